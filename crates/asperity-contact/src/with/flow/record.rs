//! The columns of a flow.

use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::surface::Axis;
use crate::units::{CubicMetre, CubicMetrePerSecond, Metre, Newton, Pascal, SquareMetre};
use crate::with::Row;
use asperity_base::record::{Column, Record, columns};

columns! {
    /// The flow through the gap of a contact under a gradient of pressure along one axis, a row of
    /// `flow.csv`; in `summary.json` of the last contact, or of a motion the means over the positions of each
    /// pass.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    #[non_exhaustive]
    pub struct FlowRecord {
        /// Pass of a motion, from 1; left out of a static contact.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub pass: Option<usize>,
        /// Position in the pass, increment, point (each from 1) or update (from 0); unknown in the mean over
        /// a pass.
        pub step: Option<usize>,
        /// Direction of the gradient of pressure: `x` or `y`.
        pub along: Axis,
        /// Length of the contact along this axis.
        pub length: Metre,
        /// Load.
        pub load: Newton,
        /// Mean pressure over the apparent area.
        pub mean_pressure: Pascal,
        /// Real area of contact.
        pub contact_area: SquareMetre,
        /// Mean gap over all cells, 0 in contact.
        pub mean_gap: Metre,
        /// Permeability K: the mean flux per width is K over 12 times the viscosity, times the mean gradient
        /// of pressure.
        pub permeability: CubicMetre,
        /// Permeability that gives the mean flux across the gradient; unknown where it is not computed.
        pub permeability_across: Option<CubicMetre>,
        /// Gap between parallel plates of this permeability.
        pub hydraulic_gap: Metre,
        /// Permeability over the cube of the mean gap.
        pub flow_factor: f64,
        /// Volume that leaks in a unit of time under the pressure difference; of a gas at the pressure of the
        /// outlet.
        pub leakage: CubicMetrePerSecond,
        /// Critical constriction: the largest gap that all cells of some path reach; 0 without a path.
        pub critical_gap: Metre,
        /// x of the critical constriction; unknown without a path.
        pub critical_x: Option<Metre>,
        /// y of the critical constriction; unknown without a path.
        pub critical_y: Option<Metre>,
        /// Width of the critical constriction across the gradient in cells; 0 without a path.
        pub critical_cells: usize,
        /// Share of the cells that are part of a path.
        pub flowing_share: f64,
        /// Volume in open cells from which no path leads out.
        pub trapped_volume: CubicMetre,
        /// Shear flow factor Φ_s: what a rough surface that slides over a smooth one carries besides the mean gap, over the
        /// rms height of the sum of both surfaces; left out unless it is asked for.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub shear_flow_factor: Option<f64>,
        /// Shear stress factor φ_fs: the shear that the pressure adds, over that of the mean gap.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub shear_stress_factor: Option<f64>,
        /// Stress factor φ_f of sliding: the mean of the reciprocal film over the reciprocal mean gap, of films of at least
        /// a hundredth of the rms height.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub sliding_stress_factor: Option<f64>,
        /// Stress factor φ_fp of a gradient of pressure: the mean of film times gradient over the mean gap times the mean
        /// gradient.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub pressure_stress_factor: Option<f64>,
        /// Permeability of the effective medium of Bruggeman with these gaps, a comparison.
        pub effective_medium: CubicMetre,
        /// Estimate of the relative error of the permeability by the grid.
        pub estimate: f64,
        /// Largest relative difference of the flux through a section from the mean of all sections.
        pub residual: f64,
    }
}

impl Record for FlowRecord {
    const COLUMNS: &'static [Column] = Self::COLUMNS;

    fn error_at(&self, error: Error) -> Error {
        match self.pass {
            Some(pass) => error.if_of_step(|source| Error::AtPass { pass, source }),
            None => error,
        }
    }
}

impl Row for FlowRecord {
    const GROUPS: &'static [(&'static str, &'static [Column])] = &[("FlowRecord", Self::OWN_COLUMNS)];

    fn pass(&self) -> Option<usize> {
        self.pass
    }

    fn mean_pressure(&self) -> Pascal {
        self.mean_pressure
    }
}

impl FlowRecord {
    /// Returns the place of the critical constriction; `None` without a path.
    pub fn constriction(&self) -> Option<[Metre; 2]> {
        self.critical_x.zip(self.critical_y).map(|(x, y)| [x, y])
    }

    /// Returns the means over the positions of each pass, for each direction. The fluxes are those of a
    /// common difference of pressure; the constriction has no mean place, and the estimate and the residual
    /// are the largest ones.
    pub fn means(rows: &[Self]) -> Vec<Self> {
        let of_passes = rows.chunk_by(|one, other| one.pass == other.pass);
        let along = |rows: &[Self], axis| -> Vec<Self> {
            rows.iter().filter(|row| row.along == axis).cloned().collect()
        };
        of_passes
            .flat_map(|rows| [Axis::X, Axis::Y].map(|axis| along(rows, axis)))
            .filter(|rows| !rows.is_empty())
            .map(|rows| Self::mean(&rows))
            .collect()
    }

    fn mean(rows: &[Self]) -> Self {
        let mean = |value: fn(&Self) -> f64| rows.iter().map(value).sum::<f64>() / rows.len() as f64;
        let most = |value: fn(&Self) -> f64| rows.iter().map(value).fold(0.0, f64::max);
        let across = rows.iter().map(|row| row.permeability_across).sum::<Option<f64>>();
        let critical_cells = rows.iter().map(|row| row.critical_cells).min().unwrap_or_default();
        Self {
            pass: rows[0].pass,
            step: None,
            along: rows[0].along,
            length: mean(|row| row.length),
            load: mean(|row| row.load),
            mean_pressure: mean(|row| row.mean_pressure),
            contact_area: mean(|row| row.contact_area),
            mean_gap: mean(|row| row.mean_gap),
            permeability: mean(|row| row.permeability),
            permeability_across: across.map(|sum| sum / rows.len() as f64),
            hydraulic_gap: mean(|row| row.hydraulic_gap),
            flow_factor: mean(|row| row.flow_factor),
            leakage: mean(|row| row.leakage),
            critical_gap: mean(|row| row.critical_gap),
            critical_x: None,
            critical_y: None,
            critical_cells,
            flowing_share: mean(|row| row.flowing_share),
            trapped_volume: mean(|row| row.trapped_volume),
            shear_flow_factor: None,
            shear_stress_factor: None,
            sliding_stress_factor: None,
            pressure_stress_factor: None,
            effective_medium: mean(|row| row.effective_medium),
            estimate: most(|row| row.estimate),
            residual: most(|row| row.residual),
        }
    }

    /// Returns the rows of the last contact, one for each direction.
    pub fn last(rows: &[Self]) -> &[Self] {
        let last = rows.last().map(|row| (row.pass, row.step));
        let of_last = rows.iter().rev().take_while(|row| Some((row.pass, row.step)) == last).count();
        &rows[rows.len() - of_last..]
    }
}
