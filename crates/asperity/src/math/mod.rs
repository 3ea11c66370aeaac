//! Mathematics shared by several modules.

mod cholesky;
pub(crate) mod convolution;
pub(crate) mod elliptic;
pub(crate) mod fft;
mod gathered;
mod gmres;
pub(crate) mod good_size;
mod indices;
pub(crate) mod mixed;
pub(crate) mod parallel;
mod planes;
mod quadrature;
mod skew_convolution;
mod slab_convolution;
mod slab_transform;
mod sparse_inverse;
pub(crate) mod sum;
pub(crate) mod tensor_convolution;
mod transposition;

pub(crate) use cholesky::Cholesky;
pub(crate) use convolution::{Convolution, Kernel};
pub(crate) use fft::RealFft2;
pub(crate) use gathered::gathered;
pub(crate) use gmres::gmres;
pub(crate) use good_size::good_size;
pub(crate) use indices::indices_where;
pub(crate) use mixed::{MixedConvolution, MixedKernel, MixedTensorConvolution, MixedTensorKernel};
pub(crate) use parallel::Bands;
pub(crate) use planes::{Planes, together};
pub(crate) use quadrature::{gauss_legendre, integrate};
pub(crate) use skew_convolution::{SkewConvolution, SkewKernel};
pub(crate) use slab_convolution::SlabConvolution;
pub(crate) use slab_transform::SlabTransform;
pub(crate) use sparse_inverse::{ROWS_ABOVE, SparseInverse};
pub(crate) use tensor_convolution::{TensorConvolution, TensorKernel};
