//! The sun path: consecutive arcs over `t` in [0, 1], and the day that it represents.

use glam::DVec3;

use super::arc::SunArc;
use super::clock::{DAY_MIN, Date, clock_text, date_time_text};
use crate::intervals::Intervals;

/// A sun path over `t` in [0, 1].
///
/// Guarantees, made by [`SunPath::new`]: at least one arc; arcs cover [0, 1] exactly, in order, without gap or overlap;
/// axes and zeros are unit vectors and orthogonal; every number is finite.
#[derive(Debug, Clone, PartialEq)]
pub struct SunPath {
    arcs: Vec<SunArc>,
    /// Angular radius of the light's disc, in radians; 0 for a point.
    pub angular_radius_rad: f64,
    /// Clock time from t = 0 to t = 1, in minutes, so that errors can be given in minutes.
    pub duration_min: f64,
    /// The day that the path represents, if it is that of a real day.
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
    /// Minutes from local midnight of `date` to t = 0; t = 1 is `duration_min` later. May be outside [0, 1440).
    pub start_min: f64,
    /// Largest angle between the path and the ephemeris, in degrees, sampled each minute while the sun is up.
    pub ephemeris_error_deg: f64,
}

/// Why arcs are not a valid path.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PathError {
    /// No arc at all.
    #[error("a sun path needs at least one arc")]
    Empty,
    /// A number is NaN or infinite, a vector is not unit or not orthogonal, or times do not ascend.
    #[error("arc {index} of the sun path is malformed: {reason}")]
    Arc {
        /// Index of the arc, from 0.
        index: usize,
        /// What is wrong with it.
        reason: &'static str,
    },
    /// The angular radius or the duration is out of range.
    #[error("the sun path's {what} is {value}: it must be finite and {bound}")]
    Size {
        /// Name of the number.
        what: &'static str,
        /// The value given.
        value: f64,
        /// What it must be.
        bound: &'static str,
    },
}

impl SunPath {
    /// Checks the arcs and makes a path of them.
    pub fn new(mut arcs: Vec<SunArc>, angular_radius_rad: f64, duration_min: f64) -> Result<Self, PathError> {
        check_arcs(&arcs)?;
        if !(0.0..std::f64::consts::FRAC_PI_2).contains(&angular_radius_rad) {
            let bound = "at least 0 and under a right angle";
            return Err(PathError::Size { what: "angular radius in radians", value: angular_radius_rad, bound });
        }
        if !(duration_min > 0.0 && duration_min.is_finite()) {
            return Err(PathError::Size { what: "duration in minutes", value: duration_min, bound: "positive" });
        }
        close_gaps(&mut arcs);
        Ok(Self { arcs, angular_radius_rad, duration_min, day: None })
    }

    /// The arcs, in order.
    pub fn arcs(&self) -> &[SunArc] {
        &self.arcs
    }

    /// A lane across the sun's disc: the parallel path with `offset_rad` added to every arc's declination, and the same
    /// hour angle at every `t`.
    pub fn lane(&self, offset_rad: f64) -> Self {
        let mut lane = self.clone();
        lane.arcs.iter_mut().for_each(|arc| arc.declination_rad += offset_rad);
        lane
    }

    /// The arc at `t` (clamped to [0, 1]).
    pub fn arc_at(&self, t: f64) -> &SunArc {
        self.arcs.iter().find(|a| t < a.t[1]).unwrap_or(&self.arcs[self.arcs.len() - 1])
    }

    /// Direction towards the sun at `t`, unit length, world space.
    pub fn direction(&self, t: f64) -> DVec3 {
        let arc = self.arc_at(t);
        arc.direction_at_hour_angle(arc.hour_angle_at(t))
    }

    /// Elevation of the sun's centre above the horizon at `t`, in radians.
    pub fn elevation_rad(&self, t: f64) -> f64 {
        let direction = self.direction(t);
        direction.y.atan2(direction.x.hypot(direction.z))
    }

    /// When the sun's centre is not behind the plane with this `normal` (any length, world space), in closed form.
    pub fn above_plane(&self, normal: DVec3) -> Intervals {
        Intervals::from_unsorted(self.arcs.iter().flat_map(|arc| arc.half_space_intervals(normal)).collect())
    }

    /// When the sun's centre is above the horizon; `up` is the world's up direction.
    pub fn above_horizon(&self, up: DVec3) -> Intervals {
        self.above_plane(up)
    }

    /// Width of the sun in path time: how long its disc takes to cross a line perpendicular to its motion.
    pub fn width_t(&self, t: f64) -> f64 {
        2.0 * self.angular_radius_rad / self.arc_at(t).speed_rad()
    }

    /// Minutes after local midnight at `t`, if the path is that of a day.
    pub fn clock_min(&self, t: f64) -> Option<f64> {
        self.day.as_ref().map(|d| d.start_min + t * self.duration_min)
    }

    /// The `t` at which local clocks show `clock_min` minutes after midnight, on whichever day of the path. `None` if
    /// the path does not include that time or is not that of a day.
    pub fn t_at_clock_min(&self, clock_min: f64) -> Option<f64> {
        let since_start = clock_min - self.day.as_ref()?.start_min;
        // A path of 24 hours from midnight includes midnight twice: 00:00 is its start and 24:00 its end.
        let exact = since_start / self.duration_min;
        let wrapped = since_start.rem_euclid(DAY_MIN) / self.duration_min;
        [exact, wrapped].into_iter().find(|t| (0.0..=1.0).contains(t))
    }

    /// `HH:MM` on local clocks at `t`.
    pub fn clock_text(&self, t: f64) -> Option<String> {
        self.clock_min(t).map(clock_text)
    }

    /// `YYYY-MM-DDTHH:MM:SS` on local clocks at `t`.
    pub fn local_text(&self, t: f64) -> Option<String> {
        let date: Date = self.day.as_ref()?.date.parse().ok()?;
        Some(date_time_text(date, self.clock_min(t)?))
    }

    /// `YYYY-MM-DDTHH:MM:SS` in UTC at `t`.
    pub fn utc_text(&self, t: f64) -> Option<String> {
        let day = self.day.as_ref()?;
        Some(date_time_text(day.date.parse().ok()?, self.clock_min(t)? - 60.0 * day.utc_offset_h))
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
        if arc.hour_angle_rad[1] <= arc.hour_angle_rad[0] || arc.t[1] - arc.t[0] <= JOINT_TOLERANCE_T {
            return wrong("its end is not after its start");
        }
        if (arc.t[0] - previous_t).abs() > JOINT_TOLERANCE_T {
            return wrong("it does not start where the one before it ended");
        }
        previous_t = arc.t[1];
    }
    if (previous_t - 1.0).abs() > JOINT_TOLERANCE_T {
        return Err(PathError::Arc { index: arcs.len() - 1, reason: "the last arc does not end at t = 1" });
    }
    Ok(())
}

/// Largest gap, in `t`, between an arc's end and the next arc's start.
const JOINT_TOLERANCE_T: f64 = 1e-9;

/// Makes the ends of neighbouring arcs equal, so that intervals on both sides of a joint can be merged.
fn close_gaps(arcs: &mut [SunArc]) {
    let mut start = 0.0;
    for arc in arcs.iter_mut() {
        arc.t[0] = start;
        start = arc.t[1];
    }
    if let Some(last) = arcs.last_mut() {
        last.t[1] = 1.0;
    }
}
