//! Residual stress of plastic strain in layers, wave by wave, by an upward and a downward layer recursion.
//!
//! Consider the frame of a wave vector q (1 along it, 2 across, 3 = z) and a traceless eigenstress τ = 2με, distributed
//! over all depths z′ of an infinite body. Its stress at z consists of the sums
//!
//! ```text
//! e0 = (q/4) ∫ e^−ζ τ dz′     e1 = (q/4) ∫ ζ e^−ζ τ dz′     ζ = q|z − z′|
//! o0, o1: the same with the sign of z − z′
//! ```
//!
//! With k = ν/(1 − ν), a = 1 + k, the difference d = τ11 − τ33, and i τ13, i τ23 in place of τ13, τ23 so that everything is
//! real:
//!
//! ```text
//! σ11 = (k + 3) e0[11] − (3k + 1) e0[33] − a e1[d] + 4a o0[13] − 2a o1[13] + k τ33 − τ11
//! σ22 = 2k (e0[11] − e0[33]) + 4k o0[13] + k τ33 − τ22
//! σ33 = (k − 1)(e0[11] + e0[33]) + a e1[d] + 2a o1[13]
//! σ13 = −2 o0[11] + 2k o0[33] + a o1[d] − 2a (e0 − e1)[13]
//! σ12 = 2 e0[12] + 2 o0[23] − τ12       σ23 = −2 o0[12] − 2 e0[23]
//! ```
//!
//! Two terms are added: the stress of the mirror image (τ13, τ23 reversed, ζ = q(z + z′), no local term), and the stress
//! under the pressure that makes the surface traction-free. Chiu, J. Appl. Mech. 44, 587 (1977); 45, 302 (1978).
//!
//! The strain is uniform in each layer, and the stress is its mean over each layer, so that the operator is symmetric. Sums
//! passed through a layer of thickness X/q decay by e^−X. The cost is linear in the number of layers, and nothing is
//! stored.

use asperity_transforms::num_complex::Complex64;

use super::lanes::Lanes;
use super::layers::Layers;
use crate::math::Planes;
use crate::math::fft::angular_frequency;
use crate::units::{Metre, Pascal};

/// Components of a symmetric tensor.
const COMPONENTS: usize = 6;

/// Parameters of the residual stress other than the strain.
pub(super) struct Sweep {
    thickness: Vec<Metre>,
    /// 2μ.
    twice_shear: Pascal,
    poisson: f64,
    /// Shape and pitch of one period.
    shape: [usize; 2],
    pitch: [Metre; 2],
}

/// Scratch memory for the recursions of a wave.
pub(super) struct SweepScratch {
    decay: Vec<Decay>,
    tau: Vec<[Lanes; 5]>,
    /// Sums from below: e0 of 11, 33, 13, 12, 23, e1 of d and 13.
    below: Vec<[Lanes; 7]>,
    stress: Vec<[Lanes; COMPONENTS]>,
}

/// Decay of a wave over a layer of thickness X/q.
#[derive(Clone, Copy, Default)]
struct Decay {
    /// e^−X.
    whole: f64,
    /// X.
    thickness: f64,
    /// Means over the layer of e^−t and t e^−t, t from 0 to X.
    mean: [f64; 2],
    /// Contribution of the layer to the sums: (q/4) ∫ of the same.
    given: [f64; 2],
    /// Contribution of the layer to itself: (q/4) times the mean of ∫ e^−ζ and ∫ ζ e^−ζ.
    own: [f64; 2],
}

impl Decay {
    /// Computes the decay with absolute errors of about 1e-16, also for terms that vanish with X.
    fn over(thickness: f64) -> Self {
        let lost = -(-thickness).exp_m1();
        let whole = 1.0 - lost;
        let mean = lost / thickness;
        Self {
            whole,
            thickness,
            mean: [mean, mean - whole],
            given: [0.25 * lost, 0.25 * (lost - thickness * whole)],
            own: [0.5 * (1.0 - mean), 0.5 * (1.0 + whole) - mean],
        }
    }
}

impl Sweep {
    /// Creates a body with these constants, whose surface has a period of `shape` cells of `pitch`.
    pub(super) fn new(
        layers: &Layers,
        young: Pascal,
        poisson: f64,
        shape: [usize; 2],
        pitch: [Metre; 2],
    ) -> Self {
        let thickness = (0..layers.count()).map(|layer| layers.thickness(layer)).collect();
        Self { thickness, twice_shear: young / (1.0 + poisson), poisson, shape, pitch }
    }

    pub(super) fn scratch(&self) -> SweepScratch {
        let layers = self.thickness.len();
        SweepScratch {
            decay: vec![Decay::default(); layers],
            tau: vec![Default::default(); layers],
            below: vec![Default::default(); layers],
            stress: vec![Default::default(); layers],
        }
    }

    /// Replaces plastic strain by residual stress, for all waves at `ky`: `columns` of [`Planes`], six components for each
    /// layer. The strain is traceless, so that its zz is not read.
    pub(super) fn residual(
        &self,
        planes: &Planes,
        ky: usize,
        columns: &mut [Complex64],
        scratch: &mut SweepScratch,
    ) {
        let [nx, ny] = self.shape;
        let stride = planes.stride();
        let qy = angular_frequency(ky, ny, self.pitch[1]);
        for kx in 0..=nx / 2 {
            let qx = angular_frequency(kx, nx, self.pitch[0]);
            let opposite = (nx - kx) % nx;
            if kx == 0 && ky == 0 {
                self.uniform(columns, stride);
                continue;
            }
            scratch.stress.fill(Default::default());
            // A wave that alternates from cell to cell runs half in each direction.
            match 2 * ky == ny {
                true => {
                    self.wave([qx, qy], columns, stride, [kx, opposite], 0.5, scratch);
                    self.wave([qx, -qy], columns, stride, [kx, opposite], 0.5, scratch);
                }
                false => self.wave([qx, qy], columns, stride, [kx, opposite], 1.0, scratch),
            }
            for (stress, columns) in scratch.stress.iter().zip(columns.chunks_exact_mut(COMPONENTS * stride))
            {
                for (stress, column) in stress.iter().zip(columns.chunks_exact_mut(stride)) {
                    if opposite == kx {
                        column[kx] = 0.5 * (stress.plus() + stress.minus());
                    } else {
                        column[kx] = stress.plus();
                        column[opposite] = stress.minus();
                    }
                }
            }
        }
    }

    /// Computes the response to the mean strain: the body cannot expand laterally.
    fn uniform(&self, columns: &mut [Complex64], stride: usize) {
        let plane = self.twice_shear / (1.0 - self.poisson);
        for columns in columns.chunks_exact_mut(COMPONENTS * stride) {
            let [xx, yy, xy] = [0, 1, 5].map(|component| columns[component * stride]);
            let zero = Complex64::default();
            let stress = [
                -plane * (xx + self.poisson * yy),
                -plane * (yy + self.poisson * xx),
                zero,
                zero,
                zero,
                -self.twice_shear * xy,
            ];
            stress.iter().enumerate().for_each(|(component, s)| columns[component * stride] = *s);
        }
    }

    /// Adds to the stress in the scratch, times `share`, the waves of (±q_x, q_y) ≠ 0 in the bins `at`.
    fn wave(
        &self,
        [qx, qy]: [f64; 2],
        columns: &[Complex64],
        stride: usize,
        at: [usize; 2],
        share: f64,
        scratch: &mut SweepScratch,
    ) {
        let q = qx.hypot(qy);
        let (c, s) = (qx / q, qy / q);
        let (cc, ss, cs) = (c * c, s * s, c * s);
        let SweepScratch { decay, tau, below, stress } = scratch;

        // Upwards from the bottom.
        let zero = Lanes::default();
        let (mut b11, mut b33, mut b13, mut b12, mut b23, mut bd, mut b13_1) =
            (zero, zero, zero, zero, zero, zero, zero);
        let mut previous = f64::NAN;
        for layer in (0..self.thickness.len()).rev() {
            let thickness = self.thickness[layer];
            decay[layer] = if thickness == previous { decay[layer + 1] } else { Decay::over(q * thickness) };
            previous = thickness;
            let columns = &columns[layer * COMPONENTS * stride..];
            let read = |component: usize| {
                let column = &columns[component * stride..];
                self.twice_shear * Lanes::of(column[at[0]], column[at[1]])
            };
            let (xx, yy, yz, xz, xy) = (read(0), read(1), read(3).times_i(), read(4).times_i(), read(5));
            let t11 = cc * xx + (2.0 * xy).times_odd(cs) + ss * yy;
            let t33 = -(xx + yy);
            let t13 = xz.times_odd(c) + s * yz;
            let t23 = yz.times_odd(c) - s * xz;
            let t12 = (yy - xx).times_odd(cs) + (cc - ss) * xy;
            tau[layer] = [t11, t33, t13, t12, t23];
            let Decay { whole, thickness, mean: [m0, m1], given: [g0, g1], .. } = decay[layer];
            let bd_0 = b11 - b33;
            below[layer] = [
                m0 * b11,
                m0 * b33,
                m0 * b13,
                m0 * b12,
                m0 * b23,
                m0 * bd + m1 * bd_0,
                m0 * b13_1 + m1 * b13,
            ];
            bd = whole * (bd + thickness * bd_0) + g1 * (t11 - t33);
            b13_1 = whole * (b13_1 + thickness * b13) + g1 * t13;
            b11 = whole * b11 + g0 * t11;
            b33 = whole * b33 + g0 * t33;
            b13 = whole * b13 + g0 * t13;
            b12 = whole * b12 + g0 * t12;
            b23 = whole * b23 + g0 * t23;
        }

        // The mirror image and the pressure for a traction-free surface, per mean of e^−qz and of qz e^−qz.
        let k = self.poisson / (1.0 - self.poisson);
        let a = 1.0 + k;
        let bd_0 = b11 - b33;
        let p = 2.0 * ((k - 1.0) * (b11 + b33) + a * bd - (2.0 * a) * b13_1);
        let image_0 = [
            (k + 3.0) * b11 - (3.0 * k + 1.0) * b33 - a * bd - (4.0 * a) * b13 + (2.0 * a) * b13_1 - p,
            (2.0 * k) * bd_0 - (4.0 * k) * b13 - (2.0 * self.poisson) * p,
            (k - 1.0) * (b11 + b33) + a * bd - (2.0 * a) * b13_1 - p,
            -2.0 * b11 + (2.0 * k) * b33 + a * bd + (2.0 * a) * (b13 - b13_1),
            2.0 * (b12 - b23),
            2.0 * (b23 - b12),
        ];
        let image_1 = [
            (2.0 * a) * b13 - a * bd_0 + p,
            zero,
            a * bd_0 - (2.0 * a) * b13 - p,
            a * bd_0 - (2.0 * a) * b13 - p,
        ];

        // Downwards from the surface.
        let (mut a11, mut a33, mut a13, mut a12, mut a23, mut ad, mut a13_1) =
            (zero, zero, zero, zero, zero, zero, zero);
        let (mut top, mut top_depth) = (1.0, 0.0);
        for layer in 0..self.thickness.len() {
            let Decay { whole, thickness, mean: [m0, m1], given: [g0, g1], own: [own0, own1] } = decay[layer];
            let [t11, t33, t13, t12, t23] = tau[layer];
            let up = &below[layer];
            let (p0, p1) = (top * m0, top * (top_depth * m0 + m1));
            top *= whole;
            top_depth += thickness;
            let d = t11 - t33;
            let ad_0 = a11 - a33;
            let [down11, down33, down13, down12, down23] = [m0 * a11, m0 * a33, m0 * a13, m0 * a12, m0 * a23];
            let (down_d, down_13) = (m0 * ad + m1 * ad_0, m0 * a13_1 + m1 * a13);
            let (e11, o11) = (down11 + up[0] + own0 * t11, down11 - up[0]);
            let (e33, o33) = (down33 + up[1] + own0 * t33, down33 - up[1]);
            let (e13, o13) = (down13 + up[2] + own0 * t13, down13 - up[2]);
            let (e12, o12) = (down12 + up[3] + own0 * t12, down12 - up[3]);
            let (e23, o23) = (down23 + up[4] + own0 * t23, down23 - up[4]);
            let (e1d, o1d) = (down_d + up[5] + own1 * d, down_d - up[5]);
            let (e1_13, o1_13) = (down_13 + up[6] + own1 * t13, down_13 - up[6]);
            ad = whole * (ad + thickness * ad_0) + g1 * d;
            a13_1 = whole * (a13_1 + thickness * a13) + g1 * t13;
            a11 = whole * a11 + g0 * t11;
            a33 = whole * a33 + g0 * t33;
            a13 = whole * a13 + g0 * t13;
            a12 = whole * a12 + g0 * t12;
            a23 = whole * a23 + g0 * t23;

            let s11 = (k + 3.0) * e11 - (3.0 * k + 1.0) * e33 - a * e1d + (4.0 * a) * o13 - (2.0 * a) * o1_13
                + k * t33
                - t11
                + p0 * image_0[0]
                + p1 * image_1[0];
            // τ22 = −τ11 − τ33.
            let s22 = (2.0 * k) * (e11 - e33) + (4.0 * k) * o13 + a * t33 + t11 + p0 * image_0[1];
            let s33 =
                (k - 1.0) * (e11 + e33) + a * e1d + (2.0 * a) * o1_13 + p0 * image_0[2] + p1 * image_1[2];
            let s13 = (2.0 * k) * o33 - 2.0 * o11 + a * o1d - (2.0 * a) * (e13 - e1_13)
                + p0 * image_0[3]
                + p1 * image_1[3];
            let s12 = 2.0 * (e12 + o23) - t12 + p0 * image_0[4];
            let s23 = -2.0 * (o12 + e23) + p0 * image_0[5];

            let across = (2.0 * s12).times_odd(cs);
            let stress = &mut stress[layer];
            stress[0] += share * (cc * s11 - across + ss * s22);
            stress[1] += share * (ss * s11 + across + cc * s22);
            stress[2] += share * s33;
            stress[3] += -share * (s * s13 + s23.times_odd(c)).times_i();
            stress[4] += -share * (s13.times_odd(c) - s * s23).times_i();
            stress[5] += share * ((s11 - s22).times_odd(cs) + (cc - ss) * s12);
        }
    }
}
