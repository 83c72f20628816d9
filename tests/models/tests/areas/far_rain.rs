//! Far rain: particles and haze together take out the rain's light at every distance from a shower; containers hold what is in
//! sight; ranks, numbers and sizes.

use core::f64::consts::PI;

use glam::{DVec2, DVec3, Quat, Vec3, Vec4};
use rain_core::haze::RateExtinction;
use rain_core::rainfall::areas::{
    AreaField, AreaRain, AreaSettings, AreaShape, FarView, PlacedArea, Seen, border_weight,
};
use rain_core::rainfall::{
    Distribution, FAR_HEIGHT, FarEye, FarRain, FarRainSettings, FarRainView, FieldMotion, RainViewVolume, far_begin,
    far_pitch_weight, far_presence, far_profile,
};

use super::{ellipse, field, places, star};

/// Half the view's angles. Units: rad.
const HALF: f64 = 0.6;
const CLOUD_M: f64 = 1000.0;
const THIN_M: f64 = 400.0;

fn volume(eye_m: DVec3, turn: f64) -> RainViewVolume {
    let rotation = Quat::from_rotation_y(-turn as f32);
    let tan = HALF.tan() as f32;
    let plane = |n: Vec3| -> Vec4 { (rotation * n.normalize()).extend(0.0) };
    RainViewVolume {
        eye_m,
        eye_velocity_m_s: DVec3::ZERO,
        side_planes: [
            plane(Vec3::new(1.0, 0.0, -tan)),
            plane(Vec3::new(-1.0, 0.0, -tan)),
            plane(Vec3::new(0.0, 1.0, -tan)),
            plane(Vec3::new(0.0, -1.0, -tan)),
        ],
        focal_px: 620.0,
        solid_angle_sr: 1.0,
        exposure_s: 1.0 / 60.0,
        turn_rad: 0.0,
        parallel: None,
    }
}

/// A view along −Z, turned by `turn` towards +X.
struct Shot<'a> {
    areas: &'a AreaField,
    weather_mm_h: f64,
    eye_m: DVec3,
    turn: f64,
    time_s: f64,
    seed: u64,
    settings: FarRainSettings,
    wind_m_s: DVec3,
}

impl<'a> Shot<'a> {
    fn of(areas: &'a AreaField, eye_m: DVec3) -> Self {
        Self {
            areas,
            weather_mm_h: 0.0,
            eye_m,
            turn: 0.0,
            time_s: 10.0,
            seed: 3,
            settings: FarRainSettings::default(),
            wind_m_s: DVec3::ZERO,
        }
    }

    fn eye<'b>(&'b self, rates: &'b RateExtinction) -> FarEye<'b> {
        FarEye {
            eye_m: self.eye_m,
            areas: self.areas,
            weather_mm_h: self.weather_mm_h,
            rates,
        }
    }

    fn fill(&self, rates: &RateExtinction, into: &mut FarRain) {
        let mut motion = FieldMotion::default();
        motion.set_velocity(self.wind_m_s, 1.2);
        into.fill(
            &self.settings,
            &FarRainView {
                eye: self.eye(rates),
                volume: &volume(self.eye_m, self.turn),
                forward: DVec3::new(self.turn.sin(), 0.0, -self.turn.cos()),
                half_view_rad: HALF,
                motion: &motion.after(self.time_s),
                seed: self.seed,
                cloud_m: CLOUD_M,
                thin_m: THIN_M,
                limit_m: 20_000.0,
            },
        );
    }

    fn taken(&self, rates: &RateExtinction) -> FarRain {
        let mut rain = FarRain::default();
        self.fill(rates, &mut rain);
        rain
    }
}

fn rates() -> RateExtinction {
    RateExtinction::new(Distribution::MarshallPalmer, 2.0)
}

fn shower(rate: f64, radius_m: f64, transition_m: f64) -> AreaSettings {
    AreaSettings {
        centre_m: DVec2::new(0.0, -radius_m),
        shape: AreaShape::Circle { radius_m },
        rain: AreaRain::Rate(rate),
        transition_m,
        ..AreaSettings::default()
    }
}

/// Light that gets through the particles along a line of sight.
fn through(rain: &FarRain, towards: DVec3) -> f64 {
    let sight = towards.as_vec3();
    rain.particles
        .iter()
        .map(|p| 1.0 - f64::from(p.opacity(sight, rain.axis, [CLOUD_M as f32, THIN_M as f32])))
        .product()
}

#[test]
fn far_particles_and_haze_take_out_the_rains_light_from_2_km_to_the_border() {
    let rates = rates();
    let mut shown = 0;
    for (rate, wind) in [(5.0, 0.0), (25.0, 6.0), (100.0, 0.0)] {
        let area = shower(rate, 600.0, 60.0);
        let areas = field(&[&area], 0.0);
        // From the border in: half and none of it is far rain.
        for distance in [2000.0, 500.0, 120.0, 50.0, 0.0, -40.0] {
            let (mut found, mut expected, mut carried, mut lines) = (0.0, 0.0, 0.0, 0.0);
            let mut rain = FarRain::default();
            for round in 0..24 {
                let shot = Shot {
                    time_s: 7.0 * f64::from(round),
                    seed: u64::from(round % 5_u32),
                    wind_m_s: DVec3::new(wind, 0.0, 0.0),
                    ..Shot::of(&areas, DVec3::new(0.0, 1.6, distance))
                };
                shot.fill(&rates, &mut rain);
                for i in 0..40 {
                    let azimuth = 0.1 * (f64::from(i % 8) - 3.5) / 4.0;
                    let pitch = [0.01, 0.05, 0.1, 0.2, 0.3][i as usize / 8];
                    let towards = DVec3::new(azimuth, pitch, -1.0).normalize();
                    let way = (CLOUD_M / towards.y).min(20_000.0);
                    let whole = areas.along(shot.eye_m, shot.eye_m + towards * way, 0.0, |r| rates.per_m(r));
                    let far = rain.share * rain.account.far_depth(&shot.eye(&rates), towards, way, CLOUD_M, THIN_M);
                    assert!(far <= whole + 1e-6, "{far} of {whole}");
                    found += 1.0 - (far - whole).exp() * through(&rain, towards);
                    expected += 1.0 - (-whole).exp();
                    carried += far;
                    lines += 1.0;
                }
            }
            let (found, expected) = (found / lines, expected / lines);
            assert!(expected > 0.02, "{rate} mm/h at {distance} m: {expected}");
            assert!(
                (found / expected - 1.0).abs() < 0.05,
                "{rate} mm/h at {distance} m: {found}, not {expected}"
            );
            if distance >= 50.0 {
                assert!(carried / lines > 0.1 * expected, "{rate} {distance}: {carried}");
                shown += 1;
            } else if distance < 0.0 {
                assert!(carried == 0.0 && rain.particles.is_empty());
            }
        }
    }
    assert_eq!(shown, 12);
}

#[test]
fn far_rain_passes_over_at_the_border_without_a_jump() {
    let rates = rates();
    let area = shower(40.0, 400.0, 0.0);
    let areas = field(&[&area], 0.0);
    let mut before: Option<f64> = None;
    let mut shares = Vec::new();
    for step in 0..=160 {
        // From 40 m outside to 40 m inside.
        let distance = 40.0 - 0.5 * f64::from(step);
        let rain = Shot::of(&areas, DVec3::new(0.0, 1.6, distance)).taken(&rates);
        if let Some(before) = before {
            assert!(
                (rain.share - before).abs() < 0.03,
                "{distance}: {before} {}",
                rain.share
            );
        }
        before = Some(rain.share);
        shares.push(rain.share);
        assert_eq!(rain.share == 0.0, rain.particles.is_empty(), "{distance}");
    }
    assert!(shares[0] > 0.3 && shares[160] == 0.0, "{shares:?}");
    // Half on the perimeter of what it is outside, but for the budget.
    let near = areas.near_share_at(DVec2::ZERO);
    assert!((near - 0.5).abs() < 1e-12, "{near}");
    assert_eq!(areas.near_share_at(DVec2::new(0.0, 20.0)), 0.0);
    assert_eq!(areas.near_share_at(DVec2::new(0.0, -20.0)), 1.0);
    assert!((areas.near_share_at(DVec2::new(0.0, 5.0)) - border_weight(5.0, 40.0)).abs() < 1e-12);
}

#[test]
fn no_particle_stands_outside_its_shower_or_in_a_dry_hole() {
    let rates = rates();
    let shower = AreaSettings {
        centre_m: DVec2::new(30.0, -500.0),
        shape: star(300.0),
        rain: AreaRain::Rate(60.0),
        transition_m: 0.0,
        ..AreaSettings::default()
    };
    let hole = AreaSettings {
        centre_m: DVec2::new(0.0, -400.0),
        shape: AreaShape::Circle { radius_m: 60.0 },
        rain: AreaRain::Scale(0.0),
        transition_m: 0.0,
        ..AreaSettings::default()
    };
    let areas = field(&[&shower, &hole], 0.0);
    let eye = DVec3::new(0.0, 1.6, 0.0);
    let rain = Shot::of(&areas, eye).taken(&rates);
    assert!(rain.particles.len() > 300, "{}", rain.particles.len());
    for p in &rain.particles {
        let at = DVec2::new(p.centre[0].into(), p.centre[2].into());
        // Places are rounded to single precision.
        let near = [DVec2::X, -DVec2::X, DVec2::Y, -DVec2::Y].map(|d| areas.rate_at(at + 1e-3 * d, 0.0));
        assert!(near.iter().any(|rate| *rate > 0.0), "{at}");
        assert!(f64::from(p.centre[1]) < CLOUD_M + 200.0);
    }
}

#[test]
fn there_is_no_far_rain_behind_inside_or_without_an_area() {
    let rates = rates();
    let area = shower(40.0, 300.0, 20.0);
    let areas = field(&[&area], 0.0);
    let outside = DVec3::new(0.0, 1.6, 400.0);
    let nothing = |shot: &Shot| {
        let rain = shot.taken(&rates);
        assert!(rain.particles.is_empty() && rain.containers.is_empty() && rain.share == 0.0);
    };
    assert!(!Shot::of(&areas, outside).taken(&rates).particles.is_empty());
    nothing(&Shot {
        turn: PI,
        ..Shot::of(&areas, outside)
    });
    nothing(&Shot::of(&areas, DVec3::new(0.0, 1.6, -300.0)));
    nothing(&Shot::of(&field(&[], 1.0), outside));
    nothing(&Shot {
        weather_mm_h: 30.0,
        ..Shot::of(&field(&[], 1.0), outside)
    });
    // No heavier than the rain around.
    nothing(&Shot {
        weather_mm_h: 40.0,
        ..Shot::of(&field(&[&area], 1.0), outside)
    });
    let unbounded = AreaSettings {
        shape: AreaShape::Unbounded,
        ..area
    };
    nothing(&Shot::of(&field(&[&unbounded], 0.0), outside));
    nothing(&Shot::of(&areas, DVec3::new(f64::NAN, 1.6, 0.0)));
    let dry = FarRainSettings {
        budget: 0,
        ..FarRainSettings::default()
    };
    nothing(&Shot {
        settings: dry,
        ..Shot::of(&areas, outside)
    });
}

#[test]
fn a_heavier_shower_adds_particles_and_moves_none() {
    let rates = rates();
    // Light enough that the budget leaves the share alone, and that one sees through both.
    let of = |rate: f64| {
        let area = shower(rate, 80.0, 30.0);
        Shot::of(&field(&[&area], 0.0), DVec3::new(0.0, 1.6, 300.0)).taken(&rates)
    };
    let (light, heavy) = (of(10.0), of(25.0));
    assert_eq!((light.share, heavy.share), (0.6, 0.6));
    assert!(heavy.particles.len() as f64 > 1.3 * light.particles.len() as f64);
    let mut kept = 0;
    for p in &light.particles {
        let same = heavy.particles.iter().find(|q| q.centre == p.centre);
        let Some(same) = same else { continue };
        assert!(same.rank == p.rank && same.phase == p.phase && same.presence >= p.presence - 1e-6);
        kept += 1;
    }
    // All but those that the heavier rain before them hides.
    assert!(
        kept as f64 > 0.99 * light.particles.len() as f64,
        "{kept} of {}",
        light.particles.len()
    );
}

#[test]
fn particles_are_larger_and_fewer_further_away_and_of_one_size_in_the_picture() {
    let rates = rates();
    let mut before = (f64::INFINITY, 0.0);
    for distance in [150.0, 600.0, 2400.0, 9600.0] {
        let area = shower(20.0, 400.0, 60.0);
        let areas = field(&[&area], 0.0);
        let shot = Shot {
            settings: FarRainSettings {
                budget: 100_000,
                ..FarRainSettings::default()
            },
            ..Shot::of(&areas, DVec3::new(0.0, 1.6, distance))
        };
        let rain = shot.taken(&rates);
        // Of a cubic metre of the same rain, and how large.
        let width =
            rain.particles.iter().map(|p| f64::from(p.half_width)).sum::<f64>() * 2.0 / rain.particles.len() as f64;
        let per_m2 = rain.particles.len() as f64 / (800.0 * 400.0);
        assert!(
            per_m2 < before.0 && width > 1.5 * before.1,
            "{distance}: {per_m2} {width} {before:?}"
        );
        before = (per_m2, width);
        for p in &rain.particles {
            let way = f64::from(Vec3::from(p.centre).with_y(0.0).length());
            let pixels = 620.0 * 2.0 * f64::from(p.half_width) / way;
            assert!((3.8..11.4).contains(&pixels), "{way} m: {pixels} px");
        }
    }
}

#[test]
fn the_budget_bounds_particles_and_haze_carries_the_rest() {
    let rates = rates();
    let area = shower(80.0, 1500.0, 100.0);
    let areas = field(&[&area], 0.0);
    let mut last = 0.0;
    for budget in [100, 1000, 4000, 40_000] {
        let shot = Shot {
            settings: FarRainSettings { budget, share: 0.6 },
            ..Shot::of(&areas, DVec3::new(0.0, 1.6, 700.0))
        };
        let rain = shot.taken(&rates);
        let wanted = rain.wanted.min(f64::from(budget));
        // Soft ranks: more particles than their sum of presences.
        let present: f64 = rain.particles.iter().map(|p| f64::from(p.presence)).sum();
        assert!(
            (present / wanted - 1.0).abs() < 0.1 + 3.0 / wanted.sqrt(),
            "{budget}: {present} {wanted}"
        );
        assert!(rain.particles.len() <= 2 * budget as usize && rain.beyond_limit == 0);
        assert!(rain.share > last && rain.share <= 0.6);
        last = rain.share;
    }
    assert_eq!(last, 0.6);
    for (settings, good) in [
        (FarRainSettings::default(), true),
        (FarRainSettings { budget: 1, share: 0.96 }, false),
        (
            FarRainSettings {
                budget: 1,
                share: f64::NAN,
            },
            false,
        ),
        (
            FarRainSettings {
                budget: 100_001,
                share: 0.5,
            },
            false,
        ),
    ] {
        assert_eq!(settings.validated().is_ok(), good, "{settings:?}");
    }
}

#[test]
fn particles_sink_with_the_rain_and_come_back_when_time_does() {
    let rates = rates();
    let area = shower(30.0, 300.0, 40.0);
    let areas = field(&[&area], 0.0);
    let at = |time_s: f64| {
        let shot = Shot {
            time_s,
            wind_m_s: DVec3::new(3.0, 0.0, 0.0),
            ..Shot::of(&areas, DVec3::new(0.0, 1.6, 200.0))
        };
        shot.taken(&rates)
    };
    let (a, b) = (at(20.0), at(20.5));
    let mut moved = 0;
    for p in &a.particles {
        let expected = Vec3::from(p.centre) + Vec3::new(1.5, -0.5 * 7.14, 0.0);
        moved += usize::from(
            b.particles
                .iter()
                .any(|q| q.rank == p.rank && q.phase == p.phase && Vec3::from(q.centre).distance(expected) < 0.02),
        );
    }
    assert!(
        moved as f64 > 0.9 * a.particles.len() as f64,
        "{moved} of {}",
        a.particles.len()
    );
    let again = at(20.0);
    assert_eq!(again.particles, a.particles);
    assert!((a.axis.x / -a.axis.y - 3.0 / 7.14).abs() < 1e-3, "{}", a.axis);
}

#[test]
fn presences_and_profiles_keep_their_means() {
    let n = 20_000;
    for density in [0.001, 0.05, 0.124, 0.126, 0.5, 0.874, 0.9, 0.999, 1.0] {
        let ranks = (0..n).map(|i| (f64::from(i) + 0.5) / f64::from(n));
        let mean = ranks.map(|rank| far_presence(density, rank)).sum::<f64>() / f64::from(n);
        assert!((mean - density).abs() < 1e-6, "{density}: {mean}");
    }
    assert_eq!(
        [
            far_presence(0.0, 0.0),
            far_presence(f64::NAN, 0.5),
            far_presence(2.0, 0.999)
        ],
        [0.0, 0.0, 1.0]
    );
    let mut mean = 0.0;
    for phase in 0..24 {
        for i in 0..60 {
            for k in 0..60 {
                let at = |i: i32| (i as f32 + 0.5) / 30.0 - 1.0;
                let own = far_profile(at(i), at(k), phase as f32 / 24.0);
                assert!((0.0..2.0).contains(&own));
                mean += f64::from(own) / (24.0 * 3600.0);
            }
        }
    }
    assert!((mean - 0.25).abs() < 1e-3, "{mean}");
    assert_eq!([far_profile(1.0, 0.0, 0.1), far_profile(f32::NAN, 0.0, 0.1)], [0.0; 2]);
    assert!((far_begin(72.0) - 0.5).abs() < 1e-12 && far_begin(36.0) == 0.0 && far_begin(200.0) == 1.0);
    assert!(far_pitch_weight(0.1) == 1.0 && far_pitch_weight(-0.1) == 0.0 && far_pitch_weight(0.8) == 0.0);
    assert_eq!(FAR_HEIGHT, 14.0);
}

/// Areas of every outline, about the origin.
fn outlines() -> Vec<PlacedArea> {
    [
        (ellipse(60.0, 25.0, 0.4), 10.0),
        (AreaShape::Circle { radius_m: 40.0 }, 0.0),
        (star(70.0), 20.0),
        (ellipse(120.0, 6.0, 2.5), 4.0),
    ]
    .into_iter()
    .map(|(shape, transition_m)| {
        let settings = AreaSettings {
            shape,
            transition_m,
            rain: AreaRain::Rate(10.0),
            ..AreaSettings::default()
        };
        let areas = field(&[&settings], 0.0);
        areas.areas()[0].clone()
    })
    .collect()
}

#[test]
fn far_containers_of_all_outlines_hold_the_rain_in_sight_with_its_soft_edge() {
    let (mut wholes, mut parts, mut none) = (0, 0, 0);
    for area in outlines() {
        for (i, eye) in places(120).enumerate() {
            let view = FarView {
                eye_m: eye,
                ahead: DVec2::from_angle(0.1 * i as f64),
                half_view_rad: [0.9, 0.5, 0.1][i % 3],
            };
            let sight: Vec<DVec2> = places(6000)
                .filter(|p| area.weight_at(*p) > 0.0 && view.ahead.angle_to(*p - eye).abs() <= view.half_view_rad)
                .collect();
            let Some(fit) = area.far_container(&view) else {
                assert!(sight.is_empty(), "{eye} sees {} points", sight.len());
                none += 1;
                continue;
            };
            match fit.seen {
                Seen::Whole => wholes += 1,
                Seen::Part => parts += 1,
            }
            for p in &sight {
                assert!(fit.holds(*p, 1e-6), "{eye} {p}: {fit:?}");
            }
            let outside = area.distance_m(eye) > 0.0;
            if outside {
                assert!((fit.distance_m - area.distance_m(eye)).abs() < 1e-9);
                assert!(area.distance_m(fit.anchor_m).abs() < 1e-9, "on the outline");
            } else {
                assert!(fit.anchor_m == eye && fit.distance_m == 0.0);
            }
        }
    }
    assert!(wholes > 10 && parts > 100 && none > 100, "{wholes} {parts} {none}");
}

#[test]
fn the_far_container_shrinks_on_approach_and_its_anchor_never_jumps() {
    let area = shower(20.0, 300.0, 0.0);
    let areas = field(&[&area], 0.0);
    let area = &areas.areas()[0];
    let fit = |eye: DVec2| {
        area.far_container(&FarView {
            eye_m: eye,
            ahead: DVec2::NEG_Y,
            half_view_rad: 0.5,
        })
        .expect("in view")
    };
    // Straight towards it: whole from afar, then cut by the picture's sides and ever smaller.
    let mut before = f64::INFINITY;
    for step in 0..60 {
        let own = fit(DVec2::new(0.0, 900.0 - 15.0 * f64::from(step)));
        let width = own.width_m();
        assert!(
            width <= before + 1e-9 && (own.seen == Seen::Part || width > 599.0),
            "{own:?}"
        );
        before = width;
    }
    assert!(
        before < 540.0 && fit(DVec2::new(0.0, 900.0)).seen == Seen::Whole,
        "{before}"
    );
    // Past its side: N12.
    let mut last: Option<DVec2> = None;
    for step in 0..200 {
        let eye = DVec2::new(-400.0 + 4.0 * f64::from(step), 40.0);
        let own = area.far_container(&FarView {
            eye_m: eye,
            ahead: DVec2::NEG_Y,
            half_view_rad: 1.2,
        });
        let anchor = own.expect("in view").anchor_m;
        assert!(last.is_none_or(|last| last.distance(anchor) < 4.01), "{eye}: {anchor}");
        last = Some(anchor);
    }
}
