//! The quantities of a law, each declared once: its column, its unit, and where a sample has it.

use asperity_contact::conductance::{ConductanceRecord, Kind as Conducts};
use asperity_contact::flow::FlowRecord;
use asperity_contact::joint::JointRecord;
use asperity_contact::motion::SweepRecord;
use asperity_surface::Axis;

/// The rows of a sample under a load.
pub(super) struct Found<'a> {
    pub(super) point: &'a SweepRecord,
    pub(super) joint: &'a JointRecord,
    pub(super) conductance: Option<&'a ConductanceRecord>,
    pub(super) flow: [Option<&'a FlowRecord>; 2],
}

impl Found<'_> {
    /// Apparent area.
    fn area(&self) -> f64 {
        self.point.load / self.point.mean_pressure
    }

    fn joint_conductance(&self, kind: Conducts) -> Option<f64> {
        let quantities = &self.conductance?.quantities;
        quantities.joint_conductance.filter(|_| quantities.kind == kind)
    }
}

/// A quantity of the law.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Gap between the mean planes.
    MeanGap,
    /// Contact fraction, corrected for the edges of spots.
    ContactFraction,
    /// Normal stiffness of an area.
    Stiffness,
    /// Tangential stiffness of an area along x.
    StiffnessX,
    /// Tangential stiffness of an area along y.
    StiffnessY,
    /// Thermal conductance of an area.
    ThermalConductance,
    /// Electrical conductance of an area.
    ElectricalConductance,
    /// Mean gap of the flow over all cells, 0 in contact: without yielding it is that of the mean planes.
    FlowGap,
    /// Pressure flow factor along x.
    FlowFactorX,
    /// Pressure flow factor along y.
    FlowFactorY,
    /// Shear flow factor along x.
    ShearFlowFactorX,
    /// Shear flow factor along y.
    ShearFlowFactorY,
}

/// A quantity with its column and its unit.
pub(super) struct Declared {
    pub(super) kind: Kind,
    pub(super) name: &'static str,
    pub(super) unit: &'static str,
    pub(super) value: fn(&Found<'_>) -> Option<f64>,
}

/// All quantities, in the order of their columns.
pub(super) const QUANTITIES: [Declared; 12] = [
    Declared { kind: Kind::MeanGap, name: "mean_gap", unit: "m", value: |found| Some(found.point.mean_gap) },
    Declared {
        kind: Kind::ContactFraction,
        name: "contact_fraction",
        unit: "",
        value: |found| Some(found.joint.corrected_fraction),
    },
    Declared {
        kind: Kind::Stiffness,
        name: "stiffness",
        unit: "Pa/m",
        value: |found| Some(found.point.stiffness? / found.area()),
    },
    Declared {
        kind: Kind::StiffnessX,
        name: "stiffness_x",
        unit: "Pa/m",
        value: |found| Some(found.joint.stiffness_x? / found.area()),
    },
    Declared {
        kind: Kind::StiffnessY,
        name: "stiffness_y",
        unit: "Pa/m",
        value: |found| Some(found.joint.stiffness_y? / found.area()),
    },
    Declared {
        kind: Kind::ThermalConductance,
        name: "thermal_joint_conductance",
        unit: "W/(m² K)",
        value: |found| found.joint_conductance(Conducts::Thermal),
    },
    Declared {
        kind: Kind::ElectricalConductance,
        name: "electrical_joint_conductance",
        unit: "S/m²",
        value: |found| found.joint_conductance(Conducts::Electrical),
    },
    Declared {
        kind: Kind::FlowGap,
        name: "flow_gap",
        unit: "m",
        value: |found| Some(found.flow.into_iter().flatten().next()?.mean_gap),
    },
    Declared {
        kind: Kind::FlowFactorX,
        name: "flow_factor_x",
        unit: "",
        value: |found| Some(found.flow[0]?.flow_factor),
    },
    Declared {
        kind: Kind::FlowFactorY,
        name: "flow_factor_y",
        unit: "",
        value: |found| Some(found.flow[1]?.flow_factor),
    },
    Declared {
        kind: Kind::ShearFlowFactorX,
        name: "shear_flow_factor_x",
        unit: "",
        value: |found| found.flow[0]?.shear_flow_factor,
    },
    Declared {
        kind: Kind::ShearFlowFactorY,
        name: "shear_flow_factor_y",
        unit: "",
        value: |found| found.flow[1]?.shear_flow_factor,
    },
];

impl Kind {
    pub(super) fn declared(self) -> &'static Declared {
        QUANTITIES.iter().find(|declared| declared.kind == self).expect("each kind is declared")
    }

    /// Name of its column.
    pub fn name(self) -> &'static str {
        self.declared().name
    }

    /// SI unit; empty for a pure number.
    pub fn unit(self) -> &'static str {
        self.declared().unit
    }
}

/// Returns the rows of a flow along an axis.
pub(super) fn along(rows: &[FlowRecord], axis: Axis, step: usize) -> Option<&FlowRecord> {
    rows.iter().find(|row| row.along == axis && row.step == Some(step))
}
