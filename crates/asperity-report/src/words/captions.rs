//! Captions of the charts and maps of the page, as in a paper.

/// Captions by the names of figures and of the maps of a contact. A capability has its own.
const CAPTIONS: [(&str, &str); 51] = [
    (
        "approach",
        "Rigid-body approach of each pass, with what the surfaces have lost by plastic deformation.",
    ),
    ("contact", "Cells that bear load, elastic and at the hardness. Their area is the real area of contact."),
    ("contact_area", "Area of the cells that bear load."),
    (
        "displacement",
        "Elastic displacement of both surfaces together, positive where they give way to each other.",
    ),
    ("creep", "Rigid-body approach since the first load. Bodies that creep come closer under the same load."),
    ("creep_area", "Area of the cells that bear load, since the first load."),
    ("creep_load", "Load since the first one. At the same approach it relaxes."),
    (
        "drag",
        "Force against the motion since the position before. Its mean is that of the dissipation; what rough bodies store, they give back.",
    ),
    (
        "drag_coefficient",
        "Force with which the bodies resist the motion over the load: what the viscoelastic body dissipates.",
    ),
    (
        "force_distance",
        "Load over the distance of the bodies, together and apart; a pull is below 0. The shaded area is energy lost, the ring the state that the maps show.",
    ),
    (
        "fretting",
        "What the cycles have done to the bodies. Points are the computed cycles, each of which may stand for several.",
    ),
    ("friction", "Force of friction at each position."),
    ("gap", "Distance of the deformed surfaces where they do not touch."),
    (
        "joint_area",
        "Real over apparent area, corrected for the edges of spots: median and band of the samples, beside theories of random surfaces.",
    ),
    (
        "joint_closure",
        "What a program takes between two bodies. The closure is 0 without pressure; below the least computed pressure the law is continued.",
    ),
    (
        "joint_conductance",
        "Heat or current through a unit of the apparent area under a unit of difference: median and band of the samples.",
    ),
    (
        "joint_flow",
        "Mean flow over that between smooth walls at the mean gap, and fluid that sliding walls carry: medians of the samples, beside the fits of Patir and Cheng.",
    ),
    (
        "joint_stiffness",
        "Rise of pressure with closure, and of shear with displacement along the surfaces of spots that stick: median and band of the samples.",
    ),
    ("load", "Load at each position: it grows with the overlap where the bodies enter and leave."),
    (
        "loading",
        "Force over displacement on the way through all stages. A loop encloses the energy that is lost.",
    ),
    ("material_ratio", "Share of the surface that lies above a height."),
    (
        "max_plastic_strain",
        "Largest accumulated plastic strain below the surfaces, each time from virgin bodies.",
    ),
    ("max_pressure", "Pressure of the most loaded cell."),
    ("mean_contact_area", "Mean of the real area of contact over the positions of each pass."),
    (
        "mean_drag",
        "Mean force over the positions of each pass with which the bodies resist the motion, over the load. It settles as the bodies remember more passes.",
    ),
    (
        "oil_film",
        "Thickness of the film, the share of it that is empty behind the contact, and what oil and solids bear.",
    ),
    ("oil_film_section", "The film and the pressures on a line along x through the largest pressure."),
    (
        "mean_film",
        "Mean film in the contact. A dashed line is the central film of smooth bodies by a formula.",
    ),
    ("solid_share", "Share of the load that the solids bear: 0 in a full film, 1 in dry contact."),
    (
        "traction_coefficient",
        "The Stribeck curve: shear of the oil and friction of the solids, over the load.",
    ),
    ("mean_gap", "Mean distance of the deformed surfaces over the whole grid."),
    ("plastic", "Depth that yields at the hardness, both bodies together."),
    ("plastic_flow", "Plastic strain and work of each step. Bodies that have shaken down flow no more."),
    ("pressure", "Pressure on each cell. Cells without colour bear none."),
    (
        "pressure_histogram",
        "Share of the contact at each pressure. A peak at the right end is material at its hardness.",
    ),
    ("profile", "The deformed surfaces and the pressure on a line along x through the most loaded cell."),
    ("roughness", "Rms height of each body before the first pass and after each one."),
    (
        "running-in",
        "What sliding has done to the bodies. Volumes add up; the temperature is the largest of a pass.",
    ),
    ("shear", "Shear traction on the lower body."),
    ("sliding", "What sliding in place has done to the bodies, update after update."),
    ("slip", "Distance that the surfaces have slipped on each other, added up over all increments."),
    ("solution", "Residual of each solution beside its tolerance, and its cost."),
    (
        "spectrum",
        "Power of the heights at each wave number, averaged over all directions. Long waves are at the left.",
    ),
    ("stick", "Where the surfaces stick, and where they slip."),
    ("stiffness", "Load that one unit of approach more takes."),
    ("stress_columns", "Stress below chosen places, over the depth."),
    (
        "subsurface",
        "The section passes through the most stressed point; the bar at the top is where the bodies touch.",
    ),
    ("temperature", "Temperature of the surfaces in contact, flash temperature and bulk together."),
    ("traction", "Tangential force over the load as the creepage grows."),
    ("plastic_strain", "Plastic strain accumulated so far. It is largest below the surface."),
    ("residual_stress", "Stress that stays without load; tension is above 0."),
];

/// Returns the caption of a figure; `None` for one that its title explains.
pub(crate) fn find(name: &str) -> Option<&'static str> {
    CAPTIONS.iter().find(|(known, _)| *known == name).map(|(_, caption)| *caption)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_caption_is_a_sentence_of_one_figure() {
        for (index, (name, caption)) in CAPTIONS.iter().enumerate() {
            assert!(caption.ends_with('.') && caption.starts_with(char::is_uppercase), "{name}: {caption}");
            assert!(CAPTIONS[..index].iter().all(|(other, _)| other != name), "{name}");
        }
    }
}
