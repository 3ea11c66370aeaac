//! The keys of a case file, by table and by kind of topography.

use super::cursor::Table;
use super::document::join;
use crate::error::Result;

/// The tables and keys of the root of a case file.
pub(in crate::study) const ROOT: [&str; 13] = [
    "title",
    "lower",
    "upper",
    "contact",
    "friction",
    "history",
    "motion",
    "sliding",
    "acceleration",
    "temperature",
    "plasticity",
    "subsurface",
    "output",
];

/// The keys of a study file that a case file has not.
const OF_A_STUDY: [&str; 4] = ["base", "axes", "table", "exclude"];

/// The keys of each table, to tell where a misplaced one belongs.
const TABLES: [(&str, &[&str]); 19] = [
    (
        "lower",
        &[
            "young",
            "poisson",
            "hardness",
            "coating",
            "topography",
            "wear",
            "film",
            "plasticity",
            "conductivity",
            "heat_capacity",
            "density",
        ],
    ),
    (
        "upper",
        &[
            "young",
            "poisson",
            "hardness",
            "coating",
            "topography",
            "mount",
            "wear",
            "film",
            "plasticity",
            "conductivity",
            "heat_capacity",
            "density",
        ],
    ),
    ("lower.coating", &["thickness", "young", "poisson"]),
    ("upper.coating", &["thickness", "young", "poisson"]),
    (
        "contact",
        &[
            "load",
            "mean_pressure",
            "approach",
            "loads",
            "mean_pressures",
            "approaches",
            "boundary",
            "method",
            "tolerance",
        ],
    ),
    (
        "motion",
        &[
            "strategy",
            "speed_lower",
            "speed_upper",
            "passes",
            "stride",
            "control",
            "plastic_update",
            "load_tolerance",
            "speed",
            "path",
            "offset_y",
            "seed",
            "counter",
        ],
    ),
    (
        "friction",
        &[
            "coefficient",
            "coupling",
            "shear_strength",
            "junction_growth",
            "force",
            "displacement",
            "sliding",
            "creepage",
            "creepages",
            "spin",
            "rolling_force",
            "increments",
        ],
    ),
    ("subsurface", &["body", "to", "layers", "planes", "section", "columns", "step"]),
    ("output", &["pressure_every", "rim", "paraview"]),
    ("acceleration", &["tolerance", "max_jump", "max_wear"]),
    ("sliding", &["distance", "speed", "updates"]),
    ("temperature", &["bulk", "every"]),
    ("lower.wear", WEAR),
    ("upper.wear", WEAR),
    ("lower.film", FILM),
    ("upper.film", FILM),
    ("lower.plasticity", FLOW),
    ("upper.plasticity", FLOW),
    ("plasticity", &["depth", "layers", "growth", "increments", "tolerance", "unload", "keep"]),
];

/// The keys of a body's wear.
const WEAR: &[&str] = &["coefficient", "dimensionless", "energy", "under_film"];

/// The keys of a body's plasticity.
const FLOW: &[&str] = &["yield_stress", "hardening", "curve", "kinematic", "recovery"];

/// The keys of a body's film.
const FILM: &[&str] = &[
    "law",
    "max_thickness",
    "rate",
    "at_temperature",
    "at_stress",
    "activation_energy",
    "activation_volume",
    "stress",
    "removal",
    "hardness",
    "x",
    "c3",
    "c4",
];

/// The keys that each kind of topography has beyond the common ones.
const SOURCES: [(&str, &[&str]); 12] = [
    ("file", &["file", "channel", "unit", "despike", "fill"]),
    ("given", &["given", "despike", "fill"]),
    ("generate = \"low-pass\"", &["generate", "shape", "seed", "sq", "cutoff", "band", "ssk", "sku"]),
    (
        "generate = \"autocorrelation\"",
        &["generate", "shape", "seed", "sq", "correlation_length", "decay", "lay", "ssk", "sku"],
    ),
    (
        "generate = \"self-affine\"",
        &["generate", "shape", "seed", "sq", "sdq", "hurst", "rolloff", "shortest"],
    ),
    ("form = \"sphere\"", &["form", "shape", "radius"]),
    ("form = \"ellipsoid\"", &["form", "shape", "radius"]),
    ("form = \"cylinder\"", &["form", "shape", "radius", "axis"]),
    ("form = \"cone\"", &["form", "shape", "angle"]),
    ("form = \"flat\"", &["form", "shape"]),
    ("form = \"sinusoid\"", &["form", "shape", "amplitude", "wavelength"]),
    ("form = \"grooves\"", &["form", "shape", "period", "depth", "profile", "lay"]),
];

/// The keys of every topography.
const PREPARATION: [&str; 12] = [
    "pitch",
    "window",
    "level",
    "mirror",
    "rotate",
    "s_filter",
    "l_filter",
    "filter",
    "resample",
    "interpolate",
    "taper",
    "plus",
];

/// No key but those of the table.
pub(super) fn known_in(table: &Table<'_>) -> Result<()> {
    let keys = TABLES.iter().find(|(name, _)| *name == table.path()).map_or(&[][..], |(_, keys)| keys);
    table.known(keys, |key| belongs(key, table.path()))
}

/// A key that is known in another table.
pub(in crate::study) fn belongs(key: &str, table: &str) -> Option<(String, Option<String>)> {
    let here = if table.is_empty() { "outside a table".to_owned() } else { format!("in [{table}]") };
    let topography = || {
        let known = PREPARATION.contains(&key) || SOURCES.iter().any(|(_, keys)| keys.contains(&key));
        let body =
            table.split('.').next().filter(|name| ["lower", "upper"].contains(name)).unwrap_or("lower");
        (known && !table.ends_with("topography")).then(|| join(body, "topography"))
    };
    let owners = TABLES.iter().filter(|(name, keys)| *name != table && keys.contains(&key));
    let owner = owners.map(|(name, _)| (*name).to_owned()).next().or_else(topography);
    let hint = match owner {
        Some(owner) => format!("`{key}` belongs in [{owner}]"),
        None if key == "title" => "`title` stands above all tables".to_owned(),
        None if key == "history" => "stages stand by themselves: [[history]]".to_owned(),
        None if ROOT.contains(&key) => format!("the table stands by itself: [{key}]"),
        None if table.is_empty() && OF_A_STUDY.contains(&key) => {
            "this is a study: `asperity study` computes it".to_owned()
        }
        None => return None,
    };
    Some((format!("unknown key '{key}' {here}"), Some(hint)))
}

/// An error if a key belongs to another kind of topography.
pub(super) fn suits(table: &Table<'_>, kind: &str) -> Result<()> {
    let own = SOURCES.iter().find(|(name, _)| *name == kind).map_or(&[][..], |(_, keys)| keys);
    let is_layer = table.path().ends_with("plus]");
    let of_the_whole = |key: &str| key == "shape" || PREPARATION.contains(&key);
    let known = own.iter().chain(&PREPARATION).copied();
    let known: Vec<&str> = known.filter(|key| !(is_layer && of_the_whole(key))).collect();
    table.known(&known, |key| {
        if is_layer && of_the_whole(key) {
            let hint = "what is added stands on the grid of the topography, as prepared".to_owned();
            return Some((format!("'{key}' has no meaning in {}", table.name()), Some(hint)));
        }
        let owners: Vec<_> = SOURCES
            .iter()
            .filter(|(name, keys)| keys.contains(&key) && *name != "given")
            .map(|(name, _)| format!("`{name}`"))
            .collect();
        let kind = match kind {
            "file" => "a file",
            "given" => "heights that are given",
            kind => kind,
        };
        Some((
            format!("'{key}' has no meaning with {kind}"),
            Some(format!("it belongs to {}", owners.join(", "))),
        ))
    })
}

/// No key but those of some topography; which go together, `suits` tells.
pub(super) fn known_of_topographies(table: &Table<'_>) -> Result<()> {
    let all: Vec<&str> = SOURCES.iter().flat_map(|(_, keys)| *keys).chain(&PREPARATION).copied().collect();
    table.known(&all, |key| belongs(key, table.path()))
}
