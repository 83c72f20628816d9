//! Drops in the air, haze, light in drops, impacts.

use std::hint::black_box;

use glam::{DVec3, IVec3, Vec3};
use rain_core::haze::{
    EXTINCTION_EFFICIENCY, FogFade, FogTable, HazeSharing, HeightHaze, ToyShopGlow, contrast_at, desaturated,
    extinction_per_m, inscattered, transmittance, visibility_m,
};
use rain_core::optics::{
    DropBody, DropRay, drop_light, drop_rays_f32, fresnel, hemispherical_mean, impact_of_deviation, rainbow,
};
use rain_core::rainfall::{
    BeardAir, CLASS_COUNT, ClassWeights, Container, Distribution, DropOutline, Fall, FallLaw, FieldMotion, LatticeEye,
    SizeClass, Spectrum, Threshold, WindResponse, cell_key, column_drop, expected_drops, fall_f32, for_each_drop,
    quality_for_budget, streak_opacity, terminal_velocity,
};
use rain_core::splash::{
    Impact, ImpactFlux, Splash, crown_height_m, crown_radius_m, for_each_impact, hashed_poisson, secondary_drop,
    splashes_per_m2_s,
};

use super::{allocations, view};

fn spectrum(rate: f64) -> Spectrum {
    Spectrum::new(Distribution::MarshallPalmer, rate).expect("inside the domain")
}

#[test]
fn the_field_of_drops_is_visited_without_allocating() {
    let classes = SizeClass::all();
    let mut motion = FieldMotion::default();
    let (mut seen, mut present) = (0, 0.0);
    let count = allocations(|| {
        for step in 0..20 {
            let spectrum = spectrum(5.0 + f64::from(step));
            motion.set_velocity(DVec3::new(f64::from(step), 0.0, 1.0), 1.2);
            motion.advance(1.0 / 60.0);
            let ahead = motion.after(0.1);
            for (k, class) in classes.iter().enumerate() {
                let threshold = Threshold::new(class, &spectrum);
                let eye = LatticeEye::new(DVec3::new(3.0, 1.7, 2.0), ahead.offset_m[k], class.cell_m);
                let key = cell_key(9, k as u32, eye.cell + IVec3::X);
                for_each_drop(class, key, threshold.scan_limit(), |_, drop| {
                    seen += 1;
                    present += threshold.presence(&drop);
                });
            }
        }
    });
    assert_eq!(count, 0);
    assert!(seen > 20 && present > 10.0, "{seen} {present}");
}

#[test]
fn a_view_is_budgeted_and_its_drops_placed_without_allocating() {
    let (spectrum, motion, view) = (spectrum(25.0), FieldMotion::default(), view());
    let mut container = Container::default();
    assert!(container.fill(7, &spectrum, &motion, &view, 0.7, 100_000));
    let count = allocations(|| {
        black_box((
            expected_drops(&spectrum, &view, 0.7),
            quality_for_budget(&spectrum, &view, 5e3),
        ));
        for record in &container.records {
            black_box(record.position(7, &container.classes));
        }
    });
    assert_eq!(count, 0);
    assert!(container.records.len() > 500);
}

#[test]
fn single_drops_fall_without_allocating() {
    let air = BeardAir::new(9e4, 5.0).expect("inside the domain");
    let fall = Fall::of_drop(2.5).expect("inside the domain");
    let mut wind = WindResponse::following(DVec3::ZERO);
    let count = allocations(|| {
        for i in 1..200 {
            let x = 0.03 * f64::from(i);
            wind.advance_constant(6.5, DVec3::new(x, 0.0, 1.0), 1.0 / 60.0);
            black_box((
                fall.at(x, 0.0),
                fall.time_to_fall_s(x, 1.0),
                fall_f32(6.0, 0.8, x as f32, 0.0),
            ));
            black_box((
                terminal_velocity(x),
                air.terminal_velocity(x),
                FallLaw::default().speed_m_s(x, &air),
            ));
            black_box((column_drop(x, 6.0, x, 5.0), streak_opacity(0.0, x, 0.002, 0.1)));
        }
    });
    assert_eq!(count, 0);
}

#[test]
fn haze_allocates_nothing() {
    let profile = HeightHaze::new(1e-3, 0.0, 50.0).expect("inside the domain");
    let glow = ToyShopGlow::new(10.0, 0.9, 1.0).expect("inside the domain");
    let mut fade = FogFade::default();
    let count = allocations(|| {
        for i in 0..100 {
            let x = f64::from(i);
            let spectrum = spectrum(0.5 * x);
            let sigma = extinction_per_m(&spectrum, EXTINCTION_EFFICIENCY);
            let sharing = HazeSharing::new(&spectrum, EXTINCTION_EFFICIENCY, [12.0; CLASS_COUNT], true)
                .expect("inside the domain");
            black_box((
                sharing.fog_depth(x),
                sharing.drawn_depth(x),
                sharing.fog_transmittance(x),
            ));
            let table = FogTable::new(&spectrum, EXTINCTION_EFFICIENCY, true, |d| 3.0 * d).expect("inside the domain");
            black_box((
                table.depth_f32(x as f32),
                profile.depth(0.0, x, 2.0 * x),
                visibility_m(sigma, 0.02),
            ));
            fade.advance(i % 3 != 0, 0.1, 30.0);
            let (colour, _) = glow.apply([0.2; 3], [0.5; 3], 0.1, glow.factor(fade.share(), x));
            black_box((
                inscattered(colour, [0.4; 3], sigma * x),
                contrast_at(sigma, x),
                transmittance(sigma * x),
            ));
            black_box(desaturated(colour, 0.5, [0.2, 0.7, 0.1]));
        }
    });
    assert_eq!(count, 0);
}

#[test]
fn light_in_drops_allocates_nothing() {
    let outline = DropOutline::new(3.0);
    let (view, normal) = (Vec3::Z, Vec3::new(0.3, 0.2, 0.93).normalize());
    let count = allocations(|| {
        for i in 0..50 {
            let x = 0.02 * f64::from(i);
            black_box((fresnel(x, 1.333), drop_light(x, 1.333), impact_of_deviation(x, 1.333)));
            let (body, centre) = DropBody::of_outline(&outline);
            let rays: Option<[DropRay; 3]> = body.rays(view, normal, 1.333);
            black_box((rays, centre, drop_rays_f32(view, normal, 1.333)));
        }
        black_box((rainbow(1, 1.333), hemispherical_mean(1.333)));
    });
    assert_eq!(count, 0);
}

#[test]
fn impacts_and_splashes_allocate_nothing() {
    let mut drops = 0;
    let count = allocations(|| {
        for i in 0..100_u32 {
            let spectrum = spectrum(f64::from(i));
            let weights = ClassWeights::new(&spectrum);
            let flux = ImpactFlux::new(&spectrum, 0.5, 6.0, DVec3::Y, DVec3::new(3.0, 0.0, 0.0));
            black_box((weights, splashes_per_m2_s(&spectrum, 0.2)));
            for_each_impact(5, [1, 2], i, 0.01 * flux.number_per_m2_s, |event| {
                let impact = Impact {
                    diameter_mm: 3.5,
                    velocity_m_s: Vec3::new(1.0, -8.0, 0.0),
                    normal: Vec3::Y,
                    film_mm: 0.3,
                };
                let splash = Splash::new(&impact, event.key);
                for index in 0..splash.count {
                    black_box(secondary_drop(&impact, &splash, event.key, index));
                    drops += 1;
                }
            });
            black_box((hashed_poisson(30.0, [i, 2, 3]), crown_radius_m(3.0, 8.0, 0.3, 0.01)));
            black_box(crown_height_m(3.0, 8.0, 0.3, 0.01));
        }
    });
    assert_eq!(count, 0);
    assert!(drops > 100, "{drops}");
}
