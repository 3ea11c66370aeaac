//! Mathematics that several modules share.

pub mod convolution;
pub mod elliptic;
pub mod fft;
pub mod good_size;
pub mod mixed;
mod quadrature;
pub mod sum;
pub mod tensor_convolution;

pub use convolution::{Convolution, Kernel};
pub use fft::RealFft2;
pub use good_size::good_size;
pub use mixed::{MixedConvolution, MixedKernel};
pub(crate) use quadrature::integrate;
pub use tensor_convolution::{TensorConvolution, TensorKernel};
