//! Mathematics shared by several modules.

mod cholesky;
pub(crate) mod convolution;
pub(crate) mod elliptic;
mod gathered;
mod gmres;
mod indices;
pub(crate) mod mixed;
mod near_copy;
mod planes;
mod skew_convolution;
mod sparse_inverse;
pub(crate) mod tensor_convolution;

pub(crate) use asperity_base::math::{
    Bands, Kernel, RealFft2, fft, gauss_legendre, good_size, integrate, parallel, sum,
};
pub(crate) use cholesky::Cholesky;
pub(crate) use convolution::{Convolution, kernel_of_values};
pub(crate) use gathered::gathered;
pub(crate) use gmres::{Gmres, gmres};
pub(crate) use indices::indices_where;
pub(crate) use mixed::{MixedConvolution, MixedKernel, MixedTensorConvolution, MixedTensorKernel};
pub(crate) use near_copy::{NearConvolution, NearKernel};
pub(crate) use planes::{Planes, together};
pub(crate) use skew_convolution::{SkewConvolution, SkewKernel};
pub(crate) use sparse_inverse::{ROWS_ABOVE, SparseInverse};
pub(crate) use tensor_convolution::{TensorConvolution, TensorKernel};
