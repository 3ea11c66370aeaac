//! The case as people write it: a file that can be computed again, its quantities with their units.

use asperity_base::units::{Dimension, format_digits, parse};
use asperity_study::dimension_of_key;
use serde_json::{Map, Value};

use super::html::escaped;

/// The case as a file, and a button that copies it.
pub(super) fn html(case: &Value) -> String {
    let toml = toml::to_string(&written(case)).unwrap_or_else(|_| format!("{case:#}"));
    let toml = escaped(&toml);
    format!(
        "<button type=\"button\" class=\"copy\" hidden>copy</button><pre id=\"case\" tabindex=\"0\">{toml}</pre>"
    )
}

/// The keys of a case file, without digests and missing values.
pub(super) fn written(case: &Value) -> Value {
    at("", case)
}

/// The value at a dotted key.
fn at(key: &str, value: &Value) -> Value {
    let below = |name: &str| if key.is_empty() { name.to_owned() } else { format!("{key}.{name}") };
    match value {
        Value::Object(keys) => {
            let kept = keys.iter().filter(|(name, value)| {
                !value.is_null() && !matches!(name.as_str(), "identity" | "sha256" | "hardness_sha256")
            });
            kept.map(|(name, value)| (name.clone(), at(&below(name), value))).collect::<Map<_, _>>().into()
        }
        Value::Array(values) => values.iter().map(|value| at(key, value)).collect(),
        Value::Number(number) => {
            let quantity = dimension_of_key(key).zip(number.as_f64());
            quantity.and_then(|(dimension, value)| exact(value, dimension)).map_or(value.clone(), Value::from)
        }
        other => other.clone(),
    }
}

/// A quantity with its unit and as few digits as are read back as the very same number; none where none are.
fn exact(value: f64, dimension: Dimension) -> Option<String> {
    let texts = (1..=17).map(|digits| format_digits(value, dimension, digits));
    texts.into_iter().find(|text| parse(text, dimension) == Ok(value))
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn quantities_have_their_units_and_digests_are_left_out() {
        let case = json!({
            "identity": "0123",
            "lower": { "young": 210e9, "poisson": 0.3, "hardness": "inf", "topography": { "sq": 35e-9, "cutoff": [8e-6, 8e-6], "seed": 1 } },
            "contact": { "load": 0.18, "approach": null },
        });
        let expected = json!({
            "lower": { "young": "210 GPa", "poisson": 0.3, "hardness": "inf", "topography": { "sq": "35 nm", "cutoff": ["8 µm", "8 µm"], "seed": 1 } },
            "contact": { "load": "180 mN" },
        });
        assert_eq!(written(&case), expected);
    }
}
