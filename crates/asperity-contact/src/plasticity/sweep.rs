//! Residual stress of plastic strain in layers, wave by wave, by an upward and a downward layer recursion.
//!
//! Consider the frame of a wave vector q (1 along it, 2 across, 3 = z) and a traceless eigenstress τ = 2με,
//! distributed over all depths z′ of an infinite body. Its stress at z consists of the sums
//!
//! ```text
//! e0 = (q/4) ∫ e^−ζ τ dz′     e1 = (q/4) ∫ ζ e^−ζ τ dz′     ζ = q|z − z′|
//! o0, o1: the same with the sign of z − z′
//! ```
//!
//! With k = ν/(1 − ν), a = 1 + k, the difference d = τ11 − τ33, and i τ13, i τ23 in place of τ13, τ23 so that
//! everything is real:
//!
//! ```text
//! σ11 = (k + 3) e0[11] − (3k + 1) e0[33] − a e1[d] + 4a o0[13] − 2a o1[13] + k τ33 − τ11
//! σ22 = 2k (e0[11] − e0[33]) + 4k o0[13] + k τ33 − τ22
//! σ33 = (k − 1)(e0[11] + e0[33]) + a e1[d] + 2a o1[13]
//! σ13 = −2 o0[11] + 2k o0[33] + a o1[d] − 2a (e0 − e1)[13]
//! σ12 = 2 e0[12] + 2 o0[23] − τ12       σ23 = −2 o0[12] − 2 e0[23]
//! ```
//!
//! Chiu, J. Appl. Mech. 44, 587 (1977); 45, 302 (1978). The part from above z has only three amplitudes:
//!
//! ```text
//! u = e0[a (d + 2 τ13)]     v = e0[(k − 1)(τ11 + τ33)] + e1[a (d + 2 τ13)]     t = e0[2 (τ12 + τ23)]
//! σ11 = 2u − v     σ22 = 2νu     σ33 = v     σ13 = v − u     σ12 = t     σ23 = −t
//! ```
//!
//! The part from below has the same with the signs of τ13, τ23, σ13 and σ23 reversed. Over a depth X/q
//! without strain, v becomes e^−X (v + X u), and u and t decay by e^−X.
//!
//! Two terms are added to those from above: the mirror image (τ13, τ23 reversed), which has the amplitudes
//! u′, v′, t′ from below at the surface, and the pressure 2v′ that makes the surface traction-free. Together
//! they are u = u′ − 2v′, v = −v′, t = t′.
//!
//! The strain is uniform in each layer, and the stress is its mean over each layer, so that the operator is
//! symmetric. The cost is linear in the number of layers, and nothing is stored.

use super::COMPONENTS;
use super::lanes::Lanes;
use super::layers::Layers;
use crate::math::fft::angular_frequency;
use crate::units::{Metre, Pascal};

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
    /// 1 − e^−X of each layer.
    lost: Vec<f64>,
    decay: Vec<Decay>,
    sources: Vec<Sources>,
    /// Amplitudes u, v, t from below at the bottom of each layer.
    below: Vec<[Lanes; 3]>,
    /// The same wave in the other direction.
    other: Vec<[Lanes; COMPONENTS]>,
}

/// Eigenstress of a layer in the frame of the wave.
#[derive(Clone, Copy, Default)]
struct Sources {
    /// a (τ11 − τ33).
    difference: Lanes,
    /// (k − 1)(τ11 + τ33).
    sum: Lanes,
    /// 2a τ13, 2 τ12, 2 τ23.
    along: Lanes,
    across: Lanes,
    below: Lanes,
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
    /// Computes the decay with absolute errors of about 1e-16, also for terms that vanish with X, from X and
    /// 1 − e^−X.
    #[inline]
    fn over(thickness: f64, lost: f64) -> Self {
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

/// Computes 1 − e^−x for x ≥ 0, to about 2e-16 of the result. It has no branches, so that it is computed for
/// several numbers at a time.
#[inline]
fn lost(x: f64) -> f64 {
    /// Adding this number rounds to an integer, which the last bits of the sum hold.
    const ROUND: f64 = 6_755_399_441_055_744.0;
    /// The first 32 bits of ln 2, and the rest.
    const LN_2: [f64; 2] = [0.693_147_180_369_123_8, 1.908_214_929_270_587_7e-10];
    // e^−x = 2^−n e^r with |r| ≤ (ln 2)/2. Beyond 700 it is 0 in all sums.
    let x = x.min(700.0);
    let shifted = x * std::f64::consts::LOG2_E + ROUND;
    let n = shifted - ROUND;
    let scale = f64::from_bits(1023u64.wrapping_sub(shifted.to_bits()) << 52);
    let r = (n * LN_2[0] - x) + n * LN_2[1];
    // (e^r − 1)/r by its series; the next term is below 1e-17.
    let mut sum = 1.0 / 6_227_020_800.0;
    for factorial in [
        479_001_600.0,
        39_916_800.0,
        3_628_800.0,
        362_880.0,
        40_320.0,
        5_040.0,
        720.0,
        120.0,
        24.0,
        6.0,
        2.0,
        1.0,
    ] {
        sum = sum * r + 1.0 / factorial;
    }
    (1.0 - scale) - scale * (r * sum)
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
            lost: vec![0.0; layers],
            decay: vec![Decay::default(); layers],
            sources: vec![Sources::default(); layers],
            below: vec![Default::default(); layers],
            other: vec![Default::default(); layers],
        }
    }

    /// Replaces plastic strain by residual stress, for the waves in the bins ±`kx` and `ky`: the components
    /// of each layer. The zz component of the strain follows from the others,
    /// because its trace is 0, and is not read.
    pub(super) fn residual(
        &self,
        [kx, ky]: [usize; 2],
        layers: &mut [[Lanes; COMPONENTS]],
        scratch: &mut SweepScratch,
    ) {
        let [nx, ny] = self.shape;
        if [kx, ky] == [0, 0] {
            return self.uniform(layers);
        }
        let [qx, qy] = [angular_frequency(kx, nx, self.pitch[0]), angular_frequency(ky, ny, self.pitch[1])];
        if 2 * ky != ny {
            return self.wave([qx, qy], layers, scratch);
        }
        // A wave that alternates from cell to cell runs half in each direction.
        let mut other = std::mem::take(&mut scratch.other);
        other.copy_from_slice(layers);
        self.wave([qx, qy], layers, scratch);
        self.wave([qx, -qy], &mut other, scratch);
        for (stress, other) in layers.iter_mut().zip(&other) {
            stress.iter_mut().zip(other).for_each(|(one, other)| *one = 0.5 * (*one + *other));
        }
        scratch.other = other;
    }

    /// Computes the response to the mean strain: the body cannot expand laterally.
    fn uniform(&self, layers: &mut [[Lanes; COMPONENTS]]) {
        let plane = self.twice_shear / (1.0 - self.poisson);
        let zero = Lanes::default();
        for layer in layers {
            let [xx, yy, .., xy] = *layer;
            *layer = [
                -plane * (xx + self.poisson * yy),
                -plane * (yy + self.poisson * xx),
                zero,
                zero,
                zero,
                -self.twice_shear * xy,
            ];
        }
    }

    /// Replaces strain by stress for the waves (±q_x, q_y) ≠ 0.
    fn wave(&self, [qx, qy]: [f64; 2], layers: &mut [[Lanes; COMPONENTS]], scratch: &mut SweepScratch) {
        let q = qx.hypot(qy);
        let (c, s) = (qx / q, qy / q);
        let (cc, ss, cs) = (c * c, s * s, c * s);
        let (shear, nu) = (self.twice_shear, self.poisson);
        let k = nu / (1.0 - nu);
        let a = 1.0 + k;
        let SweepScratch { lost: lost_in_layers, decay, sources, below, .. } = scratch;

        // Upwards from the bottom.
        let (to_cc, to_ss, to_2cs) = (shear * cc, shear * ss, Lanes::odd(2.0 * shear * cs));
        let to_across = 2.0 * shear * (cc - ss);
        let (to_along_c, to_along_s) = (Lanes::odd(2.0 * a * shear * c), 2.0 * a * shear * s);
        let (to_below_c, to_below_s) = (Lanes::odd(2.0 * shear * c), 2.0 * shear * s);
        let zero = Lanes::default();
        let [mut u, mut v, mut t] = [zero; 3];
        for (decay, thickness) in lost_in_layers.iter_mut().zip(&self.thickness) {
            *decay = lost(q * thickness);
        }
        for (layer, strain) in layers.iter().enumerate().rev() {
            decay[layer] = Decay::over(q * self.thickness[layer], lost_in_layers[layer]);
            let [xx, yy, _, yz, xz, xy] = *strain;
            let t11 = to_cc * xx + to_2cs * xy + to_ss * yy;
            let minus_t33 = shear * (xx + yy);
            let source = Sources {
                difference: a * (t11 + minus_t33),
                sum: (k - 1.0) * (t11 - minus_t33),
                along: (to_along_c * xz + to_along_s * yz).times_i(),
                across: to_2cs * (yy - xx) + to_across * xy,
                below: (to_below_c * yz - to_below_s * xz).times_i(),
            };
            sources[layer] = source;
            below[layer] = [u, v, t];
            let Decay { whole, thickness, given: [g0, g1], .. } = decay[layer];
            let rising = source.difference - source.along;
            v = whole * (v + thickness * u) + g0 * source.sum + g1 * rising;
            u = whole * u + g0 * rising;
            t = whole * t + g0 * (source.across - source.below);
        }

        // Downwards from the surface, with the mirror image and the pressure for a traction-free surface.
        u = u - 2.0 * v;
        v = -v;
        let (cs_odd, cs_2, c_odd) = (Lanes::odd(cs), Lanes::odd(2.0 * cs), Lanes::odd(c));
        for (layer, stress) in layers.iter_mut().enumerate() {
            let Decay { whole, thickness, mean: [m0, m1], given: [g0, g1], own: [own0, own1] } = decay[layer];
            let Sources { difference, sum, along, across, below: down } = sources[layer];
            let [u_below, v_below, t_below] = below[layer];
            let [xx, yy, .., xy] = *stress;
            let both = u + u_below;
            let s_u = m0 * both + own0 * difference;
            let zz = m0 * (v + v_below) + m1 * both + own0 * sum + own1 * difference;
            let s13 = m0 * (v - v_below) - (m0 - m1) * (u - u_below) - (own0 - own1) * along;
            let s12 = m0 * (t + t_below) + own0 * across;
            let s32 = m0 * (t - t_below) + own0 * down;

            let falling = difference + along;
            v = whole * (v + thickness * u) + g0 * sum + g1 * falling;
            u = whole * u + g0 * falling;
            t = whole * t + g0 * (across + down);

            // Without the local terms k τ33 − τ.
            let s22 = (2.0 * nu) * s_u;
            let s11_s22 = (2.0 - 2.0 * nu) * s_u - zz;
            let turned = cs_2 * s12;
            let plane = s22 - (k * shear) * (xx + yy);
            *stress = [
                plane + cc * s11_s22 - turned - shear * xx,
                plane + ss * s11_s22 + turned - shear * yy,
                zz,
                (c_odd * s32 - s * s13).times_i(),
                -(c_odd * s13 + s * s32).times_i(),
                cs_odd * s11_s22 + (cc - ss) * s12 - shear * xy,
            ];
        }
    }
}

#[cfg(test)]
mod tests {
    use asperity_transforms::num_complex::Complex64;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;

    #[test]
    fn the_loss_of_a_wave_is_that_of_the_exponential() {
        let mut x: f64 = 1e-300;
        while x < 1e4 {
            let exact = -(-x).exp_m1();
            assert!((lost(x) - exact).abs() <= 4e-16 * exact, "{x:e}: {:e} is {exact:e}", lost(x));
            x *= 1.07;
        }
        assert_eq!(lost(0.0), 0.0);
    }

    /// Stress in the frame of the wave, layer by layer: 11, 22, 33, 13, 12, 23, from τ11, τ33, τ13, τ12, τ23,
    /// by the sums over all layers that define it.
    fn direct(q: f64, nu: f64, faces: &[f64], tau: &[[Complex64; 5]]) -> Vec<[Complex64; 6]> {
        let (k, a) = (nu / (1.0 - nu), 1.0 / (1.0 - nu));
        let stress = |e0: [Complex64; 5], e1: [Complex64; 5], o0: [Complex64; 5], o1: [Complex64; 5]| {
            let d = |e: [Complex64; 5]| e[0] - e[1];
            [
                (k + 3.0) * e0[0] - (3.0 * k + 1.0) * e0[1] - a * d(e1) + 4.0 * a * o0[2] - 2.0 * a * o1[2],
                2.0 * k * d(e0) + 4.0 * k * o0[2],
                (k - 1.0) * (e0[0] + e0[1]) + a * d(e1) + 2.0 * a * o1[2],
                -2.0 * o0[0] + 2.0 * k * o0[1] + a * d(o1) - 2.0 * a * (e0[2] - e1[2]),
                2.0 * e0[3] + 2.0 * o0[4],
                -2.0 * o0[3] - 2.0 * e0[4],
            ]
        };
        // Means of e^−ζ and of ζ e^−ζ over a layer, times q/4 times their integrals over another, by Gauss in
        // many parts.
        let points = |layer: usize| {
            let (top, thickness) = (faces[layer], faces[layer + 1] - faces[layer]);
            (0..40).flat_map(move |n| {
                [-1.0, 1.0].map(|side| top + thickness * (f64::from(n) + 0.5 + side / 12f64.sqrt()) / 40.0)
            })
        };
        let mean = |to: usize, from: usize, apart: &dyn Fn(f64, f64) -> f64| -> [f64; 2] {
            let thickness = faces[from + 1] - faces[from];
            let mut sums = [0.0; 2];
            for z in points(to) {
                for from in points(from) {
                    let zeta = q * apart(z, from);
                    sums[0] += (-zeta).exp();
                    sums[1] += zeta * (-zeta).exp();
                }
            }
            sums.map(|sum| 0.25 * q * thickness * sum / 6400.0)
        };
        let layers = tau.len();
        let pressure = {
            let mut up = [[Complex64::default(); 5]; 2];
            for (from, tau) in tau.iter().enumerate() {
                let thickness = faces[from + 1] - faces[from];
                for at in points(from) {
                    let weight = 0.25 * q * thickness / 80.0 * (-q * at).exp();
                    for c in 0..5 {
                        up[0][c] += weight * tau[c];
                        up[1][c] += weight * q * at * tau[c];
                    }
                }
            }
            2.0 * stress(up[0], up[1], up[0].map(|v| -v), up[1].map(|v| -v))[2]
        };
        (0..layers)
            .map(|to| {
                let mut sums = [[Complex64::default(); 5]; 4];
                let mut image = [[Complex64::default(); 5]; 2];
                for (from, tau) in tau.iter().enumerate() {
                    let side = (to as f64 - from as f64).signum() * if to == from { 0.0 } else { 1.0 };
                    let near = if to == from {
                        let x = q * (faces[to + 1] - faces[to]);
                        let lost = -(-x).exp_m1();
                        [0.5 * (1.0 - lost / x), 0.5 * (2.0 - lost) - lost / x]
                    } else {
                        mean(to, from, &|a, b| (a - b).abs())
                    };
                    let far = mean(to, from, &|a, b| a + b);
                    for c in 0..5 {
                        let mirror = if c == 2 || c == 4 { -1.0 } else { 1.0 };
                        for n in 0..2 {
                            sums[n][c] += near[n] * tau[c];
                            sums[2 + n][c] += side * near[n] * tau[c];
                            image[n][c] += mirror * far[n] * tau[c];
                        }
                    }
                }
                let direct = stress(sums[0], sums[1], sums[2], sums[3]);
                let mirrored = stress(image[0], image[1], image[0], image[1]);
                let [mut p0, mut p1] = [0.0; 2];
                for z in points(to) {
                    p0 += (-q * z).exp() / 80.0;
                    p1 += q * z * (-q * z).exp() / 80.0;
                }
                let surface =
                    [p1 - p0, -2.0 * nu * p0, -p0 - p1, -p1, 0.0, 0.0].map(|share| share * pressure);
                let [t11, t33, .., t12, _] = tau[to];
                let local = [
                    k * t33 - t11,
                    k * t33 + t11 + t33,
                    Complex64::default(),
                    Complex64::default(),
                    -t12,
                    Complex64::default(),
                ];
                std::array::from_fn(|c| direct[c] + mirrored[c] + surface[c] + local[c])
            })
            .collect()
    }

    #[test]
    fn the_recursions_are_the_sums_over_all_layers() {
        let faces = [0.0, 0.4, 0.7, 1.5, 1.8];
        let layers = Layers::between(&faces).unwrap();
        let mut random = ChaCha8Rng::seed_from_u64(9);
        for (bins, poisson) in [([1, 2], 0.3), ([3, 1], 0.0), ([2, 0], 0.5), ([0, 3], 0.25), ([4, 2], 0.3)] {
            // In units in which 2μ is 1.
            let sweep = Sweep::new(&layers, 1.0 + poisson, poisson, [12, 10], [0.9, 1.1]);
            let mut value = || Complex64::new(random.random_range(-1.0..1.0), random.random_range(-1.0..1.0));
            let strain: Vec<[[Complex64; 2]; COMPONENTS]> =
                (0..4).map(|_| std::array::from_fn(|_| [value(), value()])).collect();
            let mut waves: Vec<[Lanes; COMPONENTS]> =
                strain.iter().map(|layer| layer.map(|[plus, minus]| Lanes::new(plus, minus))).collect();
            sweep.residual(bins, &mut waves, &mut sweep.scratch());
            for (side, sign) in [1.0, -1.0].into_iter().enumerate() {
                let qx = sign * angular_frequency(bins[0], 12, 0.9);
                let qy = angular_frequency(bins[1], 10, 1.1);
                let q = qx.hypot(qy);
                let (c, s) = (qx / q, qy / q);
                let i = Complex64::i();
                let tau: Vec<[Complex64; 5]> = strain
                    .iter()
                    .map(|layer| {
                        let [xx, yy, _, yz, xz, xy] = layer.map(|value| value[side]);
                        [
                            c * c * xx + 2.0 * c * s * xy + s * s * yy,
                            -xx - yy,
                            i * (c * xz + s * yz),
                            c * s * (yy - xx) + (c * c - s * s) * xy,
                            i * (c * yz - s * xz),
                        ]
                    })
                    .collect();
                for (found, exact) in waves.iter().zip(direct(q, poisson, &faces, &tau)) {
                    let [s11, s22, s33, s13, s12, s23] = exact;
                    let expected = [
                        c * c * s11 - 2.0 * c * s * s12 + s * s * s22,
                        s * s * s11 + 2.0 * c * s * s12 + c * c * s22,
                        s33,
                        -i * (s * s13 + c * s23),
                        -i * (c * s13 - s * s23),
                        c * s * (s11 - s22) + (c * c - s * s) * s12,
                    ];
                    for (component, (found, expected)) in found.iter().zip(expected).enumerate() {
                        let found = if side == 0 { found.plus() } else { found.minus() };
                        let error = (found - expected).norm();
                        assert!(error < 1e-8, "{bins:?}, ν = {poisson}, {component}: {found} is {expected}");
                    }
                }
            }
        }
    }
}
