//! Fitted days against the ephemeris, over places and dates that make trouble.

use super::super::{Compass, DayOutcome, DayRequest, day, ephemeris::Ephemeris};

const LATITUDES: [f64; 11] = [-90.0, -66.6, -45.0, -23.4, 0.0, 35.0, 51.5, 66.5, 70.0, 89.9, 90.0];
const LONGITUDES: [f64; 4] = [-180.0, -116.0, 0.0, 179.9];
const DATES: [&str; 6] = ["2026-03-20", "2026-06-21", "2026-09-23", "2026-12-21", "2028-02-29", "2026-11-03"];

pub(super) fn request(latitude_deg: f64, longitude_deg: f64, date: &str) -> DayRequest {
    let date = date.parse().expect("a date");
    DayRequest { latitude_deg, longitude_deg, date, utc_offset_h: None, north_deg: 0.0, window: None }
}

#[test]
fn every_place_and_date_stays_within_its_stated_error() {
    let (mut worst, mut worst_jump, mut arcs, mut dark) = (0.0f64, 0.0f64, [0; 4], 0);
    for latitude in LATITUDES {
        for longitude in LONGITUDES {
            for date in DATES {
                let request = request(latitude, longitude, date);
                let path = match day(&request).expect("a day") {
                    DayOutcome::Path(path) => path,
                    DayOutcome::NoSun { highest_elevation_deg, .. } => {
                        assert!(highest_elevation_deg < 1e-3, "{latitude} {longitude} {date}: {highest_elevation_deg}");
                        dark += 1;
                        continue;
                    }
                };
                let day = path.day.as_ref().expect("a day");
                let ephemeris =
                    Ephemeris::new([latitude, longitude], request.date, day.utc_offset_h, Compass::new(0.0))
                        .expect("an ephemeris");
                // At other moments than the fit's own samples.
                for i in 0..=2000 {
                    let t = f64::from(i) / 2000.0;
                    let truth = ephemeris.direction(day.start_min + t * path.duration_min).expect("a direction");
                    let error = path.direction(t).angle_between(truth).to_degrees();
                    if truth.y > 0.0 {
                        worst = worst.max(error);
                        assert!(error < 0.02, "{latitude} {longitude} {date}: {error} degrees at t {t}");
                        assert!(
                            error < day.ephemeris_error_deg + 1e-4,
                            "{latitude} {longitude} {date}: more than the stated error"
                        );
                    }
                }
                for pair in path.arcs().windows(2) {
                    let [end, start] = [pair[0].hour_angle_rad[1], pair[1].hour_angle_rad[0]];
                    let jump =
                        pair[0].direction_at_hour_angle(end).angle_between(pair[1].direction_at_hour_angle(start));
                    worst_jump = worst_jump.max(jump.to_degrees());
                }
                arcs[path.arcs().len()] += 1;
            }
        }
    }
    println!("worst {worst} degrees, worst jump {worst_jump} degrees, arcs {arcs:?}, without sun {dark}");
    assert!(worst_jump < 1e-4, "arcs meet with a jump of {worst_jump} degrees");
}
