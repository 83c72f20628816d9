//! Work against precision of splash thresholds, and of how many splashes are drawn.

use std::hint::black_box;

use glam::{DVec3, IVec2, Vec2, Vec3};
use rain_bench::study::{Study, Variant};
use rain_core::rainfall::{Distribution, Spectrum, terminal_velocity_f32};
use rain_core::splash::{
    Impact, SPLASH_CELL_M, SPLASH_SLOTS, Splash, SplashAnchor, SplashExtent, SplashField, SplashShares, crown_height_m,
    crown_life_s, crown_radius_m_f32, crown_seen_s, splash_excess, splash_excess_f32,
};
use rain_reference::splash as reference;

/// Every study of this file.
pub fn studies() -> Vec<Study> {
    vec![excess(), density()]
}

fn excess() -> Study {
    // Diameter, speed, film: 0.08 to 1.2 diameters, where the reference holds.
    let impacts: Vec<(f32, f32, f32)> = (0..600)
        .map(|i| {
            let d = 0.4 + 0.009 * i as f32;
            (
                d,
                2.0 + 7.0 * (i % 13) as f32 / 13.0,
                d * (0.09 + 1.1 * (i % 29) as f32 / 29.0),
            )
        })
        .collect();
    let variant = |name: &str, f: fn(f32, f32, f32) -> f64| {
        let error = impacts
            .iter()
            .map(|&(d, v, film)| {
                let (d64, v64) = (f64::from(d), f64::from(v));
                let exact = reference::cossali_ratio(d64, v64, f64::from(film) / d64).powf(0.625);
                (f(d, v, film) / exact - 1.0).abs()
            })
            .fold(1e-17, f64::max);
        let impacts = impacts.clone();
        Variant::new(name, error, impacts.len() as u64, move || {
            impacts.iter().map(|&(d, v, film)| f(black_box(d), v, film)).sum()
        })
    };
    /// δ^1.44 as δ √δ, the nearest power without a logarithm.
    fn rooted(d: f32, v: f32, film: f32) -> f64 {
        let delta = film / d;
        let threshold = 2100.0 + 5880.0 * delta * delta.sqrt();
        // x^(5/8) = √(x · x^¼).
        f64::from(rain_core::splash::splash_k_f32(d, v) / (threshold * threshold.sqrt().sqrt()).sqrt())
    }
    Study {
        name: "splash-threshold",
        title: "K of an impact over the threshold on a film",
        norm: "max relative error",
        unit: "impact",
        variants: vec![
            variant("f64", |d, v, film| {
                splash_excess(f64::from(d), f64::from(v), f64::from(film))
            }),
            variant("f32", |d, v, film| f64::from(splash_excess_f32(d, v, film))).default(),
            variant("f32, power 3/2 for 1.44", rooted),
        ],
    }
}

/// Moments that are looked at, a fraction of a second apart.
const MOMENTS: u32 = 48;
/// Film on the road. Units: mm.
const FILM_MM: f32 = 0.2;

/// A view over level ground, as wide as a screen, at the defaults of the plugins.
fn view() -> SplashExtent {
    SplashExtent {
        reach_m: 14.0,
        near_m: 3.5,
        angle_rad: 1.2,
        exposure_s: 1.0 / 60.0,
        film_mm: FILM_MM.into(),
    }
}

/// What the crowns of a moment cover, seen from the side, for the share of the exposure that each is seen. Units: m².
fn covered_m2(field: &SplashField, now_s: f64) -> f64 {
    let extent = view();
    let (reach, half_angle) = (extent.reach_m as f32, 0.5 * extent.angle_rad as f32);
    let anchor = SplashAnchor::new(DVec3::new(3.7, 1.7, -8.1), now_s);
    let span = (extent.reach_m / SPLASH_CELL_M) as i32 + 1;
    let mut sum = 0.0;
    for back in 0..SPLASH_SLOTS {
        for z in -span..=span {
            for x in -span..=span {
                let cell = IVec2::new(x, z);
                field.for_each(anchor.cell.wrapping_add(cell), anchor.slot.wrapping_sub(back), |mark| {
                    let at = (cell.as_vec2() - anchor.fraction + Vec2::from(mark.place)) * SPLASH_CELL_M as f32;
                    let age = anchor.age_s(back, mark.moment);
                    let life = crown_life_s(mark.diameter_mm.into()) as f32;
                    let begun = age - extent.exposure_s as f32;
                    if at.length() > reach || at.x.atan2(-at.y).abs() > half_angle || age < 0.0 || begun > life {
                        return;
                    }
                    let speed = terminal_velocity_f32(mark.diameter_mm);
                    let impact = Impact {
                        diameter_mm: mark.diameter_mm,
                        velocity_m_s: -speed * Vec3::Y,
                        normal: Vec3::Y,
                        film_mm: FILM_MM,
                    };
                    if Splash::new(&impact, mark.key).count == 0 {
                        return;
                    }
                    let time = 0.5 * (begun.max(0.0) + age.min(life));
                    let radius = crown_radius_m_f32(mark.diameter_mm, speed, FILM_MM, time);
                    let height = crown_height_m(mark.diameter_mm.into(), speed.into(), FILM_MM.into(), time.into());
                    let seen = crown_seen_s(mark.diameter_mm.into(), age.into(), extent.exposure_s) / extent.exposure_s;
                    sum += f64::from(mark.weight) * seen * 2.0 * f64::from(radius) * height;
                });
            }
        }
    }
    sum
}

fn density() -> Study {
    let spectrum = Spectrum::new(Distribution::MarshallPalmer, 25.0).expect("valid");
    let field = |budget: f64| SplashField::new(7, &spectrum, &SplashShares::for_budget(&spectrum, &view(), budget));
    let moments = || (0..MOMENTS).map(|i| 5.0 + 0.37 * f64::from(i));
    let complete = field(f64::INFINITY);
    let truth = moments().map(|now| covered_m2(&complete, now)).sum::<f64>() / f64::from(MOMENTS);
    let variant = |name: &str, budget: f64| {
        let field = field(budget);
        // The truth is the mean over time: what a frame of all splashes is off it is what nature is.
        let squares = moments().map(|now| (covered_m2(&field, now) / truth - 1.0).powi(2));
        let error = (squares.sum::<f64>() / f64::from(MOMENTS)).sqrt();
        let mut now = 0.0;
        Variant::new(name, error, 1, move || {
            now += 0.37;
            covered_m2(&field, black_box(now))
        })
    };
    Study {
        name: "splash-density",
        title: "Area of crowns under 25 mm/h, by the splashes drawn",
        norm: "rms over frames, against the mean of all splashes",
        unit: "frame on the CPU",
        variants: vec![
            variant("250", 250.0),
            variant("500", 500.0),
            variant("1 000", 1e3),
            variant("2 000", 2e3),
            variant("4 000, of software adapters", 4e3).default(),
            variant("8 000", 8e3),
            variant("16 000", 16e3),
            variant("40 000, of GPUs", 40e3),
            variant("all", f64::INFINITY),
        ],
    }
}
