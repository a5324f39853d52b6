use std::collections::HashMap;
use sunbake::ambient::*;
use sunbake::atlas::*;
use sunbake::scene::*;
use sunbake::settings::AmbientRequest;
use sunbake::trace::Tracer;
fn main() {
    let f = std::env::args().nth(1).unwrap();
    let scene = load(std::path::Path::new(&f), &LoadLimits::default()).unwrap();
    let g = Geometry::new(&scene);
    let n = ShadingNormals::new(&scene);
    let t = Tracer::new(&scene, &g);
    let mut m: HashMap<[[u32; 3]; 2], Vec<(usize, usize)>> = HashMap::new();
    for tri in 0..g.triangles.len() {
        for k in 0..3 {
            let (a, b) = (g.triangles[tri][k], g.triangles[tri][(k + 1) % 3]);
            let mut p = [a.to_array().map(f32::to_bits), b.to_array().map(f32::to_bits)];
            p.sort();
            m.entry(p).or_default().push((tri, k));
        }
    }
    let e = AmbientEngine::new(&scene, &g, &t, AmbientRequest::with_rays(256).estimate);
    let mut pts = vec![];
    let mut pairs = vec![];
    let w = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    for (_, v) in &m {
        if v.len() < 2 {
            continue;
        }
        for i in 0..v.len() {
            for j in i + 1..v.len() {
                let mid = |(tri, k): (usize, usize)| {
                    let a = w[k];
                    let b = w[(k + 1) % 3];
                    let c = w[(k + 2) % 3];
                    [0, 1].map(|x| (a[x] * 0.5 + b[x] * 0.5) * 0.98 + c[x] * 0.02)
                };
                let na = n.at(&scene, &g, v[i].0, mid(v[i]));
                let nb = n.at(&scene, &g, v[j].0, mid(v[j]));
                if na.dot(nb) < 0.999 {
                    continue;
                }
                pairs.push((v[i], v[j], pts.len(), v.len()));
                for s in [v[i], v[j]] {
                    let b = mid(s);
                    pts.push(AmbientPoint {
                        surface: SurfacePoint {
                            position_m: g.point(s.0, b),
                            normal: g.normal(s.0),
                            is_double_sided: scene.material(g.instance[s.0] as usize).is_double_sided,
                            triangle: s.0 as u32,
                        },
                        shading_normal: n.at(&scene, &g, s.0, b),
                    });
                }
            }
        }
    }
    let step = (pairs.len() / 20000).max(1);
    let sel: Vec<_> = pairs.iter().step_by(step).collect();
    let runs =
        find_ambient(&e, sel.len() * 2, |i, p: &mut Vec<AmbientPoint>| p.push(pts[sel[i / 2].2 + i % 2]), |_| true)
            .unwrap();
    let o: Vec<f32> = runs.iter().flat_map(|r| r.front.iter().map(|e| e.open)).collect();
    let mut by: HashMap<(String, usize), (f32, usize, usize)> = HashMap::new();
    for (i, p) in sel.iter().enumerate() {
        let d = (o[2 * i] - o[2 * i + 1]).abs();
        let inst = g.instance[p.0.0] as usize;
        let name = format!(
            "{:?} {:?} same_inst={} ndot={:.2} ds={}",
            scene.nodes[scene.instances[inst].node].name,
            scene.material(inst).name,
            g.instance[p.0.0] == g.instance[p.1.0],
            g.normal(p.0.0).dot(g.normal(p.1.0)),
            scene.material(inst).is_double_sided
        );
        let x = by.entry((name, p.3)).or_default();
        x.0 += d;
        x.1 += 1;
        if d > 0.1 {
            x.2 += 1;
        }
    }
    let mut v: Vec<_> = by.into_iter().collect();
    v.sort_by(|a, b| b.1.2.cmp(&a.1.2));
    println!("pairs {}", pairs.len());
    for x in v.iter().take(25) {
        println!("{:?}", x);
    }
}
