//! Response of homogeneous half-spaces.

use crate::grid::Field;
use crate::kernel::coupled::coupled_displacement;
use crate::kernel::spectral::{harmonic_displacement, harmonic_displacements};
use crate::kernel::{
    Coefficients, CoupledInfluence, CoupledResponse, Influence, Line, Response, SharedResponse,
    normal_displacement,
};
use crate::material::Compliances;
use crate::units::{Metre, Pascal};

/// Two homogeneous half-spaces: the solutions of Boussinesq and Cerruti, integrated over cells by Love.
///
/// Created from a composite modulus E* it responds only to pressure. Created from the [`Compliances`] of a
/// pair it also responds to shear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HalfSpaces {
    modulus: Pascal,
    compliances: Option<Compliances>,
}

impl From<Pascal> for HalfSpaces {
    fn from(modulus: Pascal) -> Self {
        Self { modulus, compliances: None }
    }
}

impl From<Compliances> for HalfSpaces {
    fn from(compliances: Compliances) -> Self {
        Self { modulus: compliances.modulus(), compliances: Some(compliances) }
    }
}

impl From<Pascal> for SharedResponse {
    fn from(modulus: Pascal) -> Self {
        HalfSpaces::from(modulus).into()
    }
}

impl From<Compliances> for SharedResponse {
    fn from(compliances: Compliances) -> Self {
        HalfSpaces::from(compliances).into()
    }
}

impl Response for HalfSpaces {
    fn harmonic_displacement(&self, qx: f64, qy: f64) -> f64 {
        harmonic_displacement(qx, qy, self.modulus)
    }

    fn influence(&self, pitch: [Metre; 2]) -> Box<dyn Influence> {
        let modulus = self.modulus;
        Box::new(move |x, y| normal_displacement(x, y, pitch, modulus))
    }

    fn line_influence(&self, line: &Line, pitch: [Metre; 2]) -> Option<Box<dyn Influence>> {
        Some(Box::new(LineOfCells { line: *line, pitch, modulus: self.modulus }))
    }

    fn half_space_modulus(&self) -> Option<Pascal> {
        Some(self.modulus)
    }

    fn coupled(&self) -> Option<&dyn CoupledResponse> {
        self.compliances.as_ref().map(|compliances| compliances as &dyn CoupledResponse)
    }
}

/// Half-spaces with these compliances.
impl CoupledResponse for Compliances {
    fn couples(&self) -> bool {
        self.coupling != 0.0
    }

    fn harmonic_displacements(&self, qx: f64, qy: f64) -> Coefficients {
        harmonic_displacements(qx, qy, self)
    }

    fn coupled_influence(&self, pitch: [Metre; 2]) -> Box<CoupledInfluence> {
        let compliances = *self;
        Box::new(move |x, y| coupled_displacement(x, y, pitch, &compliances))
    }

    fn coupled_line_influence(&self, line: &Line, pitch: [Metre; 2]) -> Option<Box<CoupledInfluence>> {
        let (line, compliances) = (*line, *self);
        Some(Box::new(move |x, y| line.coupled_displacement(x, y, pitch, &compliances)))
    }
}

struct LineOfCells {
    line: Line,
    pitch: [Metre; 2],
    modulus: Pascal,
}

impl Influence for LineOfCells {
    fn displacement(&self, x: Metre, y: Metre) -> f64 {
        self.line.normal_displacement(x, y, self.pitch, self.modulus)
    }

    fn table(&self, shape: [usize; 2], pitch: [Metre; 2]) -> Field {
        self.line.influence_table(shape, pitch, self.modulus)
    }
}
