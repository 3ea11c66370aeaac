//! Records of what observers have found in a contact.

mod conductance;
mod flow;

pub(in crate::study) use conductance::Quantities;
pub use conductance::{ConductanceRecord, ElectricalRecord, ThermalRecord};
pub use flow::GapFlowRecord;

/// Names of all observers.
pub(super) const OBSERVERS: [&str; 2] = ["conductance", "flow"];
