//! The figure of bodies that flow below their surfaces pass after pass: plastic work, how far the surface
//! moves, strain.

use asperity_contact::motion::{PassPlasticRecord, PassRecord};

use super::{Curve, Curves, of_bodies};
use crate::draw::{Axis, Chart, Charts, Series, Unit};

/// Plastic work of each pass, shift of the surface against the depths since the beginning, largest plastic
/// strain, and range of the residual displacement; none of bodies that do not flow.
pub(crate) fn curves(passes: &[PassRecord]) -> Option<Curves> {
    passes.first()?.plastic?;
    let over = |value: &dyn Fn(&PassPlasticRecord) -> f64| -> Curve {
        passes.iter().filter_map(|p| Some([p.pass as f64, value(&p.plastic?)])).collect()
    };
    let summed = |curve: Curve| -> Curve {
        let mut sum = 0.0;
        let each = curve.into_iter().map(|[pass, value]| {
            sum += value;
            [pass, sum]
        });
        std::iter::once([0.0, 0.0]).chain(each).collect()
    };
    // A body that does not flow is not shown.
    let bodies = |curves: [Curve; 2]| -> Vec<Series> {
        let flows = |series: &Series| series.points.iter().any(|[_, y]| *y != 0.0);
        of_bodies(curves).into_iter().filter(flows).collect()
    };
    let works = [over(&|plastic| plastic.plastic_work_lower), over(&|plastic| plastic.plastic_work_upper)];
    // Of what has shaken down nothing is left, which has no logarithm.
    let above = |curve: Curve| curve.into_iter().filter(|[_, work]| *work > 0.0).collect();
    let shown = [
        (
            Axis { log: true, ..Axis::of("plastic work of a pass", "plastic_work_lower") },
            bodies(works.map(above)),
        ),
        (
            Axis::of("shift of the surface along x", "surface_shift_lower"),
            bodies([
                summed(over(&|plastic| plastic.surface_shift_lower)),
                summed(over(&|plastic| plastic.surface_shift_upper)),
            ]),
        ),
        (
            Axis::linear("largest plastic strain", Unit::Of("%")),
            bodies([
                over(&|plastic| 100.0 * plastic.max_plastic_strain_lower),
                over(&|plastic| 100.0 * plastic.max_plastic_strain_upper),
            ]),
        ),
        (
            Axis::of("range of the residual displacement", "residual_displacement_lower"),
            bodies([
                over(&|plastic| plastic.residual_displacement_lower),
                over(&|plastic| plastic.residual_displacement_upper),
            ]),
        ),
    ];
    let charts: Vec<Chart> = shown
        .into_iter()
        .filter(|(_, series)| !series.is_empty())
        .map(|(y, series)| Chart::new("", Axis::linear("pass", Unit::Count), y, series))
        .collect();
    // Bodies that stay elastic have none.
    let strain =
        |plastic: PassPlasticRecord| plastic.max_plastic_strain_lower.max(plastic.max_plastic_strain_upper);
    passes.iter().any(|pass| pass.plastic.is_some_and(|plastic| strain(plastic) > 0.0)).then(|| {
        let charts = Charts { charts, columns: 2, aspect: 0.7 };
        Curves::new("plastic_flow", "plastic flow over the passes", charts)
    })
}
