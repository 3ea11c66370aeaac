//! Excluded combinations of a case file, in one table.
//!
//! Each row has a message, a hint and the key that the error points to. A case is checked against the rows
//! once all of its tables are read. `docs/input/combinations.md` lists them, and a test runs their examples.

mod bodies;
mod device;
mod examples;
mod loading;
mod lubrication;
mod motion;
mod output;
mod plasticity;
mod running;
mod temperature;
mod viscoelastic;

use super::cursor::{Entry, Table};
use super::{Body, Case, FrictionSpec, MotionSpec};
use asperity_base::error::{Error, Result};
use asperity_base::table;
use asperity_contact::each;
use asperity_contact::motion::Strategy;
use asperity_contact::with::viscoelastic::Viscoelasticity;
use asperity_contact::with::{
    self, BodyLaw, Capability, Circumstances, Listed, Slip, Surroundings, Timeless,
};

/// The description of a rule: two entries of a case file exclude each other, or one requires the other.
pub type Exclusion = table::Rule<()>;

fn described<F>(rule: &table::Rule<F>) -> Exclusion {
    let table::Rule { this, with, message, hint, at, example, .. } = *rule;
    table::Rule { this, with, message, hint, at, example, broken: () }
}

/// A rule that the tables of a case break: it finds the entry that does.
type Rule = table::Rule<for<'a> fn(&Tables<'a>) -> Option<Entry<'a>>>;

/// The case, with its tables.
struct Tables<'a> {
    root: &'a Table<'a>,
    case: &'a Case,
}

/// Rules of the bodies and of their loading and motion, which come before those of the laws that change the
/// bodies.
const OF_THE_CONTACT: [&[Rule]; 7] = [
    bodies::RULES,
    lubrication::RULES,
    viscoelastic::RULES,
    motion::RULES,
    loading::RULES,
    plasticity::RULES,
    running::RULES,
];

/// Rules of everything else, which come after those of the laws.
const OF_THE_REST: [&[Rule]; 3] = [temperature::RULES, output::RULES, device::RULES];

/// Returns an error if the case breaks a rule.
pub(super) fn check(root: &Table<'_>, case: &Case) -> Result<()> {
    let tables = Tables { root, case };
    tables.check(&OF_THE_CONTACT)?;
    tables.check_laws()?;
    tables.check(&OF_THE_REST)?;
    let surroundings = case.surroundings();
    each!(interface I => tables.check_given(I::of(&case.interface), I::RULES, &surroundings)?);
    each!(capability C => tables.check_given(C::of(&case.with), C::RULES, &surroundings)?);
    Ok(())
}

/// Returns the rules of a case file, in the order in which a case is checked.
pub fn rules() -> Vec<Exclusion> {
    let mut exclusions: Vec<_> = OF_THE_CONTACT.into_iter().flatten().map(described).collect();
    each!(law L => exclusions.extend(L::RULES.iter().map(described)));
    exclusions.extend(OF_THE_REST.into_iter().flatten().map(described));
    each!(interface I => exclusions.extend(I::RULES.iter().map(described)));
    each!(capability C => exclusions.extend(C::RULES.iter().map(described)));
    exclusions
}

/// Returns the error for an entry that breaks a rule.
fn refused<F>(rule: &table::Rule<F>, entry: &Entry<'_>) -> Error {
    let message = rule.message.replace("{key}", entry.key()).replace("{path}", entry.path());
    let message = message.replace("{value}", &entry.written());
    entry.error(message, Some(rule.hint.to_owned()).filter(|hint| !hint.is_empty()))
}

/// Returns the entry of a dotted key in a table, if it is given.
fn find<'a>(table: &Table<'a>, key: &str) -> Option<Entry<'a>> {
    match key.split_once('.') {
        None => table.get(key),
        Some((first, rest)) => find(&table.table(first).ok()??, rest),
    }
}

impl<'a> Tables<'a> {
    /// Returns an error if the case breaks one of these rules.
    fn check(&self, rules: &[&[Rule]]) -> Result<()> {
        let broken = rules.iter().copied().flatten().find_map(|rule| Some((rule, (rule.broken)(self)?)));
        broken.map_or(Ok(()), |(rule, entry)| Err(refused(rule, &entry)))
    }

    /// Returns an error if a table that is `given` breaks one of its rules.
    fn check_given<T>(
        &self,
        given: Option<&T>,
        rules: &[with::Rule<T>],
        surroundings: &Surroundings,
    ) -> Result<()> {
        let Some(table) = given else { return Ok(()) };
        let broken = rules.iter().filter(|rule| (rule.broken)(table, surroundings));
        let mut broken = broken.filter_map(|rule| Some((rule, self.at(rule.at)?)));
        broken.next().map_or(Ok(()), |(rule, entry)| Err(refused(rule, &entry)))
    }

    /// Returns an error if the case breaks a rule of a law that changes a body.
    fn check_laws(&self) -> Result<()> {
        for (name, body) in [("lower", &self.case.lower), ("upper", &self.case.upper)] {
            let circumstances = self.circumstances(body);
            each!(law L => for rule in L::RULES {
                let is_broken = L::of(&body.laws).is_some_and(|law| (rule.broken)(law, &circumstances));
                let at = rule.at.strip_prefix("lower").map_or(rule.at.to_owned(), |key| format!("{name}{key}"));
                if let Some(entry) = self.at(&at).filter(|_| is_broken) {
                    return Err(refused(rule, &entry));
                }
            });
        }
        Ok(())
    }

    /// Returns the entry of a dotted key, if it is given.
    fn at(&self, key: &str) -> Option<Entry<'a>> {
        find(self.root, key)
    }

    /// Returns the table of the first given capability that looks at single contacts.
    fn of_single_contacts(&self) -> Option<Entry<'a>> {
        let mut found = None;
        each!(capability C => found = found.or(self.at(C::NAME).filter(|_| !C::OF_LOAD_CYCLES)));
        found
    }

    /// Returns the first given key of these keys of a table.
    fn first(&self, table: &str, keys: &[&str]) -> Option<Entry<'a>> {
        keys.iter().find_map(|key| self.at(&format!("{table}.{key}")))
    }

    /// Returns the entry of a key in the first body of this kind that has it.
    fn of_body(&self, key: &str, is: impl Fn(&Body) -> bool) -> Option<Entry<'a>> {
        let bodies = [("lower", &self.case.lower), ("upper", &self.case.upper)];
        bodies
            .into_iter()
            .filter(|(_, body)| is(body))
            .find_map(|(name, _)| self.at(&format!("{name}.{key}")))
    }

    /// Returns the key of a sweep in [contact].
    fn sweep(&self) -> Option<Entry<'a>> {
        self.first("contact", &["loads", "mean_pressures", "approaches"])
    }

    /// Returns the stages of the history, or the history if it has none.
    fn stages(&self) -> Vec<Entry<'a>> {
        let Some(history) = self.at("history") else { return Vec::new() };
        match history.items("") {
            Ok(stages) if !stages.is_empty() => stages,
            _ => vec![history],
        }
    }

    /// Returns the first given key of these keys in a stage of the history.
    fn of_stage(&self, keys: &[&str]) -> Option<Entry<'a>> {
        let stages = self.stages().into_iter().filter_map(|stage| stage.table().ok());
        let mut given = stages.filter_map(|stage| keys.iter().find_map(|key| stage.get(key)));
        given.next()
    }

    /// Returns the boundary, if it is periodic along one axis only.
    fn line(&self) -> Option<Entry<'a>> {
        let boundary = self.case.contact.boundary;
        self.at("contact.boundary").filter(|_| boundary.repeats(0) != boundary.repeats(1))
    }

    fn motion(&self) -> Option<&'a MotionSpec> {
        self.case.motion.as_ref()
    }

    fn friction(&self) -> Option<&'a FrictionSpec> {
        self.case.friction.as_ref()
    }

    /// Returns the motion of an overlap.
    fn overlap(&self) -> Option<&'a MotionSpec> {
        self.motion().filter(|motion| motion.strategy() == Strategy::Overlap)
    }

    /// Returns the motion of a shift.
    fn shift(&self) -> Option<&'a MotionSpec> {
        self.motion().filter(|motion| motion.strategy() != Strategy::Overlap)
    }

    /// Whether the bodies slide over each other.
    fn slides(&self) -> bool {
        self.case.motion.is_some() || self.case.sliding.is_some()
    }

    /// Whether the bodies slip on each other in the stages of a loading.
    fn frets(&self) -> bool {
        !self.case.course(1.0).stages().is_empty() && self.case.friction.is_some()
    }

    /// Returns what the laws of a body need to know.
    fn circumstances(&self, body: &'a Body) -> Circumstances<'a> {
        Circumstances {
            laws: &body.laws,
            yields: body.hardness.yields(),
            has_friction: self.friction().is_some(),
            has_temperature: self.case.temperature.is_some(),
            relaxes: self.viscoelastic().is_some(),
            slip: self.slip(),
            timeless: self.timeless(),
        }
    }

    fn slip(&self) -> Slip {
        match self.motion() {
            Some(motion) if motion.strategy().direction() == 0.0 => Slip::Rolling,
            Some(_) => Slip::InPasses,
            None if self.case.sliding.is_some() => Slip::InPlace,
            None if self.frets() => Slip::InStages,
            None => Slip::None,
        }
    }

    /// Returns what is missing to know the time of the steps.
    fn timeless(&self) -> Option<Timeless> {
        if let Some(sliding) = self.case.sliding {
            return sliding.speed.is_none().then_some(Timeless::InPlace);
        }
        if let Some(motion) = self.motion() {
            let is_given = match motion.strategy() {
                Strategy::Overlap => motion.speed.is_some(),
                Strategy::Shift { .. } => self.first("motion", &["speed_upper", "speed_lower"]).is_some(),
            };
            let missing = match motion.strategy() {
                Strategy::Overlap => Timeless::Overlap,
                Strategy::Shift { .. } => Timeless::Shift,
            };
            return Some(missing).filter(|_| !is_given);
        }
        let mut cycles = self.case.history.iter().filter(|stage| stage.cycles.is_some()).peekable();
        match cycles.peek() {
            None => Some(Timeless::Cycles),
            Some(_) => cycles.any(|stage| stage.period.is_none()).then_some(Timeless::Period),
        }
    }

    fn rolls(&self) -> bool {
        self.friction().is_some_and(FrictionSpec::rolls)
    }

    /// Whether a body deforms plastically below its surface.
    fn flows(&self) -> bool {
        [&self.case.lower, &self.case.upper].iter().any(|body| body.plasticity.is_some())
    }

    fn yields(&self) -> bool {
        self.case.yields()
    }

    /// Returns the table of a viscoelastic body or layer.
    fn viscoelastic(&self) -> Option<Entry<'a>> {
        self.of_part("viscoelastic", |_| true)
    }

    /// Returns the entry by which the relaxation of a body or layer depends on its temperature.
    fn shifted(&self) -> Option<Entry<'a>> {
        self.of_part("viscoelastic.wlf_c1", Viscoelasticity::needs_temperature)
    }

    /// Returns the entry of a key in the first layer or body that relaxes so.
    fn of_part(&self, key: &str, is: impl Fn(&Viscoelasticity) -> bool) -> Option<Entry<'a>> {
        let bodies = [("lower", &self.case.lower), ("upper", &self.case.upper)];
        bodies.into_iter().find_map(|(name, body)| {
            let mut relaxing = body.parts().filter(|part| part.viscoelastic.is_some_and(&is));
            let table = match relaxing.next()?.layer {
                None => self.at(name)?.table().ok()?,
                Some(n) => match self.at(&format!("{name}.coating")) {
                    Some(coating) => coating.table().ok()?,
                    None => self.at(&format!("{name}.layers"))?.tables().ok()?.into_iter().nth(n)?,
                },
            };
            find(&table, key)
        })
    }

    /// Whether passes are extrapolated.
    fn jumps(&self) -> bool {
        self.case.acceleration.is_some_and(|acceleration| acceleration.max_jump > 1)
    }

    /// Returns the entry that requests a flash temperature.
    fn flash(&self) -> Option<Entry<'a>> {
        let wanted = self.case.temperature.is_some_and(|temperature| temperature.every() > 0);
        self.at("temperature.every").or(self.at("temperature")).filter(|_| wanted)
    }

    /// Returns the key `every` if other passes use the flash temperature of a computed pass.
    fn seldom(&self) -> Option<Entry<'a>> {
        let every = self.case.temperature.map_or(0, |temperature| temperature.every());
        self.at("temperature.every").filter(|_| every > 1)
    }
}
