//! The figure of bodies that run in: what becomes of them over the distance that they slide.

use asperity_base::units::CELSIUS;
use asperity_contact::each;
use asperity_contact::motion::PassRecord;
use asperity_contact::with::BodyLaw;

use super::{Curve, Curves, charts_over, of_bodies, of_law};
use crate::draw::{Axis, Charts, Mark, Series, Unit};

/// From such a ratio of the largest to the least distance on it is drawn by its logarithm.
const DECADES: f64 = 100.0;

/// What laws have done, roughness, contact area and temperature, each where there is any; none of bodies that
/// do not run in.
pub(super) fn curves(passes: &[PassRecord], sq: [f64; 2]) -> Option<Curves> {
    let distances: Vec<f64> = passes.iter().filter_map(|p| Some(p.running?.distance)).collect();
    let (least, most) = (distances.first()?, distances.last()?);
    let charts = charts(passes, sq, *most > DECADES * least);
    Some(Curves::new("running-in", "running in over the sliding distance", charts))
}

fn charts(passes: &[PassRecord], sq: [f64; 2], log: bool) -> Charts {
    let x = if log {
        Axis::log("sliding distance", Unit::Of("m"))
    } else {
        Axis::of("sliding distance", "distance")
    };
    let over = |value: &dyn Fn(&PassRecord) -> f64| -> Curve {
        passes.iter().filter_map(|p| Some([p.running?.distance, value(p)])).collect()
    };
    let from = |first: f64, curve: Curve| -> Curve { std::iter::once([0.0, first]).chain(curve).collect() };
    let alone = |name: &str, curve| vec![Series::new(name, curve, Mark::Line)];
    let temperature = over(&|p| p.running.map_or(f64::NAN, |r| r.max_flash_temperature - CELSIUS));
    let mut shown: Vec<(Axis, Vec<Series>)> = Vec::new();
    each!(law L => shown.extend(L::OF_PASSES.iter().map(|shown| {
        let (axis, series) = of_law(passes.iter(), |p| p.running.map(|running| running.distance), shown);
        (Axis { log: log && shown.adds_up, ..axis }, series)
    })));
    shown.extend([
        (
            Axis::of("Sq", "sq_lower"),
            of_bodies([from(sq[0], over(&|p| p.sq_lower)), from(sq[1], over(&|p| p.sq_upper))]),
        ),
        (
            Axis::of("real contact area", "mean_contact_area"),
            alone("both bodies", over(&|p| p.mean_contact_area)),
        ),
    ]);
    shown.push((Axis::linear("largest temperature", Unit::Of("°C")), alone("both bodies", temperature)));
    charts_over(&x, shown)
}
