//! Paths of the sun that tests share: real days, keys, and arcs put through a direction.

use glam::DVec3;
use sunbake::sun::{DayOutcome, DayRequest, SunArc, SunPath, day, parse_keyed};
use sunbake::testing::pseudo_random;

/// The sun's declination at a solstice.
pub const SOLSTICE_DEG: f64 = 23.44;

/// A day from sunrise to sunset, its clock that of the place.
pub fn day_at(latitude_deg: f64, date: &str) -> SunPath {
    let request = DayRequest {
        latitude_deg,
        longitude_deg: 0.0,
        date: date.parse().expect("a date"),
        utc_offset_h: Some(0.0),
        north_deg: 0.0,
        window: None,
    };
    match day(&request).expect("a day") {
        DayOutcome::Path(path) => path,
        DayOutcome::NoSun { .. } => panic!("the sun does not rise at {latitude_deg} on {date}"),
    }
}

/// Three great circles over the sky, one of them through the zenith.
pub fn keyed() -> SunPath {
    let keys = r#"{"angular_radius_deg": 0.27, "duration_min": 600, "keys": [
        {"azimuth_deg": 80, "elevation_deg": 2}, {"azimuth_deg": 120, "elevation_deg": 50},
        {"direction": [0, 1, 0]}, {"azimuth_deg": 290, "elevation_deg": 1}]}"#;
    parse_keyed(keys, 0.0).expect("keys")
}

/// Days and paths of every kind, with names.
pub fn of_every_kind() -> Vec<(&'static str, SunPath)> {
    vec![
        ("an equinox at 40 degrees", day_at(40.0, "2026-03-20")),
        ("midsummer at 65 degrees", day_at(65.0, "2026-06-21")),
        ("midwinter in the south", day_at(-33.0, "2026-06-21")),
        ("the equator at an equinox", day_at(0.0, "2026-09-23")),
        ("a polar day", day_at(80.0, "2026-06-21")),
        ("midsummer at the pole", day_at(90.0, "2026-06-21")),
        ("keys", keyed()),
    ]
}

/// An arc that has `direction` at hour angle 0, about an axis that is tilted from it towards `aside`.
pub fn arc_through(direction: DVec3, aside: DVec3, declination_deg: f64, hour_angle_rad: [f64; 2]) -> SunArc {
    let declination_rad = declination_deg.to_radians();
    let across = aside.reject_from_normalized(direction).normalize();
    let axis = (direction * declination_rad.sin() + across * declination_rad.cos()).normalize();
    let zero = direction.reject_from_normalized(axis).normalize();
    SunArc { axis, zero, declination_rad, hour_angle_rad, t: [0.0, 1.0] }
}

/// Random numbers and what is made of them.
pub struct Random(u64);

impl Random {
    /// A sequence that depends on the seed alone.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// In [0, 1).
    pub fn unit(&mut self) -> f64 {
        pseudo_random(&mut self.0)
    }

    /// In [from, to).
    pub fn range(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.unit()
    }

    /// An index below `count`.
    pub fn index(&mut self, count: usize) -> usize {
        (self.unit() * count as f64) as usize
    }

    /// In the cube from -1 to 1.
    pub fn cube(&mut self) -> DVec3 {
        DVec3::new(self.range(-1.0, 1.0), self.range(-1.0, 1.0), self.range(-1.0, 1.0))
    }

    /// Of unit length.
    pub fn direction(&mut self) -> DVec3 {
        loop {
            let v = self.cube();
            if (0.01..=1.0).contains(&v.length_squared()) {
                return v.normalize();
            }
        }
    }

    /// An arc: any axis, the declinations that matter and any other, up to one and a half turns, across any cut.
    pub fn arc(&mut self) -> SunArc {
        let declination_deg = match self.index(5) {
            0 => 0.0,
            1 => SOLSTICE_DEG,
            2 => -SOLSTICE_DEG,
            3 => self.range(-80.0, 80.0),
            _ => self.range(-SOLSTICE_DEG, SOLSTICE_DEG),
        };
        let start_rad = self.range(-10.0, 10.0);
        let length_rad = self.range(0.1, 9.0);
        arc_through(self.direction(), self.direction(), declination_deg, [start_rad, start_rad + length_rad])
    }

    /// A path of one arc, or of two that need not meet.
    pub fn path(&mut self) -> SunPath {
        let mut arcs = vec![self.arc()];
        if self.index(3) == 0 {
            arcs.push(self.arc());
            let joint = self.range(0.2, 0.8);
            arcs[0].t = [0.0, joint];
            arcs[1].t = [joint, 1.0];
        }
        SunPath::new(arcs, 0.0, 720.0).expect("the arcs are well formed")
    }
}
