//! The oil between the bodies of a case.

use crate::case::Case;
use asperity_base::error::{Error, Result};
use asperity_contact::lubrication::Lubrication;

/// Returns the oil between the bodies of a case at their mean temperature; `None` between dry ones.
///
/// # Errors
/// [`Error::Case`] if an oil by its name has no temperature, or none at which it is known.
pub(super) fn lubrication(case: &Case) -> Result<Option<Lubrication>> {
    let Some(oil) = &case.interface.lubrication else { return Ok(None) };
    let temperature = case.temperature.map(|temperature| 0.5 * temperature.bulk.iter().sum::<f64>());
    let found = oil.between_bodies(temperature);
    found
        .map(Some)
        .map_err(|source: Error| case.error_at("temperature.bulk", source.to_string(), source.hint()))
}
