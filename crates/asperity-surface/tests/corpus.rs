//! Inputs found by fuzzing, and its seeds, also pass on a stable toolchain: `fuzz/corpus`.

use std::path::Path;

#[path = "../fuzz/src/lib.rs"]
#[expect(unreachable_pub, reason = "a crate of its own elsewhere")]
mod fuzz;

#[test]
fn every_file_of_the_corpora_is_answered() {
    let corpora = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus");
    for (target, run) in fuzz::TARGETS {
        let mut files = 0;
        for file in std::fs::read_dir(corpora.join(target)).unwrap() {
            let path = file.unwrap().path();
            let bytes = std::fs::read(&path).unwrap();
            assert!(std::panic::catch_unwind(|| run(&bytes)).is_ok(), "{}", path.display());
            files += 1;
        }
        assert!(files > 0, "the corpus of {target} is empty");
    }
}
