//! `asperity surface plot`: figures of a topography, and their curves as numbers.

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

use asperity::Field;
use asperity::io;
use asperity::surface::{
    Axis as Direction, BearingCurve, Classes, Correlation, Distribution, SelfAffinity, Slope, SpectralPoint,
    Spectrum, Topography, WOLF_PRUNING, Window,
};
use asperity::units::Metre;
use serde_json::{Value, json};

use super::{read_prepared, suggest_level, without_pitch};
use crate::args::PlotSurface;
use crate::report::{Failure, Outcome, note};
use asperity_report::describe::{Law, line_of};
use asperity_report::draw::{
    self, Axis, Caption, Chart, Charts, Colours, Figure, Map, Maps, Mark, Paper, Quantity, Relief, Series,
    Unit,
};
use asperity_report::figures::RINGS;

/// Points of a sampled curve.
const POINTS: usize = 501;
/// Decades of the map of a spectrum below its largest value.
const DECADES: i32 = 8;

pub(super) fn plot(arguments: &PlotSurface) -> Outcome {
    let out = &arguments.out.clone().unwrap_or_else(|| beside(&arguments.input.file));
    if out.exists() && !arguments.overwrite {
        let message = format!("`{}` exists", out.display());
        return Err(Failure::usage(message, Some("--overwrite replaces the figures in it")));
    }
    let file = read_prepared(&arguments.input)?;
    if file.pitch.is_none() {
        let message = "the figures need a pitch, which the heights have not";
        return Err(without_pitch(message));
    }
    if file.topography.defined() == 0 {
        return Err(asperity::Error::NothingDefined { samples: file.topography.grid().cells() }.into());
    }
    suggest_level(&file.topography);
    let folder = |source| asperity::Error::File { path: out.clone(), source };
    std::fs::create_dir_all(out).map_err(folder)?;
    io::sweep(out);
    let name = arguments.input.file.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let sheet =
        Sheet { folder: out.clone(), topography: &file.topography, name, papers: arguments.drawing.papers() };
    if let Some(axis) = line_of(&file.topography) {
        let curves = json!({ "profile": sheet.profile(axis)?, "spectrum": sheet.spectrum_along(axis)?, "bearing": sheet.bearing()? });
        io::replace(&out.join("curves.json"), format!("{curves:#}\n").as_bytes())?;
        note(&format!("figures of the profile and curves.json in {}", out.display()));
        return Ok(());
    }
    let curves = json!({
        "bearing": sheet.bearing()?,
        "distributions": sheet.distributions()?,
        "spectrum": sheet.spectrum()?,
        "autocorrelation": sheet.autocorrelation()?,
    });
    sheet.heights()?;
    sheet.hills()?;
    io::replace(&out.join("curves.json"), format!("{curves:#}\n").as_bytes())?;
    note(&format!("figures and curves.json in {}", out.display()));
    Ok(())
}

/// The folder for the figures of a file where none is named: `scans/disc.x3p` → `scans/disc-figures`.
fn beside(file: &Path) -> PathBuf {
    let mut name = file.file_stem().unwrap_or_default().to_owned();
    name.push("-figures");
    file.with_file_name(name)
}

/// Directory and content of the figures.
struct Sheet<'a> {
    folder: PathBuf,
    topography: &'a Topography,
    /// Name of the file.
    name: String,
    papers: Vec<Paper>,
}

impl Sheet<'_> {
    /// Draws the heights of a single line as a curve.
    fn profile(&self, axis: Direction) -> Outcome<Value> {
        let profile = self.topography.profile(axis, 0)?;
        let place = |(k, z): (usize, &f64)| [(k as f64 + 0.5) * profile.pitch(), *z];
        let points: Vec<[f64; 2]> = profile.heights().iter().enumerate().map(place).collect();
        let x = Axis::linear(["x", "y"][axis as usize], Unit::Length);
        let series = vec![Series::new("", points.clone(), Mark::Line)];
        self.chart("profile", "profile", x, Axis::linear("height", Unit::Length), series)?;
        Ok(json!(points))
    }

    /// Draws the spectrum along the only axis of a line.
    fn spectrum_along(&self, axis: Direction) -> Outcome<Value> {
        let along = Spectrum::new(self.topography, Window::Hann).along(axis);
        let shown = along.iter().filter(|p| p.wave_number > 0.0 && p.density > 0.0);
        let points = shown.map(|p| [p.wave_number, p.density]).collect();
        let x = Axis::log("wave number", Unit::Wavenumber);
        let series = vec![Series::new("", points, Mark::Line)];
        self.chart(
            "spectrum",
            "power spectral density along the profile",
            x,
            Axis::log("C", Unit::Of("m³")),
            series,
        )?;
        Ok(json!(along))
    }

    fn heights(&self) -> Outcome {
        let (heights, grid) = (self.topography.heights(), self.topography.grid());
        self.save("heights", "heights", &draw::heights(heights, grid))?;
        let relief = Relief::of_heights(heights, grid);
        if relief.is_flat() {
            return Ok(());
        }
        self.save("relief", "heights in perspective", &relief)
    }

    /// Draws the heights, without the borders of the hills.
    fn hills(&self) -> Outcome {
        let labels = self.topography.hills(WOLF_PRUNING)?.labels;
        let mut heights = self.topography.heights().clone();
        let [nx, ny] = self.topography.grid().shape;
        for ((ix, iy), z) in heights.indexed_iter_mut() {
            let own = labels[[ix, iy]];
            if (ix + 1 < nx && labels[[ix + 1, iy]] != own) || (iy + 1 < ny && labels[[ix, iy + 1]] != own) {
                *z = f64::NAN;
            }
        }
        let map = draw::heights(&heights, self.topography.grid());
        self.save("hills", "hills (segments above 5 % of Sz)", &map.remark("grey: borders between hills"))
    }

    fn save(&self, name: &str, title: &str, figure: &dyn Figure) -> Outcome {
        let caption = Caption { title: title.to_owned(), of: self.name.clone() };
        for paper in &self.papers {
            let path = self.folder.join(format!("{name}.{}", paper.format.extension()));
            draw::save(&path, figure, &caption, paper)?;
        }
        Ok(())
    }

    fn chart(&self, name: &str, title: &str, x: Axis, y: Axis, series: Vec<Series>) -> Outcome {
        self.save(name, title, &Charts::from(Chart::new("", x, y, series)))
    }

    /// Draws the material ratio curve with the line through its core.
    fn bearing(&self) -> Outcome<Value> {
        let curve = self.topography.bearing_curve()?;
        let points = curve.sampled(POINTS);
        let core = core_line(&curve);
        // The figure uses per cent, like the parameters.
        let per_cent = |points: &[[f64; 2]]| points.iter().map(|[ratio, z]| [100.0 * ratio, *z]).collect();
        let mut series = vec![Series::new("material ratio curve", per_cent(&points), Mark::Line)];
        if let Some(core) = &core {
            series.push(Series::new("core", per_cent(core), Mark::Dashed));
        }
        let x = Axis { range: Some([0.0, 100.0]), ..Axis::linear("material ratio", Unit::Of("%")) };
        let y = Axis::linear("height above the mean", Unit::Length);
        self.chart("bearing", "material ratio (Abbott–Firestone) curve", x, y, series)?;
        Ok(json!({ "ratio_height": points, "core": core }))
    }

    /// Draws the densities of the heights and of the slopes, each with the Gaussian of the same mean square.
    fn distributions(&self) -> Outcome<Value> {
        let heights = self.topography.height_distribution(Classes::default());
        let slopes = [("along x", Slope::X), ("along y", Slope::Y)]
            .map(|(name, slope)| (name, self.topography.slope_distribution(slope, Classes::default())));
        let mut json = json!({ "heights": null, "slopes": {} });
        if let Ok(heights) = heights {
            let points = bars(&heights);
            let series = vec![
                Series::new("heights", points.clone(), Mark::Line),
                Series::new("Gaussian", gaussian(&heights, self.topography.sq()), Mark::Dashed),
            ];
            let x = Axis::linear("height above the mean", Unit::Length);
            self.density("height-distribution", "distribution of the heights", x, Unit::PerLength, series)?;
            json["heights"] = json!(points);
        }
        let mut series = Vec::new();
        for (name, slopes) in slopes {
            if let Ok(slopes) = slopes {
                let points = bars(&slopes);
                json["slopes"][name] = json!(points);
                series.push(Series::new(name, points, Mark::Line));
            }
        }
        if !series.is_empty() {
            let x = Axis::linear("slope", Unit::Number);
            self.density("slope-distribution", "distribution of the slopes", x, Unit::Number, series)?;
        }
        Ok(json)
    }

    fn density(&self, name: &str, title: &str, x: Axis, unit: Unit, series: Vec<Series>) -> Outcome {
        let y = Axis::linear("density", unit);
        self.chart(name, title, x, y, series)
    }

    /// Draws the spectrum averaged over all directions with its power law, and as a map.
    fn spectrum(&self) -> Outcome<Value> {
        let spectrum = Spectrum::new(self.topography, Window::Hann);
        let radial = spectrum.radial(RINGS);
        let points = |points: &[SpectralPoint]| -> Vec<[f64; 2]> {
            points.iter().filter(|p| p.wave_number > 0.0).map(|p| [p.wave_number, p.density]).collect()
        };
        let mut series = vec![Series::new("mean over all directions", points(&radial), Mark::LineAndPoints)];
        let law = SelfAffinity::of_longest_range(&radial).ok();
        if let Some(law) = law {
            let name = match law.doubt() {
                None => format!("self-affine, H = {:.2}", law.hurst),
                Some(_) => format!("H = {:.2}, {:.1} decades: a slope, not a law", law.hurst, law.decades()),
            };
            series.push(Series::new(name, power_law(&law, &radial), Mark::Dashed));
        }
        let x = Axis::log("wave number", Unit::Wavenumber);
        self.chart("spectrum", "power spectral density", x, Axis::log("C", Unit::Of("m⁴")), series)?;
        self.spectrum_map(&spectrum)?;
        Ok(json!({
            "radial": radial,
            "x": spectrum.along(Direction::X),
            "y": spectrum.along(Direction::Y),
            "self_affine": law.map(Law::from),
        }))
    }

    fn spectrum_map(&self, spectrum: &Spectrum) -> Outcome {
        let grid = self.topography.grid();
        let field = Field::from_shape_fn(grid.shape, |(i, j)| {
            let wave = |axis: usize, index: usize| index as isize - (grid.shape[axis] / 2) as isize;
            spectrum.density_at([wave(0, i), wave(1, j)])
        });
        let largest = field.iter().copied().fold(0.0, f64::max);
        // A plane has no spectrum, and heights of 10¹⁵⁰ m overflow.
        if largest == 0.0 || !largest.is_finite() {
            return Ok(());
        }
        let step = grid.extent().map(|length| TAU / length);
        let quantity = Quantity::new("C", Unit::Of("m⁴"));
        let names = ["wave number along x", "wave number along y"];
        let map = Map::plane("", &field, step, names, Unit::Wavenumber, quantity, Colours::Logarithmic);
        let map = map.range([largest * 10f64.powi(-DECADES), largest]);
        self.save("spectrum-map", "power spectral density, Hann's window", &Maps::new(vec![map]))
    }

    /// Draws the autocorrelation as a map, and along lines.
    fn autocorrelation(&self) -> Outcome<Value> {
        let correlation = Correlation::new(self.topography);
        let variance = correlation.variance();
        if variance == 0.0 {
            return Ok(Value::Null);
        }
        let field = correlation.values() / variance;
        let names = ["lag along x", "lag along y"];
        let (step, quantity) = (self.topography.grid().pitch, Quantity::new("R/Sq²", Unit::Number));
        let map = Map::plane("", &field, step, names, Unit::Length, quantity, Colours::Heights);
        self.save("autocorrelation-map", "autocorrelation", &Maps::new(vec![map]))?;
        let share = |curve: Vec<(Metre, f64)>| -> Vec<[f64; 2]> {
            curve.into_iter().map(|(lag, r)| [lag, r / variance]).collect()
        };
        let curves = [
            ("x", "along x", share(correlation.along(Direction::X))),
            ("y", "along y", share(correlation.along(Direction::Y))),
            ("radial", "mean over all directions", share(correlation.radial())),
        ];
        let mut json = json!({});
        let mut series = Vec::new();
        for (key, name, points) in curves {
            json[key] = json!(points);
            series.push(Series::new(name, points, Mark::Line));
        }
        let x = Axis::linear("lag", Unit::Length);
        self.chart("autocorrelation", "autocorrelation", x, Axis::linear("R/Sq²", Unit::Number), series)?;
        Ok(json)
    }
}

/// Returns the straight line from the upper to the lower end of the core.
fn core_line(curve: &BearingCurve) -> Option<Vec<[f64; 2]>> {
    curve.core().map(|core| vec![[0.0, core.upper], [1.0, core.lower]])
}

/// Returns the middle of each class and its density.
fn bars(distribution: &Distribution) -> Vec<[f64; 2]> {
    let density = distribution.density.iter().enumerate();
    density.map(|(class, density)| [distribution.centre(class), *density]).collect()
}

fn gaussian(distribution: &Distribution, deviation: f64) -> Vec<[f64; 2]> {
    let [first, last] = [0, distribution.density.len() - 1].map(|class| distribution.centre(class));
    let points = (0..POINTS).map(|i| first + (last - first) * i as f64 / (POINTS - 1) as f64);
    let density = |z: f64| (-0.5 * (z / deviation).powi(2)).exp() / (TAU.sqrt() * deviation);
    points.map(|z| [z, density(z)]).collect()
}

/// Returns the law on its range, through the geometric mean of the fitted points.
fn power_law(law: &SelfAffinity, radial: &[SpectralPoint]) -> Vec<[f64; 2]> {
    let inside = || {
        let range = law.range[0] * (1.0 - 1e-9)..=law.range[1] * (1.0 + 1e-9);
        radial.iter().filter(move |p| range.contains(&p.wave_number) && p.density > 0.0)
    };
    let exponent = -2.0 - 2.0 * law.hurst;
    let level = inside().map(|p| p.density.ln() - exponent * p.wave_number.ln()).sum::<f64>();
    let level = level / inside().count() as f64;
    law.range.map(|q| [q, (level + exponent * q.ln()).exp()]).to_vec()
}
