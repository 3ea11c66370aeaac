//! Dense programs for contacts of bodies that creep.

use asperity_contact::viscoelastic::{Creep, CreepTerm, Relaxation, RelaxationTerm};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

/// A random body with one to three times, E₀ = 1.
pub(crate) fn relaxation(random: &mut ChaCha8Rng) -> Relaxation {
    let terms = (0..random.random_range(1..4)).map(|_| RelaxationTerm {
        modulus: 10f64.powf(random.random_range(-0.5..1.2)),
        time: 10f64.powf(random.random_range(-2.0..1.0)),
    });
    Relaxation::new(1.0, terms.collect::<Vec<_>>()).unwrap()
}

/// Solves the dense equations A x = b by elimination with row pivots.
fn eliminated(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Vec<f64> {
    let n = b.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|i, j| a[*i][k].abs().total_cmp(&a[*j][k].abs())).unwrap();
        a.swap(k, pivot);
        b.swap(k, pivot);
        for i in k + 1..n {
            let factor = a[i][k] / a[k][k];
            let (above, below) = a.split_at_mut(i);
            below[0][k..].iter_mut().zip(&above[k][k..]).for_each(|(x, y)| *x -= factor * y);
            b[i] -= factor * b[k];
        }
    }
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| a[k][j] * b[j]).sum();
        b[k] = (b[k] - known) / a[k][k];
    }
    b
}

/// The pressures p ≥ 0 with h + Cp − δ ≥ 0, by Murty's pivots of least index, which end for every matrix of
/// positive principal minors.
pub(crate) fn dense(c: &[Vec<f64>], gap: &[f64], approach: f64) -> Vec<f64> {
    let n = gap.len();
    let mut touches = vec![false; n];
    for _ in 0..100_000 {
        let cells: Vec<usize> = (0..n).filter(|cell| touches[*cell]).collect();
        let a = cells.iter().map(|i| cells.iter().map(|j| c[*i][*j]).collect()).collect();
        let found = eliminated(a, cells.iter().map(|i| approach - gap[*i]).collect());
        let mut p = vec![0.0; n];
        cells.iter().zip(found).for_each(|(cell, value)| p[*cell] = value);
        let is_wrong = |cell: &usize| {
            if touches[*cell] {
                p[*cell] < -1e-12
            } else {
                gap[*cell] + c[*cell].iter().zip(&p).map(|(c, p)| c * p).sum::<f64>() - approach < -1e-12
            }
        };
        match (0..n).find(is_wrong) {
            None => return p,
            Some(cell) => touches[cell] = !touches[cell],
        }
    }
    panic!("no end");
}

/// Mean of the compliance J(t − s) over the times s from `begin` to `end`, or its value where these are one
/// time.
pub(crate) fn mean_compliance(creep: &Creep, t: f64, begin: f64, end: f64) -> f64 {
    let term = |term: &CreepTerm| {
        let e = |s: f64| ((s - t) / term.time).exp();
        let left = if end > begin { term.time * (e(end) - e(begin)) / (end - begin) } else { e(end) };
        term.compliance * (1.0 - left)
    };
    creep.glassy + creep.terms.iter().map(term).sum::<f64>()
}
