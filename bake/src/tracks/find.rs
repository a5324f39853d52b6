//! The spans of texels: which occluders matter, and when each of them hides the sun.

use super::{FoundSpan, FoundSpans, OWN_PLANE};
use crate::atlas::{Around, PageSize, SurfacePoint};
use crate::intervals::Intervals;
use crate::visibility::{OccluderFinder, OccluderSession};
use rayon::prelude::*;

/// Texels that one session finds in a row.
const RUN: usize = 256;
/// What two ends of shade may be apart and still be one, in path time: rounding.
const TOUCH: f64 = 1e-9;
/// The place of a texel that is not among those asked for.
const ABSENT: u32 = u32::MAX;

/// Shade by parts: each with its spans.
type Shades = Vec<(u32, Intervals)>;

/// Finds the spans of some texels of a page, in their order; each has a `point`. Spans shorter than `least_t`, in path
/// time, are left out: they are too short to be seen. What matters at a texel is a minimal cover of its own shade and
/// of that of texels around it, if they are asked for as well and none of the page's `walls` parts them.
pub fn find_spans(
    finder: &OccluderFinder,
    texels: &[u32],
    point: &(dyn Fn(u32) -> SurfacePoint + Sync),
    size: PageSize,
    walls: Option<&[[u8; 2]]>,
    least_t: f64,
) -> FoundSpans {
    let around = Around::new(size, walls);
    let of_texels = |find: &(dyn Fn(&mut OccluderSession, usize, &SurfacePoint) -> Shades + Sync)| -> Vec<Shades> {
        let of_run = |(run, some): (usize, &[u32])| {
            let mut session = finder.session();
            let of_texel = |(i, &texel): (usize, &u32)| find(&mut session, run * RUN + i, &point(texel));
            some.iter().enumerate().map(of_texel).collect::<Vec<_>>()
        };
        texels.par_chunks(RUN).enumerate().flat_map_iter(of_run).collect()
    };
    let covers = of_texels(&|session, _, point| cover(session, point, least_t));
    let mut place = vec![ABSENT; texels.iter().max().map_or(0, |&last| last as usize + 1)];
    texels.iter().zip(0..).for_each(|(&texel, index)| place[texel as usize] = index);
    let cover_of = |texel: usize| place.get(texel).filter(|&&index| index != ABSENT).map(|&i| &covers[i as usize]);
    let all = of_texels(&|session, index, point| {
        let others = around.texels(texels[index] as usize).filter_map(cover_of);
        let mut parts: Vec<u32> = others.flat_map(|cover| cover.iter().map(|shade| shade.0)).collect();
        parts.sort_unstable();
        parts.dedup();
        let own = &covers[index];
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
    let mut found = FoundSpans::default();
    for shades in all {
        let spans =
            shades.iter().flat_map(|(part, shade)| shade.as_slice().iter().map(|&shade| FoundSpan::new(*part, shade)));
        found.push(spans);
    }
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
