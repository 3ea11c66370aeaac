//! Mathematics shared by several modules, beside that of `asperity_elastic`.

mod dissection;
mod gathered;
mod planes;

pub(crate) use asperity_base::math::{
    Bands, Kernel, RealFft2, fft, gauss_legendre, good_size, integrate, parallel, sum,
};
pub(crate) use asperity_elastic::math::{
    Cholesky, Convolution, ROWS_ABOVE, SkewConvolution, SkewKernel, SparseInverse, convolution, elliptic,
    gmres, kernel_of_values,
};
pub(crate) use dissection::{Dissection, Front, find_borders};
pub(crate) use gathered::gathered;
pub(crate) use planes::{Planes, together};
