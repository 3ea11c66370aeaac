//! Comparison of the program with closed forms.

use asperity::verification::{CASES, Check};
use pyo3::prelude::*;

use crate::work;

/// Returns name and source of each case.
#[pyfunction]
pub(crate) fn verification_cases() -> Vec<(&'static str, &'static str)> {
    CASES.iter().map(|case| (case.name, case.source)).collect()
}

/// Quantity, refined quantity, sizes, errors, order, expectation, and whether it is met.
type Row = (&'static str, &'static str, Vec<usize>, Vec<f64>, f64, String, bool);

/// Computes the case with this index. Returns its part of the table of `asperity verify`, its checks, and its
/// error, if it failed.
#[pyfunction]
pub(crate) fn verify(
    py: Python<'_>,
    index: usize,
    threads: usize,
) -> PyResult<(String, Vec<Row>, Option<String>)> {
    let case = &CASES[index];
    let checks = work::run(py, threads, None, |_| Ok((case.checks)()))?;
    let text = asperity_cli::verification_text(case, &checks);
    let row = |check: &Check| {
        let expected = asperity_cli::verification_expects(check);
        let Check { quantity, refinement, sizes, errors, .. } = check.clone();
        (quantity, refinement, sizes, errors, check.order(), expected, check.passed())
    };
    Ok(match checks {
        Ok(checks) => (text, checks.iter().map(row).collect(), None),
        Err(error) => (text, Vec::new(), Some(error.to_string())),
    })
}

/// Returns the last line of the table.
#[pyfunction]
pub(crate) fn verdict(passed: usize, failed: usize) -> String {
    asperity_cli::verification_verdict(passed, failed)
}
