//! Figures of the law of a joint: each quantity with its band, beside theories.

use std::path::{Path, PathBuf};

use asperity_contact::flow::{patir_cheng, patir_cheng_shear};
use asperity_contact::joint::JointRecord;
use asperity_study::joint::{Band, Edge, Kind, Law, Quantity};

use super::sheet::Sheet;
use super::{Curves, FigureOptions};
use crate::draw::{Axis, Chart, Charts, Mark, Series, Unit};
use crate::error::Result;

/// Name of a band in legends.
const BAND: &str = "quantiles 0.16 to 0.84";

/// Draws the figures of a law into a folder, and returns their paths.
pub fn draw_joint(
    law: &Law,
    folder: &Path,
    wanted: &FigureOptions,
    stop: &(dyn Fn() -> bool + Sync),
) -> Result<Vec<PathBuf>> {
    let mut sheet = Sheet::into_folder(folder.to_owned(), &law.title, wanted, stop);
    curves(law).into_iter().try_for_each(|curves| sheet.add_curves(curves, ""))?;
    sheet.finish()
}

/// All curves of a law.
pub(crate) fn curves(law: &Law) -> Vec<Curves> {
    let mut all = vec![closure(law)];
    all.extend(over_pressure(law, "joint_stiffness", "stiffness of an area", &STIFFNESSES, &[STIFFNESS]));
    all.extend(over_pressure(law, "joint_area", "contact fraction", &AREA, &AREAS));
    for kind in [Kind::ThermalConductance, Kind::ElectricalConductance] {
        let shown = [(kind, "median")];
        all.extend(over_pressure(law, "joint_conductance", "conductance of an area", &shown, &[]));
    }
    all.extend(flow(law));
    all
}

const STIFFNESSES: [(Kind, &str); 3] =
    [(Kind::Stiffness, "normal"), (Kind::StiffnessX, "tangential, x"), (Kind::StiffnessY, "tangential, y")];
const STIFFNESS: Theory = ("normal, by Persson", JointRecord::persson_stiffness_of_area);
const AREA: [(Kind, &str); 1] = [(Kind::ContactFraction, "median")];
const AREAS: [Theory; 2] = [
    ("Persson", |row| row.persson_fraction),
    ("Bush, Gibson, Thomas", |row| row.bgt_fraction.filter(|fraction| *fraction < 1.0)),
];

/// Pressure over closure, with the continuation to 0, and Greenwood and Williamson at the same gaps.
fn closure(law: &Law) -> Curves {
    let points = |edge: Edge| law.closure(edge).into_iter().map(|[p, c]| [c, p]).collect::<Vec<_>>();
    let mut series = vec![Series::new("median", points(Edge::Median), Mark::LineAndPoints)];
    let rows = law.theories.iter().zip(law.closures(Edge::Median));
    let theory: Vec<_> =
        rows.filter_map(|(row, closure)| Some([closure, row.greenwood_williamson_pressure?])).collect();
    if !theory.is_empty() {
        series.push(Series::new("Greenwood, Williamson, at the gap of one sample", theory, Mark::Dashed));
    }
    let (x, y) = (Axis::linear("closure", Unit::Length), Axis::log("mean pressure", Unit::Pressure));
    let mut chart = Chart::new("", x, y, series);
    if law.samples > 1 {
        let soft = points(Edge::Low).into_iter().filter(|[_, p]| *p > 0.0);
        let stiff = points(Edge::High).into_iter().filter(|[_, p]| *p > 0.0).rev();
        chart.shaded = Some((BAND.to_owned(), vec![soft.chain(stiff).collect()]));
    }
    Curves::new("joint_closure", "pressure over the closure of the joint", chart)
}

/// A theory that is drawn beside a quantity: its name, and its value.
type Theory = (&'static str, fn(&JointRecord) -> Option<f64>);

/// Quantities over the mean pressure, the first one with its band, and theories beside. `None` without any of them.
fn over_pressure(
    law: &Law,
    name: &'static str,
    label: &'static str,
    shown: &[(Kind, &str)],
    theories: &[Theory],
) -> Option<Curves> {
    let known: Vec<(&Quantity, &str)> =
        shown.iter().filter_map(|(kind, name)| Some((law.quantity(*kind)?, *name))).collect();
    let (first, _) = known.first()?;
    let medians = |quantity: &Quantity| points(law, quantity, |band| band.median);
    let mut series: Vec<Series> = known
        .iter()
        .enumerate()
        .map(|(n, (quantity, name))| {
            let mark = [Mark::LineAndPoints, Mark::Line, Mark::Dashed][n.min(2)];
            Series::new(*name, medians(quantity), mark)
        })
        .collect();
    for (name, theory) in theories {
        let rows = law.pressures.iter().zip(&law.theories);
        let points: Vec<_> = rows.filter_map(|(p, row)| Some([*p, theory(row)?])).collect();
        if !points.is_empty() {
            series.push(Series::new(*name, points, Mark::Dashed));
        }
    }
    let unit = match first.kind.unit() {
        "" => Unit::Number,
        unit => Unit::Of(unit),
    };
    let chart = Chart::new("", Axis::log("mean pressure", Unit::Pressure), Axis::log(label, unit), series);
    let chart = with_band(law, chart, first);
    Some(Curves::new(name, format!("{label} over the mean pressure"), chart))
}

/// Flow factors over the mean gap in rms heights, beside Patir and Cheng.
fn flow(law: &Law) -> Option<Curves> {
    let sigma = law.rms_height.median;
    let gaps = law.values(Kind::FlowGap, Edge::Median)?;
    let ratios: Vec<f64> = gaps.iter().map(|gap| gap / sigma).collect();
    let of = |kind: Kind, name: &str, mark: Mark| {
        let values = law.values(kind, Edge::Median)?;
        Some(Series::new(name, ratios.iter().copied().zip(values).map(|(x, y)| [x, y]).collect(), mark))
    };
    let chart = |label: &str, series: Vec<Series>| {
        Chart::new(
            "",
            Axis::linear("mean gap over rms height", Unit::Number),
            Axis::linear(label, Unit::Number),
            series,
        )
    };
    let mut pressure: Vec<Series> =
        [of(Kind::FlowFactorX, "x", Mark::LineAndPoints), of(Kind::FlowFactorY, "y", Mark::DashedAndPoints)]
            .into_iter()
            .flatten()
            .collect();
    if pressure.is_empty() {
        return None;
    }
    let theory =
        ratios.iter().filter(|ratio| **ratio > 0.5).map(|ratio| [*ratio, patir_cheng(*ratio)]).collect();
    pressure.push(Series::new("Patir, Cheng", theory, Mark::Dashed));
    let mut shear: Vec<Series> = [
        of(Kind::ShearFlowFactorX, "x", Mark::LineAndPoints),
        of(Kind::ShearFlowFactorY, "y", Mark::DashedAndPoints),
    ]
    .into_iter()
    .flatten()
    .collect();
    let mut charts = vec![chart("pressure flow factor", pressure)];
    if !shear.is_empty() {
        let theory = ratios.iter().map(|ratio| [*ratio, patir_cheng_shear(*ratio)]).collect();
        shear.push(Series::new("Patir, Cheng", theory, Mark::Dashed));
        charts.push(chart("shear flow factor", shear));
    }
    let charts = Charts { charts, columns: 2, aspect: 0.7 };
    Some(Curves::new("joint_flow", "flow factors over the mean gap", charts))
}

fn points(law: &Law, quantity: &Quantity, value: fn(&Band) -> f64) -> Vec<[f64; 2]> {
    let bands = law.pressures.iter().zip(&quantity.bands);
    bands.map(|(p, band)| [*p, band.as_ref().map_or(f64::NAN, value)]).collect()
}

/// Shades the band of a quantity, if there are several samples.
fn with_band(law: &Law, chart: Chart, quantity: &Quantity) -> Chart {
    if law.samples < 2 {
        return chart;
    }
    let known = |points: Vec<[f64; 2]>| points.into_iter().filter(|[_, y]| y.is_finite() && *y > 0.0);
    let low = known(points(law, quantity, |band| band.low));
    let high = known(points(law, quantity, |band| band.high)).rev();
    Chart { shaded: Some((BAND.to_owned(), vec![low.chain(high).collect()])), ..chart }
}
