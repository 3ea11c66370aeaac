//! Legacy `.vtk`, for ParaView and similar programs; write only.
//!
//! Format: "VTK File Formats", legacy part: a text header, then binary numbers, big-endian, x fastest.

use std::path::Path;

use asperity_base::error::Result;
use asperity_base::grid::{Field, Grid};
use asperity_base::io::atomic;

/// Writes `heights` at the centres of the cells of `grid`, atomically.
///
/// # Errors
/// [`Error::File`](asperity_base::Error::File).
///
/// # Panics
/// If the shape of the heights differs from that of `grid`.
pub(super) fn write(path: &Path, grid: &Grid, heights: &Field) -> Result<()> {
    assert_eq!(heights.shape(), grid.shape, "heights must be on the grid");
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
        write!(file, "SCALARS height double 1\nLOOKUP_TABLE default\n")?;
        for height in heights.t() {
            file.write_all(&height.to_be_bytes())?;
        }
        file.write_all(b"\n")
    })
}
