//! The contact: maps over the kept positions and passes, with where both bodies are.

use asperity_base::Field;
use asperity_base::units::{Dimension, format};
use asperity_contact::motion::{IncrementRecord, StepRecord, StepRow, Strategy, SweepRecord};
use asperity_contact::with::answering_rank;
use asperity_study::io::fields::Fields;
use asperity_study::io::fs;
use asperity_study::{cap_name, pressure_name, temperature_name};
use rayon::prelude::*;
use serde_json::{Map, Value, json};

use super::bodies::has_rest;
use super::curves;
use super::html::{escaped, minus};
use super::layers::{Kind, LAYERS, levels_of};
use super::page_data::PageData;
use super::quantised::{self, QuantisedField};
use super::table::evenly;
use crate::draw::{Charts, Colours};
use crate::error::Result;
use crate::figures::{self, Cap, Curves, StoredArray};
use crate::words::captions;

/// Bytes that all maps of a page take together, at most.
const MAX_BYTES: usize = 11 << 18;
/// Passes whose positions are shown, at most.
const MAX_PASSES: usize = 20;
/// Positions that a pass shows at least, before passes are left out.
const MIN_POSITIONS: usize = 24;

/// One position, point or contact at rest.
struct Frame {
    /// Number of its pass among those shown.
    group: usize,
    /// What it is, in a few words.
    label: String,
    /// Its numbers.
    text: String,
    /// Where the upper body's corner is, seen from the lower one's, m.
    offset: f64,
    /// How far it is displaced along y, cyclically, m.
    across: f64,
    approach: f64,
    /// Cells in contact at the edge of the lower body's map, where a periodic map is cut.
    seam: usize,
    /// Its place on the force–distance curve, if there is one.
    mark: Option<[f64; 2]>,
    /// Largest for the frame that the answers describe, see [`answering_rank`].
    rank: Option<f64>,
    fields: Vec<(&'static str, StoredArray)>,
}

/// A frame as it goes onto the page.
struct PageFrame {
    about: Value,
    maps: Vec<(&'static str, QuantisedField)>,
}

/// The section, and the data that it shows.
pub(super) fn section(found: &mut PageData, data: &mut Value, charts: &mut Vec<Value>) -> Option<String> {
    if found.moves() {
        return of_motion(found, data, charts);
    }
    let groups = vec![json!({ "label": "" })];
    if let Some(frames) = of_increments(found) {
        let begin = answering(&frames);
        let html = SCRUBBER.to_owned() + &blocks(&frames);
        data["contact"] = shown(&all_packed(frames), groups);
        data["contact"]["begin"] = begin.into();
        data["contact"]["steps"] = "increment".into();
        return Some(html);
    }
    if let Some((maps, block)) = found.take_maps() {
        let approach = found.ok_or_note(
            found.results.static_fields().map_err(Into::into).and_then(|f| figures::approach(&f)),
        )?;
        let frame = Frame { approach, ..Frame::at_rest() };
        let mut html = SCRUBBER.to_owned() + &in_blocks(block, false);
        data["contact"] = shown(&[frame.with_maps(maps)], groups);
        let profile = found.take_profile();
        html += &section_of(profile, "", charts);
        return Some(html);
    }
    let frames = if found.points.is_empty() { of_rest(found)? } else { of_sweep(found) };
    if frames.is_empty() {
        return None;
    }
    let mut html = SCRUBBER.to_owned() + &blocks(&frames);
    let begin = answering(&frames);
    data["contact"] = shown(&all_packed(frames), groups);
    if !found.points.is_empty() {
        data["contact"]["begin"] = begin.into();
    }
    if has_rest(found.results)
        && let Some(fields) = found.ok_or_note(found.results.static_fields())
        && let Some(profile) = found.ok_or_note(figures::profile_at_rest(&fields, &found.case))
    {
        let of = match found.points.len() {
            0 => String::new(),
            points => format!(", {}", point_of(points, points)),
        };
        html += &section_of(profile, &of, charts);
    }
    Some(html)
}

/// HTML with places for the section through the most loaded spot, `of` a point.
fn section_of(profile: Option<Charts>, of: &str, charts: &mut Vec<Value>) -> String {
    if let Some(profile) = profile {
        let caption = captions::find("profile").unwrap_or_default();
        let charts_of = Curves { charts: profile, name: "profile", title: String::new(), caption };
        let places = curves::html(vec![charts_of], charts);
        if !places.is_empty() {
            return format!("<h3>Section through the most loaded spot{of}</h3>{places}");
        }
    }
    String::new()
}

/// That large fields are shown in blocks, and how.
fn blocks(frames: &[Frame]) -> String {
    let block = frames.iter().map(|frame| quantised::block(frame.pressure())).max().unwrap_or(1);
    in_blocks(block, frames.iter().any(Frame::pulls))
}

fn in_blocks(block: usize, pulls: bool) -> String {
    let shown = if pulls {
        "pressures and gaps by their mean"
    } else {
        "of each the largest pressure, gaps by their mean"
    };
    match block {
        0 | 1 => String::new(),
        block => format!(
            "<p class=\"remark\">Shown in blocks of {block} × {block} cells, {shown}. The files hold all.</p>"
        ),
    }
}

/// Where the maps are drawn.
const SCRUBBER: &str = "<div id=\"scrubber\"></div>";

fn of_motion(found: &mut PageData, data: &mut Value, charts: &mut Vec<Value>) -> Option<String> {
    let last = found.passes.len();
    if last == 0 {
        return None;
    }
    if found.case.output.pressure_every == 0 {
        let why = "No pressures were kept: <code>pressure_every = 0</code> in <code>[output]</code>.";
        return Some(format!("<p>{why}</p>"));
    }
    let fields = found.fields(found.results.fields_after(last))?;
    let names = found.ok_or_note(fields.names())?;
    let is_kept = |step: &&StepRecord| names.contains(&pressure_name(step.step));
    let kept: Vec<usize> =
        found.steps.iter().filter(|s| s.pass == last).filter(is_kept).map(|s| s.step).collect();
    if kept.is_empty() {
        return None;
    }
    let (passes, positions) = affordable(found, &fields, &kept);
    let mut frames = Vec::new();
    let mut groups = Vec::new();
    let mut histogram = None;
    let mut remark = String::new();
    for pass in passes {
        let opened = if pass == last { None } else { Some(found.fields(found.results.fields_after(pass))) };
        let Some(fields) = opened.as_ref().map_or(Some(&fields), Option::as_ref) else { continue };
        let read = read_pass(found, fields, pass, &positions, groups.len());
        let Some(read) = found.ok_or_note(read) else { continue };
        if pass == last {
            let cap = found.ok_or_note(Cap::read(fields))?;
            histogram = Some(figures::histogram(read.iter().map(Frame::pressure), &cap));
        }
        remark = blocks(&read);
        frames.extend(all_packed(read));
        groups.push(json!({
            "label": format!("pass {}", found.done[pass]),
            "changes": found.ok_or_note(changes_before(found, pass)),
            "known": !figures::has_new_upper(&found.case, pass),
        }));
    }
    let count = groups.len();
    data["contact"] = shown(&frames, groups);
    data["contact"]["wraps"] =
        found.case.motion.is_some_and(|motion| motion.strategy() != Strategy::Overlap).into();
    let mut html = SCRUBBER.to_owned() + &remark;
    if count < last || positions.len() < kept.len() {
        html += &format!(
            "<p class=\"remark\">Shown: {} of {} kept positions of {count} of {last} passes, evenly chosen, so that \
             this page stays small. The files hold all.</p>",
            positions.len(),
            kept.len(),
        );
    }
    let title = format!("distribution of the pressure over the contact, pass {}", found.done[last]);
    let caption = captions::find("pressure_histogram").unwrap_or_default();
    let histogram = histogram.map(|charts| Curves { name: "pressure_histogram", title, caption, charts });
    html += &curves::html(histogram.into_iter().collect(), charts);
    Some(html)
}

/// The passes, and the positions of each, whose maps have room, evenly chosen; the last pass among them.
fn affordable(found: &PageData, fields: &Fields, kept: &[usize]) -> (Vec<usize>, Vec<usize>) {
    let samples = evenly(kept.len(), 6);
    let size = |at: &usize| {
        let stored = StoredArray::read(fields, &pressure_name(kept[*at])).ok()?;
        let packed = if stored.field.iter().any(|p| *p < 0.0) {
            QuantisedField::even(&stored.field, stored.grid.pitch)
        } else {
            QuantisedField::positive(&stored.field, stored.grid.pitch)
        };
        Some(packed.size())
    };
    let sizes: Vec<usize> = samples.iter().filter_map(size).collect();
    // What is elastic and what is plastic takes some more, and so do words.
    let each = 1.3 * sizes.iter().sum::<usize>() as f64 / sizes.len().max(1) as f64 + 600.0;
    let last = found.passes.len();
    let changes = changes_before(found, last).ok().flatten();
    let changes = changes.iter().flatten().map(|change| change.size() as f64).sum::<f64>();
    let least = MIN_POSITIONS.min(kept.len());
    let room = MAX_BYTES as f64;
    let passes = last.min(MAX_PASSES).min((room / (least as f64 * each + changes)) as usize).max(1);
    let positions = kept.len().min(((room / passes as f64 - changes) / each) as usize).max(1);
    let passes = evenly(last, passes).into_iter().map(|index| index + 1).collect();
    (passes, evenly(kept.len(), positions).into_iter().map(|index| kept[index]).collect())
}

fn read_pass(
    found: &PageData,
    fields: &Fields,
    pass: usize,
    positions: &[usize],
    group: usize,
) -> Result<Vec<Frame>> {
    let names = fields.names()?;
    let cap = Cap::read(fields)?;
    let columns = found.results.surfaces_after(0)?[0].grid().shape[0];
    let of_pass = || found.steps.iter().filter(|step| step.pass == pass);
    let all = of_pass().count();
    let frame = |step: &StepRecord| -> Result<Frame> {
        let pressure = StoredArray::read(fields, &pressure_name(step.step))?;
        let own = if names.contains(&cap_name(step.step)) {
            Some(Cap::Field(StoredArray::read(fields, &cap_name(step.step))?.field))
        } else {
            None
        };
        let contact = pressure.contact(own.as_ref().unwrap_or(&cap));
        let seam = cut_by_the_edge(&pressure, columns);
        let mut maps = vec![("pressure", pressure), ("contact", contact)];
        if names.contains(&temperature_name(step.step)) {
            maps.extend(temperature(StoredArray::read(fields, &temperature_name(step.step))?));
        }
        Ok(Frame {
            group,
            label: format!("position {} of {all}", step.step),
            text: of_step(step),
            offset: step.offset,
            across: step.offset_y.unwrap_or(0.0),
            approach: step.approach,
            seam,
            mark: None,
            rank: None,
            fields: maps,
        })
    };
    of_pass()
        .filter(|step| positions.contains(&step.step) && names.contains(&pressure_name(step.step)))
        .map(frame)
        .collect()
}

/// Cells in contact in the first and the last of the lower body's columns.
fn cut_by_the_edge(pressure: &StoredArray, columns: usize) -> usize {
    let first = pressure.place.round() as usize % columns;
    let of_column = |lower: usize| {
        let own = (lower + columns - first) % columns;
        let cells = pressure.field.outer_iter().nth(own);
        cells.map_or(0, |cells| cells.iter().filter(|p| p.abs() > 0.0).count())
    };
    of_column(0) + of_column(columns - 1)
}

/// The map of a temperature; none where nothing touches.
fn temperature(stored: StoredArray) -> Option<(&'static str, StoredArray)> {
    stored.field.iter().any(|kelvin| kelvin.is_finite()).then(|| ("temperature", stored.celsius()))
}

fn of_step(step: &StepRecord) -> String {
    let mut text = format!(
        "offset {}, load {}, real contact {}, largest pressure {}",
        format(step.offset, Dimension::Length),
        format(step.load, Dimension::Force),
        format(step.contact_area, Dimension::Area),
        format(step.max_pressure, Dimension::Pressure),
    );
    if step.tangential_force != 0.0 {
        text += &format!(", friction {}", format(step.tangential_force.abs(), Dimension::Force));
    }
    text
}

/// Change of height of both bodies before a pass, material upwards; none before the first, and of a
/// counter-body that is new in each.
fn changes_before(found: &PageData, pass: usize) -> asperity_base::Result<Option<[QuantisedField; 2]>> {
    if pass == 1 || figures::has_new_upper(&found.case, pass) {
        return Ok(None);
    }
    let [before, now] = [found.results.surfaces_after(0)?, found.results.surfaces_after(pass - 1)?];
    let change = |body: usize, sign: f64| {
        let change = sign * (now[body].heights() - before[body].heights());
        QuantisedField::even(&change, before[body].grid().pitch)
    };
    Ok(Some([change(0, 1.0), change(1, -1.0)]))
}

fn point_of(point: usize, points: usize) -> String {
    format!("point {point} of {points}")
}

/// The points of a sweep that are kept, and its last one, whose contact the answers describe unless another
/// one ranks above.
fn of_sweep(found: &mut PageData) -> Vec<Frame> {
    let mut frames = Vec::new();
    let points: Vec<SweepRecord> = found.points.clone();
    let is_kept = |point: usize| fs::exists(found.results.point_path(point));
    let has_last = has_rest(found.results);
    let is_there = |point: &&SweepRecord| is_kept(point.point) || has_last && point.point == points.len();
    let kept: Vec<&SweepRecord> = points.iter().filter(is_there).collect();
    for point in chosen(&kept, |point| answering_rank(StepRow::Point(point))) {
        let opened = if fs::exists(found.results.point_path(point.point)) {
            found.results.point_fields(point.point)
        } else {
            found.results.static_fields()
        };
        let Some(fields) = found.fields(opened) else { continue };
        let Some(maps) = found.ok_or_note(at_rest(&fields)) else { continue };
        frames.push(Frame {
            group: 0,
            label: point_of(point.point, points.len()),
            text: format!(
                "{}load {}, real contact {}, largest pressure {}",
                point
                    .speed
                    .map_or(String::new(), |speed| format!("speed {}, ", format(speed, Dimension::Speed))),
                format(point.load, Dimension::Force),
                format(point.contact_area, Dimension::Area),
                format(point.max_pressure, Dimension::Pressure)
            ),
            offset: 0.0,
            across: 0.0,
            approach: point.approach,
            seam: 0,
            mark: None,
            rank: answering_rank(StepRow::Point(point)),
            fields: maps,
        });
    }
    frames
}

/// The steps that have room on a page, evenly chosen, with the one that ranks highest.
fn chosen<'a, T>(kept: &[&'a T], rank: impl Fn(&T) -> Option<f64>) -> Vec<&'a T> {
    let mut chosen = evenly(kept.len(), MAX_BYTES >> 16);
    chosen.extend(highest(kept.iter().map(|step| rank(step))));
    chosen.sort_unstable();
    chosen.dedup();
    chosen.into_iter().map(|index| kept[index]).collect()
}

/// The frame that the answers describe: that of the highest rank, or the last one.
fn answering(frames: &[Frame]) -> usize {
    highest(frames.iter().map(|frame| frame.rank)).unwrap_or(frames.len().saturating_sub(1))
}

/// The index of the highest of some ranks.
fn highest(ranks: impl Iterator<Item = Option<f64>>) -> Option<usize> {
    let ranked = ranks.enumerate().filter_map(|(index, rank)| Some((index, rank?)));
    ranked.max_by(|one, other| one.1.total_cmp(&other.1)).map(|(index, _)| index)
}

/// The increments that are kept of bodies that are no hard walls to each other, each with its place on the
/// force–distance curve; `None` if none is.
fn of_increments(found: &mut PageData) -> Option<Vec<Frame>> {
    (!found.case.interface.is_empty()).then_some(())?;
    let increments = found.increments.clone();
    let kept: Vec<&IncrementRecord> =
        increments.iter().filter(|each| fs::exists(found.results.increment_path(each.increment))).collect();
    let mut frames = Vec::new();
    for increment in chosen(&kept, |increment| answering_rank(StepRow::Increment(increment))) {
        let opened = found.results.increment_fields(increment.increment);
        let Some(fields) = found.fields(opened) else { continue };
        let Some(maps) = found.ok_or_note(at_rest(&fields)) else { continue };
        frames.push(Frame {
            label: format!("increment {} of {}", increment.increment, increments.len()),
            text: format!(
                "distance {}, load {}, real contact {}",
                format(-increment.approach, Dimension::Length),
                format(increment.load, Dimension::Force),
                format(increment.contact_area, Dimension::Area)
            ),
            approach: increment.approach,
            mark: Some([-increment.approach, increment.load]),
            rank: answering_rank(StepRow::Increment(increment)),
            fields: maps,
            ..Frame::at_rest()
        });
    }
    (!frames.is_empty()).then_some(frames)
}

fn of_rest(found: &mut PageData) -> Option<Vec<Frame>> {
    if !has_rest(found.results) {
        return None;
    }
    let fields = found.fields(found.results.static_fields())?;
    let maps = found.ok_or_note(at_rest(&fields))?;
    let approach = found.ok_or_note(figures::approach(&fields))?;
    Some(vec![Frame { approach, fields: maps, ..Frame::at_rest() }])
}

/// What there is of a static contact, or of a point of a sweep.
fn at_rest(fields: &Fields) -> Result<Vec<(&'static str, StoredArray)>> {
    let names = fields.names()?;
    let has = |name: &str| names.iter().any(|other| other == name);
    let read = |name: &str| StoredArray::read(fields, name);
    let pressure = read("pressure")?;
    let mut maps = Vec::new();
    let cap = Cap::read(fields)?;
    let touching = StoredArray::touching(fields, &pressure)?;
    let contact = pressure.contact_on(&touching, &cap);
    if has("traction_x") && has("stick") {
        let size = |x: &str, y: &str| -> Result<StoredArray> {
            let (x, y) = (read(x)?, read(y)?);
            let mut size = x.field.clone();
            size.zip_mut_with(&y.field, |x, y| *x = x.hypot(*y));
            Ok(x.with(size))
        };
        maps.push(("shear", size("traction_x", "traction_y")?));
        maps.push(("stick", figures::stick(&pressure, read("stick")?)));
        maps.push(("slip", size("slip_x", "slip_y")?));
    }
    if has("gap") {
        let gap = read("gap")?;
        let none = || gap.with(Field::zeros(gap.field.raw_dim()));
        let plastic = if has("plastic") { read("plastic")? } else { none() };
        maps.push(("gap", figures::open_gap(gap, &plastic.field, &touching)));
        maps.push(("plastic", plastic));
    }
    if has("displacement") {
        maps.push(("displacement", read("displacement")?));
    }
    if has("temperature") {
        maps.extend(temperature(read("temperature")?));
    }
    if has("oil_pressure") {
        for name in ["oil_pressure", "solid_pressure", "cavity"] {
            maps.push((name, read(name)?));
        }
    }
    maps.insert(0, ("contact", contact));
    maps.insert(0, ("pressure", pressure));
    Ok(maps)
}

impl Frame {
    fn pressure(&self) -> &Field {
        &self.fields[0].1.field
    }

    /// Whether there is tension among the pressures.
    fn pulls(&self) -> bool {
        self.pressure().iter().any(|p| *p < 0.0)
    }

    /// A static contact without maps.
    fn at_rest() -> Self {
        Self {
            group: 0,
            label: String::new(),
            text: String::new(),
            offset: 0.0,
            across: 0.0,
            approach: 0.0,
            seam: 0,
            mark: None,
            rank: None,
            fields: Vec::new(),
        }
    }

    fn with_maps(self, maps: Vec<(&'static str, QuantisedField)>) -> PageFrame {
        let about = json!({
            "group": self.group,
            "label": self.label,
            "text": escaped(&minus(&self.text)),
            "offset": self.offset,
            "seam": self.seam,
            "mark": self.mark,
            "across": self.across,
            "approach": Some(self.approach).filter(|approach| approach.is_finite()),
            "together": minus(&format(self.approach, Dimension::Length)),
        });
        PageFrame { about, maps }
    }

    /// Packs the fields; those of pressures with their signs, if there is tension in any frame.
    fn packed(mut self, pulls: bool) -> PageFrame {
        let fields = std::mem::take(&mut self.fields);
        let map = |(name, array): (&'static str, StoredArray)| {
            Some((name, levels_of(name, &array, pulls)?.deflated()))
        };
        let maps = fields.into_par_iter().filter_map(map).collect();
        self.with_maps(maps)
    }
}

fn all_packed(frames: Vec<Frame>) -> Vec<PageFrame> {
    let pulls = frames.iter().any(Frame::pulls);
    frames.into_par_iter().map(|frame| frame.packed(pulls)).collect()
}

/// The data of the section.
fn shown(frames: &[PageFrame], groups: Vec<Value>) -> Value {
    let mut layers = Vec::new();
    for layer in &LAYERS {
        let of_group = |group: Option<usize>| {
            let frames =
                frames.iter().filter(move |frame| group.is_none_or(|group| frame.about["group"] == group));
            let all = frames.flat_map(|frame| &frame.maps);
            all.filter(|(name, _)| *name == layer.name).map(|(_, map)| map)
        };
        let maps = || of_group(None);
        let begin =
            if matches!(layer.kind, Kind::Between) { [f64::INFINITY, f64::NEG_INFINITY] } else { [0.0; 2] };
        let span = |group| {
            of_group(group).fold(begin, |[low, high]: [f64; 2], map| [low.min(map.low), high.max(map.high)])
        };
        let [low, high] = span(None);
        let mut ranges: Vec<[f64; 2]> = (0..groups.len()).map(|group| span(Some(group))).collect();
        let pulls = layer.name == "pressure" && low < 0.0;
        if pulls {
            ranges.iter_mut().for_each(|range| *range = figures::ends_with_tension(*range).unwrap_or(*range));
        }
        // A pressure that is nowhere is shown, plastic interference that is nowhere is not.
        let always = matches!(layer.name, "pressure" | "contact");
        if maps().next().is_none() || (!always && low == 0.0 && high == 0.0) {
            continue;
        }
        let (kind, classes) = match layer.kind {
            Kind::Positive if pulls => ("diverging", Vec::new()),
            Kind::Positive => ("positive", Vec::new()),
            Kind::Signed => ("signed", Vec::new()),
            Kind::Between => ("between", Vec::new()),
            Kind::Classes(Colours::Classes(names)) => {
                ("class", names.iter().take(2 + usize::from(high > 1.0)).copied().collect())
            }
            Kind::Classes(_) => ("class", Vec::new()),
        };
        layers.push(json!({
            "name": layer.name,
            "title": layer.title,
            "caption": if pulls { Some("Pressure on each cell; tension is below 0.") } else { captions::find(layer.name) },
            "kind": kind,
            "classes": classes,
            // Each pass has its own, so that a late pass of low pressures shows them.
            "ranges": ranges,
            "unit": curves::unit(layer.unit, high.max(-low)),
        }));
    }
    let frame = |PageFrame { about, maps }: &PageFrame| {
        let mut frame = about.clone();
        let shown = maps.iter().filter(|(name, _)| layers.iter().any(|layer| layer["name"] == *name));
        frame["maps"] =
            shown.map(|(name, map)| ((*name).to_owned(), json!(map))).collect::<Map<_, _>>().into();
        frame
    };
    json!({ "layers": layers, "groups": groups, "frames": frames.iter().map(frame).collect::<Vec<_>>() })
}
