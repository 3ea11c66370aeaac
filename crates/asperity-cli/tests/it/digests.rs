//! What the examples compute, as they stand and made small, against `digests/`: an answer that changed fails
//! here.
//!
//! Of each series of numbers (a column of a table, a field, the fields of all positions together) the digest
//! holds how many they are, their mean, their rms, their sum under weights that differ from place to place,
//! and some of them.
//! `ASPERITY_DIGESTS=write cargo test -p asperity-cli --test it digests -- --include-ignored` writes them
//! anew.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use asperity::io::fields::Fields;
use asperity::study::{self, Case, Existing};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use tempfile::TempDir;

use crate::support::{asperity, files, ok};

/// An example, changed.
struct Variant {
    name: &'static str,
    example: &'static str,
    /// What stands in the case file, and what stands there instead.
    edits: &'static [(&'static str, &'static str)],
    /// How far an answer may be from its digest, relative to the rms of its series.
    tolerance: f64,
    /// Ends of the names of what is not held.
    except: &'static [&'static str],
}

const VARIANTS: [Variant; 29] = [
    as_it_stands("quickstart"),
    as_it_stands("hertz"),
    as_it_stands("friction"),
    as_it_stands("measured"),
    as_it_stands("paper"),
    as_it_stands("study"),
    as_it_stands("pull-off"),
    as_it_stands("coating"),
    Variant {
        name: "coating-small",
        example: "coating",
        edits: &[
            ("shape = [96, 96]", "shape = [24, 24]"),
            ("pitch = \"0.8 um\"", "pitch = \"3.2 um\""),
            ("load = \"2 N\"", "load = \"2 N\"\ntolerance = 1e-12"),
            ("layers = 40", "layers = 8"),
        ],
        tolerance: 1e-7,
        except: &["iterations", "convolutions"],
    },
    Variant {
        name: "fretting-small",
        example: "fretting",
        edits: &[
            ("shape = [64, 64]", "shape = [24, 24]"),
            ("pitch = \"6.5 um\"", "pitch = \"17 um\""),
            ("load = \"50 N\"", "load = \"50 N\"\ntolerance = 1e-10"),
            ("cycles = 10_000", "cycles = 40"),
            ("max_wear = \"1 um\"", "max_wear = \"1 um\"\ntolerance = 1e9\nmax_jump = 8"),
        ],
        tolerance: 1e-7,
        except: &[],
    },
    Variant {
        name: "stribeck-small",
        example: "stribeck",
        edits: &[
            ("shape = [128, 96]", "shape = [36, 28]"),
            ("pitch = \"4.2 um\"", "pitch = \"15 um\""),
            ("shortest = \"36 um\"", "shortest = \"60 um\""),
            ("points = 10", "points = 4"),
        ],
        tolerance: 1e-4,
        except: &["iterations", "convolutions"],
    },
    Variant {
        name: "joint-small",
        example: "joint",
        edits: &[
            ("shape = [128, 128]", "shape = [32, 32]"),
            ("points = 10", "points = 3"),
            ("boundary = \"periodic\"", "tolerance = 1e-12\nboundary = \"periodic\""),
        ],
        tolerance: 1e-7,
        except: &["convolutions"],
    },
    Variant {
        name: "viscoelastic-small",
        example: "viscoelastic",
        edits: &[
            ("shape = [128, 128]", "shape = [32, 32]"),
            ("pitch = \"10 um\"", "pitch = \"40 um\""),
            ("shortest = \"80 um\"", "shortest = \"160 um\""),
            ("points = 11", "points = 4"),
            ("boundary = \"periodic\"", "boundary = \"periodic\"\ntolerance = 1e-10"),
        ],
        tolerance: 1e-7,
        except: &[],
    },
    Variant {
        name: "micropitting-small",
        example: "micropitting",
        edits: &[
            ("shape = [96, 96]", "shape = [32, 32]"),
            ("pitch = \"1 um\"", "pitch = \"3 um\""),
            ("shortest = \"12 um\"", "shortest = \"24 um\""),
            ("boundary = \"periodic\"", "boundary = \"periodic\"\ntolerance = 1e-10"),
            ("speed_lower = 0", "speed_lower = 0\nstride = 4\nload_tolerance = 1e-9"),
        ],
        tolerance: 1e-6,
        except: &[],
    },
    Variant {
        name: "pull-off-small",
        example: "pull-off",
        edits: &[
            ("shape = [96, 96]", "shape = [24, 24]"),
            ("pitch = \"0.5625 nm\"", "pitch = \"2 nm\""),
            ("increments = 50", "increments = 5"),
            ("increments = 60", "increments = 6"),
            ("boundary = \"free\"", "boundary = \"free\"\ntolerance = 1e-10"),
        ],
        tolerance: 1e-7,
        except: &[],
    },
    Variant {
        name: "contact-challenge-small",
        example: "contact-challenge",
        edits: &[
            ("shape = [512, 512]", "shape = [32, 32]"),
            ("\"195.3125 nm\"", "\"3.125 um\""),
            ("\"1.5625 um\"", "\"12.5 um\""),
            ("boundary = \"periodic\"", "boundary = \"periodic\"\ntolerance = 1e-10"),
        ],
        tolerance: 1e-7,
        except: &[],
    },
    as_it_stands("seal"),
    Variant {
        name: "study-small",
        example: "study",
        edits: &[
            ("shape = [64, 64]", "shape = [24, 20]"),
            ("\"16 um\"", "\"8 um\""),
            ("[contact]", "[contact]\ntolerance = 1e-12"),
        ],
        tolerance: 1e-8,
        except: &[],
    },
    Variant {
        name: "seal-small",
        example: "seal",
        edits: &[
            ("taper = \"16 um\"", "window = [0, 0, 24, 20]\ntaper = \"4 um\""),
            (
                "[\"2 MPa\", \"5 MPa\", \"10 MPa\", \"15 MPa\", \"20 MPa\", \"30 MPa\"]",
                "[\"2 MPa\", \"10 MPa\", \"30 MPa\"]",
            ),
            ("boundary = \"periodic\"", "tolerance = 1e-12\nboundary = [\"periodic\", \"free\"]"),
        ],
        tolerance: 1e-8,
        except: &[],
    },
    Variant {
        name: "hertz-small",
        example: "hertz",
        edits: &[
            ("shape = [128, 128]", "shape = [27, 23]"),
            ("0.5 um", "2 um"),
            ("layers = 60", "layers = 6"),
            ("tolerance = 1e-8", "method = \"direct\""),
        ],
        tolerance: 1e-10,
        except: &[],
    },
    Variant {
        name: "hertz-rolling",
        example: "hertz",
        edits: &[
            ("shape = [128, 128]", "shape = [23, 23]"),
            ("0.5 um", "2 um"),
            ("layers = 60", "layers = 4"),
            ("tolerance = 1e-8", "tolerance = 1e-12"),
            ("[subsurface]", "[friction]\ncoefficient = 0.3\ncreepage = [4e-4, 1e-4]\n[subsurface]"),
        ],
        tolerance: 1e-8,
        except: &[],
    },
    Variant {
        name: "friction-small",
        example: "friction",
        edits: FRICTION_SMALL,
        tolerance: 1e-8,
        except: &[],
    },
    Variant {
        name: "friction-dissimilar",
        example: "friction",
        edits: &[
            FRICTION_SMALL[0],
            FRICTION_SMALL[1],
            FRICTION_SMALL[2],
            FRICTION_SMALL[3],
            FRICTION_SMALL[4],
            ("boundary = \"free\"", "boundary = \"free\"\ntolerance = 1e-10"),
            ("[upper]\nyoung = \"210 GPa\"", "[upper]\nhardness = \"1.1 GPa\"\nyoung = \"70 GPa\""),
        ],
        tolerance: 1e-7,
        except: &[],
    },
    Variant {
        name: "measured-small",
        example: "measured",
        edits: &[
            ("window = [0, 0, 96, 128]", "window = [20, 30, 32, 32]"),
            ("shape = [64, 128]", "shape = [20, 32]"),
            ("\"32 um\"", "\"16 um\""),
            ("0.4 N", "40 mN"),
            ("passes = 3", "passes = 2\nstride = 5\nload_tolerance = 1e-11"),
            ("[motion]", "tolerance = 1e-12\n[motion]"),
            ("pressure_every = 20", "pressure_every = 3"),
        ],
        tolerance: 1e-8,
        except: &[],
    },
    Variant {
        name: "paper-small",
        example: "paper",
        edits: &[
            ("shape = [100, 100]", "shape = [24, 20]"),
            ("12 um", "8 um"),
            ("0.2 N", "9 mN"),
            ("stride = 1 ", "stride = 3 "),
            ("load_tolerance = 1e-4", "load_tolerance = 1e-11"),
            ("boundary = \"free\"", "boundary = \"free\"\ntolerance = 1e-12"),
            ("pressure_every = 20", "pressure_every = 4"),
        ],
        tolerance: 1e-8,
        except: &[],
    },
    Variant {
        name: "running-in-small",
        example: "running-in",
        edits: &[
            ("shape = [128, 128]", "shape = [32, 32]"),
            ("[\"60 um\", \"5 um\"]", "[\"12 um\", \"5 um\"]"),
            ("\"12 um\"  ", "\"4 um\"  "),
            ("taper = \"12 um\"\n", "taper = \"4 um\"\n"),
            ("1.6 N", "0.1 N"),
            ("boundary = \"periodic\"", "boundary = \"periodic\"\ntolerance = 1e-12"),
            ("stride = 16 ", "load_tolerance = 1e-11\nstride = 8 "),
            ("passes = 100_000", "passes = 15"),
        ],
        tolerance: 1e-7,
        // A difference of what hardly differs.
        except: &["error_estimate"],
    },
    Variant {
        name: "rolling-small",
        example: "rolling",
        edits: &[
            ("shape = [128, 64]", "shape = [32, 16]"),
            ("pitch = \"3 um\"", "pitch = \"6 um\""),
            ("sq = \"20 nm\"", "sq = \"10 nm\""),
            ("taper = \"15 um\"", "taper = \"30 um\""),
            ("cutoff = \"30 um\"", "cutoff = \"60 um\""),
            ("boundary = \"periodic\"", "boundary = \"periodic\"\ntolerance = 1e-10"),
            ("layers = 16", "layers = 6\ntolerance = 1e-8"),
            ("passes = 10", "passes = 2\nstride = 2\n[subsurface]\nto = \"80 um\"\nlayers = 8\nstep = 9"),
        ],
        tolerance: 1e-5,
        except: &[],
    },
    Variant {
        name: "quickstart-small",
        example: "quickstart",
        edits: QUICKSTART_SMALL,
        tolerance: 1e-8,
        except: &[],
    },
    Variant {
        name: "quickstart-periodic",
        example: "quickstart",
        edits: &[
            QUICKSTART_SMALL[0],
            QUICKSTART_SMALL[1],
            QUICKSTART_SMALL[2],
            QUICKSTART_SMALL[3],
            ("boundary = \"free\"", "boundary = \"periodic\"\ntolerance = 1e-12"),
            ("[motion]", "[friction]\ncoefficient = 0.2\n[motion]\nstrategy = \"shift\""),
            ("\"pass-load\"", "\"step-load\""),
            ("plastic_update = \"pass\"", "plastic_update = \"step\""),
        ],
        tolerance: 1e-7,
        except: &[],
    },
];

const FRICTION_SMALL: &[(&str, &str)] = &[
    ("shape = [128, 128]", "shape = [23, 23]"),
    ("0.4 um", "2.1 um"),
    ("increments = 12", "increments = 2"),
    ("increments = 24", "increments = 4"),
    ("layers = 30", "layers = 4"),
    ("boundary = \"free\"", "boundary = \"free\"\ntolerance = 1e-12"),
];

const QUICKSTART_SMALL: &[(&str, &str)] = &[
    ("shape = [64, 64]", "shape = [24, 24]"),
    ("180 mN", "25 mN"),
    ("passes = 5", "passes = 2"),
    ("stride = 1 ", "stride = 3 "),
    ("boundary = \"free\"", "boundary = \"free\"\ntolerance = 1e-12"),
    ("control = \"pass-load\"", "load_tolerance = 1e-11\ncontrol = \"pass-load\""),
];

/// To 10⁻⁴: loads are met to that, and pressures to a residual of 10⁻⁶. Which of the points that symmetry
/// makes equal is the most stressed is left to the last digit.
const fn as_it_stands(example: &'static str) -> Variant {
    Variant {
        name: example,
        example,
        edits: &[],
        tolerance: 1e-4,
        except: &["position", "section_xy", "section_yz"],
    }
}

/// What an answer costs may differ by so much of itself between machines: an iteration more or less.
const COST_TOLERANCE: f64 = 0.1;

#[test]
fn small_examples_compute_what_they_did() {
    hold(|variant| !variant.edits.is_empty());
}

#[test]
#[ignore = "needs an optimised build, which ASPERITY_BINARY names"]
fn examples_as_they_stand_compute_what_they_did() {
    hold(|variant| variant.edits.is_empty());
}

/// Compares the results of these variants with their digests.
fn hold(is_wanted: impl Fn(&Variant) -> bool) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let write = std::env::var("ASPERITY_DIGESTS").is_ok_and(|value| value == "write");
    let mut differences = Vec::new();
    for variant in VARIANTS.iter().filter(|variant| is_wanted(variant)) {
        // As the command writes it: examples share files.
        let folder = tempfile::tempdir().unwrap();
        ok(&asperity(&folder, &format!("example {}", variant.example)));
        let digest = digest(&computed(variant, &folder));
        let path = root.join("tests/it/digests").join(variant.name).with_extension("json");
        if write {
            fs::write(&path, written(&digest)).unwrap();
            continue;
        }
        let text = fs::read_to_string(&path).unwrap();
        let kept: Digest = serde_json::from_str(&text).unwrap();
        differences.extend(
            differing(&kept, &digest, variant.tolerance)
                .into_iter()
                .map(|what| format!("{}: {what}", variant.name)),
        );
    }
    assert!(differences.is_empty(), "{} differ\n{}", differences.len(), differences.join("\n"));
}

#[test]
fn every_example_has_its_digests() {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    for example in fs::read_dir(examples).unwrap() {
        let name = example.unwrap().file_name();
        let of_it = VARIANTS.iter().filter(|variant| name == variant.example);
        let [small, whole] = of_it.fold([0; 2], |mut count, variant| {
            count[usize::from(variant.edits.is_empty())] += 1;
            count
        });
        // The digest of 100 000 passes would be as long as their results. Elasto-plastic bodies and 512 × 512
        // cells take minutes. The whole examples of fatigue and of a joint repeat the small ones. In fretting the number of
        // cycles of an extrapolation depends on rounding.
        let without = [
            "running-in",
            "rolling",
            "contact-challenge",
            "fretting",
            "viscoelastic",
            "stribeck",
            "joint",
            "micropitting",
        ];
        let wanted = usize::from(!without.iter().any(|example| name == **example));
        assert!(
            whole == wanted && small > 0,
            "{name:?} has {small} small variants, and {whole} as it stands"
        );
    }
}

// ---- what is computed ------------------------------------------------------------------------------------

/// Series of numbers by name.
type SeriesByName = BTreeMap<String, Vec<f64>>;

/// Runs the variant of the example in `folder`, and returns all numbers of its results: as it stands by the
/// command, changed by the library, which draws no figures.
fn computed(variant: &Variant, folder: &TempDir) -> SeriesByName {
    let results = folder.path().join("results");
    let example = folder.path().join(variant.example);
    if variant.edits.is_empty() {
        ok(&asperity(folder, &format!("run {}/case.toml --out results --quiet", variant.example)));
    } else {
        let mut text = fs::read_to_string(example.join("case.toml")).unwrap();
        for (is, becomes) in variant.edits {
            assert!(text.contains(is), "{}: the example has no {is:?}", variant.name);
            text = text.replace(is, becomes);
        }
        let case = Case::parse(&text, &example.join("case.toml"), &example).unwrap();
        study::run(&case, study::SurfaceInput::default(), &results, Existing::Keep, &()).unwrap();
    }
    let mut series = numbers(&results);
    series.retain(|name, _| !variant.except.iter().any(|end| name.ends_with(end)));
    series
}

/// All numbers of the results in a folder, but for times and residuals, which are noise, warm starts, and the
/// numbers of warnings.
fn numbers(folder: &Path) -> SeriesByName {
    let mut series = SeriesByName::new();
    for name in files(folder) {
        let path = folder.join(&name);
        match path.extension().and_then(|extension| extension.to_str()) {
            // `results.csv` repeats the other tables.
            Some("csv") if !["limits.csv", "results.csv"].contains(&name.as_str()) => {
                add_table(&name, &fs::read_to_string(&path).unwrap(), &mut series)
            }
            Some("h5") if !name.contains("state") => add_fields(&name, &path, &mut series),
            Some("json") if name == "summary.json" => {
                let mut summary: Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
                summary.as_object_mut().unwrap().remove("case");
                add_value(&name, &summary, &mut series);
            }
            _ => {}
        }
    }
    series.retain(|name, _| !name.ends_with("wall_time_s") && !name.ends_with("residual"));
    series
}

fn add_table(name: &str, text: &str, series: &mut SeriesByName) {
    let mut rows = text.lines().map(|row| row.split(','));
    let columns: Vec<String> = rows.next().unwrap().map(|column| format!("{name} {column}")).collect();
    for row in rows {
        for (column, value) in columns.iter().zip(row) {
            // Unknown numbers are empty, words are quoted.
            if value.is_empty() || value.starts_with('"') {
                continue;
            }
            let value: f64 = value.parse().unwrap();
            assert!(value.is_finite(), "{column} is {value}");
            series.entry(column.clone()).or_default().push(value);
        }
    }
}

/// Fields that differ in the number at the end of their name are one series.
fn add_fields(name: &str, path: &Path, series: &mut SeriesByName) {
    let fields = Fields::open(path).unwrap();
    for field in fields.names().unwrap() {
        let stem = field.trim_end_matches(|c: char| c == '_' || c.is_ascii_digit());
        series.entry(format!("{name} {stem}")).or_default().extend(fields.read(&field).unwrap().values);
    }
}

/// The numbers of an array are one series; so is what stands under one key in a list of objects.
fn add_value(name: &str, value: &Value, series: &mut SeriesByName) {
    match value {
        Value::Number(number) => series.entry(name.to_owned()).or_default().push(number.as_f64().unwrap()),
        Value::Array(values) => values.iter().for_each(|value| add_value(name, value, series)),
        Value::Object(map) => {
            map.iter().for_each(|(key, value)| add_value(&format!("{name} {key}"), value, series))
        }
        _ => {}
    }
}

// ---- digests ---------------------------------------------------------------------------------------------

/// What is kept of each series.
type Digest = BTreeMap<String, Moments>;

/// What is kept of a series.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Moments {
    count: usize,
    rms: f64,
    mean: f64,
    /// Mean under weights of −1 to 1 that no pattern of the values follows.
    weighted: f64,
    /// Values at equal distances.
    samples: Vec<f64>,
}

impl Moments {
    const SAMPLES: usize = 4;

    /// Of values of which those that are not known count as 0: JSON has no NaN.
    fn of(values: &[f64]) -> Self {
        let values: Vec<f64> = values.iter().map(|value| if value.is_nan() { 0.0 } else { *value }).collect();
        let mean = |of: &dyn Fn(usize, f64) -> f64| {
            values.iter().enumerate().map(|(k, value)| of(k, *value)).sum::<f64>() / values.len() as f64
        };
        Self {
            count: values.len(),
            rms: mean(&|_, value| value * value).sqrt(),
            mean: mean(&|_, value| value),
            weighted: mean(&|k, value| value * (1.0 + 0.7 * (k * k % 9973) as f64).sin()),
            samples: (1..=Self::SAMPLES).map(|k| values[k * values.len() / (Self::SAMPLES + 1)]).collect(),
        }
    }

    fn numbers(&self) -> impl Iterator<Item = f64> {
        [self.rms, self.mean, self.weighted].into_iter().chain(self.samples.iter().copied())
    }
}

fn digest(series: &SeriesByName) -> Digest {
    series.iter().map(|(name, values)| (name.clone(), Moments::of(values))).collect()
}

/// A line for each series.
fn written(digest: &Digest) -> String {
    let line = |(name, moments): (&String, &Moments)| {
        format!("  {}: {}", serde_json::to_string(name).unwrap(), serde_json::to_string(moments).unwrap())
    };
    format!("{{\n{}\n}}\n", digest.iter().map(line).collect::<Vec<_>>().join(",\n"))
}

/// What `got` has otherwise than `kept`.
fn differing(kept: &Digest, got: &Digest, tolerance: f64) -> Vec<String> {
    let names: BTreeSet<&String> = kept.keys().chain(got.keys()).collect();
    let difference = |name: &String| match (kept.get(name), got.get(name)) {
        (Some(_), None) => Some("is not there".to_owned()),
        (None, _) => Some("is new".to_owned()),
        (Some(kept), Some(got)) if kept.count != got.count => {
            Some(format!("has {} values, expected {}", got.count, kept.count))
        }
        (Some(one), Some(other)) => {
            let is_cost = ["iterations", "convolutions"].iter().any(|cost| name.ends_with(cost));
            let tolerance = if is_cost { COST_TOLERANCE } else { tolerance };
            let scale = scale(name, kept);
            let errors = one.numbers().zip(other.numbers()).map(|(a, b)| (a - b).abs());
            let error = errors.fold(0.0, f64::max);
            (error > tolerance * scale).then(|| format!("is off by {:.1e} of its rms", error / scale))
        }
    };
    let told = |name: &String| difference(name).map(|what| format!("{name} {what}"));
    names.into_iter().filter_map(told).collect()
}

/// The rms of a series, or of the largest component of its vector or tensor.
fn scale(name: &str, digest: &Digest) -> f64 {
    let components = ["xx", "xy", "xz", "yy", "yz", "zz", "x", "y"];
    let stem = |name: &str| {
        components.iter().find_map(|end| name.strip_suffix(&format!("_{end}"))).unwrap_or(name).to_owned()
    };
    let of_it = digest.iter().filter(|(other, _)| stem(other) == stem(name));
    of_it.map(|(_, moments)| moments.rms).fold(0.0, f64::max)
}

#[test]
fn a_digest_tells_what_changed() {
    let series = |values: [[f64; 4]; 2]| {
        let names = ["steps.csv force_x", "steps.csv force_y"];
        digest(
            &names.iter().zip(values).map(|(name, values)| ((*name).to_owned(), values.to_vec())).collect(),
        )
    };
    let kept = series([[1.0, 2.0, 3.0, 4.0], [0.0, 0.0, 1e-18, 0.0]]);
    let differences = |values| differing(&kept, &series(values), 1e-10);
    assert_eq!(differences([[1.0, 2.0, 3.0, 4.0], [0.0, 1e-17, 0.0, 0.0]]), Vec::<String>::new());
    assert_eq!(
        differences([[1.0, 2.0, 3.0, 4.0], [0.0, 3e-9, 0.0, 0.0]]),
        ["steps.csv force_y is off by 1.1e-9 of its rms"]
    );
    assert_eq!(differences([[2.0, 1.0, 3.0, 4.0], [0.0; 4]]).len(), 1, "exchanged values are reported");
    assert_eq!(kept, serde_json::from_str(&written(&kept)).unwrap());
    assert_eq!(differing(&kept, &digest(&SeriesByName::new()), 1.0).len(), 2);
}
