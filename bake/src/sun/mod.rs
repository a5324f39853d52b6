//! Sun paths: where the sun (or a lamp far away) stands at every moment `t` in [0, 1].
//!
//! A path is one or more *arcs* of constant declination, each a turn about a fixed axis, so that visibility along it has
//! closed-form answers. A real day is fitted by one to three arcs ([`day`]); a keyed path is a chain of great circles,
//! each an arc of declination zero in a frame of its own ([`keyed`]).

use glam::DVec3;

/// Mean angular radius of the sun seen from Earth, in degrees (semi-diameter 959.63 arc seconds at one astronomical
/// unit; *Explanatory Supplement to the Astronomical Almanac*).
pub const SUN_ANGULAR_RADIUS_DEG: f64 = 959.63 / 3600.0;

/// A turn about a fixed axis at constant declination: `dir(h) = cos d (cos h zero + sin h axis x zero) + sin d axis`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SunArc {
    /// Unit vector, world space: what the sun turns about, right-handed as `h` grows.
    pub axis: DVec3,
    /// Unit vector across the axis, world space: where `h` is zero.
    pub zero: DVec3,
    /// Angle of the direction above the plane across the axis, in radians.
    pub declination_rad: f64,
    /// Hour angles at the arc's start and end, in radians, ascending.
    pub hour_angle_rad: [f64; 2],
    /// Path times at the arc's start and end, ascending.
    pub t: [f64; 2],
}

impl SunArc {
    /// Direction towards the sun at an hour angle, unit length, world space.
    pub fn direction_at_hour_angle(&self, hour_angle_rad: f64) -> DVec3 {
        let (sin_d, cos_d) = self.declination_rad.sin_cos();
        let (sin_h, cos_h) = hour_angle_rad.sin_cos();
        (self.zero * cos_h + self.axis.cross(self.zero) * sin_h) * cos_d + self.axis * sin_d
    }

    /// Hour angle at path time `t`, extrapolated outside the arc.
    pub fn hour_angle_at(&self, t: f64) -> f64 {
        let [h0, h1] = self.hour_angle_rad;
        let [t0, t1] = self.t;
        h0 + (h1 - h0) * (t - t0) / (t1 - t0)
    }

    /// Angle through which the sun moves across the sky for a unit of `t`, in radians.
    pub fn speed_rad(&self) -> f64 {
        let [h0, h1] = self.hour_angle_rad;
        let [t0, t1] = self.t;
        (h1 - h0).abs() / (t1 - t0) * self.declination_rad.cos()
    }
}

/// A sun path over `t` in [0, 1].
///
/// Guarantees, made by [`SunPath::new`]: at least one arc; arcs follow one another without gap or overlap from t = 0 to
/// t = 1; axes and zeros are unit and orthogonal; every number is finite.
#[derive(Debug, Clone, PartialEq)]
pub struct SunPath {
    arcs: Vec<SunArc>,
    /// Angular radius of the light's disc, in radians; 0 for a point.
    pub angular_radius_rad: f64,
    /// How many minutes of clock time the path takes, so that errors can be told in minutes.
    pub duration_min: f64,
    /// The day it stands for, where it stands for one.
    pub day: Option<Day>,
}

/// A day, or a window of one, at a place.
#[derive(Debug, Clone, PartialEq)]
pub struct Day {
    /// Degrees north.
    pub latitude_deg: f64,
    /// Degrees east.
    pub longitude_deg: f64,
    /// `YYYY-MM-DD`.
    pub date: String,
    /// Hours that local clocks are ahead of UTC.
    pub utc_offset_h: f64,
    /// Degrees that the scene's north is turned from -Z towards +X (clockwise seen from above).
    pub north_deg: f64,
    /// Minutes from local midnight of `date` to t = 0; t = 1 is `duration_min` later. May lie outside [0, 1440).
    pub start_min: f64,
    /// Largest angle between the path and the ephemeris, in degrees, sampled each minute while the sun is up.
    pub ephemeris_error_deg: f64,
}

/// Why arcs do not make a path.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PathError {
    /// No arc at all.
    #[error("a sun path needs at least one arc")]
    Empty,
    /// Something is NaN, not unit, not orthogonal or not ascending.
    #[error("arc {index} of the sun path is malformed: {reason}")]
    Arc {
        /// Which arc.
        index: usize,
        /// What is wrong with it.
        reason: &'static str,
    },
}

impl SunPath {
    /// Checks the arcs and makes a path of them.
    pub fn new(arcs: Vec<SunArc>, angular_radius_rad: f64, duration_min: f64) -> Result<Self, PathError> {
        check_arcs(&arcs)?;
        Ok(Self { arcs, angular_radius_rad, duration_min, day: None })
    }

    /// The arcs, in order.
    pub fn arcs(&self) -> &[SunArc] {
        &self.arcs
    }

    /// The arc that holds at `t` (clamped to [0, 1]).
    pub fn arc_at(&self, t: f64) -> &SunArc {
        self.arcs.iter().find(|a| t < a.t[1]).unwrap_or(&self.arcs[self.arcs.len() - 1])
    }

    /// Direction towards the sun at `t`, unit length, world space.
    pub fn direction(&self, t: f64) -> DVec3 {
        let arc = self.arc_at(t);
        arc.direction_at_hour_angle(arc.hour_angle_at(t))
    }

    /// Width of the sun in `t`: the time its disc takes to cross a line that is square to its motion.
    pub fn width_t(&self, t: f64) -> f64 {
        2.0 * self.angular_radius_rad / self.arc_at(t).speed_rad()
    }

    /// Minutes after local midnight at `t`, for a path that stands for a day.
    pub fn clock_min(&self, t: f64) -> Option<f64> {
        self.day.as_ref().map(|d| d.start_min + t * self.duration_min)
    }
}

fn check_arcs(arcs: &[SunArc]) -> Result<(), PathError> {
    if arcs.is_empty() {
        return Err(PathError::Empty);
    }
    let mut previous_t = 0.0;
    for (index, arc) in arcs.iter().enumerate() {
        let wrong = |reason| Err(PathError::Arc { index, reason });
        let numbers = [arc.declination_rad, arc.hour_angle_rad[0], arc.hour_angle_rad[1], arc.t[0], arc.t[1]];
        if !arc.axis.is_finite() || !arc.zero.is_finite() || numbers.iter().any(|x| !x.is_finite()) {
            return wrong("a number is not finite");
        }
        let off_unit = (arc.axis.length() - 1.0).abs().max((arc.zero.length() - 1.0).abs());
        if off_unit > 1e-9 || arc.axis.dot(arc.zero).abs() > 1e-9 {
            return wrong("axis and zero are not unit vectors at a right angle");
        }
        if arc.hour_angle_rad[1] <= arc.hour_angle_rad[0] || arc.t[1] <= arc.t[0] {
            return wrong("its end is not after its start");
        }
        if (arc.t[0] - previous_t).abs() > 1e-9 {
            return wrong("it does not start where the one before it ended");
        }
        previous_t = arc.t[1];
    }
    if (previous_t - 1.0).abs() > 1e-9 {
        return Err(PathError::Arc { index: arcs.len() - 1, reason: "the last arc does not end at t = 1" });
    }
    Ok(())
}
