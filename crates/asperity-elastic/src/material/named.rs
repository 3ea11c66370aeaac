//! Materials by name.

use super::Material;
use crate::error::{Error, Result};
use crate::units::Pascal;
use asperity_base::choice::{Choice, did_you_mean};
use asperity_base::table::{Key, Source};

/// Constants of a material at room temperature. Those that differ too much between grades are missing.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct NamedMaterial {
    /// The name in a case file.
    pub name: &'static str,
    /// The grade.
    pub about: &'static str,
    /// Young's modulus.
    pub young: Pascal,
    /// Poisson's ratio.
    pub poisson: f64,
    /// Largest pressure that it carries, where the grade determines it.
    pub hardness: Option<Pascal>,
    /// Thermal conductivity, W/(m K).
    pub conductivity: Option<f64>,
    /// Heat capacity, J/(kg K).
    pub heat_capacity: Option<f64>,
    /// Density, kg/m³.
    pub density: Option<f64>,
    /// Electrical resistivity, Ω m.
    pub resistivity: Option<f64>,
    /// Where the constants are from.
    pub source: &'static str,
}

impl NamedMaterial {
    /// Returns the material of this name.
    pub fn from_name(name: &str) -> Option<&'static Self> {
        MATERIALS.iter().find(|material| material.name == name)
    }

    /// Returns a hint with the material that another name probably means.
    pub fn near(name: &str) -> Option<String> {
        let meant = meant(name).map(|name| format!("did you mean `{name}`?"));
        meant.or_else(|| did_you_mean(name, NAMES.iter().copied()))
    }

    /// Returns its elastic constants.
    ///
    /// # Errors
    /// None for a material of [`MATERIALS`].
    pub fn elastic(&self) -> Result<Material> {
        Material::elastic(self.young, self.poisson)
    }

    /// Returns the constant `key` of a table that is given, or that of its material.
    ///
    /// # Errors
    /// The error of the `source` for a missing key.
    pub fn constant(source: &dyn Source, key: &Key, given: Option<f64>, named: Option<f64>) -> Result<f64> {
        given.or(named).ok_or_else(|| match source.missing(key) {
            Error::Case(mut error) => {
                error.hint = error.hint.map(|hint| hint + ", or `material = \"steel\"`");
                Error::Case(error)
            }
            error => error,
        })
    }

    const fn new(name: &'static str, about: &'static str, elastic: [f64; 2], source: &'static str) -> Self {
        Self {
            name,
            about,
            young: 1e9 * elastic[0],
            poisson: elastic[1],
            hardness: None,
            conductivity: None,
            heat_capacity: None,
            density: None,
            resistivity: None,
            source,
        }
    }

    /// Sets the hardness, GPa.
    const fn hard(self, hardness: f64) -> Self {
        Self { hardness: Some(1e9 * hardness), ..self }
    }

    /// Sets conductivity, heat capacity and density, SI.
    const fn thermal(self, [conductivity, heat_capacity, density]: [f64; 3]) -> Self {
        Self {
            conductivity: Some(conductivity),
            heat_capacity: Some(heat_capacity),
            density: Some(density),
            ..self
        }
    }

    /// Sets the resistivity, nΩ m.
    const fn electrical(self, resistivity: f64) -> Self {
        Self { resistivity: Some(1e-9 * resistivity), ..self }
    }
}

/// Elastic constants of metals from Kaye and Laby, the others from the CRC Handbook.
const METAL: &str = "elastic: Kaye & Laby, Tables of Physical and Chemical Constants, 2.2.2; others: CRC Handbook \
                     of Chemistry and Physics, properties of the elements";

/// The materials, by their names: steels and irons, metals, ceramics and glasses, polymers, coatings.
pub const MATERIALS: &[NamedMaterial] = &[
    NamedMaterial::new("steel", "carbon steel", [210.0, 0.3], "EN 1993-1-1, EN 1993-1-2 at 20 °C, EN 1991-1-1")
        .thermal([53.3, 440.0, 7850.0]),
    NamedMaterial::new(
        "bearing-steel",
        "100Cr6 (AISI 52100), through-hardened to 62 HRC",
        [207.9, 0.3],
        "elastic: ISO/TS 16281; hardness: 62 HRC is 746 HV by ASTM E140; others: ASM Handbook vol. 1",
    )
    .hard(7.3)
    .thermal([46.6, 475.0, 7810.0]),
    NamedMaterial::new(
        "stainless-steel",
        "AISI 304 (1.4301), annealed",
        [193.0, 0.29],
        "ASM Handbook vol. 1, wrought stainless steels",
    )
    .thermal([16.2, 500.0, 8000.0])
    .electrical(720.0),
    NamedMaterial::new("cast-iron", "grey iron EN-GJL-250", [110.0, 0.26], "EN 1561:2011, annex A")
        .thermal([48.5, 460.0, 7200.0]),
    NamedMaterial::new("iron", "soft", [211.4, 0.293], METAL).thermal([80.4, 449.0, 7874.0]).electrical(96.1),
    NamedMaterial::new("aluminium", "pure", [70.3, 0.345], METAL)
        .thermal([237.0, 897.0, 2700.0])
        .electrical(26.5),
    NamedMaterial::new("chromium", "pure", [279.1, 0.21], METAL).thermal([93.9, 449.0, 7150.0]),
    NamedMaterial::new("copper", "pure", [129.8, 0.343], METAL)
        .thermal([401.0, 385.0, 8960.0])
        .electrical(16.8),
    NamedMaterial::new(
        "brass",
        "70 % copper, 30 % zinc",
        [100.6, 0.35],
        "elastic: Kaye & Laby, Tables of Physical and Chemical Constants, 2.2.2; others: ASM Handbook vol. 2, C26000",
    )
    .thermal([120.0, 375.0, 8530.0])
    .electrical(62.0),
    NamedMaterial::new("gold", "pure", [78.0, 0.44], METAL).thermal([318.0, 129.0, 19300.0]).electrical(22.1),
    NamedMaterial::new("molybdenum", "pure", [324.8, 0.293], METAL)
        .thermal([138.0, 251.0, 10200.0])
        .electrical(53.4),
    NamedMaterial::new("nickel", "soft", [199.5, 0.312], METAL)
        .thermal([90.9, 444.0, 8900.0])
        .electrical(69.3),
    NamedMaterial::new("silver", "pure", [82.7, 0.367], METAL)
        .thermal([429.0, 235.0, 10500.0])
        .electrical(15.9),
    NamedMaterial::new(
        "titanium-alloy",
        "Ti-6Al-4V, annealed",
        [113.8, 0.342],
        "ASM Materials Properties Handbook: Titanium Alloys",
    )
    .thermal([6.7, 526.0, 4430.0])
    .electrical(1780.0),
    NamedMaterial::new("tungsten", "pure", [411.0, 0.28], METAL)
        .thermal([174.0, 132.0, 19300.0])
        .electrical(52.8),
    NamedMaterial::new(
        "alumina",
        "sintered, 99.5 % and more",
        [416.0, 0.231],
        "R. G. Munro, J. Am. Ceram. Soc. 80, 1919 (1997)",
    )
    .hard(15.0)
    .thermal([33.0, 755.0, 3984.0]),
    NamedMaterial::new(
        "silicon-carbide",
        "sintered α-SiC",
        [415.0, 0.16],
        "R. G. Munro, J. Phys. Chem. Ref. Data 26, 1195 (1997)",
    )
    .hard(32.0)
    .thermal([114.0, 715.0, 3160.0]),
    NamedMaterial::new(
        "silicon-nitride",
        "bearing grade",
        [310.0, 0.27],
        "within the limits of ASTM F2094, class I, whose least hardness is 1480 HV",
    )
    .hard(14.5)
    .thermal([25.0, 700.0, 3200.0]),
    NamedMaterial::new("glass", "soda-lime, float", [70.0, 0.2], "EN 572-1, whose hardness is Knoop's")
        .hard(6.0)
        .thermal([1.0, 720.0, 2500.0]),
    NamedMaterial::new("fused-silica", "Corning 7980", [72.7, 0.16], "Corning HPFS 7980, data sheet")
        .thermal([1.3, 770.0, 2201.0]),
    NamedMaterial::new(
        "silicon",
        "polycrystal; a single crystal has 130 to 188 GPa",
        [160.0, 0.22],
        "elastic: M. A. Hopcroft, W. D. Nix, T. W. Kenny, J. Microelectromech. Syst. 19, 229 (2010); others: CRC \
         Handbook of Chemistry and Physics",
    )
    .thermal([149.0, 712.0, 2330.0]),
    NamedMaterial::new(
        "diamond",
        "polycrystal",
        [1143.0, 0.069],
        "C. A. Klein, G. F. Cardinale, Diamond Relat. Mater. 2, 918 (1993)",
    ),
    NamedMaterial::new(
        "peek",
        "unfilled",
        [4.0, 0.4],
        "Victrex PEEK 450G, data sheet; a polymer creeps, so that its modulus falls with time",
    )
    .thermal([0.32, 2200.0, 1300.0]),
    NamedMaterial::new(
        "pmma",
        "cast",
        [3.3, 0.37],
        "Plexiglas GS, data sheet; a polymer creeps, so that its modulus falls with time",
    )
    .thermal([0.19, 1470.0, 1190.0]),
    NamedMaterial::new(
        "ptfe",
        "unfilled; products have 0.4 to 0.8 GPa",
        [0.5, 0.46],
        "elastic: DuPont, Teflon PTFE properties handbook; others: Springer Handbook of Condensed Matter and \
         Materials Data, tables 3.3-12 and 3.3-13; a polymer creeps, so that its modulus falls with time",
    )
    .thermal([0.25, 1000.0, 2180.0]),
    NamedMaterial::new(
        "pdms",
        "Sylgard 184, ten parts to one; 1.3 to 3 MPa by the temperature of its cure",
        [2e-3, 0.5],
        "modulus: Z. Wang, A. A. Volinsky, N. D. Gallant, J. Appl. Polym. Sci. 131, 41050 (2014); others: Dow \
         Sylgard 184, data sheet",
    ),
    NamedMaterial::new(
        "titanium-nitride",
        "TiN, coating from a cathodic arc; others have 250 to 590 GPa",
        [397.0, 0.25],
        "modulus: table 3 of Mater. Today Bio 15, 100270 (2022); Poisson's ratio: of the crystals by J. O. Kim, \
         J. D. Achenbach, P. B. Mirkarimi, M. Shinn, S. A. Barnett, J. Appl. Phys. 72, 1805 (1992)",
    ),
    NamedMaterial::new(
        "chromium-nitride",
        "CrN, coating from a cathodic arc; others have 200 to 450 GPa",
        [422.0, 0.25],
        "modulus: table 3 of Mater. Today Bio 15, 100270 (2022); Poisson's ratio: that of titanium nitride",
    ),
    NamedMaterial::new(
        "dlc",
        "a-C:H, diamond-like carbon with 20 % hydrogen; others have 100 to 300 GPa",
        [259.0, 0.17],
        "modulus: Nat. Commun. 12 (2021), s41467-021-24766-6, table 1; Poisson's ratio: of ta-C by S. Cho, \
         I. Chasiotis, T. A. Friedmann, J. P. Sullivan, J. Micromech. Microeng. 15, 728 (2005)",
    ),
    NamedMaterial::new(
        "ta-c",
        "diamond-like carbon without hydrogen, 73 % of it as in diamond; others have 490 to 760 GPa",
        [572.0, 0.17],
        "modulus: Nat. Commun. 12 (2021), s41467-021-24766-6, table 1; Poisson's ratio: S. Cho, I. Chasiotis, \
         T. A. Friedmann, J. P. Sullivan, J. Micromech. Microeng. 15, 728 (2005)",
    ),
    NamedMaterial::new(
        "molybdenum-disulfide",
        "MoS2, dense polycrystal; porous coatings are several times softer",
        [116.0, 0.11],
        "Hill's mean of the constants of a crystal by J. L. Feldman, J. Phys. Chem. Solids 37, 1141 (1976)",
    ),
];

/// The names of [`MATERIALS`].
pub const NAMES: &[&str] = &{
    let mut names = [""; MATERIALS.len()];
    let mut index = 0;
    while index < names.len() {
        names[index] = MATERIALS[index].name;
        index += 1;
    }
    names
};

impl Choice for &'static NamedMaterial {
    const NAMES: &'static [&'static str] = NAMES;

    const WORDS: &'static [(&'static str, Self)] = &{
        let mut words = [("", &MATERIALS[0]); MATERIALS.len()];
        let mut index = 0;
        while index < words.len() {
            words[index] = (NAMES[index], &MATERIALS[index]);
            index += 1;
        }
        words
    };

    fn word(self) -> &'static str {
        self.name
    }

    fn hint(word: &str) -> Option<String> {
        let other = || "give `young` and `poisson` of a material that is not in the list".to_owned();
        NamedMaterial::near(word).or_else(|| Some(other()))
    }
}

/// Other names of materials, in small letters.
const OTHER_NAMES: &[(&str, &str)] = &[
    ("stainless", "stainless-steel"),
    ("inox", "stainless-steel"),
    ("fe", "iron"),
    ("aluminum", "aluminium"),
    ("al", "aluminium"),
    ("cr", "chromium"),
    ("cu", "copper"),
    ("au", "gold"),
    ("mo", "molybdenum"),
    ("ni", "nickel"),
    ("ag", "silver"),
    ("ti", "titanium-alloy"),
    ("titanium", "titanium-alloy"),
    ("w", "tungsten"),
    ("al2o3", "alumina"),
    ("sic", "silicon-carbide"),
    ("si3n4", "silicon-nitride"),
    ("sio2", "fused-silica"),
    ("silica", "fused-silica"),
    ("si", "silicon"),
    ("acrylic", "pmma"),
    ("plexiglas", "pmma"),
    ("teflon", "ptfe"),
    ("sylgard", "pdms"),
    ("silicone", "pdms"),
    ("tin", "titanium-nitride"),
    ("crn", "chromium-nitride"),
    ("ach", "dlc"),
    ("diamondlikecarbon", "dlc"),
    ("mos2", "molybdenum-disulfide"),
];

/// Returns the name of the material that another name means: in other letters, a symbol, or a grade such as
/// 100Cr6.
fn meant(word: &str) -> Option<&'static str> {
    let plain = |text: &str| text.chars().filter(|c| c.is_alphanumeric()).collect::<String>().to_lowercase();
    let wanted = plain(word);
    let is_grade = |about: &str| {
        let mut grades = about
            .split([' ', ',', '(', ')'])
            .map(plain)
            .filter(|part| part.contains(|c: char| c.is_ascii_digit()));
        plain(about) == wanted || grades.any(|grade| grade == wanted)
    };
    let other = OTHER_NAMES.iter().find(|(other, _)| *other == wanted).map(|(_, name)| *name);
    let is_meant = |material: &&NamedMaterial| plain(material.name) == wanted || is_grade(material.about);
    other.or_else(|| MATERIALS.iter().find(is_meant).map(|material| material.name))
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_base::exists;
    use asperity_base::table::Exists;

    #[test]
    fn every_material_has_constants_that_exist_and_a_source() {
        let within = |what: Exists, value: Option<f64>| match (what, value) {
            (Exists::Within { least, most, .. }, Some(value)) => (least..=most).contains(&value),
            _ => true,
        };
        for (index, material) in MATERIALS.iter().enumerate() {
            let name = material.name;
            assert!(material.elastic().is_ok() && material.source.len() > 10, "{name}");
            assert!(MATERIALS[..index].iter().all(|other| other.name != name), "{name} is there twice");
            assert_eq!(NamedMaterial::from_name(name), Some(material));
            assert!(within(exists::YOUNG, Some(material.young)), "{name}");
            assert!(within(exists::HARDNESS, material.hardness), "{name}");
            assert!(within(exists::CONDUCTIVITY, material.conductivity), "{name}");
            assert!(within(exists::HEAT_CAPACITY, material.heat_capacity), "{name}");
            assert!(within(exists::DENSITY, material.density), "{name}");
            assert!(within(exists::RESISTIVITY, material.resistivity), "{name}");
            // Without plastic deformation a solid carries no more than about a fifth of its modulus.
            assert!(material.hardness.is_none_or(|hardness| hardness < 0.2 * material.young), "{name}");
        }
    }

    #[test]
    fn a_name_that_is_not_in_the_list_has_a_hint() {
        let hint = |word| <&NamedMaterial>::hint(word).unwrap();
        for (word, name) in [
            ("Steel", "steel"),
            ("steal", "steel"),
            ("carbon steel", "steel"),
            ("100Cr6", "bearing-steel"),
            ("100cr6", "bearing-steel"),
            ("52100", "bearing-steel"),
            ("1.4301", "stainless-steel"),
            ("stainless", "stainless-steel"),
            ("Stainless Steel", "stainless-steel"),
            ("cast iron", "cast-iron"),
            ("aluminum", "aluminium"),
            ("Alumina", "alumina"),
            ("Al2O3", "alumina"),
            ("Si", "silicon"),
            ("SiC", "silicon-carbide"),
            ("Si3N4", "silicon-nitride"),
            ("Ti-6Al-4V", "titanium-alloy"),
            ("coper", "copper"),
            ("PMMA", "pmma"),
            ("Teflon", "ptfe"),
            ("Sylgard", "pdms"),
            ("TiN", "titanium-nitride"),
            ("DLC", "dlc"),
            ("a-C:H", "dlc"),
            ("ta-C", "ta-c"),
            ("MoS2", "molybdenum-disulfide"),
        ] {
            assert_eq!(hint(word), format!("did you mean `{name}`?"), "{word}");
        }
        for (other, name) in OTHER_NAMES {
            assert!(NAMES.contains(name) && !NAMES.contains(other), "{other}");
        }
        for word in ["rubber", "WC/C", "5", ""] {
            assert_eq!(hint(word), "give `young` and `poisson` of a material that is not in the list");
        }
    }

    #[test]
    fn metals_follow_the_law_of_wiedemann_and_franz() {
        // λ ρ / T = 2.44e-8 W Ω/K² for electrons alone; alloys and stiff lattices lie above.
        for material in MATERIALS {
            if let (Some(conductivity), Some(resistivity)) = (material.conductivity, material.resistivity) {
                let lorenz = conductivity * resistivity / 293.0;
                assert!((1.9e-8..4.6e-8).contains(&lorenz), "{}: {lorenz:.2e}", material.name);
            }
        }
    }
}
