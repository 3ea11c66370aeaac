//! OpenSees: a spring with the table, as a function in Python.

use std::fmt::Write as _;

use super::{Sheet, number};

/// Opening of the open side, on which the joint bears next to nothing, over the first closure.
const OPEN: f64 = 1e-3;

/// A function that makes the material of a joint of an area.
pub(super) fn spring(sheet: &Sheet<'_>) -> String {
    let mut text = sheet.head("#", &[
        "Beyond the last point OpenSees goes on with the last slope. On the open side the joint does not pull",
        "Closure is a compression: the material is for a zeroLength element whose deformation is the closure",
    ]);
    let list = |n: usize| sheet.closure.iter().map(|point| number(point[n])).collect::<Vec<_>>().join(", ");
    let open = OPEN * sheet.closure[1][1];
    let push = OPEN * OPEN * sheet.closure[1][0];
    let _ = write!(
        text,
        "\nCLOSURE = [{}]\nPRESSURE = [{}]\n\n\ndef joint(ops, tag, area):\n    \"\"\"Make the uniaxial material `tag` of a joint of this area.\"\"\"\n    \
         strain = [{}, *CLOSURE]\n    force = [{} * area, *(pressure * area for pressure in PRESSURE)]\n    \
         ops.uniaxialMaterial(\"ElasticMultiLinear\", tag, 0.0, \"-strain\", *strain, \"-stress\", *force)\n",
        list(1),
        list(0),
        number(-open),
        number(-push)
    );
    text
}
