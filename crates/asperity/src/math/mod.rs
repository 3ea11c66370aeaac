//! Mathematics that several modules share.

pub mod elliptic;
pub mod fft;
pub mod good_size;

pub use fft::RealFft2;
pub use good_size::good_size;
