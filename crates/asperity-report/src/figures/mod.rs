//! The figures of a results directory, drawn from what it holds and from nothing else.

mod course;
mod plastic;
mod force_distance;
mod fretting;
mod friction;
mod joint;
mod loading;
mod lubrication;
mod motion;
mod pressure;
mod profile;
mod rolling;
mod running;
mod sheet;
mod sliding;
mod static_contact;
mod stored;
mod capability;
mod subsurface;
mod surfaces;
mod sweep;
mod theories;
#[cfg(test)]
mod tests;

use std::path::PathBuf;

use asperity_base::units::{Dimension, format};
use asperity_contact::with::views::OfBodies;
use asperity_study::Results;
use asperity_study::io::fields::Fields;

use crate::draw::{Axis, Chart, Charts, Mark, Paper, Series};
use crate::error::{Error, Result};
use crate::words::captions;

pub use capability::field_map;
pub(crate) use capability::{curves as curves_of_capability, load_cycle, logarithmic};
pub(crate) use course::{OVER_POSITIONS, curves as of_motion, done, has_new_upper};
pub(crate) use force_distance::curves as of_force_distance;
pub(crate) use friction::stick;
pub(crate) use joint::curves as joint_curves;
pub use joint::draw_joint;
pub(crate) use loading::curves as of_loading;
pub(crate) use plastic::{PlasticSection, of_increments as of_plastic_increments, plastic_sections};
pub(crate) use pressure::histogram;
pub(crate) use rolling::curves as of_rolling;
pub use sheet::Sheet;
pub(crate) use sliding::curves as of_sliding;
pub(crate) use static_contact::{HeightRange, Witness, approach, open_gap, profile as profile_at_rest};
pub use stored::in_frame_of;
pub(crate) use stored::{Cap, StoredArray, ends_with_tension};
pub(crate) use subsurface::{
    columns as stress_columns, contact as contact_of_section, interfaces, on_section,
};
pub use surfaces::RINGS;
pub(crate) use surfaces::{as_measured, changed, curves as of_surfaces};
pub(crate) use sweep::curves as of_sweep;
pub(crate) use theories::Theories;

/// Writes a force with its unit. A force that pulls has a minus sign.
fn force(value: f64) -> String {
    format(value, Dimension::Force).replace('-', "−")
}

/// Which figures are drawn, and how.
#[derive(Debug, Clone, Default)]
pub struct FigureOptions {
    /// Paper and kind of file.
    pub paper: Paper,
    /// Names of the figures; all if there is none.
    pub only: Vec<String>,
    /// Whether figures that are there stay, which is an error then.
    pub keep: bool,
}

/// Charts under the name that `--only` knows them by.
#[derive(Debug, Clone)]
pub struct Curves {
    /// The name.
    pub name: &'static str,
    /// The title.
    pub title: String,
    /// Sentence about what is seen; empty without one.
    pub caption: &'static str,
    /// The charts.
    pub charts: Charts,
}

impl Curves {
    fn new(name: &'static str, title: impl Into<String>, charts: impl Into<Charts>) -> Self {
        let caption = captions::find(name).unwrap_or_default();
        Self { name, title: title.into(), caption, charts: charts.into() }
    }
}

/// A curve: points [x, y].
type Curve = Vec<[f64; 2]>;

/// The curves of the lower and of the upper body.
fn of_bodies(curves: [Curve; 2]) -> Vec<Series> {
    // Broken, so that neither hides the other where they are the same.
    let looks = [("lower body", Mark::Line), ("upper body", Mark::Dashed)].into_iter();
    looks.zip(curves).map(|((name, mark), curve)| Series::new(name, curve, mark)).collect()
}

/// The curves of a quantity of both bodies over `x`, from the rows that have one, with their axis.
fn of_law<'r, R: 'r>(
    rows: impl Iterator<Item = &'r R> + Clone,
    x: impl Fn(&R) -> Option<f64>,
    shown: &OfBodies<R>,
) -> (Axis, Vec<Series>) {
    let of_body = |body: usize| {
        let mut sum = 0.0;
        let points = rows.clone().filter_map(|row| {
            let value = (shown.values)(row)[body];
            sum = if shown.adds_up { sum + value } else { value };
            Some([x(row)?, sum])
        });
        points.collect()
    };
    (Axis::of(shown.name, shown.column), of_bodies([0, 1].map(of_body)))
}

/// The charts of quantities over `x`, without those that are 0 or unknown everywhere.
fn charts_over(x: &Axis, shown: Vec<(Axis, Vec<Series>)>) -> Charts {
    let is_there = |(_, series): &(Axis, Vec<Series>)| {
        series.iter().flat_map(|series| &series.points).any(|[_, y]| y.is_finite() && *y != 0.0)
    };
    let shown = shown.into_iter().filter(is_there);
    let charts = shown.map(|(y, series)| Chart::new("", x.clone(), y, series)).collect();
    Charts { charts, columns: 2, aspect: 0.7 }
}

/// Draws the figures of `results` into its folder `figures` and returns their paths; an error of the kind
/// `Interrupted` once `stop` says so.
pub fn draw(
    results: &Results,
    wanted: &FigureOptions,
    stop: &(dyn Fn() -> bool + Sync),
) -> Result<Vec<PathBuf>> {
    gathered(results, wanted, stop)?.finish()
}

/// The figures of `results` as PNG files in memory, with their titles.
pub fn pictures(results: &Results, wanted: &FigureOptions) -> Result<Vec<(String, Vec<u8>)>> {
    gathered(results, wanted, &|| false)?.pictures()
}

/// Draws the figures of `results`, and some of them on a second paper. A witness sees the arrays of a static
/// contact, which are read from `fields`.
pub fn gathered_with<'a>(
    results: &Results,
    wanted: &'a FigureOptions,
    beside: (Paper, &'a [&'a str]),
    stop: &'a (dyn Fn() -> bool + Sync),
    witness: (&Fields, &mut dyn Witness),
) -> Result<Sheet<'a>> {
    let sheet = Sheet::new(results, wanted, stop)?.with_pictures(beside);
    gather_on(sheet, results, Some(witness))
}

/// Draws the figures of `results`.
pub fn gathered<'a>(
    results: &Results,
    wanted: &'a FigureOptions,
    stop: &'a (dyn Fn() -> bool + Sync),
) -> Result<Sheet<'a>> {
    gather_on(Sheet::new(results, wanted, stop)?, results, None)
}

fn gather_on<'a>(
    mut sheet: Sheet<'a>,
    results: &Results,
    witness: Option<(&Fields, &mut dyn Witness)>,
) -> Result<Sheet<'a>> {
    let passes = results.passes()?;
    let of = match passes.is_empty() {
        true if results.case()?.motion.is_some() => {
            let message = format!("{} has no finished pass to draw", results.directory().display());
            return Err(Error::missing(message, None));
        }
        true => static_contact::draw(results, &mut sheet, witness)?,
        false => motion::draw(results, &passes, &mut sheet)?,
    };
    let updates = results.updates()?;
    if !updates.is_empty() {
        sliding::draw(&updates, &results.static_fields()?, &of, &mut sheet)?;
    }
    if results.increments()?.last().is_some_and(|last| last.fretting.is_some()) {
        sliding::bodies(&results.static_fields()?, &of, &mut sheet)?;
    }
    let points = results.sweep()?;
    if !points.is_empty() {
        let case = results.case()?;
        sweep::draw(&points, &case, Theories::of(results, &case, &points).as_ref(), &mut sheet)?;
    }
    let case = results.case()?;
    if case.plasticity.is_some() {
        plastic::draw(&results.plastic_fields(passes.last().map(|pass| pass.pass))?, &of, &mut sheet)?;
    }
    if case.subsurface.is_some() {
        let fields = results.subsurface_fields(passes.last().map(|pass| pass.pass))?;
        subsurface::draw(&fields, &of, &mut sheet)?;
    }
    let of_all = if points.is_empty() { of.clone() } else { sweep::loads_in_words(&points) };
    capability::draw(results, &done(&passes), &of, &of_all, &mut sheet)?;
    Ok(sheet)
}
