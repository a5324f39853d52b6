//! Lattice towers: four legs, rings and crossed braces.

use glam::{DVec3, dvec3};

use crate::material::Material;
use crate::noise::mix;
use crate::soup::Soup;

/// A square lattice tower around the Y axis.
pub(crate) struct Lattice {
    pub(crate) material: Material,
    /// Heights of its foot and its top, in metres.
    pub(crate) y_m: [f64; 2],
    /// Half its width at foot and top, in metres.
    pub(crate) half_m: [f64; 2],
    /// Storeys, each with a ring above and two braces a side.
    pub(crate) bays: usize,
    pub(crate) leg_radius_m: f64,
    pub(crate) brace_radius_m: f64,
}

impl Lattice {
    /// Where leg `k` (0 to 3) is at the fraction `t` of the height.
    fn leg(&self, k: usize, t: f64) -> DVec3 {
        const SIGNS: [(f64, f64); 4] = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)];
        let half_m = mix(self.half_m[0], self.half_m[1], t);
        let (x, z) = SIGNS[k % 4];
        dvec3(x * half_m, mix(self.y_m[0], self.y_m[1], t), z * half_m)
    }

    /// The tower as closed tubes.
    pub(crate) fn soup(&self) -> Soup {
        let mut soup = Soup::default();
        for k in 0..4 {
            soup.tube(self.material, &[self.leg(k, 0.0), self.leg(k, 1.0)], self.leg_radius_m, 6);
            for bay in 0..self.bays {
                let at = |v: usize| v as f64 / self.bays as f64;
                self.brace(&mut soup, self.leg(k, at(bay)), self.leg(k + 1, at(bay + 1)));
                self.brace(&mut soup, self.leg(k + 1, at(bay)), self.leg(k, at(bay + 1)));
                self.brace(&mut soup, self.leg(k, at(bay + 1)), self.leg(k + 1, at(bay + 1)));
            }
        }
        soup
    }

    fn brace(&self, soup: &mut Soup, a_m: DVec3, b_m: DVec3) {
        soup.tube(self.material, &[a_m, b_m], self.brace_radius_m, 5);
    }
}
