//! Fields of a static contact, by their names in files.

use asperity_base::grid::{Field, Grid};
use asperity_base::units::{Metre, Pascal};
use asperity_contact::subsurface::Tractions;
pub use asperity_contact::with::NamedField;

/// The fields of a static contact.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct RestFields {
    /// The grid of all fields.
    pub grid: Grid,
    /// Rigid-body approach δ.
    pub approach: Metre,
    /// Hardness of the pair; its smallest value if it is a map.
    pub hardness: Pascal,
    /// The fields, in the order in which they are written to files.
    pub fields: Vec<NamedField>,
}

impl RestFields {
    /// Removes and returns the field with this name.
    pub fn take(&mut self, name: &str) -> Option<Field> {
        let at = self.fields.iter().position(|field| field.name == name)?;
        Some(self.fields.swap_remove(at).values)
    }

    /// Returns the tractions on the lower body.
    pub(super) fn tractions(&self) -> Tractions {
        let of = |name| self.fields.iter().find(|field| field.name == name).map(|field| field.values.clone());
        let shear = ["traction_x", "traction_y"].map(of);
        Tractions { pressure: of("pressure").expect("every contact has a pressure"), shear }
    }
}
