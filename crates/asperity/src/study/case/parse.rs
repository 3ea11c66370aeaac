//! From text to [`Case`]. The tables are read in the order of the contract, each by one function.

use std::path::{Path, PathBuf};

use super::cursor::{Entry, Table};
use super::document::Document;
use super::friction::friction;
use super::hardness::hardness;
use super::keys::{ROOT, belongs, known_in, known_of_topographies, suits};
use super::plasticity::{self, PlasticitySpec};
use super::prescribed::prescribed;
use super::running;
use super::sliding::{alone, sliding};
use super::subsurface::subsurface;
use super::sweep::{self, sweep};
use super::{
    Body, Boundary, Case, Contact, ControlKind, CounterBody, Edge, FrictionSpec, Layer, Method, MotionPath,
    MotionSpec, Mount, OffsetY, Output, Prescribed, RANDOM, Source, StageSpec, StrategyKind, TopographySpec,
};
use crate::error::Result;
use crate::grid::MAX_CELLS;
use crate::material::{self, Coating, Material};
use crate::motion::{Acceleration, PlasticUpdate, Strategy};
use crate::solver::Coupling;
use crate::surface::UNDERSIDE;
use crate::surface::{
    Amplitude, Autocorrelation, Axis, Band, Decay, Fill, Filter, Form, Generator, Groove, HeightDistribution,
    Interpolation, Level, LowPass, Preparation, Resample, SelfAffine,
};
use crate::units::Dimension;

/// The expected text of a shape.
const SHAPE: &str = "two whole numbers of at least 1, such as [256, 256]";

/// The expected text of one length or two.
const LENGTHS: &str = "a length above 0 such as \"0.25 um\", or two";

/// A topography that stands alone, in the table `[topography]`, and the document that it stands in.
pub(super) fn topography_alone(text: &str, folder: &Path) -> Result<(TopographySpec, Document)> {
    let mut document = Document::new(PathBuf::new(), text);
    let entries = document.parse(text)?;
    let root = Table::root(&document, entries.get_ref());
    root.known(&["topography"], |key| belongs(key, ""))?;
    let spec = topography(&root.required_table("topography")?, folder)?;
    Ok((spec, document))
}

pub(super) fn case(text: &str, file: &Path, folder: &Path) -> Result<Case> {
    let mut document = Document::new(file.to_owned(), text);
    let entries = document.parse(text)?;
    let root = Table::root(&document, entries.get_ref());
    root.known(&ROOT, |key| belongs(key, ""))?;
    let title = match root.get("title") {
        Some(title) => title.text()?.to_owned(),
        None => file.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default(),
    };
    let lower = body(&root.required_table("lower")?, folder)?;
    let upper_table = root.required_table("upper")?;
    let upper = body(&upper_table, folder)?;
    one_tells_the_other(&lower.topography, &upper.topography, &upper_table)?;
    if material::composite_modulus(&lower.material, &upper.material).is_err() {
        let hint = "give one of them a finite 'young' or a coating";
        return Err(upper_table
            .required("young", "\"210 GPa\"")?
            .error("both bodies are rigid".to_owned(), Some(hint.to_owned())));
    }
    let contact_table = root.required_table("contact")?;
    let contact = contact(&contact_table)?;
    let mut motion =
        root.table("motion")?.map(|table| motion(&table, &contact_table, &contact)).transpose()?;
    let sliding = root.table("sliding")?.map(|table| sliding(&table)).transpose()?;
    alone(&root, [&lower, &upper])?;
    let slides = motion.is_some() || sliding.is_some();
    let yields = lower.hardness.yields() || upper.hardness.yields();
    let mut friction = root.table("friction")?.map(|table| friction(&table, yields, slides)).transpose()?;
    let stages = root.get("history");
    stands_alone(&contact_table, friction.as_ref(), motion.is_some(), stages.is_some())?;
    let bodies = [&lower, &upper];
    let plasticity = plasticity::plasticity(&root, bodies, contact.boundary, &mut motion, &mut friction)?;
    let history = history(stages.as_ref(), motion.is_some(), friction.as_ref(), plasticity.as_ref())?;
    if let (Some(_), Some(motion)) = (&friction, motion)
        && motion.strategy.direction() == 0.0
    {
        let hint = "give the speeds different values, or leave [friction] out".to_owned();
        let message = "surfaces of equal speeds do not slide over each other".to_owned();
        return Err(root.required_table("friction")?.error(message, Some(hint)));
    }
    if let Some(motion) = motion {
        fresh(&root, &motion, &upper.topography)?;
    }
    running::runs_in(&root, [&lower, &upper], motion.as_ref(), sliding.as_ref())?;
    let acceleration =
        root.table("acceleration")?.map(|table| accelerated(&table, [&lower, &upper], motion.as_ref()));
    let acceleration = acceleration.transpose()?;
    let temperature =
        running::temperature(&root, [&lower, &upper], motion.as_ref(), sliding.as_ref(), contact.boundary)?;
    let subsurface =
        root.table("subsurface")?.map(|table| subsurface(&table, motion.is_some())).transpose()?;
    if let Some(entry) = root.table("friction")?.and_then(|table| table.get("spin"))
        && contact.boundary != Boundary::FREE
    {
        let hint = "use `boundary = \"free\"`, or leave 'spin' out".to_owned();
        return Err(
            entry.error("what spins does not repeat itself: its boundary is free".to_owned(), Some(hint))
        );
    }
    if let (Some(_), Some(entry)) = (&subsurface, contact_table.get("boundary"))
        && contact.boundary.repeats(0) != contact.boundary.repeats(1)
    {
        let message = "a boundary periodic along one axis alone has no [subsurface] yet";
        let hint = "leave [subsurface] out, or use \"free\" or \"periodic\"".to_owned();
        return Err(entry.error(message.to_owned(), Some(hint)));
    }
    if [&lower, &upper].iter().any(|body| body.material.coating.is_some()) {
        pressed_alone(&root, &contact, friction.as_ref(), slides)?;
    }
    let output = output(root.table("output")?.as_ref())?;
    Ok(Case {
        title,
        lower,
        upper,
        contact,
        friction,
        history,
        motion,
        sliding,
        acceleration,
        temperature,
        plasticity,
        subsurface,
        output,
        document,
    })
}

/// `[acceleration]`, of bodies that run in by passes that repeat.
fn accelerated(table: &Table<'_>, bodies: [&Body; 2], motion: Option<&MotionSpec>) -> Result<Acceleration> {
    let acceleration = running::acceleration(table)?;
    if bodies.iter().all(|body| body.wear.is_none() && body.film.is_none()) {
        let hint = "give a body `[lower.wear]` or `[lower.film]`, or leave [acceleration] out".to_owned();
        return Err(table.error("[acceleration] is of bodies that wear or grow films".to_owned(), Some(hint)));
    }
    if let Some(motion) = motion.filter(|motion| acceleration.max_jump > 1 && !motion.repeats()) {
        let (what, other) = match motion {
            MotionSpec { counter: CounterBody::Fresh, .. } => {
                ("a fresh counter-body meets", "`counter = \"same\"`")
            }
            MotionSpec { offset_y, .. } if *offset_y != OffsetY::NONE => {
                ("surfaces that are displaced across meet", "`offset_y = 0`")
            }
            _ => (
                "surfaces that do not move by whole rounds meet",
                "speeds of which one is 0 or which are equal, or `path = \"reciprocating\"`",
            ),
        };
        let message = format!("{what} anew in each pass: no pass stands for others");
        return Err(table.error(message, Some(format!("set `max_jump = 1`, or {other}"))));
    }
    Ok(acceleration)
}

/// What a coated body answers to is a pressure, on a surface that is free or periodic: an error where more is asked for.
fn pressed_alone(
    root: &Table<'_>,
    contact: &Contact,
    friction: Option<&FrictionSpec>,
    moves: bool,
) -> Result<()> {
    if let (Some(table), Some(friction)) = (root.table("friction")?, friction)
        && (!moves || friction.law.coupling != Coupling::None)
    {
        let message = "what shear does to a coated body is not known yet".to_owned();
        let hint = match moves {
            true => "set `coupling = \"none\"`, or leave the coating out",
            false => "leave [friction] or the coating out",
        };
        let hint = Some(hint.to_owned());
        return Err(match table.get("coupling").filter(|_| moves) {
            Some(entry) => entry.error(message, hint),
            None => table.error(message, hint),
        });
    }
    if let Some(entry) = root.required_table("contact")?.get("boundary")
        && contact.boundary.repeats(0) != contact.boundary.repeats(1)
    {
        let message = "a coated body has no boundary that is periodic along one axis alone yet".to_owned();
        let hint = "use \"free\" or \"periodic\", or leave the coating out".to_owned();
        return Err(entry.error(message, Some(hint)));
    }
    match root.table("subsurface")? {
        None => Ok(()),
        Some(table) => {
            let hint = "leave [subsurface] or the coating out".to_owned();
            Err(table.error("stresses under a coating are not known yet".to_owned(), Some(hint)))
        }
    }
}

/// An error if both bodies wait for each other's shape or pitch.
fn one_tells_the_other(
    lower: &TopographySpec,
    upper: &TopographySpec,
    upper_table: &Table<'_>,
) -> Result<()> {
    let (Some(of_lower), Some(of_upper)) = (lower.lacks().last(), upper.lacks().last()) else {
        return Ok(());
    };
    let table = upper_table.required_table("topography")?;
    let key = upper.lacks().find(|key| lower.lacks().any(|other| other == *key)).unwrap_or(of_upper);
    let why = match lower.lacks().any(|other| other == key) {
        true => "and in [lower.topography]: a body takes from the other what it lacks".to_owned(),
        false => format!("from which [lower.topography] takes its '{of_lower}'"),
    };
    let example = if key == "shape" { "[256, 256]" } else { "\"0.5 um\"" };
    let hint = format!("for example `{key} = {example}`");
    Err(table.error(format!("missing key '{key}' in {}, {why}", table.name()), Some(hint)))
}

/// An error if the bodies of a sweep have a past, or a future.
fn stands_alone(
    contact: &Table<'_>,
    friction: Option<&FrictionSpec>,
    moves: bool,
    has_history: bool,
) -> Result<()> {
    let Some(entry) = sweep::KEYS.iter().find_map(|key| contact.get(key)) else { return Ok(()) };
    let refused = |message: &str, hint: &str| {
        Err(entry.error(message.replace("{}", entry.key()), Some(hint.to_owned())))
    };
    if moves {
        return refused("a [motion] has no '{}'", "it has one `load`, `mean_pressure` or `approach`");
    }
    if has_history {
        let hint = "each of its values presses virgin bodies, in a history what is flattened stays flat";
        return refused("'{}' and [[history]] are both given, expected one of them", hint);
    }
    if friction.is_some_and(|friction| !friction.creepages.is_empty()) {
        let hint = "a sweep goes through loads at one `creepage`, or through creepages under one `load`";
        return refused("'{}' and 'creepages' are both given, expected one of them", hint);
    }
    if friction.is_some_and(|friction| !friction.rolls()) {
        let message = "with [friction] only what rolls has '{}'";
        let hint = "what sticks and slips depends on how a load came about: give a `creepage`, a `rolling_force`, or \
                    stages in a [[history]]";
        return refused(message, hint);
    }
    Ok(())
}

/// The stages after the first, which only a static contact has.
fn history(
    entry: Option<&Entry<'_>>,
    moves: bool,
    friction: Option<&FrictionSpec>,
    plasticity: Option<&PlasticitySpec>,
) -> Result<Vec<StageSpec>> {
    let Some(entry) = entry else { return Ok(Vec::new()) };
    let tables = entry.tables()?;
    if moves {
        let table = tables.first();
        let message = "a [motion] has no [[history]]".to_owned();
        let hint = Some("a history is that of a static contact".to_owned());
        return Err(match table {
            Some(table) => table.error(message, hint),
            None => entry.error(message, hint),
        });
    }
    super::friction::history(&tables, friction, plasticity)
}

fn body(table: &Table<'_>, folder: &Path) -> Result<Body> {
    let is_upper = table.path() == "upper";
    known_in(table)?;
    let young =
        table.required("young", "\"210 GPa\"")?.positive_or_infinite(Dimension::Pressure, "a rigid body")?;
    let poisson = poisson(table)?;
    let hardness = hardness(table, folder)?;
    let coating = table.table("coating")?.map(|table| coating(&table)).transpose()?;
    let plasticity = table
        .table("plasticity")?
        .map(|flow| plasticity::flow(&flow, table, young, &hardness, coating.as_ref()))
        .transpose()?;
    let film = table.table("film")?.map(|table| running::film(&table, &hardness)).transpose()?;
    let wear =
        table.table("wear")?.map(|table| running::wear(&table, &hardness, film.as_ref())).transpose()?;
    let topography = topography(&table.required_table("topography")?, folder)?;
    let mount = match table.get("mount") {
        Some(entry) => Some(entry.choice()?),
        None if is_upper && may_be_an_underside(&topography.source) => None,
        None if is_upper => Some(Mount::TurnedOver),
        None => Some(Mount::AsIs),
    };
    // Checked above, entry by entry: this can find nothing new.
    let material = Material { coating, ..Material::elastic(young, poisson)? };
    let thermal = running::thermal(table)?;
    Ok(Body { material, hardness, plasticity, thermal, wear, film, topography, mount })
}

fn poisson(table: &Table<'_>) -> Result<f64> {
    table.required("poisson", "0.3")?.number(|value| (0.0..=0.5).contains(&value), "a number from 0 to 0.5")
}

fn coating(table: &Table<'_>) -> Result<Coating> {
    known_in(table)?;
    let thickness = table.required("thickness", "\"2 um\"")?.positive(Dimension::Length)?;
    let young = table.required("young", "\"300 GPa\"")?.positive(Dimension::Pressure)?;
    Coating::new(thickness, young, poisson(table)?)
}

/// Whether a file of results would hold the underside of a body there.
fn may_be_an_underside(source: &Source) -> bool {
    matches!(source, Source::File { channel: Some(channel), .. } if channel == UNDERSIDE)
}

fn topography(table: &Table<'_>, folder: &Path) -> Result<TopographySpec> {
    known_of_topographies(table)?;
    // Only a program that calls the library can give heights: others are not told of it.
    let kinds: &[_] = match table.get("given") {
        Some(_) => &["file", "given", "generate", "form"],
        None => &["file", "generate", "form"],
    };
    let kind = table.exactly_one(
        kinds,
        "for example `file = \"disc.x3p\"`, `generate = \"low-pass\"` or `form = \"sphere\"`",
    )?;
    let source = match kind {
        "file" => file(table, folder)?,
        "given" => given(table)?,
        "generate" => generate(table)?,
        _ => form(table)?,
    };
    let pitch = table.get("pitch").map(|entry| lengths(&entry)).transpose()?;
    let plus = table.get("plus").map(|entry| layers(&entry)).transpose()?.unwrap_or_default();
    Ok(TopographySpec { source, pitch, preparation: preparation(table)?, plus })
}

fn preparation(table: &Table<'_>) -> Result<Preparation> {
    let window = |entry: Entry<'_>| {
        let expected = "four whole numbers [x0, y0, nx, ny]";
        let window: [usize; 4] = entry.array(expected, |item| item.count(0))?;
        if window[2..].contains(&0) {
            return Err(entry.unexpected("a window [x0, y0, nx, ny] of at least one sample", None));
        }
        Ok(window)
    };
    let length = |key| table.get(key).map(|entry| entry.positive(Dimension::Length)).transpose();
    let factor = |entry: Entry<'_>| entry.number(|factor| factor > 0.0, "a number above 0 such as 6");
    let (s_filter, l_filter) = (length("s_filter")?, length("l_filter")?);
    if let (Some(shortest), Some(longest), Some(entry)) = (s_filter, l_filter, table.get("s_filter"))
        && shortest >= longest
    {
        return Err(entry.unexpected("a wavelength below that of 'l_filter'", None));
    }
    Ok(Preparation {
        window: table.get("window").map(window).transpose()?,
        despike: table.get("despike").map(factor).transpose()?,
        fill: table.choice_or("fill", Fill::None)?,
        level: table.get("level").map(|entry| level(&entry)).transpose()?.unwrap_or_default(),
        mirror: table.get("mirror").map(|entry| entry.choice()).transpose()?,
        rotate: table.get("rotate").map_or(Ok(0.0), |entry| entry.quantity(Dimension::Angle))?,
        s_filter,
        l_filter,
        filter: table.choice_or("filter", Filter::Gaussian)?,
        resample: table.get("resample").map(|entry| shape(&entry).map(Resample::Shape)).transpose()?,
        interpolate: table.choice_or("interpolate", Interpolation::Linear)?,
        taper: length("taper")?,
    })
}

/// One of the words of [`Level`]; of polynomials each order has its own.
fn level(entry: &Entry<'_>) -> Result<Level> {
    if let Some(level) = entry.text().ok().and_then(|text| text.parse().ok()) {
        return Ok(level);
    }
    let choices = Level::WORDS.map(|word| (word, Level::None));
    let hint = || format!("the order of a polynomial is from 0 to {}", Level::MAX_ORDER);
    match entry.text() {
        Ok(text) if text.starts_with("polynomial") => {
            Err(entry.unexpected("a polynomial such as \"polynomial-3\"", Some(hint())))
        }
        _ => entry.word(&choices),
    }
}

fn file(table: &Table<'_>, folder: &Path) -> Result<Source> {
    suits(table, "file")?;
    let name = table.required("file", "\"disc.x3p\"")?;
    let path = match name.text()? {
        "" => return Err(name.unexpected("the name of a file", None)),
        path => folder.join(path),
    };
    Ok(Source::File {
        path,
        channel: table.get("channel").map(|entry| entry.text().map(str::to_owned)).transpose()?,
        unit: table.get("unit").map(|entry| entry.unit(Dimension::Length)).transpose()?,
    })
}

fn given(table: &Table<'_>) -> Result<Source> {
    suits(table, "given")?;
    Ok(Source::Given { name: table.required("given", "\"disc\"")?.text()?.to_owned() })
}

fn layers(entry: &Entry<'_>) -> Result<Vec<Layer>> {
    let layer = |table: &Table<'_>| {
        known_of_topographies(table)?;
        let hint = "for example `generate = \"low-pass\"` or `form = \"sphere\"`";
        match table.exactly_one(&["generate", "form"], hint)? {
            "generate" => Ok(Layer::Generate { generate: generator(table)?, seed: seed(table)? }),
            _ => Ok(Layer::Form { form: ideal_form(table)? }),
        }
    };
    entry.tables()?.iter().map(layer).collect()
}

fn generate(table: &Table<'_>) -> Result<Source> {
    let (generate, seed) = (generator(table)?, seed(table)?);
    Ok(Source::Generate { generate, shape: table.get("shape").map(|entry| shape(&entry)).transpose()?, seed })
}

fn form(table: &Table<'_>) -> Result<Source> {
    let form = ideal_form(table)?;
    Ok(Source::Form { form, shape: table.get("shape").map(|entry| shape(&entry)).transpose()? })
}

fn seed(table: &Table<'_>) -> Result<u64> {
    Ok(table.get("seed").map(|entry| entry.whole(0)).transpose()?.unwrap_or(0))
}

fn generator(table: &Table<'_>) -> Result<Generator> {
    #[derive(Clone, Copy)]
    enum Kind {
        LowPass,
        Autocorrelation,
        SelfAffine,
    }
    let kinds = [
        ("low-pass", Kind::LowPass),
        ("autocorrelation", Kind::Autocorrelation),
        ("self-affine", Kind::SelfAffine),
    ];
    let method = table.required("generate", "\"low-pass\"")?;
    let kind = method.word(&kinds)?;
    suits(table, &format!("generate = \"{}\"", method.text()?))?;
    let sq = || table.required("sq", "\"0.2 um\"")?.positive(Dimension::Length);
    let optional = |key| table.get(key).map(|entry| entry.positive(Dimension::Length)).transpose();
    Ok(match kind {
        Kind::LowPass => Generator::LowPass(LowPass {
            sq: sq()?,
            cutoff: lengths(&table.required("cutoff", "\"8 um\"")?)?,
            band: table.choice_or("band", Band::default())?,
            heights: heights(table)?,
        }),
        Kind::Autocorrelation => Generator::Autocorrelation(Autocorrelation {
            sq: sq()?,
            correlation_length: lengths(&table.required("correlation_length", "\"8 um\"")?)?,
            decay: table.choice_or("decay", Decay::default())?,
            lay: lay(table)?,
            heights: heights(table)?,
        }),
        Kind::SelfAffine => {
            let amplitude = match table.exactly_one(
                &["sq", "sdq"],
                "'sq' is the rms height, a length; 'sdq' the rms slope, a number",
            )? {
                "sq" => Amplitude::Sq(sq()?),
                _ => Amplitude::Sdq(
                    table
                        .required("sdq", "0.1")?
                        .number(|value| value > 0.0, "a number above 0 such as 0.1")?,
                ),
            };
            let hurst = table
                .required("hurst", "0.8")?
                .number(|value| value > 0.0 && value <= 1.0, "a number above 0, at most 1")?;
            let (rolloff, shortest) = (optional("rolloff")?, optional("shortest")?);
            if let (Some(rolloff), Some(shortest), Some(entry)) = (rolloff, shortest, table.get("shortest"))
                && shortest >= rolloff
            {
                return Err(entry.unexpected("a wavelength below that of 'rolloff'", None));
            }
            Generator::SelfAffine(SelfAffine { hurst, rolloff, shortest, amplitude })
        }
    })
}

/// Skewness and kurtosis; a skewness needs its kurtosis, of which it bounds the range.
fn heights(table: &Table<'_>) -> Result<HeightDistribution> {
    let number = |entry: Entry<'_>| entry.number(|_| true, "a number");
    let mut heights = HeightDistribution::GAUSSIAN;
    if let Some(ssk) = table.get("ssk") {
        heights = HeightDistribution { ssk: number(ssk)?, sku: number(table.required("sku", "4.5")?)? };
    } else if let Some(sku) = table.get("sku") {
        heights.sku = number(sku)?;
    }
    Ok(heights)
}

fn lay(table: &Table<'_>) -> Result<f64> {
    table.get("lay").map_or(Ok(0.0), |entry| entry.quantity(Dimension::Angle))
}

fn ideal_form(table: &Table<'_>) -> Result<Form> {
    #[derive(Clone, Copy)]
    enum Kind {
        Sphere,
        Ellipsoid,
        Cylinder,
        Cone,
        Flat,
        Sinusoid,
        Grooves,
    }
    let kinds = [
        ("sphere", Kind::Sphere),
        ("ellipsoid", Kind::Ellipsoid),
        ("cylinder", Kind::Cylinder),
        ("cone", Kind::Cone),
        ("flat", Kind::Flat),
        ("sinusoid", Kind::Sinusoid),
        ("grooves", Kind::Grooves),
    ];
    let name = table.required("form", "\"sphere\"")?;
    let kind = name.word(&kinds)?;
    suits(table, &format!("form = \"{}\"", name.text()?))?;
    let radius = || table.required("radius", "\"1 mm\"")?.positive(Dimension::Length);
    Ok(match kind {
        Kind::Sphere => Form::Sphere { radius: radius()? },
        Kind::Ellipsoid => {
            const RADII: &str = "two radii of curvature, along x and along y, such as [\"1 mm\", \"2 mm\"]";
            let radii = table.required("radius", "[\"1 mm\", \"2 mm\"]")?;
            if !radii.is_array() {
                let hint = "a body of one radius is a `form = \"sphere\"`".to_owned();
                return Err(radii.unexpected(RADII, Some(hint)));
            }
            Form::Ellipsoid { radius: radii.array(RADII, |item| item.positive(Dimension::Length))? }
        }
        Kind::Cylinder => {
            Form::Cylinder { radius: radius()?, axis: table.choice_or("axis", Axis::default())? }
        }
        Kind::Cone => {
            let entry = table.required("angle", "\"5 deg\"")?;
            let angle = entry.positive(Dimension::Angle)?;
            if angle >= std::f64::consts::FRAC_PI_2 {
                let hint = "a number without a unit is in radians".to_owned();
                return Err(entry.unexpected("an angle below 90 deg such as \"5 deg\"", Some(hint)));
            }
            Form::Cone { angle }
        }
        Kind::Flat => Form::Flat,
        Kind::Sinusoid => Form::Sinusoid {
            amplitude: table.required("amplitude", "\"0.1 um\"")?.positive(Dimension::Length)?,
            wavelength: table.required("wavelength", "\"64 um\"")?.pair(LENGTHS, |item| {
                item.positive_or_infinite(Dimension::Length, "no variation in that direction")
            })?,
        },
        Kind::Grooves => Form::Grooves {
            period: table.required("period", "\"0.1 mm\"")?.positive(Dimension::Length)?,
            depth: table.required("depth", "\"1 um\"")?.positive(Dimension::Length)?,
            profile: table.choice_or("profile", Groove::default())?,
            lay: lay(table)?,
        },
    })
}

fn contact(table: &Table<'_>) -> Result<Contact> {
    known_in(table)?;
    const PRESCRIBED: [&str; 6] =
        ["load", "mean_pressure", "approach", "loads", "mean_pressures", "approaches"];
    table.exactly_one(&PRESCRIBED, "for example `load = \"2 N\"` and no other of them")?;
    let sweep = sweep(table)?;
    Ok(Contact {
        prescribed: sweep.as_ref().map_or_else(|| prescribed(table), |sweep| Ok(sweep.largest()))?,
        sweep,
        boundary: table.get("boundary").map_or(Ok(Boundary::FREE), |entry| boundary(&entry))?,
        method: table.choice_or("method", Method::Auto)?,
        tolerance: fraction_or(table, "tolerance", 1e-6)?,
    })
}

/// A word for both axes, or one for each.
fn boundary(entry: &Entry<'_>) -> Result<Boundary> {
    const EXPECTED: &str = "\"free\", \"periodic\", or one of them for x and one for y";
    Ok(Boundary(entry.pair(EXPECTED, |word| word.choice::<Edge>())?))
}

fn motion(table: &Table<'_>, contact_table: &Table<'_>, contact: &Contact) -> Result<MotionSpec> {
    known_in(table)?;
    let is_shift = table.choice_or("strategy", StrategyKind::Overlap)? == StrategyKind::Shift;
    if contact.boundary.repeats(0) && !is_shift {
        let message = "a boundary periodic along x has no overlap, where a finite body passes over another";
        let hint = "use `boundary = \"free\"` or `[\"free\", \"periodic\"]`, or `strategy = \"shift\"` under [motion]"
            .to_owned();
        let place = table.get("strategy").or(contact_table.get("boundary"));
        return Err(place.map_or_else(
            || table.error(message.to_owned(), Some(hint.clone())),
            |entry| entry.error(message.to_owned(), Some(hint.clone())),
        ));
    }
    let strategy = if is_shift { shift(table)? } else { overlap(table)? };
    let count = |key, default| match table.get(key) {
        Some(entry) => entry.count(1),
        None => Ok(default),
    };
    Ok(MotionSpec {
        strategy,
        passes: count("passes", 1)?,
        stride: count("stride", 1)?,
        control: control(table, contact.prescribed)?,
        plastic_update: table.choice_or("plastic_update", PlasticUpdate::Pass)?,
        load_tolerance: fraction_or(table, "load_tolerance", 1e-4)?,
        speed: speed(table, is_shift)?,
        path: table.choice_or("path", MotionPath::OneWay)?,
        offset_y: offset_y(table, contact.boundary)?,
        counter: table.choice_or("counter", CounterBody::Same)?,
    })
}

/// Where along y the passes lie.
fn offset_y(table: &Table<'_>, boundary: Boundary) -> Result<OffsetY> {
    let entry = table.get("offset_y");
    let is_random = entry.as_ref().is_some_and(|entry| entry.text().is_ok());
    if let Some(seed) = table.get("seed").filter(|_| !is_random) {
        let hint = "set `offset_y = \"random\"`, or leave 'seed' out".to_owned();
        return Err(seed.error("'seed' is that of passes that lie anywhere along y".to_owned(), Some(hint)));
    }
    let Some(entry) = entry else { return Ok(OffsetY::NONE) };
    let offset = if is_random {
        let random = entry.word(&[(RANDOM, ())]);
        random.map_err(|_| entry.unexpected("a whole number of cells, or \"random\"", None))?;
        OffsetY::Random { seed: seed(table)? }
    } else {
        OffsetY::Cells(entry.count(0)?)
    };
    if offset != OffsetY::NONE && !boundary.repeats(1) {
        let hint = "set `boundary = [\"free\", \"periodic\"]` or `\"periodic\"` in [contact], or leave 'offset_y' out".to_owned();
        let message =
            "what is displaced along y comes in on the other side: its boundary is periodic along y";
        return Err(entry.error(message.to_owned(), Some(hint)));
    }
    Ok(offset)
}

/// An error if the upper body is to be made anew for each pass, and is not made from a seed.
fn fresh(root: &Table<'_>, motion: &MotionSpec, upper: &TopographySpec) -> Result<()> {
    if motion.counter == CounterBody::Same || matches!(upper.source, Source::Generate { .. }) {
        return Ok(());
    }
    let entry = root.required_table("motion")?.required("counter", "\"fresh\"")?;
    let message = "a fresh counter-body is made from another seed: the upper topography has none".to_owned();
    let hint = "give [upper.topography] a `generate`, or set `counter = \"same\"`".to_owned();
    Err(entry.error(message, Some(hint)))
}

/// The speed of the upper body, of an overlap alone.
fn speed(table: &Table<'_>, is_shift: bool) -> Result<Option<f64>> {
    let Some(entry) = table.get("speed") else { return Ok(None) };
    if is_shift {
        let hint = "a shift has `speed_lower` and `speed_upper`".to_owned();
        return Err(entry.error("'speed' belongs to strategy = \"overlap\"".to_owned(), Some(hint)));
    }
    entry.positive(Dimension::Speed).map(Some)
}

fn overlap(table: &Table<'_>) -> Result<Strategy> {
    match table.get("speed_lower").or(table.get("speed_upper")) {
        None => Ok(Strategy::Overlap),
        Some(entry) => Err(entry.error(
            "a speed has no meaning with strategy = \"overlap\"".to_owned(),
            Some("only positions count there; speeds belong to `strategy = \"shift\"`".to_owned()),
        )),
    }
}

fn shift(table: &Table<'_>) -> Result<Strategy> {
    let speed = |key, default| match table.get(key) {
        Some(entry) => entry.quantity(Dimension::Speed),
        None => Ok(default),
    };
    let (speed_lower, speed_upper) = (speed("speed_lower", 0.0)?, speed("speed_upper", 1.0)?);
    if speed_lower == 0.0
        && speed_upper == 0.0
        && let Some(entry) = table.get("speed_upper")
    {
        return Err(entry.error("neither surface moves: both speeds are 0".to_owned(), None));
    }
    Ok(Strategy::Shift { speed_lower, speed_upper })
}

fn control(table: &Table<'_>, prescribed: Prescribed) -> Result<ControlKind> {
    let natural = match prescribed {
        Prescribed::Approach(_) => ControlKind::Approach,
        Prescribed::Load(_) | Prescribed::MeanPressure(_) => ControlKind::PassLoad,
    };
    let Some(entry) = table.get("control") else { return Ok(natural) };
    let kind = entry.choice()?;
    match ((kind == ControlKind::Approach), (natural == ControlKind::Approach)) {
        (true, false) => Err(entry.unexpected(
            "\"pass-load\" or \"step-load\", as [contact] gives a load",
            Some("or give `approach` under [contact] instead of the load".to_owned()),
        )),
        (false, true) => Err(entry.unexpected(
            "\"approach\", as [contact] gives an approach",
            Some("or give `load` or `mean_pressure` under [contact] instead of the approach".to_owned()),
        )),
        _ => Ok(kind),
    }
}

fn output(table: Option<&Table<'_>>) -> Result<Output> {
    let default = Output { pressure_every: 8, rim: 0.1, paraview: false };
    let Some(table) = table else { return Ok(default) };
    known_in(table)?;
    let pressure_every = table.get("pressure_every").map(|entry| entry.count(0)).transpose()?;
    let part = |value: f64| (0.0..0.5).contains(&value);
    let rim = table
        .get("rim")
        .map(|entry| entry.number(part, "a part of the length from 0, below 0.5"))
        .transpose()?;
    let paraview = table.get("paraview").map(|entry| entry.flag()).transpose()?;
    Ok(Output {
        pressure_every: pressure_every.unwrap_or(default.pressure_every),
        rim: rim.unwrap_or(default.rim),
        paraview: paraview.unwrap_or(default.paraview),
    })
}

fn shape(entry: &Entry<'_>) -> Result<[usize; 2]> {
    let whole = |item: &Entry<'_>| item.whole(0).map(|cells| usize::try_from(cells).unwrap_or(usize::MAX));
    let shape: [usize; 2] = entry.array(SHAPE, whole)?;
    match shape[0].checked_mul(shape[1]) {
        Some(0) => Err(entry.unexpected(SHAPE, None)),
        Some(cells) if cells <= MAX_CELLS => Ok(shape),
        _ => Err(entry.unexpected("a grid of at most 2³² cells", None)),
    }
}

fn lengths(entry: &Entry<'_>) -> Result<[f64; 2]> {
    entry.pair(LENGTHS, |item| item.positive(Dimension::Length))
}

fn fraction_or(table: &Table<'_>, key: &str, default: f64) -> Result<f64> {
    let good = |value: f64| value > 0.0 && value < 1.0;
    table.get(key).map_or(Ok(default), |entry| entry.number(good, "a number above 0, below 1"))
}
