//! One convolution in two precisions.

use std::sync::{Arc, OnceLock};

use crate::grid::{Field, SingleField};
use crate::math::{Convolution, Kernel};

/// A kernel in double precision, and in single once that is asked for. Convolutions of several shapes may share it.
pub(crate) struct MixedKernel {
    double: Arc<Kernel<f64>>,
    single: OnceLock<Arc<Kernel<f32>>>,
}

impl MixedKernel {
    /// The `kernel`, in double and in single precision.
    pub(crate) fn new(kernel: Kernel<f64>) -> Arc<Self> {
        Arc::new(Self { double: Arc::new(kernel), single: OnceLock::new() })
    }

    fn double(&self) -> Arc<Kernel<f64>> {
        Arc::clone(&self.double)
    }

    fn single(&self) -> Arc<Kernel<f32>> {
        Arc::clone(self.single.get_or_init(|| Arc::new(self.double.to_single())))
    }
}

/// Convolution of fields of one shape in either precision. It holds the scratch of the one that was asked for last: the two take
/// turns.
pub(crate) struct MixedConvolution {
    /// The kernel, which other convolutions may share.
    pub(crate) kernel: Arc<MixedKernel>,
    shape: [usize; 2],
    latest: Latest,
}

enum Latest {
    None,
    Double(Convolution<f64>),
    Single(Convolution<f32>),
}

impl MixedConvolution {
    /// The convolution of fields of `shape` with `kernel`; see [`Convolution::new`].
    pub(crate) fn new(kernel: Arc<MixedKernel>, shape: [usize; 2]) -> Self {
        Self { kernel, shape, latest: Latest::None }
    }

    /// Writes the convolution of `input` into `output`, to 1e-15 of the largest output.
    pub(crate) fn apply(&mut self, input: &Field, output: &mut Field) {
        if !matches!(self.latest, Latest::Double(_)) {
            self.latest = Latest::None;
            self.latest = Latest::Double(Convolution::new(self.kernel.double(), self.shape));
        }
        if let Latest::Double(convolution) = &mut self.latest {
            convolution.apply(input, output);
        }
    }

    /// Writes the convolution of `input` into `output` in half the time, to 3e-7 of the largest output.
    pub(crate) fn apply_single(&mut self, input: &SingleField, output: &mut SingleField) {
        if !matches!(self.latest, Latest::Single(_)) {
            self.latest = Latest::None;
            self.latest = Latest::Single(Convolution::new(self.kernel.single(), self.shape));
        }
        if let Latest::Single(convolution) = &mut self.latest {
            convolution.apply(input, output);
        }
    }
}
