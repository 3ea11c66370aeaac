//! SHA-256 digests.

use std::io::{self, Read};
use std::path::Path;

use sha2::{Digest, Sha256};

/// The SHA-256 of `bytes`, hexadecimal.
pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The SHA-256 of the bytes of `numbers`, little-endian, hexadecimal.
pub fn sha256_of(numbers: impl Iterator<Item = f64>) -> String {
    let mut digest = Sha256::new();
    let mut buffer = Vec::with_capacity(1 << 16);
    for number in numbers {
        buffer.extend_from_slice(&number.to_le_bytes());
        if buffer.len() == buffer.capacity() {
            digest.update(&buffer);
            buffer.clear();
        }
    }
    digest.update(&buffer);
    digest.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The SHA-256 of the content of a regular file, hexadecimal.
pub fn sha256_of_file(path: &Path) -> io::Result<String> {
    let mut file = super::regular::open(path, "a topography file")?;
    let mut digest = Sha256::new();
    let mut buffer = vec![0; 1 << 20];
    loop {
        match file.read(&mut buffer)? {
            0 => return Ok(digest.finalize().iter().map(|byte| format!("{byte:02x}")).collect()),
            count => digest.update(&buffer[..count]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_digest_is_that_of_sha256sum() {
        assert_eq!(sha256(b"abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    }

    #[test]
    fn a_digest_of_numbers_is_that_of_their_bytes() {
        let numbers: Vec<f64> = (0..20_000).map(|k| 0.1 * f64::from(k)).collect();
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        assert_eq!(sha256_of(numbers.into_iter()), sha256(&bytes));
    }
}
