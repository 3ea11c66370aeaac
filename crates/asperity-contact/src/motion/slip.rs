//! The slip regime of a pair: how its bodies slip on each other.

use crate::error::Result;
use crate::motion::pair::Pair;
use crate::operator::Operators;
use crate::solver::{
    Bounds, ContactSolver, Device, Friction, Frictionless, GrossSliding, Rolling, Sliding, SteadyRolling,
    StickSlip,
};

/// How two bodies slip on each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SlipRegime {
    /// Without friction.
    Frictionless,
    /// Every cell slips, in one direction.
    Sliding(Sliding),
    /// Each cell sticks until its shear reaches the limit of friction.
    StickSlip(Friction),
    /// Steady rolling.
    Rolling(Friction, Rolling),
}

impl SlipRegime {
    /// Creates the solver of contacts of a `pair` in this regime on `shape` cells. It is the one place in
    /// which a solver is chosen.
    ///
    /// # Errors
    /// [`Error::Unsupported`](crate::Error::Unsupported) if the interface or the bodies of the pair do not
    /// support the regime.
    pub fn solver(
        self,
        pair: &Pair,
        operators: &Operators,
        shape: [usize; 2],
        device: Device,
    ) -> Result<Box<dyn ContactSolver>> {
        pair.check_dry()?;
        let interface = pair.shared_interface();
        Ok(match self {
            Self::Frictionless => Box::new(Frictionless::new(device.operator(operators, shape), interface)),
            Self::Sliding(sliding) if self.displaces_normally(pair) => {
                Box::new(GrossSliding::coupled(operators.coupled_on(shape), interface, sliding))
            }
            Self::Sliding(sliding) => {
                Box::new(GrossSliding::uncoupled(device.operator(operators, shape), interface, sliding))
            }
            Self::StickSlip(friction) => {
                pair.check_stick()?;
                Box::new(StickSlip::new(operators.coupled_on(shape), interface, friction))
            }
            Self::Rolling(friction, rolling) => {
                pair.check_stick()?;
                Box::new(SteadyRolling::new(operators.coupled_on(shape), interface, friction, rolling))
            }
        })
    }

    /// Returns the `bounds` of cells without shear under the shear of this regime, as far as it is known
    /// before the pressure.
    pub fn sheared(self, bounds: Bounds) -> Bounds {
        match self {
            Self::Sliding(sliding) => sliding.friction.sliding_bounds(&bounds),
            Self::Frictionless | Self::StickSlip(_) | Self::Rolling(..) => bounds,
        }
    }

    /// Returns the gross sliding; `None` in another regime.
    pub fn sliding(&self) -> Option<&Sliding> {
        match self {
            Self::Sliding(sliding) => Some(sliding),
            Self::Frictionless | Self::StickSlip(_) | Self::Rolling(..) => None,
        }
    }

    /// Returns the steady rolling; `None` in another regime.
    pub fn rolling(&self) -> Option<Rolling> {
        match self {
            Self::Rolling(_, rolling) => Some(*rolling),
            Self::Frictionless | Self::Sliding(_) | Self::StickSlip(_) => None,
        }
    }

    /// Whether the shear displaces the bodies of a `pair` normally, so that their pressures depend on it.
    pub fn displaces_normally(&self, pair: &Pair) -> bool {
        self.sliding().is_some_and(|sliding| sliding.shear_displaces_normally(pair.couples()))
    }
}

impl From<Option<Sliding>> for SlipRegime {
    fn from(sliding: Option<Sliding>) -> Self {
        sliding.map_or(Self::Frictionless, Self::Sliding)
    }
}

impl From<Option<Friction>> for SlipRegime {
    fn from(friction: Option<Friction>) -> Self {
        friction.map_or(Self::Frictionless, Self::StickSlip)
    }
}
