//! A map that does not change: a place on the page, its field in the data.

use serde_json::{Value, json};

use super::curves;
use super::quantised::QuantisedField;
use crate::draw::Unit;

/// A field in a plane, as it is shown.
pub(super) struct Plane {
    /// Name of the picture when it is saved.
    pub(super) file: String,
    pub(super) title: String,
    pub(super) caption: &'static str,
    pub(super) map: QuantisedField,
    /// Where its left end is, m.
    pub(super) x: f64,
    /// Whether the second axis is a depth.
    pub(super) down: bool,
    pub(super) quantity: &'static str,
    pub(super) unit: Unit,
    pub(super) shades: Shades,
    /// Where the upper edge is in contact, from and to, m.
    pub(super) spans: Vec<[f64; 2]>,
    /// Depths of the interfaces between layers, m.
    pub(super) interfaces: Vec<f64>,
    /// A point that is marked, and what it is.
    pub(super) mark: Option<([f64; 2], &'static str)>,
}

/// Which values the colours run over.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shades {
    /// From 0 to the highest.
    FromZero,
    /// From the lowest to the highest, over the logarithm.
    Logarithmic,
    /// As far below 0 as above.
    AroundZero,
}

/// HTML with a place for each plane, which go to `data`.
pub(super) fn html(planes: Vec<Plane>, data: &mut Value) -> String {
    beside(planes, "", data)
}

/// [`html`] with something beside the planes.
pub(super) fn beside(planes: Vec<Plane>, other: &str, data: &mut Value) -> String {
    if data["planes"].is_null() {
        data["planes"] = json!([]);
    }
    let all = data["planes"].as_array_mut().expect("it has been made one");
    let mut html = String::from("<div class=\"split\">");
    for plane in planes {
        html += &format!("<div data-plane=\"{}\"></div>", all.len());
        all.push(plane.data());
    }
    if !other.is_empty() {
        html += &format!("<div>{other}</div>");
    }
    html + "</div>"
}

impl Plane {
    fn data(self) -> Value {
        let [low, high] = match (self.shades, [self.map.low, self.map.high]) {
            (Shades::FromZero, [_, high]) => [0.0, high],
            (Shades::Logarithmic, range) => range,
            (Shades::AroundZero, [low, high]) => [-high.max(-low), high.max(-low)],
        };
        let [along, down] = self.map.extent();
        json!({
            "file": self.file,
            "title": self.title,
            "caption": self.caption,
            "x": self.x,
            "length": curves::unit(Unit::Length, along.max(down)),
            "down": self.down,
            "quantity": self.quantity,
            "unit": curves::unit(self.unit, high.max(-low)),
            "kind": match self.shades {
                Shades::FromZero => "positive",
                Shades::Logarithmic => "logarithmic",
                Shades::AroundZero => "diverging",
            },
            "range": [low, high],
            "mark": self.mark.map(|(at, what)| json!({ "at": at, "what": what })),
            "spans": self.spans,
            "interfaces": self.interfaces,
            "map": self.map,
        })
    }
}
