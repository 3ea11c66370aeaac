//! Rows of passes and of points.

use std::collections::BTreeMap;

use asperity::each;
use asperity::motion::{PassRecord, StepCell, SweepRecord};
use asperity::study::Results;
use asperity::study::case::{Case, Source};
use asperity::with::views::{PassCell, RowCell};
use asperity::with::{BodyLaw, Capability, Listed, Row, interface_cell, interface_cells};

use super::columns::{Cell, Columns};

/// Table of passes or of points of a case.
pub(super) struct Rows {
    columns: Columns,
    /// Reference of the approach.
    planes: &'static str,
    /// Whether the column is the distance of the planes, determined by the first row.
    apart: bool,
    /// Fraction of the bodies' length that is the rim at free ends; 0 without a rim.
    rim: f64,
    slides: bool,
    yields: bool,
    flows: bool,
    /// Number of finished passes of the motion.
    done: usize,
    /// The columns of the laws that change a body, each with the sum of its values.
    laws: Vec<(PassCell, f64)>,
    /// Numbers of capabilities in the row of the next pass.
    found: Vec<StepCell>,
    /// Their numbers in the rows of the passes before an interruption, by pass.
    earlier: BTreeMap<usize, Vec<StepCell>>,
    /// The heads of these columns: those that have a number in the first row.
    heads: Option<Vec<&'static str>>,
}

impl Rows {
    pub(super) fn new(case: &Case) -> Self {
        let bodies = [&case.lower, &case.upper];
        let motion = case.motion.as_ref();
        let mut laws = Vec::new();
        each!(law L => if bodies.iter().any(|body| L::of(&body.laws).is_some()) {
            laws.push((L::CELL, 0.0));
        });
        let mut found = Vec::new();
        each!(capability C => found.extend(C::of(&case.with).into_iter().flat_map(|asked| asked.cells(&[]))));
        let has_ends = case.contact.boundary != asperity::operator::Boundary::PERIODIC;
        Self {
            columns: motion.map_or_else(Columns::default, |motion| Columns::counting_to(motion.passes)),
            planes: planes(case),
            apart: false,
            rim: if has_ends && motion.is_some() { case.output.rim } else { 0.0 },
            slides: case.friction.is_some(),
            yields: bodies.iter().any(|body| body.hardness.yields()),
            flows: bodies.iter().any(|body| body.plasticity.is_some()),
            done: 0,
            laws,
            found,
            earlier: BTreeMap::new(),
            heads: None,
        }
    }

    /// Returns the row of a pass, the first one with the heads of the columns and their explanation.
    ///
    /// Every table has load, largest pressure and contact area. Columns beyond the width of a terminal are
    /// left out by rank.
    pub(super) fn pass(&mut self, pass: &PassRecord) -> String {
        self.done += pass.represents();
        let mut ranked = vec![
            (Rank::Always, Cell::new("load", "mean_load", pass.mean_load)),
            (Rank::Always, Cell::new("p max", "max_pressure", pass.max_pressure)),
            (Rank::Always, Cell::new("area", "mean_contact_area", pass.mean_contact_area)),
        ];
        ranked.insert(0, (Rank::Approach, self.approach(pass.pass == 1, pass.approach)));
        if self.rim > 0.0 {
            let inside = pass.mean_contact_area_interior;
            ranked.push((Rank::Always, Cell::new("inside", "mean_contact_area_interior", inside)));
        }
        if self.yields {
            let plastic = pass.lost_inside("plastic")[0] + pass.lost_inside("plastic")[1];
            ranked.push((Rank::Plastic, Cell::new("plastic", "plastic_volume_lower_interior", plastic)));
        }
        if let Some(plastic) = &pass.plastic {
            let work = plastic.plastic_work_lower + plastic.plastic_work_upper;
            ranked.push((Rank::Always, Cell::new("work", "plastic_work_lower", work)));
        }
        for RowCell { head, column, value, .. } in pass.interface.iter().flat_map(interface_cells) {
            ranked.push((Rank::Always, Cell::new(head, column, value)));
        }
        if let Some(drag) = &pass.drag {
            ranked.push((Rank::Always, Cell::new("drag/W", "drag_coefficient", drag.drag_coefficient)));
        }
        if let Some(film) = &pass.film {
            ranked.push((Rank::Always, Cell::new("film", "mean_film", film.mean_film)));
            ranked.push((Rank::Always, Cell::share("solids", film.solid_share)));
            ranked.push((Rank::Always, Cell::new("T/W", "traction_coefficient", film.traction_coefficient)));
        }
        ranked.push((Rank::Roughness, Cell::new("Sq lower", "sq_lower_interior", pass.sq_lower_interior)));
        ranked
            .push((Rank::UpperRoughness, Cell::new("Sq upper", "sq_upper_interior", pass.sq_upper_interior)));
        ranked.extend(self.of_laws(pass));
        let found = self.earlier.get(&pass.pass).unwrap_or(&self.found).clone();
        let known = || found.iter().filter(|cell| cell.value.is_some()).map(|cell| cell.head).collect();
        let heads = self.heads.get_or_insert_with(known);
        for StepCell { head, column, value } in found.into_iter().filter(|cell| heads.contains(&cell.head)) {
            let cell =
                column.map_or_else(|| Cell::share(head, value), |column| Cell::new(head, column, value));
            ranked.push((Rank::Always, cell));
        }
        match &pass.running {
            Some(running) if running.max_flash_temperature.is_finite() => {
                let temperature = Cell::new("T max", "max_flash_temperature", running.max_flash_temperature);
                ranked.push((Rank::Always, temperature));
            }
            Some(_) => {}
            None if self.slides => {
                let friction = Cell::new("friction", "friction_coefficient", pass.friction_coefficient);
                ranked.push((Rank::Friction, friction));
            }
            None => {}
        }
        let (cells, left_out) = within_a_terminal(ranked);
        let above = if pass.pass == 1 { self.above(&left_out) } else { String::new() };
        above + &self.columns.row("pass", self.done, &cells)
    }

    /// Receives what capabilities show in the row of the next pass.
    pub(super) fn set_step_cells(&mut self, cells: &[StepCell]) {
        self.found = cells.to_vec();
    }

    /// Continues the table after the passes of a `case` that are in its results.
    pub(super) fn continued(mut self, case: &Case, results: &Results) -> Self {
        each!(capability C => if let Some(asked) = C::of(&case.with) {
            let rows = results.rows::<C>().unwrap_or_default();
            for rows in rows.chunk_by(|one, next| one.pass() == next.pass()) {
                let cells = self.earlier.entry(rows[0].pass().unwrap_or_default()).or_default();
                cells.extend(asked.cells(rows));
            }
        });
        self
    }

    /// Returns the cells of the laws in the row of a pass.
    fn of_laws(&mut self, pass: &PassRecord) -> Vec<(Rank, Cell)> {
        let cell = |(cell, sum): &mut (PassCell, f64)| {
            *sum = if cell.adds_up { *sum } else { 0.0 } + (cell.value)(pass);
            (Rank::Always, Cell::growing(cell.head, cell.column, cell.least, *sum))
        };
        self.laws.iter_mut().map(cell).collect()
    }

    /// Returns the lines above the heads of the columns of passes.
    fn above(&self, left_out: &[&str]) -> String {
        let mut above = "load, area: means over the pass".to_owned();
        if self.apart && !left_out.contains(&"apart") {
            above += &format!("; apart: distance of the {}", self.planes);
        }
        for (cell, _) in &self.laws {
            above += &format!("; {}", cell.about);
        }
        if self.flows {
            above += "; work: plastic, in the pass";
        }
        above += "\n";
        if self.rim > 0.0 {
            let laws = self.laws.iter().map(|(cell, _)| (cell.head, cell.head, cell.is_inside));
            let of = [("Sq lower", "Sq", true), ("plastic", "plastic", self.yields)].into_iter().chain(laws);
            let of = of.filter(|(head, _, shown)| *shown && !left_out.contains(head));
            let of: Vec<&str> = of.map(|(_, name, _)| name).collect();
            above += &format!(
                "inside: without the rim, {} of the length at free ends; {} too\n",
                self.rim,
                of.join(", ")
            );
        }
        if !left_out.is_empty() {
            above += &format!("not in this table: {}, see passes.csv\n", left_out.join(", "));
        }
        above
    }

    /// Returns the row of a point of a sweep, the first one with the heads of the columns.
    pub(super) fn point(&mut self, point: &SweepRecord) -> String {
        let first = point.point == 1;
        let approach = self.approach(first, point.approach);
        let mut cells: Vec<Cell> = Vec::new();
        if let Some(speed) = point.speed {
            cells.push(Cell::new("speed", "speed", speed));
        }
        cells.push(Cell::new("load", "load", point.load));
        if let Some(lubrication) = point.lubrication {
            let film = lubrication.film;
            cells.extend([
                Cell::new("film", "mean_film", film.mean_film),
                Cell::new("central", "central_film", lubrication.central_film),
                Cell::new("least", "min_film", film.min_film),
                Cell::new("λ", "lambda", film.lambda),
                Cell::share("solids", film.solid_share),
                Cell::new("T/W", "traction_coefficient", film.traction_coefficient),
                Cell::new("p max", "max_pressure", point.max_pressure),
            ]);
        } else if self.slides {
            // The rounding error of a zero force.
            let shown = |ratio: f64| if ratio.abs() < 1e-6 { 0.0 } else { ratio };
            let traction = point.traction();
            let along = |axis: usize| traction.map(|ratio| shown(ratio[axis]));
            cells.extend([
                Cell::new("creep x", "creepage_x", point.creepage_x),
                Cell::new("creep y", "creepage_y", point.creepage_y),
                Cell::new("T/W x", "friction_coefficient", along(0)),
                Cell::new("T/W y", "friction_coefficient", along(1)),
                Cell::new("shear", "max_shear", point.max_shear),
                Cell::share("stick", point.stick_area / point.contact_area),
                Cell::share("area", point.contact_fraction),
            ]);
        } else {
            cells.extend([
                Cell::new("p mean", "mean_pressure", point.mean_pressure),
                approach,
                Cell::new("gap", "mean_gap", point.mean_gap),
                Cell::share("area", point.contact_fraction),
                Cell::new("p max", "max_pressure", point.max_pressure),
            ]);
            if self.yields {
                cells.push(Cell::new("plastic", "plastic_volume", point.plastic_volume));
            }
            cells.push(match (&point.interface, point.steady) {
                (Some(interface), _) => {
                    let RowCell { head, column, value, .. } = interface_cell(interface);
                    Cell::new(head, column, value)
                }
                (None, Some(steady)) => Cell::new("drag/W", "drag_coefficient", steady.drag_coefficient),
                (None, None) => match point.plastic {
                    Some(flow) => Cell::share("strain", flow.max_plastic_strain),
                    None => Cell::new("stiff", "stiffness", point.stiffness),
                },
            });
        }
        let above = match (first, self.slides) {
            (true, _) if point.lubrication.is_some() => {
                "film: mean over the contact; T/W: traction coefficient; solids: share of the load\n"
                    .to_owned()
            }
            (true, true) => {
                "T/W: traction coefficient, tangential force over load; area: of the grid\n".to_owned()
            }
            (true, false) if self.apart => format!("gap: mean; apart: distance of the {}\n", self.planes),
            _ => String::new(),
        };
        above + &self.columns.row("point", point.point, &cells)
    }

    /// Returns the approach, or the distance of the planes if they are apart in the first row.
    fn approach(&mut self, first: bool, approach: f64) -> Cell {
        if first {
            self.apart = approach < 0.0;
        }
        if self.apart {
            Cell::new("apart", "approach", -approach)
        } else {
            Cell::new("approach", "approach", approach)
        }
    }
}

/// Rank of a column. If space is short, the last ones are left out first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Rank {
    Always,
    Roughness,
    Friction,
    Plastic,
    Approach,
    UpperRoughness,
}

/// Returns the cells that fit into a terminal of 80 characters, in order, and the heads of the others.
fn within_a_terminal(mut ranked: Vec<(Rank, Cell)>) -> (Vec<Cell>, Vec<&'static str>) {
    const ROOM: usize = 8;
    let mut left_out = Vec::new();
    while ranked.len() > ROOM {
        let last =
            (0..ranked.len()).max_by_key(|at| ranked[*at].0).expect("there are more than a row has room for");
        if ranked[last].0 == Rank::Always {
            break;
        }
        left_out.push(ranked.remove(last).1.head());
    }
    (ranked.into_iter().map(|(_, cell)| cell).collect(), left_out)
}

/// Describes the planes whose distance is −approach: z = 0 of both bodies, the mean of a levelled or
/// generated surface.
pub(super) fn planes(case: &Case) -> &'static str {
    let has_mean_zero = |source: &Source, levelled: bool| match source {
        Source::Form { .. } => false,
        Source::File { .. } | Source::Given { .. } => levelled,
        _ => true,
    };
    let all = [&case.lower, &case.upper].iter().all(|body| {
        let topography = &body.topography;
        has_mean_zero(&topography.source, topography.preparation.level != asperity::surface::Level::None)
    });
    if all { "mean planes" } else { "planes z = 0" }
}
