//! Chunks of arrays in files: bytes of equal significance together (the shuffle filter of HDF5), then
//! deflated.
//!
//! The low bytes of measured or computed numbers are noise. They are stored as they are, which is as small,
//! and many times as fast to write and to read. Every reader of zlib streams reads them.

use std::io;

use flate2::{Compress, Compression, Decompress, FlushCompress, FlushDecompress, Status};

/// Bytes of a value.
const WIDTH: usize = 8;

/// Packs values for a chunk of `len` values, the last of which may be missing and become 0.
pub fn packed(values: &[f64], len: usize, level: u32) -> Vec<u8> {
    let mut planes = vec![0; WIDTH * len];
    shuffle(values, len, &mut planes);
    let mut stream = Stream::new(planes.len() / 2 + 1024, level);
    planes.chunks_exact(len).for_each(|plane| stream.add(plane));
    stream.end(adler32(&planes))
}

/// Unpacks the first values of a chunk of `len` values.
///
/// # Errors
/// [`io::ErrorKind::InvalidData`] if the chunk is damaged.
pub fn unpack(packed: &[u8], len: usize, values: &mut [f64]) -> io::Result<()> {
    let damaged = || io::Error::new(io::ErrorKind::InvalidData, "a damaged chunk");
    let mut planes = Vec::with_capacity(WIDTH * len);
    let mut stream = Decompress::new(true);
    let status =
        stream.decompress_vec(packed, &mut planes, FlushDecompress::Finish).map_err(|_| damaged())?;
    if status != Status::StreamEnd || planes.len() != WIDTH * len {
        return Err(damaged());
    }
    unshuffle(&planes, len, values);
    Ok(())
}

/// A zlib stream, RFC 1950 and 1951, whose blocks are of different kinds.
struct Stream {
    bytes: Vec<u8>,
    /// Bits that do not fill a byte yet, the first one lowest.
    bits: u64,
    count: u32,
    /// Compresses blocks, each by itself.
    blocks: Compress,
}

/// Kind of a block without compression, and of one with a code of its own.
const STORED: u64 = 0b00;
const OWN_CODE: u64 = 0b10;
/// Literals and the end of the block.
const SYMBOLS: usize = 257;
/// Bits of the longest code.
const MAX_BITS: u32 = 15;

impl Stream {
    fn new(capacity: usize, level: u32) -> Self {
        let mut bytes = Vec::with_capacity(capacity);
        // Deflate with a window of 32 KiB at the default level; a multiple of 31.
        bytes.extend([0x78, 0x9c]);
        Self { bytes, bits: 0, count: 0, blocks: Compress::new(Compression::new(level), false) }
    }

    /// Adds the bytes in the kind of block that suits them.
    fn add(&mut self, plane: &[u8]) {
        /// Bytes on which kinds are tried.
        const SAMPLE: usize = 1 << 13;
        /// Size below which a slower kind is worth its time, over that of a faster one.
        const GAIN: f64 = 0.97;
        let counts = counts(plane);
        if plane.len() < 2 * SAMPLE || counts.iter().any(|count| *count as usize > plane.len() / 2) {
            return self.compress(plane);
        }
        let from = (plane.len() - SAMPLE) / 2;
        let sample = &plane[from..from + SAMPLE];
        let mut tried = Vec::with_capacity(2 * SAMPLE);
        deflate(&mut self.blocks, sample, &mut tried);
        let coded = entropy(&self::counts(sample)) / 8.0;
        if (tried.len() as f64) < GAIN * coded.min(SAMPLE as f64) {
            self.compress(plane);
        } else if entropy(&counts) / 8.0 < GAIN * plane.len() as f64 {
            self.code(plane, &counts);
        } else {
            plane.chunks(usize::from(u16::MAX)).for_each(|block| self.store(block, false));
        }
    }

    /// Adds bytes as they are.
    fn store(&mut self, block: &[u8], is_last: bool) {
        self.write(u64::from(is_last) | STORED << 1, 3);
        self.write(0, (8 - self.count % 8) % 8);
        let size = block.len() as u16;
        self.bytes.extend(size.to_le_bytes());
        self.bytes.extend((!size).to_le_bytes());
        self.bytes.extend(block);
    }

    /// Adds bytes with what repeats in them replaced.
    fn compress(&mut self, plane: &[u8]) {
        if self.count > 0 {
            self.store(&[], false);
        }
        deflate(&mut self.blocks, plane, &mut self.bytes);
    }

    /// Adds bytes in a Huffman code of their `counts`.
    fn code(&mut self, plane: &[u8], counts: &[u32; 256]) {
        let mut weights = [1; SYMBOLS];
        weights[..256].copy_from_slice(counts);
        let lengths = code_lengths(weights);
        self.write(OWN_CODE << 1, 3);
        // 257 lengths of literals, 1 of a distance, 19 of lengths.
        self.write(0, 5);
        self.write(0, 5);
        self.write(15, 4);
        // Lengths 0 to 15 have codes of 4 bits; repetitions (16, 17, 18) have none.
        (0..19).for_each(|at| self.write(if at < 3 { 0 } else { 4 }, 3));
        for length in lengths.into_iter().chain([0]) {
            self.write(reversed(length, 4), 4);
        }
        let codes = codes(&lengths);
        for byte in plane {
            let [code, length] = codes[usize::from(*byte)];
            self.write(u64::from(code), length);
        }
        let [code, length] = codes[SYMBOLS - 1];
        self.write(u64::from(code), length);
    }

    /// Ends the stream.
    fn end(mut self, checksum: u32) -> Vec<u8> {
        self.store(&[], true);
        self.bytes.extend(checksum.to_be_bytes());
        self.bytes
    }

    /// Adds the lowest bits of a number, at most 15 of them.
    #[inline]
    fn write(&mut self, bits: u64, count: u32) {
        self.bits |= bits << self.count;
        self.count += count;
        if self.count >= 32 {
            self.bytes.extend((self.bits as u32).to_le_bytes());
            self.bits >>= 32;
            self.count -= 32;
        }
        if self.count.is_multiple_of(8) {
            // Whole bytes leave, so that what is aligned can follow.
            self.bytes.extend_from_slice(&self.bits.to_le_bytes()[..self.count as usize / 8]);
            (self.bits, self.count) = (0, 0);
        }
    }
}

/// Appends blocks of a deflate stream that ends with a whole byte.
fn deflate(blocks: &mut Compress, bytes: &[u8], packed: &mut Vec<u8>) {
    blocks.reset();
    loop {
        let rest = &bytes[blocks.total_in() as usize..];
        packed.reserve(rest.len() + 1024);
        blocks.compress_vec(rest, packed, FlushCompress::Sync).expect("memory takes all");
        if blocks.total_in() as usize == bytes.len() && packed.len() < packed.capacity() {
            return;
        }
    }
}

/// Counts each byte.
fn counts(plane: &[u8]) -> [u32; 256] {
    // Neighbours are often the same, and would wait for each other.
    let mut parts = [[0; 256]; 4];
    for bytes in plane.chunks(4) {
        bytes.iter().zip(&mut parts).for_each(|(byte, counts)| counts[usize::from(*byte)] += 1);
    }
    std::array::from_fn(|byte| parts.iter().map(|counts| counts[byte]).sum())
}

/// Bits of a message with these counts.
fn entropy(counts: &[u32; 256]) -> f64 {
    let all: u32 = counts.iter().sum();
    let bits = |count: u32| f64::from(count) * (f64::from(all) / f64::from(count)).log2();
    counts.iter().filter(|count| **count > 0).map(|count| bits(*count)).sum()
}

/// Lengths of a Huffman code of symbols with these weights, at most [`MAX_BITS`]; 0 for a weight of 0.
fn code_lengths(mut weights: [u32; SYMBOLS]) -> [u32; SYMBOLS] {
    loop {
        let mut nodes: Vec<(u64, usize)> = (0..SYMBOLS)
            .filter(|symbol| weights[*symbol] > 0)
            .map(|symbol| (u64::from(weights[symbol]), symbol))
            .collect();
        nodes.sort_unstable();
        let leaves = nodes.len();
        // Parents come after their children; both queues are sorted.
        let mut parents = vec![0; 2 * leaves - 1];
        let (mut leaf, mut inner) = (0, leaves);
        for parent in leaves..2 * leaves - 1 {
            let mut weight = 0;
            for _ in 0..2 {
                let takes_leaf = leaf < leaves && (inner >= nodes.len() || nodes[leaf].0 <= nodes[inner].0);
                let child = if takes_leaf { &mut leaf } else { &mut inner };
                weight += nodes[*child].0;
                parents[*child] = parent;
                *child += 1;
            }
            nodes.push((weight, SYMBOLS));
        }
        let mut depths = vec![0; 2 * leaves - 1];
        for node in (0..2 * leaves - 2).rev() {
            depths[node] = depths[parents[node]] + 1;
        }
        if depths.iter().all(|depth| *depth <= MAX_BITS) {
            let mut lengths = [0; SYMBOLS];
            (0..leaves).for_each(|node| lengths[nodes[node].1] = depths[node]);
            return lengths;
        }
        // Rare symbols become less rare.
        weights.iter_mut().filter(|weight| **weight > 0).for_each(|weight| *weight = *weight / 2 + 1);
    }
}

/// Codes of these lengths, as they are written, with their lengths.
fn codes(lengths: &[u32; SYMBOLS]) -> [[u32; 2]; SYMBOLS] {
    let mut next = 0;
    let mut codes = [[0; 2]; SYMBOLS];
    for length in 1..=MAX_BITS {
        next <<= 1;
        for symbol in (0..SYMBOLS).filter(|symbol| lengths[*symbol] == length) {
            codes[symbol] = [reversed(next, length) as u32, length];
            next += 1;
        }
    }
    codes
}

/// The lowest bits of a number, the last one first.
fn reversed(bits: u32, count: u32) -> u64 {
    u64::from(bits.reverse_bits() >> (32 - count))
}

/// Adler-32 of a zlib stream.
fn adler32(bytes: &[u8]) -> u32 {
    const MODULUS: u64 = 65521;
    const BLOCK: usize = 32;
    let (mut a, mut b) = (1_u64, 0_u64);
    // The sums of so many bytes do not overflow.
    for part in bytes.chunks(1 << 16) {
        let blocks = part.chunks_exact(BLOCK);
        let rest = blocks.remainder();
        for block in blocks {
            let (mut sum, mut weighted) = (0_u32, 0_u32);
            for (k, byte) in block.iter().enumerate() {
                sum += u32::from(*byte);
                weighted += (BLOCK - k) as u32 * u32::from(*byte);
            }
            b += BLOCK as u64 * a + u64::from(weighted);
            a += u64::from(sum);
        }
        for byte in rest {
            a += u64::from(*byte);
            b += a;
        }
        (a, b) = (a % MODULUS, b % MODULUS);
    }
    (b << 16 | a) as u32
}

/// Puts the bytes of values in planes of `len`, the lowest first.
fn shuffle(values: &[f64], len: usize, planes: &mut [u8]) {
    let (groups, rest) = values.as_chunks::<WIDTH>();
    for (at, group) in groups.iter().enumerate() {
        let rows = transposed(group.map(f64::to_bits));
        for (plane, row) in planes.chunks_exact_mut(len).zip(rows) {
            plane[WIDTH * at..][..WIDTH].copy_from_slice(&row.to_le_bytes());
        }
    }
    let begin = values.len() - rest.len();
    for (at, value) in rest.iter().enumerate() {
        for (plane, byte) in planes.chunks_exact_mut(len).zip(value.to_le_bytes()) {
            plane[begin + at] = byte;
        }
    }
}

/// Gathers the bytes of values from planes of `len`.
fn unshuffle(planes: &[u8], len: usize, values: &mut [f64]) {
    let planes: [&[u8]; WIDTH] = std::array::from_fn(|plane| &planes[plane * len..][..len]);
    let (groups, rest) = values.as_chunks_mut::<WIDTH>();
    let begin = WIDTH * groups.len();
    for (at, group) in groups.iter_mut().enumerate() {
        let row =
            |plane: &[u8]| u64::from_le_bytes(plane[WIDTH * at..][..WIDTH].try_into().expect("eight bytes"));
        *group = transposed(planes.map(row)).map(f64::from_bits);
    }
    for (at, value) in rest.iter_mut().enumerate() {
        *value = f64::from_le_bytes(planes.map(|plane| plane[begin + at]));
    }
}

/// Transposes eight rows of eight bytes.
#[inline(always)]
fn transposed(mut rows: [u64; WIDTH]) -> [u64; WIDTH] {
    let mut swap = |low: usize, high: usize, shift: u32, mask: u64| {
        let swapped = ((rows[low] >> shift) ^ rows[high]) & mask;
        rows[low] ^= swapped << shift;
        rows[high] ^= swapped;
    };
    [0, 1, 2, 3].into_iter().for_each(|row| swap(row, row + 4, 32, 0x0000_0000_ffff_ffff));
    [0, 1, 4, 5].into_iter().for_each(|row| swap(row, row + 2, 16, 0x0000_ffff_0000_ffff));
    [0, 2, 4, 6].into_iter().for_each(|row| swap(row, row + 1, 8, 0x00ff_00ff_00ff_00ff));
    rows
}

#[cfg(test)]
mod tests {
    use std::io::{Read, Write};

    use flate2::read::ZlibDecoder;
    use flate2::write::ZlibEncoder;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;

    /// Values of which each byte is of another kind.
    fn heights(count: usize) -> Vec<f64> {
        let mut random = ChaCha8Rng::seed_from_u64(7);
        let noise = move || random.random::<f64>();
        let waves = (0..count).map(|k| (0.001 * k as f64).sin() + 0.3 * (0.013 * k as f64).cos());
        waves.zip(std::iter::repeat_with(noise)).map(|(wave, noise)| 1e-6 * (wave + 1e-3 * noise)).collect()
    }

    fn foreign(values: &[f64], len: usize) -> Vec<u8> {
        let mut planes = vec![0; WIDTH * len];
        for (at, value) in values.iter().enumerate() {
            for (plane, byte) in value.to_le_bytes().into_iter().enumerate() {
                planes[plane * len + at] = byte;
            }
        }
        planes
    }

    #[test]
    fn any_zlib_reads_the_bytes_and_they_come_back() {
        let len = 1 << 15;
        let smooth = heights(len);
        let sparse: Vec<f64> = smooth.iter().map(|z| if *z > 1e-6 { *z } else { 0.0 }).collect();
        let steps: Vec<f64> = (0..len).map(|k| f64::from((k * k % 251) as u8) / 16.0).collect();
        let odd = [f64::NAN, f64::INFINITY, -0.0, 5e-324, f64::MAX];
        for values in [&smooth[..], &sparse, &steps, &smooth[..len - 13], &odd, &[0.0; 40_000][..len]] {
            let packed = packed(values, len, 2);
            let mut bytes = Vec::new();
            ZlibDecoder::new(&packed[..]).read_to_end(&mut bytes).unwrap();
            assert!(bytes == foreign(values, len));
            let mut back = vec![1.0; values.len()];
            unpack(&packed, len, &mut back).unwrap();
            assert!(back.iter().zip(values).all(|(back, value)| back.to_bits() == value.to_bits()));
        }
    }

    #[test]
    fn noise_takes_little_more_space_than_with_the_best_compression() {
        let len = 1 << 17;
        let values = heights(len);
        let mut best = ZlibEncoder::new(Vec::new(), Compression::best());
        best.write_all(&foreign(&values, len)).unwrap();
        let (best, ours) = (best.finish().unwrap().len(), packed(&values, len, 2).len());
        assert!((ours as f64) < 1.03 * best as f64, "{ours} bytes, {best} by the best compression");
    }

    #[test]
    fn damage_is_an_error() {
        let (len, values) = (1 << 15, heights(1 << 15));
        let packed = packed(&values, len, 2);
        let mut back = vec![0.0; len];
        for at in (0..packed.len()).step_by(packed.len() / 50) {
            let mut damaged = packed.clone();
            damaged[at] ^= 1 << (at % 8);
            assert!(unpack(&damaged, len, &mut back).is_err(), "byte {at}");
        }
        assert!(unpack(&packed[..packed.len() - 1], len, &mut back).is_err());
        assert!(unpack(&packed, len - 1, &mut back[1..]).is_err());
    }

    #[test]
    fn no_code_is_longer_than_deflate_allows_and_all_are_needed() {
        // Fibonacci's numbers have the longest codes.
        let mut weights = [0; SYMBOLS];
        let (mut a, mut b) = (1, 1);
        for weight in &mut weights[..40] {
            *weight = a;
            (a, b) = (b, a + b);
        }
        weights[SYMBOLS - 1] = 1;
        let lengths = code_lengths(weights);
        assert_eq!(lengths.iter().max(), Some(&MAX_BITS));
        let kraft: f64 =
            lengths.iter().filter(|length| **length > 0).map(|length| 0.5_f64.powi(*length as i32)).sum();
        assert!((kraft - 1.0).abs() < 1e-12, "{kraft}");
    }

    #[test]
    fn the_checksum_is_that_of_its_standard() {
        assert_eq!(adler32(b"Wikipedia"), 0x11e6_0398);
        let bytes: Vec<u8> = (0..200_000_u32).map(|k| (k.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
        let (mut a, mut b) = (1_u32, 0_u32);
        for byte in &bytes {
            a = (a + u32::from(*byte)) % 65521;
            b = (b + a) % 65521;
        }
        assert_eq!(adler32(&bytes), b << 16 | a);
    }
}
