//! The two faces of the roadside sign.

use std::sync::OnceLock;

use glam::{DVec2, dvec2};

use super::pixmap::{Rgb, blend, shade};
use crate::letters::{Stroke, text_strokes};
use crate::noise::{fbm, smoothstep};
use crate::trig::{cos, sin};

const TURQUOISE: Rgb = [0.20, 0.58, 0.58];
const CREAM: Rgb = [0.95, 0.89, 0.74];
const RED: Rgb = [0.76, 0.20, 0.13];
const YELLOW: Rgb = [0.97, 0.72, 0.20];

/// 1 inside a shape (distance below 0), with an edge of about a pixel of a 256 px high picture.
fn fill(distance: f64) -> f64 {
    smoothstep(0.003, -0.003, distance)
}

fn box_distance(p: DVec2, half: DVec2, radius: f64) -> f64 {
    let q = p.abs() - half + DVec2::splat(radius);
    q.max(DVec2::ZERO).length() + q.x.max(q.y).min(0.0) - radius
}

fn text_distance(strokes: &[Stroke], p: DVec2, half_bold: f64) -> f64 {
    let mut nearest = f64::INFINITY;
    for stroke in strokes {
        let n = stroke.points.len();
        for k in 1..n + usize::from(stroke.closed) {
            let (a, b) = (stroke.points[k - 1], stroke.points[k % n]);
            let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
            nearest = nearest.min(p.distance(a.lerp(b, t)));
        }
    }
    nearest - half_bold
}

/// The half sun on the lower rim: a disc and eleven rays.
fn sun_cover(p: DVec2) -> f64 {
    let from = p - dvec2(0.0, -0.40);
    let disc = from.length() - 0.21;
    let mut cover = fill(disc);
    for k in 0..11 {
        let angle = f64::from(k) * std::f64::consts::PI / 10.0;
        let along = from.dot(dvec2(cos(angle), sin(angle)));
        let across = from.perp_dot(dvec2(cos(angle), sin(angle))).abs();
        let ray = (across - 0.030 * (along / 0.3)).max(0.255 - along).max(along - if k % 2 == 0 { 0.44 } else { 0.37 });
        cover = cover.max(fill(ray));
    }
    cover
}

fn weathered(color: Rgb, u: f64, v: f64) -> Rgb {
    let fade = fbm(u * 7.0, v * 4.0, 4, 0, 121);
    let streak = smoothstep(0.55, 0.8, fbm(u * 40.0, v * 2.0, 3, 0, 122));
    shade(blend(color, CREAM, 0.16 * fade), 0.90 + 0.12 * fade - 0.10 * streak)
}

/// The big face, twice as wide as high: a rising sun under the station's name.
pub(crate) fn sun(u: f64, v: f64) -> Rgb {
    static NAME: OnceLock<Vec<Stroke>> = OnceLock::new();
    let name = NAME.get_or_init(|| text_strokes("SUNBAKE", 0.25));
    let p = dvec2((u - 0.5) * 2.0, 0.5 - v);
    let inner = box_distance(p, dvec2(0.96, 0.46), 0.06);
    let rim = fill(inner + 0.025) - fill(inner + 0.045);
    let mut color = blend(TURQUOISE, YELLOW, sun_cover(p) * fill(inner + 0.045));
    color = blend(color, CREAM, rim.max(fill(text_distance(name, p - dvec2(0.0, 0.235), 0.047))));
    color = blend(color, RED, fill(text_distance(name, p - dvec2(0.0, 0.235), 0.028)));
    weathered(blend(color, CREAM, 1.0 - fill(inner)), u, v)
}

/// The small face, twice as wide as high.
pub(crate) fn gas(u: f64, v: f64) -> Rgb {
    static WORD: OnceLock<Vec<Stroke>> = OnceLock::new();
    let word = WORD.get_or_init(|| text_strokes("GAS", 0.56));
    let p = dvec2((u - 0.5) * 2.0, 0.5 - v);
    let inner = box_distance(p, dvec2(0.93, 0.43), 0.10);
    let color = blend(RED, CREAM, fill(inner));
    weathered(blend(color, RED, fill(text_distance(word, p, 0.062))), u, v)
}
