//! Films of oil in words and curves.

use super::Lubricant;
use crate::lubrication::{Oil, ViscosityLaw};
use crate::motion::{FilmRecord, LubricationRecord, PassRecord, SweepRecord};
use crate::units::{Dimension, MetrePerSecond, format, format_digits, format_number, format_number_digits};
use crate::with::views::{Answer, BesidePoints, OfPoints, percent};
use asperity_base::choice::Choice;

/// The curves over the points of a sweep: the Stribeck curve, who bears the load, and the film.
pub(in crate::with) const OF_POINTS: [OfPoints; 3] = [
    OfPoints {
        column: "traction_coefficient",
        label: "traction coefficient",
        may_be_log: false,
        value: |point| Some(point.lubrication?.film.traction_coefficient),
        beside: &[],
    },
    OfPoints {
        column: "solid_share",
        label: "share of the solids in the load",
        may_be_log: false,
        value: |point| Some(point.lubrication?.film.solid_share),
        beside: &[],
    },
    OfPoints {
        column: "mean_film",
        label: "film",
        may_be_log: true,
        value: |point| Some(point.lubrication?.film.mean_film),
        beside: &[
            BesidePoints {
                name: "mean over the contact",
                value: |point| Some(point.lubrication?.film.mean_film),
                is_dashed: false,
            },
            BesidePoints {
                name: "least",
                value: |point| Some(point.lubrication?.film.min_film),
                is_dashed: false,
            },
            BesidePoints {
                name: "Hamrock and Dowson, smooth bodies",
                value: |point| point.lubrication?.hamrock_dowson_film,
                is_dashed: true,
            },
        ],
    },
];

impl Lubricant {
    /// Describes the oil for `asperity check`.
    pub fn describe(&self, oil: &Oil) -> String {
        let name = self.oil.map_or(String::new(), |named| format!("{}, ", named.name));
        let viscosity = format(oil.viscosity, Dimension::Viscosity);
        let rises = match oil.law {
            ViscosityLaw::Constant => "at any pressure".to_owned(),
            law => {
                let rise = format(oil.pressure_viscosity, Dimension::PerPressure);
                format!("rising with pressure by {rise} ({})", law.word())
            }
        };
        let shear = match (self.limiting_stress, self.eyring_stress) {
            (Some(share), _) => format!(", shear up to {} of the pressure", format_number(share)),
            (_, Some(stress)) => format!(", Eyring's stress {}", format(stress, Dimension::Pressure)),
            (None, None) => String::new(),
        };
        format!("{name}viscosity {viscosity} {rises}{shear}")
    }
}

/// Returns what the points of a sweep show of films of oil: film, shares and friction at the only speed, or the curve
/// over the speeds.
pub(in crate::with) fn answers(points: &[SweepRecord]) -> Vec<Answer> {
    match films_at_speeds(points).as_slice() {
        [] => Vec::new(),
        [film] => one(film),
        films => several(films),
    }
}

/// Returns the films of the points, each with its speed.
pub(super) fn films_at_speeds(points: &[SweepRecord]) -> Vec<FilmOfPoint> {
    let films = points.iter().filter_map(|point| Some((point.speed?, point.lubrication?)));
    films.map(|(speed, film)| FilmOfPoint { speed, film }).collect()
}

/// The film at a speed.
#[derive(Clone, Copy)]
pub(super) struct FilmOfPoint {
    pub(super) speed: MetrePerSecond,
    pub(super) film: LubricationRecord,
}

/// Writes a number with what it may be wrong by, if that is known and seen.
fn with_uncertainty(value: &str, uncertainty: Option<f64>, write: impl Fn(f64) -> String) -> String {
    match uncertainty {
        Some(off) if off > 0.0 => format!("{value} ± {}", write(off)),
        _ => value.to_owned(),
    }
}

fn film_in_words(film: &LubricationRecord) -> String {
    let thickness = format_digits(film.film.mean_film, Dimension::Length, 3);
    let multiple = Dimension::Length.multiple(film.film.mean_film);
    let off = film.mean_film_uncertainty.filter(|off| *off > 5e-4 * film.film.mean_film);
    with_uncertainty(&thickness, off, |off| {
        format!("{} {}", format_number_digits(off / multiple.factor, 1), multiple.symbol)
    })
}

fn lambda_in_words(film: &FilmRecord) -> String {
    film.lambda.map_or(String::new(), |lambda| format!(" (λ = {})", format_number_digits(lambda, 2)))
}

fn friction_in_words(film: &LubricationRecord) -> String {
    let friction = film.film.traction_coefficient;
    let off = film.traction_uncertainty.filter(|off| *off > 5e-3 * friction);
    with_uncertainty(&format_number_digits(friction, 3), off, |off| format_number_digits(off, 1))
}

fn one(FilmOfPoint { speed, film }: &FilmOfPoint) -> Vec<Answer> {
    let speed = format(*speed, Dimension::Speed);
    let lambda = lambda_in_words(&film.film);
    let thickness = film_in_words(film);
    let friction = friction_in_words(film);
    let solids = percent(film.film.solid_share);
    let borne = if film.film.solid_share > 0.0 {
        format!("the solids bear {solids} of the load")
    } else {
        "the oil bears all of the load".to_owned()
    };
    let answer = |name: &'static str, value: String, about: &str, sentence: String| Answer {
        name: name.into(),
        value,
        about: about.to_owned(),
        sentence,
    };
    vec![
        answer(
            "film",
            thickness.clone(),
            "Mean film over the contact, ± its difference to that on half as many cells.",
            format!(
                "At {speed} the film is {thickness} thick{lambda}, {borne}, and the traction coefficient is {friction}."
            ),
        ),
        answer("share of the solids", solids, "Share of the load that the solids bear.", String::new()),
        answer(
            "traction coefficient",
            friction,
            "Shear of the oil and friction of the solids, over the load.",
            String::new(),
        ),
    ]
}

/// Returns what passes of lubricated bodies show: the film and the friction of the last one; `None` of others.
pub(in crate::with) fn in_passes(passes: &[PassRecord]) -> Option<Answer> {
    let film = passes.last()?.film?;
    let thickness = format_digits(film.mean_film, Dimension::Length, 3);
    let friction = format_number_digits(film.traction_coefficient, 3);
    let last = if passes.len() > 1 { "In the last pass" } else { "On average" };
    Some(Answer {
        name: "film".into(),
        about: "Mean film over the contact and the positions of the last pass.".into(),
        sentence: format!(
            "{last} the film is {thickness} thick{}, the solids bear {} of the load, and the traction coefficient is {friction}.",
            lambda_in_words(&film),
            percent(film.solid_share)
        ),
        value: thickness,
    })
}

fn several(films: &[FilmOfPoint]) -> Vec<Answer> {
    let by = |value: fn(&FilmOfPoint) -> f64| {
        move |a: &&FilmOfPoint, b: &&FilmOfPoint| value(a).total_cmp(&value(b))
    };
    let speed = |at: &FilmOfPoint| format(at.speed, Dimension::Speed);
    let (Some(slowest), Some(fastest), Some(least), Some(most)) = (
        films.iter().min_by(by(|at| at.speed)),
        films.iter().max_by(by(|at| at.speed)),
        films.iter().min_by(by(|at| at.film.film.traction_coefficient)),
        films.iter().max_by(by(|at| at.film.film.traction_coefficient)),
    ) else {
        return Vec::new();
    };
    let borne = |at: &FilmOfPoint| percent(at.film.film.solid_share);
    let value = friction_in_words(&least.film);
    vec![Answer {
        name: "least traction coefficient".into(),
        about: format!("At {}.", speed(least)),
        sentence: format!(
            "The traction coefficient is least at {}: {value}, under a film of {}; it is largest at {}: {}. From {} to {} the film \
             grows from {} to {}, and the share of the solids in the load goes from {} to {}.",
            speed(least),
            film_in_words(&least.film),
            speed(most),
            friction_in_words(&most.film),
            speed(slowest),
            speed(fastest),
            film_in_words(&slowest.film),
            film_in_words(&fastest.film),
            borne(slowest),
            borne(fastest)
        ),
        value,
    }]
}
