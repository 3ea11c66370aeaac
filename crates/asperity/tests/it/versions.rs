//! The version stands in several files, and is the same in all of them.

use std::fs;
use std::path::Path;

#[test]
fn all_files_of_a_release_have_the_version_of_the_workspace() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let read = |name: &str| fs::read_to_string(root.join(name)).unwrap();
    let version = env!("CARGO_PKG_VERSION");
    for (file, line) in [
        ("CITATION.cff", format!("version: {version}\n")),
        ("codemeta.json", format!("\"version\": \"{version}\"")),
        ("recipe/recipe.yaml", format!("version: \"{version}\"\n")),
        ("CHANGELOG.md", format!("{version}\n")),
    ] {
        assert!(read(file).contains(&line), "{file} has no `{}`", line.trim());
    }
    let cargo = read("Cargo.toml");
    let own = cargo.lines().filter(|line| line.starts_with("asperity") && line.contains("path = "));
    assert!(own.clone().count() > 5);
    own.for_each(|line| assert!(line.contains(&format!("version = \"{version}\"")), "{line}"));
}
