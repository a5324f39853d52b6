//! What the sun's paths are held to.

mod dates_and_clocks_read_as_written;
mod days_follow_the_ephemeris;
mod days_follow_trigonometry;
mod half_spaces_match_brute_force;
mod keys_and_lights_make_paths;
mod odd_days_are_ordinary_input;

/// A small deterministic generator (Knuth's MMIX constants), so that a failure repeats.
pub(super) struct Random(u64);

impl Random {
    /// From a seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Uniform in [0, 1).
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Uniform in [from, to).
    pub fn range(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.unit()
    }

    /// Uniform on the sphere.
    pub fn direction(&mut self) -> glam::DVec3 {
        let (z, angle) = (self.range(-1.0, 1.0), self.range(0.0, std::f64::consts::TAU));
        let r = (1.0 - z * z).sqrt();
        glam::DVec3::new(r * angle.cos(), r * angle.sin(), z)
    }
}
