//! Files for programs that compute with the law of a joint. Each says in its comments what it is, in which units, in which
//! range, and what the program does beyond it.

mod abaqus;
mod ansys;
mod calculix;
mod comsol;
mod moose;
mod opensees;

use super::law::{Edge, Law};
use super::quantities::Kind;
use asperity_base::choice::choice;
use asperity_base::error::{Error, Result};
use asperity_base::units::{Dimension, format};

/// Most letters of a title in a comment: some programs read no longer lines.
const MAX_TITLE: usize = 80;

/// A program, or another form of the law.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Client {
    /// The table alone.
    Csv,
    /// CalculiX: `*SURFACE BEHAVIOR` with a table, and for heat `*GAP CONDUCTANCE`.
    Calculix,
    /// Abaqus: `*SURFACE BEHAVIOR`, `*GAP CONDUCTANCE`.
    Abaqus,
    /// Ansys Mechanical APDL: tables of the real constants of CONTA174.
    Ansys,
    /// COMSOL Multiphysics: interpolation functions.
    Comsol,
    /// MOOSE: `PiecewiseLinear` functions.
    Moose,
    /// OpenSees: a spring with the table.
    Opensees,
    /// Constants of other laws.
    Coefficients,
}

choice!(Client:
    "csv" => Csv,
    "calculix" => Calculix,
    "abaqus" => Abaqus,
    "ansys" => Ansys,
    "comsol" => Comsol,
    "moose" => Moose,
    "opensees" => Opensees,
    "coefficients" => Coefficients,
);

/// A consistent system of units.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Units {
    /// mm, N, t, s, K: pressures in MPa, conductances in mW/(mm² K).
    #[default]
    Millimetre,
    /// m, N, kg, s, K.
    Metre,
}

choice!(Units: "mm" => Millimetre, "si" => Metre);

/// Units and friction of the files for a program.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ClientSettings {
    /// Units of the files.
    pub units: Units,
    /// Friction coefficient, if surfaces may slip.
    pub friction: Option<f64>,
}

impl ClientSettings {
    /// Returns a reason why files are without what is asked for.
    pub fn doubt(&self, law: &Law) -> Option<String> {
        let is_unknown = self.friction.is_some() && law.quantity(Kind::StiffnessX).is_none();
        is_unknown
            .then(|| "files have no friction: the tangential stiffness of these bodies is unknown".to_owned())
    }
}

/// A file for a program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ClientFile {
    /// Its name.
    pub name: String,
    /// Its content.
    pub text: String,
}

impl Client {
    /// Writes the law for this program.
    ///
    /// # Errors
    /// [`Error::Unsupported`] if the law does not rise, or if the program cannot take what it has.
    pub fn files(self, law: &Law, settings: &ClientSettings) -> Result<Vec<ClientFile>> {
        if !law.rises() {
            return Err(Error::Unsupported(
                "no program takes a law whose pressure does not rise with the closure; joint.html has its warnings",
            ));
        }
        let sheet = |edge: Edge| Sheet::new(law, edge, settings);
        let edges = [(Edge::Median, ""), (Edge::Low, "-low"), (Edge::High, "-high")];
        // A single sample has no band.
        let edges = if law.samples > 1 { &edges[..] } else { &edges[..1] };
        let each = |name: &str, ending: &str, text: &dyn Fn(&Sheet<'_>) -> Result<String>| {
            let file = |(edge, suffix): &(Edge, &str)| {
                Ok(ClientFile { name: format!("{name}{suffix}.{ending}"), text: text(&sheet(*edge))? })
            };
            edges.iter().map(file).collect::<Result<Vec<_>>>()
        };
        Ok(match self {
            Self::Csv => vec![ClientFile { name: "joint.csv".to_owned(), text: law.csv() }],
            Self::Calculix => {
                let mut files = each("joint-calculix", "inp", &|sheet| Ok(calculix::cold(sheet)))?;
                if law.quantity(Kind::ThermalConductance).is_some() {
                    files.extend(each("joint-calculix-heat", "inp", &calculix::heat)?);
                }
                files
            }
            Self::Abaqus => each("joint-abaqus", "inp", &|sheet| Ok(abaqus::interaction(sheet)))?,
            Self::Ansys => each("joint-ansys", "mac", &|sheet| Ok(ansys::tables(sheet)))?,
            Self::Comsol => {
                let mut files = each("joint-comsol-pressure", "txt", &|sheet| Ok(comsol::pressure(sheet)))?;
                if law.quantity(Kind::ThermalConductance).is_some() {
                    files.extend(each("joint-comsol-conductance", "txt", &|sheet| {
                        Ok(comsol::conductance(sheet))
                    })?);
                }
                files
            }
            Self::Moose => each("joint-moose", "i", &|sheet| Ok(moose::functions(sheet)))?,
            Self::Opensees => each("joint-opensees", "py", &|sheet| Ok(opensees::spring(sheet)))?,
            Self::Coefficients => {
                let text = serde_json::to_string_pretty(&law.coefficients()).expect("numbers can be written");
                vec![ClientFile { name: "joint-coefficients.json".to_owned(), text: text + "\n" }]
            }
        })
    }
}

/// The law at an edge, in the units of a program.
struct Sheet<'l> {
    law: &'l Law,
    edge: Edge,
    settings: ClientSettings,
    /// Pressure and closure, from 0 on.
    closure: Vec<[f64; 2]>,
    /// Pressure and conductance of an area, where it is known, from the pressure 0 on.
    conductance: Vec<[f64; 2]>,
}

impl<'l> Sheet<'l> {
    fn new(law: &'l Law, edge: Edge, settings: &ClientSettings) -> Self {
        let scales = settings.units.scales();
        let closure =
            law.closure(edge).iter().map(|[p, c]| [p * scales.pressure, c * scales.length]).collect();
        let known = law.values(Kind::ThermalConductance, edge).unwrap_or_default();
        let conductance = law.pressures.iter().zip(known).filter(|(_, value)| value.is_finite());
        let conductance: Vec<[f64; 2]> =
            conductance.map(|(p, h)| [p * scales.pressure, h * scales.conductance]).collect();
        // Without pressure the gas still conducts.
        let open = conductance.first().map(|[_, least]| [0.0, law.gas_share * least]);
        let conductance = open.into_iter().chain(conductance).collect();
        Self { law, edge, settings: *settings, closure, conductance }
    }

    /// Slope of pressure over closure between the last two points.
    fn last_slope(&self) -> f64 {
        let [.., before, last] = self.closure[..] else { unreachable!("a law has at least two points") };
        (last[0] - before[0]) / (last[1] - before[1])
    }

    /// The closure at a factor of the largest pressure, on the last slope.
    fn extended(&self, factor: f64) -> [f64; 2] {
        let last = self.closure[self.closure.len() - 1];
        let pressure = factor * last[0];
        [pressure, last[1] + (pressure - last[0]) / self.last_slope()]
    }

    /// Pressure and tangential stiffness of an area in the middle of the range, for programs that take one number.
    fn tangential_stiffness(&self) -> Option<[f64; 2]> {
        let middle = self.law.pressures.len() / 2;
        let stiffness = self.law.values(Kind::StiffnessX, self.edge)?[middle];
        let scales = self.settings.units.scales();
        let pressure = self.law.pressures[middle] * scales.pressure;
        stiffness.is_finite().then(|| [pressure, stiffness * scales.pressure / scales.length])
    }

    /// Comment lines about the file, each after `mark`: what it is, its datum, units and range; then what a program does.
    fn head(&self, mark: &str, program: &[&str]) -> String {
        let law = self.law;
        let edge = match self.edge {
            Edge::Low => "quantile 0.16 of",
            Edge::Median if law.samples > 1 => "median of",
            Edge::Median => "law of",
            Edge::High => "quantile 0.84 of",
        };
        let samples =
            if law.samples == 1 { "one sample".to_owned() } else { format!("{} samples", law.samples) };
        let [least, most] =
            [0, law.pressures.len() - 1].map(|n| format(law.pressures[n], Dimension::Pressure));
        let units = match self.settings.units {
            Units::Millimetre => {
                "mm, N, t, s, K (pressure MPa, stiffness of an area MPa/mm, conductance mW/(mm2 K))"
            }
            Units::Metre => "m, N, kg, s, K (pressure Pa, stiffness of an area Pa/m, conductance W/(m2 K))",
        };
        let datum = format(law.datum, Dimension::Length);
        let lines = [
            format!("Joint: {}", plain(&law.title)),
            format!("asperity {}: {edge} {samples}", env!("CARGO_PKG_VERSION")),
            format!("Units: {units}"),
            format!(
                "Closure = {} - mean gap of both surfaces; it holds nothing of the bulk of the bodies",
                plain(&datum)
            ),
            format!(
                "Computed from {least} to {most}; below, the pressure falls exponentially to a hundredth, then straight to 0"
            ),
        ];
        let yields = law.yields.then(|| "Cells yield: the law holds for the first loading alone".to_owned());
        let conducts = self.conductance.len() - usize::from(!self.conductance.is_empty());
        let shorter = (0 < conducts && conducts < law.pressures.len()).then(|| {
            format!("The conductance is known under {conducts} of {} pressures alone", law.pressures.len())
        });
        let friction = self.settings.doubt(law);
        let program = program.iter().map(|line| (*line).to_owned());
        lines
            .into_iter()
            .chain(yields)
            .chain(shorter)
            .chain(friction)
            .chain(program)
            .map(|line| format!("{mark} {line}\n"))
            .collect()
    }
}

/// Returns a text in one line of plain letters.
fn plain(text: &str) -> String {
    let letter = |letter: char| match letter {
        'µ' => 'u',
        ' '..='~' => letter,
        _ if letter.is_whitespace() => ' ',
        _ => '?',
    };
    text.chars().take(MAX_TITLE).map(letter).collect()
}

/// Factors from SI.
struct Scales {
    pressure: f64,
    length: f64,
    conductance: f64,
}

impl Units {
    fn scales(self) -> Scales {
        match self {
            Self::Millimetre => Scales { pressure: 1e-6, length: 1e3, conductance: 1e-3 },
            Self::Metre => Scales { pressure: 1.0, length: 1.0, conductance: 1.0 },
        }
    }
}

/// Writes a number in at most 20 characters, with a sign at its exponent.
fn number(value: f64) -> String {
    let text = format!("{value:.9e}");
    let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let (sign, exponent) = match exponent.strip_prefix('-') {
        Some(exponent) => ('-', exponent),
        None => ('+', exponent),
    };
    format!("{digits}e{sign}{exponent:0>2}")
}

#[cfg(test)]
mod tests {
    use super::{number, plain};

    #[test]
    fn titles_are_one_line_of_plain_letters() {
        assert_eq!(plain("Fläche\n5 µm"), "Fl?che 5 um");
        assert_eq!(plain(&"a".repeat(300)).len(), 80);
    }

    #[test]
    fn numbers_have_the_digits_that_programs_read() {
        assert_eq!(number(2.232279590123e-5), "2.232279590e-05");
        assert_eq!(number(-1.5e123), "-1.500000000e+123");
        assert_eq!(number(0.0), "0.000000000e+00");
        assert!(number(-1.234567890123e-300).len() <= 20);
    }
}
