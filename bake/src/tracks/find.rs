//! The spans of every texel: which occluders matter, and when each of them hides the sun.

use crate::atlas::{Around, PageSize, SurfacePoint};
use crate::intervals::Intervals;
use crate::visibility::{OccluderFinder, OccluderSession};
use rayon::prelude::*;

/// The occluder that stands for the surface's own plane and the horizon.
pub const OWN_PLANE: u32 = u32::MAX;

/// Texels that one session finds in a row.
const RUN: usize = 256;
/// What two ends of shade may be apart and still be one, in path time: rounding.
const TOUCH: f64 = 1e-9;

/// A span of shade by one occluder.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FoundSpan {
    /// The occluder's part, or [`OWN_PLANE`].
    pub part: u32,
    /// Start and end, path time.
    pub shade: [f64; 2],
}

/// Spans of the texels of a page, each texel's by ascending part and time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FoundSpans {
    /// For each texel, where its spans begin; one more at the end.
    pub first: Vec<u32>,
    /// All spans.
    pub spans: Vec<FoundSpan>,
}

impl FoundSpans {
    /// Of a texel.
    pub fn of_texel(&self, texel: usize) -> &[FoundSpan] {
        &self.spans[self.first[texel] as usize..self.first[texel + 1] as usize]
    }
}

/// Shade by parts: each with its spans.
type Shades = Vec<(u32, Intervals)>;

/// Finds the spans of every texel that has a point. Those shorter than `least_t` are left out: they are too short to be
/// seen. `walls` are the page's.
pub fn find_spans(
    finder: &OccluderFinder,
    size: PageSize,
    points: &[Option<SurfacePoint>],
    walls: Option<&[[u8; 2]]>,
    least_t: f64,
) -> FoundSpans {
    let of_texels = |find: &(dyn Fn(&mut OccluderSession, usize, &SurfacePoint) -> Shades + Sync)| -> Vec<Shades> {
        let of_run = |run: usize| {
            let mut session = finder.session();
            let texels = run * RUN..points.len().min((run + 1) * RUN);
            let of_texel =
                |texel: usize| points[texel].as_ref().map_or_else(Vec::new, |point| find(&mut session, texel, point));
            texels.map(of_texel).collect::<Vec<_>>()
        };
        (0..points.len().div_ceil(RUN)).into_par_iter().flat_map_iter(of_run).collect()
    };
    let covers = of_texels(&|session, _, point| cover(session, point, least_t));
    let around = Around::new(size, walls);
    let all = of_texels(&|session, texel, point| {
        let mut parts: Vec<u32> = around.texels(texel).flat_map(|other| covers[other].iter().map(|s| s.0)).collect();
        parts.sort_unstable();
        parts.dedup();
        let own = &covers[texel];
        let facing = session.facing(point);
        let mut shades: Shades = own.clone();
        for part in parts.into_iter().filter(|part| *part != OWN_PLANE) {
            if own.iter().all(|(own, _)| *own != part) {
                shades.push((part, shade_of(session, point, &facing, part, least_t)));
            }
        }
        shades.sort_by_key(|(part, _)| *part);
        shades
    });
    let mut found = FoundSpans { first: Vec::with_capacity(points.len() + 1), spans: Vec::new() };
    for shades in all {
        found.first.push(found.spans.len() as u32);
        let of_part = |(part, shade): (u32, Intervals)| {
            shade.as_slice().iter().map(|&shade| FoundSpan { part, shade }).collect::<Vec<_>>()
        };
        found.spans.extend(shades.into_iter().flat_map(of_part));
    }
    found.first.push(found.spans.len() as u32);
    found
}

/// When a part alone hides the sun from a point that faces it.
fn shade_of(
    session: &mut OccluderSession,
    point: &SurfacePoint,
    facing: &Intervals,
    part: u32,
    least_t: f64,
) -> Intervals {
    let shade = facing.without(&session.alone(point, part));
    shade.longer_than(least_t)
}

/// Parts that together hide the sun from a point whenever it is hidden, none of which can be left out, and when the
/// surface's own plane does.
fn cover(session: &mut OccluderSession, point: &SurfacePoint, least_t: f64) -> Shades {
    let facing = session.facing(point);
    let (lit, parts) = session.find(point);
    let shade = facing.without(&lit);
    let mut shades: Shades =
        parts.into_iter().map(|part| (part, shade_of(session, point, &facing, part, least_t))).collect();
    shades.retain(|(_, shade)| !shade.as_slice().is_empty());
    // The shortest are tried first.
    shades.sort_by(|a, b| a.1.lit_length().total_cmp(&b.1.lit_length()).then(a.0.cmp(&b.0)));
    let mut index = 0;
    while index < shades.len() {
        let others = shades.iter().enumerate().filter(|(other, _)| *other != index);
        let union = others.flat_map(|(_, (_, shade))| shade.as_slice().iter().copied());
        let union = Intervals::from_unsorted(union.collect());
        let own_share = shades[index].1.intersection(&shade).without(&union);
        match own_share.longer_than(least_t.max(TOUCH)).as_slice().is_empty() {
            true => {
                shades.remove(index);
            }
            false => index += 1,
        }
    }
    shades.push((OWN_PLANE, Intervals::always().without(&facing).longer_than(TOUCH)));
    shades.sort_by_key(|(part, _)| *part);
    shades
}
