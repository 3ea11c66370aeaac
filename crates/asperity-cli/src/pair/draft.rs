//! The text of a case of two bodies.

use std::fmt::Write as _;

use super::surface::quoted;
use crate::args::Load;

/// A case to be written.
pub(super) struct Draft {
    pub(super) title: String,
    /// The lower and the upper body.
    pub(super) bodies: [DraftBody; 2],
    pub(super) load: Load,
    pub(super) periodic: bool,
    /// Whether the surfaces have to be brought to a common grid.
    pub(super) is_common: bool,
    /// Passes of a motion; `None` for a contact at rest.
    pub(super) passes: Option<u32>,
}

/// A body of a draft.
pub(super) struct DraftBody {
    pub(super) material: String,
    pub(super) hardness: Option<String>,
    /// The keys of its topography, with their values as TOML.
    pub(super) topography: Vec<(&'static str, String)>,
}

impl Draft {
    /// Returns the case file.
    pub(super) fn text(&self) -> String {
        let mut text = format!("title = {}\n", quoted(&self.title));
        for (name, body) in ["lower", "upper"].into_iter().zip(&self.bodies) {
            let _ = write!(text, "\n[{name}]\nmaterial = {}\n", quoted(&body.material));
            if let Some(hardness) = &body.hardness {
                let hardness = if hardness == "inf" { hardness.clone() } else { quoted(hardness) };
                let _ = writeln!(text, "hardness = {hardness}");
            }
            let _ = writeln!(text, "[{name}.topography]");
            for (key, value) in &body.topography {
                let _ = writeln!(text, "{key} = {value}");
            }
        }
        let Load { key, text: load } = &self.load;
        let _ = write!(text, "\n[contact]\n{key} = {}\n", quoted(load));
        if self.periodic {
            text += "boundary = \"periodic\"\n";
        }
        if self.is_common {
            text += "grid = \"common\"\n";
        }
        if let Some(passes) = self.passes {
            let _ = write!(text, "\n[motion]\npasses = {passes}\n");
            if self.periodic {
                text += "strategy = \"shift\"\n";
            }
        }
        text
    }
}
