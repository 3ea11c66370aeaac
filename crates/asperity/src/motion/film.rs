//! Tribofilms: what grows on a body where it is rubbed, and is rubbed off again.

use serde::Serialize;

use crate::choice::choice;
use crate::error::{Error, Result, check, check_in};
use crate::grid::{CellValues, Field};
use crate::motion::body::{Body, State};
use crate::motion::law::{Law, Touching};
use crate::motion::pair::Pair;
use crate::units::{CubicMetre, Dimension, Joule, Kelvin, Metre, MetrePerSecond, Pascal};

/// Boltzmann's constant, J/K.
const BOLTZMANN: f64 = 1.380_649e-23;
/// Planck's constant, J s.
const PLANCK: f64 = 6.626_070_15e-34;

/// Name of the state in which a body keeps the thickness of its film, m.
pub const FILM: &str = "film";
/// Name of the state in which a body keeps what the mechano-chemical law has grown, m.
const GROWN: &str = "film_grown";

/// The film of a body: a thickness in each cell, which grows and is removed while the cell is in contact.
#[derive(Debug, Clone, PartialEq)]
pub struct Film {
    law: FilmLaw,
    max_thickness: Metre,
    hardness: Option<Pascal>,
    /// The hardness of the body without film; known once the bodies are prepared.
    bare: Option<CellValues>,
}

/// How a film grows and is removed. It serialises under the keys of a case file.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(tag = "law", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum FilmLaw {
    /// df/dt = G (1 − f/f_max) − R f, where G follows Arrhenius under a stress σ and R = r p v.
    Arrhenius {
        /// Growth of a film of no thickness at the next two, > 0.
        rate: MetrePerSecond,
        /// Temperature of that rate.
        at_temperature: Kelvin,
        /// Stress of that rate.
        at_stress: Pascal,
        /// Activation energy ΔU, ≥ 0.
        activation_energy: Joule,
        /// Activation volume ΔV, ≥ 0.
        activation_volume: CubicMetre,
        /// The stress that drives it.
        stress: FilmStress,
        /// Removal r per pressure and distance slid, ≥ 0, 1/(Pa m).
        removal: f64,
    },
    /// f = g − l: dg/dt = (k_B T/h_P) x (f_max − g), dl/dt = C₄ (C₃ − l).
    ///
    /// A. Ghanbarzadeh et al., Tribol. Int. 93, 573 (2016).
    MechanoChemical {
        /// The factor x, > 0: of order 10⁻¹⁶.
        x: f64,
        /// The thickness C₃ that removal takes in the end, 0 to f_max.
        c3: Metre,
        /// The rate C₄ at which it does, ≥ 0, 1/s.
        c4: f64,
    },
}

/// The stress that drives the growth of a film.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FilmStress {
    /// The pressure.
    Pressure,
    /// The magnitude of the shear traction.
    Shear,
}

choice!(FilmStress: "pressure" => Pressure, "shear" => Shear);

impl Film {
    /// A film of at most `max_thickness`, > 0, that follows a law, and at its thickest bears at most the pressure `hardness`, which
    /// is below that of the body.
    ///
    /// # Errors
    /// [`Error::OutOfRange`].
    pub fn new(law: FilmLaw, max_thickness: Metre, hardness: Option<Pascal>) -> Result<Self> {
        let positive = |value: f64| value > 0.0 && value.is_finite();
        let at_least_0 = |value: f64| value >= 0.0 && value.is_finite();
        let thick = positive(max_thickness);
        check_in(Dimension::Length, "max_thickness", max_thickness, thick, "a thickness above 0")?;
        if let Some(hardness) = hardness {
            check_in(Dimension::Pressure, "hardness", hardness, positive(hardness), "a hardness above 0")?;
        }
        match law {
            FilmLaw::Arrhenius {
                rate,
                at_temperature,
                at_stress,
                activation_energy,
                activation_volume,
                removal,
                ..
            } => {
                check_in(Dimension::Speed, "rate", rate, positive(rate), "a rate above 0")?;
                let warm = positive(at_temperature);
                check_in(
                    Dimension::Temperature,
                    "at_temperature",
                    at_temperature,
                    warm,
                    "a temperature above 0 K",
                )?;
                check_in(
                    Dimension::Pressure,
                    "at_stress",
                    at_stress,
                    at_least_0(at_stress),
                    "a stress from 0",
                )?;
                for (key, dimension, value) in [
                    ("activation_energy", Dimension::Energy, activation_energy),
                    ("activation_volume", Dimension::Volume, activation_volume),
                    ("removal", Dimension::RemovalRate, removal),
                ] {
                    check_in(dimension, key, value, at_least_0(value), "a value from 0")?;
                }
            }
            FilmLaw::MechanoChemical { x, c3, c4 } => {
                check("x", x, positive(x), "a number above 0")?;
                let within = (0.0..=max_thickness).contains(&c3);
                check_in(Dimension::Length, "c3", c3, within, "a thickness from 0 to max_thickness")?;
                check("c4", c4, at_least_0(c4), "a rate from 0, 1/s")?;
            }
        }
        Ok(Self { law, max_thickness, hardness, bare: None })
    }

    /// The largest thickness f_max.
    pub fn max_thickness(&self) -> Metre {
        self.max_thickness
    }

    /// Adds the rates of growth and removal over a position to their sums on a body, 0 or 1: ∫G dt in m and ∫R dt, or of the
    /// mechano-chemical law the exponents of growth and removal.
    pub(super) fn add_rates(&self, body: usize, touching: &Touching, sums: &mut [Field]) {
        let [grown, removed] = sums else { unreachable!("two sums") };
        let temperature = touching.temperature[body];
        match self.law {
            FilmLaw::Arrhenius {
                rate,
                at_temperature,
                at_stress,
                activation_energy,
                activation_volume,
                stress,
                removal,
            } => {
                let stress = match stress {
                    FilmStress::Pressure => touching.pressure,
                    FilmStress::Shear => touching.shear,
                };
                touching.add(body, grown, |index| {
                    let (stress, temperature) = (stress[index], temperature[index]);
                    let energy = activation_energy * (1.0 / temperature - 1.0 / at_temperature);
                    let work = activation_volume * (stress / temperature - at_stress / at_temperature);
                    let growth = rate * ((work - energy) / BOLTZMANN).exp();
                    growth * touching.time
                });
                touching.add(body, removed, |index| {
                    removal * touching.pressure[index] * touching.sliding_distance
                });
            }
            FilmLaw::MechanoChemical { x, c4, .. } => {
                touching
                    .add(body, grown, |index| BOLTZMANN * temperature[index] / PLANCK * x * touching.time);
                touching.add(body, removed, |_| c4 * touching.time);
            }
        }
    }

    /// The states of the film on a body.
    pub(super) fn states<'a>(&self, body: &'a Body) -> FilmStates<'a> {
        let field =
            |name: &str| body.state.get(name).map(|state| state.values.as_slice().expect("standard layout"));
        FilmStates { thickness: field(FILM).unwrap_or_default(), grown: field(GROWN).unwrap_or_default() }
    }

    /// The thickness of a cell, and what it has grown, after so many passes: exact where contact and temperature are frozen.
    fn after(&self, [thickness, grown]: [Metre; 2], [growth, removal]: [f64; 2], passes: f64) -> [Metre; 2] {
        match self.law {
            FilmLaw::Arrhenius { .. } => {
                let decay = growth / self.max_thickness + removal;
                if decay <= 0.0 {
                    return [thickness, grown];
                }
                let steady = growth / decay;
                [steady + (thickness - steady) * (-decay * passes).exp(), 0.0]
            }
            FilmLaw::MechanoChemical { c3, .. } => {
                let lost = grown - thickness;
                let grown = self.max_thickness + (grown - self.max_thickness) * (-growth * passes).exp();
                let lost = c3 + (lost - c3) * (-removal * passes).exp();
                [grown - lost, grown]
            }
        }
    }

    /// The mean thickness of a cell over so many passes; of none its thickness now.
    pub(super) fn mean_thickness(&self, states: [Metre; 2], rates: [f64; 2], passes: f64) -> Metre {
        /// (1 − e⁻ᵃ)/a.
        fn mean_decay(a: f64) -> f64 {
            if a > 1e-8 { -(-a).exp_m1() / a } else { 1.0 - 0.5 * a }
        }
        let ([thickness, grown], [growth, removal]) = (states, rates);
        match self.law {
            FilmLaw::Arrhenius { .. } => {
                let decay = growth / self.max_thickness + removal;
                if decay <= 0.0 {
                    return thickness;
                }
                let steady = growth / decay;
                steady + (thickness - steady) * mean_decay(decay * passes)
            }
            FilmLaw::MechanoChemical { c3, .. } => {
                let lost = grown - thickness;
                let grown = self.max_thickness + (grown - self.max_thickness) * mean_decay(growth * passes);
                let lost = c3 + (lost - c3) * mean_decay(removal * passes);
                grown - lost
            }
        }
    }

    /// Prepares a body: no film where none is known yet, and the hardness that the film leaves.
    fn prepare(&mut self, body: &mut Body) {
        let zeros = || State { unit: "m".to_owned(), values: Field::zeros(body.heights.raw_dim()) };
        let states = match self.law {
            FilmLaw::Arrhenius { .. } => &[FILM][..],
            FilmLaw::MechanoChemical { .. } => &[FILM, GROWN],
        };
        for name in states {
            let zeros = zeros();
            body.state.entry((*name).to_owned()).or_insert(zeros);
        }
        self.bare = Some(body.hardness.clone());
        self.soften(body);
    }

    /// Gives a body the hardness H − (H − H_f) min(f/f_max, 1) that its film leaves.
    fn soften(&self, body: &mut Body) {
        let (Some(soft), Some(bare)) = (self.hardness, &self.bare) else { return };
        let thickness = &body.state[FILM].values;
        let mut hardness = thickness.clone();
        for (cell, value) in hardness.iter_mut().enumerate() {
            let hard = bare.at(cell);
            *value = hard - (hard - soft) * (*value / self.max_thickness).clamp(0.0, 1.0);
        }
        body.hardness = hardness.into();
    }
}

/// The states of a film, by cell.
pub(super) struct FilmStates<'a> {
    thickness: &'a [Metre],
    grown: &'a [Metre],
}

impl FilmStates<'_> {
    /// Thickness, and what has grown, of a flat cell.
    pub(super) fn at(&self, cell: usize) -> [Metre; 2] {
        [&self.thickness, &self.grown].map(|values| values.get(cell).copied().unwrap_or(0.0))
    }
}

/// Sums of growth and removal over a pass, by cell.
pub(super) struct Growing<'a>([&'a [f64]; 2]);

impl<'a> Growing<'a> {
    /// Number of sums.
    pub(super) const SUMS: usize = 2;

    pub(super) fn of(sums: &'a [Field]) -> Self {
        Self([0, 1].map(|index| sums[index].as_slice().expect("standard layout")))
    }

    pub(super) fn at(&self, cell: usize) -> [f64; 2] {
        self.0.map(|values| values[cell])
    }
}

/// Growth and removal of the films of both bodies. The heights grow with them; the cells bear less under a soft one.
#[derive(Debug, Clone)]
pub struct Films {
    films: [Option<Film>; 2],
}

impl Films {
    /// The films of the lower and of the upper body; none of a body that has none.
    ///
    /// # Errors
    /// [`Error::Unsupported`] for a film that is harder than its body, or bears less than a body that bears everything.
    pub fn new(films: [Option<Film>; 2], pair: &Pair) -> Result<Self> {
        for (film, body) in films.iter().zip([&pair.lower, &pair.upper]) {
            if let Some(soft) = film.as_ref().and_then(|film| film.hardness)
                && (soft > body.hardness.min() || !body.hardness.max().is_finite())
            {
                return Err(Error::Unsupported(
                    "a film with a hardness is softer than its body, which yields too",
                ));
            }
        }
        Ok(Self { films })
    }
}

impl Law for Films {
    fn name(&self) -> &str {
        "film"
    }

    fn prepare(&mut self, pair: &mut Pair) {
        for (film, body) in self.films.iter_mut().zip([&mut pair.lower, &mut pair.upper]) {
            if let Some(film) = film {
                film.prepare(body);
            }
        }
    }

    fn sums(&self) -> usize {
        Growing::SUMS
    }

    fn add(&self, _: &Pair, touching: &Touching, sums: &mut [Vec<Field>; 2]) {
        for (body, sums) in sums.iter_mut().enumerate() {
            if let Some(film) = &self.films[body] {
                film.add_rates(body, touching, sums);
            }
        }
    }

    fn advance(&self, pair: &mut Pair, sums: &[Vec<Field>; 2], passes: f64) -> [Field; 2] {
        let Pair { lower, upper, .. } = pair;
        let mut bodies = [lower, upper];
        [0, 1].map(|index| {
            let body = &mut *bodies[index];
            let mut depth = Field::zeros(body.heights.raw_dim());
            let Some(film) = &self.films[index] else { return depth };
            let growing = Growing::of(&sums[index]);
            let states = film.states(body);
            let after: Vec<[Metre; 2]> =
                (0..depth.len()).map(|cell| film.after(states.at(cell), growing.at(cell), passes)).collect();
            for ((depth, after), before) in depth.iter_mut().zip(&after).zip(&body.state[FILM].values) {
                *depth = before - after[0];
            }
            for (which, name) in [FILM, GROWN].into_iter().enumerate() {
                if let Some(state) = body.state.get_mut(name) {
                    state.values.iter_mut().zip(&after).for_each(|(value, after)| *value = after[which]);
                }
            }
            film.soften(body);
            depth
        })
    }
}
