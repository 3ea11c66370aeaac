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
fn x_and_height_are_a_profile_and_a_line_of_x_y_and_height_is_refused() {
    arbtest(|u| {
        let points = u.int_in_range(9..=60)?;
        let z = (0..points).map(|_| uniform(u)).collect::<arbtest::arbitrary::Result<Vec<_>>>()?;
        let step = 10f64.powf(6.0 * uniform(u)? - 6.0) * if u.arbitrary()? { 1.0 } else { -1.0 };
        let lacking = u.int_in_range(1..=points - 2)?;
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
        let read = from_bytes(Path::new("line"), text.as_bytes(), None, None);
        if layout > 0 {
            let message = read.unwrap_err().to_string();
            assert!(
                message.contains("look like a line scan with x, y and height, expected"),
                "{message}\n{text}"
            );
            return Ok(());
        }
        let scan = read.unwrap_or_else(|error| panic!("{error}\n{text}"));
        assert_eq!((scan.format, scan.unit, scan.lines), ("xz", LengthUnit::MetresThroughout, None));
        let mut expected =
            Field::from_shape_fn([points, 1], |(i, _)| if i == lacking { f64::NAN } else { z[i] });
        if step < 0.0 {
            expected.invert_axis(ndarray::Axis(0));
        }
        assert_same(&scan.heights, &expected);
        let [dx, dy] = scan.pitch.unwrap();
        let off = (dx / step.abs() - 1.0).abs() * (points - 1) as f64;
        assert!(dx == dy && off < 0.11, "{dx} for {step}");
        Ok(())
    })
    .budget_ms(500);
}

#[test]
fn a_profile_may_have_names_units_and_decimal_commas() {
    for (text, channel, factors) in [
        ("x [mm];z [um]\n0;1\n0,5;3\n1;2,5\n", "z", [1e-3, 1e-6]),
        ("Instrument: a stylus\nX (mm)\tHeight (um)\n0\t1\n0.5\t3\n1\t2.5\n", "Height", [1e-3, 1e-6]),
        ("\"X\";\"Z\";\n\"0\";\"1\";\n\"0,5\";\"3\";\n\"1\";\"2,5\";\n", "Z", [1.0, 1.0]),
        ("Distance, Height [nm]\n0, 1\n0.5, 3\n1, 2.5\n", "Height", [1.0, 1e-9]),
    ] {
        let scan = decode(text.as_bytes(), None).unwrap_or_else(|fault| panic!("{text}: {fault:?}"));
        assert_eq!((scan.format, scan.channel.as_str()), ("csv", channel));
        assert_same(&scan.heights, &(ndarray::array![[1.0], [3.0], [2.5]] * factors[1]));
        assert_eq!(scan.pitch, Some([0.5 * factors[0]; 2]));
    }
    let titled = decode(b"Stylus trace\n0 1\n0.5 3\n1 2.5\n", None).unwrap();
    assert_eq!((titled.format, titled.pitch), ("xz", Some([0.5; 2])));
    let two = decode(b"x [um], z [um], z2 [nm]\n0,1,4\n1,2,5\n2,3,6\n", Some("z2")).unwrap();
    assert_eq!((two.channels.len(), two.heights[[2, 0]]), (2, 6.0 * 1e-9));
    // Four lines without names, and four lines whose x are not evenly spaced.
    let four = decode(b"0 1\n1 3\n2 2\n3 5\n", None).unwrap();
    assert_eq!((four.format, four.heights.dim(), four.pitch), ("xz", (4, 1), Some([1.0; 2])));
    assert_eq!(
        defect(b"x,z\n0,1\n1,3\n3,2\n"),
        "csv: x is `x`, expected at least 3 evenly spaced positions, each once"
    );
}

#[test]
fn narrow_matrices_of_few_lines_stay_matrices() {
    arbtest(|u| {
        let shape = [u.int_in_range(2..=7)?, u.int_in_range(2..=3)?];
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
        // Three heights are evenly spaced by chance, as the positions of a profile are.
        if kind < 3 && shape[1] == 2 && shape[0] > 2 && super::super::points::profile(&heights, 1).is_some() {
            return Ok(());
        }
        let text = lines_of(&heights);
        let scan = from_bytes(Path::new("matrix"), text.as_bytes(), None, None);
        let scan = scan.unwrap_or_else(|error| panic!("{error}\n{text}"));
        assert_eq!(scan.format, "text", "{text}");
        assert_same(&scan.heights, &heights.t().to_owned());
        Ok(())
    })
    .budget_ms(500);
}

fn lines_of(heights: &Field) -> String {
    let line = |row: ndarray::ArrayView1<'_, f64>| {
        row.iter().map(|z| format!("{z:e}")).collect::<Vec<_>>().join(" ") + "\n"
    };
    heights.rows().into_iter().map(line).collect()
}

#[test]
fn a_narrow_table_of_many_lines_looks_like_points_unless_it_is_called_a_matrix() {
    arbtest(|u| {
        let columns = u.int_in_range(2..=7)?;
        let mut table = Field::zeros([u.int_in_range(if columns > 3 { 22 } else { 8 }..=60)?, columns]);
        for value in &mut table {
            *value = uniform(u)?;
        }
        if u.is_empty() {
            return Ok(());
        }
        let text = lines_of(&table);
        let name = Path::new("cloud.txt");
        let error = from_bytes(name, text.as_bytes(), None, None).unwrap_err();
        assert!(error.to_string().contains("look like"), "{error}");
        assert!(error.hint().unwrap().contains("griddata"));
        for (axis, expected) in [(Axis::X, table.t().to_owned()), (Axis::Y, table.clone())] {
            let scan = ReadOptions::default().with_lines(axis).scan_bytes(name, text.as_bytes()).unwrap();
            assert_eq!((scan.format, scan.lines), ("text", Some(axis)));
            assert_same(&scan.heights, &expected);
        }
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
    assert_eq!(
        defect((0..40).map(track).collect::<String>().as_bytes()),
        "text: 40 lines of 2 numbers look like x and height, expected evenly spaced x"
    );
    // A motor that drifts while the other axis moves back and forth.
    let drift = |i: i32| {
        format!("{} {} {}\n", (f64::from(i)).powf(1.3), (3.0 + f64::from(i * i % 7)).sqrt(), i * 5 % 11)
    };
    assert_eq!(
        defect((0..40).map(drift).collect::<String>().as_bytes()),
        "text: 40 lines of 3 numbers look like points x, y and height on no grid, expected a regular grid"
    );
}
