//! Tribofilms: films that grow on a rubbed surface and are removed by rubbing.

use serde::Serialize;

use crate::error::{Error, Result, check, check_in};
use crate::grid::{CellValues, Field};
use crate::motion::body::{Body, State};
use crate::motion::law::{ContactCells, Law};
use crate::motion::pair::Pair;
use crate::units::{CubicMetre, Dimension, Joule, Kelvin, Metre, MetrePerSecond, Pascal, PerPascal, Range};
use asperity_base::choice::choice;

/// Boltzmann's constant, J/K.
const BOLTZMANN: f64 = 1.380_649e-23;
/// Planck's constant, J s.
const PLANCK: f64 = 6.626_070_15e-34;

/// Name of the body state that stores the thickness of the film, m.
pub const FILM: &str = "film";
/// Name of the body state that stores the growth by the mechano-chemical law, m.
const GROWN: &str = "film_grown";

/// Accepted activation energies, besides 0: up to 60 eV, far above that of any chemical bond. A number in eV without its
/// unit is rejected.
pub const ACTIVATION_ENERGIES: Range = Range { least: 1e-24, most: 1e-17, unit: "J" };
/// Accepted activation volumes, besides 0: up to 1 µm³, for soft bodies under small stresses. A number in nm³ without its
/// unit is rejected.
pub const ACTIVATION_VOLUMES: Range = Range { least: 1e-36, most: 1e-18, unit: "m³" };
/// Accepted temperatures of a known growth rate. A number below 200, in °C without its unit, is rejected.
pub const GROWTH_TEMPERATURES: Range = Range { least: 200.0, most: 5000.0, unit: "K" };
/// Accepted factors x of the mechano-chemical law.
pub const GROWTH_FACTORS: Range = Range { least: 1e-45, most: 1.0, unit: "" };
/// Accepted rates C₄ of the mechano-chemical law, besides 0.
pub const REMOVAL_RATES: Range = Range { least: 1e-15, most: 1e15, unit: "1/s" };

/// Largest exponent of Arrhenius' law. A film that grows at e⁵⁰⁰ of the known rate reaches its limit at once. Sums of such
/// rates over positions, passes and time stay finite.
const MAX_EXPONENT: f64 = 500.0;

/// The film of a body: a thickness in each cell, which grows and is removed while the cell is in contact.
#[derive(Debug, Clone, PartialEq)]
pub struct Film {
    law: FilmLaw,
    max_thickness: Metre,
    hardness: Option<Pascal>,
    /// Hardness of the body without its film; set when the bodies are prepared.
    bare: Option<CellValues>,
}

/// Law of growth and removal of a film. It serialises under the keys of a case file.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(tag = "law", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum FilmLaw {
    /// df/dt = G (1 − f/f_max) − R f, where G follows Arrhenius under a stress σ and R = r p v.
    Arrhenius {
        /// Growth rate of a film of zero thickness at the reference temperature and stress below, > 0.
        rate: MetrePerSecond,
        /// Reference temperature, 200 … 5000 K.
        at_temperature: Kelvin,
        /// Reference stress.
        at_stress: Pascal,
        /// Activation energy ΔU, 0 or 10⁻²⁴ … 10⁻¹⁷ J.
        activation_energy: Joule,
        /// Activation volume ΔV, 0 or 10⁻³⁶ … 10⁻¹⁸ m³.
        activation_volume: CubicMetre,
        /// The driving stress.
        stress: FilmStress,
        /// Removal r per pressure and distance slid, ≥ 0, 1/(Pa m).
        removal: f64,
    },
    /// f = g − l ≥ 0: dg/dt = (k_B T/h_P) x (f_max − g), dl/dt = C₄ (C₃ − l). The film of a
    /// bare cell, f = 0, is removed as fast as it grows while dl/dt would be above dg/dt.
    ///
    /// A. Ghanbarzadeh et al., Tribol. Int. 93, 573 (2016).
    MechanoChemical {
        /// The factor x, 10⁻⁴⁵ … 1, typically about 10⁻¹⁶.
        x: f64,
        /// The final thickness C₃ lost to removal, 0 to f_max.
        c3: Metre,
        /// The rate C₄ of removal, 0 or 10⁻¹⁵ … 10¹⁵ 1/s.
        c4: f64,
    },
    /// A solid lubricant, such as bonded MoS₂, which begins at its largest thickness and only wears: df = −k p |ds| while f > 0.
    SolidLubricant {
        /// Wear coefficient k of the film, > 0, 1/Pa.
        wear: PerPascal,
    },
}

impl FilmLaw {
    /// Whether the film changes with time. A solid lubricant changes only with the distance slid.
    pub fn takes_time(&self) -> bool {
        !matches!(self, Self::SolidLubricant { .. })
    }
}

/// The stress that drives film growth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FilmStress {
    /// The pressure.
    Pressure,
    /// The magnitude of the shear traction.
    Shear,
}

choice!(FilmStress: "pressure" => Pressure, "shear" => Shear);

impl Film {
    /// Creates a film of thickness at most `max_thickness`, > 0, with a law. At its thickest it can carry at most the
    /// pressure `hardness`, which is below that of the body.
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
                let warm = GROWTH_TEMPERATURES.holds(at_temperature);
                check_in(
                    Dimension::Temperature,
                    "at_temperature",
                    at_temperature,
                    warm,
                    "a temperature of 200 to 5000 K",
                )?;
                check_in(
                    Dimension::Pressure,
                    "at_stress",
                    at_stress,
                    at_least_0(at_stress),
                    "a stress from 0",
                )?;
                let energy = activation_energy == 0.0 || ACTIVATION_ENERGIES.holds(activation_energy);
                check_in(
                    Dimension::Energy,
                    "activation_energy",
                    activation_energy,
                    energy,
                    "0 or an energy of 1e-24 to 1e-17 J",
                )?;
                let volume = activation_volume == 0.0 || ACTIVATION_VOLUMES.holds(activation_volume);
                check_in(
                    Dimension::Volume,
                    "activation_volume",
                    activation_volume,
                    volume,
                    "0 or a volume of 1e-36 to 1e-18 m³",
                )?;
                check_in(Dimension::RemovalRate, "removal", removal, at_least_0(removal), "a value from 0")?;
            }
            FilmLaw::MechanoChemical { x, c3, c4 } => {
                check("x", x, GROWTH_FACTORS.holds(x), "a number of 1e-45 to 1")?;
                let within = (0.0..=max_thickness).contains(&c3);
                check_in(Dimension::Length, "c3", c3, within, "a thickness from 0 to max_thickness")?;
                let rate = c4 == 0.0 || REMOVAL_RATES.holds(c4);
                check("c4", c4, rate, "0 or a rate of 1e-15 to 1e15 1/s")?;
            }
            FilmLaw::SolidLubricant { wear } => {
                check_in(Dimension::WearCoefficient, "wear", wear, positive(wear), "a coefficient above 0")?;
            }
        }
        Ok(Self { law, max_thickness, hardness, bare: None })
    }

    /// The largest thickness f_max.
    pub fn max_thickness(&self) -> Metre {
        self.max_thickness
    }

    /// Adds the rates of growth and removal at a position to their sums on a body, 0 or 1. Arrhenius: ∫G dt in m and ∫R dt.
    /// Mechano-chemical: the exponents of growth and removal. Solid lubricant: nothing, and the depth worn off, m.
    pub(super) fn add_rates(&self, body: usize, contact_cells: &ContactCells, sums: &mut [Field]) {
        let [grown, removed] = sums else { unreachable!("two sums") };
        let temperature = contact_cells.temperature[body];
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
                    FilmStress::Pressure => contact_cells.pressure,
                    FilmStress::Shear => contact_cells.shear,
                };
                contact_cells.add(body, grown, |index| {
                    let (stress, temperature) = (stress[index], temperature[index]);
                    let energy = activation_energy * (1.0 / temperature - 1.0 / at_temperature);
                    let work = activation_volume * (stress / temperature - at_stress / at_temperature);
                    let exponent = (work - energy) / BOLTZMANN;
                    let growth = rate * if exponent > MAX_EXPONENT { MAX_EXPONENT } else { exponent }.exp();
                    growth * contact_cells.time
                });
                contact_cells.add(body, removed, |index| {
                    removal * contact_cells.pressure[index] * contact_cells.sliding_distance(index)
                });
            }
            FilmLaw::MechanoChemical { x, c4, .. } => {
                contact_cells.add(body, grown, |index| {
                    BOLTZMANN * temperature[index] / PLANCK * x * contact_cells.time
                });
                contact_cells.add(body, removed, |_| c4 * contact_cells.time);
            }
            FilmLaw::SolidLubricant { wear } => {
                contact_cells.add(body, removed, |index| {
                    wear * contact_cells.pressure[index] * contact_cells.sliding_distance(index)
                });
            }
        }
    }

    /// The states of the film on a body.
    pub(super) fn states<'a>(&self, body: &'a Body) -> FilmStates<'a> {
        let field =
            |name: &str| body.state.get(name).map(|state| state.values.as_slice().expect("standard layout"));
        FilmStates { thickness: field(FILM).unwrap_or_default(), grown: field(GROWN).unwrap_or_default() }
    }

    /// Returns the thickness and growth of a cell after `passes` passes; exact if contact and temperature are frozen.
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
                let balance = Balance::new([self.max_thickness, c3], [growth, removal], [thickness, grown]);
                let grown = balance.grown(passes);
                [balance.thickness(passes), grown]
            }
            FilmLaw::SolidLubricant { .. } => [at_least_0(thickness - removal * passes), 0.0],
        }
    }

    /// Returns the mean thickness of a cell over `passes` passes; the present thickness for 0 passes.
    pub(super) fn mean_thickness(&self, states: [Metre; 2], rates: [f64; 2], passes: f64) -> Metre {
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
                let balance = Balance::new([self.max_thickness, c3], [growth, removal], [thickness, grown]);
                balance.mean_thickness(passes)
            }
            FilmLaw::SolidLubricant { .. } => match removal * passes {
                worn if worn <= thickness => thickness - 0.5 * worn,
                worn => 0.5 * thickness * (thickness / worn),
            },
        }
    }

    /// Prepares a body: sets the initial film if there is none yet, and the hardness under the film.
    fn prepare(&mut self, body: &mut Body) {
        let (states, begin) = match self.law {
            FilmLaw::Arrhenius { .. } => (&[FILM][..], 0.0),
            FilmLaw::MechanoChemical { .. } => (&[FILM, GROWN][..], 0.0),
            FilmLaw::SolidLubricant { .. } => (&[FILM][..], self.max_thickness),
        };
        let shape = body.heights.raw_dim();
        for name in states {
            let state = || State { unit: "m".to_owned(), values: Field::from_elem(shape, begin) };
            body.state.entry((*name).to_owned()).or_insert_with(state);
        }
        self.bare = Some(body.hardness.clone());
        self.set_hardness(body);
    }

    /// Sets the hardness of a body under its film, H − (H − H_f) min(f/f_max, 1).
    fn set_hardness(&self, body: &mut Body) {
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

/// (1 − e⁻ᵃ)/a.
fn mean_decay(a: f64) -> f64 {
    if a > 1e-8 { -(-a).exp_m1() / a } else { 1.0 - 0.5 * a }
}

/// Growth g and removal l of a mechano-chemical film in a cell at constant exponents G and R per pass, as functions of the
/// passes t since the beginning.
///
/// g = f_max + (g₀ − f_max) e^(−Gt),  l = C₃ + (l₀ − C₃) e^(−Rt),  f = g − l
///
/// Where f would fall below 0 the cell is bare, l = g, while R (C₃ − g) ≥ G (f_max − g). It grows again from g* = (R C₃ − G
/// f_max)/(R − G) on.
struct Balance {
    /// The largest thickness f_max, and the final removal C₃.
    ends: [Metre; 2],
    /// Exponents G and R.
    rates: [f64; 2],
    /// Initial growth and removal.
    begin: [Metre; 2],
    /// The passes at which the film is used up and at which it grows again; `None` if it is never used up.
    bare: Option<[f64; 2]>,
}

impl Balance {
    /// Creates the balance of a cell of this thickness and growth.
    fn new(ends: [Metre; 2], rates: [f64; 2], [thickness, grown]: [Metre; 2]) -> Self {
        let begin = [grown, grown - thickness];
        let mut balance = Self { ends, rates, begin, bare: None };
        balance.bare = balance.bare();
        balance
    }

    /// Growth after `passes` passes.
    fn grown(&self, passes: f64) -> Metre {
        self.ends[0] + (self.begin[0] - self.ends[0]) * (-self.rates[0] * passes).exp()
    }

    /// Removal of a film that is not used up.
    fn removed(&self, passes: f64) -> Metre {
        self.ends[1] + (self.begin[1] - self.ends[1]) * (-self.rates[1] * passes).exp()
    }

    /// Thickness after `passes` passes.
    fn thickness(&self, passes: f64) -> Metre {
        match self.bare {
            Some([begin, end]) if passes >= begin => {
                if passes <= end {
                    0.0
                } else {
                    self.regrown(end).thickness(passes - end)
                }
            }
            _ => at_least_0(self.grown(passes) - self.removed(passes)),
        }
    }

    /// Mean thickness over `passes` passes; the initial thickness for 0 passes.
    fn mean_thickness(&self, passes: f64) -> Metre {
        match self.bare {
            Some([begin, end]) if passes > begin => {
                let before = begin * self.mean_unbounded(begin);
                let after = match passes > end {
                    true => (passes - end) * self.regrown(end).mean_thickness(passes - end),
                    false => 0.0,
                };
                at_least_0((before + after) / passes)
            }
            _ => at_least_0(self.mean_unbounded(passes)),
        }
    }

    /// Mean of g − l.
    fn mean_unbounded(&self, passes: f64) -> Metre {
        let mean = |which: usize| {
            let end = self.ends[which];
            end + (self.begin[which] - end) * mean_decay(self.rates[which] * passes)
        };
        mean(0) - mean(1)
    }

    /// Returns the balance of a cell that regrows after it has been bare until `end`.
    fn regrown(&self, end: f64) -> Self {
        let grown = self.grown(end);
        Self { begin: [grown; 2], bare: None, ..*self }
    }

    /// Returns the passes between which the cell is bare, for a film that is used up, whose removal is faster than its
    /// growth.
    fn bare(&self) -> Option<[f64; 2]> {
        let ([most, removed], [growth, removal]) = (self.ends, self.rates);
        let (to_grow, to_remove) = (most - self.begin[0], removed - self.begin[1]);
        if removal <= growth || removal * to_remove <= growth * to_grow {
            return None;
        }
        let difference = |passes: f64| self.grown(passes) - self.removed(passes);
        // The film is thinnest when growth and removal are equally fast.
        let thinnest = ((removal * to_remove) / (growth * to_grow)).ln() / (removal - growth);
        let thinnest = if thinnest.is_finite() { thinnest } else { f64::MAX.sqrt() / removal };
        if difference(thinnest) >= 0.0 {
            return None;
        }
        let begin = first_zero(difference, thinnest);
        // f_max − g decreases to f_max − g*.
        let again = removal * (most - removed) / (removal - growth);
        let end = (to_grow / again).ln() / growth;
        Some([begin, if end.is_finite() { end.max(begin) } else { f64::INFINITY }])
    }
}

/// Returns the value, or 0 if it is below 0. NaN stays NaN.
fn at_least_0(value: f64) -> f64 {
    if value < 0.0 { 0.0 } else { value }
}

/// Finds the zero of a function that falls from a value of at least 0 at 0 to a value below 0 at `end`.
fn first_zero(value: impl Fn(f64) -> f64, end: f64) -> f64 {
    if value(0.0) <= 0.0 {
        return 0.0;
    }
    let (mut above, mut below) = (0.0, end);
    loop {
        let middle = 0.5 * (above + below);
        if middle <= above || middle >= below {
            return below;
        }
        if value(middle) > 0.0 { above = middle } else { below = middle }
    }
}

/// The states of a film, by cell.
pub(super) struct FilmStates<'a> {
    thickness: &'a [Metre],
    grown: &'a [Metre],
}

impl FilmStates<'_> {
    /// Thickness and growth of a flat cell.
    pub(super) fn at(&self, cell: usize) -> [Metre; 2] {
        [&self.thickness, &self.grown].map(|values| values.get(cell).copied().unwrap_or(0.0))
    }
}

/// Sums of growth and removal over a pass, by cell.
pub(super) struct GrowthSums<'a>([&'a [f64]; 2]);

impl<'a> GrowthSums<'a> {
    /// Number of sums.
    pub(super) const SUMS: usize = 2;

    pub(super) fn of(sums: &'a [Field]) -> Self {
        Self([0, 1].map(|index| sums[index].as_slice().expect("standard layout")))
    }

    pub(super) fn at(&self, cell: usize) -> [f64; 2] {
        self.0.map(|values| values[cell])
    }
}

/// Growth and removal of the films of both bodies. The heights grow with the films, and cells under a soft film carry less.
#[derive(Debug, Clone)]
pub struct Films {
    films: [Option<Film>; 2],
}

impl Films {
    /// Creates the films of the lower and of the upper body; `None` for a body without film.
    ///
    /// # Errors
    /// [`Error::Unsupported`] if a film is harder than its body, or if a film has a hardness and its body has none.
    pub fn new(films: [Option<Film>; 2], pair: &Pair) -> Result<Self> {
        for (film, body) in films.iter().zip([&pair.lower, &pair.upper]) {
            if let Some(soft) = film.as_ref().and_then(|film| film.hardness)
                && (soft > body.hardness.min() || !body.hardness.max().is_finite())
            {
                return Err(Error::Unsupported("a film with a hardness needs a body with a hardness"));
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
        GrowthSums::SUMS
    }

    fn add(&self, _: &Pair, contact_cells: &ContactCells, sums: &mut [Vec<Field>; 2]) {
        for (body, sums) in sums.iter_mut().enumerate() {
            if let Some(film) = &self.films[body] {
                film.add_rates(body, contact_cells, sums);
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
            let growing = GrowthSums::of(&sums[index]);
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
            film.set_hardness(body);
            depth
        })
    }
}
