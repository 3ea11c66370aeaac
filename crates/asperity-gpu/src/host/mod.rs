//! The processor in plain loops: the reference of the kernels, which needs no device.

mod preconditioner;

use asperity_base::error::Result;
use asperity_base::grid::{CellValues, Field, coarse_means, in_rows};
use asperity_base::math::fft::RealFft2;
use asperity_base::units::{Metre, Pascal};
use asperity_transforms::num_complex::Complex64;
use ndarray::Array2;

use crate::fields::{Device, Fields};
use crate::problem::{Compliance, Contact, Harmonics, Level, Precision, Rough};
use crate::waves::Waves;
use preconditioner::Preconditioner;

/// The processor.
pub(crate) struct Host;

/// Gaps and upper bounds of the contacts, one after another.
pub(crate) struct Gaps {
    gaps: Vec<Field>,
    uppers: Vec<CellValues>,
}

/// Membership of a cell in the predicted sets.
#[derive(Clone, Copy, PartialEq)]
enum Set {
    Free,
    Lower,
    Upper,
}

/// The fields of all contacts, flat and one after another, except the buffer, which is not padded here.
pub(crate) struct HostFields {
    shapes: Vec<[usize; 2]>,
    pressure: Vec<f64>,
    touch: Vec<f64>,
    gap: Vec<f64>,
    kept: Vec<f64>,
    upper: Vec<f64>,
    direction: Vec<f32>,
    set: Vec<Set>,
    buffer: Vec<f64>,
    transform: RealFft2,
    /// The factors of the displacement: `[k, l]`, with all k and half of l.
    compliance: Field,
    preconditioner: Preconditioner,
    self_influence: f64,
}

impl Device for Host {
    type Gaps = Gaps;
    type Fields = HostFields;
    type Pressure = Vec<Field>;

    fn gaps(&self, contacts: &[Contact], _: Precision) -> Result<Gaps> {
        let gaps = contacts.iter().map(|contact| in_rows(contact.gap).into_owned()).collect();
        Ok(Gaps { gaps, uppers: contacts.iter().map(|contact| contact.upper.clone()).collect() })
    }

    fn rough(&self, rough: &Rough, level: &Level, _: Precision) -> Result<Gaps> {
        let transform = RealFft2::new(level.padded);
        let waves = Waves::from_rough(rough);
        let side = rough.side;
        let at = |k: usize, l: usize| {
            let [re, im] =
                waves.amplitude(if 2 * k < side { k as i64 } else { k as i64 - side as i64 }, l as i64);
            Complex64::new(re, im)
        };
        let mut spectrum = Array2::from_shape_fn([side, side / 2 + 1], |(k, l)| at(k, l));
        let squares: f64 = spectrum
            .indexed_iter()
            .map(|((k, l), wave)| {
                let k = k.min(side - k) as f64;
                let both = if l == 0 { 1.0 } else { 2.0 };
                both * (waves.first * k.hypot(l as f64)).powi(2) * wave.norm_sqr()
            })
            .sum();
        let factor = rough.slope / squares.sqrt() * (side * side) as f64;
        spectrum.iter_mut().for_each(|wave| *wave *= factor);
        let heights = transform.inverse_leading(&spectrum, [side; 2]);
        let summit = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        Ok(Gaps { gaps: vec![summit - heights], uppers: vec![CellValues::Uniform(f64::INFINITY)] })
    }

    fn coarse(&self, fine: &Gaps) -> Result<Gaps> {
        let gaps = fine.gaps.iter().map(coarse_means).collect();
        Ok(Gaps { gaps, uppers: fine.uppers.iter().map(CellValues::coarse).collect() })
    }

    fn fields(&self, Gaps { gaps, uppers }: Gaps, level: &Level) -> Result<HostFields> {
        let shapes: Vec<[usize; 2]> = gaps.iter().map(|gap| gap.dim().into()).collect();
        let cells = gaps.iter().map(Field::len).sum();
        let upper = gaps.iter().zip(&uppers);
        let upper = upper.flat_map(|(gap, upper)| (0..gap.len()).map(|cell| upper.value(cell))).collect();
        let transform = RealFft2::new(level.padded);
        let compliance = compliance(level, &transform);
        let influence = influence(level, &transform, &compliance);
        let preconditioner = Preconditioner::new(level, &shapes, |i, j| influence[[i, j]]);
        Ok(HostFields {
            shapes,
            pressure: vec![0.0; cells],
            touch: vec![0.0; cells],
            gap: gaps.iter().flatten().copied().collect(),
            kept: vec![0.0; cells],
            upper,
            direction: vec![0.0; cells],
            set: vec![Set::Free; cells],
            buffer: vec![0.0; cells],
            transform,
            compliance,
            preconditioner,
            self_influence: level.self_influence(influence[[0, 0]]),
        })
    }

    fn pressure_of(&self, fields: HostFields) -> Result<Vec<Field>> {
        Ok(fields.cut(&fields.pressure))
    }

    fn prolong(&self, coarse: &Vec<Field>, fine: &mut HostFields) -> Result<()> {
        let mut pressure = fine.pressure.iter_mut();
        for (coarse, shape) in coarse.iter().zip(&fine.shapes) {
            for (i, j) in ndarray::indices(*shape) {
                *pressure.next().expect("as many cells") = coarse[[i / 2, j / 2]];
            }
        }
        Ok(())
    }
}

/// Calls `of` with the whole table of frequencies, from those up to half of the axis x.
fn mirrored([rows, columns]: [usize; 2], of: impl Fn(usize, usize) -> f64) -> Field {
    Field::from_shape_fn([rows, columns / 2 + 1], |(k, l)| of(k.min(rows - k), l))
}

fn compliance(level: &Level, transform: &RealFft2) -> Field {
    let [rows, columns] = level.padded;
    match &level.compliance {
        Compliance::Harmonic => {
            mirrored(level.padded, |k, l| if [k, l] == [0, 0] { 0.0 } else { harmonic(level, [k, l]) })
        }
        Compliance::Influence(influence) => {
            let cyclic = Field::from_shape_fn([rows, columns], |(i, j)| {
                influence[[i.min(rows - i), j.min(columns - j)]]
            });
            transform.forward(&cyclic).mapv(|value| value.re)
        }
    }
}

/// Displacement of the padded cells per unit pressure on the first one.
fn influence(level: &Level, transform: &RealFft2, compliance: &Field) -> Field {
    let mut unit = Field::zeros(level.padded);
    unit[[0, 0]] = 1.0;
    let mut waves = transform.forward(&unit);
    waves.zip_mut_with(compliance, |wave, factor| *wave *= *factor);
    transform.inverse_leading(&waves, level.padded)
}

fn harmonic(level: &Level, bins: [usize; 2]) -> f64 {
    match &level.harmonics {
        Harmonics::HalfSpaces(modulus) => {
            let [x, y] = [0, 1].map(|axis| bins[axis] as f64 * level.wavenumbers()[axis]);
            2.0 / (modulus * x.hypot(y))
        }
        Harmonics::Table(table) => table[bins],
    }
}

fn clip(pressure: f64, upper: f64) -> f64 {
    if pressure < 0.0 { 0.0 } else { pressure.min(upper) }
}

impl HostFields {
    /// Multiplies the transforms of the contacts in the buffer.
    fn filter(&mut self, factors: impl Fn(&Self) -> &Field) {
        let mut from = 0;
        for [rows, columns] in self.shapes.clone() {
            let cells = from..from + rows * columns;
            let field = Field::from_shape_vec([rows, columns], self.buffer[cells.clone()].to_vec());
            let mut waves = self.transform.forward(&field.expect("the shape of the contact"));
            waves.zip_mut_with(factors(self), |wave, factor| *wave *= *factor);
            let field = self.transform.inverse_leading(&waves, [rows, columns]);
            self.buffer[cells.clone()].iter_mut().zip(&field).for_each(|(to, from)| *to = *from);
            from = cells.end;
        }
    }

    /// [`Self::filter`] of values in single precision.
    fn filter_in_single(&mut self, factors: impl Fn(&Self) -> &Field) {
        self.filter(factors);
        self.buffer.iter_mut().for_each(|value| *value = f64::from(*value as f32));
    }

    /// Cuts the values of all contacts into their fields.
    fn cut(&self, values: &[f64]) -> Vec<Field> {
        let mut rest = values;
        let field = |shape: &[usize; 2]| {
            let (own, next) = rest.split_at(shape[0] * shape[1]);
            rest = next;
            Field::from_shape_vec(*shape, own.to_vec()).expect("the shape of the contact")
        };
        self.shapes.iter().map(field).collect()
    }

    fn free(&self) -> impl Iterator<Item = usize> {
        (0..self.set.len()).filter(|cell| self.set[*cell] == Set::Free)
    }
}

impl Fields for HostFields {
    fn cells(&self) -> usize {
        self.pressure.len()
    }

    fn self_influence(&self) -> f64 {
        self.self_influence
    }

    fn upper(&self) -> [Pascal; 2] {
        [self.upper.iter().sum(), self.upper.iter().copied().fold(0.0, f64::max)]
    }

    fn set_pressure(&mut self, pressure: &[&Field]) -> Result<()> {
        let values = pressure.iter().flat_map(|field| field.iter());
        self.pressure.iter_mut().zip(values).for_each(|(p, value)| *p = *value);
        Ok(())
    }

    fn set_uniform(&mut self, pressure: Pascal) -> Result<()> {
        self.pressure.fill(pressure);
        Ok(())
    }

    fn close_alone(&mut self, approach: Metre, stiffness: f64) -> Result<()> {
        self.pressure.iter_mut().zip(&self.gap).for_each(|(p, h)| *p = stiffness * (approach - h));
        Ok(())
    }

    fn scale_below(&mut self, factor: f64) -> Result<[Pascal; 2]> {
        let mut sums = [0.0; 2];
        for (p, upper) in self.pressure.iter_mut().zip(&self.upper) {
            *p = if *p < *upper { clip(*p * factor, *upper) } else { *upper };
            sums[0] += *p;
            sums[1] += if *p < *upper { *p } else { 0.0 };
        }
        Ok(sums)
    }

    fn propose(&mut self, approach: Metre, stiffness: f64) -> Result<[Pascal; 2]> {
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        for ((y, p), touch) in self.buffer.iter_mut().zip(&self.pressure).zip(&self.touch) {
            *y = if stiffness > 0.0 { p + (approach - touch) * stiffness } else { *p };
            range = [range[0].min(*y), range[1].max(*y)];
        }
        Ok(range)
    }

    fn proposed_sum(&mut self, offset: Pascal) -> Result<[f64; 2]> {
        let mut sums = [0.0; 2];
        for (y, upper) in self.buffer.iter().zip(&self.upper) {
            let p = clip(y + offset, *upper);
            sums = [sums[0] + p, sums[1] + if p > 0.0 && p < *upper { 1.0 } else { 0.0 }];
        }
        Ok(sums)
    }

    fn accept(&mut self, offset: Pascal) -> Result<()> {
        let cells = self.pressure.iter_mut().zip(&self.buffer).zip(&self.upper);
        cells.for_each(|((p, y), upper)| *p = clip(y + offset, *upper));
        Ok(())
    }

    fn predict_sets(&mut self, offset: Pascal) -> Result<[f64; 4]> {
        let [mut free, mut moving, mut moved, mut borne] = [0.0; 4];
        for (cell, set) in self.set.iter_mut().enumerate() {
            let (y, upper, p) = (self.buffer[cell] + offset, self.upper[cell], self.pressure[cell]);
            *set = match y {
                y if y <= 0.0 => Set::Lower,
                y if y >= upper => Set::Upper,
                _ => Set::Free,
            };
            let lacks = match set {
                Set::Free => {
                    free += 1.0;
                    borne += clip(p, upper);
                    continue;
                }
                Set::Lower => -p,
                Set::Upper => upper - p,
            };
            moving += if lacks == 0.0 { 0.0 } else { 1.0 };
            moved += lacks;
        }
        Ok([free, moving, moved, borne])
    }

    fn convolve(&mut self) -> Result<()> {
        self.buffer.copy_from_slice(&self.pressure);
        self.filter(|fields| &fields.compliance);
        let cells = self.touch.iter_mut().zip(&self.gap).zip(&self.buffer);
        cells.for_each(|((touch, h), u)| *touch = h + u);
        Ok(())
    }

    fn multiplier(&mut self) -> Result<[f64; 3]> {
        let mut sums = [0.0, 0.0, f64::NEG_INFINITY];
        for ((p, touch), upper) in self.pressure.iter().zip(&self.touch).zip(&self.upper) {
            if *p > 0.0 && p < upper {
                sums = [sums[0] + p, sums[1] + p * touch, sums[2]];
            } else if *p > 0.0 {
                sums[2] = sums[2].max(*touch);
            }
        }
        Ok(sums)
    }

    fn residual(&mut self, approach: Metre) -> Result<[f64; 5]> {
        let mut sums = [0.0; 5];
        for cell in 0..self.pressure.len() {
            let (p, touch) = (self.pressure[cell], self.touch[cell]);
            let u = touch - self.gap[cell];
            let to = clip(p + (approach - touch) / self.self_influence, self.upper[cell]);
            let phi = (self.self_influence * (p - to)).abs();
            sums =
                [sums[0] + u, sums[1] + u * u, sums[2].max(phi), sums[3].max(p.abs()), sums[4].max(u.abs())];
        }
        Ok(sums)
    }

    fn move_to_bounds(&mut self, each: Pascal, per_pressure: f64) -> Result<()> {
        for cell in 0..self.pressure.len() {
            let (upper, p) = (self.upper[cell], self.pressure[cell]);
            let d = match self.set[cell] {
                Set::Free => -each - per_pressure * clip(p, upper),
                Set::Lower => -p,
                Set::Upper => upper - p,
            };
            self.direction[cell] = if self.set[cell] == Set::Free { d as f32 } else { 0.0 };
            self.buffer[cell] = f64::from(d as f32);
        }
        self.filter_in_single(|fields| &fields.compliance);
        for cell in 0..self.pressure.len() {
            self.touch[cell] += self.buffer[cell];
            self.pressure[cell] = match self.set[cell] {
                Set::Free => self.pressure[cell] + f64::from(self.direction[cell]),
                Set::Lower => 0.0,
                Set::Upper => self.upper[cell],
            };
        }
        Ok(())
    }

    fn reset_direction(&mut self) -> Result<f64> {
        self.direction.fill(0.0);
        Ok(self.free().map(|cell| self.touch[cell]).sum())
    }

    fn advance(&mut self, step: f64, datum: Metre) -> Result<[f64; 3]> {
        let mut sums = [0.0; 3];
        for cell in 0..self.pressure.len() {
            if step != 0.0 {
                self.touch[cell] += step * self.buffer[cell];
                self.pressure[cell] += step * f64::from(self.direction[cell]);
            }
            let (w, p) = (datum - self.touch[cell], self.pressure[cell]);
            let [residual, violation] = match self.set[cell] {
                Set::Free => [w, self.self_influence * (p - clip(p, self.upper[cell]))],
                Set::Lower => [0.0, w.max(0.0)],
                Set::Upper => [0.0, w.min(0.0)],
            };
            self.buffer[cell] = f64::from(residual as f32);
            let squares = [residual * residual, violation * violation];
            sums = [sums[0] + squares[0], sums[1] + squares[1], sums[2].max(residual.abs())];
        }
        Ok(sums)
    }

    fn adapt(&mut self, free: f64) -> Result<()> {
        self.preconditioner.adapt(&self.set, free);
        Ok(())
    }

    fn precondition(&mut self, datum: Metre) -> Result<[f64; 3]> {
        self.preconditioner.apply(&self.set, &mut self.buffer);
        let mut sums = [0.0; 3];
        for cell in self.free() {
            let (z, r) = (self.buffer[cell], datum - self.touch[cell]);
            sums = [sums[0] + z, sums[1] + r, sums[2] + r * z];
        }
        Ok(sums)
    }

    fn respond(&mut self, mean: f64, beta: f64) -> Result<[f64; 2]> {
        for cell in 0..self.pressure.len() {
            let d = self.buffer[cell] - mean + beta * f64::from(self.direction[cell]);
            self.direction[cell] = if self.set[cell] == Set::Free { d as f32 } else { 0.0 };
            self.buffer[cell] = f64::from(self.direction[cell]);
        }
        self.filter_in_single(|fields| &fields.compliance);
        let mut sums = [0.0; 2];
        for cell in self.free() {
            let v = self.buffer[cell];
            sums = [sums[0] + v * f64::from(self.direction[cell]), sums[1] + v];
        }
        Ok(sums)
    }

    fn pressure_sum(&mut self) -> Result<Pascal> {
        Ok(self.pressure.iter().sum())
    }

    fn add_to_free(&mut self, pressure: Pascal) -> Result<()> {
        let cells = self.pressure.iter_mut().zip(&self.set).filter(|(_, set)| **set == Set::Free);
        cells.for_each(|(p, _)| *p += pressure);
        Ok(())
    }

    fn step_along_gap(&mut self, approach: Metre, compliance: f64) -> Result<()> {
        self.pressure
            .iter_mut()
            .zip(&self.touch)
            .for_each(|(p, touch)| *p += (approach - touch) / compliance);
        Ok(())
    }

    fn keep(&mut self) -> Result<()> {
        self.kept.copy_from_slice(&self.pressure);
        Ok(())
    }

    fn convolve_kept(&mut self) -> Result<()> {
        self.buffer.copy_from_slice(&self.kept);
        self.filter(|fields| &fields.compliance);
        Ok(())
    }

    fn descent(&mut self, approach: Metre) -> Result<[f64; 2]> {
        let mut sums = [0.0; 2];
        for cell in 0..self.pressure.len() {
            let before = self.gap[cell] + self.buffer[cell];
            let change = self.pressure[cell] - self.kept[cell];
            sums = [sums[0] + (approach - before) * change, sums[1] + change * (self.touch[cell] - before)];
        }
        Ok(sums)
    }

    fn step_from_kept(&mut self, share: f64) -> Result<()> {
        for cell in 0..self.pressure.len() {
            let (before, kept) = (self.gap[cell] + self.buffer[cell], self.kept[cell]);
            self.touch[cell] = before + share * (self.touch[cell] - before);
            self.pressure[cell] = kept + share * (self.pressure[cell] - kept);
        }
        Ok(())
    }

    fn statistics(&mut self, approach: Metre) -> Result<[f64; 3]> {
        let gap = self.touch.iter().map(|touch| touch - approach).sum();
        let contact = self.pressure.iter().filter(|p| **p > 0.0).count() as f64;
        Ok([gap, contact, self.pressure.iter().copied().fold(0.0, f64::max)])
    }

    fn histogram(&mut self, width: Pascal, bins: usize) -> Result<Vec<u64>> {
        let mut counts = vec![0; bins];
        let touching = self.pressure.iter().filter(|p| **p > 0.0);
        touching.for_each(|p| counts[((p / width) as usize).min(bins - 1)] += 1);
        Ok(counts)
    }

    fn gaps(&self) -> Result<Vec<Field>> {
        Ok(self.cut(&self.gap))
    }

    fn multiply(&mut self, _: bool) -> Result<()> {
        self.filter(|fields| &fields.compliance);
        Ok(())
    }

    fn bytes(&self) -> usize {
        let numbers = [&self.pressure, &self.touch, &self.gap, &self.kept, &self.upper, &self.buffer];
        8 * numbers.iter().map(|values| values.len()).sum::<usize>()
            + 4 * self.direction.len()
            + self.set.len()
    }

    fn wait(&self) -> Result<()> {
        Ok(())
    }

    fn results(&self) -> Result<Vec<[Field; 2]>> {
        let displacement: Vec<f64> = self.touch.iter().zip(&self.gap).map(|(touch, h)| touch - h).collect();
        let (pressure, displacement) = (self.cut(&self.pressure), self.cut(&displacement));
        Ok(pressure.into_iter().zip(displacement).map(|(p, u)| [p, u]).collect())
    }
}
