//! The points of sweeps within a study, as one more axis of its table.

use serde_json::Value;

use super::axis::{Axis, ValueInFile};

/// Keys of a case that list the points of a sweep, and the key of one point.
const SWEPT: [(&str, &str); 6] = [
    ("/contact/loads", "contact.load"),
    ("/contact/mean_pressures", "contact.mean_pressure"),
    ("/contact/approaches", "contact.approach"),
    ("/friction/creepages", "friction.creepage"),
    ("/steady/speeds", "steady.speed"),
    ("/lubrication/speeds", "lubrication.speed"),
];

/// Returns the key of a point of the sweep of a resolved case, and the values of all points; `None` without a
/// list of points.
pub(super) fn swept(case: &Value) -> Option<(&'static str, Vec<toml::Value>)> {
    let (key, values) = SWEPT.iter().find_map(|(list, key)| Some((*key, case.pointer(list)?.as_array()?)))?;
    let pairs: Vec<&[Value]> =
        values.iter().filter_map(|value| value.as_array().map(Vec::as_slice)).collect();
    // A vector along x is a number.
    let are_along_x = pairs.iter().all(|pair| pair.iter().skip(1).all(|other| other.as_f64() == Some(0.0)));
    let value = |value: &Value| match value {
        Value::Array(pair) if are_along_x => toml::Value::try_from(pair.first()?).ok(),
        value => toml::Value::try_from(value).ok(),
    };
    Some((key, values.iter().map(value).collect::<Option<_>>()?))
}

/// Returns the axis of the points of these sweeps, with each of their values once; `None` if they change
/// different keys.
pub(super) fn axis<'a>(sweeps: impl Iterator<Item = &'a (&'static str, Vec<toml::Value>)>) -> Option<Axis> {
    let (mut key, mut all): (_, Vec<ValueInFile>) = (None, Vec::new());
    for (of_sweep, values) in sweeps {
        if *key.get_or_insert(*of_sweep) != *of_sweep {
            return None;
        }
        for value in values {
            if all.iter().all(|known| known.value != *value) {
                all.push(ValueInFile { value: value.clone(), span: 0..0 });
            }
        }
    }
    Some(Axis::new(key?.to_owned(), all))
}
