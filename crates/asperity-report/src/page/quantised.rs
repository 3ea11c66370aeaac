//! Fields as small as a page wants them: levels in place of numbers, deflated, as text.

use std::io::Write;

use asperity_base::Field;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use rayon::prelude::*;
use serde::Serialize;

/// The most cells along a side; larger fields are reduced by blocks.
const MAX_SIDE: usize = 1024;
/// Levels that are many, bytes.
const MANY: usize = 1 << 19;

/// A field in levels, `[ix, iy]`, the last index fastest.
#[derive(Debug, Clone, Serialize)]
pub(super) struct QuantisedField {
    code: Code,
    pub(super) shape: [usize; 2],
    /// Size of a cell, m.
    pitch: [f64; 2],
    /// Where its corner is on the lower body, in its own cells.
    corner: [f64; 2],
    /// Values of the lowest and of the highest level, SI.
    pub(super) low: f64,
    pub(super) high: f64,
    /// Deflated (zlib), in base 64.
    data: String,
}

/// What the levels of a cell mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
enum Code {
    /// One byte: 0 for what is not above 0, 1 to 255 evenly from 0 to the highest value.
    Positive,
    /// One byte: 0 for what is not above 0, 1 to 255 in equal ratios from the lowest to the highest value.
    Logarithmic,
    /// Two bytes: 0 to 65534 evenly from the lowest to the highest value, 65535 undefined. Differences along
    /// y; first all high, then all low bytes.
    Even,
    /// One byte: the number of a class; 255 undefined.
    Class,
}

/// How the cells of a block become one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Reduction {
    /// Summits do not vanish.
    Largest,
    Mean,
}

/// A field in levels that are not deflated yet.
pub(super) struct Levels {
    /// All but the data.
    field: QuantisedField,
    levels: Vec<u8>,
}

impl Levels {
    /// Numbers of which those above 0 count, such as pressures.
    pub(super) fn positive(field: &Field, pitch: [f64; 2]) -> Self {
        let (field, pitch) = reduced(field, pitch, Reduction::Largest);
        let high = field.iter().copied().filter(|p| p.is_finite()).fold(0.0, f64::max);
        let level = |p: &f64| if *p > 0.0 { 1 + (p / high * 254.0).round().min(254.0) as u8 } else { 0 };
        let levels: Vec<u8> = field.iter().map(level).collect();
        Self::new(Code::Positive, &field, pitch, [0.0, high], levels)
    }

    /// Numbers above 0 over decades, such as flows: those below `least` of the largest count as that.
    pub(super) fn logarithmic(field: &Field, pitch: [f64; 2], least: f64) -> Self {
        let (field, pitch) = reduced(field, pitch, Reduction::Largest);
        let above = || field.iter().copied().filter(|value| *value > 0.0 && value.is_finite());
        let high = above().fold(0.0, f64::max);
        let low = above().fold(high, f64::min).max(least * high);
        let steps = 254.0 / (high / low).ln().max(f64::MIN_POSITIVE);
        let level = |value: &f64| {
            if *value > 0.0 { 1 + ((value / low).ln() * steps).round().clamp(0.0, 254.0) as u8 } else { 0 }
        };
        let levels: Vec<u8> = field.iter().map(level).collect();
        Self::new(Code::Logarithmic, &field, pitch, [low, high], levels)
    }

    /// Numbers of any sign, such as heights.
    pub(super) fn even(field: &Field, pitch: [f64; 2]) -> Self {
        let (field, pitch) = reduced(field, pitch, Reduction::Mean);
        let finite = || field.iter().copied().filter(|z| z.is_finite());
        let [low, high] =
            [finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max)];
        let [low, high] = if low <= high { [low, high] } else { [0.0, 0.0] };
        let scale = if high > low { 65534.0 / (high - low) } else { 0.0 };
        let level = |z: f64| if z.is_finite() { ((z - low) * scale).round() as u16 } else { u16::MAX };
        let mut bytes = [Vec::with_capacity(field.len()), Vec::with_capacity(field.len())];
        for row in field.outer_iter() {
            let mut before = 0;
            for z in row {
                let now = level(*z);
                let [high, low] = now.wrapping_sub(before).to_be_bytes();
                bytes[0].push(high);
                bytes[1].push(low);
                before = now;
            }
        }
        Self::new(Code::Even, &field, pitch, [low, high], bytes.concat())
    }

    /// Numbers of classes, from 0.
    pub(super) fn classes(field: &Field, pitch: [f64; 2]) -> Self {
        let (field, pitch) = reduced(field, pitch, Reduction::Largest);
        let levels: Vec<u8> =
            field.iter().map(|class| if class.is_finite() { *class as u8 } else { u8::MAX }).collect();
        let high = field.iter().copied().filter(|class| class.is_finite()).fold(0.0, f64::max);
        Self::new(Code::Class, &field, pitch, [0.0, high], levels)
    }

    fn new(code: Code, field: &Field, pitch: [f64; 2], [low, high]: [f64; 2], levels: Vec<u8>) -> Self {
        let (shape, corner) = (field.dim().into(), [0.0; 2]);
        Self { field: QuantisedField { code, shape, pitch, corner, low, high, data: String::new() }, levels }
    }

    /// The same field with its corner there on the lower body, in cells as they were before a reduction.
    pub(super) fn with_corner(self, corner: [f64; 2], cell: [f64; 2]) -> Self {
        Self { field: self.field.with_corner(corner, cell), ..self }
    }

    /// The field as it goes onto the page.
    pub(super) fn deflated(self) -> QuantisedField {
        // Of many levels the best compression takes several times as long for less than a hundredth.
        let level = if self.levels.len() > MANY { Compression::default() } else { Compression::best() };
        let mut deflated = ZlibEncoder::new(Vec::new(), level);
        deflated.write_all(&self.levels).expect("memory takes all");
        let data = STANDARD.encode(deflated.finish().expect("memory takes all"));
        QuantisedField { data, ..self.field }
    }
}

impl QuantisedField {
    /// Numbers of which those above 0 count, such as pressures.
    pub(super) fn positive(field: &Field, pitch: [f64; 2]) -> Self {
        Levels::positive(field, pitch).deflated()
    }

    /// Numbers above 0 over decades, such as flows: those below `least` of the largest count as that.
    pub(super) fn logarithmic(field: &Field, pitch: [f64; 2], least: f64) -> Self {
        Levels::logarithmic(field, pitch, least).deflated()
    }

    /// Numbers of any sign, such as heights.
    pub(super) fn even(field: &Field, pitch: [f64; 2]) -> Self {
        Levels::even(field, pitch).deflated()
    }

    /// The same field with its corner there on the lower body, in cells as they were before a reduction.
    pub(super) fn with_corner(self, [x, y]: [f64; 2], cell: [f64; 2]) -> Self {
        let corner = [x * cell[0] / self.pitch[0], y * cell[1] / self.pitch[1]];
        Self { corner, ..self }
    }

    /// How far it reaches along both axes, m.
    pub(super) fn extent(&self) -> [f64; 2] {
        [0, 1].map(|axis| self.shape[axis] as f64 * self.pitch[axis])
    }

    /// Bytes that it takes.
    pub(super) fn size(&self) -> usize {
        self.data.len()
    }
}

/// Cells along either side of the blocks that a field is shown in; 1 unless it is large.
pub(super) fn block(field: &Field) -> usize {
    field.nrows().max(field.ncols()).div_ceil(MAX_SIDE).max(1)
}

/// At most [`MAX_SIDE`] cells along a side, each a block of so many along both axes; the last block may be of
/// fewer.
fn reduced(field: &Field, pitch: [f64; 2], reduction: Reduction) -> (Field, [f64; 2]) {
    let block = block(field);
    if block == 1 {
        return (field.clone(), pitch);
    }
    let shape = [field.nrows().div_ceil(block), field.ncols().div_ceil(block)];
    let field_rows: Vec<_> = field.outer_iter().collect();
    let of = |i: usize, j: usize| {
        let ends = |at: usize, n: usize| at * block..((at + 1) * block).min(n);
        let (mut count, mut sum, mut largest) = (0, 0.0, f64::NEG_INFINITY);
        for row in &field_rows[ends(i, field.nrows())] {
            for value in ends(j, field.ncols()).map(|at| row[at]).filter(|value| value.is_finite()) {
                count += 1;
                sum += value;
                largest = f64::max(largest, value);
            }
        }
        match (count, reduction) {
            (0, _) => f64::NAN,
            (_, Reduction::Largest) => largest,
            (count, Reduction::Mean) => sum / f64::from(count),
        }
    };
    let rows = (0..shape[0]).into_par_iter();
    let blocks: Vec<f64> = rows.flat_map_iter(|i| (0..shape[1]).map(move |j| of(i, j))).collect();
    (
        Field::from_shape_vec(shape, blocks).expect("a value of each block"),
        pitch.map(|pitch| pitch * block as f64),
    )
}

#[cfg(test)]
pub(super) mod tests {
    use std::io::Read;

    use super::*;

    /// The values again, as a browser comes to them.
    pub(in crate::page) fn unpacked(packed: &QuantisedField) -> Field {
        let deflated = STANDARD.decode(&packed.data).unwrap();
        let mut levels = Vec::new();
        flate2::read::ZlibDecoder::new(&deflated[..]).read_to_end(&mut levels).unwrap();
        let (cells, columns) = (packed.shape[0] * packed.shape[1], packed.shape[1]);
        let mut before = 0u16;
        Field::from_shape_fn(packed.shape, |(i, j)| {
            let n = i * columns + j;
            match packed.code {
                Code::Positive if levels[n] == 0 => 0.0,
                Code::Positive => f64::from(levels[n] - 1) / 254.0 * packed.high,
                Code::Logarithmic if levels[n] == 0 => 0.0,
                Code::Logarithmic => {
                    packed.low * (packed.high / packed.low).powf(f64::from(levels[n] - 1) / 254.0)
                }
                Code::Class if levels[n] == u8::MAX => f64::NAN,
                Code::Class => f64::from(levels[n]),
                Code::Even => {
                    let step = u16::from_be_bytes([levels[n], levels[cells + n]]);
                    before = if j == 0 { step } else { before.wrapping_add(step) };
                    match before {
                        u16::MAX => f64::NAN,
                        level => packed.low + f64::from(level) / 65534.0 * (packed.high - packed.low),
                    }
                }
            }
        })
    }

    #[test]
    fn numbers_over_decades_come_back_within_half_a_level() {
        let field =
            Field::from_shape_fn([5, 4], |(i, j)| if i == 0 { 0.0 } else { 10f64.powi(-((i * j) as i32)) });
        let packed = QuantisedField::logarithmic(&field, [1.0; 2], 1e-6);
        assert_eq!([packed.low, packed.high], [1e-6, 1.0]);
        for (found, given) in unpacked(&packed).iter().zip(&field) {
            let expected = if *given > 0.0 { given.max(1e-6) } else { 0.0 };
            assert!((found - expected).abs() <= 0.03 * expected, "{found} {given}");
        }
        let flat = QuantisedField::logarithmic(&Field::from_elem([2, 2], 3.0), [1.0; 2], 1e-6);
        assert!(unpacked(&flat).iter().all(|value| *value == 3.0));
    }

    #[test]
    fn a_field_comes_back_within_half_a_level() {
        arbtest::arbtest(|u| {
            let shape = [u.int_in_range(1..=9)?, u.int_in_range(1..=9)?];
            let size = 10f64.powi(u.int_in_range(-12..=9)?);
            let mut field = Field::zeros(shape);
            for value in &mut field {
                *value = match u.int_in_range(0..=5)? {
                    0 => 0.0,
                    1 => size,
                    _ => size * f64::from(u.arbitrary::<u32>()?) / f64::from(u32::MAX),
                };
            }
            let largest = field.iter().copied().fold(0.0, f64::max);
            let back = unpacked(&QuantisedField::positive(&field, [1.0; 2]));
            for (p, q) in field.iter().zip(&back) {
                assert!((p - q).abs() <= 0.5001 * largest / 254.0, "{p} came back as {q}");
            }
            let mut heights = field.mapv(|p| 3.0 * p - size);
            if u.arbitrary()? {
                heights[[0, 0]] = f64::NAN;
            }
            let packed = QuantisedField::even(&heights, [1.0; 2]);
            let level = (packed.high - packed.low) / 65534.0;
            for (z, back) in heights.iter().zip(&unpacked(&packed)) {
                assert!((z - back).abs() <= 0.5001 * level || z.is_nan() && back.is_nan(), "{z} as {back}");
            }
            Ok(())
        });
    }

    #[test]
    fn no_contact_is_kept_apart_from_the_least_pressure_and_the_hardness_is_kept() {
        let field = Field::from_shape_vec([1, 4], vec![0.0, 1e-6, 1.0, 4e9]).unwrap();
        let packed = QuantisedField::positive(&field, [1.0; 2]);
        assert_eq!(unpacked(&packed).iter().copied().collect::<Vec<_>>(), [0.0, 0.0, 0.0, 4e9]);
        let deflated = STANDARD.decode(&packed.data).unwrap();
        let mut levels = Vec::new();
        flate2::read::ZlibDecoder::new(&deflated[..]).read_to_end(&mut levels).unwrap();
        assert_eq!(levels, [0, 1, 1, 255]);
    }

    #[test]
    fn a_summit_survives_the_reduction_and_heights_keep_their_mean() {
        let mut field = Field::zeros([4096, 3]);
        field[[4095, 2]] = 7.0;
        let packed = QuantisedField::positive(&field, [1e-6; 2]);
        assert_eq!((packed.shape, packed.pitch), ([1024, 1], [4e-6; 2]));
        assert_eq!(unpacked(&packed)[[1023, 0]], 7.0);
        let (mean, _) = reduced(&field, [1e-6; 2], Reduction::Mean);
        assert!((mean[[1023, 0]] - 7.0 / 12.0).abs() < 1e-15);
    }
}
