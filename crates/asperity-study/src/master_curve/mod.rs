//! Master curves of viscoelastic bodies, from text files as instruments export them.
//!
//! A line names the columns, which are found by their titles, in any order. Units stand in the titles or in a
//! line below them. A column of tan δ or of the phase angle takes the place of a modulus, and |E*| that of
//! E′. Shear moduli become those of tension.

mod cells;
mod columns;
mod head;
mod titles;

use crate::case::{Body, Case, Part};
use crate::io::{regular, sha256};
use crate::surface_input::SurfaceInput;
use asperity_base::error::Result;
use asperity_base::io::text;
use asperity_contact::viscoelastic::MasterPoint;
use cells::lines;
use columns::Columns;
use titles::{Deformation, Head};

/// A master curve with the digest of its file, hexadecimal.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct MasterCurve {
    /// Its points, at rising frequencies.
    pub points: Vec<MasterPoint>,
    /// E/G = 2 (1 + ν) by which its moduli were multiplied, if the file has shear moduli.
    pub from_shear: Option<f64>,
    /// The digest.
    pub sha256: String,
}

/// Largest accepted file.
const MAX_BYTES: u64 = 16 << 20;
const EXAMPLE: &str = "a line above the numbers names the columns with their units, for example `Frequency (Hz); E' (MPa); E'' (MPa)`";

/// Reads the master curves of the parts of the body `name` of a case; `None` of a part that has none.
///
/// # Errors
/// [`Error::Case`](asperity_base::Error::Case) at its key if the file cannot be read or is no master curve;
/// [`Error::SurfaceChanged`](asperity_base::Error::SurfaceChanged).
pub(super) fn of_body(
    case: &Case,
    name: &str,
    body: &Body,
    given: &SurfaceInput,
) -> Result<Vec<Option<MasterCurve>>> {
    body.parts().map(|part| of_part(case, name, part, given)).collect()
}

fn of_part(case: &Case, name: &str, part: Part<'_>, given: &SurfaceInput) -> Result<Option<MasterCurve>> {
    let Some(file) = part.viscoelastic.and_then(|part| part.file.as_ref()) else { return Ok(None) };
    let key = format!("{}.viscoelastic.file", case.table_of(name, part.layer));
    let content = regular::read(file, "a master curve", MAX_BYTES)
        .map_err(|source| case.error_at(&key, format!("{}: {source}", file.display()), None))?;
    let sha256 = sha256(&content);
    given.admit(&key, &sha256)?;
    let (mut points, deformation) = read(&content).map_err(|Refusal { message, hint }| {
        case.error_at(&key, format!("{}: {message}", file.display()), hint.map(str::to_owned))
    })?;
    let from_shear = (deformation == Deformation::Shear).then_some(2.0 * (1.0 + part.poisson));
    for point in &mut points {
        point.storage *= from_shear.unwrap_or(1.0);
        point.loss *= from_shear.unwrap_or(1.0);
    }
    Ok(Some(MasterCurve { points, from_shear, sha256 }))
}

/// Outcome of a part of the reading; the message of an error begins with the line.
type Read<T> = std::result::Result<T, String>;

/// Reason why a file is no master curve.
#[derive(Debug)]
struct Refusal {
    message: String,
    hint: Option<&'static str>,
}

/// Reads the points of a curve, and the deformation to which its moduli belong.
fn read(content: &[u8]) -> std::result::Result<(Vec<MasterPoint>, Deformation), Refusal> {
    let plain = |message: String| Refusal { message, hint: None };
    let of_titles = |message| Refusal { message, hint: Some(EXAMPLE) };
    let lines = lines(&text::decode(content).ok_or_else(|| plain("is no text".to_owned()))?);
    let (head, body) = Head::find(&lines).map_err(of_titles)?;
    let (columns, body) = head.columns(body).map_err(of_titles)?;
    let points = columns.points(&head, body).and_then(Columns::ordered).map_err(plain)?;
    match points.len() {
        0..3 => Err(plain(format!("has {} points, expected at least three", points.len()))),
        _ => Ok((points, columns.deformation)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The curve of most files below: 0.1, 1, 10 Hz; E′ 2, 3, 5 MPa; E″ 0.5, 1, 4 MPa.
    const CURVE: [[f64; 3]; 3] = [[0.1, 2e6, 0.5e6], [1.0, 3e6, 1e6], [10.0, 5e6, 4e6]];

    #[track_caller]
    fn assert_curve(content: &[u8], deformation: Deformation) {
        let text = String::from_utf8_lossy(content);
        let (points, found) = read(content).unwrap_or_else(|error| panic!("{error:?}: {text}"));
        assert_eq!((points.len(), found), (CURVE.len(), deformation), "{text}");
        for (point, expected) in points.iter().zip(CURVE) {
            for (found, expected) in [point.frequency, point.storage, point.loss].into_iter().zip(expected) {
                assert!((found / expected - 1.0).abs() < 1e-4, "{found} for {expected}: {text}");
            }
        }
    }

    fn utf16(text: &str) -> Vec<u8> {
        std::iter::once(0xfeff).chain(text.encode_utf16()).flat_map(u16::to_le_bytes).collect()
    }

    fn latin_1(text: &str) -> Vec<u8> {
        text.chars().map(|c| u8::try_from(u32::from(c)).unwrap()).collect()
    }

    // The layouts of exports of five makers, with numbers of our own.
    const STEPS: &str = "Filename\tC:\\data\\sample.tri\nOperator\tnobody\nSample name\tSBR, filled\n\n[step]\nFrequency sweep\n\
        Angular frequency\tStorage modulus\tLoss modulus\tTan(delta)\tTemperature\tStep time\n\
        rad/s\tMPa\tMPa\t\t°C\ts\n\
        6.283185e-01\t2.0e+00\t5.0e-01\t0.25\t20.01\t35.1\n6.283185e+00\t3.0e+00\t1.0e+00\t0.3333\t19.98\t55.2\n\
        6.283185e+01\t5.0e+00\t4.0e+00\t0.8\t20.00\t70.3\n";
    const SIGNALS: &str = "CLOSED\t0\r\nModule\tMulti-Frequency-Strain\r\nNsig\t5\r\nSig1\tTime (min)\r\nSig2\tTemperature (°C)\r\n\
        Sig3\tFrequency (Hz)\r\nSig4\tLoss Modulus (kPa)\r\nSig5\tStorage Modulus (kPa)\r\nDate\t01-Nov-26\r\nStartOfData\r\n\
        1.0\t25.0\t10.0\t4000\t5000\r\n2.0\t25.1\t1.0\t1000\t3000\r\n3.0\t25.0\t0.1\t500\t2000\r\n";
    const HASHES: &str = "#EXPORTTYPE:DATA ALL\n#DECIMAL:COMMA\n#SEPARATOR:SEMICOLON\n#SAMPLE:Profil für 23 °C\n\n\
        ##Temp./°C;Frequenz/Hz;E'/MPa;E''/MPa;tan d\n\
        23,0;0,100;2,00;0,500;0,25;\n23,1;1,000;3,00;1,000;0,333;\n23,0;10,000;5,00;4,000;0,8;\n";
    const INTERVALS: &str = "Project:\tProject 1\nTest:\tFrequency sweep\n\nInterval and data points:\t1\t3\nInterval data:\tPoint No.\t\
        Angular Frequency\tStorage Modulus\tLoss Modulus\tLoss Factor\tShear Stress\n\n\t\t[rad/s]\t[Pa]\t[Pa]\t[1]\t[Pa]\n\
        \t1\t62,83185\t5,00E+06\t4,00E+06\t0,8\t50\n\t2\t6,283185\t3,00E+06\t1,00E+06\t0,333\t30\n\
        \t3\t0,6283185\t2,00E+06\t5,00E+05\t0,25\t20\n";
    const ALIGNED: &str = "Curve Name:\n   Sample 1\nCurve Values:\n   Index        t        f       E'      E''    tanDelta\n\
        \x20               [s]     [Hz]    [MPa]    [MPa]     []\n\
        \x20      0      1.0      0.1      2.0      0.5   0.25\n       1      2.0      1.0      3.0      1.0   0.333\n\
        \x20      2      3.0     10.0      5.0      4.0   0.8\n\n";

    #[test]
    fn exports_of_instruments_are_read_by_their_titles() {
        use Deformation::{Shear, Tension};
        for (content, deformation) in [
            (STEPS.as_bytes().to_vec(), Tension),
            (utf16(SIGNALS), Tension),
            (latin_1(HASHES), Tension),
            (utf16(INTERVALS), Shear),
            (ALIGNED.as_bytes().to_vec(), Tension),
        ] {
            assert_curve(&content, deformation);
        }
    }

    #[test]
    fn columns_may_have_any_order_and_tan_delta_may_stand_for_a_modulus() {
        for (head, rows) in [
            ("E'' (MPa);E' (MPa);f (Hz)", ["0.5;2;0.1", "1;3;1", "4;5;10"]),
            ("f/Hz,tan δ [%],E'/MPa", ["0.1,25,2", "1,33.333333,3", "10,80,5"]),
            ("x_Hz;E''_MPa;E'_MPa", ["0.1;0.5;2", "1;1;3", "10;4;5"]),
            ("f/Hz,tan δ,E'/MPa", ["0.1,0.25,2", "1,0.33333333,3", "10,0.8,5"]),
            ("f/Hz,tan δ,E\"/MPa", ["0.1,0.25,0.5", "1,0.33333333,1", "10,0.8,4"]),
            (
                "|E*| (MPa)\tTan Delta\tFreq. (Hz)",
                ["2.061553\t0.25\t0.1", "3.162278\t0.3333333\t1", "6.403124\t0.8\t10"],
            ),
            (
                "f (Hz);|E*| (MPa);δ (°)",
                ["0,1;2,061553;14,036243", "1;3,162278;18,434949", "10;6,403124;38,659808"],
            ),
            // Complete, with more columns, out of order.
            (
                "f_Hz, ω_rad/s, E'_MPa, E''_MPa, tan d",
                ["1, 6, 3, 1, 0.3", "10, 63, 5, 4, 0.8", "0.1, 0.6, 2, 0.5, 0.2"],
            ),
            // Temperatures of the sweeps beside a reduced frequency, or beside one that rises throughout.
            (
                "Frequency (Hz);aT f (Hz);T;E' (MPa);E'' (MPa)",
                ["1;0.1;60;2;0.5", "1;1;20;3;1", "1;10;-20;5;4"],
            ),
            ("Temperature;Frequency (Hz);E' (MPa);E'' (MPa)", ["60;0.1;2;0.5", "20;1;3;1", "-20;10;5;4"]),
            // Without names, by position; the names are ours; names on a comment.
            ("x_Hz y_MPa z_MPa", ["0.1 2 0.5", "1 3 1", "10 5 4"]),
            ("frequency_Hz, storage_MPa, loss_MPa", ["0.1, 2, 0.5", "1, 3, 1", "10, 5, 4"]),
            (
                "# frequency, storage modulus, loss modulus\nf (Hz), E' (MPa), E'' (MPa)",
                ["0.1, 2, 0.5", "1, 3, 1", "10, 5, 4"],
            ),
            (
                "Frequency sweep; Storage modulus\nf (Hz); E' (MPa); E'' (MPa)",
                ["0.1; 2; 0.5", "1; 3; 1", "10; 5; 4"],
            ),
            ("# frequency_Hz, storage_MPa, loss_MPa", ["0.1, 2, 0.5", "1, 3, 1", "10, 5, 4"]),
            ("f (Hz);E' (MPa);E'' (MPa)", ["0.1, 2, 0.5", "1, 3, 1", "10, 5, 4"]),
        ] {
            assert_curve(format!("{head}\n{}\n", rows.join("\n")).as_bytes(), Deformation::Tension);
        }
        // A head that is repeated on each page.
        let pages = HASHES.replace("23,1;1", "##Temp./°C;Frequenz/Hz;E'/MPa;E''/MPa;tan d\n23,1;1");
        assert_curve(&latin_1(&pages), Deformation::Tension);
        let pages = STEPS.replace(
            "6.283185e+01",
            "Angular frequency\tStorage modulus\tLoss modulus\tTan(delta)\n\n6.283185e+01",
        );
        assert!(read(pages.as_bytes()).unwrap_err().message.contains("a second table begins there"));
    }

    #[test]
    fn what_is_no_master_curve_says_why() {
        const HEAD: &str = "frequency_Hz, storage_Pa, loss_Pa\n";
        for (text, told) in [
            (String::new(), "no line names"),
            ("log f (Hz), log E' (Pa), log E'' (Pa)\n1, 2, 3\n".to_owned(), "no line names"),
            ("f (Hz), J' (1/Pa), J'' (1/Pa)\n1, 2, 3\n".to_owned(), "no line names"),
            ("1, 2, 3\n".to_owned(), "no line names a frequency and a modulus"),
            (
                "frequency, storage_Pa, loss_Pa\n1, 2, 3\n".to_owned(),
                "line 1: the frequency `frequency` has no unit",
            ),
            (
                "frequency_Hz, storage, loss_Pa\n1, 2, 3\n".to_owned(),
                "the storage modulus `storage` has no unit",
            ),
            ("f_Hz, E'_Pa\n1, 2\n".to_owned(), "expected also a loss modulus, tan δ or a phase angle"),
            (
                "f_Hz, E'_Pa, E''_Pa, E'_Pa\n".to_owned(),
                "line 1 names the storage modulus in columns 2 and 4",
            ),
            ("f_Hz, E'_Pa, f_Hz, E''_Pa\n".to_owned(), "line 1 names the frequency in columns 1 and 3"),
            (format!("{HEAD}1, 2\n"), "line 2 has 2 columns, expected the 3 of line 1"),
            // Decimal commas between commas.
            (format!("{HEAD}0,1,2,1,0,5\n"), "line 2 has 6 columns, expected the 3 of line 1"),
            (format!("{HEAD}1, 2, 3\n2, 2, 3\n1, 2, 3\n"), "lines 2 and 4 have the same frequency"),
            (format!("{HEAD}1, 2, -3\n"), "line 2: the loss modulus is `-3`, expected a number above 0"),
            (format!("{HEAD}1, soft, 3\n"), "line 2: the storage modulus is `soft`"),
            (format!("{HEAD}1, , 3\n"), "line 2: the storage modulus is missing, expected a number above 0"),
            (format!("{HEAD}slow, 2, 3\n"), "line 2: the frequency is `slow`"),
            (format!("{HEAD}1, 2, 3\n2, 2, 3\n"), "has 2 points"),
            // Sweeps at two temperatures, which the file has or has not.
            (
                "T_C, f_Hz, E'_Pa, E''_Pa\n".to_owned() + "20, 1, 9, 1\n20, 2, 9, 1\n60, 1.1, 3, 1\n",
                "lines 2 and 4 are no",
            ),
            (
                "temp, f_Hz, E'_Pa, E''_Pa\n".to_owned() + "20, 1, 9, 1\n20, 2, 9, 1\n60, 1.1, 3, 1\n",
                "`temp` goes from 20 to 60, expected a curve at one temperature",
            ),
        ] {
            let Refusal { message, hint } = read(text.as_bytes()).unwrap_err();
            assert!(message.contains(told), "{message}: {text}");
            let of_titles = ["line 1", "no line"].iter().any(|start| message.starts_with(start));
            assert_eq!(hint.is_some(), of_titles, "{message}");
        }
        assert_eq!(read(b"\x00\x01").unwrap_err().message, "is no text");
    }
}
