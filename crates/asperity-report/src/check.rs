//! A case in words before it is computed.

use std::fmt::Write as _;

use asperity_base::Choice;
use asperity_base::units::{self, Dimension, bytes};
use asperity_contact::each;
use asperity_contact::motion::{LoadControl, OffsetY, Path, PlasticUpdate, Point, Stage};
use asperity_contact::solver::{Control, Creep, Friction, Rolling, Tangential};
use asperity_contact::with::{BodyLaw, Capability, Listed, ordinal};
use asperity_study::case::{Body, Boundary, CounterBody, Course, Mount, Side};
use asperity_study::{Bodies, Case, Demand, Estimate, MountedSurface, Plan};

use crate::words::closed_form;

/// A row of the description of a case: its name and its text.
pub type Row = (&'static str, String);

/// Describes a case before it is computed: bodies, contact, cost, and all that it asks for.
pub fn rows(case: &Case, bodies: &Bodies, estimate: &Estimate, demand: &Demand) -> Vec<Row> {
    let mut rows = vec![
        ("lower", body(&bodies.lower)),
        ("upper", body(&bodies.upper)),
        ("pair", pair(case, estimate)),
        ("contact", contact(case, estimate)),
        ("motion", motion(case, estimate)),
        ("memory", memory(demand)),
        ("time", time(demand)),
    ];
    let friction = case.friction.as_ref().map(|spec| ("friction", friction(&spec.law, estimate)));
    let stages = estimate.course.stages();
    let history = (case.friction.is_none() && stages.len() > 1).then(|| ("history", loading_path(stages)));
    let theory = estimate.closed_form.as_ref().map(|form| ("theory", closed_form::expected(form)));
    let interface =
        case.interface.describe(&estimate.interface, estimate.lubrication.as_ref().map(|of| &of.oil));
    let stress = estimate.subsurface.as_ref().map(|plan| ("stress", stress(case, plan)));
    rows.extend(theory.into_iter().chain(friction).chain(history).chain(interface));
    rows.extend(laws(case, demand));
    rows.extend(stress);
    let surroundings = case.surroundings();
    each!(capability C => rows.extend(C::of(&case.with).map(|asked| (C::VERB, asked.describe(&surroundings)))));
    rows
}

fn body(body: &MountedSurface) -> String {
    let grid = body.topography.grid();
    let length = |value| units::format(value, Dimension::Length);
    let ([nx, ny], [dx, dy], [lx, ly]) = (grid.shape, grid.pitch, grid.extent());
    let mut text =
        format!("{nx} × {ny} cells of {} × {}, {} × {}; ", length(dx), length(dy), length(lx), length(ly));
    match body.topography.sq() {
        0.0 => text.push_str("flat"),
        sq => {
            let _ = write!(text, "Sq {}, Sdq {:.4}", length(sq), body.topography.sdq());
        }
    }
    if let Some(origin) = &body.origin {
        let [sx, sy] = origin.shape;
        let _ = write!(text, "; {} `{}`, {sx} × {sy} samples", origin.format, origin.channel);
        if origin.is_underside {
            text.push_str(match body.mount {
                Mount::AsIs => ", an underside, mounted as it is",
                Mount::TurnedOver => ", an underside, turned over",
            });
        }
    }
    let findings = &body.findings;
    if findings.undefined > 0 {
        let _ = write!(text, ", {} filled", findings.undefined);
    }
    if findings.spikes > 0 {
        let _ = write!(text, ", {} spikes replaced", findings.spikes);
    }
    if let Some(form) = &findings.form {
        let kind = if form.axis.is_some() { "cylinder" } else { "sphere" };
        let _ = write!(text, "; a {kind} of radius {} subtracted", length(form.radius));
    }
    text
}

fn pair(case: &Case, estimate: &Estimate) -> String {
    let pressure = |value| units::format(value, Dimension::Pressure);
    let coated = if case.is_coated() { " without the layers" } else { "" };
    let modulus = format!("E* {}{coated}", pressure(estimate.modulus));
    if let Some(volume) = case.plasticity {
        let of_body = |(name, body): (&str, &Body)| {
            let flow = body.plasticity.as_ref()?;
            Some(format!("the {name} body flows from {} on", pressure(flow.yield_stress())))
        };
        let bodies: Vec<_> =
            [("lower", &case.lower), ("upper", &case.upper)].into_iter().filter_map(of_body).collect();
        let depth = units::format(volume.depth, Dimension::Length);
        return format!("{modulus}; {}, in {} layers down to {depth}", bodies.join(", "), volume.layers);
    }
    if estimate.hardness.is_infinite() {
        return match &estimate.viscoelastic {
            None => format!("{modulus}, elastic"),
            Some(viscoelastic) => {
                let relaxed = if case.is_coated() { ", relaxed" } else { " relaxed" };
                format!("{modulus}{relaxed}; {}", viscoelastic.bodies.join("; "))
            }
        };
    }
    let who = match estimate.lower_share {
        Some(1.0) => "the lower body deforms",
        Some(0.0) => "the upper body deforms",
        Some(_) => "both deform alike",
        None => "the softer of two cells deforms",
    };
    let up_to = match estimate.max_hardness {
        most if most == estimate.hardness => pressure(most),
        most if most.is_infinite() => format!("{} where it is softest", pressure(estimate.hardness)),
        most => format!("{} … {}", pressure(estimate.hardness), pressure(most)),
    };
    format!("{modulus}, pressure up to {up_to}; {who} plastically")
}

fn contact(case: &Case, estimate: &Estimate) -> String {
    let force = |value| units::format(value, Dimension::Force);
    let control = match (estimate.control, estimate.load_control) {
        (Control::Approach(approach), _) => {
            format!("approach {}", units::format(approach, Dimension::Length))
        }
        (Control::Load(load), LoadControl::Pass) => format!("mean load {} over a pass", force(load)),
        (Control::Load(load), LoadControl::Step) => match case.motion {
            Some(_) => format!("load {} at each position", force(load)),
            None => format!("load {}", force(load)),
        },
    };
    let boundary = match case.contact.boundary {
        Boundary([edge, same]) if edge == same => format!("{} boundary", edge.word()),
        Boundary([x, y]) => format!("boundary {} along x, {} along y", x.word(), y.word()),
    };
    let method = case.contact.method.word();
    let mut text = match &estimate.course {
        Course::Sweep(points) if !case.contact.sweep().is_empty() => swept(points),
        _ => control,
    };
    if let (Control::Load(load), true) = (estimate.control, estimate.plastic_limit.is_finite()) {
        let share = 100.0 * load / estimate.plastic_limit;
        let _ = write!(text, " ({share:.1} % of the plastic limit {})", force(estimate.plastic_limit));
    }
    if let Control::Load(load) = estimate.control {
        let mean = units::format(load / estimate.mean_facing_area, Dimension::Pressure);
        let at_most = if !case.contact.sweep().is_empty() { " at most" } else { "" };
        let _ = write!(text, ", nominal pressure {mean}{at_most}");
    }
    let _ = write!(text, ", {boundary}, method {method}, tolerance {:e}", case.contact.tolerance);
    text
}

/// Describes the loads or approaches of a sweep.
fn swept(points: &[Point]) -> String {
    let value = |point: &Point| match point.control {
        Control::Load(value) | Control::Approach(value) => value,
    };
    let [least, most] =
        [f64::min, f64::max].map(|pick| points.iter().map(value).reduce(pick).unwrap_or_default());
    let (kind, dimension) = match points[0].control {
        Control::Load(_) => ("load", Dimension::Force),
        Control::Approach(_) => ("approach", Dimension::Length),
    };
    let [least, most] = [least, most].map(|end| units::format(end, dimension));
    format!("{}, {kind} {least} to {most}", plural(points.len(), "point", "points"))
}

fn motion(case: &Case, estimate: &Estimate) -> String {
    let Some(motion) = case.motion else {
        return match &estimate.course {
            Course::Sweep(points) if points[0].speed.is_some() => steady(case, points),
            Course::Sweep(points) => {
                format!("none: {}", plural(points.len(), "static contact", "static contacts"))
            }
            Course::InPlace(slide) => format!(
                "in place over {}, {}",
                units::format(slide.ends.last().copied().unwrap_or(0.0), Dimension::Length),
                plural(slide.ends.len(), "update", "updates")
            ),
            _ => "none: one static contact".to_owned(),
        };
    };
    let strategy = motion.strategy.word();
    let update = match motion.plastic_update {
        PlasticUpdate::Pass => "after each pass",
        PlasticUpdate::Step => "at each position",
    };
    let mut text = format!(
        "{strategy}, {} of {}, stride {}",
        plural(estimate.passes, "pass", "passes"),
        plural(estimate.positions, "position", "positions"),
        plural(motion.stride, "cell", "cells")
    );
    if motion.path != Path::OneWay {
        let _ = write!(text, ", {}", motion.path.word());
    }
    match motion.offset_y() {
        OffsetY::NONE => {}
        OffsetY::Cells(cells) => {
            let _ = write!(text, ", {} further along y in each pass", plural(cells, "cell", "cells"));
        }
        OffsetY::Random { .. } => text += ", anywhere along y",
    }
    if motion.counter == CounterBody::Fresh {
        text += ", a fresh counter-body in each pass";
    }
    if estimate.hardness.is_finite() {
        let _ = write!(text, ", plastic deformation {update}");
    }
    text
}

fn friction(friction: &Friction, estimate: &Estimate) -> String {
    let mut text = format!("coefficient {}", friction.coefficient);
    if friction.shear_strength.is_finite() {
        let strength = units::format(friction.shear_strength, Dimension::Pressure);
        let _ = write!(text, ", shear up to {strength}");
    }
    if friction.junction_growth > 0.0 {
        let _ = write!(text, ", junction growth {}", friction.junction_growth);
    }
    let coupling = friction.coupling.word();
    let _ = write!(text, ", coupling {coupling}, Dundurs' β {:.3}; ", estimate.dundurs);
    text + &match &estimate.course {
        Course::Passes(_) | Course::InPlace(_) => "sliding at each position".to_owned(),
        Course::Rolling(at) => rolling(*at),
        Course::Stages(stages) => loading_path(stages),
        Course::Sweep(points) => rolling_through(points),
    }
}

/// Describes steady sliding at one speed after another.
fn steady(case: &Case, points: &[Point]) -> String {
    let what = if case.steady.is_some() { "steady sliding" } else { "a steady film" };
    let speeds = points.iter().filter_map(|point| point.speed);
    let speeds: Vec<String> = speeds.map(|speed| units::format(speed, Dimension::Speed)).collect();
    match speeds.as_slice() {
        [only] => format!("{what} at {only}"),
        several => {
            format!("{what} at {} speeds, {} to {}", several.len(), several[0], several[several.len() - 1])
        }
    }
}

/// Describes the rolling of a sweep: one creepage for all points, or a range.
fn rolling_through(points: &[Point]) -> String {
    let [Some(first), Some(last)] = [0, points.len() - 1].map(|point| points[point].regime.rolling()) else {
        return String::new();
    };
    match (first.creep, last.creep) {
        (Creep::Creepage([x, y]), Creep::Creepage([to_x, to_y])) if first != last => {
            let count = plural(points.len(), "creepage", "creepages");
            format!("rolling at {count}, {x}, {y} to {to_x}, {to_y}{}", with_spin(first.spin))
        }
        _ => rolling(first),
    }
}

fn rolling(Rolling { creep, spin }: Rolling) -> String {
    let force = |value| units::format(value, Dimension::Force);
    let at = match creep {
        Creep::Creepage([x, y]) => format!("at the creepage {x}, {y}"),
        Creep::Force([x, y]) => format!("under the force {}, {}", force(x), force(y)),
    };
    format!("rolling {at}{}", with_spin(spin))
}

fn with_spin(spin: f64) -> String {
    if spin == 0.0 { String::new() } else { format!(" and a spin of {spin} 1/m") }
}

fn loading_path(stages: &[Stage]) -> String {
    let increments = Stage::increments(stages);
    let cycles: usize = stages.iter().filter_map(|stage| stage.cycles).map(|cycles| cycles.count).sum();
    let slides = |stage: &Stage| matches!(stage.loading.tangential, Tangential::Sliding(_));
    format!(
        "{}{} in {}{}{}",
        if cycles > 1 { "up to " } else { "" },
        plural(increments, "increment", "increments"),
        plural(stages.len(), "stage", "stages"),
        if cycles > 0 { format!(", {}", plural(cycles, "cycle", "cycles")) } else { String::new() },
        if stages.iter().any(slides) { ", sliding" } else { "" }
    )
}

fn plural(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}

fn memory(demand: &Demand) -> String {
    let Demand { surfaces, solver, together, results, memory, .. } = *demand;
    let together = if together > 0.0 { format!(", {} for a pass", bytes(together)) } else { String::new() };
    format!(
        "about {}: {} for the surfaces, {} for each thread{together}, {} of results",
        bytes(memory),
        bytes(surfaces),
        bytes(solver),
        bytes(results)
    )
}

fn time(demand: &Demand) -> String {
    let [solving, drawing] = demand.times();
    format!(
        "{} {}: {} to solve and write, {} for figures and page",
        if demand.is_least { "at least" } else { "about" },
        units::format_time(solving + drawing),
        units::format_time(solving),
        units::format_time(drawing)
    )
}

/// Describes the laws of the bodies, heat and extrapolation, with a row for each in the case.
fn laws(case: &Case, demand: &Demand) -> Vec<(&'static str, String)> {
    let bodies = [("lower", &case.lower), ("upper", &case.upper)];
    let of_bodies = |describe: &dyn Fn(&Body) -> Option<String>| {
        let texts = bodies.into_iter().filter_map(|(name, body)| Some((name, describe(body)?)));
        let texts: Vec<(&str, String)> = texts.collect();
        match texts.as_slice() {
            [] => None,
            [(_, one), (_, other)] if one == other => Some(format!("of both bodies {one}")),
            _ => {
                let texts: Vec<_> =
                    texts.iter().map(|(name, text)| format!("of the {name} body {text}")).collect();
                Some(texts.join("; "))
            }
        }
    };
    let mut rows = Vec::new();
    each!(law L => rows.push((L::NAME, of_bodies(&|body| L::of(&body.laws).map(L::describe)))));
    let heat = case.temperature.map(|spec| {
        let [lower, upper] = spec.bulk.map(|kelvin| units::format(kelvin, Dimension::Temperature));
        let bulk = if lower == upper { lower } else { format!("{lower} (lower) and {upper} (upper)") };
        let flash = match (spec.every(), case.motion.is_some()) {
            (0, _) => "no flash temperature".to_owned(),
            (_, false) => "flash temperature of the cells in contact".to_owned(),
            (1, true) => "flash temperature at each position".to_owned(),
            (every, true) => {
                format!("flash temperature at each position of every {} computed pass", ordinal(every))
            }
        };
        format!("bulk {bulk}, {flash}")
    });
    let passes = case.acceleration.and_then(|acceleration| {
        let passes = case.motion?.passes;
        Some(format!(
            "{} {} of {passes} computed, each extrapolated over at most {} or a depth of {}{}",
            if demand.is_least { "at least" } else { "about" },
            units::format_number(demand.passes.round()),
            plural(acceleration.max_jump.min(passes), "pass", "passes"),
            units::format(acceleration.max_depth(), Dimension::Length),
            if demand.is_least { "; once points fail, each pit ends an extrapolation" } else { "" }
        ))
    });
    rows.extend([("heat", heat), ("passes", passes)]);
    rows.into_iter().filter_map(|(name, text)| Some((name, text?))).collect()
}

fn stress(case: &Case, plan: &Plan) -> String {
    let body = case.subsurface.as_ref().map_or(Side::Lower, |spec| spec.body).word();
    let position =
        if case.motion.is_some() { format!(" at position {}", plan.index + 1) } else { String::new() };
    let deepest = plan.depths.last().copied().unwrap_or(0.0);
    format!(
        "in the {body} body{position}, {} depths to {}, about {} for each thread",
        plan.depths.len(),
        units::format(deepest, Dimension::Length),
        bytes(plan.memory())
    )
}
