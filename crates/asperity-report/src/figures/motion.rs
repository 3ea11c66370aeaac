//! Figures of a motion: what it did to the bodies, its pressures, its course.

use asperity_base::{Field, Grid};
use asperity_contact::kernel::response;
use asperity_contact::motion::{PassRecord, PlasticUpdate, StepRecord};
use asperity_contact::operator::Operators;
use asperity_contact::with;
use asperity_study::io::fields::Fields;
use asperity_study::{Results, cap_name, pressure_name, temperature_name};
use asperity_surface::{FunctionalParameters, HeightParameters, Topography};

use super::pressure;
use super::profile::{OverlapFields, Profile, Row, most_loaded};
use super::sheet::Sheet;
use super::stored::{Cap, StoredArray, ends_with_tension, of_pressures, touched};
use super::surfaces;
use super::{course, force, rolling};
use crate::draw::{Axis, Chart, Charts, Colours, Maps, Mark, Series, Unit, range_of_heights};
use crate::error::Result;

/// Pressure maps on one sheet.
const SHEET: usize = 6;
/// Passes whose roughness is computed for its figure, at most.
const PARAMETERS: usize = 24;
/// Share of the largest change of a height, up to which what is left of differences of heights is their
/// rounding.
const ROUNDING: f64 = 1e-9;

/// Where the colours of pressures end: at the largest, or where a few cells stand out, at a percentile, which
/// is then said.
fn most_of(pressures: impl Iterator<Item = f64>) -> (f64, Option<&'static str>) {
    const SHARE: f64 = 0.98;
    let mut all: Vec<f64> = pressures.filter(|pressure| *pressure > 0.0).collect();
    all.sort_unstable_by(f64::total_cmp);
    let Some(largest) = all.last().copied() else { return (f64::MIN_POSITIVE, None) };
    let most = all[((all.len() - 1) as f64 * SHARE) as usize];
    if largest > 1.5 * most {
        (most, Some("colours end at the percentile 98 % of the cells in contact"))
    } else {
        (largest, None)
    }
}

/// Draws them, and says of what load and pass the last are.
pub(super) fn draw(results: &Results, passes: &[PassRecord], sheet: &mut Sheet) -> Result<String> {
    let steps = results.steps()?;
    let pass = passes.len();
    let done = course::done(passes);
    let [first, last] = [results.fields_after(0)?, results.fields_after(pass)?];
    let before = [StoredArray::read(&first, "lower")?, StoredArray::read(&first, "upper")?];
    let after = [StoredArray::read(&last, "lower")?, StoredArray::read(&last, "upper")?];
    let cap = Cap::read(&last)?;
    let load = |record: &PassRecord| format!("mean load {}", force(record.mean_load));
    let all = done[pass];
    let of = format!("{}, pass {all}", load(&passes[pass - 1]));
    let throughout = match pass {
        1 => of.clone(),
        _ => format!("{}, passes 1 to {all}", load(&passes[0])),
    };
    let after_pass = format!("{}, after pass {all}", load(&passes[pass - 1]));
    let is_fresh = course::has_new_upper(&results.case()?, pass);

    sheet.add("topographies", "topographies before and after", &throughout, || {
        Ok(topographies(&before, &after, all, is_fresh))
    })?;
    for (name, title, body) in [
        ("relief_lower", "lower body in perspective", &after[0]),
        ("relief_upper", "upper body in perspective, underside", &after[1]),
    ] {
        if !body.relief().is_flat() {
            sheet.add(name, title, &after_pass, || Ok(body.relief()))?;
        }
    }
    sheet.add_dear(&surfaces::NAMES, &throughout, || {
        Ok(surfaces::curves(&surfaces::as_measured(&before)?, Some(&surfaces::as_measured(&after)?)))
    })?;
    let mean =
        [StoredArray::read(&last, "mean_pressure_lower")?, StoredArray::read(&last, "mean_pressure_upper")?];
    sheet.add("mean_pressure", "mean pressure over the pass", &of, || {
        let (largest, remark) = most_of(mean.iter().flat_map(|mean| mean.field.iter().copied()));
        let maps = [(&mean[0], "on the lower body"), (&mean[1], "on the upper body")];
        let least = mean.iter().flat_map(|mean| mean.field.iter().copied()).fold(0.0, f64::min);
        let range = ends_with_tension([least, largest]).unwrap_or([0.0, largest]);
        let maps = Maps::new(maps.map(|(mean, title)| mean.pressure_within(title, range)).into());
        Ok(remark.into_iter().fold(maps, Maps::remark))
    })?;
    let mut kept = Vec::new();
    for of_law in with::kept().into_iter().filter(|kept| kept.map.is_some()) {
        if let Some(fields) = of_bodies(&last, of_law.state, &before)? {
            kept.push((of_law, fields));
        }
    }
    if !kept.is_empty() {
        // Material upwards on both sides.
        let mut changes = vec![
            before[0].with(&after[0].field - &before[0].field),
            before[1].with(&before[1].field - &after[1].field),
        ];
        changes.truncate(if is_fresh { 1 } else { 2 });
        sheet
            .add("lost", "change of height since the beginning", &throughout, || Ok(changes_of(&changes)))?;
    }
    if cap.is_finite() {
        // What other laws have not taken, but for the rounding of the heights.
        let flown = |body: usize, lost: Field| {
            let rounding = ROUNDING * lost.iter().fold(0.0, |most: f64, depth| most.max(depth.abs()));
            let flown = kept.iter().fold(lost, |lost, (of, fields)| lost + of.raises * &fields[body].field);
            before[body].with(flown.mapv_into(|depth| if depth.abs() < rounding { 0.0 } else { -depth }))
        };
        let mut changes =
            vec![flown(0, &before[0].field - &after[0].field), flown(1, &after[1].field - &before[1].field)];
        changes.truncate(if is_fresh { 1 } else { 2 });
        sheet.add("plastic", "change of height by plastic flow since the beginning", &throughout, || {
            Ok(changes_of(&changes))
        })?;
    }
    for (of_law, fields) in &kept {
        let Some(map) = of_law.map else { continue };
        let title = if is_fresh { map.of_fresh } else { map.title };
        let of = if of_law.raises < 0.0 { &throughout } else { &after_pass };
        sheet.add(of_law.state, title, of, || Ok(on_bodies(fields, map.quantity)))?;
    }
    pressures(results, &last, &steps, [pass, all], before[0].grid, &cap, &of, sheet)?;
    if let Some(curves) = rolling::curves(passes) {
        sheet.add_curves(curves, &throughout)?;
    }
    let sq = before.each_ref().map(|body| body.field.std(0.0));
    for curves in course::solution(&steps, &[], &done) {
        sheet.add_curves(curves, &throughout)?;
    }
    for curves in course::curves(passes, &steps, sq) {
        sheet.add_curves(curves, &throughout)?;
    }
    sheet.add("parameters", "surface parameters over the passes, material upwards", &throughout, || {
        parameters(results, &done)
    })?;
    Ok(of)
}

/// Both bodies before and after, each on one scale, so that its change shows.
fn topographies<'a>(
    before: &'a [StoredArray; 2],
    after: &'a [StoredArray; 2],
    pass: usize,
    is_fresh: bool,
) -> Maps<'a> {
    let at_end = format!("after pass {pass}");
    let upper_before = if is_fresh {
        "upper body of the first pass, underside, before"
    } else {
        "upper body, underside, before"
    };
    let mut remarks = Vec::new();
    let ranges = [0, 1].map(|body| {
        let (range, remark) = range_of_heights([&before[body].field, &after[body].field])?;
        remarks.extend(remark);
        Some(range)
    });
    let map = |stored: &'a StoredArray, title: String, body: usize| {
        let map = stored.heights(title);
        match ranges[body] {
            Some(range) => map.range(range),
            None => map,
        }
    };
    let maps = vec![
        map(&before[0], "lower body, before".to_owned(), 0),
        map(&before[1], upper_before.to_owned(), 1),
        map(&after[0], format!("lower body, {at_end}"), 0),
        map(&after[1], format!("upper body, underside, {at_end}"), 1),
    ];
    remarks.into_iter().fold(Maps::new(maps), Maps::remark)
}

/// What a law keeps of both bodies under the name of a state, 0 on one of which it keeps nothing; none if on
/// neither.
fn of_bodies(fields: &Fields, state: &str, bodies: &[StoredArray; 2]) -> Result<Option<[StoredArray; 2]>> {
    let names = fields.names()?;
    let read = |body: usize| {
        let name = format!("{state}_{}", ["lower", "upper"][body]);
        if names.contains(&name) {
            StoredArray::read(fields, &name)
        } else {
            Ok(bodies[body].with(Field::zeros(bodies[body].field.raw_dim())))
        }
    };
    let known = ["lower", "upper"].iter().any(|body| names.contains(&format!("{state}_{body}")));
    if known { Ok(Some([read(0)?, read(1)?])) } else { Ok(None) }
}

/// Changes of height on one scale about zero, of the bodies that have changed; of the lower one where none
/// has.
fn changes_of(changes: &[StoredArray]) -> Maps<'_> {
    let size =
        |stored: &StoredArray| stored.field.iter().fold(0.0, |most: f64, change| most.max(change.abs()));
    let largest = changes.iter().map(size).fold(f64::MIN_POSITIVE, f64::max);
    let map = |(stored, body)| {
        let map = StoredArray::map(stored, body, "change of height", Unit::Length, Colours::Signed);
        map.range([-largest, largest])
    };
    let bodies = || changes.iter().zip(["lower body", "upper body"]);
    let maps: Vec<_> = bodies().filter(|(stored, _)| size(stored) > 0.0).map(map).collect();
    Maps::new(if maps.is_empty() { bodies().take(1).map(map).collect() } else { maps })
}

/// A length on each body, on one scale: a body on which there is none is then seen to have none.
fn on_bodies<'a>(fields: &'a [StoredArray], quantity: &'a str) -> Maps<'a> {
    let largest = fields.iter().flat_map(|field| &field.field).copied().fold(f64::MIN_POSITIVE, f64::max);
    let map = |(field, body): (&'a StoredArray, &str)| {
        field.map(body, quantity, Unit::Length, Colours::Pressure).range([0.0, largest])
    };
    Maps::new(fields.iter().zip(["lower body", "upper body"]).map(map).collect())
}

/// The pressures that were kept of the last pass: maps, an animation, their distribution, a section.
#[expect(clippy::too_many_arguments, reason = "all of them are what a pass left")]
fn pressures(
    results: &Results,
    fields: &Fields,
    steps: &[StepRecord],
    [pass, done]: [usize; 2],
    lower: Grid,
    cap: &Cap,
    of: &str,
    sheet: &mut Sheet,
) -> Result {
    let names = fields.names()?;
    let kept: Vec<&StepRecord> =
        steps.iter().filter(|s| s.pass == pass && names.contains(&pressure_name(s.step))).collect();
    let largest = kept.iter().map(|step| step.max_pressure).fold(0.0, f64::max);
    // Of the positions where pressures come to the hardness that of the largest load.
    let loaded = kept.iter().filter(|step| step.max_pressure >= largest * (1.0 - 1e-6));
    let Some(most) = loaded.max_by(|a, b| a.load.total_cmp(&b.load)) else { return Ok(()) };
    let read = |step: &StepRecord| StoredArray::read(fields, &pressure_name(step.step));
    // With tension in the cells in contact, whose least is that of the open ones, too.
    let least = kept.iter().filter_map(|step| step.interface).map(|record| record.min_pressure);
    let range = ends_with_tension([least.fold(0.0, f64::min), largest])
        .unwrap_or([0.0, largest.max(f64::MIN_POSITIVE)]);
    let number = SHEET.min(kept.len());
    // The middles of equal parts of the pass: its very ends show next to nothing.
    let middles: Vec<&StepRecord> =
        (0..number).map(|k| kept[(2 * k + 1) * kept.len() / (2 * number)]).collect();
    let caps: Vec<Cap> = middles
        .iter()
        .map(|step| {
            if names.contains(&cap_name(step.step)) {
                Ok(Cap::Field(StoredArray::read(fields, &cap_name(step.step))?.framed(lower).field))
            } else {
                Cap::read(fields)
            }
        })
        .collect::<Result<_>>()?;
    let shown: Vec<(String, StoredArray)> = middles
        .iter()
        .map(|step| {
            let title = format!("position {}: {}", step.step, force(step.load));
            Ok((title, read(step)?.framed(lower)))
        })
        .collect::<Result<_>>()?;
    sheet.add("pressure", "pressure on the lower body", of, || {
        Ok(Maps::new(shown.iter().map(|(title, stored)| stored.pressure_within(title, range)).collect()))
    })?;
    if middles.iter().any(|step| names.contains(&temperature_name(step.step))) {
        let temperatures: Vec<StoredArray> = middles
            .iter()
            .map(|step| Ok(StoredArray::read(fields, &temperature_name(step.step))?.celsius().framed(lower)))
            .collect::<Result<_>>()?;
        let known =
            || temperatures.iter().flat_map(|stored| &stored.field).copied().filter(|t| t.is_finite());
        let warm = [f64::min, f64::max].map(|pick| known().fold(f64::NAN, pick));
        sheet.add("temperature", "temperature of the contact", of, || {
            let maps = temperatures.iter().zip(&shown).map(|(stored, (title, _))| {
                stored
                    .map(title, "temperature", Unit::Of("°C"), Colours::Between)
                    .range(warm)
                    .missing("no contact")
            });
            Ok(Maps::new(maps.collect()))
        })?;
    }
    let contacts: Vec<StoredArray> =
        shown.iter().zip(&caps).map(|((_, stored), cap)| stored.contact(cap)).collect();
    sheet.add("contact", "contact on the lower body", of, || {
        let titled = contacts.iter().zip(&shown).map(|(contact, (title, _))| (contact, title));
        let maps = titled.map(|(contact, title)| contact.map(title, "", Unit::Number, cap.colours()));
        Ok(Maps::new(maps.map(|map| map.missing("outside the overlap")).collect()))
    })?;
    let frames: Vec<StoredArray> =
        kept.iter().map(|step| Ok(read(step)?.framed(lower))).collect::<Result<_>>()?;
    sheet.add("pressure_histogram", "distribution of the pressure over the contact", of, || {
        Ok(pressure::histogram(frames.iter().map(|stored| &stored.field), &caps[0]))
    })?;
    sheet.animate("pressure", "pressure on the lower body", of_pressures(range), || {
        let words = kept.iter().map(|step| {
            let load = force(step.load);
            format!("pass {done}, position {}, load {load}", step.step)
        });
        let maps = frames.iter().map(|stored| Maps::new(vec![stored.pressure_within("", range)]));
        Ok(words.zip(maps).collect())
    })?;
    if let Some(profile) = section(results, &read(most)?, most)? {
        let of = format!("{of}, position {}", most.step);
        sheet.add("profile", "section through the most loaded spot", &of, || Ok(profile.charts()))?;
    }
    Ok(())
}

/// The section at a position, where what its pressure displaces is known: the surfaces that met there are
/// those after the pass before, unless they yielded from step to step, and shear displaces nothing normally,
/// unless bodies are dissimilar.
fn section(results: &Results, pressure: &StoredArray, step: &StepRecord) -> Result<Option<Profile>> {
    let case = results.case()?;
    let bodies = response(&case.lower.material, &case.upper.material)?;
    let couples = bodies.coupled().is_some_and(|coupled| coupled.couples());
    let yields = case.lower.hardness.yields() || case.upper.hardness.yields();
    let step_by_step =
        yields && case.motion.is_some_and(|motion| motion.plastic_update == PlasticUpdate::Step);
    let unknown = course::has_new_upper(&case, step.pass);
    if step_by_step || unknown || (case.friction.is_some() && couples) {
        return Ok(None);
    }
    let [below, above] = results.surfaces_after(step.pass - 1)?;
    let shape = pressure.grid.shape;
    let columns = below.heights().nrows().min(above.heights().nrows());
    let largest = Grid { shape: [columns, shape[1]], ..pressure.grid };
    let mut displacement = Field::zeros(shape);
    Operators::new(largest, bodies, case.contact.boundary)
        .on(shape)
        .apply(&pressure.field, &mut displacement);
    // Between two columns a surface is between their heights.
    let facing = |body: &Topography, first: f64, across: usize| {
        let (columns, here) = (body.heights().nrows() as isize, first.floor());
        let height = |i: isize, j: usize| {
            let j = (j + shape[1] - across) % shape[1];
            body.heights()[[i.rem_euclid(columns) as usize, j]]
        };
        Field::from_shape_fn(shape, |(i, j)| {
            let i = here as isize + i as isize;
            height(i, j) + (first - here) * (height(i + 1, j) - height(i, j))
        })
    };
    let [dx, dy] = pressure.grid.pitch;
    let across = (step.offset_y.unwrap_or(0.0) / dy).round() as usize;
    let below = facing(&below, pressure.place, 0);
    let above = facing(&above, pressure.place - step.offset / dx, across);
    // What is left of the interference where they touch.
    let mut plastic = &below - &above - &displacement + step.approach;
    plastic.zip_mut_with(&pressure.field, |w, p| *w = if *p > 0.0 { w.max(0.0) } else { 0.0 });
    let touching = touched(&pressure.field);
    let Some(spot) = most_loaded(&pressure.field, &touching) else { return Ok(None) };
    let row = |field: &'_ Field| field.column(spot[1]).to_owned();
    let [lower, upper, yielded] = [&below, &above, &plastic].map(row);
    let facing = OverlapFields {
        touching: &touching,
        pressure: &pressure.field,
        row: Row { lower: lower.view(), upper: upper.view(), plastic: yielded.view() },
        displacement: &displacement,
        is_plastic: plastic.iter().any(|w| *w > 0.0),
        approach: step.approach,
        pitch: pressure.grid.pitch,
        column: pressure.column,
    };
    Profile::through(&facing, spot, &case)
}

/// Sa, Sq, Ssk, Sk, Spk and Svk of both bodies.
fn parameters(results: &Results, done: &[usize]) -> Result<Charts> {
    let passes = done.len() - 1;
    let every = passes.div_ceil(PARAMETERS);
    let mut shown: Vec<usize> = (0..=passes).step_by(every).collect();
    if shown.last() != Some(&passes) {
        shown.push(passes);
    }
    const NAMES: [&str; 6] = ["Sa", "Sq", "Ssk", "Sk", "Spk", "Svk"];
    // Of each parameter and body.
    let mut curves: [[Vec<[f64; 2]>; 2]; 6] = Default::default();
    for pass in shown {
        let [lower, upper] = results.surfaces_after(pass)?;
        // The height of an underside turned over is that of the surface as it was measured.
        for (body, surface) in [lower, upper.underside()].iter().enumerate() {
            let (height, core) = (HeightParameters::new(surface), FunctionalParameters::new(surface));
            let values = [height.sa, height.sq, height.ssk, core.sk, core.spk, core.svk];
            for (curve, value) in curves.iter_mut().zip(values) {
                curve[body].push([done[pass] as f64, value]);
            }
        }
    }
    let chart = |(name, [lower, upper]): (&str, [Vec<[f64; 2]>; 2])| {
        let unit = if name == "Ssk" { Unit::Number } else { Unit::Length };
        let series = vec![
            Series::new("lower body", lower, Mark::LineAndPoints),
            Series::new("upper body", upper, Mark::LineAndPoints),
        ];
        Chart::new("", Axis::linear("pass", Unit::Count), Axis::linear(name, unit), series)
    };
    Ok(Charts { charts: NAMES.into_iter().zip(curves).map(chart).collect(), columns: 3, aspect: 0.8 })
}
