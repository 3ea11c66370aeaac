//! NPZ: arrays of NumPy under names, as `numpy.savez` and `numpy.savez_compressed` write them; read only.
//!
//! A zip archive with a file `NAME.npy` for each array. Each matrix of real numbers is a channel, indexed
//! `[ix, iy]` in metres, see [`npy`](super::npy); other arrays are left out. If there are several, the user
//! must choose one. There is no pitch.

use std::io::{Cursor, Read};

use zip::ZipArchive;

use super::npy::{self, Matrix};
use super::{Decoded, Fault, Scan, choose_among};
use asperity_base::error::Defect;

type Archive<'a> = ZipArchive<Cursor<&'a [u8]>>;

/// Whether a zip archive has an array.
pub(super) fn is_one(bytes: &[u8]) -> bool {
    ZipArchive::new(Cursor::new(bytes))
        .is_ok_and(|archive| archive.file_names().flatten().any(|name| name.ends_with(END)))
}

/// End of the names of arrays.
const END: &str = ".npy";

/// Largest size of the header of an array, and largest number of arrays.
const MAX_HEADER: u64 = 1 << 17;
const MAX_ARRAYS: usize = 1 << 12;

pub(super) fn decode(bytes: &[u8], channel: Option<&str>) -> Decoded {
    let fault = |defect| Fault::defect("npz", defect);
    let mut archive = ZipArchive::new(Cursor::new(bytes)).map_err(|error| fault(container(&error)))?;
    let mut names: Vec<_> =
        archive.file_names().flatten().filter_map(|name| name.strip_suffix(END).map(str::to_owned)).collect();
    names.sort_unstable();
    names.dedup();
    names.truncate(MAX_ARRAYS);
    let (mut channels, mut matrices, mut unsuitable) = (Vec::new(), Vec::new(), None);
    for name in names {
        match entry(&mut archive, &name, MAX_HEADER).and_then(|start| Matrix::at_start(&start)) {
            Ok(matrix) => {
                matrices.push(matrix);
                channels.push(name);
            }
            Err(defect) => unsuitable = Some(defect),
        }
    }
    if let (true, Some(defect)) = (channels.is_empty(), unsuitable) {
        return Err(fault(defect));
    }
    let chosen = choose_among(&channels, channel)?;
    // The header is read again, with the numbers behind it.
    let most = MAX_HEADER + matrices[chosen].bytes();
    let array = entry(&mut archive, &channels[chosen], most).map_err(fault)?;
    let heights = npy::array(&array).map_err(fault)?;
    Ok(Scan::of_matrix("npz", channels, chosen, heights))
}

/// Unpacks at most so many bytes of an array.
fn entry(archive: &mut Archive<'_>, name: &str, most: u64) -> Result<Vec<u8>, Defect> {
    let file = archive.by_name(&format!("{name}{END}")).map_err(|error| container(&error))?;
    let mut unpacked = Vec::new();
    file.take(most).read_to_end(&mut unpacked).map_err(|error| container(&error))?;
    if unpacked.starts_with(npy::MAGIC) {
        Ok(unpacked)
    } else {
        Err(Defect::Missing("array in a file of the archive"))
    }
}

fn container(error: &dyn std::fmt::Display) -> Defect {
    Defect::Container(error.to_string())
}
