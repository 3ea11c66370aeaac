//! Legacy `.vtk`, for ParaView and its kin; only written.
//!
//! Format: "VTK File Formats", the legacy part: a text header, then binary numbers, big-endian, x fastest.

use std::path::Path;

use crate::error::Result;
use crate::grid::{Field, Grid};
use crate::io::atomic;

/// Writes `fields`, named, on the centres of the cells of `grid`, atomically. Spaces in a name become `_`.
///
/// # Errors
/// [`Error::File`](crate::Error::File).
///
/// # Panics
/// If a field is not on `grid`.
pub fn write(path: &Path, grid: &Grid, fields: &[(&str, &Field)]) -> Result<()> {
    let ([nx, ny], [dx, dy]) = (grid.shape, grid.pitch);
    atomic::write_with(path, |file| {
        writeln!(file, "# vtk DataFile Version 3.0\nasperity, SI units\nBINARY\nDATASET STRUCTURED_POINTS")?;
        writeln!(
            file,
            "DIMENSIONS {nx} {ny} 1\nORIGIN {:e} {:e} 0\nSPACING {dx:e} {dy:e} 1",
            dx / 2.0,
            dy / 2.0
        )?;
        writeln!(file, "POINT_DATA {}", grid.cells())?;
        for (name, field) in fields {
            assert_eq!(field.dim(), (nx, ny), "{name} is not on the grid");
            let name = name.replace(char::is_whitespace, "_");
            write!(file, "SCALARS {name} double 1\nLOOKUP_TABLE default\n")?;
            for value in field.t() {
                file.write_all(&value.to_be_bytes())?;
            }
            file.write_all(b"\n")?;
        }
        Ok(())
    })
}
