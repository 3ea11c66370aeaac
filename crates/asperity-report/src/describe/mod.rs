//! A topography in numbers: roughness, random surface, profiles.

mod table;

use asperity_base::units::{self, Dimension, Metre, Multiple};
use asperity_base::{Error, Result};
use asperity_surface::{
    Axis, FeatureParameters, Findings, GreenwoodWilliamson, HybridParameters, Level, Parameter, Parameters,
    ProfileParameters, Round, SelfAffinity, SpatialParameters, SpectralMoments, Spectrum, Summits,
    Topography, Unit, Window,
};
use serde::Serialize;

use crate::figures::RINGS;
use crate::words::numbers::meaning;
pub use table::{Row, Table};

/// Returns the tilt or the form that makes most of the variance of the heights: a phrase with its verb, its
/// share of Sq², and the level that removes it.
pub fn prevailing_form(topography: &Topography) -> Option<(&'static str, f64, Level)> {
    let left = |level| topography.clone().level(level).map_or(f64::NAN, |left| left.sq().powi(2));
    let all = left(Level::Mean);
    let forms = [("tilt makes", Level::Plane), ("tilt and form make", Level::Quadratic)];
    let shares = forms.map(|(cause, level)| (cause, 1.0 - left(level) / all, level));
    shares.into_iter().find(|(_, share, _)| *share > 0.5)
}

/// Describes what a preparation has found and removed, a sentence for each.
pub fn findings_in_words(findings: &Findings, topography: &Topography) -> Vec<String> {
    let mut words = Vec::new();
    if findings.spikes > 0 {
        words.push(format!("{} samples removed as spikes", findings.spikes));
    }
    words.extend(findings.form.as_ref().map(|form| subtracted(form, topography)));
    words
}

fn subtracted(form: &Round, topography: &Topography) -> String {
    let [x, y] = topography.grid().extent();
    let diagonal = x.hypot(y);
    // Its rise over the field is less than a thousandth of the roughness, or only round-off.
    let rise = diagonal * diagonal / (8.0 * form.radius.abs());
    if rise <= (1e-3 * topography.sq()).max(1e-9 * diagonal) {
        return "the surface is flat: it has no curvature to subtract".to_owned();
    }
    let radius = units::format(form.radius.abs(), Dimension::Length);
    let side = if form.radius > 0.0 { "convex" } else { "concave" };
    match form.axis {
        None => format!("{side} sphere of radius {radius} subtracted"),
        Some(axis) => {
            let angle = axis.to_degrees();
            format!("{side} cylinder of radius {radius} subtracted, its axis at {angle:.2}° from x")
        }
    }
}

/// Numbers of a topography, SI.
#[derive(Serialize)]
pub struct Description {
    /// Areal parameters of ISO 25178-2; none of a single line.
    pub parameters: Option<Parameters>,
    /// None without a pitch, and of a single line.
    #[serde(flatten)]
    pub statistics: Option<Statistics>,
    /// None without a cut-off.
    pub profiles: Option<Profiles>,
    #[serde(skip)]
    has_pitch: bool,
}

/// Quantities of the theories of random surfaces.
#[derive(Serialize)]
pub struct Statistics {
    /// Spectral moments under Hann's window.
    pub moments: SpectralMoments,
    /// Nayak's α.
    pub bandwidth: f64,
    /// Its asperities.
    pub asperities: Asperities,
    /// The self-affine law on the longest range that follows one.
    pub self_affine: Option<Law>,
}

/// A power law of the spectrum, and its range.
#[derive(Serialize)]
pub struct Law {
    /// The law.
    #[serde(flatten)]
    pub fit: SelfAffinity,
    /// Decades of its range.
    pub decades: f64,
    /// A reason not to trust it.
    pub doubt: Option<String>,
}

impl From<SelfAffinity> for Law {
    fn from(fit: SelfAffinity) -> Self {
        Self { fit, decades: fit.decades(), doubt: fit.doubt() }
    }
}

/// The surface of Greenwood and Williamson.
#[derive(Serialize)]
pub struct Asperities {
    /// Values from the summits.
    pub counted: GreenwoodWilliamson,
    /// Values from the moments.
    pub by_moments: GreenwoodWilliamson,
}

/// Parameters of ISO 21920-2 of the roughness, means over all lines; of a single line those along it.
#[derive(Serialize)]
pub struct Profiles {
    /// Nesting index of the filter.
    pub cutoff: Metre,
    /// Parameters along x.
    pub x: Option<ProfileParameters>,
    /// Parameters along y.
    pub y: Option<ProfileParameters>,
}

/// Returns the axis of a single line of heights; none for several lines.
pub fn line_of(topography: &Topography) -> Option<Axis> {
    match topography.grid().shape {
        [nx, 1] if nx > 1 => Some(Axis::X),
        [1, ny] if ny > 1 => Some(Axis::Y),
        _ => None,
    }
}

/// Returns the default cut-off for a line: the longest of ISO 21920-3 that fits five times into the line,
/// else a fifth of the line.
pub fn cutoff_of_a_line(topography: &Topography) -> Option<Metre> {
    const CUTOFFS: [Metre; 5] = [8e-3, 2.5e-3, 0.8e-3, 0.25e-3, 0.08e-3];
    let axis = line_of(topography)?;
    let grid = topography.grid();
    let [fifth, pitch] = [grid.extent()[axis as usize] / 5.0, grid.pitch[axis as usize]];
    let cutoff = CUTOFFS.into_iter().find(|cutoff| *cutoff <= fifth).unwrap_or(fifth);
    Some(cutoff).filter(|cutoff| *cutoff >= 2.0 * pitch)
}

impl Description {
    /// Describes a topography, whose pitch may be unknown.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a cut-off that does not suit the lines.
    pub fn new(topography: &Topography, has_pitch: bool, cutoff: Option<Metre>) -> Result<Self> {
        let line = line_of(topography);
        let parameters = line.is_none().then(|| {
            let mut parameters = topography.parameters();
            if !has_pitch {
                // These quantities need lengths along the surface.
                parameters.spatial = SpatialParameters::undefined();
                parameters.hybrid = HybridParameters::undefined();
                parameters.feature = FeatureParameters::undefined();
            }
            parameters
        });
        let profiles = cutoff.map(|cutoff| {
            let along = |axis| {
                let exists = line.is_none_or(|line| line == axis);
                exists.then(|| topography.profile_parameters(axis, cutoff)).transpose()
            };
            Ok::<_, Error>(Profiles { cutoff, x: along(Axis::X)?, y: along(Axis::Y)? })
        });
        let statistics = (has_pitch && line.is_none()).then(|| Statistics::of(topography));
        Ok(Self { parameters, statistics, profiles: profiles.transpose()?, has_pitch })
    }

    /// Adds the numbers to a table, in sections.
    pub fn add_to(&self, table: &mut Table) {
        let parameters = self.parameters.as_ref().map_or_else(Vec::new, Parameters::rows);
        for family in parameters.chunk_by(|a, b| a.family == b.family) {
            table.title(format!("{} parameters, ISO 25178-2", family[0].family));
            for row in family {
                let alike = parameters.iter().filter(|other| is_of_one_column(row, other));
                let multiple = row.unit.multiple(alike.map(|other| other.value));
                // Without a pitch no length along the surface is known.
                let why = self.has_pitch.then_some(row.value);
                table.numbers(row.symbol, [row.value], &multiple, meaning(row, why));
            }
        }
        if let Some(statistics) = &self.statistics {
            about_statistics(table, statistics);
        }
        if let Some(profiles) = &self.profiles {
            about_profiles(table, profiles);
        }
    }
}

impl Statistics {
    fn of(topography: &Topography) -> Self {
        let spectrum = Spectrum::new(topography, Window::Hann);
        let moments = spectrum.moments();
        Self {
            moments,
            bandwidth: moments.bandwidth(),
            asperities: Asperities {
                counted: Summits::new(topography).greenwood_williamson(),
                by_moments: moments.greenwood_williamson(),
            },
            self_affine: SelfAffinity::of_longest_range(&spectrum.radial(RINGS)).ok().map(Law::from),
        }
    }
}

/// Whether two parameters are printed in one unit: heights with heights, lengths along the surface with such.
fn is_of_one_column(one: &Parameter, other: &Parameter) -> bool {
    let along = |row: &Parameter| row.family == "spatial";
    one.unit == other.unit && along(one) == along(other)
}

fn about_statistics(table: &mut Table, statistics: &Statistics) {
    let Statistics { moments, bandwidth, asperities, self_affine } = statistics;
    let in_units = |factor: f64, symbol: &str| Multiple { factor, symbol: symbol.to_owned() };
    let pure = in_units(1.0, "");
    table.title("spectral moments, along x | along y");
    table.numbers("m0", [moments.m0], &Unit::Area.multiple([moments.m0]), "mean square height");
    table.numbers("m2", moments.m2, &pure, "mean square slope");
    table.numbers("m4", moments.m4, &in_units(1e12, "/µm²"), "mean square second derivative");
    table.numbers("α", [*bandwidth], &pure, "Nayak's bandwidth, m0 m4/m2²");
    table.title("asperities of Greenwood and Williamson, counted as summits | from the moments");
    let heights = [&asperities.counted, &asperities.by_moments].map(|found| found.height_deviation);
    let heights = Unit::Length.multiple(heights);
    let mut row = |name, unit: Option<Unit>, value: fn(&GreenwoodWilliamson) -> f64, remark| {
        let values = [&asperities.counted, &asperities.by_moments].map(value);
        let multiple = unit.map_or_else(|| heights.clone(), |unit| unit.multiple(values));
        table.numbers(name, values, &multiple, remark);
    };
    row("η", Some(Unit::PerArea), |found| found.density, "density");
    row("R", Some(Unit::Length), |found| found.radius, "radius of the tips");
    row("σs", None, |found| found.height_deviation, "standard deviation of their heights");
    row("zs", None, |found| found.mean_height, "mean height above that of the surface");
    if let Some(Law { fit: law, doubt, .. }) = self_affine {
        table.title("self-affine law, on the longest range of the spectrum that follows one");
        table.words("H", format!("{:.3} ± {:.3}", law.hurst, law.hurst_error), "Hurst exponent");
        let wavelength = |q: f64| Unit::Length.format(std::f64::consts::TAU / q);
        let range = format!("{} … {}", wavelength(law.range[1]), wavelength(law.range[0]));
        table.words("range", range, "wavelengths");
        if let Some(doubt) = doubt {
            table.words("H", doubt, "");
        }
    }
}

/// The parameters along both axes, or along the only one of a line.
fn about_profiles(table: &mut Table, profiles: &Profiles) {
    let cutoff = Unit::Length.format(profiles.cutoff);
    let axes = [("along x", &profiles.x), ("along y", &profiles.y)];
    let shown = axes.iter().filter_map(|(name, parameters)| Some((*name, parameters.as_ref()?.rows())));
    let (names, columns): (Vec<_>, Vec<_>) = shown.unzip();
    table.title(format!("profile parameters, ISO 21920-2, cut-off {cutoff}: {}", names.join(" | ")));
    // These lengths lie along the surface, the others are heights.
    let along = |row: &Parameter| ["Rsm", "Rdl"].contains(&row.symbol);
    for (n, row) in columns.first().into_iter().flatten().enumerate() {
        let alike = columns.iter().flatten();
        let alike = alike.filter(|other| row.unit == other.unit && along(row) == along(other));
        let multiple = row.unit.multiple(alike.map(|other| other.value));
        table.numbers(row.symbol, columns.iter().map(|column| column[n].value), &multiple, row.meaning);
    }
}
