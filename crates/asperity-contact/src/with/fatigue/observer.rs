//! Fatigue below the bodies of a case.

use ndarray::{Array3, Axis};

use super::limited_bodies::{Limited, LimitedBodies};
use super::memory::states;
use super::smooth::Smooth;
use super::{Critical, Fatigue, FatigueRecord, OnBody, critical, critical_depths};
use crate::error::Result;
use crate::grid::{Field, Grid};
use crate::motion::{Body, CycleReport, ObservedContact};
use crate::with::{BodyField, Given, NamedField, Observer, Place};

/// Tells what the memory of a load cycle has found.
#[derive(Debug)]
pub struct FatigueObserver {
    bodies: LimitedBodies,
    /// The bodies without roughness, if the risk over theirs is asked for.
    smooth: Option<Smooth>,
}

impl FatigueObserver {
    pub(super) fn new(fatigue: &Fatigue, given: &Given<'_>) -> Result<Self> {
        let bodies = LimitedBodies::new(fatigue, given)?;
        let asks = bodies.limited().any(|(_, body)| body.risk);
        let smooth = asks.then(|| Smooth::new(given)).transpose()?;
        Ok(Self { bodies, smooth })
    }

    /// Returns the row and the fields of a body.
    fn of_body(
        &self,
        (index, limited): (usize, &Limited),
        (body, grid): (&Body, Grid),
        report: &CycleReport<'_>,
    ) -> Result<(FatigueRecord, Vec<BodyField>)> {
        let LimitedBodies { fatigue, boundary, .. } = &self.bodies;
        let depths = &limited.depths;
        let states = |name: fn(usize) -> String| -> Vec<&Field> {
            (0..depths.len()).map(|k| &body.state[&name(k)].values).collect()
        };
        let (of_cycle, so_far) = (states(states::over_limit), states(states::damage));
        let [nx, ny] = grid.shape;
        let all =
            |fields: &[&Field]| Array3::from_shape_fn((depths.len(), nx, ny), |(k, i, j)| fields[k][[i, j]]);
        let (over, suffered) = (all(&of_cycle), all(&so_far));
        let each = over.mapv(|over| limited.damage.damage(over));
        let (critical, of_critical) = if limited.is_covered() {
            (Critical::default(), Vec::new())
        } else {
            critical::of_body(body, critical_depths(depths, &each))
        };
        let most = |values: &Array3<f64>| {
            values.fold_axis(Axis(0), f64::NEG_INFINITY, |most, value| most.max(*value))
        };
        let (place, largest_over) =
            over.indexed_iter().fold(((0, 0, 0), f64::NEG_INFINITY), |best, (at, over)| {
                if *over > best.1 { (at, *over) } else { best }
            });
        let largest = |values: &mut dyn Iterator<Item = &f64>| values.copied().fold(0.0, f64::max);
        let share = |count: usize| count as f64 / grid.cells() as f64;
        let left = suffered.iter().zip(&each).map(|(damage, each)| (1.0 - damage).max(0.0) / each);
        let left = left.filter(|left| left.is_finite()).reduce(f64::min);
        let pass = report.pass.as_ref();
        let plastic = pass.filter(|pass| pass.plastic_volumes.iter().any(|volume| volume.body == index));
        let life_ratio = match (&self.smooth, pass) {
            (Some(smooth), Some(pass)) if limited.risk => smooth.life_ratio(
                &self.bodies,
                (index, limited),
                (pass.motion, &|| report.stop()),
                &of_cycle,
            )?,
            _ => None,
        };
        let row = FatigueRecord {
            pass: pass.map(|pass| pass.record.pass),
            stage: report.stage,
            cycle: report.stage.map(|_| report.done),
            step: report.step,
            body: if index == 0 { OnBody::Lower } else { OnBody::Upper },
            mean_pressure: report.mean_pressure,
            over_limit: largest_over,
            x: grid.centre(0, place.1),
            y: grid.centre(1, place.2),
            depth: depths[place.0],
            edge_cells: (0..2)
                .filter(|axis| !boundary.repeats(*axis))
                .map(|axis| {
                    let cell = [place.1, place.2][axis];
                    cell.min(grid.shape[axis] - 1 - cell)
                })
                .min(),
            damage_of_pass: largest(&mut each.iter()),
            damage: largest(&mut suffered.iter()),
            life: left.map(|left| report.done as f64 + left),
            critical,
            pitted_share: body
                .state
                .get(states::PITTED)
                .map(|pitted| share(pitted.values.iter().filter(|depth| **depth > 0.0).count())),
            life_ratio,
            plastic_work: plastic
                .and_then(|pass| pass.record.plastic)
                .map(|plastic| [plastic.plastic_work_lower, plastic.plastic_work_upper][index]),
            stride: pass.map(|pass| {
                (pass.motion.stride * fatigue.every) as f64 / pass.record.largest_spot_cells.max(1) as f64
            }),
        };
        let name = ["lower", "upper"][index];
        let field =
            |what: &str, unit, grid, values| BodyField { name: format!("{what}_{name}"), unit, grid, values };
        let (in_depth, section) = section(limited, &of_cycle, grid, place.2);
        let mut fields = vec![
            field("over_limit", "1", grid, most(&over)),
            field("over_limit_section", "1", in_depth, section),
            field("damage", "1", grid, most(&suffered)),
        ];
        fields.extend(of_critical.into_iter().map(|(what, values)| field(what, "m", grid, values)));
        Ok((row, fields))
    }
}

/// Returns f over its limit below a row of cells, linear between the depths and evenly spaced; 0 in layers.
fn section(limited: &Limited, over_limit: &[&Field], grid: Grid, row: usize) -> (Grid, Field) {
    /// Rows of cells of a section.
    const ROWS: usize = 96;
    let depths = &limited.depths;
    let step = depths[depths.len() - 1] / ROWS as f64;
    let values = Field::from_shape_fn([grid.shape[0], ROWS], |(i, k)| {
        let depth = (k as f64 + 0.5) * step;
        if limited.is_covered() && depth < depths[0] {
            return 0.0;
        }
        let below = depths.partition_point(|z| *z <= depth).min(depths.len() - 1);
        let above = below.saturating_sub(1);
        let share = match depths[below] - depths[above] {
            0.0 => 0.0,
            apart => ((depth - depths[above]) / apart).clamp(0.0, 1.0),
        };
        (1.0 - share) * over_limit[above][[i, row]] + share * over_limit[below][[i, row]]
    });
    (Grid { shape: [grid.shape[0], ROWS], pitch: [grid.pitch[0], step] }, values)
}

impl Observer for FatigueObserver {
    type Row = FatigueRecord;

    fn observe(&self, _: Place, _: &ObservedContact<'_>) -> Result<(Vec<FatigueRecord>, Vec<NamedField>)> {
        Ok((Vec::new(), Vec::new()))
    }

    fn after_cycle(&self, report: &CycleReport<'_>) -> Result<(Vec<FatigueRecord>, Vec<BodyField>)> {
        let (mut rows, mut fields) = (Vec::new(), Vec::new());
        if !self.bodies.fatigue.wants(report.number) {
            return Ok((rows, fields));
        }
        let pair = report.pair;
        let bodies = [(&pair.lower, pair.lower_grid()), (&pair.upper, pair.upper_grid())];
        for (index, limited) in self.bodies.limited() {
            let (row, of_body) = self.of_body((index, limited), bodies[index], report)?;
            rows.push(row);
            fields.extend(of_body);
        }
        Ok((rows, fields))
    }
}
