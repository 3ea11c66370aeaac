//! A static contact of a case: solved in memory, or kept increment by increment and point by point in a results directory.

use crate::error::{Error, Result};
use crate::grid::{CellValues, Field, Grid, check_finite};
use crate::motion::{
    FILM, Flowed, FlowedContact, FlowedVolume, InPlace, IncrementRecord, LoadedContact, Pair, SlidingState,
    State, StaticContact, UpdateRecord, WEAR, Watch, WornContact, load_in_stages, press, press_flowing, roll,
    sweep,
};
use crate::solver::{Equilibrium, Friction, Params, Solution};
use crate::study::case::{Case, LoadingPath};
use crate::study::estimate::estimate;
use crate::study::flow;
use crate::study::given::Given;
use crate::study::loading::LoadingWriter;
use crate::study::prepare::bodies_until;
use crate::study::results::Writer;
use crate::study::review;
use crate::study::run::{pair, params};
use crate::study::sliding::SlidingWriter;
use crate::study::summary::Outcome;
use crate::study::tables;
use crate::subsurface::Tractions;
use crate::units::{Metre, Pascal, SquareMetre};

/// A static contact as it was computed.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Rest {
    /// The contact in numbers, or the points of a sweep.
    pub outcome: Outcome,
    /// The increments of a loading in stages; none of other contacts.
    pub increments: Vec<IncrementRecord>,
    /// The updates of a contact that slides in place, the first before it slides; none of other contacts.
    pub updates: Vec<UpdateRecord>,
    /// The fields of the contact, at the last point of a sweep.
    pub fields: RestFields,
    /// What has flowed below the surfaces; none of bodies that do not.
    pub flowed: Option<Flowed>,
    /// What the user should know about the result.
    pub warnings: Vec<String>,
}

/// The fields of a static contact.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct RestFields {
    /// The grid that all of them stand on.
    pub grid: Grid,
    /// Rigid-body approach δ.
    pub approach: Metre,
    /// The hardness of the pair, the least where it is a map.
    pub hardness: Pascal,
    /// The fields, in the order in which files have them.
    pub fields: Vec<NamedField>,
}

/// A field by the name that it has in files.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct NamedField {
    /// The name.
    pub name: &'static str,
    /// Unit of the values, SI.
    pub unit: &'static str,
    /// The values, `[ix, iy]`.
    pub values: Field,
}

/// Computes the static contact of `case` and leaves nothing on the disk: the answer has the bits of that of
/// [`run()`](crate::study::run()).
///
/// # Errors
/// Everything that can be wrong with a case, its surfaces or the contact; [`Error::Unsupported`] for a motion. Stress under the
/// surface, which goes to a file, is not computed.
pub fn rest(case: &Case, given: Given, watch: &dyn Watch) -> Result<Rest> {
    if case.motion.is_some() {
        return Err(Error::Unsupported("what moves is no contact at rest"));
    }
    let bodies = bodies_until(case, given, &|| watch.stop())?;
    let estimate = estimate(case, &bodies)?;
    let pair = pair(case, bodies)?;
    let (mut solved, warnings) = solve(case, &pair, estimate.apparent_area, None, watch)?;
    let increments = solved.increments().to_vec();
    let flowed = solved.take_flowed();
    let rest = Rest {
        outcome: solved.outcome(),
        increments,
        updates: solved.updates().to_vec(),
        fields: solved.into_fields(displaced(pair, flowed.as_ref())),
        flowed,
        warnings: [estimate.warnings, warnings].concat(),
    };
    rest.checked()
}

impl Rest {
    /// The same contact, if each number of it is one, as the files of a run must be.
    fn checked(self) -> Result<Self> {
        self.outcome.check()?;
        tables::checked(&self.increments)?;
        tables::checked(&self.updates)?;
        for NamedField { name, values, .. } in &self.fields.fields {
            check_finite(name, values.shape(), values)?;
        }
        for volume in self.flowed.iter().flat_map(|flowed| [&flowed.volumes, &flowed.residual]).flatten() {
            let FlowedVolume { state, residual_stress, displacement, .. } = volume;
            check_finite("strain", state.strain.shape(), &state.strain)?;
            check_finite("accumulated", state.accumulated.shape(), &state.accumulated)?;
            check_finite("residual_stress", residual_stress.shape(), residual_stress)?;
            check_finite("displacement", displacement.shape(), displacement)?;
        }
        Ok(self)
    }
}

/// The `pair` with its surfaces where plastic strain below them has brought them.
pub(super) fn displaced(pair: Pair, flowed: Option<&Flowed>) -> Pair {
    match flowed {
        Some(flowed) => flowed.displaced(pair),
        None => pair,
    }
}

/// A static contact with all that is known of it.
pub(super) enum Solved {
    /// In one step without friction.
    Pressed(Box<StaticContact>),
    /// In stages, or rolling.
    Loaded(Box<LoadedContact>, Option<Box<LoadingWriter>>),
    /// A sweep: its points, the last as a whole.
    Swept(Outcome, Box<LoadedContact>),
    /// Worn in place.
    Slid(Box<WornContact>, Option<Friction>, Option<Box<SlidingWriter>>),
    /// Of bodies that flow below their surfaces: the contact, and what has flowed until that is taken.
    Flowed(Box<FlowedContact>),
}

/// What has kept the course of a contact.
pub(super) enum UnderWay {
    Loading(Box<LoadingWriter>),
    Sliding(Box<SlidingWriter>),
}

impl UnderWay {
    /// Removes what was kept to go on from.
    pub(super) fn done(&self) -> Result<()> {
        match self {
            Self::Loading(writer) => writer.done(),
            Self::Sliding(writer) => writer.done(),
        }
    }
}

/// Solves the static contact of `case`, whose bodies are a `pair`, and tells what to be wary of in the answer. What is kept on
/// the way is kept by the `writer`, which begins as soon as something is.
pub(super) fn solve(
    case: &Case,
    pair: &Pair,
    apparent_area: SquareMetre,
    writer: Option<&Writer>,
    watch: &dyn Watch,
) -> Result<(Solved, Vec<String>)> {
    let (boundary, params): (_, &Params) = (case.contact.boundary, &params(case));
    let control = case.contact.prescribed.control(apparent_area);
    let law = case.friction.as_ref().map(|friction| &friction.law);
    let begin = || writer.map_or(Ok(()), Writer::begin);
    let every = case.output.pressure_every;
    if let Some(slide) = case.slide(apparent_area) {
        let friction = slide.friction;
        begin()?;
        let mut kept = writer.map(|writer| Box::new(writer.sliding(slide.ends.len() + 1)));
        let left = kept.as_ref().map(|kept| kept.under_way(pair)).transpose()?.flatten();
        let from = left.as_ref().map_or(pair, |left| &left.pair).clone();
        let contact = case.wearing(InPlace::new(from, boundary, slide, *params)?)?;
        let state = left.map(|left| SlidingState::resumed(&contact, left.updates, left.pressure));
        let worn = match &mut kept {
            None => contact.run(state, watch, &mut ())?,
            Some(kept) => contact.run(state, watch, kept.as_mut())?,
        };
        let warnings = at_rest(&worn.state.pair, case, &worn.solution);
        return Ok((Solved::Slid(Box::new(worn), friction, kept), warnings));
    }
    Ok(match (case.loading_path(apparent_area), law, &case.plasticity) {
        (Some(LoadingPath::Stages(stages)), _, Some(spec)) => {
            let (bodies, path) = (flow::bodies(case, spec, pair)?, flow::path(spec, stages));
            let contact = press_flowing(pair, boundary, law, bodies, &path, params, watch)?;
            begin()?;
            let of_answer = at_rest(pair, case, contact.solution.normal());
            let warnings = [review::flowed(case, pair, &contact), of_answer].concat();
            (Solved::Flowed(Box::new(contact)), warnings)
        }
        (Some(LoadingPath::Sweep(points)), law, _) => {
            begin()?;
            let (points, contact) = match writer {
                None => sweep(pair, boundary, law, &points, params, Vec::new(), watch, &mut ())?,
                Some(writer) => {
                    let done = writer.results().sweep()?;
                    let mut output = writer.sweep(pair, every);
                    sweep(pair, boundary, law, &points, params, done, watch, &mut output)?
                }
            };
            let warnings = review::sweep(&points, &contact);
            (Solved::Swept(Outcome::Sweep(points), Box::new(contact)), warnings)
        }
        (Some(LoadingPath::Rolling(rolling)), Some(law), _) => {
            let contact = roll(pair, boundary, law, control, rolling, params, watch)?;
            begin()?;
            let warnings =
                [review::loaded(&contact), at_rest(pair, case, contact.solution.normal())].concat();
            (Solved::Loaded(Box::new(contact), None), warnings)
        }
        (Some(LoadingPath::Stages(stages)), law, _) if law.is_some() || stages.len() > 1 => {
            begin()?;
            let increments = stages.iter().map(|stage| stage.increments).sum();
            let mut loading = writer.map(|writer| Box::new(writer.loading(pair, increments)));
            let contact = match &mut loading {
                None => load_in_stages(pair, boundary, law, &stages, params, None, watch, &mut ())?,
                Some(loading) => {
                    let done = loading.under_way()?;
                    load_in_stages(pair, boundary, law, &stages, params, done, watch, loading.as_mut())?
                }
            };
            let warnings =
                [review::loaded(&contact), at_rest(pair, case, contact.solution.normal())].concat();
            (Solved::Loaded(Box::new(contact), loading), warnings)
        }
        _ => {
            let contact = press(pair, boundary, control, params, watch)?;
            begin()?;
            let warnings = at_rest(pair, case, &contact.solution);
            (Solved::Pressed(Box::new(contact)), warnings)
        }
    })
}

fn at_rest(pair: &Pair, case: &Case, solution: &Solution) -> Vec<String> {
    review::static_contact(pair, case.contact.boundary, &solution.pressure)
}

impl Solved {
    /// The contact in numbers.
    pub(super) fn outcome(&self) -> Outcome {
        match self {
            Self::Pressed(contact) => Outcome::Static(Box::new(contact.record.clone())),
            Self::Loaded(contact, _) => Outcome::Static(Box::new(contact.record.clone())),
            Self::Swept(outcome, _) => outcome.clone(),
            Self::Slid(contact, ..) => Outcome::Static(Box::new(contact.record.clone())),
            Self::Flowed(contact) => Outcome::Static(Box::new(contact.record.clone())),
        }
    }

    /// The last update of a contact that has slid in place.
    pub(super) fn last_update(&self) -> Option<UpdateRecord> {
        self.updates().last().cloned()
    }

    fn updates(&self) -> &[UpdateRecord] {
        match self {
            Self::Slid(contact, ..) => &contact.state.updates,
            Self::Pressed(_) | Self::Loaded(..) | Self::Swept(..) | Self::Flowed(..) => &[],
        }
    }

    fn increments(&self) -> &[IncrementRecord] {
        match self {
            Self::Loaded(contact, _) => &contact.increments,
            Self::Flowed(contact) => &contact.flowed.increments,
            Self::Pressed(_) | Self::Swept(..) | Self::Slid(..) => &[],
        }
    }

    /// What has flowed below the surfaces.
    pub(super) fn take_flowed(&mut self) -> Option<Flowed> {
        match self {
            Self::Flowed(contact) => Some(std::mem::take(&mut contact.flowed)),
            Self::Pressed(_) | Self::Loaded(..) | Self::Swept(..) | Self::Slid(..) => None,
        }
    }

    /// What has kept the course of a loading, or of sliding in place.
    pub(super) fn take_under_way(&mut self) -> Option<UnderWay> {
        match self {
            Self::Loaded(_, loading) => loading.take().map(UnderWay::Loading),
            Self::Slid(_, _, sliding) => sliding.take().map(UnderWay::Sliding),
            Self::Pressed(_) | Self::Swept(..) | Self::Flowed(..) => None,
        }
    }

    /// The fields, with the surfaces of the `pair`.
    pub(super) fn into_fields(self, pair: Pair) -> RestFields {
        let (grid, hardness) = (pair.lower_grid(), pair.min_hardness());
        let (solution, plastic, slip) = match self {
            Self::Slid(contact, friction, _) => return worn_fields(*contact, friction),
            Self::Pressed(contact) => {
                let StaticContact { solution, .. } = *contact;
                let plastic = solution.plastic_interference();
                (Equilibrium::Frictionless(Box::new(solution)), plastic, None)
            }
            Self::Flowed(contact) => {
                let FlowedContact { solution, slip, .. } = *contact;
                (solution, grid.zeros(), slip)
            }
            Self::Loaded(contact, _) | Self::Swept(_, contact) => {
                let LoadedContact { solution, plastic, slip, .. } = *contact;
                (solution, plastic, slip)
            }
        };
        let (normal, shear) = match solution {
            Equilibrium::Frictionless(solution) => (*solution, None),
            Equilibrium::Frictional(solution) => {
                let solution = *solution;
                (solution.normal, Some((solution.shear, solution.displacement, solution.stick)))
            }
        };
        // Those of the bodies as they are prepared, whatever the course of a loading has left of them.
        drop(normal.initial_gap);
        let gap = pair.initial_gap(&pair.at_rest()) + &normal.displacement - normal.approach;
        let mut fields = Vec::new();
        let mut add = |name, unit, values| fields.push(NamedField { name, unit, values });
        add("pressure", "Pa", normal.pressure);
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
}

/// Names of the fields of what laws keep of the lower and of the upper body.
const STATES: [(&str, [&str; 2]); 3] = [
    (WEAR, ["wear_lower", "wear_upper"]),
    (FILM, ["film_lower", "film_upper"]),
    ("film_grown", ["film_grown_lower", "film_grown_upper"]),
];

/// The fields of a contact that was worn in place, with its bodies as they are then.
fn worn_fields(contact: WornContact, friction: Option<Friction>) -> RestFields {
    let WornContact { state: SlidingState { pair, .. }, solution, temperature, .. } = contact;
    // Films have given the bodies another hardness.
    let (grid, approach, hardness) = (pair.lower_grid(), solution.approach, pair.min_hardness());
    let (gap, plastic) = (solution.gap(), solution.plastic_interference());
    let mut fields = Vec::new();
    let mut add = |name, unit, values| fields.push(NamedField { name, unit, values });
    let shear = friction.map(|friction| solution.pressure.mapv(|p| friction.shear_limit(p)));
    add("pressure", "Pa", solution.pressure);
    add("displacement", "m", solution.displacement);
    add("gap", "m", gap);
    for (state, names) in STATES {
        for (name, body) in names.into_iter().zip([&pair.lower, &pair.upper]) {
            if let Some(State { values, .. }) = body.state.get(state) {
                add(name, "m", values.clone());
            }
        }
    }
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

impl RestFields {
    /// The field of that name, which is taken out.
    pub fn take(&mut self, name: &str) -> Option<Field> {
        let at = self.fields.iter().position(|field| field.name == name)?;
        Some(self.fields.swap_remove(at).values)
    }

    /// What acts on the lower body.
    pub(super) fn tractions(&self) -> Tractions {
        let of = |name| self.fields.iter().find(|field| field.name == name).map(|field| field.values.clone());
        let shear = ["traction_x", "traction_y"].map(of);
        Tractions { pressure: of("pressure").expect("every contact has a pressure"), shear }
    }
}
