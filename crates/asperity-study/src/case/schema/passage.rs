//! The keys of what a contact lets through: heat or current, and a fluid.

use super::Bounds::{AboveZero, FromZero};
use super::exists;
use super::typed::{
    DEPTH, FLAG, Optional, Typed, choice, count, defaulted, optional, other, quantity, required, section,
};
use asperity_base::units::Dimension;

/// `[conductance]`.
pub(crate) mod conductance {
    use super::*;
    use asperity_contact::conductance::Kind;

    section! { &["conductance"], "";
        KIND: Typed<Kind> = defaulted(
            "kind",
            choice::<Kind>(),
            "\"thermal\"",
            "\"electrical\"",
            "whether heat or current passes: bodies need `conductivity` or `resistivity`",
        );
        FILM: Optional<()> = optional(
            "film",
            other(
                None,
                "resistance of an area ≥ 0, such as \"1e-8 m2 K/W\"; \"1e-12 ohm m2\" with `kind = \"electrical\"`",
                |_, _| Ok(()),
            ),
            "none",
            "\"1e-8 m2 K/W\"",
            "resistance of a film on the spots, of an area",
        );
        GAS: Optional<f64> = optional(
            "gas",
            quantity(Dimension::Conductivity, AboveZero).exists(exists::GAS),
            "none",
            "\"0.026 W/(m K)\"",
            "thermal conductivity of a gas in the gap",
        );
        JUMP: Typed<f64> = defaulted(
            "jump",
            DEPTH.exists(exists::JUMP),
            "0.0",
            "\"0.37 um\"",
            "temperature jump distance of the gas at both surfaces together, which adds to the gap",
        );
        DROP: Optional<()> = optional(
            "drop",
            other(
                None,
                "temperature difference > 0, such as \"10 K\"; \"0.1 V\" with `kind = \"electrical\"`",
                |_, _| Ok(()),
            ),
            "1 K, or 1 V",
            "\"10 K\"",
            "difference between the bodies; it scales flux and power, nothing else",
        );
        EVERY: Typed<usize> = defaulted(
            "every",
            count(0),
            "1",
            "4",
            "interval of the positions of a pass, or of the increments, updates or points, whose conductance is computed; 0: once a \
             pass, where the left edges are flush, or for the last contact alone",
        );
    }
}

/// `[flow]`.
pub(crate) mod flow {
    use super::*;
    use asperity_contact::flow::{Along, Ends};

    section! { &["flow"], "";
        VISCOSITY: Typed<f64> = required(
            "viscosity",
            quantity(Dimension::Viscosity, AboveZero).exists(exists::VISCOSITY),
            "\"80 mPa s\"",
            "viscosity of the fluid, constant",
        );
        PRESSURE: Typed<f64> = defaulted(
            "pressure",
            quantity(Dimension::Pressure, FromZero).exists(exists::FLUID_PRESSURE),
            "1e5",
            "\"1 bar\"",
            "pressure difference that drives the leakage",
        );
        ALONG: Typed<Along> = defaulted(
            "along",
            choice::<Along>(),
            "\"both\"",
            "\"x\"",
            "direction of the pressure gradient",
        );
        ENDS: Optional<Ends> = optional(
            "ends",
            choice::<Ends>(),
            "`\"periodic\"` along periodic axes, `\"reservoirs\"` along free ones",
            "\"reservoirs\"",
            "`\"periodic\"`: the gap repeats itself, under a mean gradient of pressure; `\"reservoirs\"`: the fluid has two pressures at \
             the ends of the grid, and the sides are closed along a free axis",
        );
        GAS: Typed<bool> = defaulted(
            "gas",
            FLAG,
            "false",
            "true",
            "whether the fluid is an ideal gas at constant temperature; needs `outlet`",
        );
        OUTLET: Optional<f64> = optional(
            "outlet",
            quantity(Dimension::Pressure, AboveZero).exists(exists::FLUID_PRESSURE),
            "with a gas: must be given",
            "\"1 bar\"",
            "absolute pressure of a gas at the outlet, to which its leakage refers",
        );
        EVERY: Typed<usize> = defaulted(
            "every",
            count(0),
            "1",
            "4",
            "interval of the positions of a pass, or of the increments, updates or points, whose flow is computed; 0: once a pass, \
             where the left edges are flush, or for the last contact alone",
        );
    }
}
