//! A static contact of a case: solved in memory, or written to a results directory increment by increment and
//! point by point.

use crate::case::{Case, Course};
use crate::closed_form::ClosedFormRecord;
use crate::elasto_plastic;
use crate::estimate::{Estimate, estimate};
use crate::fields::{NamedField, RestFields};
use crate::finish::{closed_form, pair, params};
use crate::limits::Limits;
use crate::observe::{self, Observers};
use crate::prepare::bodies_until;
use crate::results::{BODIES, StepWriter, Writer, state_name};
use crate::review;
use crate::summary::Outcome;
use crate::surface_input::SurfaceInput;
use crate::tables;
use asperity_base::error::{Error, Result};
use asperity_base::grid::{CellValues, Field, check_finite};
use asperity_contact::lubrication::Film;
use asperity_contact::motion::{
    Body, ChangedBodies, IncrementRecord, LoadedContact, Output, Pair, PlasticResult, PlasticVolume, Point,
    Slide, SlidingContact, SlidingOutcome, SlidingState, SlipRegime, Stage, StagedLoading, State,
    StaticRecord, UpdateRecord, Watch, YieldingBodies, press, sweep, sweep_elasto_plastic,
};
use asperity_contact::operator::Boundary;
use asperity_contact::solver::{Control, Equilibrium, Friction, Params, Solution};
use asperity_contact::with::{self, InterfaceNumbers, Observations};

/// Result of a static contact.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct StaticResult {
    /// The record of the contact, or the points of a sweep.
    pub outcome: Outcome,
    /// The increments of a loading in stages; empty for other contacts.
    pub increments: Vec<IncrementRecord>,
    /// The updates of a contact that slides in place, beginning before it slides; empty for other contacts.
    pub updates: Vec<UpdateRecord>,
    /// The fields of the contact; for a sweep, at its last point.
    pub fields: RestFields,
    /// The interface of the bodies in numbers.
    pub interface: InterfaceNumbers,
    /// The closed form of the contact, if both bodies are smooth forms; `None` for others.
    pub closed_form: Option<ClosedFormRecord>,
    /// The plastic state below the surfaces; `None` for other than elasto-plastic bodies.
    pub plastic_result: Option<PlasticResult>,
    /// The rows of the capabilities that the case asks for.
    pub found: Observations,
    /// Warnings for the user.
    pub warnings: Vec<String>,
}

/// Computes the static contact of `case` without writing any file. The result has the bits of
/// [`run()`](crate::run()).
///
/// # Errors
/// Every error of a case, its surfaces or the contact; [`Error::Unsupported`] for a motion. Stress under the
/// surface is not computed, because it is written to a file.
pub fn static_contact(case: &Case, given: SurfaceInput, watch: &dyn Watch) -> Result<StaticResult> {
    if case.course(1.0).moves() {
        return Err(Error::Unsupported("a motion is not a static contact"));
    }
    let bodies = bodies_until(case, given, &|| watch.stop())?;
    let estimate = estimate(case, &bodies)?;
    let pair = pair(case, bodies)?;
    let mut rest = solve(case, pair, &estimate, None, watch)?;
    rest.warnings.splice(0..0, estimate.warnings);
    rest.checked()
}

impl StaticResult {
    /// Creates an outcome with its fields, and nothing else.
    fn of(outcome: impl Into<Outcome>, fields: RestFields) -> Self {
        let outcome = outcome.into();
        Self {
            outcome,
            increments: Vec::new(),
            updates: Vec::new(),
            fields,
            interface: InterfaceNumbers::default(),
            closed_form: None,
            plastic_result: None,
            found: Observations::default(),
            warnings: Vec::new(),
        }
    }

    /// Adds what the observers have found.
    fn seen_by(mut self, case: &Case, observers: Observers) -> Result<Self> {
        let (found, fields) = observers.finish()?;
        self.fields.fields.extend(fields);
        self.warnings.extend(observe::doubts(case, &found));
        Ok(Self { found, ..self })
    }

    /// Returns the contact after checking that all its numbers are finite, as for the files of a run.
    fn checked(self) -> Result<Self> {
        self.outcome.check()?;
        tables::checked(&self.increments)?;
        tables::checked(&self.updates)?;
        for NamedField { name, values, .. } in &self.fields.fields {
            check_finite(name, values.shape(), values)?;
        }
        for volume in self
            .plastic_result
            .iter()
            .flat_map(|plastic_result| [&plastic_result.volumes, &plastic_result.residual])
            .flatten()
        {
            let PlasticVolume { state, residual_stress, displacement, .. } = volume;
            check_finite("strain", state.strain.shape(), &state.strain)?;
            check_finite("accumulated", state.accumulated.shape(), &state.accumulated)?;
            check_finite("residual_stress", residual_stress.shape(), residual_stress)?;
            check_finite("displacement", displacement.shape(), displacement)?;
        }
        Ok(self)
    }
}

/// Solves the static contact of `case`, whose bodies are a `pair`, and adds warnings about the result.
/// Intermediate results are written by the `writer`, which begins with the first of them.
pub(super) fn solve(
    case: &Case,
    pair: Pair,
    estimate: &Estimate,
    writer: Option<&Writer>,
    watch: &dyn Watch,
) -> Result<StaticResult> {
    let apparent_area = estimate.apparent_area;
    let law = case.friction.as_ref().map(|friction| &friction.law);
    let control = case.contact.prescribed().control(apparent_area);
    let extent = pair.lower_grid().extent();
    let contact = StaticProblem { case, pair, estimate, law, control, params: params(case), writer, watch };
    let rest = match (case.course(apparent_area), law) {
        (Course::InPlace(slide), _) => contact.slide(slide),
        (Course::Sweep(points), _) => contact.sweep(&points),
        (Course::Rolling(rolling), Some(friction)) => contact.press(SlipRegime::Rolling(*friction, rolling)),
        (Course::Stages(stages), law) if law.is_some() || stages.len() > 1 || case.plasticity.is_some() => {
            contact.load_in_stages(&stages)
        }
        _ => contact.press(SlipRegime::Frictionless),
    }?;
    let interface = estimate.interface.after(&rest.increments);
    Ok(StaticResult { interface, closed_form: closed_form(case, extent, &rest.outcome), ..rest })
}

/// A static contact to be solved.
struct StaticProblem<'a> {
    case: &'a Case,
    pair: Pair,
    estimate: &'a Estimate,
    law: Option<&'a Friction>,
    control: Control,
    params: Params,
    writer: Option<&'a Writer>,
    watch: &'a dyn Watch,
}

impl StaticProblem<'_> {
    /// Solves in one step.
    fn press(self, regime: SlipRegime) -> Result<StaticResult> {
        let case = self.case;
        let (boundary, control) = (self.boundary(), self.control);
        let contact = press(&self.pair, boundary, control, regime, &self.params, self.watch)?;
        self.begin()?;
        let mut observers = self.observers(None)?;
        observers.contact(contact.solution.normal())?;
        let broken = self.compare(contact.solution.normal())?;
        self.loaded(contact, broken).seen_by(case, observers)
    }

    /// Solves stage after stage.
    fn load_in_stages(self, stages: &[Stage]) -> Result<StaticResult> {
        let case = self.case;
        self.begin()?;
        let under_way = |writer: &Writer| writer.results().loading_under_way(&self.pair, stages.len());
        // The stress below the surfaces of elasto-plastic bodies is not kept: their loading begins anew.
        let resumed = self.writer.filter(|_| case.plasticity.is_none());
        let left = resumed.map(under_way).transpose()?.flatten();
        let done = left.as_ref().map_or(&[][..], |left| &left.increments);
        let every = case.increments_kept_every();
        let mut kept = self.writer.map(|writer| writer.increments(done, every)).transpose()?;
        let done = done.last().map(|last| last.increment);
        let (mut observers, mut limits) = (self.observers(done)?, self.limits(done)?);
        let (boundary, outputs) = (self.boundary(), &mut outputs(&mut observers, &mut limits, &mut kept));
        let (pair, law, stages) = (self.pair.clone(), self.law.copied(), stages.to_vec());
        let loading = match &case.plasticity {
            None => StagedLoading::new(pair, boundary, law, stages, self.params)?,
            Some(region) => {
                let unloading = elasto_plastic::unloading(region, &stages);
                StagedLoading::new(pair, boundary, law, stages, self.params)?.with_plastic(
                    elasto_plastic::bodies(case, region, &self.pair)?,
                    region.params(),
                    unloading,
                )?
            }
        };
        let changes = case.changes(loading.pair(), self.params)?;
        let contact = loading.with_changes(changes).run(left, self.watch, outputs)?;
        self.loaded(contact, limits.all()).seen_by(case, observers)
    }

    /// Solves one load, or one creepage, after another.
    fn sweep(self, points: &[Point]) -> Result<StaticResult> {
        let case = self.case;
        self.begin()?;
        let under_way = |writer: &Writer| writer.results().sweep_under_way(&self.pair);
        let mut state = self.writer.map(under_way).transpose()?.unwrap_or_default();
        state.records.truncate(points.len().saturating_sub(1));
        let every = self.case.output.pressure_every;
        let mut kept = self.writer.map(|writer| writer.points(&state.records, every)).transpose()?;
        let last = state.records.last().map(|last| last.point);
        let (mut observers, mut limits) = (self.observers(last)?, self.limits(last)?);
        let (boundary, outputs) = (self.boundary(), &mut outputs(&mut observers, &mut limits, &mut kept));
        let (pair, params, watch) = (&self.pair, &self.params, self.watch);
        let (points, contact) = match &case.plasticity {
            None => sweep(pair, boundary, points, params, state, watch, outputs)?,
            Some(region) => {
                let virgin = || elasto_plastic::bodies(case, region, pair);
                let increments = region.increments.unwrap_or(1);
                let bodies = YieldingBodies { virgin: &virgin, increments, plastic: region.params() };
                sweep_elasto_plastic(pair, boundary, points, bodies, params, state, watch, outputs)?
            }
        };
        let of_bodies = review::elasto_plastic(case, pair, &contact);
        let of_films = with::doubts_after_points(&case.interface, &points);
        let warnings = [limits.all(), of_bodies, review::sweep(&points, &contact), of_films].concat();
        let LoadedContact { solution, plastic, slip, plastic_result, film, .. } = contact;
        let mut fields = fields(displaced(self.pair, plastic_result.as_ref()), solution, plastic, slip);
        fields.fields.extend(film.iter().flat_map(of_film));
        let result = StaticResult::of(Outcome::Sweep(points), fields);
        StaticResult { plastic_result, warnings, ..result }.seen_by(case, observers)
    }

    /// Solves sliding in place.
    fn slide(self, slide: Slide) -> Result<StaticResult> {
        let case = self.case;
        let friction = slide.friction;
        self.begin()?;
        let under_way = |writer: &Writer| writer.results().sliding_under_way(&self.pair);
        let left = self.writer.map(under_way).transpose()?.flatten();
        let done = left.as_ref().map_or(&[][..], |left| &left.updates);
        let mut kept = self.writer.map(|writer| writer.updates(done)).transpose()?;
        let last = done.last().map(|last| last.update);
        let (mut observers, mut limits) = (self.observers(last)?, self.limits(last)?);
        let from = left.as_ref().map_or(&self.pair, |left| &left.pair).clone();
        let changes = case.changes(&from, self.params)?;
        let contact =
            SlidingContact::new(from, self.boundary(), slide, self.params)?.with_changes(changes)?;
        let state = left.map(|left| left.resumed(&contact));
        let worn = contact.run(state, self.watch, &mut outputs(&mut observers, &mut limits, &mut kept))?;
        let (record, updates) = (worn.record.clone(), worn.state.updates.clone());
        let of_answer = review::static_contact(&worn.state.pair, self.boundary(), &worn.solution.pressure);
        let scar = review::scar(&self.pair, &worn.state.pair, self.boundary());
        let warnings = [limits.all(), of_answer, scar.into_iter().collect()].concat();
        let result = StaticResult::of(record, worn_fields(worn, friction));
        StaticResult { updates, warnings, ..result }.seen_by(case, observers)
    }

    /// Creates the result from the end of a loading, or of rolling, with the warnings of `broken` limits.
    fn loaded(self, contact: LoadedContact, broken: Vec<String>) -> StaticResult {
        let changed = contact.changed.as_ref();
        let scar = changed.and_then(|changed| review::scar(&self.pair, &changed.pair, self.boundary()));
        let of_increments = with::doubts_after_increments(&contact.increments).into_iter().collect();
        let warnings = [
            broken,
            review::loaded(&contact, self.boundary()),
            review::flash_in_cycles(self.case, &contact, self.boundary()).into_iter().collect(),
            review::elasto_plastic(self.case, &self.pair, &contact),
            of_increments,
            self.review(contact.solution.normal()),
            scar.into_iter().collect(),
        ]
        .concat();
        let LoadedContact { record, increments, solution, plastic, slip, changed, plastic_result, .. } =
            contact;
        let temperature =
            changed.as_ref().and_then(|changed| Some(changed.heat.as_ref()?.temperature_field()));
        let pair = changed.map_or(self.pair, |ChangedBodies { pair, .. }| pair);
        let mut fields = fields(displaced(pair, plastic_result.as_ref()), solution, plastic, slip);
        fields.fields.extend(temperature.map(|values| NamedField::new("temperature", "K", values)));
        StaticResult { increments, warnings, plastic_result, ..StaticResult::of(record, fields) }
    }

    /// Creates the observers of the case, after the steps that are `done`.
    fn observers(&self, done: Option<usize>) -> Result<Observers> {
        Observers::new(self.case, &self.pair, &[], (self.writer, done))
    }

    /// Creates the limits of the case, after the steps that are `done`.
    fn limits(&self, done: Option<usize>) -> Result<Limits> {
        Limits::new(self.case, &self.pair, self.estimate, (self.writer, done))
    }

    /// Compares a contact that is solved in one step with the limits. Returns the warnings, which the watch
    /// receives at once.
    fn compare(&self, solution: &Solution) -> Result<Vec<String>> {
        let mut limits = self.limits(None)?;
        limits.contact(solution)?;
        limits.all().iter().for_each(|warning| self.watch.warning(warning));
        Ok(limits.all())
    }

    fn boundary(&self) -> Boundary {
        self.case.contact.boundary
    }

    /// Clears the results that will be replaced, if any.
    fn begin(&self) -> Result<()> {
        self.writer.map_or(Ok(()), Writer::begin)
    }

    fn review(&self, solution: &Solution) -> Vec<String> {
        review::static_contact(&self.pair, self.boundary(), &solution.pressure)
    }
}

/// Returns the outputs of a course: the rows of the observers and the limits are written before that of the
/// step.
fn outputs<'a>(
    observers: &'a mut Observers,
    limits: &'a mut Limits,
    kept: &'a mut Option<StepWriter>,
) -> Vec<&'a mut dyn Output> {
    let kept = kept.iter_mut().map(|kept| kept as &mut dyn Output);
    [observers as &mut dyn Output, limits].into_iter().chain(kept).collect()
}

impl From<StaticRecord> for Outcome {
    fn from(record: StaticRecord) -> Self {
        Self::Static(Box::new(record))
    }
}

/// Creates the fields of a contact of the `pair` in one step without friction.
pub fn pressed(pair: Pair, solution: Solution) -> RestFields {
    let plastic = solution.plastic_interference();
    fields(pair, Equilibrium::Frictionless(Box::new(solution)), plastic, None)
}

/// Creates the fields of a contact of the `pair` with this plastic interference of its cells.
fn fields(pair: Pair, solution: Equilibrium, plastic: Field, slip: Option<[Field; 2]>) -> RestFields {
    let (grid, hardness) = (pair.lower_grid(), pair.min_hardness());
    let (normal, shear) = match solution.into_frictional() {
        Err(solution) => (*solution, None),
        Ok(solution) => (solution.normal, Some((solution.shear, solution.displacement, solution.stick))),
    };
    let contact = (!pair.touches_by_pressure()).then(|| normal.contact_field());
    // The heights are those of the prepared bodies, whatever the loading history did to them.
    drop(normal.initial_gap);
    let gap = pair.initial_gap(&pair.at_rest()) + &normal.displacement - normal.approach;
    let mut fields = states(&pair);
    let mut add =
        |name: &'static str, unit: &'static str, values| fields.push(NamedField::new(name, unit, values));
    add("pressure", "Pa", normal.pressure);
    if let Some(contact) = contact {
        add("contact", "1", contact);
    }
    add("displacement", "m", normal.displacement);
    add("gap", "m", gap);
    add("lower", "m", pair.lower.heights);
    add("upper", "m", pair.upper.heights);
    add("plastic", "m", plastic);
    if let CellValues::Field(cap) = normal.bounds.upper() {
        add("cap", "Pa", cap.clone());
    }
    let stick = shear.map(|([qx, qy], [ux, uy], stick)| {
        add("traction_x", "Pa", qx);
        add("traction_y", "Pa", qy);
        add("displacement_x", "m", ux);
        add("displacement_y", "m", uy);
        stick
    });
    if let Some([x, y]) = slip {
        add("slip_x", "m", x);
        add("slip_y", "m", y);
    }
    if let Some(stick) = stick {
        add("stick", "1", stick);
    }
    RestFields { grid, approach: normal.approach, hardness, fields }
}

/// Returns the fields of a film of oil.
fn of_film(film: &Film) -> [NamedField; 3] {
    film.parts().map(|(name, unit, values)| NamedField::new(name, unit, values.clone()))
}

/// Returns a `pair` whose surfaces plastic strain has displaced, if there is any.
fn displaced(pair: Pair, plastic: Option<&PlasticResult>) -> Pair {
    match plastic {
        None => pair,
        Some(plastic) => plastic.displaced(pair),
    }
}

/// Returns what laws and memories keep with both bodies.
fn states(pair: &Pair) -> Vec<NamedField> {
    let of_body = |(body, state): (&'static str, &Body)| {
        let states = state.state.iter();
        let named = move |(name, State { unit, values }): (&String, &State)| {
            NamedField::new(state_name(name, body), unit.clone(), values.clone())
        };
        states.map(named).collect::<Vec<_>>()
    };
    BODIES.into_iter().zip([&pair.lower, &pair.upper]).flat_map(of_body).collect()
}

/// Creates the fields of a contact that slid in place, with its worn bodies.
fn worn_fields(contact: SlidingOutcome, friction: Option<Friction>) -> RestFields {
    let SlidingOutcome { state: SlidingState { pair, .. }, solution, temperature, .. } = contact;
    // Films have changed the hardness of the bodies.
    let (grid, approach, hardness) = (pair.lower_grid(), solution.approach, pair.min_hardness());
    let (gap, plastic) = (solution.gap(), solution.plastic_interference());
    let mut fields = states(&pair);
    let mut add =
        |name: &'static str, unit: &'static str, values| fields.push(NamedField::new(name, unit, values));
    let shear = friction.map(|friction| solution.pressure.mapv(|p| friction.shear_limit(p)));
    if !pair.interface().is_hard() {
        add("contact", "1", solution.contact_field());
    }
    add("pressure", "Pa", solution.pressure);
    add("displacement", "m", solution.displacement);
    add("gap", "m", gap);
    add("lower", "m", pair.lower.heights);
    add("upper", "m", pair.upper.heights);
    add("plastic", "m", plastic);
    if let CellValues::Field(cap) = solution.bounds.upper() {
        add("cap", "Pa", cap.clone());
    }
    if let Some(shear) = shear {
        let nothing = Field::zeros(shear.raw_dim());
        add("traction_x", "Pa", shear);
        add("traction_y", "Pa", nothing);
    }
    if let Some(temperature) = temperature {
        add("temperature", "K", temperature);
    }
    RestFields { grid, approach, hardness, fields }
}
