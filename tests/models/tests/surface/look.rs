//! States, wet albedo, roughness, colour of water, the sources' looks.

use proptest::prelude::*;
use rain_core::surface::artist_look::{
    ArtistLook, accumulated_water, crack_water, effective_wetness, lagarde_porosity, lagarde_porous_wet, lagarde_wet,
    nguyenova_puddle, nguyenova_puddle_amount, nguyenova_puddle_depth_mm, painted_puddle_water, screen_blend,
};
use rain_core::surface::{
    SurfaceState, SurfaceWeights, WATER_F0, Water, WetBody, closed_film_share, closed_film_share_f32, film_roughness,
    film_roughness_f32, mud_phase, saturated_albedo, saturated_albedo_f32, under_water, wet_albedo, wet_albedo_f32,
    wet_albedo_rgb, widened_roughness,
};
use rain_reference::surface as truth;

use super::{ANY, config, log_spaced};
use crate::check::Worst;

const INDICES: [f64; 2] = [1.333, 1.55];

#[test]
fn wet_albedo_has_its_check_values() {
    for (dry, wet, ratio) in [
        (0.05, 0.02461, 0.4922),
        (0.10, 0.05056, 0.5056),
        (0.15, 0.07795, 0.5197),
        (0.20, 0.10691, 0.5345),
        (0.30, 0.17009, 0.5670),
        (0.40, 0.24139, 0.6035),
        (0.50, 0.32247, 0.6449),
        (0.60, 0.41546, 0.6924),
        (0.80, 0.64929, 0.8116),
        (0.95, 0.88491, 0.9315),
    ] {
        let found = wet_albedo(dry);
        assert!((found - wet).abs() < 5.1e-6, "{dry}: {found}");
        assert!((found / dry - ratio).abs() < 5.1e-5, "{dry}: {found}");
    }
    for (dry, ratio) in [(0.10, 0.5403), (0.20, 0.5687), (0.30, 0.6002), (0.50, 0.6748)] {
        assert!((WetBody::ANGSTROM.albedo(dry) / dry - ratio).abs() < 5.1e-5, "{dry}");
    }
    let sky = 1.0 - WetBody::UNDER_SKY.entry_reflectance;
    assert!((sky - 0.933_59).abs() < 5.1e-6, "{sky}");
    assert!((sky / (1.0 - WATER_F0) - 1.0 + 0.047).abs() < 5e-4, "4.7 % less");
    assert!((WATER_F0 - 0.020_373).abs() < 5e-7);
    assert!((WetBody::LEKNER_DORF.internal_reflectance - 0.474_591).abs() < 5e-7);
    assert!((truth::mean_reflectance(1.333) - 0.066_405_8).abs() < 5.1e-8);
    assert!((truth::mean_reflectance(1.55) - 0.099_065_8).abs() < 5.1e-8);
    assert!((truth::mean_reflectance(1.55 / 1.333) - 0.037_528_1).abs() < 5.1e-8);
}

#[test]
fn wet_albedo_is_the_printed_formula() {
    let (mut exact, mut single, mut wrong) = (Worst::default(), Worst::default(), Worst::default());
    // The reference integrates R̄ anew each time: one call for the gain, the formula typed from the paper for the rest.
    let gain = (1.0 - truth::mean_reflectance(1.55 / 1.333)) / (1.0 - truth::mean_reflectance(1.55));
    let p = 1.0 - (1.0 - truth::mean_reflectance(1.333)) / (1.333 * 1.333);
    let printed = |dry: f64, gain: f64| {
        let a_d = 1.0 - dry;
        let a = a_d * ((1.0 - a_d) * gain + a_d);
        (1.0 - WATER_F0) * (1.0 - a / (1.0 - p * (1.0 - a)))
    };
    assert!((printed(0.3, gain) - truth::lekner_dorf(0.3, INDICES, WATER_F0)).abs() < 1e-15);
    for i in 0..=4000 {
        let dry = f64::from(i) / 4000.0;
        exact.absolute(wet_albedo(dry), printed(dry, gain), || format!("{dry}"));
        single.absolute(
            f64::from(wet_albedo_f32(dry as f32)),
            wet_albedo(f64::from(dry as f32)),
            || format!("{dry}"),
        );
        wrong.absolute(wet_albedo(dry), printed(dry, 1.05 * gain), String::new);
    }
    exact.assert_below(5e-9, 4000);
    single.assert_below(3e-7, 4000);
    assert!(wrong.error > 1e-3, "a gain 5 % off goes unseen");
    // Grains of n = 1.5 to 1.6 move the ratio by less than 0.001.
    for n in [1.5, 1.6] {
        for dry in [0.1, 0.3, 0.6] {
            let other = truth::lekner_dorf(dry, [1.333, n], WATER_F0);
            assert!(((other - wet_albedo(dry)) / dry).abs() < 1e-3, "{n} {dry}");
        }
    }
}

#[test]
fn wet_albedo_is_two_layers_with_every_bounce() {
    let (mut worst, mut wrong) = (Worst::default(), Worst::default());
    for dry in [0.0, 0.02, 0.1, 0.3, 0.6, 0.9, 1.0] {
        // What the body throws back at each meeting, in Ångström's way: its albedo.
        let straight = WetBody::ANGSTROM;
        worst.absolute(straight.albedo(dry), truth::two_layers(dry, 1.333, 1.0, 0.0), || {
            format!("{dry}")
        });
        for cos in [0.05, 0.3, 0.7, 1.0] {
            let reference = truth::two_layers(dry, 1.333, cos, 0.0);
            worst.absolute(straight.albedo_at(dry, cos), reference, || format!("{dry} {cos}"));
            wrong.absolute(straight.albedo_at(1.05 * dry, cos), reference, String::new);
        }
    }
    worst.assert_below(1e-8, 30);
    assert!(wrong.error > 1e-3, "an albedo 5 % off goes unseen");
}

#[test]
fn no_wet_surface_gives_more_light_than_it_gets() {
    for i in 0..=100 {
        for j in 0..=100 {
            let (dry, cos) = (f64::from(i) / 100.0, f64::from(j) / 100.0);
            for body in [WetBody::LEKNER_DORF, WetBody::ANGSTROM] {
                let total = truth::fresnel(cos, 1.333) + body.albedo_at(dry, cos);
                assert!(total <= 1.0 + 1e-12, "{dry} {cos}: {total}");
            }
            for water in [
                Water::CLEAR,
                Water::MUDDY,
                Water {
                    mud_albedo: [1.0; 3],
                    absorption_per_m: [0.0; 3],
                    ..Water::MUDDY
                },
            ] {
                for depth in [0.0, 0.01, 0.2] {
                    let below = under_water([dry; 3], &water, depth, cos);
                    let total = truth::fresnel(cos, 1.333) + below.into_iter().fold(0.0, f64::max);
                    assert!(total <= 1.0 + 1e-12, "{water:?} {depth} {dry} {cos}: {total}");
                }
            }
        }
    }
    // A white body is a white furnace.
    for cos in [0.1, 0.5, 1.0] {
        let total = truth::fresnel(cos, 1.333) + WetBody::LEKNER_DORF.albedo_at(1.0, cos);
        assert!((total - 1.0).abs() < 1e-12, "{total}");
    }
}

#[test]
fn constant_factors_of_the_sources_are_far_from_it() {
    let look = |albedo| ArtistLook {
        albedo,
        gloss: 0.3,
        f0: 0.04,
    };
    assert!((lagarde_wet(look(0.1), 1.0).albedo - wet_albedo(0.1)).abs() > 0.02);
    assert!((lagarde_wet(look(0.95), 1.0).albedo - wet_albedo(0.95)).abs() > 0.59);
    let mut worst = Worst::default();
    for i in 0..=1000 {
        let dry = f64::from(i) / 1000.0;
        worst.absolute(lagarde_wet(look(dry), 1.0).albedo, wet_albedo(dry), || format!("{dry}"));
    }
    worst.assert_below(0.68, 1000);
    assert!(worst.error > 0.679, "{worst:?}");
}

#[test]
fn albedos_are_the_formula_in_every_light_and_at_every_saturation() {
    let (mut exact, mut damp, mut single, mut wrong) =
        (Worst::default(), Worst::default(), Worst::default(), Worst::default());
    let shares = (0..=100).map(|i| f64::from(i) / 100.0);
    for body in [WetBody::LEKNER_DORF, WetBody::ANGSTROM, WetBody::UNDER_SKY] {
        let light = [body.index_gain, body.internal_reflectance];
        for dry in shares.clone() {
            let place = || format!("{body:?} {dry}");
            exact.absolute(
                body.albedo(dry),
                truth::soaked(dry, light, body.entry_reflectance),
                place,
            );
            single.absolute(
                f64::from(body.albedo_f32(dry as f32)),
                body.albedo(f64::from(dry as f32)),
                place,
            );
            for cos in shares.clone() {
                let reference = truth::soaked(dry, light, truth::fresnel(cos, 1.333));
                exact.absolute(body.albedo_at(dry, cos), reference, || format!("{body:?} {dry} {cos}"));
                wrong.absolute(body.albedo_at(1.05 * dry, cos), reference, String::new);
            }
        }
    }
    let light = [
        WetBody::LEKNER_DORF.index_gain,
        WetBody::LEKNER_DORF.internal_reflectance,
    ];
    for dry in shares.clone() {
        let soaked = truth::soaked(dry, light, WATER_F0);
        let [_, green, _] = wet_albedo_rgb([0.3, dry as f32, 0.9]);
        single.absolute(f64::from(green), wet_albedo(f64::from(dry as f32)), || {
            format!("rgb {dry}")
        });
        assert_eq!(
            wet_albedo_rgb([0.3, dry as f32, 0.9]),
            [0.3, dry as f32, 0.9].map(wet_albedo_f32)
        );
        for w in shares.clone() {
            let place = || format!("{dry} {w}");
            damp.absolute(saturated_albedo(dry, w), (1.0 - w) * dry + w * soaked, place);
            let (dry32, w32) = (dry as f32, w as f32);
            single.absolute(
                f64::from(saturated_albedo_f32(dry32, w32)),
                saturated_albedo(f64::from(dry32), f64::from(w32)),
                place,
            );
        }
    }
    exact.assert_below(2e-15, 30_000);
    damp.assert_below(2e-15, 10_000);
    single.assert_below(3e-7, 10_000);
    assert!(wrong.error > 0.01, "an albedo 5 % off goes unseen");
}

#[test]
fn mud_shines_as_light_scattered_once_under_an_even_sky() {
    // Cosines in the air, evenly; those of the rays under water.
    let refracted = |c: f64| (1.0 - (1.0 - c * c) / (1.333 * 1.333)).sqrt();
    let cosines: Vec<f64> = (0..50).map(|i| (f64::from(i) + 0.5) / 50.0).collect();
    let mean = |of: &dyn Fn(f64) -> f64| cosines.iter().map(|c| 2.0 * c * of(refracted(*c))).sum::<f64>() / 50.0;
    let thick = mean(&|mu| truth::scattered_once(mu, 0.924, 1.333, 1e3));
    assert!((mean(&mud_phase) - 1.0).abs() < 3e-4, "{}", mean(&mud_phase));
    let (mut worst, mut wrong) = (Worst::default(), Worst::default());
    for c in [0.0, 0.2, 0.5, 0.8, 1.0] {
        let mu = refracted(c);
        for optical in [0.01, 0.1, 0.3, 1.0, 3.0, 1e3] {
            let reference = truth::scattered_once(mu, 0.924, 1.333, optical) / thick;
            let found = |optical: f64| mud_phase(mu) * (1.0 - (-optical * (1.0 / mu + 1.19)).exp());
            worst.absolute(found(optical), reference, || format!("{c} {optical}"));
            wrong.absolute(found(1.2 * optical), reference, String::new);
            // The whole of it, over black ground.
            let water = Water {
                absorption_per_m: [0.0; 3],
                turbidity_per_m: 50.0,
                mud_albedo: [0.2; 3],
            };
            let whole = under_water([0.0; 3], &water, optical / 50.0, c)[1];
            let entry = 1.0 - truth::fresnel(c, 1.333);
            assert!(
                (whole - 0.2 * entry * found(optical)).abs() < 1e-6,
                "{c} {optical}: {whole}"
            );
        }
    }
    worst.assert_below(0.045, 30);
    assert!(wrong.error > 0.06, "a depth 20 % off goes unseen");
    // Brighter at a grazing angle than from above; bad input stays in bounds.
    assert!(mud_phase(0.6613) > 1.25 && mud_phase(1.0) < 0.82);
    for bad in ANY {
        assert!(mud_phase(bad).is_finite() && mud_phase(bad) > 0.0, "{bad}");
    }
}

#[test]
fn water_absorbs_nearly_as_the_integral_over_all_directions() {
    let (mut worst, mut wrong) = (Worst::default(), Worst::default());
    for optical in [0.0, 0.01, 0.05, 0.2, 0.5, 1.0, 3.0] {
        for dry in [0.05, 0.3, 0.7, 1.0] {
            for cos in [0.2, 0.6, 1.0] {
                let water = Water {
                    absorption_per_m: [10.0, 10.0, 0.0],
                    ..Water::CLEAR
                };
                // The body in water, 1 − a, so that the reference sees the same one.
                let body =
                    dry * (2.0 - WetBody::LEKNER_DORF.index_gain + (WetBody::LEKNER_DORF.index_gain - 1.0) * dry);
                let reference = truth::two_layers(body, 1.333, cos, optical);
                let found = under_water([dry; 3], &water, optical / 10.0, cos);
                worst.absolute(found[0], reference, || format!("{optical} {dry} {cos}"));
                wrong.absolute(
                    under_water([dry; 3], &water, optical / 5.0, cos)[0],
                    reference,
                    String::new,
                );
                assert!(
                    (found[2] - WetBody::LEKNER_DORF.albedo_at(dry, cos)).abs() < 1e-15,
                    "clear channel"
                );
            }
        }
    }
    worst.assert_below(0.013, 80);
    assert!(wrong.error > 0.1, "twice the depth goes unseen");
    // Clear water of a puddle takes next to nothing; a metre of it is blue.
    let [r, _, b] = under_water([0.3; 3], &Water::CLEAR, 0.005, 1.0);
    assert!((r / b - 1.0).abs() < 0.01);
    let [r, g, b] = under_water([0.3; 3], &Water::CLEAR, 2.0, 1.0);
    assert!(r < 0.5 * b && r < g && g < b);
    // Thick mud has its own colour, whatever lies below.
    let (dark, light) = (
        under_water([0.02; 3], &Water::MUDDY, 1.0, 1.0),
        under_water([0.9; 3], &Water::MUDDY, 1.0, 1.0),
    );
    assert!((dark[0] - light[0]).abs() < 1e-9 && dark[0] > dark[1] && dark[1] > dark[2]);
    let way = Water::CLEAR.transmittance(2.0);
    assert!((way[0] - (-0.68_f64).exp()).abs() < 1e-15 && way[2] > way[1] && way[1] > way[0]);
    let mut worst = Worst::default();
    for absorption in [0.0, 0.34, 12.0, 1e4] {
        for turbidity_per_m in [0.0, 40.0, 1e4] {
            let water = Water {
                absorption_per_m: [absorption, 0.5 * absorption, 0.0],
                turbidity_per_m,
                ..Water::CLEAR
            };
            for way in log_spaced(1e-9, 1e9, 200) {
                for (found, absorption) in water.transmittance(way).into_iter().zip(water.absorption_per_m) {
                    let exact = (-absorption * way - turbidity_per_m * way).exp();
                    worst.absolute(found, exact, || format!("{absorption} {turbidity_per_m} {way}"));
                }
            }
        }
    }
    worst.assert_below(1e-15, 7000);
}

#[test]
fn looks_take_anything() {
    let unit = |x: f64| (0.0..=1.0).contains(&x);
    for a in ANY {
        let single = a as f32;
        assert!(unit(wet_albedo(a)) && unit(f64::from(wet_albedo_f32(single))), "{a}");
        assert!(wet_albedo_rgb([single; 3]).into_iter().all(|x| unit(f64::from(x))));
        for b in ANY {
            for x in [
                WetBody::LEKNER_DORF.albedo_at(a, b),
                saturated_albedo(a, b),
                f64::from(saturated_albedo_f32(single, b as f32)),
                widened_roughness(a, b),
                film_roughness(a, b, 0.3, 0.8),
                film_roughness(0.3, 0.04, a, b),
                f64::from(film_roughness_f32(0.3, 0.04, single, b as f32)),
                under_water([a; 3], &Water::MUDDY, b, 0.5)[1],
                under_water([0.5; 3], &Water::MUDDY, a, b)[1],
                crack_water(a, b),
                painted_puddle_water(a, b, 0.4),
                painted_puddle_water(0.5, a, b),
                accumulated_water(a, b),
                effective_wetness(a, b, 0.2),
                screen_blend(a, b),
                nguyenova_puddle_amount(a, b),
                nguyenova_puddle_depth_mm(a) / 10.0,
                lagarde_porosity(a, b),
            ] {
                assert!(unit(x), "{a} {b}: {x}");
            }
            let look = ArtistLook {
                albedo: a,
                gloss: b,
                f0: a,
            };
            for look in [
                lagarde_wet(look, b),
                lagarde_porous_wet(look, a, b),
                nguyenova_puddle(look, b),
                look.flooded(a),
            ] {
                assert!(
                    unit(look.albedo) && unit(look.gloss) && unit(look.f0),
                    "{a} {b}: {look:?}"
                );
            }
            let w = SurfaceWeights::new(a, b, 0.8).expect("valid texture");
            assert!(
                (w.dry + w.wet + w.drenched + w.puddle - 1.0).abs() < 1e-15,
                "{a} {b}: {w:?}"
            );
        }
    }
    for bad in [f64::NAN, f64::INFINITY, -1.0, 1001.0] {
        assert!(
            SurfaceWeights::new(0.5, 0.1, bad)
                .expect_err("refused")
                .to_string()
                .starts_with("texture_depth_mm")
        );
    }
    for bad in [f64::NAN, -1.0, 1e5] {
        assert!(
            Water {
                turbidity_per_m: bad,
                ..Water::CLEAR
            }
            .validated()
            .is_err()
        );
        assert!(
            Water {
                absorption_per_m: [0.1, bad, 0.1],
                ..Water::CLEAR
            }
            .validated()
            .is_err()
        );
        assert!(
            Water {
                mud_albedo: [0.1, bad, 0.1],
                ..Water::CLEAR
            }
            .validated()
            .is_err()
        );
    }
    assert!(Water::MUDDY.validated().is_ok());
}

#[test]
fn the_four_states_follow_pores_and_film() {
    for (w, h, state) in [
        (0.0, 0.0, SurfaceState::Dry),
        (0.01, 0.0, SurfaceState::Wet),
        (1.0, 0.0, SurfaceState::Wet),
        (1.0, 0.001, SurfaceState::Drenched),
        (1.0, 0.799, SurfaceState::Drenched),
        (1.0, 0.8, SurfaceState::Puddle),
        (f64::NAN, f64::NAN, SurfaceState::Dry),
    ] {
        assert_eq!(SurfaceState::of(w, h, 0.8), state, "{w} {h}");
    }
    let weights = |w, h| SurfaceWeights::new(w, h, 1.0).expect("valid");
    assert_eq!(weights(0.0, 0.0).dry, 1.0);
    assert_eq!(weights(1.0, 0.0).wet, 1.0);
    assert_eq!(weights(0.25, 0.0).wet, 0.25);
    assert_eq!(weights(1.0, 1.2).puddle, 1.0);
    assert_eq!(weights(1.0, 1.0).puddle, 0.5, "half at the texture depth");
    assert_eq!(weights(1.0, 0.8).puddle, 0.0);
    assert!((weights(1.0, 0.5).drenched - 0.5).abs() < 1e-15);
    assert!((weights(1.0, 0.5).covered() - 0.5).abs() < 1e-15);
    // Typed from the doc.
    let ramp = |a: f64, b: f64, x: f64| {
        let t = ((x - a) / (b - a)).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    };
    let (mut worst, mut rough, mut wrong) = (Worst::default(), Worst::default(), Worst::default());
    for texture in [0.0, 0.004, 0.01, 0.8, 1.0, 37.0, 1000.0] {
        // The least texture that a weight sees; the roughness sees any.
        let t = f64::max(texture, 0.01);
        for i in 0..=300 {
            let h = t * f64::from(i) / 200.0;
            for w in [0.0, 0.1, 0.7, 1.0] {
                let s = SurfaceWeights::new(w, h, texture).expect("valid");
                let (covered, puddle) = (ramp(0.0, t, h), ramp(0.8 * t, 1.2 * t, h));
                for (found, exact) in [
                    (s.puddle, puddle),
                    (s.covered(), covered),
                    (s.drenched, covered - puddle),
                    (s.wet, w * (1.0 - covered)),
                    (s.dry, (1.0 - w) * (1.0 - covered)),
                    (closed_film_share(h, t), ramp(0.5 * t, 1.5 * t, h)),
                    (
                        film_roughness(0.6, w, h, t),
                        one_lobe(0.6, w, ramp(0.5 * t, 1.5 * t, h)),
                    ),
                ] {
                    worst.absolute(found, exact, || format!("{w} {h} {texture}"));
                }
                let exact = one_lobe(0.6, w, ramp(0.5 * t, 1.5 * t, h));
                rough.absolute(film_roughness(0.6, w, h, t), exact, || format!("{w} {h} {texture}"));
                let off = SurfaceWeights::new(w, 1.05 * h, texture).expect("valid");
                wrong.absolute(off.puddle, puddle, String::new);
            }
        }
    }
    assert!(wrong.error > 0.05, "a film 5 % off goes unseen");
    worst.assert_below(3e-16, 40_000);
    rough.assert_below(5e-16, 8_000);
}

/// Width of one lobe as high as two that share a surface.
fn one_lobe(bare: f64, flooded: f64, share: f64) -> f64 {
    if share > 0.0 && flooded == 0.0 {
        return 0.0;
    }
    let heights = (1.0 - share) / bare.powi(2) + if share > 0.0 { share / flooded.powi(2) } else { 0.0 };
    heights.sqrt().recip()
}

#[test]
fn water_is_smooth_and_waves_widen_it() {
    assert_eq!(rain_core::optics::normal_reflectance(1.333), WATER_F0);
    assert_eq!(film_roughness(0.6, 0.04, 0.0, 0.8), 0.6);
    assert!((film_roughness(0.6, 0.04, 1.2, 0.8) - 0.04).abs() < 1e-16);
    assert!(
        (film_roughness(0.6, 0.04, 0.8, 0.8) - 0.056_443_252).abs() < 1e-7,
        "full texture: half of its tops are bare"
    );
    assert_eq!(
        film_roughness(0.6, 0.04, 0.1, 0.0),
        0.04,
        "no texture: any film covers it"
    );
    // α² + 2⟨s²⟩: rings of 0.1 slope variance widen a mirror to 0.45.
    assert!((widened_roughness(0.04, 0.1) - (0.04_f64 * 0.04 + 0.2).sqrt()).abs() < 3e-16);
    assert_eq!((widened_roughness(0.3, 0.0), widened_roughness(0.3, 9.0)), (0.3, 1.0));
    let (mut single, mut widened, mut wrong) = (Worst::default(), Worst::default(), Worst::default());
    for texture in [0.0_f32, 0.01, 0.8, 37.0, 1e3] {
        for i in 0..=1000_u16 {
            let h = texture.max(0.01) * f32::from(i) / 600.0;
            let closed = closed_film_share(h.into(), texture.into());
            single.absolute(f64::from(closed_film_share_f32(h, texture)), closed, || {
                format!("{h} {texture}")
            });
            for (dry, water) in [(0.6_f32, 0.04_f32), (0.0, 1.0), (1.0, 0.0), (0.3, 0.3)] {
                let exact = film_roughness(dry.into(), water.into(), h.into(), texture.into());
                single.absolute(f64::from(film_roughness_f32(dry, water, h, texture)), exact, || {
                    format!("{dry} {water} {h} {texture}")
                });
            }
        }
    }
    single.assert_below(5e-7, 20_000);
    for i in 0..=100 {
        let a = f64::from(i) / 100.0;
        for slopes in log_spaced(1e-12, 1e6, 100).chain([0.0]) {
            let exact = f64::hypot(a, (2.0 * slopes).sqrt()).min(1.0);
            widened.absolute(widened_roughness(a, slopes), exact, || format!("{a} {slopes}"));
            wrong.absolute(widened_roughness(a, 1.05 * slopes), exact, String::new);
        }
    }
    widened.assert_below(3e-16, 10_000);
    assert!(wrong.error > 0.01, "slopes 5 % off go unseen");
}

proptest! {
    #![proptest_config(config(256))]

    #[test]
    fn wet_is_darker_and_order_stays(a in 0.0_f64..1.0, b in 0.0_f64..1.0, w in 0.0_f64..1.0, v in 0.0_f64..1.0) {
        let (low, high) = (a.min(b), a.max(b));
        prop_assert!(wet_albedo(low) <= wet_albedo(high));
        prop_assert!(wet_albedo(low) <= low && WetBody::ANGSTROM.albedo(low) >= wet_albedo(low));
        prop_assert!(WetBody::UNDER_SKY.albedo(low) <= wet_albedo(low));
        // Relative darkening is stronger for darker bodies (C29).
        prop_assert!(wet_albedo(low) * high <= wet_albedo(high) * low + 1e-15);
        prop_assert!(saturated_albedo(a, w.max(v)) <= saturated_albedo(a, w.min(v)));
        prop_assert!(widened_roughness(low, w) <= widened_roughness(high, w) && widened_roughness(a, w) >= a);
        prop_assert!(widened_roughness(a, w.min(v)) <= widened_roughness(a, w.max(v)));
        let [r, _, b] = wet_albedo_rgb([low as f32, 0.5, high as f32]);
        prop_assert!(r <= b && r <= low as f32 + 1e-7);
        let single = f64::from(saturated_albedo_f32(a as f32, w as f32));
        prop_assert!((single - saturated_albedo(f64::from(a as f32), f64::from(w as f32))).abs() < 3e-7);
    }

    #[test]
    fn states_are_continuous_and_rise_with_water(
        w in 0.0_f64..1.0,
        h in 0.0_f64..3.0,
        texture in 0.0_f64..2.0,
        step in 0.0_f64..1e-6,
    ) {
        let a = SurfaceWeights::new(w, h, texture).expect("valid");
        let b = SurfaceWeights::new(w, h + step, texture).expect("valid");
        let parts = [a.dry, a.wet, a.drenched, a.puddle];
        prop_assert!(parts.iter().all(|x| (0.0..=1.0).contains(x)));
        prop_assert!((parts.iter().sum::<f64>() - 1.0).abs() < 1e-15);
        prop_assert!(b.puddle >= a.puddle && b.covered() >= a.covered() - 1e-15 && b.dry <= a.dry);
        // The steepest ramp is 3/2 over 0.4 T, T at least 0.01 mm.
        let slope = 1.5 / (0.4 * texture.max(0.01));
        for (x, y) in parts.into_iter().zip([b.dry, b.wet, b.drenched, b.puddle]) {
            prop_assert!((x - y).abs() <= 2.0 * slope * step + 1e-15);
        }
        // More film, smoother.
        prop_assert!(film_roughness(0.6, 0.03, h + step, texture) <= film_roughness(0.6, 0.03, h, texture) + 1e-16);
    }

    #[test]
    fn deeper_absorbing_water_is_darker(dry in 0.0_f64..1.0, cos in 0.0_f64..1.0, depth in 0.0_f64..5.0, more in 0.0_f64..1.0) {
        let (shallow, deep) = (
            under_water([dry; 3], &Water::CLEAR, depth, cos),
            under_water([dry; 3], &Water::CLEAR, depth + more, cos),
        );
        for i in 0..3 {
            prop_assert!(deep[i] <= shallow[i] && deep[i] >= 0.0);
        }
    }
}
