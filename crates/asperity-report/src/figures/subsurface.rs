//! The figures of the stress under a surface.

use std::collections::BTreeMap;

use asperity_base::Field;
use asperity_base::units::{Dimension, format};
use asperity_study::io::fields::{Attribute, Fields};

use super::Curves;
use super::sheet::Sheet;
use crate::draw::{Axis, Chart, Charts, Colours, Map, Maps, Mark, Quantity, Series, Unit};
use crate::error::{Error, Result};

/// Von Mises' stress on the section; the most stressed point is marked if it lies there.
pub(super) fn draw(fields: &Fields, of: &str, sheet: &mut Sheet) -> Result {
    let stored = fields.read("section_von_mises")?;
    let ([dx, dz], x) = ([stored.pitch[0], stored.pitch[1]], stored.origin[0]);
    let layers =
        stored.into_field().ok_or_else(|| Error::missing("`section_von_mises` is not a section", None))?;
    // Values stand at depths, from the surface on: between them, lines.
    const FINER: usize = 4;
    let cells = [layers.nrows(), FINER * (layers.ncols() - 1)];
    let field = Field::from_shape_fn(cells, |(i, k)| {
        let part = ((k % FINER) as f64 + 0.5) / FINER as f64;
        (1.0 - part) * layers[[i, k / FINER]] + part * layers[[i, k / FINER + 1]]
    });
    let attributes = fields.attributes()?;
    let place = match (attributes.get("section"), attributes.get("position"), attributes.get("body")) {
        (Some(Attribute::Number(y)), Some(Attribute::Numbers(at)), Some(Attribute::Text(body))) => {
            Some((*y, at, body))
        }
        _ => None,
    };
    let (y, at, body) = place.ok_or_else(|| Error::missing("it is not said where the section lies", None))?;
    let begin = x - 0.5 * dx;
    let ends = [[begin, begin + cells[0] as f64 * dx], [0.0, (layers.ncols() - 1) as f64 * dz]];
    let title = format!("von Mises stress in the {body} body");
    let step = match attributes.get("step") {
        Some(Attribute::Integer(step)) => format!(", position {step}"),
        _ => String::new(),
    };
    let of = format!("{of}{step}, section at y = {}", format(y, Dimension::Length));
    let spans = contact(fields, ends[0][0], dx)?;
    let interfaces = interfaces(&attributes, ends[1][1]);
    sheet.add("subsurface", &title, &of, || {
        let map = Map::section(
            "",
            &field,
            ends,
            Quantity::new("von Mises stress", Unit::Pressure),
            Colours::Pressure,
        );
        let map = map.with_contours(&field).with_spans(spans, "contact").with_depths(interfaces, "interface");
        let on_it = at[1] == y;
        let mark = [on_section(at[0], ends[0]), at[2]];
        let map = if on_it { map.marked(mark, "most stressed point") } else { map };
        Ok(Maps::new(vec![map]))
    })?;
    columns(fields)?.into_iter().try_for_each(|curves| sheet.add_curves(curves, &of))
}

/// Returns a place x of the body on a section from and to these ends. A section that passes the end of its
/// body counts on from there.
pub(crate) fn on_section(x: f64, [from, to]: [f64; 2]) -> f64 {
    if x < from { x + (to - from) } else { x }
}

/// Returns the depths of the interfaces of a body with layers above the lower end of a section.
pub(crate) fn interfaces(attributes: &BTreeMap<String, Attribute>, to: f64) -> Vec<f64> {
    match attributes.get("layer_depth") {
        Some(Attribute::Numbers(tops)) => {
            tops.iter().copied().filter(|top| *top > 0.0 && *top < to).collect()
        }
        _ => Vec::new(),
    }
}

/// Where the surface of the section bears: from and to along x, m. `begin` is its left end, `dx` the size of
/// a cell.
pub(crate) fn contact(fields: &Fields, begin: f64, dx: f64) -> Result<Vec<[f64; 2]>> {
    /// Share of the largest pressure below which there is rounding alone.
    const ROUNDING: f64 = 1e-9;
    let layers = fields.read("section_zz")?.into_field();
    let Some(pressure) = layers.map(|layers| layers.column(0).mapv(|stress| -stress)) else {
        return Ok(Vec::new());
    };
    let least = ROUNDING * pressure.iter().copied().fold(0.0, f64::max);
    let mut spans: Vec<[f64; 2]> = Vec::new();
    let mut open = false;
    for (i, p) in pressure.iter().enumerate() {
        let [from, to] = [i, i + 1].map(|edge| begin + edge as f64 * dx);
        match (*p > least, open) {
            (true, true) => spans.iter_mut().next_back().into_iter().for_each(|span| span[1] = to),
            (true, false) => spans.push([from, to]),
            (false, _) => {}
        }
        open = *p > least;
    }
    Ok(spans)
}

/// The six stresses down each column that was kept; none where there is none.
pub(crate) fn columns(fields: &Fields) -> Result<Option<Curves>> {
    let names = fields.names()?;
    let mut charts = Vec::new();
    for number in 1.. {
        let of = |component: &str| format!("column_{number:02}_{component}");
        if !names.contains(&of("xx")) {
            break;
        }
        let mut series = Vec::new();
        for component in ["xx", "yy", "zz", "yz", "xz", "xy"] {
            let stored = fields.read(&of(component))?;
            let points = stored.values.iter().enumerate();
            let points = points.map(|(k, stress)| [stored.origin[0] + k as f64 * stored.pitch[0], *stress]);
            series.push(Series::new(format!("σ {component}"), points.collect(), Mark::Line));
        }
        let x = Axis::linear("depth", Unit::Length);
        charts.push(Chart::new(
            format!("column {number}"),
            x,
            Axis::linear("stress", Unit::Pressure),
            series,
        ));
    }
    if charts.is_empty() {
        return Ok(None);
    }
    let charts = Charts { charts, columns: 2, aspect: 0.8 };
    Ok(Some(Curves::new("stress_columns", "stress below chosen places", charts)))
}
