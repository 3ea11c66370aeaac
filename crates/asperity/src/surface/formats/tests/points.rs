//! Tables of points compared with the data written to them.

use super::*;

type Random<'a, 'b> = &'a mut arbtest::arbitrary::Unstructured<'b>;

/// Uniform in 0 … 1.
fn uniform(u: Random<'_, '_>) -> arbtest::arbitrary::Result<f64> {
    Ok(f64::from(u.arbitrary::<u32>()?) / f64::from(u32::MAX))
}

/// A table of points with its origin.
#[derive(Debug)]
struct PointTable {
    text: String,
    pitch: [f64; 2],
    heights: Field,
    jitter: f64,
}

/// A grid with up to a given fraction of its points missing, written in some order with some separator.
fn written(u: Random<'_, '_>, shape: [usize; 2], lacking: f64) -> arbtest::arbitrary::Result<PointTable> {
    let pitch = [10f64.powf(6.0 * uniform(u)? - 6.0), 10f64.powf(6.0 * uniform(u)? - 6.0)];
    let origin = [1e3 * pitch[0] * (uniform(u)? - 0.5), 1e3 * pitch[1] * (uniform(u)? - 0.5)];
    // Positions of a stage, exact or nearly so.
    let jitter = *u.choose(&[0.0, 1e-6, 0.05, 0.1])?;
    let mut heights = Field::from_elem(shape, f64::NAN);
    let mut lines = Vec::new();
    let separator = *u.choose(&[" ", "\t", ",", ";", ", ", "  "])?;
    let [nx, ny] = shape;
    for point in 0..nx * ny {
        let [ix, iy] = if nx > ny { [point / ny, point % ny] } else { [point % nx, point / nx] };
        if uniform(u)? < lacking {
            continue;
        }
        let mut place = |i: usize, axis: usize| -> arbtest::arbitrary::Result<f64> {
            Ok(origin[axis] + pitch[axis] * (i as f64 + jitter * (2.0 * uniform(u)? - 1.0)))
        };
        let (x, y) = (place(ix, 0)?, place(iy, 1)?);
        let z = 1e-6 * (2.0 * uniform(u)? - 1.0);
        heights[[ix, iy]] = z;
        lines.push(format!("{x:e}{separator}{y:e}{separator}{z:e}"));
    }
    match u.int_in_range(0..=2)? {
        0 => {}
        1 => lines.reverse(),
        _ => {
            for i in (1..lines.len()).rev() {
                lines.swap(i, u.int_in_range(0..=i)?);
            }
        }
    }
    Ok(PointTable { text: lines.join(*u.choose(&["\n", "\r\n"])?), pitch, heights, jitter })
}

/// The part of a field within its outermost nonempty lines.
fn trimmed(heights: &Field) -> Field {
    let there = |axis: usize| -> Vec<usize> {
        let lines = heights.axis_iter(ndarray::Axis(axis)).enumerate();
        lines.filter(|(_, line)| line.iter().any(|z| !z.is_nan())).map(|(i, _)| i).collect()
    };
    let (x, y) = (there(0), there(1));
    heights.slice(ndarray::s![x[0]..=x[x.len() - 1], y[0]..=y[y.len() - 1]]).to_owned()
}

#[test]
fn points_that_lack_are_missing_heights() {
    arbtest(|u| {
        let shape = [u.int_in_range(4..=24)?, u.int_in_range(4..=24)?];
        let lacking = *u.choose(&[0.0, 0.01, 0.1, 0.3])?;
        let written = written(u, shape, lacking)?;
        let count = written.heights.iter().filter(|z| !z.is_nan()).count();
        // The grid of so few points is ambiguous.
        if count < 6 || 2 * count < written.heights.len() || count < 16 && written.jitter > 1e-3 {
            return Ok(());
        }
        let expected = trimmed(&written.heights);
        for header in ["", "# x y z\n", "x,y,z\n"] {
            let text = format!("{header}{}", written.text);
            let scan = from_bytes(Path::new("points"), text.as_bytes(), None, Some(1e-3));
            let scan = scan.unwrap_or_else(|error| panic!("{error}\n{text}"));
            assert_eq!(scan.format, if header.starts_with('x') { "csv" } else { "xyz" });
            assert_same(&scan.heights, &expected.mapv(|z| z * 1e-3));
            for axis in 0..2 {
                let pitch = scan.pitch.unwrap()[axis] / 1e-3;
                let off = (pitch / written.pitch[axis] - 1.0).abs() * (expected.shape()[axis] - 1) as f64;
                assert!(off < 0.21, "{pitch} instead of {}", written.pitch[axis]);
            }
        }
        Ok(())
    })
    .budget_ms(1500);
}

#[test]
fn a_line_scan_is_refused_as_one() {
    arbtest(|u| {
        let points = u.int_in_range(9..=60)?;
        let z = (0..points).map(|_| uniform(u)).collect::<arbtest::arbitrary::Result<Vec<_>>>()?;
        let step = 10f64.powf(6.0 * uniform(u)? - 6.0) * if u.arbitrary()? { 1.0 } else { -1.0 };
        let lacking = u.int_in_range(0..=points)?;
        let jitter = *u.choose(&[0.0, 1e-6, if points > 16 { 0.05 } else { 0.0 }])?;
        let layout = u.int_in_range(0..=3)?;
        let mut text = String::new();
        for (i, z) in z.iter().enumerate().filter(|(i, _)| *i != lacking) {
            let x = step * (i as f64 + jitter * (2.0 * uniform(u)? - 1.0));
            text += &match layout {
                0 => format!("{x:e} {z:e}\n"),
                1 => format!("{x:e};7;{z:e}\n"),
                2 => format!("0.5\t{x:e}\t{z:e}\n"),
                _ => format!("{x:e},{:e},{z:e}\n", 0.5 * x),
            };
        }
        let message = from_bytes(Path::new("line"), text.as_bytes(), None, None).unwrap_err().to_string();
        assert!(message.contains("a line scan: ") && message.contains("expected a map"), "{message}\n{text}");
        Ok(())
    })
    .budget_ms(500);
    let named = defect(b"x [mm];z [um]\n0;1\n1;3\n2;2\n");
    assert_eq!(named, "csv: the table is `a line scan of x [mm], z [um]`, expected a map: x, y and heights");
}

#[test]
fn narrow_matrices_stay_matrices() {
    arbtest(|u| {
        let shape = [u.int_in_range(2..=60)?, u.int_in_range(2..=3)?];
        // Heights as noise, as levels of an instrument, as a plane with noise, as a plane.
        let kind = u.int_in_range(0..=3)?;
        let slope = [uniform(u)?, uniform(u)? - 0.5];
        let mut heights = Field::zeros(shape);
        for (i, j) in ndarray::indices(shape) {
            let noise = uniform(u)?;
            heights[[i, j]] = match kind {
                0 => noise,
                1 => (noise * 200.0).round(),
                2 => slope[0] * i as f64 + slope[1] * j as f64 + 3.0 * noise,
                _ => 0.1 * i as f64 + slope[1] * j as f64,
            };
        }
        // Once the random numbers are used up, there is no noise.
        if kind < 3 && u.is_empty() {
            return Ok(());
        }
        // A slope steeper than its noise in the first of two columns looks like the points of a line scan.
        let first = heights.column(0);
        if kind == 2 && first.iter().zip(first.iter().skip(1)).all(|(one, next)| one < next) {
            return Ok(());
        }
        let lines = heights.rows().into_iter().map(|row| {
            let values: Vec<_> = row.iter().map(|z| format!("{z:e}")).collect();
            values.join(" ")
        });
        let text = lines.collect::<Vec<_>>().join("\n");
        let scan = from_bytes(Path::new("matrix"), text.as_bytes(), None, None);
        let scan = scan.unwrap_or_else(|error| panic!("{error}\n{text}"));
        assert_eq!(scan.format, "text", "{text}");
        assert_same(&scan.heights, &heights);
        Ok(())
    })
    .budget_ms(500);
}

#[test]
fn points_on_no_grid_are_refused() {
    let mut twice = String::new();
    for i in 0..100 {
        twice += &format!("{} {} {}\n", i / 10, i % 10, 0.37 * f64::from(i * i % 17));
    }
    let columns = twice.replace('\n', " 1\n");
    twice += "3 3 0.5\n";
    assert_eq!(
        defect(twice.as_bytes()),
        "text: the table is `101 points, some of them at one place`, expected one height at each x and y"
    );
    assert_eq!(
        defect(columns.as_bytes()),
        "text: the table is `4 columns, the first two of them x and y`, expected x, y and height, or a first line \
         that names the columns"
    );
    let track = |i: i32| format!("{} {}\n", (1.0 + f64::from(i)).ln(), i * i % 11);
    assert!(
        defect((0..40).map(track).collect::<String>().as_bytes()).contains("a line scan: 40 points of x, z")
    );
    // A motor that drifts while the other axis moves back and forth.
    let drift = |i: i32| {
        format!("{} {} {}\n", (f64::from(i)).powf(1.3), (3.0 + f64::from(i * i % 7)).sqrt(), i * 5 % 11)
    };
    assert!(defect((0..40).map(drift).collect::<String>().as_bytes()).contains("x, y, z on no grid"));
}
