//! Words for keys of a case and for columns of the results, as they stand at axes and above tables.

/// Keys and columns whose words are not their letters.
const WORDS: [(&str, &str); 13] = [
    ("bulk", "bulk temperature"),
    ("sq", "Sq"),
    ("sdq", "Sdq"),
    ("cutoff", "cut-off"),
    ("mean_load", "mean load"),
    ("contact_area", "real area of contact"),
    ("mean_contact_area", "real area of contact"),
    ("contact_fraction", "contact fraction"),
    ("max_pressure", "largest pressure"),
    ("max_flash_temperature", "largest temperature"),
    ("force_ratio", "traction coefficient"),
    ("subsurface_max_von_mises", "largest von Mises stress"),
    ("max_shear", "largest shear"),
];

/// The words for a dotted key of a case: `Sq of the lower body`.
pub(super) fn of_key(key: &str) -> String {
    let name = plain(key.rsplit('.').next().unwrap_or(key));
    match key.split('.').collect::<Vec<_>>()[..] {
        [body @ ("lower" | "upper"), "layers", layer, _] => match layer.parse::<usize>() {
            Ok(index) => format!("{name} of layer {} of the {body} body", index + 1),
            Err(_) => format!("{name} of the {body} body"),
        },
        [body @ ("lower" | "upper"), "coating", _] => format!("{name} of the coating of the {body} body"),
        [body @ ("lower" | "upper"), _, ..] => format!("{name} of the {body} body"),
        _ => name,
    }
}

/// The words for a column of the results: `mean film of the upper body`.
pub(super) fn of_column(column: &str) -> String {
    let body = ["lower", "upper"]
        .into_iter()
        .find_map(|body| Some((column.strip_suffix(body)?.strip_suffix('_')?, body)));
    match body {
        Some((name, body)) => format!("{} of the {body} body", plain(name)),
        None => plain(column),
    }
}

fn plain(name: &str) -> String {
    let known = WORDS.iter().find(|(known, _)| *known == name);
    known.map_or_else(|| name.replace('_', " "), |(_, words)| (*words).to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_and_columns_become_words() {
        assert_eq!(of_key("lower.topography.sq"), "Sq of the lower body");
        assert_eq!(of_key("contact.load"), "load");
        assert_eq!(of_key("lower.layers.1.young"), "young of layer 2 of the lower body");
        assert_eq!(of_key("upper.coating.thickness"), "thickness of the coating of the upper body");
        assert_eq!(of_column("wear_volume_upper"), "wear volume of the upper body");
        assert_eq!(of_column("max_pressure"), "largest pressure");
    }
}
