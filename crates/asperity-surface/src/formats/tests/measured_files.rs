//! Measured files, compared with the heights that other programs read. `ASPERITY_TOPOGRAPHIES` names their
//! folder.

use super::*;

#[test]
#[ignore = "reads measured files, which are not part of the repository"]
fn an_x3p_by_mountainsmap_is_read_as_others_read_it() {
    assert_as_expected("x3p-2.x3p", "x3p", 1.0);
}

#[test]
#[ignore = "reads measured files, which are not part of the repository"]
fn a_sur_by_mountainsmap_is_read_as_others_read_it() {
    assert_as_expected("sur-2.sur", "sur", 1e-3);
}

#[test]
#[ignore = "reads measured files, which are not part of the repository"]
fn the_pits_of_a_measured_map_are_the_first_spikes_to_go() {
    let path = measured("sur-2.sur");
    let scan = read(&path, None, None).unwrap();
    let grid = Grid::new([563, 484], scan.pitch.unwrap()).unwrap();
    let measured = Topography::new(grid, scan.heights).unwrap();
    let cleared = measured.clone().despike(8.0).unwrap();
    // 98 samples in a few pits, down to 1.25 µm, of a surface whose other samples lie within 0.1 µm of their
    // mean.
    let middle = measured.mean();
    let deep = |map: &Topography| map.heights().iter().filter(|z| **z < middle - 1e-7).count();
    assert_eq!([deep(&measured), deep(&cleared)], [98, 0]);
    assert!(cleared.undefined() - measured.undefined() < 3000);
    let sku = |map: &Topography| {
        let middle = map.mean();
        map.heights().iter().filter(|z| !z.is_nan()).fold([0.0; 2], |[m2, m4], z| {
            let height = z - middle;
            [m2 + height.powi(2), m4 + height.powi(4)]
        })
    };
    let [m2, m4] = sku(&cleared);
    assert!(m4 * (cleared.heights().len() - cleared.undefined()) as f64 / (m2 * m2) < 3.0);
}

#[test]
#[ignore = "reads measured files, which are not part of the repository"]
fn an_npy_is_read_as_numpy_reads_it() {
    assert_as_expected("example-2d.npy", "npy", 1.0);
}

#[test]
#[ignore = "reads measured files, which are not part of the repository"]
fn a_table_of_points_is_read_as_others_read_it() {
    assert_as_expected("xyz-1.txt", "xyz", 1.0);
}

#[test]
#[ignore = "reads measured files, which are not part of the repository"]
fn nanoscope_files_are_read_as_others_read_them() {
    for name in ["di-2.di", "di-3.di", "di-4.di"] {
        assert_as_expected(name, "nanoscope", 1e-9);
    }
    let path = measured("di-2.di");
    let scan = read(&path, Some("Height 2"), None).unwrap();
    assert_eq!(scan.channels, ["Height", "Height 2", "Deflection"]);
    assert_relative_eq!(scan.heights[[0, 0]], 38.854_639_766_813_97e-9, max_relative = 1e-12);
}

#[test]
#[ignore = "reads measured files, which are not part of the repository"]
fn an_igor_wave_is_read_as_others_read_it() {
    assert_as_expected("10x10-one_channel_without_name.ibw", "ibw", 1.0);
}

#[test]
#[ignore = "reads measured files, which are not part of the repository"]
fn a_nid_is_read_as_others_read_it() {
    assert_as_expected("nid-1.nid", "nid", 1.0);
    let path = measured("nid-1.nid");
    let scan = read(&path, Some("Scan backward (Z-AxisSensor)"), None).unwrap();
    assert_eq!(scan.channels.len(), 4);
    assert_relative_eq!(scan.heights[[0, 0]], -2.871_063_219_156_861e-6, max_relative = 1e-12);
}

#[test]
#[ignore = "reads measured files, which are not part of the repository"]
fn an_stp_of_wsxm_is_read_as_others_read_it() {
    assert_as_expected("stp-1.stp", "wsxm", 1e-9);
}

#[test]
#[ignore = "reads measured files, which are not part of the repository"]
fn an_mi_is_read_as_others_read_it() {
    assert_as_expected("mi-1.mi", "mi", 1e-6);
}

#[test]
#[ignore = "reads measured files, which are not part of the repository"]
fn a_text_of_a_holographic_microscope_is_read() {
    let path = measured("matrix-4.txt.gz");
    let scan = read(&path, None, None).unwrap();
    assert_eq!((scan.format, scan.heights.dim(), scan.pitch), ("koala", (75, 305), Some([3.69862e-7; 2])));
    assert_relative_eq!(scan.heights[[1, 0]], -4.596037 * 2.91818e-8, max_relative = 1e-15);
}

#[test]
#[ignore = "reads measured files, which are not part of the repository"]
fn an_sdf_is_read_as_others_read_it() {
    assert_as_expected("sdf-1.sdf", "sdf", 1e-6);
}

#[test]
#[ignore = "reads measured files, which are not part of the repository"]
fn an_al3d_is_read_as_others_read_it() {
    assert_as_expected("al3d-1.al3d", "al3d", 1.0);
}

#[test]
#[ignore = "reads measured files, which are not part of the repository"]
fn an_frt_is_read_as_others_read_it() {
    assert_as_expected("frt-2.frt", "frt", 1.0);
}

#[test]
#[ignore = "reads measured files, which are not part of the repository"]
fn a_metropro_dat_is_read_as_others_read_it() {
    assert_as_expected("metropro-1.dat", "metropro", 1.0);
}

#[test]
#[ignore = "reads measured files, which are not part of the repository"]
fn an_opd_is_read_as_others_read_it() {
    assert_as_expected("opd-1.opd", "opd", 1e-3);
}

#[test]
#[ignore = "reads measured files, which are not part of the repository"]
fn a_plu_is_read_as_others_read_it() {
    assert_as_expected("plu-1.plu", "plu", 1e-6);
}

#[test]
#[ignore = "reads measured files, which are not part of the repository"]
fn a_tmd_is_read_as_others_read_it() {
    assert_as_expected("tmd-1.tmd", "tmd", 1e-3);
}

#[test]
#[ignore = "reads measured files, which are not part of the repository"]
fn documents_of_mountains_are_read_as_others_read_them() {
    assert_as_expected("mnt-2.mnt", "mnt", 1e-6);
}

#[test]
#[ignore = "reads measured files, which are not part of the repository"]
fn an_opdx_is_read_as_others_read_it() {
    assert_as_expected("opdx-3.opdx", "opdx", 1e-6);
}

#[test]
#[ignore = "reads measured files, which are not part of the repository"]
fn an_nms_is_read_as_others_read_it_but_for_its_steps() {
    // The pitch is 312.5 nm, 160 µm with a 100 × lens; the other program reads the same number in mm.
    let path = measured("nms-1.nms");
    let scan = read(&path, None, None).unwrap();
    assert_eq!((scan.format, scan.heights.dim()), ("nms", (512, 512)));
    assert_relative_eq!(512.0 * scan.pitch.unwrap()[0], 159.999_995_474_890_95e-6, max_relative = 1e-12);
    for (at, expected) in
        [((0, 0), 2.689124584197998), ((1, 0), 2.693327243281454), ((0, 1), 2.692517092132836)]
    {
        assert_relative_eq!(scan.heights[at], expected * 1e-6, max_relative = 1e-12);
    }
    assert_relative_eq!(scan.heights.mean().unwrap(), 4.344685260505126e-6, max_relative = 1e-12);
}

#[test]
#[ignore = "reads measured files, which are not part of the repository"]
fn a_netcdf_is_read_as_others_read_it() {
    assert_as_expected("nc-1.nc", "netcdf", 1e-9);
}

/// Path of a measured file.
fn measured(name: &str) -> PathBuf {
    let folder = std::env::var_os("ASPERITY_TOPOGRAPHIES")
        .expect("ASPERITY_TOPOGRAPHIES names the folder of measured files");
    PathBuf::from(folder).join(name)
}

/// Compares the file with the heights read by another program (`expected.json`), given in `unit`.
#[track_caller]
fn assert_as_expected(name: &str, format: &str, unit: f64) {
    let (path, expected) = (measured(name), measured("expected.json"));
    let expected: serde_json::Value = serde_json::from_slice(&std::fs::read(expected).unwrap()).unwrap();
    let expected = &expected[name];
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    let scan = read(&path, None, None).unwrap();
    assert_eq!((scan.format, &scan.channels[0]), (format, &scan.channel));
    let (nx, ny) = scan.heights.dim();
    // A profile is a map of one line.
    let shape = if ny == 1 { serde_json::json!([nx]) } else { serde_json::json!([nx, ny]) };
    assert_eq!(shape, expected["shape"]);
    if let Some(pitch) = scan.pitch {
        for ((pitch, n), size) in
            pitch.iter().zip([nx, ny]).zip(expected["physical_sizes_in_file_unit"].as_array().unwrap())
        {
            assert_relative_eq!(pitch * n as f64, number(size) * unit, max_relative = 1e-12);
        }
    }
    let there: Vec<f64> = scan.heights.iter().copied().filter(|height| !height.is_nan()).collect();
    assert_eq!(scan.heights.len() - there.len(), expected["undefined"].as_u64().unwrap() as usize);
    let least = there.iter().copied().fold(f64::INFINITY, f64::min);
    let largest = there.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let mean = there.iter().sum::<f64>() / there.len() as f64;
    let scale = largest.abs().max(least.abs());
    for (found, key) in [(least, "min"), (largest, "max"), (mean, "mean")] {
        assert_relative_eq!(
            found,
            number(&expected[key]) * unit,
            epsilon = 1e-12 * scale,
            max_relative = 1e-12
        );
    }
    if expected["corners"].is_null() {
        return;
    }
    let corners =
        [((0, 0), "0,0"), ((nx - 1, 0), "-1,0"), ((0, ny - 1), "0,-1"), ((nx - 1, ny - 1), "-1,-1")];
    for (at, key) in corners.into_iter().chain([((1, 0), "1,0"), ((0, 1), "0,1")]) {
        let found = scan.heights[at];
        match &expected["corners"][format!("h[{key}]")] {
            serde_json::Value::Null => assert!(found.is_nan(), "h[{key}] = {found}, expected none"),
            corner => assert_relative_eq!(found, number(corner) * unit, max_relative = 1e-12),
        }
    }
}
