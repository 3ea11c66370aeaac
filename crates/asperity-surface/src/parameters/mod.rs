//! Roughness parameters of ISO 25178-2:2021, with one file per family of parameters.

mod bearing;
mod distribution;
mod feature;
mod functional;
mod height;
mod hybrid;
pub(crate) mod row;
pub(crate) mod slope;
mod spatial;
mod stratified;

pub use bearing::BearingCurve;
pub use distribution::{Classes, Distribution, Slope};
pub use feature::FeatureParameters;
pub use functional::FunctionalParameters;
pub use height::HeightParameters;
pub use hybrid::HybridParameters;
pub(crate) use hybrid::area_excess;
pub use row::{Parameter, Unit};
pub use spatial::SpatialParameters;
pub use stratified::Core;

use serde::Serialize;

use crate::{NEVER, Stop, Topography, WOLF_PRUNING, check_stop};
use asperity_base::error::Result;
use asperity_base::units::Metre;

/// Areal roughness parameters over the defined samples, by families; serialised as one map from symbol to
/// value.
///
/// No filter is applied: level and filter first. Values are SI, ratios are fractions of one. An undefined
/// parameter is NaN, `null` in JSON; its family describes when this occurs.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Parameters {
    /// Parameters of the heights alone.
    #[serde(flatten)]
    pub height: HeightParameters,
    /// Parameters of the autocorrelation and the spectrum.
    #[serde(flatten)]
    pub spatial: SpatialParameters,
    /// Parameters of the slopes.
    #[serde(flatten)]
    pub hybrid: HybridParameters,
    /// Parameters of the material ratio curve.
    #[serde(flatten)]
    pub functional: FunctionalParameters,
    /// Parameters of the hills and dales, pruned at [`WOLF_PRUNING`].
    #[serde(flatten)]
    pub feature: FeatureParameters,
}

impl Parameters {
    /// Computes the parameters of `topography`.
    pub fn new(topography: &Topography) -> Self {
        Self::until(topography, NEVER).expect("nobody stops it, and the pruning is a share")
    }

    /// [`new`](Self::new) that can be stopped by `stop`.
    ///
    /// # Errors
    /// [`asperity_base::Error::Interrupted`].
    pub fn until(topography: &Topography, stop: Stop<'_>) -> Result<Self> {
        fn made<T>(stop: Stop<'_>, of: impl FnOnce() -> T) -> Result<T> {
            check_stop(stop)?;
            Ok(of())
        }
        Ok(Self {
            height: made(stop, || HeightParameters::new(topography))?,
            spatial: made(stop, || SpatialParameters::new(topography))?,
            hybrid: made(stop, || HybridParameters::new(topography))?,
            functional: made(stop, || FunctionalParameters::new(topography))?,
            feature: FeatureParameters::until(topography, WOLF_PRUNING, stop)?,
        })
    }

    /// Returns all parameters with symbols, units and meanings, for tables.
    pub fn rows(&self) -> Vec<Parameter> {
        let Self { height, spatial, hybrid, functional, feature } = self;
        [height.rows(), spatial.rows(), hybrid.rows(), functional.rows(), feature.rows()].concat()
    }
}

impl Topography {
    /// Computes the ISO 25178 parameters of the defined samples. For one family alone use for example
    /// [`HeightParameters::new`]: other families sort the heights.
    pub fn parameters(&self) -> Parameters {
        Parameters::new(self)
    }

    /// Root mean square height, [`HeightParameters::sq`].
    pub fn sq(&self) -> Metre {
        HeightParameters::new(self).sq
    }

    /// Root mean square gradient, [`HybridParameters::sdq`].
    pub fn sdq(&self) -> f64 {
        HybridParameters::new(self).sdq
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Form;
    use asperity_base::grid::{Field, Grid};

    fn topography(shape: [usize; 2], height: impl Fn(usize, usize) -> f64) -> Topography {
        let grid = Grid::new(shape, [1e-6; 2]).unwrap();
        Topography::new(grid, Field::from_shape_fn(shape, |(ix, iy)| height(ix, iy))).unwrap()
    }

    #[test]
    fn what_has_no_meaning_is_not_a_number() {
        let flat = Form::Flat.on(&Grid::new([4, 4], [1.0; 2]).unwrap()).unwrap().parameters();
        let Parameters { height, hybrid, functional, .. } = flat;
        assert_eq!((height.sa, height.sq, height.sz), (0.0, 0.0, 0.0));
        assert!(height.ssk.is_nan() && hybrid.sdq.is_nan() && hybrid.sdr.is_nan());
        assert_eq!((functional.sk, functional.spk, functional.svk, functional.vvc), (0.0, 0.0, 0.0, 0.0));
        let nothing = topography([4, 4], |_, _| f64::NAN).parameters();
        assert!(nothing.rows().iter().all(|row| row.value.is_nan()));
    }

    #[test]
    fn one_row_and_one_sample_are_surfaces_too() {
        let row = topography([64, 1], |ix, _| 1e-7 * (0.3 * ix as f64).sin()).parameters();
        let everywhere = [row.height.rows(), row.hybrid.rows(), row.functional.rows()].concat();
        assert!(everywhere.iter().all(|row| row.value.is_finite()), "{row:?}");
        assert!(row.spatial.sal.is_finite() && row.spatial.str.is_nan() && row.feature.spd > 0.0);
        let one = topography([1, 1], |_, _| 3.0).parameters();
        assert_eq!((one.height.sz, one.functional.smc, one.functional.vmp), (0.0, 0.0, 0.0));
        assert!(one.hybrid.sdq.is_finite() && one.functional.sk.is_nan());
    }

    #[test]
    fn undefined_samples_do_not_count() {
        // Every second row undefined: the heights that are left are those of the rows between.
        let height = |ix: usize, iy: usize| ((7 * ix * ix + 3 * iy) % 31) as f64;
        let holed = topography([30, 40], |ix, iy| if iy % 2 == 0 { height(ix, iy / 2) } else { f64::NAN });
        let whole = topography([30, 20], height);
        assert_eq!(HeightParameters::new(&holed), HeightParameters::new(&whole));
        assert_eq!(FunctionalParameters::new(&holed), FunctionalParameters::new(&whole));
    }

    #[test]
    fn json_is_one_map_of_the_symbols_in_the_rows() {
        let parameters = topography([8, 8], |ix, iy| (ix as f64).sin() + (iy as f64).cos()).parameters();
        let json = serde_json::to_value(parameters).unwrap();
        let rows = parameters.rows();
        assert_eq!(json.as_object().unwrap().len(), rows.len());
        let same = |row: &Parameter| {
            if row.value.is_nan() { json[row.symbol].is_null() } else { json[row.symbol] == row.value }
        };
        assert!(rows.iter().all(same), "{json}");
        let sq = rows.iter().find(|row| row.symbol == "Sq").unwrap();
        assert_eq!(
            (sq.unit, sq.family, sq.meaning),
            (Unit::Length, "height", "Root mean square height, √⟨z²⟩")
        );
    }
}
