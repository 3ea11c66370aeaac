//! Closed forms: one table of all questions.

use asperity::lubrication::OILS;
use asperity::material::{Coating, Compliances, MATERIALS, Material};
use asperity::motion::Watch;
use asperity::ndarray::{Array2, s};
use asperity::reference::{
    Carter, CattaneoMindlin, Cone, FlatPunch, HertzEllipse, HertzLine, HertzSphere, MindlinDeresiewicz,
    SlidingSphere, StickingPunch, StickingSphere, Westergaard, cattaneo, cell, rough, spence, westergaard,
};
use asperity::stress::Stress;
use asperity::{Error, Result};
use numpy::{IntoPyArray, PyArray2, PyReadonlyArray2};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use rayon::prelude::*;

use crate::arrays::{ok, record};
use crate::work;

/// Appends the answer at a point with these coordinates.
type Answer = Box<dyn Fn(&[f64], &mut Vec<f64>) + Send + Sync>;

/// Makes an `if` for each question: `form.method` from the data of the form, at the coordinates of a point,
/// and functions of coordinates alone.
macro_rules! answers {
    (
        $question:ident, $data:ident;
        $($name:literal $datum:pat => $form:expr, { $($method:ident [$($point:ident),*])* })*
        ;
        $($function:literal $argument:pat => $answer:expr,)*
    ) => {
        $($(
            if $question == concat!($name, ".", stringify!($method)) {
                let $datum = $data else { return None };
                let form = $form;
                return Some(Box::new(move |point, out| {
                    let &[$($point),*] = point else { unreachable!("the caller knows the coordinates") };
                    form.$method($($point),*).append(out);
                }));
            }
        )*)*
        $(
            if $question == $function {
                return Some(Box::new(|point, out| {
                    let $argument = point else { unreachable!("the caller knows the arguments") };
                    $answer.append(out);
                }));
            }
        )*
    };
}

/// Returns the answer to the `question` for a closed form with these `data`.
#[rustfmt::skip]
fn answer(question: &str, data: &[f64]) -> Option<Answer> {
    answers! {
        question, data;
        "HertzSphere" &[radius, modulus, load] => HertzSphere { radius, modulus, load }, {
            contact_radius[] approach[] peak_pressure[] elastic_energy[] pressure[r] displacement[r] axis_stress[depth, poisson]
        }
        "HertzLine" &[radius, modulus, load_per_length] => HertzLine { radius, modulus, load_per_length }, {
            half_width[] peak_pressure[] pressure[x] approach[datum] gap[x]
        }
        "HertzEllipse" &[rx, ry, modulus, load] => HertzEllipse::new([rx, ry], modulus, load), {
            contact_area[] elastic_energy[] pressure[x, y]
        }
        "Cone" &[slope, modulus, load] => Cone { slope, modulus, load }, {
            contact_radius[] approach[] mean_pressure[] elastic_energy[] pressure[r] displacement[r]
        }
        "FlatPunch" &[radius, modulus, load] => FlatPunch { radius, modulus, load }, {
            approach[] elastic_energy[] pressure[r] displacement[r]
        }
        "Westergaard" &[amplitude, wavelength, modulus, mean_pressure] =>
            Westergaard { amplitude, wavelength, modulus, mean_pressure }, {
            full_contact_pressure[] half_width[] contact_fraction[] mean_gap[] elastic_energy[] pressure[x] gap[x]
        }
        "CattaneoMindlin" &[radius, modulus, load, gt, friction, force] =>
            pushed([radius, modulus, load], gt, friction, force), {
            stick_radius[] displacement[] cycle_loss[] shear[r]
        }
        "MindlinDeresiewicz" &[radius, modulus, load, gt, friction, turn, tangential_load] =>
            MindlinDeresiewicz { turn: pushed([radius, modulus, load], gt, friction, turn), tangential_load }, {
            stick_radius[] displacement[] shear[r]
        }
        "Carter" &[radius, modulus, load_per_length, friction, tangential_load_per_length] => Carter {
            normal: HertzLine { radius, modulus, load_per_length }, friction, tangential_load_per_length
        }, {
            stick_half_width[] stick_centre[] creepage[] shear[x]
        }
        "SlidingSphere" &[radius, modulus, load, friction, poisson] => Sliding(SlidingSphere {
            normal: HertzSphere { radius, modulus, load }, friction, poisson
        }), {
            stress[x, y, depth]
        }
        "StickingPunch" &[radius, modulus, dundurs, load] => StickingPunch { radius, modulus, dundurs, load }, {
            approach[]
        }
        "StickingSphere" &[radius, modulus, dundurs, load] => StickingSphere { radius, modulus, dundurs, load }, {
            contact_radius[] approach[]
        }
        ;
        "HertzSphere.from_approach" &[radius, modulus, approach] => HertzSphere::from_approach(radius, modulus, approach).load,
        "HertzEllipse.approach" &[rx, ry, modulus, load] => HertzEllipse::new([rx, ry], modulus, load).approach,
        "HertzEllipse.peak_pressure" &[rx, ry, modulus, load] => HertzEllipse::new([rx, ry], modulus, load).peak_pressure,
        "HertzEllipse.semi_axes" &[rx, ry, modulus, load] => HertzEllipse::new([rx, ry], modulus, load).semi_axes,
        "Cone.from_approach" &[slope, modulus, approach] => Cone::from_approach(slope, modulus, approach).load,
        "FlatPunch.from_approach" &[radius, modulus, approach] => FlatPunch::from_approach(radius, modulus, approach).load,
        "Carter.from_creepage" &[radius, modulus, load_per_length, friction, creepage] =>
            Carter::from_creepage(HertzLine { radius, modulus, load_per_length }, friction, creepage)
                .tangential_load_per_length,
        "StickingPunch.from_approach" &[radius, modulus, dundurs, approach] =>
            StickingPunch::from_approach(radius, modulus, dundurs, approach).load,
        "StickingSphere.from_approach" &[radius, modulus, dundurs, approach] =>
            StickingSphere::from_approach(radius, modulus, dundurs, approach).load,
        "stick_ratio" &[friction, dundurs] => spence::stick_ratio(friction, dundurs),
        "stick_ratio_plane" &[friction, dundurs] => spence::stick_ratio_plane(friction, dundurs),
        "bgt_area_fraction" &[pressure, modulus, slope] => rough::bgt_area_fraction(pressure, modulus, slope),
        "persson_area_fraction" &[pressure, modulus, slope] => rough::persson_area_fraction(pressure, modulus, slope),
        "fully_plastic_area" &[load, hardness] => rough::fully_plastic_area(load, hardness),
        "corner_displacement" &[pressure, dx, dy, modulus] => cell::corner_displacement(pressure, [dx, dy], modulus),
        "centre_displacement" &[pressure, dx, dy, modulus] => cell::centre_displacement(pressure, [dx, dy], modulus),
        "mean_displacement" &[pressure, dx, dy, modulus] => cell::mean_displacement(pressure, [dx, dy], modulus),
        "full_contact_pressure_2d" &[amplitude, wavelength, modulus] =>
            westergaard::full_contact_pressure_2d(amplitude, wavelength, modulus),
        "light_contact_fraction_2d" &[pressure, full] => westergaard::light_contact_fraction_2d(pressure, full),
    }
    None
}

fn pushed(
    [radius, modulus, load]: [f64; 3],
    tangential_modulus: f64,
    friction: f64,
    tangential_load: f64,
) -> CattaneoMindlin {
    CattaneoMindlin {
        normal: HertzSphere { radius, modulus, load },
        tangential_modulus,
        friction,
        tangential_load,
    }
}

/// A point with three coordinates.
struct Sliding(SlidingSphere);

impl Sliding {
    fn stress(&self, x: f64, y: f64, depth: f64) -> Stress {
        self.0.stress([x, y], depth)
    }
}

/// The numbers of an answer.
trait Numbers {
    fn append(self, out: &mut Vec<f64>);
}

impl Numbers for f64 {
    fn append(self, out: &mut Vec<f64>) {
        out.push(self);
    }
}

impl<const N: usize> Numbers for [f64; N] {
    fn append(self, out: &mut Vec<f64>) {
        out.extend(self);
    }
}

impl Numbers for Stress {
    fn append(self, out: &mut Vec<f64>) {
        out.extend(self.components());
    }
}

/// Evaluates a closed form with these `data` at `points`, with one row of coordinates for each, and returns
/// one row of numbers for each.
#[pyfunction]
pub(crate) fn closed_form<'py>(
    py: Python<'py>,
    question: &str,
    data: Vec<f64>,
    points: PyReadonlyArray2<'py, f64>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    /// Number of points between two checks whether to stop; they take no longer than starting a thread.
    const STRIDE: usize = 1024;
    let Some(answer) = answer(question, &data) else {
        return Err(PyTypeError::new_err(format!("no closed form answers {question}")));
    };
    let points = points.as_array().as_standard_layout().into_owned();
    let count = points.nrows();
    let stride = |number: usize| {
        let mut values = Vec::new();
        for point in points.slice(s![number * STRIDE..count.min((number + 1) * STRIDE), ..]).outer_iter() {
            answer(point.as_slice().expect("rows stand one after the other"), &mut values);
        }
        values
    };
    let values = if count <= STRIDE {
        stride(0)
    } else {
        work::run(py, 0, None, |watch| {
            let watched = |number| if watch.stop() { Err(Error::Interrupted) } else { Ok(stride(number)) };
            let strides = (0..count.div_ceil(STRIDE)).into_par_iter().map(watched);
            Ok(strides.collect::<Result<Vec<_>>>()?.concat())
        })?
    };
    let width = values.len() / count.max(1);
    let values = Array2::from_shape_vec([count, width], values);
    Ok(values.expect("as many numbers at each point").into_pyarray(py))
}

/// Young's modulus and Poisson's ratio; thickness, Young's modulus and Poisson's ratio of each layer.
pub(crate) type Constants = (f64, f64, Vec<[f64; 3]>);

pub(crate) fn material((young, poisson, layers): Constants) -> Result<Material> {
    let layers =
        layers.into_iter().map(|[thickness, young, poisson]| Coating::new(thickness, young, poisson));
    Ok(Material::elastic(young, poisson)?.layered(layers.collect::<Result<_>>()?))
}

/// Returns the compliances of a pair, 1/E*, 1/N*, 1/G*, their E* and Dundurs' β, and the composite tangential
/// modulus.
#[pyfunction]
pub(crate) fn compliances(py: Python<'_>, lower: Constants, upper: Constants) -> PyResult<[f64; 6]> {
    let pair = || {
        let (lower, upper) = (material(lower)?, material(upper)?);
        let pair = Compliances::new(&lower, &upper)?;
        let Compliances { normal, lateral, coupling } = pair;
        let tangential = cattaneo::tangential_modulus(&lower, &upper);
        Ok([normal, lateral, coupling, pair.modulus(), pair.dundurs(), tangential])
    };
    ok(pair(), py)
}

/// Returns the materials that are known by name, each as a dictionary of its constants.
#[pyfunction]
pub(crate) fn named_materials(py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
    record(py, &MATERIALS)
}

/// Returns the lubricants that are known by name, each as a dictionary of its constants.
#[pyfunction]
pub(crate) fn named_oils(py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
    record(py, &OILS)
}

/// Returns Dundurs' β, friction, stick ratio and stiffening of the coupled punches.
pub(crate) fn coupled_punches() -> Vec<[f64; 4]> {
    let row =
        |punch: &spence::CoupledPunch| [punch.dundurs, punch.friction, punch.stick_ratio, punch.stiffening];
    spence::COUPLED.iter().map(row).collect()
}
