//! The card of a device.

/// Name and memory of a device.
#[derive(Debug, Clone, PartialEq)]
pub struct Card {
    /// Its name.
    pub name: String,
    /// Its compute capability, if it is a GPU.
    pub capability: Option<[u32; 2]>,
    /// Its memory, bytes.
    pub memory: f64,
    /// Memory that is free, bytes.
    pub free: f64,
}
