use sunbake::ambient::*;
use sunbake::atlas::{self, *};
use sunbake::scene::*;
use sunbake::settings::AmbientRequest;
use sunbake::trace::Tracer;
fn main() {
    let f = std::env::args().nth(1).unwrap();
    let edge: u32 = std::env::args().nth(2).unwrap().parse().unwrap();
    let scene = load(std::path::Path::new(&f), &LoadLimits::default()).unwrap();
    let at = atlas::build(&scene, &AtlasSettings { page_size_texels: edge, ..Default::default() }, &|_| true).unwrap();
    let g = Geometry::new(&scene);
    let n = ShadingNormals::new(&scene);
    let t = Tracer::new(&scene, &g);
    let samples = atlas::sample_page(&scene, &g, &at, 0);
    let order = atlas::by_tiles(&samples, at.pages[0]);
    let e = AmbientEngine::new(&scene, &g, &t, AmbientRequest::with_rays(64).estimate);
    let runs = find_ambient(
        &e,
        order.len(),
        |i, p: &mut Vec<AmbientPoint>| {
            let s = &samples.samples[order[i] as usize];
            p.push(AmbientPoint {
                surface: atlas::surface_point(&scene, &g, s),
                shading_normal: n.at(&scene, &g, s.triangle as usize, s.barycentric.map(f64::from)),
            });
        },
        |_| true,
    )
    .unwrap();
    let mut page = AmbientPage::new(at.pages[0], &samples, &order, &runs, e.settings());
    page.fill(&atlas::gutter(at.pages[0], &samples, 2), &samples);
    let now = std::time::Instant::now();
    let seams = Seams::find(&scene, &g, &n, &at, 0, &samples);
    println!("find {:?}", now.elapsed());
    let b = page.front.open.clone();
    println!("{:#?}", seams.heal(&mut page.front.open, [0.0, 1.0]));
    let mut moved: Vec<f32> =
        samples.samples.iter().map(|s| (b[s.texel as usize] - page.front.open[s.texel as usize]).abs()).collect();
    moved.sort_by(f32::total_cmp);
    println!(
        "moved covered: p99 {} p999 {} max {}",
        moved[moved.len() * 99 / 100],
        moved[moved.len() * 999 / 1000],
        moved[moved.len() - 1]
    );
}
