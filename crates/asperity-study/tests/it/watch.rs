//! The observer of a contact sees its progress, and can stop it within an iteration.

use std::fs;
use std::path::{Path, PathBuf};

use asperity_base::Error;
use asperity_contact::motion::{Progress, Watch};
use asperity_study::{Case, Existing, SurfaceInput};

/// Stops as soon as a file exists.
struct Until(PathBuf);

impl Watch for Until {
    fn at(&self, _: &Progress) {}

    fn stop(&self) -> bool {
        self.0.exists()
    }
}

#[test]
fn what_was_interrupted_goes_on_from_the_rows_that_it_has_written_and_from_no_others() {
    let body = |form: &str, more: &str| {
        format!(
            "young = 210e9\npoisson = 0.3\ntopography = {{ form = {form}, shape = [12, 12], pitch = 1e-6 }}\n{more}"
        )
    };
    let ball = |more: &str, tables: &str| {
        let (plane, ball) = (body("\"flat\"", ""), body("\"sphere\", radius = 5e-5", more));
        format!("[lower]\n{plane}[upper]\n{ball}{tables}")
    };
    for (case, state, table) in [
        (
            ball("", "[contact]\nload = 5e-3\n[friction]\ncoefficient = 0.3\nforce = 1e-3\nincrements = 4\n"),
            "fields/state-0002.h5",
            "increments.csv",
        ),
        (
            ball(
                "",
                "[contact]\nload = 5e-3\n[friction]\ncoefficient = 0.3\nforce = 1e-3\nincrements = 4\ncoupling = \"none\"\n\
                 [adhesion]\nwork = 0.1\nrange = \"grid\"\n",
            ),
            "fields/state-0002.h5",
            "increments.csv",
        ),
        (
            ball(
                "wear = { coefficient = 1e-13 }\n",
                "[contact]\nload = 5e-3\n[friction]\ncoefficient = 0.1\n[sliding]\ndistance = 0.01\nupdates = 4\n",
            ),
            "fields/state-0002.h5",
            "updates.csv",
        ),
        (ball("", "[contact]\nloads = [1e-3, 2e-3, 5e-3]\n"), "sweep.csv", "sweep.csv"),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("out");
        let case = Case::parse(&case, Path::new("case.toml"), folder.path()).unwrap();
        let run = |existing: Existing, watch: &dyn Watch| {
            asperity_study::run(&case, SurfaceInput::default(), &out, existing, watch)
                .map(|(summary, _)| summary)
        };
        let stopped = run(Existing::Keep, &Until(out.join(state)));
        assert!(matches!(stopped, Err(Error::Interrupted)), "{table}: {stopped:?}");
        let path = out.join(table);
        let text = fs::read_to_string(&path).unwrap();
        let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
        let (row, _) = lines[1].rsplit_once(',').unwrap();
        lines[1] = format!("{row},0.125");
        fs::write(&path, lines.join("\n") + "\n").unwrap();
        let refused = run(Existing::Resume, &()).unwrap_err();
        assert!(
            matches!(&refused, Error::NotResumable { path: named, .. } if *named == path),
            "{table}: {refused:?}"
        );
        assert!(refused.to_string().ends_with("has been changed since it was written"), "{refused}");
        fs::write(&path, text).unwrap();
        run(Existing::Resume, &()).unwrap();
    }
}
