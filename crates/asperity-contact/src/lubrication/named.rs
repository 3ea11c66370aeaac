//! Lubricants by name.

use super::oil::{Oil, ViscosityLaw};
use crate::error::{Error, Result};
use crate::units::{CELSIUS, Dimension, Kelvin, PascalSecond};
use asperity_base::choice::{Choice, did_you_mean};

/// Constants of a lubricant, from which [`NamedOil::oil_at_temperature`] makes an oil.
///
/// ```
/// use asperity_contact::lubrication::NamedOil;
///
/// let oil = NamedOil::from_name("ISO VG 46").expect("it is in the list");
/// let warm = oil.oil_at_temperature(273.15 + 70.0)?;
/// assert!((12e-3..14e-3).contains(&warm.viscosity), "{}", warm.viscosity);
/// # Ok::<(), asperity_contact::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct NamedOil {
    /// The name.
    pub name: &'static str,
    /// The grade, and how well its constants are known.
    pub about: &'static str,
    /// Dynamic viscosity at 40 °C and at 100 °C: the kinematic viscosity times the density at that temperature.
    pub viscosity: [PascalSecond; 2],
    /// Pressure–viscosity coefficient at 40 °C and ambient pressure, 1/Pa.
    pub pressure_viscosity: f64,
    /// Density at 15 °C, kg/m³.
    pub density: f64,
    /// How the viscosity rises with pressure.
    pub law: ViscosityLaw,
    /// Whether the density rises with pressure.
    pub compressible: bool,
    /// Lowest and highest temperature of [`NamedOil::oil_at_temperature`].
    pub temperatures: [Kelvin; 2],
    /// Where the constants are from.
    pub source: &'static str,
    /// How the viscosity falls with temperature.
    #[serde(skip)]
    curve: Curve,
}

/// How the viscosity falls with temperature.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Curve {
    /// Walther's equation through the viscosities at 40 °C and at 100 °C.
    Walther,
    /// Cheng's formula for glycerol.
    Glycerol,
    /// The formula of IAPWS for water.
    Water,
}

/// Temperatures of the viscosities in the list.
const NODES: [Kelvin; 2] = [CELSIUS + 40.0, CELSIUS + 100.0];

/// Temperature of the densities in the list.
const COLD: Kelvin = CELSIUS + 15.0;

/// Decrease of density with temperature, kg/(m³ K). It is the same for all lubricating oils in API MPMS 11.1 (ASTM
/// D1250).
const EXPANSION: f64 = 0.6278;

impl NamedOil {
    /// Returns the lubricant of this name.
    pub fn from_name(name: &str) -> Option<&'static Self> {
        OILS.iter().find(|oil| oil.name == name)
    }

    /// Returns a hint with the lubricant that another name probably means, such as `vg46` or `PAO-4`.
    pub fn near(name: &str) -> Option<String> {
        let plain =
            |text: &str| text.chars().filter(|c| c.is_alphanumeric()).collect::<String>().to_lowercase();
        let wanted = plain(name);
        let other = OTHER_NAMES.iter().find(|(other, _)| *other == wanted).map(|(_, name)| *name);
        let is_meant = |oil: &&Self| {
            let own = plain(oil.name);
            own == wanted || own.strip_prefix("iso") == Some(&wanted)
        };
        let meant = other.or_else(|| OILS.iter().find(is_meant).map(|oil| oil.name));
        let meant = meant.map(|name| format!("did you mean `{name}`?"));
        meant.or_else(|| did_you_mean(name, OILS.iter().map(|oil| oil.name)))
    }

    /// Returns the oil at a temperature.
    ///
    /// ν + 0.7 mm²/s = 10^10^(A − B lg T) (Walther, ASTM D341),  α = α₄₀ (ln η + 9.67)/(ln η₄₀ + 9.67) (Roelands)
    ///
    /// A and B follow from the kinematic viscosities ν at 40 °C and 100 °C. Between them the viscosity of a mineral oil
    /// is within 3 % of measured ones. Far below 40 °C it is an extrapolation. Roelands' exponent z does not depend on
    /// temperature, which leads to his α within 10 %. Without his law α is constant. Glycerol: N.-S. Cheng, Ind. Eng.
    /// Chem. Res. 47, 3285 (2008). Water: IAPWS SR6-08(2011), within 1 %.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if the temperature is not within [`NamedOil::temperatures`].
    pub fn oil_at_temperature(&self, temperature: Kelvin) -> Result<Oil> {
        let [least, most] = self.temperatures;
        if !(least..=most).contains(&temperature) {
            let [cold, hot] = [least - CELSIUS, most - CELSIUS];
            return Err(Error::OutOfRange {
                quantity: "bulk",
                value: temperature,
                dimension: Some(Dimension::Temperature),
                expected: format!("{least:.2} … {most:.2} K ({cold:.0} … {hot:.0} °C) for {}", self.name)
                    .into(),
            });
        }
        let viscosity = self.viscosity_at(temperature);
        let pressure_viscosity = match self.law {
            ViscosityLaw::Roelands => {
                let rise = |viscosity: PascalSecond| viscosity.ln() + 9.67;
                self.pressure_viscosity * rise(viscosity) / rise(self.viscosity[0])
            }
            ViscosityLaw::Constant | ViscosityLaw::Barus | ViscosityLaw::Doolittle => self.pressure_viscosity,
        };
        let oil = Oil {
            viscosity,
            pressure_viscosity,
            law: self.law,
            compressible: self.compressible,
            free_volume: None,
        };
        oil.check().map(|()| oil)
    }

    /// Returns the viscosity at ambient pressure.
    fn viscosity_at(&self, temperature: Kelvin) -> PascalSecond {
        let celsius = temperature - CELSIUS;
        match self.curve {
            Curve::Walther => {
                let density = |temperature: Kelvin| density(self.density, temperature);
                let double_log =
                    |node: usize| (1e6 * self.viscosity[node] / density(NODES[node]) + 0.7).log10().log10();
                let share = (temperature / NODES[0]).ln() / (NODES[1] / NODES[0]).ln();
                let exponent = double_log(0) + share * (double_log(1) - double_log(0));
                1e-6 * (10f64.powf(10f64.powf(exponent)) - 0.7) * density(temperature)
            }
            Curve::Glycerol => 12.1 * ((celsius - 1233.0) * celsius / (9900.0 + 70.0 * celsius)).exp(),
            Curve::Water => {
                let reduced = temperature / 300.0;
                let terms = [(280.68, -1.9), (511.45, -7.7), (61.131, -19.6), (0.45903, -40.0)];
                1e-6 * terms.iter().map(|(factor, power)| factor * reduced.powf(*power)).sum::<f64>()
            }
        }
    }

    /// Creates an oil from its kinematic viscosities at 40 °C and 100 °C in mm²/s, its coefficient in 1/GPa and its
    /// density.
    const fn new(
        [name, about, source]: [&'static str; 3],
        kinematic: [f64; 2],
        pressure_viscosity: f64,
        cold: f64,
    ) -> Self {
        Self {
            name,
            about,
            viscosity: [
                1e-6 * kinematic[0] * density(cold, NODES[0]),
                1e-6 * kinematic[1] * density(cold, NODES[1]),
            ],
            pressure_viscosity: pressure_viscosity / 1e9,
            density: cold,
            law: ViscosityLaw::Roelands,
            compressible: true,
            temperatures: [CELSIUS - 20.0, CELSIUS + 150.0],
            source,
            curve: Curve::Walther,
        }
    }

    /// Creates a mineral oil.
    const fn mineral(name: &'static str, kinematic: [f64; 2], pressure_viscosity: f64, density: f64) -> Self {
        Self::new([name, MINERAL_GRADE, MINERAL], kinematic, pressure_viscosity, density)
    }
}

/// Density of a lubricating oil of density `cold` at 15 °C.
const fn density(cold: f64, temperature: Kelvin) -> f64 {
    cold - EXPANSION * (temperature - COLD)
}

const MINERAL_GRADE: &str = "mineral oil of viscosity index 95; oils of the grade have ±10 % in viscosity, ±20 % in \
                             the pressure–viscosity coefficient";

const MINERAL: &str = "viscosity: ISO 3448, ASTM D2270; pressure–viscosity coefficient: G. W. Stachowiak, A. W. \
                       Batchelor, Engineering Tribology, table 2.3, interpolated; density: typical of data sheets";

const SYNTHETIC: &str = "viscosity and density: typical of data sheets; pressure–viscosity coefficient: W. R. Jones, R. \
                         L. Johnson, W. O. Winer, D. M. Sanborn, ASLE Trans. 18, 249 (1975)";

/// The lubricants, by their names: mineral oils, synthetic oils, glycerol and water.
pub const OILS: &[NamedOil] = &[
    NamedOil::mineral("ISO VG 32", [32.0, 5.29], 19.5, 875.0),
    NamedOil::mineral("ISO VG 46", [46.0, 6.645], 20.7, 879.0),
    NamedOil::mineral("ISO VG 68", [68.0, 8.53], 21.8, 886.0),
    NamedOil::mineral("ISO VG 100", [100.0, 11.07], 22.9, 891.0),
    NamedOil::mineral("ISO VG 150", [150.0, 14.55], 24.2, 897.0),
    NamedOil::mineral("ISO VG 220", [220.0, 18.75], 26.6, 899.0),
    NamedOil::mineral("ISO VG 320", [320.0, 23.96], 29.1, 903.0),
    NamedOil::new(["PAO 4", THIN_PAO, SYNTHETIC], [18.4, 4.1], 12.8, 820.0),
    NamedOil::new(["PAO 6", THIN_PAO, SYNTHETIC], [31.0, 5.9], 14.1, 827.0),
    NamedOil::new(
        ["PAO 40", "poly-α-olefin; pressure–viscosity coefficient within 25 %", SYNTHETIC],
        [396.0, 39.0],
        18.5,
        850.0,
    ),
    NamedOil::new(
        [
            "ester",
            "polyol ester for turbines, MIL-PRF-23699; pressure–viscosity coefficient within 15 %",
            SYNTHETIC,
        ],
        [27.6, 5.1],
        13.0,
        1003.5,
    ),
    NamedOil {
        law: ViscosityLaw::Barus,
        viscosity: [0.2824, 0.01483],
        temperatures: [CELSIUS, CELSIUS + 100.0],
        curve: Curve::Glycerol,
        ..NamedOil::new(
            [
                "glycerol",
                "without water, of which 1 % thins it by a fifth; viscosity within 5 %, pressure–viscosity \
                 coefficient within 20 %, as a mean to 3 GPa",
                "viscosity and density: N.-S. Cheng, Ind. Eng. Chem. Res. 47, 3285 (2008); pressure–viscosity \
                 coefficient: R. L. Cook, H. E. King, C. A. Herbst, D. R. Herschbach, J. Chem. Phys. 100, 5178 (1994)",
            ],
            [0.0; 2],
            5.3,
            1267.2,
        )
    },
    NamedOil {
        law: ViscosityLaw::Constant,
        compressible: false,
        viscosity: [0.6527e-3, 0.2816e-3],
        temperatures: [CELSIUS, CELSIUS + 100.0],
        curve: Curve::Water,
        ..NamedOil::new(
            [
                "water",
                "liquid, at ambient pressure; its viscosity hardly depends on pressure",
                "IAPWS SR6-08(2011), Liquid Water at 0.1 MPa",
            ],
            [0.0; 2],
            0.0,
            999.1,
        )
    },
];

const THIN_PAO: &str = "poly-α-olefin; products differ by 10 % in viscosity; pressure–viscosity coefficient within \
                        20 %, from Roelands' exponent 0.46 of a thicker one";

/// The names of [`OILS`].
pub const OIL_NAMES: &[&str] = &{
    let mut names = [""; OILS.len()];
    let mut index = 0;
    while index < names.len() {
        names[index] = OILS[index].name;
        index += 1;
    }
    names
};

impl Choice for &'static NamedOil {
    const NAMES: &'static [&'static str] = OIL_NAMES;

    const WORDS: &'static [(&'static str, Self)] = &{
        let mut words = [("", &OILS[0]); OILS.len()];
        let mut index = 0;
        while index < words.len() {
            words[index] = (OIL_NAMES[index], &OILS[index]);
            index += 1;
        }
        words
    };

    fn word(self) -> &'static str {
        self.name
    }

    fn hint(word: &str) -> Option<String> {
        let other =
            || "give `viscosity` and `pressure_viscosity` of an oil that is not in the list".to_owned();
        NamedOil::near(word).or_else(|| Some(other()))
    }
}

/// Other names of lubricants, in small letters.
const OTHER_NAMES: &[(&str, &str)] = &[
    ("glycerine", "glycerol"),
    ("glycerin", "glycerol"),
    ("polyolester", "ester"),
    ("poe", "ester"),
    ("h2o", "water"),
];

#[cfg(test)]
mod tests {
    use super::*;

    fn oil(name: &str) -> &'static NamedOil {
        NamedOil::from_name(name).unwrap()
    }

    fn viscosity(name: &str, celsius: f64) -> PascalSecond {
        oil(name).oil_at_temperature(CELSIUS + celsius).unwrap().viscosity
    }

    #[test]
    fn every_oil_flows_more_easily_the_warmer_it_is_and_has_a_source() {
        for (index, oil) in OILS.iter().enumerate() {
            let name = oil.name;
            assert!(OILS[..index].iter().all(|other| other.name != name), "{name} is there twice");
            assert!(oil.source.len() > 10 && (800.0..1300.0).contains(&oil.density), "{name}");
            let [least, most] = oil.temperatures;
            let steps = (0..=40).map(|step| least + f64::from(step) / 40.0 * (most - least));
            let oils: Vec<Oil> = steps.map(|t| oil.oil_at_temperature(t.min(most)).unwrap()).collect();
            for pair in oils.windows(2) {
                assert!(pair[1].viscosity < pair[0].viscosity, "{name}");
                assert!(pair[1].pressure_viscosity <= pair[0].pressure_viscosity, "{name}");
            }
            for (node, listed) in NODES.into_iter().zip(oil.viscosity) {
                let there = oil.oil_at_temperature(node).unwrap().viscosity;
                assert!((there / listed - 1.0).abs() < 5e-4, "{name}: {there:e} {listed:e}");
            }
            let refused = oil.oil_at_temperature(most + 1.0).unwrap_err().to_string();
            assert!(
                refused.starts_with("bulk is ") && refused.ends_with(&format!("for {name}")),
                "{refused}"
            );
            assert!(
                oil.oil_at_temperature(least - 1.0).is_err() && oil.oil_at_temperature(f64::NAN).is_err()
            );
        }
    }

    #[test]
    fn mineral_oils_have_the_viscosity_of_their_grade_and_a_viscosity_index_of_95() {
        // ASTM D2270, table 1: two viscosities at 100 °C, each with L and H.
        for (grade, below, above) in [
            (32.0, [5.2, 43.76, 30.43], [5.3, 45.53, 31.40]),
            (46.0, [6.6, 69.16, 44.24], [6.7, 71.29, 45.33]),
            (68.0, [8.5, 111.5, 65.32], [8.6, 113.9, 66.48]),
            (100.0, [11.0, 173.9, 95.19], [11.1, 176.6, 96.45]),
            (150.0, [14.5, 279.6, 142.4], [14.6, 283.0, 143.9]),
            (220.0, [18.7, 437.3, 207.6], [18.8, 441.5, 209.3]),
            (320.0, [23.8, 673.7, 297.9], [24.0, 683.9, 301.8]),
        ] {
            let oil = oil(&format!("ISO VG {grade}"));
            let kinematic = |node: usize| 1e6 * oil.viscosity[node] / density(oil.density, NODES[node]);
            assert!((kinematic(0) / grade - 1.0).abs() < 1e-12, "{}", oil.name);
            let share = (kinematic(1) - below[0]) / (above[0] - below[0]);
            let [low, high] = [1, 2].map(|column| below[column] + share * (above[column] - below[column]));
            let index = 100.0 * (low - grade) / (low - high);
            assert!((94.8..95.2).contains(&index), "{}: {index}", oil.name);
        }
    }

    #[test]
    fn viscosities_and_coefficients_are_near_published_ones() {
        for (name, celsius, published, within) in [
            ("water", 20.0, 1.0016e-3, 2e-4),
            ("water", 25.0, 0.8900e-3, 2e-4),
            ("glycerol", 20.0, 1.412, 0.02),
        ] {
            let error = viscosity(name, celsius) / published - 1.0;
            assert!(error.abs() < within, "{name}: {error}");
        }
        // Stachowiak and Batchelor, table 2.3: viscosities in mPa s and coefficients in 1/GPa at 30, 60 and 100 °C.
        for (name, eta, alpha) in [
            ("ISO VG 100", [153.0, 34.0, 9.1], [23.7, 20.5, 15.8]),
            ("ISO VG 150", [250.0, 50.5, 12.6], [25.0, 21.3, 17.6]),
        ] {
            for ((celsius, eta), alpha) in [30.0, 60.0, 100.0].into_iter().zip(eta).zip(alpha) {
                let oil = oil(name).oil_at_temperature(CELSIUS + celsius).unwrap();
                let errors = [1e3 * oil.viscosity / eta - 1.0, 1e9 * oil.pressure_viscosity / alpha - 1.0];
                assert!(errors[0].abs() < 0.07 && errors[1].abs() < 0.09, "{name}, {celsius} °C: {errors:?}");
            }
        }
    }

    #[test]
    fn a_name_that_is_not_in_the_list_has_a_hint() {
        for (word, name) in [
            ("ISO VG46", "ISO VG 46"),
            ("iso vg 46", "ISO VG 46"),
            ("VG 46", "ISO VG 46"),
            ("ISO-VG-320", "ISO VG 320"),
            ("pao4", "PAO 4"),
            ("Water", "water"),
            ("glycerine", "glycerol"),
            ("glycrol", "glycerol"),
        ] {
            assert!(NamedOil::from_name(word).is_none());
            assert_eq!(NamedOil::near(word).unwrap(), format!("did you mean `{name}`?"), "{word}");
        }
        assert!(OTHER_NAMES.iter().all(|(_, name)| NamedOil::from_name(name).is_some()));
        assert_eq!(NamedOil::near("ISO VG 47"), None);
    }
}
