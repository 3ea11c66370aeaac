//! The rows of passes and of points.

use asperity::motion::{PassRecord, RunningRecord, SweepRecord};
use asperity::study::case::{Case, ControlKind, Source};

use super::columns::{Cell, Columns};

/// A table of passes or of points, as a case has it.
pub(super) struct Rows {
    columns: Columns,
    /// What `approach` refers to.
    planes: &'static str,
    /// The first row settles whether the planes are told to be apart.
    apart: bool,
    /// The part of the bodies' length that is their rim at free ends; 0 where they have none.
    rim: f64,
    slides: bool,
    yields: bool,
    wears: bool,
    grows: bool,
    flows: bool,
    /// Whether the passes have the approach given.
    at_approach: bool,
    /// Passes of the motion that are done, and the wear of both bodies in them, m³.
    done: usize,
    wear: f64,
}

impl Rows {
    pub(super) fn new(case: &Case) -> Self {
        let bodies = [&case.lower, &case.upper];
        let motion = case.motion.as_ref();
        let has_ends = case.contact.boundary != asperity::operator::Boundary::PERIODIC;
        Self {
            columns: motion.map_or_else(Columns::default, |motion| Columns::counting_to(motion.passes)),
            planes: planes(case),
            apart: false,
            rim: if has_ends && motion.is_some() { case.output.rim } else { 0.0 },
            slides: case.friction.is_some(),
            yields: bodies.iter().any(|body| body.hardness.yields()),
            wears: bodies.iter().any(|body| body.wear.is_some()),
            flows: bodies.iter().any(|body| body.plasticity.is_some()),
            grows: bodies.iter().any(|body| body.film.is_some()),
            at_approach: motion.is_some_and(|motion| motion.control == ControlKind::Approach),
            done: 0,
            wear: 0.0,
        }
    }

    /// The row of a pass, the first below the heads of the columns and what they are.
    ///
    /// Where bodies run in, what was prescribed and the largest pressure make room for wear, film and temperature.
    pub(super) fn pass(&mut self, pass: &PassRecord) -> String {
        self.done += pass.represents();
        let running = pass.running.as_ref();
        let approach = self.approach(pass.pass == 1, pass.approach);
        let load = Cell::of("load", "mean_load", pass.mean_load);
        let mut cells = match running {
            None => vec![approach, load, Cell::of("p max", "max_pressure", pass.max_pressure)],
            Some(_) => vec![if self.at_approach { load } else { approach }],
        };
        cells.push(Cell::of("area", "mean_contact_area_interior", pass.mean_contact_area_interior));
        if self.yields {
            let plastic = pass.lost_inside("plastic")[0] + pass.lost_inside("plastic")[1];
            cells.push(Cell::of("plastic", "plastic_volume_lower_interior", plastic));
        }
        if let Some(flow) = &pass.flow {
            let work = flow.plastic_work_lower + flow.plastic_work_upper;
            cells.push(Cell::of("work", "plastic_work_lower", work));
        }
        cells.push(Cell::of("Sq lower", "sq_lower_interior", pass.sq_lower_interior));
        cells.push(Cell::of("Sq upper", "sq_upper_interior", pass.sq_upper_interior));
        match running {
            Some(running) => cells.extend(self.running(pass, running)),
            None if self.slides => {
                cells.push(Cell::of("friction", "friction_coefficient", pass.friction_coefficient))
            }
            None => {}
        }
        let above = if pass.pass == 1 { self.above(running) } else { String::new() };
        above + &self.columns.row("pass", self.done, &cells)
    }

    /// What wear, films and friction's heat add to the row of a pass.
    fn running(&mut self, pass: &PassRecord, running: &RunningRecord) -> Vec<Cell> {
        let mut cells = Vec::new();
        if self.wears {
            self.wear += pass.lost_inside("wear")[0] + pass.lost_inside("wear")[1];
            cells.push(Cell::growing("wear", "wear_volume_lower_interior", 1e-18, self.wear));
        }
        if self.grows {
            let film = running.mean_film_lower.max(running.mean_film_upper);
            cells.push(Cell::growing("film", "mean_film_lower", 1e-9, film));
        }
        if running.max_flash_temperature.is_finite() {
            cells.push(Cell::of("T max", "max_flash_temperature", running.max_flash_temperature));
        }
        cells
    }

    /// What the columns of passes are.
    fn above(&self, running: Option<&RunningRecord>) -> String {
        let means = match running {
            Some(_) if !self.at_approach => "area: mean over the pass",
            _ => "load and area: means over the pass",
        };
        let mut above = means.to_owned();
        if self.apart && (running.is_none() || !self.at_approach) {
            above += &format!("; apart: between the {}", self.planes);
        }
        if self.wears {
            above += "; wear: of both bodies so far";
        }
        if self.grows {
            above += "; film: mean of the thicker";
        }
        if self.flows {
            above += "; work: plastic, in the pass";
        }
        above += "\n";
        if self.rim > 0.0 {
            let of = [("area", true), ("plastic volume", self.yields), ("Sq", true), ("wear", self.wears)];
            let of: Vec<&str> = of.into_iter().filter(|(_, shown)| *shown).map(|(name, _)| name).collect();
            above +=
                &format!("{}: without the rim, {} of the length at free ends\n", of.join(", "), self.rim);
        }
        above
    }

    /// The row of a point of a sweep, the first below the heads of the columns.
    pub(super) fn point(&mut self, point: &SweepRecord) -> String {
        let first = point.point == 1;
        let approach = self.approach(first, point.approach);
        let mut cells = vec![Cell::of("load", "load", point.load)];
        if self.slides {
            // What rounding leaves of a force that is not there.
            let force = |force: f64| if force.abs() < 1e-6 * point.load { 0.0 } else { force };
            cells.extend([
                Cell::of("creep x", "creepage_x", point.creepage_x),
                Cell::of("creep y", "creepage_y", point.creepage_y),
                Cell::of("force x", "tangential_force_x", force(point.tangential_force_x)),
                Cell::of("force y", "tangential_force_y", force(point.tangential_force_y)),
                Cell::of("shear", "max_shear", point.max_shear),
                Cell::share("stick", point.stick_area / point.contact_area),
                Cell::share("area", point.contact_fraction),
            ]);
        } else {
            cells.extend([
                Cell::of("p mean", "mean_pressure", point.mean_pressure),
                approach,
                Cell::of("gap", "mean_gap", point.mean_gap),
                Cell::share("area", point.contact_fraction),
                Cell::of("p max", "max_pressure", point.max_pressure),
            ]);
            if self.yields {
                cells.push(Cell::of("plastic", "plastic_volume", point.plastic_volume));
            }
            cells.push(Cell::of("stiff", "stiffness", point.stiffness));
        }
        let above = match first && self.apart && !self.slides {
            true => format!("gap: mean; apart: between the {}\n", self.planes),
            false => String::new(),
        };
        above + &self.columns.row("point", point.point, &cells)
    }

    /// The approach, or how far the planes are apart if they are in the first row.
    fn approach(&mut self, first: bool, approach: f64) -> Cell {
        if first {
            self.apart = approach < 0.0;
        }
        match self.apart {
            true => Cell::of("apart", "approach", -approach),
            false => Cell::of("approach", "approach", approach),
        }
    }
}

/// The planes whose distance is −approach: z = 0 of both bodies, which is the mean of a levelled or generated surface.
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
