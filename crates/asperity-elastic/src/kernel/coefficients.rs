//! The nine influence coefficients of a cell.

/// The nine influence coefficients of one cell on another, m/Pa, of which six are independent:
///
/// ```text
/// ⎡u_x⎤   ⎡xx   xy  −zx⎤ ⎡q_x⎤     u_x, u_y   lower minus upper body: the displacement against slip
/// ⎢u_y⎥ = ⎢xy   yy  −zy⎥ ⎢q_y⎥     u_z        closure: what opens the gap
/// ⎣u_z⎦   ⎣zx   zy   zz⎦ ⎣ p ⎦     q_x, q_y   on the lower body; the upper one bears the opposite
/// ```
///
/// xx, yy and zz are even in x and in y. xy is odd in both, zx is odd in x only, and zy is odd in y only. The
/// matrix of all cells is symmetric and positive definite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coefficients {
    /// u_x under q_x.
    pub xx: f64,
    /// u_x under q_y, and u_y under q_x.
    pub xy: f64,
    /// u_y under q_y.
    pub yy: f64,
    /// u_z under q_x, and −u_x under p.
    pub zx: f64,
    /// u_z under q_y, and −u_y under p.
    pub zy: f64,
    /// u_z under p.
    pub zz: f64,
}

impl Coefficients {
    /// Returns the coefficients as a matrix: displacement `[i]` under traction `[j]`, in the order x, y, z.
    pub fn matrix(&self) -> [[f64; 3]; 3] {
        let Self { xx, xy, yy, zx, zy, zz } = *self;
        [[xx, xy, -zx], [xy, yy, -zy], [zx, zy, zz]]
    }

    /// Returns the coefficients of a lower body with these and an `upper` body, each under a rigid one.
    pub(super) fn against(self, upper: Self) -> Self {
        Self {
            xx: self.xx + upper.xx,
            xy: self.xy + upper.xy,
            yy: self.yy + upper.yy,
            zx: self.zx - upper.zx,
            zy: self.zy - upper.zy,
            zz: self.zz + upper.zz,
        }
    }

    /// Returns the coefficients at an offset with these signs, from the coefficients `self` at the offset
    /// with positive signs. Odd coefficients vanish at 0.
    pub(super) fn at_offset(self, [x, y]: [f64; 2]) -> Self {
        Self { xy: x * y * self.xy, zx: x * self.zx, zy: y * self.zy, ..self }
    }
}
