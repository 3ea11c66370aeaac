//! `asperity verify`: closed-form cases, their errors and orders of convergence.

use std::io::{self, Write};

use asperity::Result;
use asperity::verification::{CASES, Case, Check, Expected};

use crate::report::{Failure, Outcome, written};

/// Computes all cases and prints each when it is finished.
pub(crate) fn verify() -> Outcome {
    let Tally { passed, failed } = match table(&mut io::stdout().lock(), CASES) {
        Ok(tally) => tally,
        Err(error) => return written(Err(error)),
    };
    if failed == 0 { Ok(()) } else { Err(Failure::Checks { failed, all: passed + failed }) }
}

/// Number of checks by verdict.
struct Tally {
    passed: usize,
    failed: usize,
}

/// Writes the table.
fn table(out: &mut impl Write, cases: &[Case]) -> io::Result<Tally> {
    let (mut passed, mut failed) = (0, 0);
    for case in cases {
        // The present case has a name already.
        writeln!(out, "{}", title(case))?;
        let checks = (case.checks)();
        writeln!(out, "{}", body(&checks))?;
        match &checks {
            Ok(checks) => {
                let good = checks.iter().filter(|check| check.passed()).count();
                (passed, failed) = (passed + good, failed + checks.len() - good);
            }
            Err(_) => failed += 1,
        }
    }
    writeln!(out, "{}", verdict(passed, failed))?;
    Ok(Tally { passed, failed })
}

/// Returns the lines of a case and its checks, with an empty line at the end.
pub fn text(case: &Case, checks: &Result<Vec<Check>>) -> String {
    format!("{}\n{}\n", title(case), body(checks))
}

/// Returns the last line of the table.
pub fn verdict(passed: usize, failed: usize) -> String {
    match failed {
        0 => format!("all {passed} checks passed"),
        _ => format!("{failed} of {} checks FAILED", passed + failed),
    }
}

/// Describes the expectation of a check.
pub fn expected(check: &Check) -> String {
    match &check.expected {
        Expected::RoundOff(tolerance) => format!("|error| ≤ {tolerance:.0e}"),
        Expected::Counted(cells) => format!("|error| ≤ {cells}/({})", check.refinement),
        Expected::Order { order, finest } => {
            format!("order {:.1} to {:.1}, last ≤ {finest:.0e}", order.start(), order.end())
        }
    }
}

fn title(case: &Case) -> String {
    format!("{} — {}", case.name, case.source)
}

/// Returns the lines of a case below its name.
fn body(checks: &Result<Vec<Check>>) -> String {
    match checks {
        Ok(checks) => {
            let sizes = |first: &Check| {
                let sizes: String = first.sizes.iter().map(|n| format!("{n:>9}")).collect();
                format!("  {:<22}{sizes}   order\n", first.refinement)
            };
            let rows = checks.iter().map(|check| format!("  {}\n", row(check)));
            checks.first().map(sizes).into_iter().chain(rows).collect()
        }
        Err(error) => format!("  FAILED: {error}\n"),
    }
}

/// Returns quantity, errors, order if one is expected, expectation and verdict.
fn row(check: &Check) -> String {
    let errors: String = check.errors.iter().map(|error| format!("{error:>9.1e}")).collect();
    let order = match &check.expected {
        Expected::Order { .. } => format!("{:.2}", check.order()),
        _ => String::new(),
    };
    let verdict = if check.passed() { "ok" } else { "FAILED" };
    format!("{:<22}{errors}   {order:<5}  {:<32} {verdict}", check.quantity, expected(check))
}

#[cfg(test)]
mod tests {
    use asperity::Error;

    use super::*;

    fn written(cases: &[Case]) -> (String, bool) {
        let mut out = Vec::new();
        let passed = table(&mut out, cases).unwrap();
        (String::from_utf8(out).unwrap(), passed.failed == 0)
    }

    fn second_order(order_of_the_last: f64) -> Vec<Check> {
        vec![Check {
            quantity: "peak pressure",
            refinement: "a/Δx",
            sizes: vec![8, 16],
            errors: vec![-4e-3, -4e-3 * 0.5f64.powf(order_of_the_last)],
            expected: Expected::Order { order: 1.8..=2.2, finest: 1e-2 },
        }]
    }

    #[test]
    fn a_case_is_shown_with_its_errors_their_order_and_the_verdict() {
        let case = Case { name: "sphere", source: "Hertz (1882)", checks: || Ok(second_order(2.0)) };
        let (text, passed) = written(&[case]);
        let expected = "\
sphere — Hertz (1882)
  a/Δx                          8       16   order
  peak pressure           -4.0e-3  -1.0e-3   2.00   order 1.8 to 2.2, last ≤ 1e-2    ok

all 1 checks passed
";
        assert_eq!(text, expected);
        assert!(passed);
    }

    #[test]
    fn a_wrong_order_and_a_case_without_an_answer_fail() {
        let wrong = Case { name: "", source: "", checks: || Ok(second_order(1.0)) };
        let error = || Err(Error::NotConverged { iterations: 3, residual: 1.0, tolerance: 1e-6 });
        let none = Case { name: "", source: "", checks: error };
        let (text, passed) = written(&[wrong, none]);
        assert!(text.contains("1.00   order 1.8 to 2.2, last ≤ 1e-2    FAILED"), "{text}");
        assert!(text.contains("  FAILED: no equilibrium after 3 iterations"), "{text}");
        assert!(text.ends_with("2 of 2 checks FAILED\n"), "{text}");
        assert!(!passed);
    }
}
