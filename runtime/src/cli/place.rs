//! Cameras, as options name them.

use glam::DVec3;
use sunbake_runtime::camera::CameraChoice;

/// Vertical field of view unless given, in degrees.
const FOV_DEG: f64 = 45.0;

/// Reads a camera. What is all numbers is a pair of points; anything else is a name.
pub fn parse_camera(text: &str) -> Result<CameraChoice, String> {
    if text == "default" {
        return Ok(CameraChoice::Default);
    }
    let numbers: Option<Vec<f64>> =
        text.split(',').map(|x| x.trim().parse().ok().filter(|x: &f64| x.is_finite())).collect();
    let Some(numbers) = numbers else { return Ok(CameraChoice::Named(text.to_owned())) };
    let (points, fov_deg) = match numbers.len() {
        6 => (numbers.as_slice(), FOV_DEG),
        7 => (&numbers[..6], numbers[6]),
        count => {
            return Err(format!("`{text}` has {count} numbers; a camera has six or seven: ex,ey,ez,tx,ty,tz[,fov]"));
        }
    };
    if !(1.0..=170.0).contains(&fov_deg) {
        return Err(format!("a field of view of {fov_deg} degrees is out of range: give 1 to 170"));
    }
    let (eye_m, target_m) = (DVec3::from_slice(&points[..3]), DVec3::from_slice(&points[3..]));
    if eye_m == target_m {
        return Err(format!("`{text}` looks from a point at the same point: give two points"));
    }
    Ok(CameraChoice::LookAt { eye_m, target_m, fov_deg })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cameras_are_names_or_points() {
        assert_eq!(parse_camera("hero"), Ok(CameraChoice::Named("hero".into())));
        assert_eq!(parse_camera("default"), Ok(CameraChoice::Default));
        let camera = parse_camera("-1,2,3, 0,0,0,60").unwrap();
        assert_eq!(
            camera,
            CameraChoice::LookAt { eye_m: DVec3::new(-1.0, 2.0, 3.0), target_m: DVec3::ZERO, fov_deg: 60.0 }
        );
        for bad in ["1,2,3", "1,2,3,1,2,3", "0,0,0,1,1,1,0", "0,0,0,1,1,1,180", "1,2,3,4,5,6,7,8"] {
            assert!(parse_camera(bad).is_err(), "{bad}");
        }
    }
}
