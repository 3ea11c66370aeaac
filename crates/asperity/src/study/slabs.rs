//! A contact at rest on a grid that is divided among ranks, and its results.
//!
//! ```text
//! DIR/case.json summary.json   as of any run
//!     fields/rank-0000.h5 …    the fields on the rows of each rank
//!     fields/ranks.json        which rows these are
//!     fields.h5                all rows, once they are collected
//! ```

use std::fs;
use std::path::Path;
use std::sync::Arc;

use ndarray::s;
use serde::{Deserialize, Serialize};
use web_time::Instant;

use super::case::Case;
use super::estimate::{cut_off, spot, too_few_cells};
use super::identity::{self, Known};
use super::prepare::{SlabBodies, slab_bodies};
use super::rest::{NamedField, RestFields, Solved};
use super::results::{Existing, Results, Writer};
use super::run::{Computed, conclude, params};
use super::summary::{self, Outcome, Summary};
use crate::error::{Error, Result};
use crate::grid::{Field, Grid};
use crate::io::atomic;
use crate::io::fields::{Attribute, FieldFile, Fields};
use crate::motion::{Pair, press_slab};
use crate::operator::{Boundary, Edge};
use crate::ranks::{Largest, Ranks, Slab};
use crate::solver::Method;
use crate::units::{Metre, Pascal};

/// Computes the contact at rest of `case` on these `ranks`, which call it together, and writes its results to `directory`, which all
/// of them see: each the fields on its rows, rank 0 all else. The summary is given to rank 0.
///
/// Surfaces that are made are made by slabs, where both are Gaussian or forms and nothing else is done with them; of others each
/// rank has the whole for a while.
///
/// # Errors
/// Everything that can be wrong with a case, its surfaces, the contact or the directory; [`Error::Case`] for what is not computed on
/// ranks, [`Error::RanksDiffer`], [`Error::TooManyRanks`]. The other ranks wait for one that has an error.
pub fn run_on_ranks(
    case: &Case,
    ranks: &Arc<dyn Ranks>,
    directory: &Path,
    existing: Existing,
) -> Result<Option<Summary>> {
    let began = Instant::now();
    check_same(&**ranks, "version of asperity", env!("CARGO_PKG_VERSION"))?;
    check(case)?;
    let SlabBodies { slab, bodies } = slab_bodies(case, Arc::clone(ranks))?;
    let resolved = identity::resolved_of(
        case,
        [&bodies[0], &bodies[1]].map(|body| Known {
            grid: slab.whole_grid(),
            origin: body.origin.as_ref(),
            hardness_sha256: body.hardness_sha256.as_ref(),
        }),
    );
    let identity = identity::of(&resolved);
    check_same(&**ranks, "case", &identity)?;
    let [lower, upper] = bodies;
    let materials = [&case.lower.material, &case.upper.material];
    let pair = Pair::new(lower.topography, upper.topography, materials)?
        .with_hardness([lower.hardness, upper.hardness])?;
    let first = ranks.rank() == 0;
    let writer = first.then(|| Writer::enter(directory, &resolved, existing)).transpose()?;
    let control = case.contact.prescribed.control(slab.whole_grid().area());
    let contact = press_slab(&pair, &slab, case.contact.boundary, control, &params(case))?;
    if let Some(writer) = &writer {
        writer.begin()?;
    }
    wait_for_all(&**ranks);
    let outcome = Outcome::Static(Box::new(contact.record.clone()));
    let Largest(softest) = slab.merged(Largest(-pair.min_hardness()));
    let fields = Solved::Pressed(Box::new(contact)).into_fields(pair);
    let index = Index::new(&slab, case.contact.boundary, &fields, -softest, &identity);
    index.write_part(directory, &slab, fields)?;
    wait_for_all(&**ranks);
    let Some(writer) = writer else { return Ok(None) };
    index.write(directory)?;
    let computed = Computed { outcome, subsurface: Vec::new(), sliding: None, flow: None };
    conclude(case, &writer, resolved, began, computed, Vec::new()).map(Some)
}

/// Gathers the fields that the ranks of a run have left in `directory` into the one file that a run of one process leaves there,
/// and adds to its summary what the whole contact gives to be wary of. It takes the memory of all fields.
///
/// # Errors
/// [`Error::NoResults`] where no run on ranks has ended, [`Error::File`] for files that are missing, damaged or of another run.
pub fn collect(directory: &Path) -> Result<()> {
    let results = Results::open(directory)?;
    let index = Index::read(directory)?;
    let mut summary = results.summary()?;
    let grid = Grid::new(index.shape, index.pitch)?;
    let mut file = FieldFile::of_run(&index.identity, &results.static_path());
    file.set("approach", index.approach).set("hardness", index.hardness.unwrap_or(f64::INFINITY));
    let parts = index.open_parts(directory)?;
    let mut needed = Vec::new();
    for Named { name, unit } in &index.fields {
        let values = index.whole(&parts, name)?;
        file.add_field(name, unit, &grid, [0.0, 0.0], &values);
        if ["pressure", "lower", "upper"].contains(&name.as_str()) {
            needed.push(values);
        }
    }
    file.write()?;
    let [pressure, lower, upper] = needed.as_slice() else { unreachable!("every contact has these fields") };
    let boundary = Boundary(index.periodic.map(|wraps| if wraps { Edge::Periodic } else { Edge::Free }));
    let rim = cut_off(pressure, || upper - lower, grid.pitch, boundary);
    for warning in rim.into_iter().chain(too_few_cells(spot(pressure, boundary))) {
        if !summary.warnings.contains(&warning) {
            summary.warnings.push(warning);
        }
    }
    summary::write(&results.summary_path(), &summary)
}

/// Refuses what is not computed on ranks, where it stands in the case.
fn check(case: &Case) -> Result<()> {
    let bodies = [("lower", &case.lower), ("upper", &case.upper)];
    let of_bodies = bodies.into_iter().flat_map(|(name, body)| {
        let tables = [
            ("plasticity", body.plasticity.is_some()),
            ("wear", body.wear.is_some()),
            ("film", body.film.is_some()),
        ];
        tables.map(|(table, given)| (format!("{name}.{table}"), given))
    });
    let tables = [
        ("friction", case.friction.is_some()),
        ("history", !case.history.is_empty()),
        ("motion", case.motion.is_some()),
        ("sliding", case.sliding.is_some()),
        ("temperature", case.temperature.is_some()),
        ("plasticity", case.plasticity.is_some()),
        ("subsurface", case.subsurface.is_some()),
        ("output.paraview", case.output.paraview),
        ("contact.sweep", case.contact.sweep.is_some()),
        ("contact.method", matches!(case.contact.method, Method::Direct | Method::PolonskyKeer)),
    ];
    let tables = tables.map(|(table, given)| (table.to_owned(), given));
    match tables.into_iter().chain(of_bodies).find(|(_, given)| *given) {
        None => Ok(()),
        Some((key, _)) => Err(case.error_at(
            &key,
            format!("'{key}' is not computed on ranks"),
            Some("take it out, or let `asperity run` compute the case on one machine".to_owned()),
        )),
    }
}

/// Refuses ranks that have not the same `text`.
fn check_same(ranks: &dyn Ranks, what: &'static str, text: &str) -> Result<()> {
    // As many digits as a number holds exactly.
    let digest = crate::io::sha256(text.as_bytes());
    let number = u64::from_str_radix(&digest[..12], 16).expect("hexadecimal") as f64;
    let numbers = ranks.gather(&[number], &vec![1; ranks.count()]);
    match numbers.iter().position(|other| *other != numbers[0]) {
        None => Ok(()),
        Some(rank) => Err(Error::RanksDiffer { rank, what }),
    }
}

/// Returns once all ranks have come here.
fn wait_for_all(ranks: &dyn Ranks) {
    ranks.gather(&[0.0], &vec![1; ranks.count()]);
}

/// `fields/ranks.json`: which rows of the fields are where.
#[derive(Debug, Serialize, Deserialize)]
struct Index {
    version: String,
    identity: String,
    shape: [usize; 2],
    pitch: [Metre; 2],
    periodic: [bool; 2],
    approach: Metre,
    /// None where it is infinite.
    hardness: Option<Pascal>,
    fields: Vec<Named>,
    parts: Vec<Part>,
}

#[derive(Debug, Serialize, Deserialize)]
struct Named {
    name: String,
    unit: String,
}

/// The rows of one rank.
#[derive(Debug, Serialize, Deserialize)]
struct Part {
    file: String,
    first_row: usize,
    rows: usize,
}

/// The name of the index in the folder of the fields.
const INDEX: &str = "ranks.json";

impl Index {
    fn new(slab: &Slab, boundary: Boundary, fields: &RestFields, hardness: Pascal, identity: &str) -> Self {
        let Grid { shape, pitch } = slab.whole_grid();
        let named = |field: &NamedField| Named { name: field.name.to_owned(), unit: field.unit.to_owned() };
        let part = |(rank, rows): (usize, std::ops::Range<usize>)| Part {
            file: format!("rank-{rank:04}.h5"),
            first_row: rows.start,
            rows: rows.len(),
        };
        Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            identity: identity.to_owned(),
            shape,
            pitch,
            periodic: boundary.wraps(),
            approach: fields.approach,
            hardness: Some(hardness).filter(|hardness| hardness.is_finite()),
            fields: fields.fields.iter().map(named).collect(),
            parts: slab.parts().all().enumerate().map(part).collect(),
        }
    }

    fn read(directory: &Path) -> Result<Self> {
        let path = directory.join("fields").join(INDEX);
        let failed = |source| Error::File { path: path.clone(), source };
        let text = fs::read(&path).map_err(failed)?;
        serde_json::from_slice(&text).map_err(|error| failed(error.into()))
    }

    fn write(&self, directory: &Path) -> Result<()> {
        let text = serde_json::to_vec_pretty(self).expect("an index can be written as JSON");
        atomic::replace(&directory.join("fields").join(INDEX), &text)
    }

    /// Writes the fields on the rows of this rank.
    fn write_part(&self, directory: &Path, slab: &Slab, fields: RestFields) -> Result<()> {
        let Part { file: name, first_row, .. } = &self.parts[slab.ranks().rank()];
        let mut file = FieldFile::of_run(&self.identity, &directory.join("fields").join(name));
        file.set("first_row", *first_row);
        let origin = [*first_row as f64 * self.pitch[0], 0.0];
        for NamedField { name, unit, values } in fields.fields {
            file.add_field(name, unit, &slab.grid(), origin, &values);
        }
        file.write()
    }

    /// The files of the parts, undamaged and of this run.
    fn open_parts(&self, directory: &Path) -> Result<Vec<Fields>> {
        let open = |part: &Part| {
            let path = directory.join("fields").join(&part.file);
            let fields = Fields::open(&path)?;
            fields.verify()?;
            let ours = Some(&Attribute::from(self.identity.as_str()));
            if fields.attributes()?.get("identity") == ours {
                Ok(fields)
            } else {
                Err(Error::NotResumable { path, reason: "is of another run" })
            }
        };
        self.parts.iter().map(open).collect()
    }

    /// All rows of a field, of which `parts` have theirs.
    fn whole(&self, parts: &[Fields], name: &str) -> Result<Field> {
        let mut whole = Field::zeros(self.shape);
        for (Part { first_row, rows, .. }, fields) in self.parts.iter().zip(parts) {
            let values = fields.read(name)?.into_field().expect("a field");
            whole.slice_mut(s![*first_row..first_row + rows, ..]).assign(&values);
        }
        Ok(whole)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ranks::threads::on_ranks;
    use crate::study::{Given, run};

    /// Two bodies, the lower one of a ball and roughness, the upper one measured or made.
    fn case(upper: &str, contact: &str) -> Case {
        let text = format!(
            r#"
            [lower]
            young = "210 GPa"
            poisson = 0.3
            hardness = "2 GPa"
            [lower.topography]
            form = "sphere"
            radius = "10 mm"
            shape = [66, 48]
            pitch = "1 um"
            [[lower.topography.plus]]
            generate = "autocorrelation"
            sq = "20 nm"
            correlation_length = ["4 um", "8 um"]
            lay = "20 deg"
            seed = 1

            [upper]
            young = "210 GPa"
            poisson = 0.3
            [upper.topography]
            generate = "low-pass"
            sq = "20 nm"
            cutoff = "8 um"
            seed = 2
            {upper}

            [contact]
            tolerance = 1e-12
            {contact}
            "#
        );
        Case::parse(&text, Path::new("case.toml"), Path::new("")).unwrap()
    }

    #[test]
    fn a_case_on_ranks_leaves_what_one_process_leaves() {
        for (upper, contact) in [
            ("", "load = \"0.1 N\""),
            ("", "boundary = \"periodic\"\nmean_pressure = \"50 MPa\""),
            // Prepared, so made by each rank as a whole.
            ("level = \"mean\"", "boundary = [\"periodic\", \"free\"]\napproach = \"150 nm\""),
            // Heights that are not Gaussian.
            ("ssk = -0.5\nsku = 3.5", "load = \"0.2 N\""),
        ] {
            let case = case(upper, contact);
            let folder = tempfile::tempdir().unwrap();
            let [together, alone] = ["together", "alone"].map(|name| folder.path().join(name));
            let summaries =
                on_ranks(3, |ranks| run_on_ranks(&case, &ranks, &together, Existing::Keep).unwrap());
            assert!(summaries[0].is_some() && summaries[1..].iter().all(Option::is_none));
            collect(&together).unwrap();
            let (expected, _) = run(&case, Given::default(), &alone, Existing::Keep, &()).unwrap();
            let [together, alone] = [together, alone].map(|path| Results::open(&path).unwrap());
            assert_eq!(together.case().unwrap(), alone.case().unwrap());
            let [fields, others] = [&together, &alone].map(|results| results.static_fields().unwrap());
            assert_eq!(fields.names().unwrap(), others.names().unwrap());
            for name in ["pressure", "displacement", "lower", "upper"] {
                let [found, expected] =
                    [&fields, &others].map(|fields| fields.read(name).unwrap().into_field().unwrap());
                let size = expected.iter().fold(0.0, |m: f64, value| m.max(value.abs()));
                let error = (found - expected).iter().fold(0.0, |m: f64, e| m.max(e.abs()));
                assert!(error <= 1e-10 * size, "{name}, {contact}: {error:e} of {size:e}");
            }
            let [found, expected] =
                [together.summary().unwrap(), expected].map(|summary| match summary.outcome {
                    Outcome::Static(record) => *record,
                    _ => unreachable!("a contact at rest"),
                });
            assert!((found.load / expected.load - 1.0).abs() < 1e-10);
            assert!((found.mean_gap / expected.mean_gap - 1.0).abs() < 1e-9);
            assert_eq!(found.plastic_cells, expected.plastic_cells);
            assert!((found.contact_area / expected.contact_area - 1.0).abs() < 1e-10);
        }
    }

    #[test]
    fn what_the_whole_contact_gives_to_be_wary_of_is_told_once_it_is_collected() {
        let case = case("", "load = \"1 mN\"");
        let folder = tempfile::tempdir().unwrap();
        on_ranks(2, |ranks| run_on_ranks(&case, &ranks, folder.path(), Existing::Keep).map(drop))
            .into_iter()
            .for_each(Result::unwrap);
        let warnings = || Results::open(folder.path()).unwrap().summary().unwrap().warnings;
        assert_eq!(warnings(), Vec::<String>::new());
        for _ in 0..2 {
            collect(folder.path()).unwrap();
            let warnings = warnings();
            assert!(
                warnings.len() == 1 && warnings[0].contains("the mesh is coarse for the contact"),
                "{warnings:?}"
            );
        }
    }

    #[test]
    fn ranks_that_differ_are_refused_by_all() {
        let errors = on_ranks(3, |ranks| {
            let version = if ranks.rank() == 2 { "0.2.0" } else { "0.1.0" };
            check_same(&*ranks, "version of asperity", version).unwrap_err().to_string()
        });
        assert_eq!(errors, ["rank 2 has another version of asperity than rank 0"; 3]);
        let folder = tempfile::tempdir().unwrap();
        let errors = on_ranks(2, |ranks| {
            let load = format!("load = \"{} N\"", 1 + ranks.rank());
            run_on_ranks(&case("", &load), &ranks, folder.path(), Existing::Keep).unwrap_err().to_string()
        });
        assert_eq!(errors, ["rank 1 has another case than rank 0"; 2]);
    }

    #[test]
    fn what_is_not_computed_on_ranks_is_refused_at_its_line() {
        for (table, key) in [
            ("method = \"direct\"", "contact.method"),
            ("[friction]\ncoefficient = inf", "friction"),
            ("[subsurface]\nto = \"5 um\"", "subsurface"),
            ("[output]\nparaview = true", "output.paraview"),
            ("[motion]\npasses = 1", "motion"),
        ] {
            let case = case("", &format!("load = \"1 N\"\n{table}"));
            let Err(Error::Case(error)) = check(&case) else { panic!("{key} is not refused") };
            assert_eq!((error.key.as_str(), error.line > 30), (key, true));
            assert_eq!(error.message, format!("'{key}' is not computed on ranks"));
        }
    }
}
