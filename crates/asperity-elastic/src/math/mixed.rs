//! Convolutions in two precisions.

use std::sync::{Arc, OnceLock};

use asperity_base::math::mixed::{LastUsed, Mixed};

use crate::grid::{Field, SingleField};
use crate::math::{Convolution, Kernel, NearConvolution, NearKernel, TensorConvolution, TensorKernel};

/// A kernel of one field in two precisions. Convolutions of several shapes may share it.
pub(crate) struct MixedKernel {
    kernels: Mixed<Kernel<f64>, Kernel<f32>>,
    /// The near copy of the kernel, if there is one.
    near: OnceLock<Option<Arc<NearKernel>>>,
}

/// A tensor of kernels in two precisions.
pub(crate) type MixedTensorKernel = Mixed<TensorKernel<f64>, TensorKernel<f32>>;

impl MixedKernel {
    /// Creates the `kernel` in both precisions.
    pub(crate) fn new(kernel: Kernel<f64>) -> Arc<Self> {
        Arc::new(Self { kernels: Mixed::new(kernel), near: OnceLock::new() })
    }

    /// Returns the near copy of the kernel, designed on first use; none if no copy is near enough.
    fn near(&self) -> Option<&Arc<NearKernel>> {
        self.near.get_or_init(|| NearKernel::new(&self.kernels.double()).map(Arc::new)).as_ref()
    }
}

/// Convolution of fields of one shape in either precision. It holds the scratch memory of the precision used
/// last.
pub(crate) struct MixedConvolution {
    /// The kernel, which other convolutions may share.
    pub(crate) kernel: Arc<MixedKernel>,
    shape: [usize; 2],
    latest: LastUsed<Convolution<f64>, Convolution<f32>>,
    near: Option<NearConvolution>,
}

impl MixedConvolution {
    /// Creates the convolution of fields of `shape` with `kernel`; see [`Convolution::new`].
    pub(crate) fn new(kernel: Arc<MixedKernel>, shape: [usize; 2]) -> Self {
        Self { kernel, shape, latest: LastUsed::None, near: None }
    }

    /// Computes the convolution `output` of `input`, to 1e-15 of the largest output.
    pub(crate) fn apply(&mut self, input: &Field, output: &mut Field) {
        let Self { kernel, shape, latest, .. } = self;
        latest.double(|| Convolution::new(kernel.kernels.double(), *shape)).apply(input, output);
    }

    /// Computes the convolution `output` of `input` in half the time, to 3e-7 of the largest output.
    pub(crate) fn apply_single(&mut self, input: &SingleField, output: &mut SingleField) {
        let Self { kernel, shape, latest, .. } = self;
        let new = || Convolution::new(kernel.kernels.single(Kernel::to_single), *shape);
        latest.single(new).apply(input, output);
    }

    /// Returns the near copy of the kernel, if there is one.
    pub(crate) fn near_copy(&self) -> Option<&Arc<NearKernel>> {
        self.kernel.near()
    }

    /// Computes the `output` of the near copy, or of the convolution if there is none.
    pub(crate) fn apply_near(&mut self, input: &SingleField, output: &mut SingleField) {
        let Some(near) = self.kernel.near() else { return self.apply_single(input, output) };
        let shape = self.shape;
        self.near.get_or_insert_with(|| NearConvolution::new(Arc::clone(near), shape)).apply(input, output);
    }

    /// Releases the scratch memory.
    pub(crate) fn release(&mut self) {
        self.latest = LastUsed::None;
        self.near = None;
    }
}

/// Convolution of three fields of one shape with a tensor of kernels in either precision; see
/// [`MixedConvolution`] for one field.
pub(crate) struct MixedTensorConvolution {
    kernel: Arc<MixedTensorKernel>,
    shape: [usize; 2],
    latest: LastUsed<TensorConvolution<f64>, TensorConvolution<f32>>,
}

impl MixedTensorConvolution {
    /// Creates the convolution of fields of `shape` with `kernel`; see [`TensorConvolution::new`].
    pub(crate) fn new(kernel: Arc<MixedTensorKernel>, shape: [usize; 2]) -> Self {
        Self { kernel, shape, latest: LastUsed::None }
    }

    /// [`TensorConvolution::apply`] in double precision.
    pub(crate) fn apply(&mut self, input: [Option<&Field>; 3], output: [Option<&mut Field>; 3]) {
        let Self { kernel, shape, latest } = self;
        latest.double(|| TensorConvolution::new(kernel.double(), *shape)).apply(input, output);
    }

    /// [`TensorConvolution::apply`] in half the time, to 4e-7 of the largest output.
    pub(crate) fn apply_single(
        &mut self,
        input: [Option<&SingleField>; 3],
        output: [Option<&mut SingleField>; 3],
    ) {
        let Self { kernel, shape, latest } = self;
        let new = || TensorConvolution::new(kernel.single(TensorKernel::to_single), *shape);
        latest.single(new).apply(input, output);
    }
}
