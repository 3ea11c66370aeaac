//! Contacts of bodies that may attract each other.

use crate::choice::choice;
use crate::error::Result;
use crate::grid::Field;
use crate::motion::pair::Pair;
use crate::operator::Operator;
use crate::solver::{self, Bounds, Control, Params, Solution, solve_adhesive_watched, solve_normal_watched};

/// Presses a `pair` together without friction, over the initial `gap` and within the upper `bounds` of the pressure. Bodies that
/// attract each other come from the `last` contact, or from afar; for others, its pressure is the start of the solution.
#[expect(clippy::too_many_arguments, reason = "the contact, where it begins, and who looks on")]
pub(super) fn press_from(
    pair: &Pair,
    operator: &mut dyn Operator,
    gap: &Field,
    bounds: &Bounds,
    control: Control,
    last: Option<&Solution>,
    params: &Params,
    watch: &dyn solver::Watch,
) -> Result<Solution> {
    match pair.adhesion() {
        Some(adhesion) => {
            solve_adhesive_watched(operator, gap, adhesion, bounds.upper(), control, last, params, watch)
        }
        None => {
            let start = last.map(|last| &last.pressure);
            solve_normal_watched(operator, gap, bounds, control, start, params, watch)
        }
    }
}

/// Where bodies that attract each other come from at each position of a pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum AdhesionHistory {
    /// From afar: positions are independent.
    #[default]
    None,
    /// From the position before, with its displacement: the bodies keep what adheres, and jumps lose energy. Each pass begins from
    /// afar.
    Path,
}

choice!(AdhesionHistory: "none" => None, "path" => Path);
