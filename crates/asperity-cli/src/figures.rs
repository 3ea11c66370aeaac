//! The figures of a results directory, drawn from what it holds and from nothing else.

use std::io;
use std::path::{Path, PathBuf};

use asperity::io::atomic;
use asperity::io::fields::{Attribute, Fields};
use asperity::io::results::{Results, pressure_name};
use asperity::motion::{IncrementRecord, PassRecord, StepRecord};
use asperity::units::{Dimension, format};
use asperity::{Field, Grid};

use crate::draw::{
    self, Animation, Axis, Colours, Frame, LineFigure, MapFigure, Mark, Quantity, SectionFigure, Series, Unit,
};
use crate::report::{Failure, Outcome};

/// Pressure maps on one sheet.
const SHEET: usize = 6;

/// Draws all figures of `results` into its folder `figures` and returns their paths; an error of the kind `Interrupted`
/// once `stop` says so.
pub(crate) fn draw(results: &Results, stop: &dyn Fn() -> bool) -> Outcome<Vec<PathBuf>> {
    let folder = results.figures_folder();
    std::fs::create_dir_all(&folder)
        .map_err(|source| asperity::Error::File { path: folder.clone(), source })?;
    atomic::sweep(&folder);
    let mut sheet = Sheet { folder, drawn: Vec::new(), stop };
    let passes = results.passes()?;
    if passes.is_empty() {
        static_contact(results, &mut sheet)?;
    } else {
        motion(results, &passes, &mut sheet)?;
    }
    if results.case()?.get("subsurface").is_some() {
        subsurface(&results.subsurface_fields(passes.last().map(|pass| pass.pass))?, &mut sheet)?;
    }
    Ok(sheet.drawn)
}

/// Where figures go, and which there are.
struct Sheet<'a> {
    folder: PathBuf,
    drawn: Vec<PathBuf>,
    /// Whether no more are wanted.
    stop: &'a dyn Fn() -> bool,
}

impl Sheet<'_> {
    fn add(
        &mut self,
        name: &str,
        figure: impl FnOnce(&Path) -> Result<(), draw::Error>,
    ) -> Result<(), draw::Error> {
        let path = self.folder.join(name);
        if (self.stop)() {
            return Err(draw::Error { path, source: io::ErrorKind::Interrupted.into() });
        }
        figure(&path)?;
        self.drawn.push(path);
        Ok(())
    }
}

/// A field as stored, with the grid that it lies on.
struct Stored {
    field: Field,
    grid: Grid,
    /// Distance of its corner from the lower body's, in columns.
    column: usize,
}

impl Stored {
    fn read(fields: &Fields, name: &str) -> Outcome<Self> {
        let stored = fields.read(name)?;
        let pitch = [stored.pitch[0], stored.pitch[1]];
        let column = (stored.origin[0] / pitch[0] - 0.5).round().max(0.0) as usize;
        let field =
            stored.into_field().ok_or_else(|| Failure::usage(format!("`{name}` is not a field"), None))?;
        let grid = Grid::new([field.nrows(), field.ncols()], pitch)?;
        Ok(Self { field, grid, column })
    }

    fn map(&self, title: impl Into<String>, name: &str, unit: Unit, colours: Colours) -> MapFigure<'_> {
        MapFigure {
            title: title.into(),
            field: &self.field,
            grid: &self.grid,
            quantity: Quantity::new(name, unit),
            colours,
            range: None,
        }
    }

    fn pressure(&self, title: impl Into<String>) -> MapFigure<'_> {
        self.map(title, "pressure", Unit::Pressure, Colours::Pressure)
    }

    /// What the pressure is of the largest that its cell bears.
    fn over(&self, cap: &Cap) -> Self {
        let field = match cap {
            Cap::Field(cap) if cap.dim() == self.field.dim() => &self.field / cap,
            Cap::Field(_) => self.field.clone(),
            Cap::Number(cap) if cap.is_finite() => self.field.mapv(|p| p / cap),
            Cap::Number(_) => self.field.clone(),
        };
        Self { field, ..*self }
    }

    /// Where a share of the cap is elastic and where it is plastic.
    fn contact(&self, title: impl Into<String>, yields: bool) -> MapFigure<'_> {
        let hardness = if yields { 1.0 } else { f64::INFINITY };
        self.map(title, "pressure", Unit::Number, Colours::Contact { hardness })
    }

    fn heights(&self, title: impl Into<String>) -> MapFigure<'_> {
        self.map(title, "height", Unit::Length, Colours::Heights)
    }
}

fn static_contact(results: &Results, sheet: &mut Sheet<'_>) -> Outcome {
    let fields = results.static_fields()?;
    let read = |name| Stored::read(&fields, name);
    let (lower, upper, pressure) = (read("lower")?, read("upper")?, read("pressure")?);
    let (gap, plastic) = (read("gap")?, read("plastic")?);
    let hardness = hardness(&fields)?;
    let bodies = [lower.heights("lower body"), upper.heights("upper body, underside")];
    sheet.add("topographies.png", |path| draw::maps(path, &bodies, 2))?;
    sheet.add("pressure.png", |path| draw::map(path, &pressure.pressure("pressure")))?;
    let share = pressure.over(&Cap::read(&fields)?);
    sheet.add("contact.png", |path| draw::map(path, &share.contact("contact", hardness.is_finite())))?;
    let gap = gap.map("deformed gap", "gap", Unit::Length, Colours::Heights);
    sheet.add("gap.png", |path| draw::map(path, &gap))?;
    if hardness.is_finite() {
        let plastic = plastic.map("plastic interference", "depth", Unit::Length, Colours::Pressure);
        sheet.add("plastic.png", |path| draw::map(path, &plastic))?;
    }
    if fields.names()?.iter().any(|name| name == "stick") {
        friction(&fields, &pressure, sheet)?;
    }
    let increments = results.increments()?;
    if increments.len() > 1 {
        sheet.add("loading.png", |path| draw::lines(path, &loading(&increments)))?;
    }
    Ok(())
}

/// Shear and where it holds.
fn friction(fields: &Fields, pressure: &Stored, sheet: &mut Sheet<'_>) -> Outcome {
    let read = |name| Stored::read(fields, name);
    let [mut shear, y] = [read("traction_x")?, read("traction_y")?];
    shear.field.zip_mut_with(&y.field, |x, y| *x = x.hypot(*y));
    let mut stick = read("stick")?;
    stick.field.zip_mut_with(&pressure.field, |s, p| *s += f64::from(u8::from(*p > 0.0)));
    let maps = [
        shear.map("shear traction", "shear", Unit::Pressure, Colours::Pressure),
        stick.map("stick and slip", "", Unit::Number, Colours::Stick),
    ];
    sheet.add("shear.png", |path| draw::maps(path, &maps, 2))?;
    Ok(())
}

/// Force over displacement: in the plane, or where nothing acts there, load over approach.
fn loading(increments: &[IncrementRecord]) -> LineFigure {
    // What rounding leaves of a force that is not there does not count.
    let acts = |i: &IncrementRecord| i.tangential_force_x.hypot(i.tangential_force_y) > 1e-8 * i.load;
    if increments.iter().any(acts) { pushing(increments) } else { pressing(increments) }
}

fn pressing(increments: &[IncrementRecord]) -> LineFigure {
    let points = increments.iter().map(|i| [i.approach, i.load]).collect();
    LineFigure {
        title: "load over approach".to_owned(),
        x: Axis::linear("approach", Unit::Length),
        y: Axis::linear("load", Unit::Force),
        right: None,
        series: vec![Series::new("loading", points, Mark::LineAndPoints)],
    }
}

/// Along the direction of the loading.
fn pushing(increments: &[IncrementRecord]) -> LineFigure {
    let [x, y] = direction(increments);
    let along = match [x, y] {
        [1.0, 0.0] => "along x".to_owned(),
        [0.0, 1.0] => "along y".to_owned(),
        _ => format!("along {:.1}° from x to y", y.atan2(x).to_degrees()).replace('-', "−"),
    };
    let points = std::iter::once([0.0, 0.0]).chain(increments.iter().map(|i| {
        [
            x * i.tangential_displacement_x + y * i.tangential_displacement_y,
            x * i.tangential_force_x + y * i.tangential_force_y,
        ]
    }));
    LineFigure {
        title: "tangential force over displacement".to_owned(),
        x: Axis::linear(format!("displacement of the upper body {along}"), Unit::Length),
        y: Axis::linear(format!("force {along}"), Unit::Force),
        right: None,
        series: vec![Series::new("loading", points.collect(), Mark::LineAndPoints)],
    }
}

/// The direction in which a contact is loaded: that of most of its force, signed towards +x, or towards +y where it lies
/// along y. Rounding decides neither the axis nor the sign: a force to and fro along x has the direction +x.
fn direction(increments: &[IncrementRecord]) -> [f64; 2] {
    let forces = || increments.iter().map(|i| [i.tangential_force_x, i.tangential_force_y]);
    // The principal axis of the forces, which has no sign yet.
    let [xx, yy, xy] = forces().fold([0.0; 3], |s, [x, y]| [s[0] + x * x, s[1] + y * y, s[2] + x * y]);
    let angle = 0.5 * (2.0 * xy).atan2(xx - yy);
    let (y, x) = angle.sin_cos();
    const ROUNDING: f64 = 1e-6;
    match [x, y] {
        [_, y] if y.abs() < ROUNDING => [1.0, 0.0],
        [x, _] if x.abs() < ROUNDING => [0.0, 1.0],
        [x, y] if x < 0.0 => [-x, -y],
        both => both,
    }
}

fn motion(results: &Results, passes: &[PassRecord], sheet: &mut Sheet<'_>) -> Outcome {
    let steps = results.steps()?;
    let first = results.fields_after(0)?;
    let last = results.fields_after(passes.len())?;
    let before = [Stored::read(&first, "lower")?, Stored::read(&first, "upper")?];
    let after = [Stored::read(&last, "lower")?, Stored::read(&last, "upper")?];
    let hardness = hardness(&last)?;

    // One scale for a body before and after, so that its change shows.
    let ranges = [0, 1].map(|body| Some(range(&[&before[body].field, &after[body].field])));
    let at_end = format!("after pass {}", passes.len());
    let bodies = [
        MapFigure { range: ranges[0], ..before[0].heights("lower body, before") },
        MapFigure { range: ranges[1], ..before[1].heights("upper body (underside), before") },
        MapFigure { range: ranges[0], ..after[0].heights(format!("lower body, {at_end}")) },
        MapFigure { range: ranges[1], ..after[1].heights(format!("upper body (underside), {at_end}")) },
    ];
    sheet.add("topographies.png", |path| draw::maps(path, &bodies, 2))?;
    let mean = [Stored::read(&last, "mean_pressure_lower")?, Stored::read(&last, "mean_pressure_upper")?];
    let means =
        [mean[0].pressure("mean pressure, lower body"), mean[1].pressure("mean pressure, upper body")];
    sheet.add("mean_pressure.png", |path| draw::maps(path, &means, 2))?;
    if hardness.is_finite() {
        plastic_depth(&before, &after, sheet)?;
    }
    pressures(&last, &steps, passes.len(), before[0].grid, hardness, sheet)?;
    sheet.add("load.png", |path| draw::lines(path, &over_positions(&steps, passes.len(), "load")))?;
    if steps.iter().any(|step| step.tangential_force != 0.0) {
        let force = over_positions(&steps, passes.len(), "friction force");
        sheet.add("friction.png", |path| draw::lines(path, &force))?;
    }
    sheet.add("contact_area.png", |path| {
        draw::lines(path, &over_positions(&steps, passes.len(), "real contact area"))
    })?;
    let roughness = roughness_over_passes(passes, &before);
    sheet.add("roughness.png", |path| draw::lines(path, &roughness))?;
    sheet.add("approach.png", |path| draw::lines(path, &approach_over_passes(passes)))?;
    Ok(())
}

/// Von Mises' stress on the section; the most stressed point is marked if it lies there.
fn subsurface(fields: &Fields, sheet: &mut Sheet<'_>) -> Outcome {
    let stored = fields.read("section_von_mises")?;
    let ([dx, dz], x) = ([stored.pitch[0], stored.pitch[1]], stored.origin[0]);
    let layers =
        stored.into_field().ok_or_else(|| Failure::usage("`section_von_mises` is not a section", None))?;
    // Values stand at depths, from the surface on: between them, lines.
    const FINER: usize = 4;
    let cells = [layers.nrows(), FINER * (layers.ncols() - 1)];
    let field = Field::from_shape_fn(cells, |(i, k)| {
        let part = ((k % FINER) as f64 + 0.5) / FINER as f64;
        (1.0 - part) * layers[[i, k / FINER]] + part * layers[[i, k / FINER + 1]]
    });
    let attributes = fields.attributes()?;
    let place = match (attributes.get("section"), attributes.get("position"), attributes.get("body")) {
        (Some(Attribute::Number(y)), Some(Attribute::Numbers(at)), Some(Attribute::Text(body))) => {
            Some((*y, at, body))
        }
        _ => None,
    };
    let (y, at, body) = place.ok_or_else(|| Failure::usage("it is not said where the section lies", None))?;
    let begin = x - 0.5 * dx;
    let figure = SectionFigure {
        title: format!("von Mises stress in the {body} body, y = {}", format(y, Dimension::Length)),
        field: &field,
        ends: [[begin, begin + cells[0] as f64 * dx], [0.0, (layers.ncols() - 1) as f64 * dz]],
        quantity: Quantity::new("von Mises stress", Unit::Pressure),
        mark: (at[1] == y).then(|| [at[0], at[2]]),
    };
    sheet.add("subsurface.png", |path| draw::section(path, &figure))?;
    Ok(())
}

/// Least and greatest value of some fields.
fn range(fields: &[&Field]) -> [f64; 2] {
    let values = fields.iter().flat_map(|field| field.iter());
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], z| [low.min(*z), high.max(*z)])
}

/// How deep each body has been flattened since the beginning.
fn plastic_depth(
    before: &[Stored; 2],
    after: &[Stored; 2],
    sheet: &mut Sheet<'_>,
) -> Result<(), draw::Error> {
    let depth = |field, body: usize| Stored { field, grid: before[body].grid, column: 0 };
    let lower = depth(&before[0].field - &after[0].field, 0);
    let upper = depth(&after[1].field - &before[1].field, 1);
    // One scale for both: a body that does not yield is then seen not to.
    let deepest = lower.field.iter().chain(&upper.field).copied().fold(f64::MIN_POSITIVE, f64::max);
    let maps = [(&lower, "lower body"), (&upper, "upper body")].map(|(depth, body)| MapFigure {
        range: Some([0.0, deepest]),
        ..depth.map(format!("plastic deformation, {body}"), "depth", Unit::Length, Colours::Pressure)
    });
    sheet.add("plastic.png", |path| draw::maps(path, &maps, 2))
}

/// Maps and an animation of the pressures that were kept of the last pass.
fn pressures(
    fields: &Fields,
    steps: &[StepRecord],
    pass: usize,
    lower: Grid,
    hardness: f64,
    sheet: &mut Sheet<'_>,
) -> Outcome {
    let names = fields.names()?;
    let kept: Vec<&StepRecord> =
        steps.iter().filter(|s| s.pass == pass && names.contains(&pressure_name(s.step))).collect();
    if kept.is_empty() {
        return Ok(());
    }
    let pressure = |step: &StepRecord| Stored::read(fields, &pressure_name(step.step));
    let range = [0.0, kept.iter().map(|s| s.max_pressure).fold(f64::MIN_POSITIVE, f64::max)];
    let shown: Vec<(String, Stored)> = (0..SHEET.min(kept.len()))
        .map(|k| {
            // The middles of equal parts of the pass: its very ends show next to nothing.
            let step = kept[(2 * k + 1) * kept.len() / (2 * SHEET.min(kept.len()))];
            let stored = pressure(step)?;
            let field = in_frame_of(&stored.field, stored.column, lower);
            let title = format!("position {}: {}", step.step, format(step.load, Dimension::Force));
            Ok((title, Stored { field, grid: lower, column: 0 }))
        })
        .collect::<Outcome<_>>()?;
    let maps: Vec<MapFigure> = shown
        .iter()
        .map(|(title, stored)| MapFigure { range: Some(range), ..stored.pressure(title) })
        .collect();
    sheet.add("pressure.png", |path| draw::maps(path, &maps, 3))?;
    let cap = Cap::read(fields)?;
    let shares: Vec<Stored> = shown.iter().map(|(_, stored)| stored.over(&cap)).collect();
    let contacts: Vec<MapFigure> = shown
        .iter()
        .zip(&shares)
        .map(|((title, _), share)| share.contact(title, hardness.is_finite()))
        .collect();
    sheet.add("contact.png", |path| draw::maps(path, &contacts, 3))?;
    let frames: Vec<(String, Field)> = kept
        .iter()
        .map(|step| {
            let stored = pressure(step)?;
            let title = format!("pass {pass}, position {}", step.step);
            Ok((title, in_frame_of(&stored.field, stored.column, lower)))
        })
        .collect::<Outcome<_>>()?;
    let animation = Animation {
        grid: &lower,
        quantity: Quantity::new("pressure", Unit::Pressure),
        colours: Colours::Pressure,
        range,
        delay: 12,
    };
    let frames = frames.iter().map(|(title, field)| Frame { title: title.clone(), field });
    sheet.add("pressure.gif", |path| draw::animation(path, &animation, frames))?;
    Ok(())
}

/// A field whose first column is the lower body's `first`, on that body's grid; what does not face the upper body is
/// undefined.
pub(crate) fn in_frame_of(field: &Field, first: usize, grid: Grid) -> Field {
    let mut framed = Field::from_elem(grid.shape, f64::NAN);
    for (column, values) in field.outer_iter().enumerate() {
        framed.row_mut((first + column) % grid.shape[0]).assign(&values);
    }
    framed
}

/// A quantity of the positions in the first, a middle and the last pass.
fn over_positions(steps: &[StepRecord], passes: usize, quantity: &str) -> LineFigure {
    let (unit, value): (Unit, fn(&StepRecord) -> f64) = match quantity {
        "load" => (Unit::Force, |s| s.load),
        "friction force" => (Unit::Force, |s| s.tangential_force.abs()),
        _ => (Unit::Area, |s| s.contact_area),
    };
    let mut shown = vec![1, passes.div_ceil(2), passes];
    shown.dedup();
    let series = shown.into_iter().map(|pass| {
        let points = steps.iter().filter(|s| s.pass == pass).map(|s| [s.offset, value(s)]).collect();
        Series::new(format!("pass {pass}"), points, Mark::Line)
    });
    LineFigure {
        title: format!("{quantity} over the positions"),
        x: Axis::linear("offset of the upper body", Unit::Length),
        y: Axis::linear(quantity, unit),
        right: None,
        series: series.collect(),
    }
}

fn roughness_over_passes(passes: &[PassRecord], before: &[Stored; 2]) -> LineFigure {
    let points = |body: usize, value: fn(&PassRecord) -> f64| {
        let first = [0.0, before[body].field.std(0.0)];
        std::iter::once(first).chain(passes.iter().map(|p| [p.pass as f64, value(p)])).collect()
    };
    LineFigure {
        title: "roughness over the passes".to_owned(),
        x: Axis::linear("pass", Unit::Number),
        y: Axis::linear("Sq", Unit::Length),
        right: None,
        series: vec![
            Series::new("lower body", points(0, |p| p.sq_lower), Mark::LineAndPoints),
            Series::new("upper body", points(1, |p| p.sq_upper), Mark::LineAndPoints),
        ],
    }
}

fn approach_over_passes(passes: &[PassRecord]) -> LineFigure {
    let points = |value: fn(&PassRecord) -> f64| passes.iter().map(|p| [p.pass as f64, value(p)]).collect();
    LineFigure {
        title: "approach and plastic volume over the passes".to_owned(),
        x: Axis::linear("pass", Unit::Number),
        y: Axis::linear("approach", Unit::Length),
        right: Some(Axis::linear("plastic volume in the pass", Unit::Volume)),
        series: vec![
            Series::new("approach", points(|p| p.approach), Mark::LineAndPoints),
            Series::new("lower body", points(|p| p.plastic_volume_lower), Mark::LineAndPoints).on_the_right(),
            Series::new("upper body", points(|p| p.plastic_volume_upper), Mark::LineAndPoints).on_the_right(),
        ],
    }
}

/// The largest pressure that a cell bears: below the hardness where shear softens what is plastic.
enum Cap {
    /// Of each cell.
    Field(Field),
    /// Of all cells.
    Number(f64),
}

impl Cap {
    /// The field `cap`, else the attribute `cap` of the file, else the hardness.
    fn read(fields: &Fields) -> Outcome<Self> {
        if fields.names()?.iter().any(|name| name == "cap") {
            return Ok(Self::Field(Stored::read(fields, "cap")?.field));
        }
        match fields.attributes()?.get("cap") {
            Some(Attribute::Number(cap)) => Ok(Self::Number(*cap)),
            _ => Ok(Self::Number(hardness(fields)?)),
        }
    }
}

fn hardness(fields: &Fields) -> Outcome<f64> {
    match fields.attributes()?.get("hardness") {
        Some(Attribute::Number(hardness)) => Ok(*hardness),
        _ => Ok(f64::INFINITY),
    }
}

#[cfg(test)]
mod tests;
