//! Records of what observers have found in a contact, and of the limits that it exceeds.

mod conductance;
mod flow;
mod limit;

pub(crate) use conductance::Quantities;
pub use conductance::{ConductanceRecord, ElectricalRecord, ThermalRecord};
pub use flow::GapFlowRecord;
pub(crate) use limit::LIMITS_TABLE;
pub use limit::{BrokenLimit, Limit};

/// Names of all observers.
pub(super) const OBSERVERS: [&str; 2] = ["conductance", "flow"];
