//! Detail below a texel: cuts between charts, and bars much finer than a texel.

use crate::{ao, bake, baked, ball, front, ground, settings};
use glam::{DMat4, DVec2, Vec2, Vec3};
use std::collections::HashMap;
use sunbake::settings::{AmbientRequest, BakeSettings};
use sunbake::testing::{SceneBuilder, block, floor, opaque};

#[test]
fn supersampling_averages_over_a_texel() {
    // Below a grate much finer than texels, a single point sees a bar or a gap by chance.
    let bars: Vec<[Vec3; 3]> = (-20..20)
        .flat_map(|i| floor(Vec2::new(i as f32 * 0.1, -2.0), Vec2::new(i as f32 * 0.1 + 0.05, 2.0), 0.02))
        .collect();
    let scene = SceneBuilder::new().soup(&ground(2.0)).soup(&bars).build();
    let spread = |supersample: u32| {
        let request = AmbientRequest { supersample, ..AmbientRequest::with_rays(1024) };
        let settings = BakeSettings { page_size_texels: 64, ambient: Some(request), ..settings() };
        let (_, texels) = bake(&scene, &settings);
        let opens: Vec<f64> = texels
            .iter()
            .filter(|t| {
                t.position[1].abs() < 1e-4 && t.normal[1] > 0.9 && t.position[0].abs().max(t.position[2].abs()) < 1.5
            })
            .map(ao)
            .collect();
        let mean = opens.iter().sum::<f64>() / opens.len() as f64;
        (mean, (opens.iter().map(|o| (o - mean).powi(2)).sum::<f64>() / opens.len() as f64).sqrt())
    };
    let ((mean, one), (mean_of_more, four)) = (spread(1), spread(4));
    assert!((mean - mean_of_more).abs() < 0.05 && four < 0.6 * one, "{mean} {one}, {mean_of_more} {four}");
}

/// What a filter of two by two texels reads.
fn filtered(open: &[u16], [width, height]: [usize; 2], uv: Vec2) -> f64 {
    let place = uv.as_dvec2() * DVec2::new(width as f64, height as f64) - 0.5;
    let (low, share) = (place.floor(), place - place.floor());
    let texel = |dx: f64, dy: f64| {
        let x = (low.x + dx).clamp(0.0, width as f64 - 1.0) as usize;
        let y = (low.y + dy).clamp(0.0, height as f64 - 1.0) as usize;
        f64::from(open[y * width + x]) / 65_535.0
    };
    let row = |dy: f64| texel(0.0, dy) * (1.0 - share.x) + texel(1.0, dy) * share.x;
    row(0.0) * (1.0 - share.y) + row(1.0) * share.y
}

#[test]
fn no_seam_shows_where_charts_meet() {
    // A round stone of many charts, half in the shade of a slab, and a bent strip.
    let slab = block(Vec3::new(-2.0, 1.2, -0.5), Vec3::new(0.3, 1.4, 2.0));
    let scene =
        SceneBuilder::new().mesh_of(ball(3), opaque(), &[DMat4::IDENTITY]).soup(&slab).soup(&ground(3.0)).build();
    let request = AmbientRequest::with_rays(64);
    let settings = BakeSettings { page_size_texels: 256, ambient: Some(request), ..settings() };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (set, _) = baked(&scene, &settings, folder.path());
    let scene = set.scene(&sunbake::scene::LoadLimits::default()).unwrap();
    let page = &set.pages[0];
    let open = &front(&set).visibility;
    let mut edges: HashMap<[[u32; 3]; 2], Vec<[Vec2; 2]>> = HashMap::new();
    for mesh in scene.meshes.iter().filter(|mesh| mesh.normals.is_some()) {
        let uvs = mesh.texcoords[1].as_ref().unwrap();
        for triangle in mesh.indices.chunks_exact(3) {
            for k in 0..3 {
                let mut ends = [triangle[k], triangle[(k + 1) % 3]]
                    .map(|v| (mesh.positions[v as usize].to_array().map(|x| (x + 0.0).to_bits()), uvs[v as usize]));
                ends.sort_by_key(|end| end.0);
                edges.entry(ends.map(|end| end.0)).or_default().push(ends.map(|end| end.1));
            }
        }
    }
    let mut apart = Vec::new();
    for sides in edges.values().filter(|sides| sides.len() == 2 && sides[0] != sides[1]) {
        for step in 0..=8 {
            let at = |[a, b]: [Vec2; 2]| {
                filtered(open, [page.width as usize, page.height as usize], a.lerp(b, step as f32 / 8.0))
            };
            apart.push((at(sides[0]) - at(sides[1])).abs());
        }
    }
    apart.sort_by(f64::total_cmp);
    let (p99, worst) = (apart[apart.len() * 99 / 100], apart[apart.len() - 1]);
    println!("{} points on cuts: 99 % within {p99:.4}, worst {worst:.4}", apart.len());
    // Three codes of 8 bits, which the eye does not see, and five more of noise at the worst point.
    assert!(apart.len() > 500 && p99 < 3.0 / 255.0 && worst < 8.0 / 255.0, "{} {p99} {worst}", apart.len());
    let told = &set.manifest.ambient.as_ref().unwrap().seams;
    assert!(told.mean < 0.5 * told.mean_before, "{told:?}");
}
