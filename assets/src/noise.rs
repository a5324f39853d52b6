//! Hashes, a random number generator and value noise, all from integer arithmetic.

/// Mixes the bits of `x` (a 32-bit finaliser of multiplies and xor-shifts).
pub(crate) fn hash(x: u32) -> u32 {
    let mut h = x.wrapping_add(0x9e37_79b9);
    h = (h ^ (h >> 16)).wrapping_mul(0x21f0_aaad);
    h = (h ^ (h >> 15)).wrapping_mul(0x735a_2d97);
    h ^ (h >> 15)
}

/// A number in [0, 1) that belongs to the lattice point `(x, y)` of the field `seed`.
pub(crate) fn lattice(x: i32, y: i32, seed: u32) -> f64 {
    let h = hash(hash(hash(seed) ^ x.cast_unsigned()).wrapping_add(y.cast_unsigned()));
    f64::from(h) / 4_294_967_296.0
}

/// A small generator: the n-th hash of a seed.
#[derive(Debug, Clone)]
pub(crate) struct Rng {
    seed: u32,
    count: u32,
}

impl Rng {
    /// A generator that always gives the same series for the same seed.
    pub(crate) fn new(seed: u32) -> Self {
        Self { seed: hash(seed), count: 0 }
    }

    /// The next number in [0, 1).
    pub(crate) fn unit(&mut self) -> f64 {
        self.count += 1;
        f64::from(hash(self.seed ^ self.count.wrapping_mul(0x85eb_ca6b))) / 4_294_967_296.0
    }

    /// The next number in [low, high).
    pub(crate) fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }
}

/// 0 below `from`, 1 above `to`, smooth between. `from` may exceed `to`; the ramp then falls.
pub(crate) fn smoothstep(from: f64, to: f64, x: f64) -> f64 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Linear blend from `a` (t = 0) to `b` (t = 1).
pub(crate) fn mix(a: f64, b: f64, t: f64) -> f64 {
    a + (b - a) * t
}

/// Smooth noise in [0, 1] with one feature a unit. `period` (in units, 0 for none) makes it repeat.
pub(crate) fn value_noise(x: f64, y: f64, period: i32, seed: u32) -> f64 {
    let (cell_x, cell_y) = (x.floor(), y.floor());
    let (tx, ty) = (smoothstep(0.0, 1.0, x - cell_x), smoothstep(0.0, 1.0, y - cell_y));
    let at = |dx: i32, dy: i32| {
        let wrap = |v: i32| if period > 0 { v.rem_euclid(period) } else { v };
        lattice(wrap(cell_x as i32 + dx), wrap(cell_y as i32 + dy), seed)
    };
    mix(mix(at(0, 0), at(1, 0), tx), mix(at(0, 1), at(1, 1), tx), ty)
}

/// Sum of `octaves` noises, each twice as fine and half as strong, scaled back to [0, 1].
pub(crate) fn fbm(x: f64, y: f64, octaves: u32, period: i32, seed: u32) -> f64 {
    let (mut sum, mut weight, mut total, mut scale) = (0.0, 1.0, 0.0, 1);
    for octave in 0..octaves {
        let s = f64::from(scale);
        sum += weight * value_noise(x * s, y * s, period * scale, seed.wrapping_add(octave * 101));
        total += weight;
        weight *= 0.5;
        scale *= 2;
    }
    sum / total
}
