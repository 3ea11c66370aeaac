//! Messages and exit codes for bad input.

use std::fs;
use std::path::Path;

use toml::{Table, Value};

use crate::support::{as_promised, asperity, assert_has, files, folder_with, moving, refused, run};
use crate::support::{set, stderr};

/// Each row of `data/bad.toml` has the keys that a ball on a plane does not have, and the exit code, the
/// error and the hint that it must produce.
#[test]
fn every_bad_input_has_its_own_message() {
    let folder = tempfile::tempdir().unwrap();
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    for entry in fs::read_dir(data).unwrap() {
        let path = entry.unwrap().path();
        fs::copy(&path, folder.path().join(path.file_name().unwrap())).unwrap();
    }
    let before = files(folder.path());
    let file = folder.path().join("bad.toml");
    let rows = fs::read_to_string(&file).unwrap();
    let rows: Vec<_> = rows.split("### ").skip(1).map(|row| row.split_once('\n').unwrap()).collect();
    assert!(rows.len() >= 20, "{rows:?}");
    for (name, row) in rows {
        let promised: Vec<&str> = row.lines().filter_map(|line| line.strip_prefix("# ")).collect();
        let code: i32 = promised[0].strip_prefix("exit code ").unwrap().parse().unwrap();
        fs::write(&file, of_ball(row)).unwrap();
        let output = run(&folder, "bad.toml --out out");
        let messages: Vec<String> = stderr(&output)
            .lines()
            .filter(|line| line.starts_with("error: ") || line.starts_with("hint: "))
            .map(str::to_owned)
            .collect();
        let kept =
            promised[1..].iter().zip(&messages).all(|(promised, message)| as_promised(promised, message));
        let all = messages.len() == promised.len() - 1;
        assert!(kept && all && output.status.code() == Some(code), "{name}: {promised:#?}\n{messages:#?}");
        assert!(output.stdout.is_empty(), "{name}");
        // What is wrong before anything is computed leaves no directory behind.
        let out = folder.path().join("out");
        assert!(code == 1 || !out.exists(), "{name}");
        let _ = fs::remove_dir_all(out);
    }
    assert_eq!(files(folder.path()), before);
}

/// Returns the case of a row: a ball on a plane, with the keys of the row in place of its own.
fn of_ball(row: &str) -> String {
    let mut case: Table = r#"
        [lower]
        young = "210 GPa"
        poisson = 0.3
        hardness = "4 GPa"
        topography = { form = "flat", shape = [8, 8], pitch = "1 um" }
        [upper]
        young = "210 GPa"
        poisson = 0.3
        topography = { form = "sphere", radius = "1 mm", shape = [8, 8], pitch = "1 um" }
        [contact]
        load = "1 mN"
    "#
    .parse()
    .unwrap();
    for (key, value) in row.parse::<Table>().unwrap() {
        match (case.get_mut(&key), value) {
            (Some(Value::Table(body)), Value::Table(keys)) if key != "contact" => body.extend(keys),
            (_, value) => _ = case.insert(key, value),
        }
    }
    case.to_string()
}

#[test]
fn bad_usage_of_run_is_exit_code_2() {
    let folder = folder_with("case.toml", &moving(1, 8));
    for arguments in
        ["", "nowhere.toml", "case.toml --threads 0", "case.toml --threads many", "case.toml --example hertz"]
    {
        refused(&run(&folder, arguments));
    }
    assert_eq!(files(folder.path()), set("case.toml"));
}

#[test]
fn a_topography_where_a_case_is_expected_is_named_with_the_commands_for_it() {
    let folder = folder_with("case.toml", &moving(1, 8));
    let write = |name: &str, content: &[u8]| fs::write(folder.path().join(name), content).unwrap();
    write("grid.asc", b"ncols 2\nnrows 2\ncellsize 1e-6\n1 2\n3 4\n");
    write("points.csv", b"x,y,z\n0,0,1\n0,1,2\n1,0,3\n1,1,4\n");
    write("note.pdf", b"%PDF-1.7");
    write("unknown.bin", b"\x00\xff\x01");
    write("broken.toml", b"[lower\nyoung = 1\n");
    for (command, expected) in [("check", "a case file"), ("run", "a case file"), ("study", "a study file")] {
        for (file, told) in [
            ("grid.asc", "is a topography (asc, 2 × 2 heights), expected"),
            ("points.csv", "is a topography (csv, 2 × 2 heights), expected"),
            ("note.pdf", "it is a document (PDF)"),
            ("unknown.bin", "it is binary, of no known format"),
            ("broken.toml", "unclosed table"),
        ] {
            let error = refused(&asperity(&folder, &format!("{command} {file}")));
            assert_has(&error, told);
            let describes = format!("`asperity surface info {file}` describes it");
            assert_eq!(error.contains(expected), file != "broken.toml", "{error}");
            assert_eq!(error.contains(&describes), told.contains("topography"), "{error}");
        }
    }
}
