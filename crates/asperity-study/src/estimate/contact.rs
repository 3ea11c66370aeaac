//! Contacts that the grid does not resolve: cut off at its boundary, with too few cells, or absent.
//!
//! Predictions use Hertz' contact of the paraboloid closest to the gap. Warnings about a result use its
//! pressures.

use ndarray::s;

use asperity_base::grid::Field;
use asperity_base::units::{self, Dimension, Metre, Pascal};
use asperity_contact::motion::{Paraboloid, Position, initial_gap, largest_spot};
use asperity_contact::operator::Boundary;
use asperity_contact::solver::Control;

/// Number of cells across a contact spot from which its pressures are accurate to a few per cent.
pub(crate) const CELLS_ACROSS: usize = 6;

/// Half-width of a contact over its radius of curvature up to which strains are small: they are about a third
/// of it.
const SMALL_STRAIN: f64 = 0.1;

/// Returns the predictions of Hertz' estimate for bodies with this initial `gap`: whether the boundary cuts
/// the contact off, and whether it has too few cells.
pub(super) fn predict(
    gap: &Field,
    pitch: [Metre; 2],
    modulus: Pascal,
    boundary: Boundary,
    control: Control,
) -> HertzPrediction {
    let Some(paraboloid) = Paraboloid::fit(gap, pitch) else { return HertzPrediction::default() };
    let mut prediction = HertzPrediction { curved: true, ..HertzPrediction::default() };
    let touch = gap.iter().copied().fold(f64::INFINITY, f64::min);
    let presses = match control {
        Control::Load(_) => true,
        Control::Approach(approach) => approach > touch,
    };
    if !presses {
        return prediction;
    }
    let length = |value| units::format(value, Dimension::Length);
    let Some(contact) = paraboloid.hertz(modulus, control, touch) else {
        prediction.rim = endless(&paraboloid, boundary);
        return prediction;
    };
    if let Some((axis, reach, rim, pressure)) = hardest_side(&paraboloid, contact.semi_axes, boundary)
        && pressure >= 1.0
    {
        prediction.rim = Some(format!(
            "the rim of the grid cuts the contact off along {}: by Hertz it reaches {} from the apex, the rim is {} away; \
             take a larger `shape` or a lower load",
            ["x", "y"][axis],
            length(reach),
            length(rim)
        ));
    }
    let [widest, radius] = [0, 1]
        .map(|axis| [contact.semi_axes[axis], 1.0 / paraboloid.curvatures[axis]])
        .into_iter()
        .reduce(|one, other| if other[0] / other[1] > one[0] / one[1] { other } else { one })
        .expect("two axes");
    if widest > SMALL_STRAIN * radius {
        prediction.wide = Some(format!(
            "the contact is wide for a theory of small strains: by Hertz it reaches {} from its centre, {} of the radius of curvature, \
             {}, and the theory holds up to {SMALL_STRAIN}; check `radius` and the load",
            length(widest),
            units::format_number_digits(widest / radius, 2),
            length(radius)
        ));
    }
    let narrow = 2.0 * contact.semi_axes[0].min(contact.semi_axes[1]);
    let cells = narrow / paraboloid.pitch[0].max(paraboloid.pitch[1]);
    if cells < CELLS_ACROSS as f64 {
        prediction.coarse = Some(format!(
            "the mesh is coarse for the contact: by Hertz it is {} across, {cells:.3} cells; its pressures need \
             {CELLS_ACROSS}: take a smaller `pitch`",
            length(narrow)
        ));
    }
    prediction
}

/// Predictions of Hertz' estimate.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct HertzPrediction {
    /// Whether the bodies are curved rather than rough.
    pub(super) curved: bool,
    /// Warning that the boundary of the grid cuts the contact off.
    pub(super) rim: Option<String>,
    /// Warning that the contact has too few cells.
    pub(super) coarse: Option<String>,
    /// Warning that the contact is too wide for small strains.
    pub(super) wide: Option<String>,
}

/// Finds the free side of the grid with the highest edge pressure for a contact with these semi-axes along
/// the principal directions. Returns its axis, the reach of the contact from the apex, the distance of the
/// side, and the pressure at the side over that at the centre.
///
/// A contact with the reach a that is cut off at w presses on the last cells, of pitch h, with about p₀
/// (√(h/w) + 1.1 (a/w − 1) √(w/h)). An edge at w adds a term to Hertz' pressure that grows as the inverse
/// root of the distance from the edge, here averaged over a cell. The factor 1.1 is from computations of
/// spheres and ellipsoids on 32 to 128 cells.
fn hardest_side(
    paraboloid: &Paraboloid,
    semi_axes: [Metre; 2],
    boundary: Boundary,
) -> Option<(usize, Metre, Metre, f64)> {
    let [c, s] = paraboloid.direction;
    let [along, across] = semi_axes;
    let reach = [(along * c).hypot(across * s), (along * s).hypot(across * c)];
    let sides = [0, 1].into_iter().filter(|axis| !boundary.repeats(*axis)).flat_map(|axis| {
        [paraboloid.apex[axis], paraboloid.extent[axis] - paraboloid.apex[axis]]
            .map(|rim| (axis, reach[axis], rim))
    });
    let pressures = sides.map(|(axis, reach, rim)| {
        let cells = (rim / paraboloid.pitch[axis]).max(1.0);
        (
            axis,
            reach,
            rim,
            cells.sqrt().recip() + 1.1 * (reach / rim.max(paraboloid.pitch[axis]) - 1.0) * cells.sqrt(),
        )
    });
    pressures.max_by(|one, other| one.3.total_cmp(&other.3))
}

/// Warns of a gap that does not open towards a free side.
fn endless(paraboloid: &Paraboloid, boundary: Boundary) -> Option<String> {
    let [large, small] = paraboloid.curvatures;
    let axis = paraboloid.line();
    let length = |value| units::format(value, Dimension::Length);
    if large <= 0.0 || -small > large {
        return (boundary != Boundary::PERIODIC).then(|| {
            format!(
                "the gap is hollow, of radius {}: the bodies touch at the rim of the grid, where pressures rise without \
                 bound; `level = \"quadratic\"` removes the curvature of a measurement",
                length(1.0 / small.abs())
            )
        });
    }
    (!boundary.repeats(axis)).then(|| {
        format!(
            "the line contact ends at the rim of the grid along {}, where its pressure rises, nor is it in plane strain: \
             the radius is {} across; {} gives it no ends",
            ["x", "y"][axis],
            length(1.0 / large),
            boundary_of_a_line(axis)
        )
    })
}

/// Boundary of a line contact along an axis, as written in a case file.
fn boundary_of_a_line(axis: usize) -> &'static str {
    ["`boundary = [\"periodic\", \"free\"]`", "`boundary = [\"free\", \"periodic\"]`"][axis]
}

/// Returns the gap at first touch, if the bodies do not touch at this `approach` at any of the `positions`.
pub(super) fn apart(surfaces: [&Field; 2], positions: &[Position], approach: Metre) -> Option<Metre> {
    let highest = surfaces[0].iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let lowest = surfaces[1].iter().copied().fold(f64::INFINITY, f64::min);
    let mut touch = f64::INFINITY;
    // Positions with the largest overlap usually touch first, and the search ends at the first that touches.
    let mut ordered: Vec<&Position> = positions.iter().collect();
    ordered.sort_by_key(|position| std::cmp::Reverse(position.columns));
    for position in ordered {
        touch = initial_gap(surfaces, position).iter().copied().fold(touch, f64::min);
        if touch < approach {
            return None;
        }
        // The most prominent heights bound the distance.
        if touch <= lowest - highest {
            break;
        }
    }
    Some(touch)
}

/// Warns that there is no contact at an approach below `touch`.
pub(super) fn no_contact(approach: Metre, touch: Metre) -> String {
    let length = |value| units::format(value, Dimension::Length);
    format!(
        "no contact: the approach is {}, the smallest gap {}; the bodies touch from an `approach` of {} on",
        length(approach),
        length(touch),
        length(touch)
    )
}

/// Warns if the largest contact spot has too few cells.
pub fn too_few_cells(across: usize) -> Option<String> {
    match across {
        1 => Some(format!(
            "the mesh is coarse for the contact: its largest spot is a single cell across, {CELLS_ACROSS} or more are \
             needed for its pressures; take a smaller `pitch`"
        )),
        2..CELLS_ACROSS => Some(format!(
            "the mesh is coarse for the contact: its largest spot is {across} cells across, {CELLS_ACROSS} or more are \
             needed for its pressures; take a smaller `pitch`"
        )),
        _ => None,
    }
}

/// Warns if a free side of the grid cuts a curved contact off, according to the `pressure`. Either the
/// pressure is largest in the outermost cells, or the load on one side of them is not much below that on the
/// most loaded line inside.
///
/// If the Hertzian contact of a sphere or an ellipsoid extends slightly beyond the side, its largest pressure
/// is still accurate to 1 %. Once the pressure at the side exceeds it, the error soon exceeds 5 %.
pub fn cut_off(
    pressure: &Field,
    gap: impl FnOnce() -> Field,
    pitch: [Metre; 2],
    boundary: Boundary,
) -> Option<String> {
    const SHARE_OF_A_LINE: f64 = 0.75;
    let sides = [0, 1].map(|axis| Sides::of(pressure, axis));
    let (axis, side) = sides
        .iter()
        .enumerate()
        .filter(|(axis, side)| !boundary.repeats(*axis) && side.rim > 0.0)
        .filter(|(_, side)| side.rim >= side.inside || side.line >= SHARE_OF_A_LINE * side.fullest)
        .max_by(|one, other| one.1.rim.total_cmp(&other.1.rim))?;
    let paraboloid = Paraboloid::fit(&gap(), pitch)?;
    let value = |value| units::format(value, Dimension::Pressure);
    let way_out = if paraboloid.is_endless() {
        format!("{} gives a line contact no ends", boundary_of_a_line(paraboloid.line()))
    } else {
        "take a larger `shape` or a lower load".to_owned()
    };
    Some(format!(
        "the rim of the grid cuts the contact off along {}: the largest pressure there is {}, inside {}, and the outermost \
         cells bear {:.2} % of the load; {way_out}",
        ["x", "y"][axis],
        value(side.rim),
        value(side.inside),
        100.0 * boundary.outermost(pressure) / pressure.sum()
    ))
}

/// Pressures at the two sides of the grid across an axis.
struct Sides {
    /// Largest pressure at them.
    rim: Pascal,
    /// Largest pressure elsewhere, without all sides.
    inside: Pascal,
    /// The larger of the sums over the two sides.
    line: Pascal,
    /// Largest sum over a line between them.
    fullest: Pascal,
}

impl Sides {
    fn of(pressure: &Field, axis: usize) -> Self {
        let n = pressure.len_of(ndarray::Axis(axis));
        let ends = || pressure.axis_iter(ndarray::Axis(axis)).step_by((n - 1).max(1));
        let most = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
        let end = |n: usize| (n - 1).max(1);
        let inside = pressure.slice(s![1..end(pressure.nrows()), 1..end(pressure.ncols())]);
        let lines = pressure.sum_axis(ndarray::Axis(1 - axis));
        Self {
            rim: most(&mut ends().flat_map(|line| line.to_vec())),
            inside: inside.fold(0.0, |most, p| if *p > most { *p } else { most }),
            line: most(&mut ends().map(|line| line.sum())),
            fullest: most(&mut lines.iter().copied().take(n - 1).skip(1)),
        }
    }
}

/// Number of cells across the largest contact spot of a pressure field.
pub fn spot(pressure: &Field, boundary: Boundary) -> usize {
    let touching = pressure.iter().enumerate().filter(|(_, p)| **p > 0.0).map(|(cell, _)| cell);
    largest_spot(touching, [pressure.nrows(), pressure.ncols()], boundary.wraps())
}
