//! The rows of passes and of points.

use asperity::motion::{PassRecord, SweepRecord};
use asperity::study::case::{Case, Source};
use asperity::units::Dimension::{Area, Force, Length, Pressure, Stiffness, Volume};

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
}

impl Rows {
    pub(super) fn new(case: &Case) -> Self {
        let has_ends = case.contact.boundary != asperity::operator::Boundary::PERIODIC;
        Self {
            columns: Columns::default(),
            planes: planes(case),
            apart: false,
            rim: if has_ends && case.motion.is_some() { case.output.rim } else { 0.0 },
            slides: case.friction.is_some(),
            yields: [&case.lower, &case.upper].iter().any(|body| body.hardness.yields()),
        }
    }

    /// The row of a pass, the first below the heads of the columns and what they are.
    pub(super) fn pass(&mut self, pass: &PassRecord) -> String {
        let mut cells = vec![
            self.approach(pass.pass == 1, pass.approach),
            Cell::of("load", Force, pass.mean_load),
            Cell::of("p max", Pressure, pass.max_pressure),
            Cell::of("area", Area, pass.mean_contact_area_interior),
        ];
        if self.yields {
            let plastic = pass.lost_inside("plastic")[0] + pass.lost_inside("plastic")[1];
            cells.push(Cell::of("plastic", Volume, plastic));
        }
        cells.push(Cell::of("Sq lower", Length, pass.sq_lower_interior));
        cells.push(Cell::of("Sq upper", Length, pass.sq_upper_interior));
        if self.slides {
            cells.push(Cell::number("friction", pass.friction_coefficient));
        }
        let mut above = String::new();
        if pass.pass == 1 {
            above = "load and area: means over the pass".to_owned();
            if self.apart {
                above += &format!("; apart: between the {}", self.planes);
            }
            above += "\n";
            if self.rim > 0.0 {
                let of = if self.yields { "area, plastic volume, Sq" } else { "area, Sq" };
                above += &format!("{of}: without the rim, {} of the length at free ends\n", self.rim);
            }
        }
        above + &self.columns.row("pass", pass.pass, &cells)
    }

    /// The row of a point of a sweep, the first below the heads of the columns.
    pub(super) fn point(&mut self, point: &SweepRecord) -> String {
        let first = point.point == 1;
        let approach = self.approach(first, point.approach);
        let mut cells = vec![Cell::of("load", Force, point.load)];
        if self.slides {
            // What rounding leaves of a force that is not there.
            let force = |force: f64| if force.abs() < 1e-6 * point.load { 0.0 } else { force };
            cells.extend([
                Cell::number("creep x", point.creepage_x),
                Cell::number("creep y", point.creepage_y),
                Cell::of("force x", Force, force(point.tangential_force_x)),
                Cell::of("force y", Force, force(point.tangential_force_y)),
                Cell::of("shear", Pressure, point.max_shear),
                Cell::share("stick", point.stick_area / point.contact_area),
                Cell::share("area", point.contact_fraction),
            ]);
        } else {
            cells.extend([
                Cell::of("p mean", Pressure, point.mean_pressure),
                approach,
                Cell::of("gap", Length, point.mean_gap),
                Cell::share("area", point.contact_fraction),
                Cell::of("p max", Pressure, point.max_pressure),
            ]);
            if self.yields {
                cells.push(Cell::of("plastic", Volume, point.plastic_volume));
            }
            cells.push(Cell::of("stiff", Stiffness, point.stiffness));
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
            true => Cell::of("apart", Length, -approach),
            false => Cell::of("approach", Length, approach),
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
