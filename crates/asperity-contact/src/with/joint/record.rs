//! The columns of the law of a joint.

use serde::{Deserialize, Serialize};

use crate::units::{Metre, Newton, NewtonPerMetre, Pascal};
use crate::with::Row;
use asperity_base::record::{Column, Record, columns};

columns! {
    /// The law of a joint under a load, a row of `joint.csv`; in `summary.json` of the last contact.
    ///
    /// The gap without load is the sum of both surfaces. Theories use its moments alone, by differences between neighbouring
    /// cells; none of them is fitted.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    #[non_exhaustive]
    pub struct JointRecord {
        /// Increment or point, from 1.
        pub step: Option<usize>,
        /// Load.
        pub load: Newton,
        /// Mean pressure over the apparent area.
        pub mean_pressure: Pascal,
        /// Tangential stiffness along x of the cells that bear elastically; unknown in full contact, where it is infinite.
        pub stiffness_x: Option<NewtonPerMetre>,
        /// Tangential stiffness along y.
        pub stiffness_y: Option<NewtonPerMetre>,
        /// Contact fraction, corrected for the edges of spots.
        pub corrected_fraction: f64,
        /// Gap of the mean planes at which the surfaces first touch, the largest height of their sum.
        pub first_touch_gap: Metre,
        /// Rms height σ of the sum of both surfaces.
        pub rms_height: Metre,
        /// Rms slope of the sum of both surfaces.
        pub rms_slope: f64,
        /// Nayak's parameter m₀ m₄/m₂² of the sum of both surfaces; unknown of flat ones.
        pub nayak: Option<f64>,
        /// Lag at which the autocorrelation of the sum of both surfaces falls to 0.2; 0 of flat ones. Unknown of surfaces
        /// whose correlation does not fall so far.
        pub correlation_length: Option<Metre>,
        /// Composite modulus E*.
        pub modulus: Pascal,
        /// Contact fraction by Persson's theory; unknown of flat surfaces, as all theories.
        pub persson_fraction: Option<f64>,
        /// Contact fraction by Bush, Gibson and Thomas, for light loads.
        pub bgt_fraction: Option<f64>,
        /// Normal stiffness by Persson's exponential law, load/(0.4 σ).
        pub persson_stiffness: Option<NewtonPerMetre>,
        /// Mean pressure at the same mean gap by Greenwood and Williamson; unknown without peaks in their sense.
        pub greenwood_williamson_pressure: Option<Pascal>,
        /// Convolutions for the tangential stiffnesses.
        pub convolutions: f64,
    }
}

impl JointRecord {
    /// Normal stiffness of an area by Persson's exponential law, Pa/m.
    pub fn persson_stiffness_of_area(&self) -> Option<f64> {
        self.persson_stiffness.map(|stiffness| stiffness * self.mean_pressure / self.load)
    }
}

impl Record for JointRecord {
    const COLUMNS: &'static [Column] = Self::COLUMNS;
}

impl Row for JointRecord {
    const GROUPS: &'static [(&'static str, &'static [Column])] = &[("JointRecord", Self::OWN_COLUMNS)];

    fn pass(&self) -> Option<usize> {
        None
    }

    fn mean_pressure(&self) -> Pascal {
        self.mean_pressure
    }
}
