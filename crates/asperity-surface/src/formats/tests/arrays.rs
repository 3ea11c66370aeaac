//! Arrays under names: MATLAB and NPZ.

use super::*;

/// The matrix Z of the files in the corpora, [ix, iy].
fn z() -> Field {
    ndarray::array![
        [-1.232, 0.267, -0.007, 0.502, -1.327],
        [1.108, 0.094, f64::NAN, -1.358, -1.307],
        [-0.718, 1.186, 0.895, -0.544, -0.547],
    ]
}

/// The matrix of integers in them.
fn integers() -> Field {
    ndarray::array![[1.0, 2.0, 3.0, 4.0], [5.0, 6.0, 7.0, -8.0]]
}

#[test]
fn the_matrix_of_a_mat_by_scipy_is_read_as_an_array() {
    // Written by scipy 1.17.1: beside the matrix a scalar, a text, a vector, a logical and a complex matrix.
    let scan = read(&corpus("mat", "compressed"), None, None).unwrap();
    assert_eq!((scan.format, scan.channels.as_slice()), ("mat", &["Z".to_owned()][..]));
    assert_eq!((scan.pitch, scan.unit, scan.lines), (None, LengthUnit::Metres, Some(Axis::Y)));
    assert_same(&scan.heights, &z());
    let turned = ReadOptions::default().with_lines(Axis::X).read(corpus("mat", "compressed"));
    assert!(matches!(turned, Err(Error::NoPitch { .. })));
    let turned = ReadOptions::default().with_lines(Axis::X).scan(corpus("mat", "compressed")).unwrap();
    assert_same(&turned.heights, &z().t().to_owned());
}

#[test]
fn several_matrices_of_a_mat_are_channels_to_be_chosen() {
    let file = corpus("mat", "plain");
    let Err(Error::NoChannel { available, .. }) = read(&file, None, None) else {
        panic!("no channel is chosen")
    };
    assert_eq!(available, ["a", "b", "u"]);
    assert_same(&read(&file, Some("a"), None).unwrap().heights, &integers());
    assert_same(&read(&file, Some("u"), None).unwrap().heights, &integers().mapv(f64::abs));
    assert_same(&read(&file, Some("b"), None).unwrap().heights, &z().mapv(|z| f64::from(z as f32)));
    let profile = read(&corpus("mat", "profile"), None, Some(1e-6)).unwrap();
    assert_same(&profile.heights, &(ndarray::array![[0.0, 1.0, 4.0, 9.0]] * 1e-6));
    let complex = read(&corpus("mat", "complex"), None, None).unwrap_err().to_string();
    assert!(
        complex.ends_with("mat: the content is `z: complex`, expected a matrix of real numbers"),
        "{complex}"
    );
}

#[test]
fn version_7_3_of_a_mat_has_the_order_of_version_5() {
    // Written by h5py 3 behind a block of 512 bytes, as MATLAB does.
    let scan = read(&corpus("mat", "hierarchical"), None, None).unwrap();
    assert_eq!((scan.format, scan.channel.as_str(), scan.lines), ("mat", "/Z", Some(Axis::Y)));
    assert_same(&scan.heights, &integers());
}

/// An uncompressed matrix of two rows with this class, flags and storage, big-endian.
fn big(class: u8, flags: u8, storage: u32, data: &[u8], sizes: [u32; 2]) -> Vec<u8> {
    let mut variable = Vec::new();
    variable.extend(
        [6, 8, u32::from(flags) << 8 | u32::from(class), 0].iter().flat_map(|n: &u32| n.to_be_bytes()),
    );
    variable.extend([5, 8, sizes[0], sizes[1]].iter().flat_map(|n: &u32| n.to_be_bytes()));
    // A small element: the name.
    variable.extend([0, 1, 0, 1, b'h', 0, 0, 0]);
    variable.extend([storage, data.len() as u32].iter().flat_map(|n| n.to_be_bytes()));
    variable.extend(data);
    variable.resize(variable.len().next_multiple_of(8), 0);
    let mut file = b"MATLAB 5.0 MAT-file".to_vec();
    file.resize(124, b' ');
    file.extend([1, 0]);
    file.extend(b"MI");
    file.extend([14, variable.len() as u32].iter().flat_map(|n| n.to_be_bytes()));
    file.extend(variable);
    file
}

#[test]
fn numbers_of_a_mat_may_be_narrower_than_their_class_and_in_either_byte_order() {
    let expected = ndarray::array![[1.0, 3.0], [2.0, 4.0]];
    for (storage, data) in [(2, vec![1, 2, 3, 4]), (4, vec![0, 1, 0, 2, 0, 3, 0, 4])] {
        assert_same(&decode(&big(6, 0, storage, &data, [2, 2]), Some("h")).unwrap().heights, &expected);
    }
    let refused = |class, flags| defect(&big(class, flags, 2, &[1, 2, 3, 4], [2, 2]));
    for (class, flags, kind) in [(9, 0x02, "logical"), (4, 0, "text"), (1, 0, "a cell array")] {
        let expected = format!("mat: the content is `h: {kind}`, expected a matrix of real numbers");
        assert_eq!(refused(class, flags), expected);
    }
}

#[test]
fn a_damaged_mat_is_an_error() {
    let fault = |file: &[u8]| defect(file);
    let good = big(6, 0, 2, &[1, 2, 3, 4], [2, 2]);
    assert_eq!(fault(&good[..127]), "mat: no byte order at the end of the header");
    assert_eq!(fault(&good[..190]), "mat: the file holds 190 bytes, expected 192");
    assert_eq!(
        fault(&big(6, 0, 2, &[1, 2], [2, 2])),
        "mat: the part of the heights holds 2 bytes, expected 4"
    );
    assert_eq!(
        fault(&big(6, 0, 2, &[1], [1 << 20, 1 << 20])),
        "mat: 1099511627776 heights, at most 268435456 are read"
    );
    assert_eq!(
        fault(&big(6, 0, 16, &[1, 2, 3, 4], [2, 2])),
        "mat: the kind of an element is `16`, expected that of real numbers"
    );
    assert!(fault(b"MATLAB 7.3 MAT-file").contains("no HDF5 behind 512 bytes"));
    let packed = std::fs::read(corpus("mat", "profile")).unwrap();
    let whole = decode(&packed, None).unwrap();
    for end in 129..packed.len() {
        // After the first of the two variables the file may end.
        if let Ok(scan) = decode(&packed[..end], None) {
            assert_eq!((end, scan), (185, whole.clone()));
        }
    }
}

#[test]
fn arrays_of_an_npz_are_channels() {
    // Written by numpy 2.4.6.
    let scan = read(&corpus("npz", "one"), None, None).unwrap();
    assert_eq!((scan.format, scan.channel.as_str(), scan.lines), ("npz", "heights", Some(Axis::Y)));
    assert_same(&scan.heights, &z());
    let several = corpus("npz", "several");
    let Err(Error::NoChannel { available, .. }) = read(&several, None, None) else {
        panic!("no channel is chosen")
    };
    assert_eq!(available, ["a", "b"]);
    assert_same(&read(&several, Some("a"), None).unwrap().heights, &integers());
    assert_same(&read(&several, Some("b"), None).unwrap().heights, &z());
    let none = read(&corpus("npz", "none"), None, None).unwrap_err().to_string();
    assert!(none.ends_with("npz: the array is `1-dimensional`, expected 2-dimensional"), "{none}");
}

#[test]
fn an_npz_that_unpacks_to_more_than_it_says_is_an_error() {
    let short = files::npy("'<f8'", false, "(2, 2)", &[0; 1 << 20]);
    let archive = zipped(&[("z.npy", &short)]);
    assert!(defect(&archive).starts_with("npz: the array holds "), "{}", defect(&archive));
    assert_eq!(defect(&zipped(&[("z.npy", b"not an array")])), "npz: no array in a file of the archive");
}
