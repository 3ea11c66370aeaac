//! Fatigue below the bodies of a case.

use ndarray::Array3;

use super::{AtDepth, Basquin, DangVan, Fatigue, FatigueRecord, OnBody, StressHistory, critical_wear};
use crate::error::Result;
use crate::grid::{Field, Grid};
use crate::motion::{Contact, ObservedContact, PassReport};
use crate::operator::Boundary;
use crate::units::Metre;
use crate::with::{BodyField, Given, NamedField, Observer, Place};

/// Computes the fatigue of a pass.
#[derive(Debug)]
pub struct FatigueObserver {
    fatigue: Fatigue,
    boundary: Boundary,
    depths: Vec<Metre>,
    /// The bodies that have limits, lower one first.
    bodies: [Option<Limited>; 2],
}

/// A body with its limits.
#[derive(Debug)]
struct Limited {
    poisson: f64,
    criterion: DangVan,
    damage: Basquin,
}

impl FatigueObserver {
    pub(super) fn new(fatigue: &Fatigue, given: &Given<'_>) -> Result<Self> {
        let surroundings = &given.surroundings;
        let limited = |index: usize| {
            let body = &surroundings.bodies[index];
            let limits = body.properties.fatigue.as_ref();
            limits
                .map(|limits| {
                    let (criterion, damage) = (limits.criterion()?, limits.damage()?);
                    Ok(Limited { poisson: body.material.poisson, criterion, damage })
                })
                .transpose()
        };
        Ok(Self {
            depths: fatigue.depths(given.pair.pitch()),
            fatigue: fatigue.clone(),
            boundary: surroundings.boundary,
            bodies: [limited(0)?, limited(1)?],
        })
    }

    /// Computes what a body with this `grid` has seen in a pass.
    fn of_body(
        &self,
        index: usize,
        body: &Limited,
        grid: Grid,
        report: &PassReport<'_>,
    ) -> Result<Vec<AtDepth>> {
        let pair = report.pair;
        let sign = if index == 0 { 1.0 } else { -1.0 };
        let contacts: Vec<&Contact> = report.contacts.iter().step_by(self.fatigue.every).collect();
        let tractions = |position: usize| {
            let contact = contacts[position];
            let pressure = contact.pressure_field(pair.lower.width());
            let placement = pair.placements(&contact.position)[index];
            let sliding = report.motion.sliding(contact.position.stroke);
            let shear = sliding.map(|sliding| placement.onto(&pressure.mapv(|p| sign * sliding.shear(p)[0])));
            (placement.onto(&pressure), shear)
        };
        StressHistory::new(grid, self.boundary, body.poisson, contacts.len(), tractions)
            .dang_van(&body.criterion, &self.depths)
    }

    /// Returns the row and the fields of a body.
    fn summarised(
        &self,
        index: usize,
        body: &Limited,
        grid: Grid,
        found: &[AtDepth],
        report: &PassReport<'_>,
    ) -> (FatigueRecord, Vec<BodyField>) {
        let (depths, every) = (&self.depths, self.fatigue.every);
        let [nx, ny] = grid.shape;
        let limit = body.criterion.limit();
        let over = Array3::from_shape_fn((found.len(), nx, ny), |(k, i, j)| found[k].f[[i, j]] / limit);
        let damage = over.mapv(|over| body.damage.damage(over));
        let wear = damage.map_axis(ndarray::Axis(0), |column| critical_wear(depths, &column.to_vec()));
        let worst = over.fold_axis(ndarray::Axis(0), f64::NEG_INFINITY, |most, over| most.max(*over));
        let (place, most) = over.indexed_iter().fold(((0, 0, 0), f64::NEG_INFINITY), |best, (at, over)| {
            if *over > best.1 { (at, *over) } else { best }
        });
        let largest = |field: &Field| field.iter().copied().fold(0.0, f64::max);
        let most_wear = largest(&wear);
        let critical = wear.iter().filter(|wear| **wear > 0.1 * most_wear).count();
        let spot = report.record.largest_spot_cells.max(1) as f64;
        let row = FatigueRecord {
            pass: report.record.pass,
            step: report.contacts.len(),
            body: if index == 0 { OnBody::Lower } else { OnBody::Upper },
            mean_pressure: report.record.mean_pressure,
            over_limit: most,
            x: grid.centre(0, place.1),
            y: grid.centre(1, place.2),
            depth: depths[place.0],
            edge_cells: (0..2)
                .filter(|axis| !self.boundary.repeats(*axis))
                .map(|axis| {
                    let cell = [place.1, place.2][axis];
                    cell.min(grid.shape[axis] - 1 - cell)
                })
                .min(),
            shear_amplitude: found.iter().map(|at| largest(&at.shear_amplitude)).fold(0.0, f64::max),
            damage: damage.iter().copied().fold(0.0, f64::max),
            critical_wear: most_wear,
            critical_share: if most_wear > 0.0 { critical as f64 / grid.cells() as f64 } else { 0.0 },
            stride: (report.motion.stride * every) as f64 / spot,
        };
        let name = ["lower", "upper"][index];
        let mut fields = vec![
            BodyField { body: index, name: format!("over_limit_{name}"), unit: "1", values: worst },
            BodyField { body: index, name: format!("critical_wear_{name}"), unit: "m", values: wear },
        ];
        for (k, plane) in over.outer_iter().enumerate() {
            let name = format!("over_limit_{name}_{:02}", k + 1);
            fields.push(BodyField { body: index, name, unit: "1", values: plane.to_owned() });
        }
        (row, fields)
    }
}

impl Observer for FatigueObserver {
    type Row = FatigueRecord;

    fn observe(&self, _: Place, _: &ObservedContact<'_>) -> Result<(Vec<FatigueRecord>, Vec<NamedField>)> {
        Ok((Vec::new(), Vec::new()))
    }

    fn after_pass(&self, report: &PassReport<'_>) -> Result<(Vec<FatigueRecord>, Vec<BodyField>)> {
        let (mut rows, mut fields) = (Vec::new(), Vec::new());
        if !self.fatigue.wants(report.record.pass) {
            return Ok((rows, fields));
        }
        let grids = [report.pair.lower_grid(), report.pair.upper_grid()];
        for (index, (body, grid)) in self.bodies.iter().zip(grids).enumerate() {
            let Some(body) = body else { continue };
            let found = self.of_body(index, body, grid, report)?;
            let (row, of_body) = self.summarised(index, body, grid, &found, report);
            rows.push(row);
            fields.extend(of_body);
        }
        Ok((rows, fields))
    }
}
