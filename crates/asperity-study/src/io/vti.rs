//! VTK image data, `.vti`, for ParaView: fields of results on their grid.
//!
//! Format: "VTK XML file formats", image data with appended raw numbers, little-endian. Each array is
//! preceded by its length in bytes, and x runs fastest.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use ndarray::Array2;

use super::atomic;
use super::fields::Fields;
use asperity_base::error::Result;
use asperity_base::grid::Field;
use asperity_base::units::Metre;

/// Location of values on an image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Location {
    /// Values at the points of an image.
    Points,
    /// Values in the cells of an image.
    Cells,
}

/// Values on a regular grid in space.
#[derive(Debug, Clone, PartialEq)]
struct Image<'a> {
    /// Number of points along x, y and z.
    points: [usize; 3],
    origin: [Metre; 3],
    spacing: [Metre; 3],
    of: Location,
    /// Names and values, x fastest.
    arrays: Vec<(&'a str, Vec<f32>)>,
}

impl Image<'_> {
    fn write(&self, path: &Path) -> Result<()> {
        atomic::write_with(path, |file| self.write_to(file))
    }

    fn write_to(&self, file: &mut dyn Write) -> io::Result<()> {
        let list = |values: [String; 3]| values.join(" ");
        let extent = list(self.points.map(|n| format!("0 {}", n - 1)));
        let [origin, spacing] = [self.origin, self.spacing].map(|v| list(v.map(|v| format!("{v:e}"))));
        let place = match self.of {
            Location::Points => "PointData",
            Location::Cells => "CellData",
        };
        writeln!(
            file,
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" \
             header_type=\"UInt64\">\n<ImageData WholeExtent=\"{extent}\" Origin=\"{origin}\" Spacing=\"{spacing}\">\n\
             <Piece Extent=\"{extent}\">\n<{place}>"
        )?;
        let mut offset = 0;
        for (name, values) in &self.arrays {
            writeln!(
                file,
                "<DataArray type=\"Float32\" Name=\"{name}\" format=\"appended\" offset=\"{offset}\"/>"
            )?;
            offset += 8 + 4 * values.len();
        }
        write!(file, "</{place}>\n</Piece>\n</ImageData>\n<AppendedData encoding=\"raw\">\n_")?;
        for (_, values) in &self.arrays {
            file.write_all(&(4 * values.len() as u64).to_le_bytes())?;
            values.iter().try_for_each(|value| file.write_all(&value.to_le_bytes()))?;
        }
        file.write_all(b"\n</AppendedData>\n</VTKFile>\n")
    }
}

/// Writes the fields of the file at `path`, `NAME.h5`, on the grid of the lower body as `NAME.vti`, and those
/// on a different grid of the upper body as `NAME-upper.vti`. Fields on a part of the lower body are
/// undefined beyond it.
///
/// # Errors
/// [`Error::File`](asperity_base::Error::File) if the file cannot be read, or if one of the others cannot be
/// written.
pub fn write_fields(path: &Path) -> Result<()> {
    let fields = Fields::open(path)?;
    let mut lower: Option<Sheet> = None;
    let mut upper: Option<Sheet> = None;
    let names = fields.names()?;
    // The bodies come first, because they define the grids.
    let bodies = ["lower", "upper"].into_iter().map(str::to_owned).filter(|name| names.contains(name));
    let others = names.iter().filter(|name| !matches!(name.as_str(), "lower" | "upper")).cloned();
    for name in bodies.chain(others) {
        let stored = fields.read(&name)?;
        let (pitch, origin) =
            ([stored.pitch[0], *stored.pitch.last().expect("an axis")], stored.origin.clone());
        let Some(field) = stored.into_field() else { continue };
        let sheet =
            if name.starts_with("upper") || name.ends_with("_upper") { &mut upper } else { &mut lower };
        let sheet = sheet.get_or_insert_with(|| Sheet {
            shape: [field.nrows(), field.ncols()],
            pitch,
            arrays: Vec::new(),
        });
        let first = (origin[0] / pitch[0] - 0.5).round().max(0.0) as usize;
        let values = sheet.placed(&field, first);
        sheet.arrays.push((name, values));
    }
    let stem = path.with_extension("");
    let named = |end: &str| PathBuf::from(format!("{}{end}.vti", stem.display()));
    match (lower, upper) {
        (Some(mut lower), Some(upper)) if lower.shape == upper.shape => {
            lower.arrays.extend(upper.arrays);
            lower.write(&named(""))
        }
        (lower, upper) => {
            lower.map_or(Ok(()), |sheet| sheet.write(&named("")))?;
            upper.map_or(Ok(()), |sheet| sheet.write(&named("-upper")))
        }
    }
}

/// Fields of one body.
struct Sheet {
    shape: [usize; 2],
    pitch: [Metre; 2],
    arrays: Vec<(String, Vec<f32>)>,
}

impl Sheet {
    /// Returns the values of a field whose first column is column `first` of the body, x fastest.
    fn placed(&self, field: &Field, first: usize) -> Vec<f32> {
        let [nx, ny] = self.shape;
        let mut values = vec![f32::NAN; nx * ny];
        for ((ix, iy), value) in field.indexed_iter() {
            values[iy * nx + (first + ix) % nx] = *value as f32;
        }
        values
    }

    fn write(self, path: &Path) -> Result<()> {
        let [nx, ny] = self.shape;
        let image = Image {
            points: [nx + 1, ny + 1, 1],
            origin: [0.0; 3],
            spacing: [self.pitch[0], self.pitch[1], self.pitch[0]],
            of: Location::Cells,
            arrays: self.arrays.iter().map(|(name, values)| (name.as_str(), values.clone())).collect(),
        };
        image.write(path)
    }
}

/// Writes values on planes at evenly spaced depths under the surface of a body as a volume. z is 0 at the
/// surface and decreases into the body. The centre of the first cell is at `origin`.
///
/// # Errors
/// [`Error::File`](asperity_base::Error::File).
///
/// # Panics
/// If there are no planes, or if their shapes differ.
pub fn write_volume(
    path: &Path,
    name: &str,
    planes: &[Array2<f32>],
    origin: [Metre; 2],
    [dx, dy, dz]: [Metre; 3],
) -> Result<()> {
    let (nx, ny) = planes[0].dim();
    // The deepest plane is the lowest.
    let values = planes.iter().rev().flat_map(|plane| {
        assert_eq!(plane.dim(), (nx, ny), "a plane of another shape");
        plane.t().iter().copied().collect::<Vec<_>>()
    });
    let depth = (planes.len() - 1) as f64 * dz;
    let image = Image {
        points: [nx, ny, planes.len()],
        origin: [origin[0], origin[1], -depth],
        spacing: [dx, dy, dz],
        of: Location::Points,
        arrays: vec![(name, values.collect())],
    };
    image.write(path)
}

#[cfg(test)]
mod tests {
    use std::process::Command;

    use super::*;
    use crate::io::fields::FieldFile;
    use asperity_base::grid::Grid;

    /// Output line of a Python script with `vtk`.
    fn as_vtk_reads(path: &Path, say: &str) -> String {
        let python = std::env::var_os("ASPERITY_PYTHON").expect("ASPERITY_PYTHON names a Python with vtk");
        let script = format!(
            "import sys, vtk\nr = vtk.vtkXMLImageDataReader()\nr.SetFileName(sys.argv[1])\nr.Update()\n\
             i = r.GetOutput()\n{say}"
        );
        let output = Command::new(python).args(["-c", &script]).arg(path).output().unwrap();
        let text = String::from_utf8_lossy(&output.stdout).trim().to_owned();
        assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
        text
    }

    #[test]
    #[ignore = "needs a Python with vtk, which ASPERITY_PYTHON names"]
    fn fields_in_the_cells_of_the_lower_body_are_read_in_python() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("pass-0001.h5");
        let grid = Grid::new([5, 3], [1e-6, 2e-6]).unwrap();
        let part = Grid::new([2, 3], [1e-6, 2e-6]).unwrap();
        let other = Grid::new([4, 3], [1e-6, 2e-6]).unwrap();
        let numbered = |grid: &Grid| Field::from_shape_fn(grid.shape, |(i, j)| (10 * i + j) as f64);
        let mut file = FieldFile::new(&path);
        file.add_field("lower", "m", &grid, [0.0; 2], &numbered(&grid));
        file.add_field("upper", "m", &other, [0.0; 2], &numbered(&other));
        file.add_field("mean_pressure_upper", "Pa", &other, [0.0; 2], &numbered(&other));
        // Wraps around: in columns 4 and 0.
        file.add_field("pressure_00001", "Pa", &part, [4e-6, 0.0], &numbered(&part));
        file.write().unwrap();
        write_fields(&path).unwrap();

        let say = "d = i.GetCellData()\nprint(i.GetDimensions(), i.GetSpacing()[:2], i.GetOrigin(), \
                   [d.GetArrayName(k) for k in range(d.GetNumberOfArrays())], \
                   [d.GetArray('lower').GetValue(k) for k in (0, 1, 5, 14)], \
                   [d.GetArray('pressure_00001').GetValue(k) for k in (4, 0, 1, 9)])";
        let expected = "(6, 4, 1) (1e-06, 2e-06) (0.0, 0.0, 0.0) ['lower', 'pressure_00001'] \
                        [0.0, 10.0, 1.0, 42.0] [0.0, 10.0, nan, 1.0]";
        assert_eq!(as_vtk_reads(&path.with_extension("vti"), say), expected);
        let say = "d = i.GetCellData()\nprint(i.GetDimensions(), d.GetNumberOfArrays())";
        assert_eq!(as_vtk_reads(&directory.path().join("pass-0001-upper.vti"), say), "(5, 4, 1) 2");
    }

    #[test]
    #[ignore = "needs a Python with vtk, which ASPERITY_PYTHON names"]
    fn a_volume_with_the_surface_on_top_is_read_in_python() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("subsurface.vti");
        let planes: Vec<Array2<f32>> =
            (0..3).map(|k| Array2::from_shape_fn([2, 4], |(i, j)| (100 * k + 10 * i + j) as f32)).collect();
        write_volume(&path, "von_mises", &planes, [0.5, 0.25], [1.0, 0.5, 0.125]).unwrap();
        let say = "a = i.GetPointData().GetArray('von_mises')\n\
                   at = lambda x, y, z: a.GetValue(i.FindPoint(x, y, z))\n\
                   print(i.GetDimensions(), i.GetBounds(), at(1.5, 0.25, 0), at(0.5, 0.75, -0.25))";
        assert_eq!(as_vtk_reads(&path, say), "(2, 4, 3) (0.5, 1.5, 0.25, 1.75, -0.25, 0.0) 10.0 201.0");
    }
}
