//! What a drop shows, against rays traced through its true shape.

use glam::{DVec3, Vec3};
use rain_core::optics::{drop_rays_f32, DropBody, CHEAP_REFLECTED, CHEAP_REFRACTED};
use rain_core::rainfall::{Spheroid, DropOutline};
use rain_reference::light::drop::{Shape, lamp, overcast, see};

const N: f64 = 1.333;

#[test]
fn explore() {
    let env: [(&str, Box<dyn Fn([f64; 3]) -> f64>); 3] = [
        ("uniform", Box::new(|_| 1.0)),
        ("overcast", Box::new(|d| overcast(d, 0.05))),
        ("lamp", Box::new(|d| 0.02 + 20.0*lamp(d, DVec3::new(0.3, 0.25, -1.0).normalize().to_array(), 0.15))),
    ];
    for elevation in [0.0_f64, 0.5, -0.5] {
        let view = DVec3::new(0.0, elevation.sin(), -elevation.cos());
        let right = DVec3::X;
        let up = right.cross(view);
        let cap = |f: &dyn Fn([f64; 3]) -> f64, half: f64, axis: DVec3| {
            let (mut sum, mut w) = (0.0, 0.0);
            for i in 0..100 { for j in 0..200 {
                let c = 1.0 - (1.0 - half.cos()) * (f64::from(i) + 0.5) / 100.0;
                let phi = f64::from(j) * 0.0314159265;
                let s = (1.0 - c * c).sqrt();
                let d = axis * c + right * (s * phi.cos()) + up * (s * phi.sin());
                sum += f(d.to_array()); w += 1.0;
            }}
            sum / w
        };
        for mm in [1.0, 2.0, 4.0] {
            let shape = Shape::falling(mm);
            let ends = shape.ends();
            let middle = 0.5 * (ends[0] + ends[1]);
            let sph = Spheroid::of_drop(mm);
            let (a, alpha) = (sph.horizontal_mm / mm * 2.0, sph.vertical_mm / sph.horizontal_mm);
            let body_s = DropBody::new(alpha as f32, alpha as f32);
            let (body, [wide, level]) = DropBody::of_outline(&DropOutline::new(mm));
            println!("{body:?} {wide} {level}");
            // rows: model -> env -> (sum|err|, sum ref, sum model)
            let names = ["round s", "outline 2ray", "cheap", "sph 2", "sph 3", "sph4", "sph5", "outl-n sph2", "outl-n sph3", "outl-n sph5", "egg2", "egg3", "egg5", "outl-n egg2", "outl-n egg3", "outl-n egg5"];
            let mut err = vec![[0.0; 3]; names.len()];
            let mut bias = vec![[0.0; 3]; names.len()];
            let mut total = [0.0; 3];
            let mut missed = 0; let mut missed_egg = 0;
            let mut count = 0;
            let caps: Vec<[f64; 2]> = env.iter().map(|(_, f)| [cap(f, 40.0_f64.to_radians(), view), cap(f, core::f64::consts::PI, view)]).collect();
            let m = 40;
            for i in 0..m { for j in 0..m {
                let (u, v) = ((f64::from(i) + 0.5) / f64::from(m) * 2.4 - 1.2, (f64::from(j) + 0.5) / f64::from(m) * 2.4 - 1.2);
                let q = right * u + up * v;
                let Some(seen) = see(&shape, (q + DVec3::Y * middle).to_array(), view.to_array(), N, if mm > 3.0 && elevation < 0.0 { 20 } else { 3 }) else { continue };
                count += 1;
                let truth: Vec<f64> = env.iter().map(|(_, f)| seen.radiance(f)).collect();
                let v32 = view.as_vec3();
                let outline = DVec3::from_array(seen.normal).as_vec3();
                let vertical = (alpha * elevation.cos()).hypot(elevation.sin()) ;
                let mut disc = Vec3::new((u / a) as f32, (v / (a * vertical)) as f32, 0.0);
                if disc.length() > 0.9999 { disc = disc.normalize() * 0.9999; }
                let ball = (right.as_vec3() * disc.x + up.as_vec3() * disc.y - v32 * (1.0 - disc.length_squared()).max(0.0).sqrt()).normalize();
                let thr = right.as_vec3() * disc.x + up.as_vec3() * disc.y * vertical as f32;
                let sn = match body_s.enter((q / a).as_vec3(), v32) { Some(n) => n, None => { missed += 1; body_s.enter(thr, v32).unwrap() } };
                let at = ((q + DVec3::Y * middle).as_vec3() - Vec3::Y * level) / wide;
                let axis_at = (DVec3::Y * middle).as_vec3() / wide - Vec3::Y * level / wide;
                let mut t = 1.0; let mut eg = body.enter(at, v32);
                while eg.is_none() { t -= 0.005; eg = body.enter(axis_at + (at - axis_at) * t, v32); }
                if t < 1.0 { missed_egg += 1; }
                let eg = eg.unwrap();
                for e in 0..3 {
                    let f = &env[e].1;
                    let l = |d: Vec3| f(d.as_dvec3().to_array());
                    let two = |n: Vec3| { let r = drop_rays_f32(v32, n, N as f32).unwrap(); f64::from(r.refracted_weight) * l(r.refracted) + f64::from(r.reflected_weight) * l(r.reflected) };
                    let sum = |rays: &[rain_core::optics::DropRay]| rays.iter().map(|r| f64::from(r.weight) * l(r.direction)).sum::<f64>();
                    let n = N as f32;
                    let values = [
                        two(ball), two(outline),
                        f64::from(CHEAP_REFRACTED) * caps[e][0] + f64::from(CHEAP_REFLECTED) * caps[e][1],
                        sum(&body_s.rays::<2>(v32, sn, n).unwrap()),
                        sum(&body_s.rays::<3>(v32, sn, n).unwrap()),
                        sum(&body_s.rays::<4>(v32, sn, n).unwrap()),
                        sum(&body_s.rays::<5>(v32, sn, n).unwrap()),
                        sum(&body_s.rays::<2>(v32, outline, n).unwrap()),
                        sum(&body_s.rays::<3>(v32, outline, n).unwrap()),
                        sum(&body_s.rays::<5>(v32, outline, n).unwrap()),
                        sum(&body.rays::<2>(v32, eg, n).unwrap()),
                        sum(&body.rays::<3>(v32, eg, n).unwrap()),
                        sum(&body.rays::<5>(v32, eg, n).unwrap()),
                        sum(&body.rays::<2>(v32, outline, n).unwrap()),
                        sum(&body.rays::<3>(v32, outline, n).unwrap()),
                        sum(&body.rays::<5>(v32, outline, n).unwrap()),
                    ];
                    for (k, value) in values.iter().enumerate() { err[k][e] += (value - truth[e]).abs(); bias[k][e] += value - truth[e]; }
                    total[e] += truth[e];
                }
            }}
            println!("elev {elevation} D {mm} alpha {alpha:.4} rays {count} missed {missed} {missed_egg} mean uniform {:.5}", total[0] / f64::from(count));
            for k in 0..names.len() {
                print!("  {:14}", names[k]);
                for e in 0..3 { print!("  {}: {:.4} ({:+.4})", env[e].0, err[k][e] / total[e], bias[k][e] / total[e]); }
                println!();
            }
        }
    }
}
