//! Reasons not to trust films of oil.

use super::Lubricant;
use super::views::{FilmOfPoint, films_at_speeds};
use crate::lubrication::ViscosityLaw;
use crate::motion::{FilmRecord, LubricationRecord, PassRecord, SweepRecord};
use crate::units::{Dimension, Metre, MetrePerSecond, Pascal, format, format_number_digits};
use crate::with::views::percent;

/// Largest difference to half as many cells without a warning: of the mean film, relative, and of the share of the
/// solids.
const UNCERTAIN: [f64; 2] = [0.1, 0.05];

/// Pressures up to which the laws of viscosity are used: Barus fails above some 0.3 GPa and Roelands above some 1 GPa;
/// free volumes are measured to some 2 GPa (Bair, High Pressure Rheology for Quantitative EHL).
const BARUS: Pascal = 0.3e9;
const ROELANDS: Pascal = 1.2e9;
const DOOLITTLE: Pascal = 2e9;

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
    let at = |speed: MetrePerSecond| format!("at {}", format(speed, Dimension::Speed));
    let mut doubts = of_the_grid(&films, at);
    doubts.extend(of_films(oil, &films.iter().map(|of| (at(of.speed), of.film.film)).collect::<Vec<_>>()));
    doubts
}

/// Returns reasons in the passes of a motion not to trust their films; each names the pass in which it is worst.
pub(in crate::with) fn after_passes(oil: &Lubricant, passes: &[PassRecord]) -> Vec<String> {
    let films = passes.iter().filter_map(|pass| Some((format!("in pass {}", pass.pass), pass.film?)));
    let films: Vec<_> = films.collect();
    let is_mixed = |(_, film): &&(String, FilmRecord)| (MATTERS..1.0 - MATTERS).contains(&film.solid_share);
    let mixed = films.iter().find(is_mixed).map(|(place, film)| {
        format!(
            "{place} the solids bear {} of the load: in mixed friction this share depends on the grid; compare it with that on cells of half the size",
            percent(film.solid_share)
        )
    });
    mixed.into_iter().chain(of_films(oil, &films)).collect()
}

/// Returns what films on half as many cells say about the grid.
fn of_the_grid(films: &[FilmOfPoint], at: impl Fn(MetrePerSecond) -> String) -> Vec<String> {
    let worst = |value: fn(&LubricationRecord) -> f64, limit: f64| {
        let beyond = films.iter().filter(|of| value(&of.film) > limit);
        let worst = beyond.max_by(|a, b| value(&a.film).total_cmp(&value(&b.film)));
        worst.map(|FilmOfPoint { speed, film }| (at(*speed), film, value(film)))
    };
    let share = |film: &LubricationRecord| film.solid_share_uncertainty.unwrap_or(0.0);
    let thickness =
        |film: &LubricationRecord| film.mean_film_uncertainty.unwrap_or(0.0) / film.film.mean_film;
    let mut doubts = Vec::new();
    if let Some((place, film, off)) = worst(share, UNCERTAIN[1]) {
        doubts.push(format!(
            "the grid decides who bears the load: {place} the solids bear {}, and {} more or less on half as many cells along both axes; \
             asperities and the wedges of oil between them need a finer grid",
            percent(film.film.solid_share),
            percent(off)
        ));
    } else if let Some((place, _, off)) = worst(thickness, UNCERTAIN[0]) {
        doubts.push(format!(
            "the grid decides the film: {place} its mean differs by {} on half as many cells along both axes; take a finer grid",
            percent(off)
        ));
    }
    if let Some(FilmOfPoint { speed, .. }) = films.iter().find(|of| of.film.mean_film_uncertainty.is_none()) {
        doubts.push(format!(
            "{} there is no film on half as many cells to compare with: the uncertainty of the grid is unknown",
            at(*speed)
        ));
    }
    doubts
}

/// Returns reasons not to trust films, each with its place in words, as "at 1 m/s".
fn of_films(oil: &Lubricant, films: &[(String, FilmRecord)]) -> Vec<String> {
    // The film for which a value is largest above a limit, with its place.
    let worst = |value: &dyn Fn(&FilmRecord) -> f64, limit: f64| {
        let beyond = films.iter().filter(|(_, film)| value(film) > limit);
        let worst = beyond.max_by(|(_, a), (_, b)| value(a).total_cmp(&value(b)));
        worst.map(|(place, film)| (place, film, value(film)))
    };
    let mut doubts = Vec::new();
    let short = |film: &FilmRecord| film.inlet_ratio.map_or(0.0, f64::recip);
    if let Some((place, _, factor)) = worst(&short, STARVED) {
        doubts.push(format!(
            "the inlet is too short {place}, and the film is starved: a fully flooded one begins {} times as far ahead of the centre of the \
             contact; make the grid longer along x",
            format_number_digits(factor, 3)
        ));
    }
    let (limit, name) = match oil.viscosity_law() {
        ViscosityLaw::Constant => (f64::INFINITY, ""),
        ViscosityLaw::Barus => (BARUS, "Barus' law of viscosity is far too stiff"),
        ViscosityLaw::Roelands => (ROELANDS, "Roelands' law of viscosity has not been measured"),
        ViscosityLaw::Doolittle => (DOOLITTLE, "Doolittle's law of viscosity has not been measured"),
    };
    if let Some((place, _, most)) = worst(&|film| film.max_oil_pressure, limit) {
        doubts.push(format!(
            "the oil has up to {} {place}: {name} above some {}",
            format(most, Dimension::Pressure),
            format(limit, Dimension::Pressure)
        ));
    }
    let thin = |film: &FilmRecord| if film.solid_share < 0.5 { MOLECULES / film.mean_film } else { 0.0 };
    if let Some((place, film, _)) = worst(&thin, 1.0) {
        doubts.push(format!(
            "the film of {} {place} is a few molecules thick, where oil is no continuum",
            format(film.mean_film, Dimension::Length)
        ));
    }
    if oil.boundary_friction.is_none()
        && let Some((place, film, _)) = worst(&|film| film.solid_share, MATTERS)
    {
        doubts.push(format!(
            "the solids bear {} of the load {place}, and the traction leaves their friction out: give `boundary_friction` in [lubrication]",
            percent(film.solid_share)
        ));
    }
    let of_oil = |film: &FilmRecord| {
        film.traction_coefficient - oil.boundary_friction.unwrap_or(0.0) * film.solid_share
    };
    if oil.limiting_stress.is_none()
        && oil.eyring_stress.is_none()
        && let Some((place, _, traction)) = worst(&of_oil, NEWTONIAN)
    {
        doubts.push(format!(
            "the traction coefficient of the oil {place} is {}, more than oils have: under pressure they shear at a limiting stress; give \
             `limiting_stress` (0.03 to 0.1) or `eyring_stress` in [lubrication]",
            format_number_digits(traction, 3)
        ));
    }
    if let Some((place, _, share)) = worst(&|film| film.hardness_share, 1.0) {
        doubts.push(format!(
            "{place} the pressure is up to {} times the hardness, which does not limit it under a film of oil",
            format_number_digits(share, 3)
        ));
    }
    doubts
}
