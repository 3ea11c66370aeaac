//! Mathematics that topography and mechanics share: transforms, work shared by threads, quadrature, sums,
//! rules of the active set.

pub mod active_set;
pub mod fft;
pub mod good_size;
pub mod kernel;
pub mod mixed;
pub mod parallel;
pub mod plans;
mod quadrature;
mod sparse_inverse;
pub mod sum;

pub use fft::RealFft2;
pub use good_size::good_size;
pub use kernel::Kernel;
pub use parallel::Bands;
pub use quadrature::{gauss_legendre, integrate};
pub use sparse_inverse::{ROWS_ABOVE, SparseInverse};
