//! Reasons not to trust films of oil.

use super::Lubricant;
use super::views::{FilmOfPoint, films_at_speeds};
use crate::lubrication::ViscosityLaw;
use crate::motion::{LubricationRecord, SweepRecord};
use crate::units::{Dimension, Metre, MetrePerSecond, Pascal, format, format_number_digits};
use crate::with::views::percent;

/// Largest difference to half as many cells without a warning: of the mean film, relative, and of the share of the
/// solids.
const UNCERTAIN: [f64; 2] = [0.1, 0.05];

/// Pressures up to which the laws of viscosity are used: Barus fails above some 0.3 GPa and Roelands above some 1 GPa
/// (Bair, High Pressure Rheology for Quantitative EHL).
const BARUS: Pascal = 0.3e9;
const ROELANDS: Pascal = 1.2e9;

/// Thickness below which an oil is no continuum: some ten molecules.
const MOLECULES: Metre = 5e-9;

/// Distance of a fully flooded inlet over that of the grid from which on a film is starved.
const STARVED: f64 = 1.03;

/// Share of the load above which the friction of the solids matters.
const MATTERS: f64 = 0.01;

/// Traction coefficient of the oil above which it needs a limit: traction fluids have 0.12.
const NEWTONIAN: f64 = 0.12;

/// Returns reasons in the points of a sweep not to trust its films; each names the speed at which it is worst.
pub(in crate::with) fn after_points(oil: &Lubricant, points: &[SweepRecord]) -> Vec<String> {
    let films = films_at_speeds(points);
    let at = |speed: &MetrePerSecond| format(*speed, Dimension::Speed);
    // The film for which a value is largest above a limit, with its speed.
    let worst = |value: &dyn Fn(&LubricationRecord) -> f64, limit: f64| {
        let beyond = films.iter().filter(|at| value(&at.film) > limit);
        let worst = beyond.max_by(|a, b| value(&a.film).total_cmp(&value(&b.film)));
        worst.map(|FilmOfPoint { speed, film }| ((speed, film), value(film)))
    };
    let mut doubts = Vec::new();
    let share = |film: &LubricationRecord| film.solid_share_uncertainty.unwrap_or(0.0);
    let thickness =
        |film: &LubricationRecord| film.mean_film_uncertainty.map_or(0.0, |off| off / film.mean_film);
    if let Some(((speed, film), off)) = worst(&share, UNCERTAIN[1]) {
        doubts.push(format!(
            "the grid decides who bears the load: at {} the solids bear {}, and {} more or less on half as many cells along both axes; \
             asperities and the wedges of oil between them need a finer grid",
            at(speed),
            percent(film.solid_share),
            percent(off)
        ));
    } else if let Some(((speed, _), off)) = worst(&thickness, UNCERTAIN[0]) {
        doubts.push(format!(
            "the grid decides the film: at {} its mean differs by {} on half as many cells along both axes; take a finer grid",
            at(speed),
            percent(off)
        ));
    }
    if let Some(FilmOfPoint { speed, .. }) = films.iter().find(|at| at.film.mean_film_uncertainty.is_none()) {
        doubts.push(format!(
            "at {} there is no film on half as many cells to compare with: the uncertainty of the grid is unknown",
            at(speed)
        ));
    }
    let short = |film: &LubricationRecord| film.inlet_ratio.map_or(0.0, f64::recip);
    if let Some(((speed, _), factor)) = worst(&short, STARVED) {
        doubts.push(format!(
            "the inlet is too short at {}, and the film is starved: a fully flooded one begins {} times as far ahead of the centre of the \
             contact; make the grid longer along x",
            at(speed),
            format_number_digits(factor, 3)
        ));
    }
    let (limit, name) = match oil.viscosity_law() {
        ViscosityLaw::Constant => (f64::INFINITY, ""),
        ViscosityLaw::Barus => (BARUS, "Barus' law of viscosity is far too stiff"),
        ViscosityLaw::Roelands => (ROELANDS, "Roelands' law of viscosity has not been measured"),
    };
    if let Some(((speed, _), most)) = worst(&|film| film.max_oil_pressure, limit) {
        doubts.push(format!(
            "the oil has up to {} at {}: {name} above some {}",
            format(most, Dimension::Pressure),
            at(speed),
            format(limit, Dimension::Pressure)
        ));
    }
    let thin =
        |film: &LubricationRecord| if film.solid_share < 0.5 { MOLECULES / film.mean_film } else { 0.0 };
    if let Some(((speed, film), _)) = worst(&thin, 1.0) {
        doubts.push(format!(
            "the film of {} at {} is a few molecules thick, where oil is no continuum",
            format(film.mean_film, Dimension::Length),
            at(speed)
        ));
    }
    if let Some(((speed, film), _)) =
        worst(&|film| film.solid_share, MATTERS).filter(|_| oil.boundary_friction.is_none())
    {
        doubts.push(format!(
            "the solids bear {} of the load at {}, and the traction leaves their friction out: give `boundary_friction` in [lubrication]",
            percent(film.solid_share),
            at(speed)
        ));
    }
    let is_newtonian = oil.limiting_stress.is_none() && oil.eyring_stress.is_none();
    let of_oil = |film: &LubricationRecord| {
        film.traction_coefficient - oil.boundary_friction.unwrap_or(0.0) * film.solid_share
    };
    if let Some(((speed, _), traction)) = worst(&of_oil, NEWTONIAN).filter(|_| is_newtonian) {
        doubts.push(format!(
            "the traction coefficient of the oil at {} is {}, more than oils have: under pressure they shear at a limiting stress; give \
             `limiting_stress` (0.03 to 0.1) or `eyring_stress` in [lubrication]",
            at(speed),
            format_number_digits(traction, 3)
        ));
    }
    if let Some(((speed, _), share)) = worst(&|film| film.hardness_share, 1.0) {
        doubts.push(format!(
            "at {} the pressure is up to {} times the hardness, which does not limit it under a film of oil",
            at(speed),
            format_number_digits(share, 3)
        ));
    }
    doubts
}
