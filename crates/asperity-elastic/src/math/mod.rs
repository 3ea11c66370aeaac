//! Mathematics of operators and solvers: convolutions, factorisations, elliptic integrals.

mod cholesky;
pub mod convolution;
pub mod elliptic;
mod extremes;
mod gmres;
mod indices;
pub(crate) mod mixed;
mod near_copy;
mod skew_convolution;
pub(crate) mod tensor_convolution;

pub(crate) use asperity_base::math::{
    Bands, Kernel, fft, gauss_legendre, good_size, integrate, parallel, sum,
};
pub use asperity_base::math::{ROWS_ABOVE, SparseInverse};
pub use cholesky::Cholesky;
pub use convolution::{Convolution, kernel_of_values};
pub(crate) use extremes::{extremes, largest};
pub use gmres::{Gmres, gmres};
pub(crate) use indices::indices_where;
pub(crate) use mixed::{MixedConvolution, MixedKernel, MixedTensorConvolution, MixedTensorKernel};
pub(crate) use near_copy::{NearConvolution, NearKernel};
pub use skew_convolution::{SkewConvolution, SkewKernel};
pub(crate) use tensor_convolution::{TensorConvolution, TensorKernel};
