//! The damage that load cycles leave in the material below the surfaces.

use ndarray::Axis;

use super::limited_bodies::{Limited, LimitedBodies};
use super::{advance_damage, critical};
use crate::error::Result;
use crate::grid::Field;
use crate::motion::{Body, LoadCycle, Memory, Pair, PlasticVolume, State};
use crate::stress::Component;
use crate::units::Metre;

/// Part of a life by which a pit may be late, because a cycle is extrapolated over several.
const LATE: f64 = 0.05;

/// The damage of two bodies: f of each load cycle, by Dang Van, and the damage that adds up, by Basquin and
/// Miner. Both are states of a body, a field for each depth.
pub(super) struct Damage(pub(super) LimitedBodies);

/// Names of the states of a body.
pub(super) mod states {
    /// f over its limit in the cycle that was looked at last, at a depth by its index.
    pub(in super::super) fn over_limit(depth: usize) -> String {
        format!("over_limit_{:02}", depth + 1)
    }

    /// The damage so far.
    pub(in super::super) fn damage(depth: usize) -> String {
        format!("damage_{:02}", depth + 1)
    }

    /// Depth that has broken out so far.
    pub(in super::super) const PITTED: &str = "pitted";
}

impl Damage {
    /// Changes the damage of a body, and returns the depth that breaks out of each of its columns.
    fn age(limited: &Limited, body: &mut Body, cycles: f64, worn: &Field) -> Field {
        let depths = &limited.depths;
        let layers = depths.len();
        let mut damage: Vec<Field> = (0..layers).map(|k| taken(body, &states::damage(k))).collect();
        let of_cycle: Vec<&Field> = (0..layers).map(|k| &body.state[&states::over_limit(k)].values).collect();
        let mut lost = Field::zeros(body.heights.raw_dim());
        let (mut column, mut each) = (vec![0.0; layers], vec![0.0; layers]);
        // Removal by laws between cycles counts as a cycle without damage.
        let (times, share) = (cycles.max(1.0), cycles.min(1.0));
        for (cell, lost) in lost.indexed_iter_mut() {
            for k in 0..layers {
                (column[k], each[k]) = (damage[k][cell], share * limited.damage.damage(of_cycle[k][cell]));
            }
            let worn = if limited.is_covered() { 0.0 } else { worn[cell].max(0.0) };
            advance_damage(depths, &mut column, &each, times, worn / times);
            *lost = pit(depths, &mut column, limited.pitting);
            (0..layers).for_each(|k| damage[k][cell] = column[k]);
        }
        for (k, values) in damage.into_iter().enumerate() {
            body.state.insert(states::damage(k), State { unit: "1".to_owned(), values });
        }
        if let Some(of_cycle) = body.state.get_mut(critical::OF_CYCLE).filter(|_| cycles > 0.0) {
            of_cycle.values = worn / cycles;
        }
        if let Some(pitted) = body.state.get_mut(states::PITTED) {
            pitted.values += &lost;
        }
        lost
    }
}

fn body_of(pair: &mut Pair, index: usize) -> &mut Body {
    if index == 0 { &mut pair.lower } else { &mut pair.upper }
}

/// Takes the values of a state out of a body.
fn taken(body: &mut Body, name: &str) -> Field {
    body.state.remove(name).expect("a state that was prepared").values
}

/// Breaks out a column above the deepest of its first `pitting` depths at which the damage has reached 1, and
/// returns the depth lost. The pit ends where the damage between two depths falls to 1.
fn pit(depths: &[Metre], damage: &mut [f64], pitting: usize) -> Metre {
    let Some(failed) = damage[..pitting].iter().rposition(|damage| *damage >= 1.0) else { return 0.0 };
    let bottom = match depths.get(failed + 1) {
        Some(next) if damage[failed + 1] < 1.0 => {
            let share = (damage[failed] - 1.0) / (damage[failed] - damage[failed + 1]);
            depths[failed] + share * (next - depths[failed])
        }
        _ => depths[failed],
    };
    let nothing = vec![0.0; depths.len()];
    advance_damage(depths, damage, &nothing, 1.0, bottom);
    bottom
}

impl Memory for Damage {
    fn takes(&self) -> Option<&str> {
        self.0.limited().any(|(_, body)| body.pitting > 0).then_some("pits")
    }

    fn prepare(&self, pair: &mut Pair) {
        for (index, limited) in self.0.limited() {
            let body = body_of(pair, index);
            let mut add = |name: String, unit: &str| {
                let values = Field::zeros(body.heights.raw_dim());
                body.state.entry(name).or_insert(State { unit: unit.to_owned(), values });
            };
            for k in 0..limited.depths.len() {
                add(states::over_limit(k), "1");
                add(states::damage(k), "1");
            }
            if limited.pitting > 0 {
                add(states::PITTED.to_owned(), "m");
            }
            if !limited.is_covered() {
                critical::prepare(body);
            }
        }
    }

    fn look(&self, cycle: &LoadCycle<'_>, pair: &mut Pair) -> Result<()> {
        if !self.0.fatigue.wants(cycle.number) {
            return Ok(());
        }
        for (index, limited) in self.0.limited() {
            let found = self.0.dang_van((index, limited), pair, cycle)?;
            let volume = cycle.plastic_volumes.iter().find(|volume| volume.body == index);
            let body = body_of(pair, index);
            // Cycles between two computed ones do damage between theirs.
            let between =
                if self.0.fatigue.passes.is_empty() { 0.5 * (cycle.extrapolated - 1.0) } else { 0.0 };
            for (k, at) in found.into_iter().enumerate() {
                let mut over = at.f / limited.criterion.limit();
                if let Some(volume) = volume {
                    let weight = limited.criterion.weight() / limited.criterion.limit();
                    over.scaled_add(weight, &residual_hydrostatic(volume, at.depth));
                }
                let before =
                    body.state.insert(states::over_limit(k), State { unit: "1".to_owned(), values: over });
                let Some(before) = before.filter(|_| between > 0.0) else { continue };
                let mut damage = taken(body, &states::damage(k));
                let now = &body.state[&states::over_limit(k)].values;
                ndarray::Zip::from(&mut damage).and(now).and(&before.values).for_each(|damage, now, then| {
                    let change = limited.damage.damage(*now) - limited.damage.damage(*then);
                    *damage = (*damage + between * change).max(0.0);
                });
                body.state.insert(states::damage(k), State { unit: "1".to_owned(), values: damage });
            }
        }
        Ok(())
    }

    fn most_cycles(&self, pair: &Pair) -> f64 {
        let mut most = f64::INFINITY;
        for (index, limited) in self.0.limited() {
            let body = [&pair.lower, &pair.upper][index];
            for k in 0..limited.pitting {
                let [over, damage] =
                    [states::over_limit(k), states::damage(k)].map(|name| &body.state[&name].values);
                for (over, damage) in over.iter().zip(damage) {
                    most = most.min((1.0 + LATE - damage).max(0.0) / limited.damage.damage(*over));
                }
            }
        }
        most.max(1.0)
    }

    fn advance(&self, pair: &mut Pair, cycles: f64, worn: &[Field; 2]) -> [Field; 2] {
        let mut lost = [&pair.lower, &pair.upper].map(|body| Field::zeros(body.heights.raw_dim()));
        for (index, limited) in self.0.limited() {
            let body = body_of(pair, index);
            lost[index] = Self::age(limited, body, cycles, &worn[index]);
        }
        lost
    }
}

/// Returns the hydrostatic part of the residual stress at a depth, linear between the centres of the layers;
/// 0 below them.
fn residual_hydrostatic(volume: &PlasticVolume, depth: Metre) -> Field {
    let centres: Vec<Metre> = volume.faces.windows(2).map(|faces| 0.5 * (faces[0] + faces[1])).collect();
    let trace = |layer: usize| {
        let stress = volume.residual_stress.index_axis(Axis(0), layer);
        let part = |component: Component| stress.index_axis(Axis(0), component as usize).to_owned();
        (part(Component::Xx) + part(Component::Yy) + part(Component::Zz)) / 3.0
    };
    let above = centres.partition_point(|centre| *centre <= depth);
    match (above.checked_sub(1), centres.get(above)) {
        (None, _) => trace(0),
        (Some(_), None) if volume.faces.last().is_some_and(|last| depth > *last) => {
            Field::zeros(volume.displacement.raw_dim())
        }
        (Some(last), None) => trace(last),
        (Some(upper), Some(next)) => {
            let share = (depth - centres[upper]) / (next - centres[upper]);
            trace(upper) * (1.0 - share) + trace(above) * share
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Grid;
    use crate::plasticity::{PlasticState, TensorField};

    #[test]
    fn a_column_breaks_out_down_to_where_its_damage_is_one() {
        let depths = [1.0, 2.0, 4.0, 8.0];
        // Between 2 and 4 the damage falls from 1.5 to 0.5.
        let mut damage = [0.2, 1.5, 0.5, 0.1];
        assert_eq!(pit(&depths, &mut damage, 3), 3.0);
        // The depths are those below the new surface: 4, 5, 7 and 11, where nothing was known.
        for (found, expected) in damage.into_iter().zip([0.5, 0.4, 0.2, 0.0]) {
            assert!((found - expected).abs() < 1e-12, "{damage:?}");
        }
        // Only as deep as asked for.
        let mut damage = [0.2, 0.9, 1.5, 0.1];
        assert_eq!(pit(&depths, &mut damage, 2), 0.0);
        // All of it has failed.
        let mut damage = [2.0; 4];
        assert_eq!(pit(&depths, &mut damage, 2), 2.0);
    }

    #[test]
    fn the_residual_stress_is_linear_between_layers_and_ends_with_them() {
        let shape = [2, 3];
        let grid = Grid::new(shape, [1.0; 2]).unwrap();
        // The layers have the centres 0.5, 2 and 4.5; the trace of a layer is 3, 6 and 12 times x + 1.
        let mut residual_stress = TensorField::zeros((3, 6, shape[0], shape[1]));
        for (layer, size) in [1.0, 2.0, 4.0].into_iter().enumerate() {
            for ((i, _), stress) in residual_stress
                .slice_mut(ndarray::s![layer, Component::Zz as usize, .., ..])
                .indexed_iter_mut()
            {
                *stress = 3.0 * size * (i as f64 + 1.0);
            }
        }
        let volume = PlasticVolume {
            body: 0,
            grid,
            faces: vec![0.0, 1.0, 3.0, 6.0],
            state: PlasticState {
                accumulated: residual_stress.sum_axis(Axis(1)),
                strain: residual_stress.clone(),
                back_stress: None,
            },
            residual_stress,
            displacement: Field::zeros(shape),
            max_strain: (0.0, [0.0; 3]),
            yielded_volume: 0.0,
            stored_energy: 0.0,
        };
        for (depth, expected) in [(0.0, 1.0), (0.5, 1.0), (1.25, 1.5), (2.0, 2.0), (5.0, 4.0), (7.0, 0.0)] {
            let found = residual_hydrostatic(&volume, depth);
            assert!((found[[0, 1]] - expected).abs() < 1e-12, "{depth}: {found}");
            assert!((found[[1, 2]] - 2.0 * expected).abs() < 1e-12);
        }
    }
}
