//! A static contact on a grid that is distributed over ranks, and its results.
//!
//! ```text
//! DIR/case.json summary.json   as for any run
//!     fields/rank-0000.h5 …    the fields on the rows of each rank
//!     fields/ranks.json        the rows in each file
//!     fields.h5                all rows, after collection
//! ```

use std::path::Path;
use std::sync::Arc;
use std::thread;
use std::time::Duration;

use web_time::Instant;

use crate::index::{Index, Named};
use crate::prepare::{SlabBodies, made_by_slabs, slab_bodies};
use crate::press::press_slab;
use asperity_base::error::{Error, Result};
use asperity_base::grid::Grid;
use asperity_base::io::atomic::Token;
use asperity_base::ranks::{Largest, Ranks};
use asperity_contact::each;
use asperity_contact::motion::Pair;
use asperity_contact::operator::{Boundary, Edge};
use asperity_contact::solver::{Device, Method};
use asperity_contact::with::{BodyLaw, Capability, Listed};
use asperity_study::SurfaceInput;
use asperity_study::case::Case;
use asperity_study::io::fields::FieldFile;
use asperity_study::parts::{
    BodyData, Computed, closed_form, conclude, cut_off, grids, identity_of, params, pressed, resolved_of,
    spot, too_few_cells,
};
use asperity_study::{Demand, demand};
use asperity_study::{Existing, Results, Writer};
use asperity_study::{Outcome, Summary};

/// The memory that a rank needs for a contact, bytes.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct DemandOfRank {
    /// The largest memory at any time, except while the surfaces are made.
    pub steady: f64,
    /// The largest memory while the surfaces are generated or read, by one rank per machine at a time.
    pub making: f64,
    /// The memory that the first rank needs to collect all fields.
    pub collecting: f64,
}

/// Estimates the memory that each of the `ranks` needs for `case`. Only the sizes of files are read.
///
/// # Errors
/// [`Error::Case`] if a file cannot be read, or if `case` is not supported on ranks; [`Error::TooManyRanks`].
pub fn demand_on_ranks(case: &Case, ranks: usize) -> Result<DemandOfRank> {
    check(case)?;
    let given = SurfaceInput::default();
    let Demand { surfaces, solver, results, .. } = demand(case, &given, 1)?;
    let cells = |grid: &Grid| grid.shape[0] as f64 * grid.shape[1] as f64;
    let grids = grids(case, &given)?;
    let [rows, columns] = grids[1].shape;
    if ranks > rows {
        return Err(Error::TooManyRanks { ranks, rows });
    }
    let share = rows.div_ceil(ranks) as f64 / rows as f64;
    let kept = NUMBER * grids.iter().map(cells).sum::<f64>();
    let exchanged = if ranks > 1 { EXCHANGED } else { 1.0 };
    let steady = PROGRAM + share * exchanged * (kept + solver.max(results));
    let by_slabs = [&case.lower, &case.upper].into_iter().all(|body| made_by_slabs(&body.topography));
    let making = PROGRAM + if by_slabs { share * surfaces } else { surfaces };
    Ok(DemandOfRank { steady, making, collecting: collecting([rows, columns]) })
}

/// Estimates the memory that [`collect`] needs for the results in `directory`, bytes.
///
/// # Errors
/// The errors of [`collect`] for its first file.
pub fn demand_of_collecting(directory: &Path) -> Result<f64> {
    let index = Index::read(directory, &Results::open(directory)?.case_json()?)?;
    Ok(collecting(index.grid().shape))
}

fn collecting([rows, columns]: [usize; 2]) -> f64 {
    /// Number of fields stored at a time.
    const FIELDS: f64 = 5.0;
    PROGRAM + FIELDS * NUMBER * rows as f64 * columns as f64
}

/// Memory of the ranks relative to that of one process: transforms are stored twice while they are exchanged.
const EXCHANGED: f64 = 1.2;
/// Memory of the program, MPI and their libraries.
const PROGRAM: f64 = 24e6;
/// Bytes of a number.
const NUMBER: f64 = 8.0;

/// Computes the static contact of `case` on these `ranks`, which all call it together, and writes its results
/// to `directory`, which all of them must see. Each rank writes the fields on its rows, and rank 0 everything
/// else. Rank 0 receives the summary.
///
/// If both surfaces are Gaussian or forms, without further preparation, each rank generates only its slab.
/// For other surfaces each rank holds the whole for a while.
///
/// # Errors
/// Every error of a case, its surfaces, the contact or the directory; [`Error::Case`] for input that is not
/// supported on ranks; [`Error::RanksDiffer`], also if a rank sees another directory than rank 0;
/// [`Error::TooManyRanks`]. If one rank fails, the others keep waiting for it.
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
    let resolved = resolved_of(
        case,
        [&bodies[0], &bodies[1]].map(|body| BodyData {
            grid: slab.whole_grid(),
            origin: body.origin.as_ref(),
            hardness_sha256: body.hardness_sha256.as_ref(),
            master_sha256: Vec::new(),
        }),
    );
    let identity = identity_of(&resolved);
    check_same(&**ranks, "case", &identity)?;
    let [lower, upper] = bodies;
    let materials = [&case.lower.material, &case.upper.material];
    let pair = Pair::new(lower.topography, upper.topography, materials)?
        .with_hardness([lower.hardness, upper.hardness])?;
    let first = ranks.rank() == 0;
    let writer = first.then(|| Writer::enter(directory, &resolved, existing)).transpose()?;
    check_same_directory(&**ranks, directory)?;
    let control = case.contact.prescribed().control(slab.whole_grid().area());
    let contact = press_slab(&pair, &slab, case.contact.boundary, control, &params(case))?;
    if let Some(writer) = &writer {
        writer.begin()?;
    }
    wait_for_all(&**ranks);
    let outcome = Outcome::Static(Box::new(contact.record.clone()));
    let Largest(softest) = slab.merged(Largest(-pair.min_hardness()));
    let fields = pressed(pair, contact.solution);
    let index = Index::new(&slab, case.contact.boundary, &fields, -softest, &identity);
    index.write_part(directory, &slab, fields)?;
    wait_for_all(&**ranks);
    let Some(writer) = writer else { return Ok(None) };
    index.write(directory)?;
    let closed_form = closed_form(case, slab.whole_grid().extent(), &outcome);
    let computed = Computed::from_outcome(outcome).with_closed_form(closed_form);
    conclude(case, &writer, began, computed, Vec::new()).map(Some)
}

/// Gathers the fields that the ranks of a run left in `directory` into one file, as from a run of one
/// process. Adds to the summary the warnings that need the whole contact. It takes the memory of all fields.
///
/// # Errors
/// [`Error::NoResults`] if no run on ranks has finished, [`Error::File`] for missing or damaged files,
/// [`Error::OtherRows`] for files with the rows of another rank, [`Error::NotResumable`] for files of another
/// run. Earlier collected fields then stay unchanged.
pub fn collect(directory: &Path) -> Result<()> {
    let results = Results::open(directory)?;
    let index = Index::read(directory, &results.case_json()?)?;
    let mut summary = results.summary()?;
    let grid = index.grid();
    let mut file = FieldFile::of_run(&index.identity, &results.static_path());
    file.set("approach", index.approach).set("hardness", index.hardness.unwrap_or(f64::INFINITY));
    let parts = index.open_parts(directory)?;
    let mut needed = Vec::new();
    for field in &index.fields {
        let values = index.whole(&parts, field)?;
        let Named { name, unit } = field;
        file.add_field(name, unit, &grid, [0.0, 0.0], &values);
        if ["pressure", "lower", "upper"].contains(&name.as_str()) {
            needed.push(values);
        }
    }
    file.write()?;
    let [pressure, lower, upper] = needed.as_slice() else { unreachable!("an index that is read has these") };
    let boundary = Boundary(index.periodic.map(|wraps| if wraps { Edge::Periodic } else { Edge::Free }));
    let rim = cut_off(pressure, || upper - lower, grid.pitch, boundary);
    for warning in rim.into_iter().chain(too_few_cells(spot(pressure, boundary))) {
        if !summary.warnings.contains(&warning) {
            summary.warnings.push(warning);
        }
    }
    asperity_study::parts::write_summary(&results.summary_path(), &summary)
}

/// Rejects input that is not supported on ranks, at its place in the case.
fn check(case: &Case) -> Result<()> {
    let bodies = [("lower", &case.lower), ("upper", &case.upper)];
    let of_bodies = bodies.into_iter().flat_map(|(name, body)| {
        let mut tables = vec![("plasticity", body.plasticity.is_some())];
        each!(law L => tables.push((L::NAME, L::of(&body.laws).is_some())));
        tables.into_iter().map(move |(table, given)| (format!("{name}.{table}"), given))
    });
    let tables = [
        ("friction", case.friction.is_some()),
        ("history", !case.history.is_empty()),
        ("motion", case.motion.is_some()),
        ("sliding", case.sliding.is_some()),
        ("steady", case.steady.is_some()),
        ("temperature", case.temperature.is_some()),
        ("plasticity", case.plasticity.is_some()),
        ("subsurface", case.subsurface.is_some()),
        ("output.paraview", case.output.paraview),
        ("contact.sweep", !case.contact.sweep().is_empty()),
        ("contact.method", matches!(case.contact.method, Method::Direct | Method::PolonskyKeer)),
        ("contact.device", case.contact.device != Device::Cpu),
    ];
    let tables = tables.map(|(table, given)| (table.to_owned(), given));
    let mut asked = Vec::new();
    each!(interface I => asked.push((I::NAME.to_owned(), I::of(&case.interface).is_some())));
    each!(capability C => asked.push((C::NAME.to_owned(), C::of(&case.with).is_some())));
    match tables.into_iter().chain(asked).chain(of_bodies).find(|(_, given)| *given) {
        None => Ok(()),
        Some((key, _)) => Err(case.error_at(
            &key,
            format!("'{key}' is not computed on ranks"),
            Some("take it out, or let `asperity run` compute the case on one machine".to_owned()),
        )),
    }
}

/// Returns an error if the ranks differ in their `text`.
fn check_same(ranks: &dyn Ranks, what: &'static str, text: &str) -> Result<()> {
    // As many digits as a number represents exactly.
    let digest = asperity_study::io::sha256(text.as_bytes());
    let number = u64::from_str_radix(&digest[..12], 16).expect("hexadecimal") as f64;
    let numbers = ranks.gather(&[number], &vec![1; ranks.count()]);
    match numbers.iter().position(|other| *other != numbers[0]) {
        None => Ok(()),
        Some(rank) => Err(Error::RanksDiffer { rank, what }),
    }
}

/// Returns an error if a rank does not see the `directory` of rank 0, which keeps a file there until all have
/// looked.
fn check_same_directory(ranks: &dyn Ranks, directory: &Path) -> Result<()> {
    /// Number of attempts, and the wait between them: a network file system may be slow.
    const TRIALS: (usize, Duration) = (10, Duration::from_millis(100));
    let token = match ranks.rank() {
        0 => Some(Token::new(directory)?),
        _ => None,
    };
    let number = token.as_ref().map_or(0, Token::number) as f64;
    let number = ranks.gather(&[number], &vec![1; ranks.count()])[0] as u64;
    let sees = || Token::is_in(directory, number);
    let seen = sees()
        || (1..TRIALS.0).any(|_| {
            thread::sleep(TRIALS.1);
            sees()
        });
    let all = ranks.gather(&[f64::from(seen)], &vec![1; ranks.count()]);
    match all.iter().position(|seen| *seen == 0.0) {
        None => Ok(()),
        Some(rank) => Err(Error::RanksDiffer { rank, what: "results directory" }),
    }
}

/// Returns once all ranks have called it.
fn wait_for_all(ranks: &dyn Ranks) {
    ranks.gather(&[0.0], &vec![1; ranks.count()]);
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use asperity_base::grid::Field;
    use asperity_base::ranks::threads::on_ranks;
    use asperity_study::{SurfaceInput, run};

    /// Two bodies: a ball with roughness below, a measured or generated surface above.
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
            // Preparation: each rank makes the surface as a whole.
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
            let (expected, _) = run(&case, SurfaceInput::default(), &alone, Existing::Keep, &()).unwrap();
            let [together, alone] = [together, alone].map(|path| Results::open(&path).unwrap());
            assert_eq!(together.case_json().unwrap(), alone.case_json().unwrap());
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
                    _ => unreachable!("a static contact"),
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

    /// Returns the results of a case on `count` ranks, in a new directory.
    fn computed(case: &Case, count: usize) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        on_ranks(count, |ranks| run_on_ranks(case, &ranks, folder.path(), Existing::Keep).map(drop))
            .into_iter()
            .for_each(Result::unwrap);
        folder
    }

    fn file_of(folder: &tempfile::TempDir, rank: usize) -> std::path::PathBuf {
        folder.path().join("fields").join(format!("rank-{rank:04}.h5"))
    }

    #[test]
    fn a_file_of_other_rows_or_of_another_run_is_refused_by_its_name() {
        let load = |load: &str| case("", &format!("load = \"{load}\""));
        let two = computed(&load("0.1 N"), 2);
        let three = computed(&load("0.1 N"), 3);
        let other = computed(&load("0.2 N"), 2);
        let own = [0, 1].map(|rank| fs::read(file_of(&two, rank)).unwrap());
        let of = |folder: &tempfile::TempDir, rank| fs::read(file_of(folder, rank)).unwrap();
        for (rank, content, said) in [
            (0, own[1].clone(), "holds rows 33 to 65 of a run on 2 ranks, expected rows 0 to 32 of one on 2"),
            (1, own[0].clone(), "holds rows 0 to 32 of a run on 2 ranks, expected rows 33 to 65 of one on 2"),
            (0, of(&three, 0), "holds rows 0 to 21 of a run on 3 ranks, expected rows 0 to 32 of one on 2"),
            (1, of(&three, 2), "holds rows 44 to 65 of a run on 3 ranks, expected rows 33 to 65 of one on 2"),
            (1, of(&other, 1), "is of another run"),
        ] {
            fs::write(file_of(&two, rank), content).unwrap();
            let message = collect(two.path()).unwrap_err().to_string();
            assert_eq!(message, format!("{} {said}", file_of(&two, rank).display()));
            fs::write(file_of(&two, rank), &own[rank]).unwrap();
        }
        // Both at once, with the index of another run.
        fs::write(file_of(&two, 0), &own[1]).unwrap();
        fs::write(file_of(&two, 1), &own[0]).unwrap();
        assert!(matches!(collect(two.path()), Err(Error::OtherRows { rows: [33, 65], .. })));
        [0, 1].iter().for_each(|rank| fs::write(file_of(&two, *rank), &own[*rank]).unwrap());
        let index = |folder: &tempfile::TempDir| folder.path().join("fields/ranks.json");
        let own_index = fs::read(index(&two)).unwrap();
        fs::copy(index(&other), index(&two)).unwrap();
        let message = collect(two.path()).unwrap_err().to_string();
        assert_eq!(message, format!("{} is of another run", index(&two).display()));
        assert!(!two.path().join("fields.h5").exists(), "a field was collected from the wrong rows");
        fs::write(index(&two), own_index).unwrap();
        collect(two.path()).unwrap();
    }

    #[test]
    fn a_damaged_file_of_a_run_gives_an_error_that_names_it() {
        let folder = computed(&case("", "load = \"0.1 N\""), 2);
        collect(folder.path()).unwrap();
        let fields = || {
            let fields = Results::open(folder.path()).unwrap().static_fields().unwrap();
            let read = |name: &String| fields.read(name).unwrap().into_field().unwrap();
            fields.names().unwrap().iter().map(read).collect::<Vec<Field>>()
        };
        let expected = fields();
        let (mut refused, mut unharmed) = (0, 0);
        for name in ["rank-0000.h5", "rank-0001.h5", "ranks.json"] {
            let path = folder.path().join("fields").join(name);
            let whole = fs::read(&path).unwrap();
            let flipped = (0..whole.len()).step_by(whole.len() / 60).map(|at| {
                let mut bytes = whole.clone();
                bytes[at] ^= 0x55;
                bytes
            });
            let cut = [0, 1, 7, 8, 100, whole.len() / 2, whole.len() - 1].map(|n| whole[..n].to_vec());
            for bytes in flipped.chain(cut) {
                fs::write(&path, bytes).unwrap();
                match collect(folder.path()) {
                    // A byte without effect, such as one in the name of a version, an unused one or a space.
                    Ok(()) => {
                        assert_eq!(fields(), expected, "{name} was damaged without a word");
                        unharmed += 1;
                    }
                    Err(error) => {
                        assert!(error.to_string().contains(name), "{error}");
                        refused += 1;
                    }
                }
            }
            fs::write(&path, whole).unwrap();
        }
        assert!(refused > 2 * unharmed, "{refused} of {} refused", refused + unharmed);
    }

    #[test]
    fn an_index_that_does_not_hold_each_row_once_is_refused() {
        let folder = computed(&case("", "load = \"0.1 N\""), 2);
        let path = folder.path().join("fields/ranks.json");
        let index: serde_json::Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
        for (pointer, value, said) in [
            ("/parts/1/first_row", serde_json::json!(0), "do not hold each row once"),
            ("/parts/1/rows", serde_json::json!(34), "do not hold each row once"),
            ("/parts/0/rows", serde_json::json!(0), "do not hold each row once"),
            ("/parts/1/rows", serde_json::json!(u64::MAX), "do not hold each row once"),
            ("/parts", serde_json::json!([]), "do not hold each row once"),
            ("/parts/1/file", serde_json::json!("../fields/rank-0000.h5"), "not numbered in the order"),
            ("/shape", serde_json::json!([0, 48]), "no meaning"),
            ("/shape", serde_json::json!([66, 49]), "another shape"),
            ("/pitch/1", serde_json::json!(2e-6), "another shape, pitch or unit"),
            ("/fields/0/name", serde_json::json!("displacement"), "ranks.json"),
            ("/fields", serde_json::json!([]), "lists no pressure"),
            ("/identity", serde_json::json!("0"), "is of another run"),
        ] {
            let mut changed = index.clone();
            *changed.pointer_mut(pointer).unwrap() = value;
            crate::index::sign(&mut changed);
            fs::write(&path, changed.to_string()).unwrap();
            let message = collect(folder.path()).unwrap_err().to_string();
            assert!(message.contains(said), "{pointer}: {message}");
        }
        assert!(!folder.path().join("fields.h5").exists());
    }

    #[test]
    fn ranks_that_write_to_different_directories_are_refused_by_all() {
        let folder = tempfile::tempdir().unwrap();
        let case = case("", "load = \"0.1 N\"");
        let errors = on_ranks(2, |ranks| {
            let own = folder.path().join(format!("of-{}", ranks.rank()));
            std::fs::create_dir(&own).unwrap();
            run_on_ranks(&case, &ranks, &own, Existing::Keep).unwrap_err().to_string()
        });
        assert_eq!(errors, ["rank 1 has another results directory than rank 0"; 2]);
        for rank in 0..2 {
            let left = fs::read_dir(folder.path().join(format!("of-{rank}"))).unwrap();
            let left: Vec<_> =
                left.map(|entry| entry.unwrap().file_name()).filter(|n| n != ".lock").collect();
            assert!(left.is_empty(), "rank {rank} has written {left:?}");
        }
    }

    #[test]
    fn the_memory_of_a_rank_falls_with_their_number_where_surfaces_are_made_by_slabs() {
        let demands = |upper: &str| [1, 2, 4].map(|n| demand_on_ranks(&case(upper, "load = 1"), n).unwrap());
        let [one, two, four] = demands("");
        let own = |demand: DemandOfRank| demand.steady - PROGRAM;
        assert!(own(one) > 1.6 * own(two) && own(two) > 1.8 * own(four), "{one:?} {two:?} {four:?}");
        assert!(one.making > two.making && two.making > four.making);
        assert_eq!(one.collecting, four.collecting);
        // A levelled surface is made as a whole.
        let [one, _, four] = demands("level = \"mean\"");
        assert_eq!(one.making, four.making);
        let error = demand_on_ranks(&case("", "load = 1"), 67).unwrap_err();
        assert_eq!(error.to_string(), "67 ranks are too many for a grid of 66 rows along x");
    }

    #[test]
    fn what_is_not_computed_on_ranks_is_refused_at_its_line() {
        for (table, key) in [
            ("method = \"direct\"", "contact.method"),
            ("device = \"host\"", "contact.device"),
            ("[friction]\ncoefficient = inf", "friction"),
            ("[subsurface]\nto = \"5 um\"", "subsurface"),
            ("[flow]\nviscosity = \"1 mPa s\"", "flow"),
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
