//! The law of a joint for other programs: a sweep of loads over samples of two rough surfaces as one table with its scatter.
//!
//! [`samples`] makes a study of a case: the same loads on seeds of generated surfaces, or on patches of measured ones.
//! [`Law::collect`] brings its finished cases together. Everything is taken at the same mean pressure: the median over the
//! samples, and the quantiles 0.16 and 0.84 as its band.
//!
//! **Datum.** The surfaces repeat, so the mean gap g is the distance of their mean planes, and holds nothing of the bulk of
//! the bodies. Programs with finite elements take the closure c = g₀ − g, which is 0 without pressure. The gap of first
//! touch is no good g₀: it is an extreme value, and grows with the sample. g₀ lies where the law, continued below the least
//! pressure p₁ as p = p₁ exp(−(g − g₁)/u₀) with u₀ = p₁/k_n down to p₁/100, and from there along its tangent, reaches p = 0;
//! of the median and of both edges of the band it is the largest.

mod clients; // files for other programs
mod coefficients; // constants of other laws that fit it
mod doubts; // reasons not to trust it
mod law; // samples as one law
mod quantities; // what the law is of
mod samples; // the study of a case
mod table; // joint.csv
mod warnings; // what is told of the samples

pub use clients::{Client, ClientFile, ClientSettings, Units};
pub use coefficients::{Coefficients, Exponential, GreenwoodTripp, PatirCheng};
pub use law::{Band, Checks, Edge, Law, Quantity};
pub use quantities::Kind;
pub use samples::{MAX_SAMPLES, samples};
