//! Cases with their data, for the command and for a page in a browser.

/// A case with its data.
pub(crate) struct ExampleFiles {
    pub(crate) name: &'static str,
    pub(crate) about: &'static str,
    pub(crate) files: &'static [(&'static str, &'static [u8])],
}

/// The examples, in the order of their list.
pub(crate) const KITS: [ExampleFiles; 17] = [
    ExampleFiles {
        name: "quickstart",
        about: "two rough steel surfaces run in: 64 × 64 cells, 5 passes",
        files: &[("case.toml", include_bytes!("../../examples/quickstart/case.toml"))],
    },
    ExampleFiles {
        name: "hertz",
        about: "a ball on a plane, at rest: compare with Hertz",
        files: &[("case.toml", include_bytes!("../../examples/hertz/case.toml"))],
    },
    ExampleFiles {
        name: "friction",
        about: "a ball pushed to and fro on a plane: stick, slip and the loop of Cattaneo and Mindlin",
        files: &[("case.toml", include_bytes!("../../examples/friction/case.toml"))],
    },
    ExampleFiles {
        name: "fretting",
        about: "a ball that frets on a plate: 10 000 cycles of partial slip, of which some 20 are computed",
        files: &[
            ("case.toml", include_bytes!("../../examples/fretting/case.toml")),
            ("gross-slip.toml", include_bytes!("../../examples/fretting/gross-slip.toml")),
        ],
    },
    ExampleFiles {
        name: "stribeck",
        about: "a ground ball on a lubricated disc: friction, film and contact from full film to dry",
        files: &[("case.toml", include_bytes!("../../examples/stribeck/case.toml"))],
    },
    ExampleFiles {
        name: "viscoelastic",
        about: "a rough slider over rubber: friction and real area of contact over five decades of speed",
        files: &[
            ("case.toml", include_bytes!("../../examples/viscoelastic/case.toml")),
            ("master.csv", include_bytes!("../../examples/viscoelastic/master.csv")),
        ],
    },
    ExampleFiles {
        name: "coating",
        about: "a ball coated with DLC slides on steel: what cracks the coating, and what takes it off",
        files: &[
            ("case.toml", include_bytes!("../../examples/coating/case.toml")),
            ("study.toml", include_bytes!("../../examples/coating/study.toml")),
        ],
    },
    ExampleFiles {
        name: "micropitting",
        about: "fatigue of two ground surfaces: f over its limit by Dang Van, and which wear is faster",
        files: &[("case.toml", include_bytes!("../../examples/micropitting/case.toml"))],
    },
    ExampleFiles {
        name: "measured",
        about: "a ground disc from an x3p file with missing heights, against a polished plate",
        files: &[
            ("case.toml", include_bytes!("../../examples/measured/case.toml")),
            ("disc.x3p", include_bytes!("../../examples/measured/disc.x3p")),
            ("README.md", include_bytes!("../../examples/measured/README.md")),
        ],
    },
    ExampleFiles {
        name: "running-in",
        about: "wear, tribofilm and flash temperature over 100 000 passes, 141 of them computed",
        files: &[("case.toml", include_bytes!("../../examples/running-in/case.toml"))],
    },
    ExampleFiles {
        name: "rolling",
        about: "a ball rolls ten times over ground steel, which flows below its surface and shakes down",
        files: &[("case.toml", include_bytes!("../../examples/rolling/case.toml"))],
    },
    ExampleFiles {
        name: "pull-off",
        about: "an AFM tip on a rough polymer: the force-distance curve of two bodies that attract each other",
        files: &[("case.toml", include_bytes!("../../examples/pull-off/case.toml"))],
    },
    ExampleFiles {
        name: "contact-challenge",
        about: "the Contact-Mechanics Challenge, adhesive and rough, on 512 × 512 cells",
        files: &[("case.toml", include_bytes!("../../examples/contact-challenge/case.toml"))],
    },
    ExampleFiles {
        name: "seal",
        about: "a measured disc against a flat ring: leakage and heat over loads, as the ring wears, and over samples",
        files: &[
            ("case.toml", include_bytes!("../../examples/seal/case.toml")),
            ("wear.toml", include_bytes!("../../examples/seal/wear.toml")),
            ("sample.toml", include_bytes!("../../examples/seal/sample.toml")),
            ("samples.toml", include_bytes!("../../examples/seal/samples.toml")),
            ("disc.x3p", include_bytes!("../../examples/measured/disc.x3p")),
        ],
    },
    ExampleFiles {
        name: "joint",
        about: "a bolted joint of ground steel: stiffness, conductance and flow factors for a finite element program",
        files: &[("case.toml", include_bytes!("../../examples/joint/case.toml"))],
    },
    ExampleFiles {
        name: "study",
        about: "many cases made of one: contact area over pressure for two roughnesses, in samples",
        files: &[
            ("case.toml", include_bytes!("../../examples/study/case.toml")),
            ("load.toml", include_bytes!("../../examples/study/load.toml")),
        ],
    },
    ExampleFiles {
        name: "paper",
        about: "the paper's problem: 100 × 100 cells, every position of 3 passes",
        files: &[("case.toml", include_bytes!("../../examples/paper/case.toml"))],
    },
];
