//! The small formulas of haze and optics against their twins, over the whole domain.

use core::f64::consts::{FRAC_PI_2, PI};

use proptest::prelude::*;
use rain_core::haze::{
    FogFade, HazeSharing, HeightHaze, LUMA_GAMMA, LUMA_LINEAR, ToyShopGlow, artist_fog_amount, card_coverage,
    card_weight, contrast_at, desaturated, extinction_for_visibility_per_m, fog_density, inscattered, inscattered_f32,
    mean_decay, mid_start_m, mid_weight, near_weight, obscured, ramp, single_range_fog_depth, transmittance,
    visibility_m,
};
use rain_core::optics::{
    Polarised, brewster_rad, critical_angle_rad, energy_split, field_of_view_rad, fresnel, fresnel_f32,
    hemispherical_mean_inside, normal_reflectance, rainbow, retro_reflection, schlick, sphere_order_share,
};
use rain_core::rainfall::{CLASS_COUNT, Distribution, Spectrum};
use rain_reference::light as optics;
use rain_reference::light::haze as reference;
use rain_reference::numerics::simpson;

use super::{NOT_NUMBERS, config};
use crate::check::Worst;

/// 0, and every tenth of a decade from 1e-12 to 1e3.
fn depths() -> impl Iterator<Item = f64> {
    core::iter::once(0.0).chain((-120..=30).map(|i| 10_f64.powf(0.1 * f64::from(i))))
}

/// Indices of refraction from just above 1 to 10.
fn indices() -> impl Iterator<Item = f64> {
    (0..=90).map(|i| 1.0 + 1e-6 * 10_f64.powf(f64::from(i) / 90.0 * 9_f64.log10() + f64::from(i) / 15.0))
}

#[test]
fn light_lost_and_left_are_exponentials() {
    let (mut through, mut lost, mut mean, mut mixed, mut single) = (
        Worst::default(),
        Worst::default(),
        Worst::default(),
        Worst::default(),
        Worst::default(),
    );
    for depth in depths() {
        let place = || format!("τ = {depth}");
        // Held at 700.
        let held = f64::min(depth, 700.0);
        through.relative(transmittance(depth), 1.0 / held.exp(), 1e-310, place);
        lost.relative(obscured(depth), reference::lost(held), 1e-310, place);
        lost.relative(card_coverage(depth, 1.0), reference::lost(held), 1e-310, place);
        through.relative(contrast_at(depth, 1.0), 1.0 / held.exp(), 1e-310, place);
        if depth > 0.0 {
            mean.relative(mean_decay(depth), reference::mean_decay(depth), 1e-310, place);
        }
        for (light, fog) in [(1.0, 0.3), (0.0, 5.0), (1e6, 1e-3), (2.0, 2.0)] {
            let expected = fog + (light - fog) / held.exp();
            let scale = f64::max(light, fog);
            mixed.absolute(
                inscattered([light; 3], [fog; 3], depth)[1] / scale,
                expected / scale,
                place,
            );
            let (l, f, d) = (light as f32, fog as f32, f64::min(depth, 80.0) as f32);
            let exact = f64::from(f) + (f64::from(l) - f64::from(f)) * (-f64::from(d)).exp();
            single.absolute(f64::from(inscattered_f32(l, f, d)) / scale, exact / scale, place);
        }
    }
    through.assert_below(1e-15, 300);
    lost.assert_below(1e-15, 300);
    mean.assert_below(6e-15, 150);
    mixed.assert_below(1e-15, 600);
    single.assert_below(3e-7, 600);
    assert!(
        (transmittance(1.05) - 1.0 / 1_f64.exp()).abs() > 0.01,
        "5 % of the depth goes unseen"
    );
    for bad in NOT_NUMBERS {
        assert_eq!(
            (card_coverage(bad, 1.0), contrast_at(bad, 1.0)),
            (obscured(bad), transmittance(bad))
        );
        assert!((0.0..=1.0).contains(&inscattered([1.0; 3], [0.0; 3], bad)[0]), "{bad}");
        assert!((0.0..=1.0).contains(&inscattered_f32(1.0, 0.0, bad as f32)), "{bad}");
    }
}

#[test]
fn visibility_is_where_contrast_meets_the_threshold() {
    let (mut distance, mut sigma, mut bent) = (Worst::default(), Worst::default(), Worst::default());
    for extinction in depths().filter(|&x| x > 1e-8) {
        for threshold in [1e-6, 0.02, 0.05, 0.5, 0.999, 1.0] {
            let place = || format!("{extinction} 1/m to {threshold}");
            // The logarithm by the distance from 1 where that is shorter.
            let ln: f64 = if threshold > 0.5 {
                f64::ln_1p(threshold - 1.0)
            } else {
                f64::ln(threshold)
            };
            let expected = (-ln / extinction).min(1e9);
            distance.relative(visibility_m(extinction, threshold), expected, 1e-30, place);
            bent.relative(1.05 * visibility_m(extinction, threshold), expected, 1e-30, place);
            let way = (1e3 * extinction).max(1e-3);
            let expected = -ln / way;
            sigma.relative(extinction_for_visibility_per_m(way, threshold), expected, 1e-30, place);
        }
    }
    distance.assert_below(1e-15, 600);
    sigma.assert_below(1e-15, 600);
    assert!(bent.error > 0.04);
    for (bad, held) in [(f64::NAN, 1e9), (0.0, 1e-3), (-1.0, 1e-3), (f64::INFINITY, 1e9)] {
        assert_eq!(
            extinction_for_visibility_per_m(bad, 0.02),
            extinction_for_visibility_per_m(held, 0.02)
        );
    }
    for (bad, held) in [(f64::NAN, 0.02), (0.0, 1e-6), (-1.0, 1e-6), (7.0, 1.0)] {
        assert_eq!(visibility_m(0.01, bad), visibility_m(0.01, held));
    }
}

#[test]
fn haze_thins_out_by_its_scale() {
    let mut worst = Worst::default();
    for scale in [1e-3, 8.0, 300.0, 1e9] {
        for base in [-50.0, 0.0, 120.0] {
            let haze = HeightHaze::new(0.02, base, scale).expect("valid");
            for i in -200..=200 {
                let height = base + 2.5 * f64::from(i);
                let expected = 0.02 / (f64::max(height - base, 0.0) / scale).exp();
                worst.relative(haze.extinction_per_m(height), expected, 1e-310, || {
                    format!("{height} m, H {scale}")
                });
            }
            assert_eq!(haze.extinction_per_m(f64::NAN), 0.02);
            assert_eq!(haze.extinction_per_m(f64::INFINITY), 0.0);
        }
    }
    worst.assert_below(1e-15, 4000);
}

#[test]
fn weights_and_cards_are_their_ramps() {
    let (mut step, mut weight, mut bent) = (Worst::default(), Worst::default(), Worst::default());
    let (mut card, mut way) = (Worst::default(), Worst::default());
    for i in 0..=1200 {
        let r = 0.05 * f64::from(i);
        step.absolute(
            ramp(r, 2.0, 41.0),
            simpson(0.0, ((r - 2.0) / 39.0).clamp(0.0, 1.0), 4, |t| 6.0 * t * (1.0 - t)),
            || format!("{r}"),
        );
        for z in [0.0, 0.2, 0.25, 0.7, 3.0, 4.0, 9.0, 15.0, 29.0, 60.0] {
            let place = || format!("{r} m, range {z} m");
            let near = if z >= 0.25 { reference::near_weight(r, z) } else { 0.0 };
            weight.absolute(near_weight(r, z), near, place);
            let start = (0.8 * z).clamp(3.2, 24.0);
            assert_eq!(mid_start_m(z), start);
            let mid = reference::smooth(r, start, 1.5 * start) - reference::smooth(r, 24.0, 36.0);
            weight.absolute(mid_weight(r, z), mid, place);
            bent.absolute(mid_weight(1.05 * r, z), mid, place);
        }
    }
    for r in [0.0, 1.0, 3.3, 4.1, 6.0, 17.0, 25.0, 33.0, 40.0, 300.0] {
        for a in [1e-3, 0.5, 2.0, 4.0, 50.0] {
            for z in [0.0, 4.0, 9.0, 15.0, 29.0] {
                let (found, expected) = (card_weight(r, a, z), reference::card(r, a, z));
                let place = || format!("{r} m, {a} m, {z} m");
                way.absolute(a * found, a * expected, place);
                if a >= 0.5 {
                    card.absolute(found, expected, place);
                }
            }
        }
    }
    step.assert_below(1e-15, 1200);
    weight.assert_below(1e-15, 24_000);
    card.assert_below(1e-13, 200);
    way.assert_below(1e-13, 250);
    assert!(bent.error > 0.05);
    for (bad, held) in [(f64::NAN, 1e-3), (0.0, 1e-3), (-1.0, 1e-3), (f64::INFINITY, 1e3)] {
        assert_eq!(card_weight(6.0, bad, 4.0), card_weight(6.0, held, 4.0), "{bad}");
    }
    assert_eq!((mid_start_m(f64::NAN), mid_start_m(f64::INFINITY)), (3.2, 24.0));
}

#[test]
fn single_ranges_leave_the_rest_to_the_fog() {
    let (mut worst, mut account) = (Worst::default(), Worst::default());
    for sigma in [0.0, 1e-6, 1.4e-3, 0.1] {
        for efficiency in [1.0, 2.0, 4.0] {
            for way in [0.0, 3.0, 30.0, 500.0, 1e9] {
                for (range, share) in [(0.0, 0.0), (15.0, 0.4), (30.0, 1.0), (1e9, 1.0)] {
                    // Before the range the fog lacks the drawn share, beyond it nothing.
                    let near = f64::min(way, range);
                    let expected = sigma * ((efficiency - share) * near + efficiency * (way - near));
                    let found = single_range_fog_depth(sigma, efficiency, way, range, share);
                    worst.absolute(
                        found / (sigma * efficiency * way).max(1e-300),
                        expected / (sigma * efficiency * way).max(1e-300),
                        || format!("{sigma} 1/m, {efficiency}, {way} m, {range} m, {share}"),
                    );
                }
            }
        }
    }
    worst.assert_below(1e-15, 240);
    for (efficiency, ranges) in [(1.0, 4.0), (2.0, 15.0), (4.0, 0.0)] {
        let spectrum = Spectrum::new(Distribution::MarshallPalmer, 20.0).expect("valid");
        let sharing = HazeSharing::new(&spectrum, efficiency, [ranges; CLASS_COUNT], true).expect("valid");
        let sigma = reference::geometric_extinction(spectrum.n0_per_m3_mm, spectrum.slope_per_mm, 0.0, 30.0);
        for way in [0.0, 1.0, 10.0, 40.0, 1e4] {
            let place = || format!("Q {efficiency}, {ranges} m, {way} m");
            account.relative(sharing.total_depth(way), efficiency * sigma * way, 1e-30, place);
            let parts = sharing.drawn_depth(way) + sharing.fog_depth(way);
            account.relative(parts, efficiency * sigma * way, 1e-30, place);
            account.relative(
                sharing.fog_transmittance(way),
                (-sharing.fog_depth(way)).exp(),
                1e-30,
                place,
            );
        }
    }
    account.assert_below(1e-10, 45);
}

#[test]
fn artists_fog_is_its_table_and_its_products() {
    let (mut table, mut density, mut grey, mut glow) =
        (Worst::default(), Worst::default(), Worst::default(), Worst::default());
    for i in 0..=1000 {
        let x = 1e-3 * f64::from(i);
        table.absolute(artist_fog_amount(x), reference::table_fog(x), || format!("{x}"));
        for (own, gain) in [(1e-6, 0.0), (1e-3, 4.0), (1e3, 1e3)] {
            let expected = own + own * gain * x;
            density.relative(fog_density(own, gain, x), expected, 1e-30, || {
                format!("{own} {gain} {x}")
            });
        }
        for luma in [LUMA_LINEAR, LUMA_GAMMA] {
            let colour = [0.9 - 0.5 * x, 0.1 + x * x, 0.3];
            let y = colour[0] * luma[0] + colour[1] * luma[1] + colour[2] * luma[2];
            for (found, own) in desaturated(colour, x, luma).into_iter().zip(colour) {
                grey.absolute(found, own * (1.0 - x) + y * x, || format!("{x}"));
            }
        }
        let toy = ToyShopGlow::new(10.0, 0.8, 0.5).expect("valid");
        for luminance in [0.0, 1.0, 9.0, 40.0] {
            let expected = (x - x * luminance / 10.0).clamp(0.0, 0.8);
            glow.absolute(toy.factor(x, luminance), expected, || format!("{x} {luminance}"));
            let (colour, halo) = toy.apply([1.0, 0.2, 0.0], [0.5, 0.6, 0.7], 0.1, expected);
            glow.absolute(colour[0], 1.0 - 0.5 * expected, || format!("{x}"));
            glow.absolute(colour[2], 0.7 * expected, || format!("{x}"));
            glow.absolute(halo, 0.1 + 0.5 * expected.powi(2), || format!("{x}"));
        }
    }
    table.assert_below(4e-16, 1001);
    density.assert_below(1e-15, 3000);
    grey.assert_below(4e-16, 6000);
    glow.assert_below(4e-16, 16_000);
    for bad in NOT_NUMBERS {
        assert!((0.0..=1.0).contains(&artist_fog_amount(bad)));
        assert!((0.0..=1e9).contains(&fog_density(bad, 1.0, bad)), "{bad}");
    }
    assert_eq!(artist_fog_amount(f64::NAN), 0.0);
    let mut fade = FogFade::default();
    let mut worst = Worst::default();
    for i in 1..=200 {
        fade.advance(true, 0.01, 4.0);
        worst.absolute(fade.share(), 0.0025 * f64::from(i), || format!("step {i}"));
    }
    worst.assert_below(1e-14, 200);
}

#[test]
fn special_angles_and_reflectances_are_the_textbooks() {
    let (mut angle, mut bare, mut cheap, mut inside) =
        (Worst::default(), Worst::default(), Worst::default(), Worst::default());
    for n in indices() {
        let place = || format!("n = {n}");
        let root = (n - 1.0).sqrt() * (n + 1.0).sqrt();
        // The angle whose tangent is n has the sine n/√(1 + n²).
        angle.absolute(brewster_rad(n), (n / n.hypot(1.0)).asin(), place);
        angle.absolute(brewster_rad(1.0 / n), (1.0 / n.hypot(1.0)).asin(), place);
        angle.absolute(critical_angle_rad(n), (1.0 / root).atan(), place);
        angle.absolute(field_of_view_rad(n), 4.0 * root.atan(), place);
        let [s, p] = optics::fresnel(0.0, 1.0, n);
        bare.absolute(normal_reflectance(n), 0.5 * (s + p), place);
        bare.absolute(normal_reflectance(1.0 / n), 0.5 * (s + p), place);
        assert_eq!(Polarised { s, p }.mean(), 0.5 * (s + p));
        for theta in [0.0, 0.4, 1.0, 1.3, 1.5] {
            cheap.absolute(schlick(f64::cos(theta), n), optics::schlick(theta, n), place);
        }
    }
    for n in [1.001, 1.05, 1.333, 1.5, 2.0, 5.0] {
        // Total beyond the critical angle; within it F from inside, dense towards that angle, where it rises.
        let critical = (1.0_f64 / n).asin();
        let part = simpson(0.0, critical.powf(0.25), 4000, |x| {
            let theta = (critical - x.powi(4)).max(0.0);
            let [s, p] = optics::fresnel(theta, n, 1.0);
            0.5 * (s + p) * (2.0 * theta).sin() * 4.0 * x.powi(3)
        });
        let mean = part + critical.cos().powi(2);
        inside.absolute(hemispherical_mean_inside(n), mean, || format!("n = {n}"));
    }
    angle.assert_below(6e-15, 360);
    bare.assert_below(4e-16, 180);
    cheap.assert_below(1e-15, 450);
    inside.assert_below(1e-13, 6);
    for (bad, held) in [
        (f64::NAN, 1.0),
        (0.0, 1.0),
        (-1.0, 1.0),
        (1e300, 10.0),
        (f64::INFINITY, 10.0),
    ] {
        assert_eq!(critical_angle_rad(bad), critical_angle_rad(held));
        assert_eq!(field_of_view_rad(bad), field_of_view_rad(held));
        assert_eq!(hemispherical_mean_inside(bad), hemispherical_mean_inside(held));
    }
    assert_eq!((critical_angle_rad(1.0), field_of_view_rad(1.0)), (FRAC_PI_2, 0.0));
}

#[test]
fn single_precision_reflectance_stays_near_at_the_critical_angle() {
    let mut worst = Worst::default();
    for n in (0..=100).map(|i| 0.5 + 0.0025 * i as f32) {
        let edge = (1.0 - f64::from(n) * f64::from(n)).sqrt();
        for i in -100..=100 {
            let c = (edge + 3e-8 * f64::from(i)) as f32;
            let exact = fresnel(f64::from(c), f64::from(n));
            worst.absolute(f64::from(fresnel_f32(c, n)), exact, || format!("{n} {c}"));
        }
    }
    worst.assert_below(3e-3, 16_000);
}

#[test]
fn light_sent_back_and_shared_out_is_that_of_its_orders() {
    let (mut back, mut split) = (Worst::default(), Worst::default());
    for n in [1.0, 1.05, 1.3, 1.333, 1.5, 1.7, 1.9] {
        let f0: f64 = ((n - 1.0) / (n + 1.0)) * ((n - 1.0) / (n + 1.0));
        // Front and back as mirrors: radii of curvature of the two images.
        let (front, rear) = (0.25 * f0, (1.0 - f0).powi(2) * f0 * (n / (4.0 - 2.0 * n)).powi(2));
        back.relative(retro_reflection(n), front + rear, 1e-30, || format!("{n}"));
        let shares = energy_split(n);
        let known = [0, 1, 2, 3, 4].map(|order| sphere_order_share(order, n));
        let found = [
            shares.reflected,
            shares.through,
            shares.inner[0],
            shares.inner[1],
            shares.inner[2],
        ];
        assert_eq!(found, known, "{n}");
        let later: f64 = (5..100).map(|order| sphere_order_share(order, n)).sum();
        split.absolute(shares.rest, later, || format!("{n}"));
    }
    back.assert_below(5e-15, 7);
    split.assert_below(1e-6, 7);
    assert_eq!(retro_reflection(3.0), retro_reflection(1.9));
    assert_eq!(sphere_order_share(u32::MAX, 1.333), sphere_order_share(100, 1.333));
}

#[test]
fn rainbows_of_any_water_are_found_by_search() {
    let mut worst = Worst::default();
    for n in [1.3, 1.3314, 1.333, 1.3377, 1.37, 1.42, 1.5] {
        for order in [1, 2] {
            let bow = rainbow(order, n).expect("has it");
            let (slow, _) = rain_reference::light::sphere::bow(order as usize, n);
            worst.absolute(bow.angle_rad, slow, || format!("{order} at {n}"));
            // Descartes: tan i = ((k + 1) tan r) at the stationary ray.
            let (i, r) = (bow.impact.asin(), (bow.impact / n).asin());
            let k = f64::from(order) + 1.0;
            assert!((i.tan() / (k * r.tan()) - 1.0).abs() < 1e-12, "{order} at {n}");
        }
    }
    worst.assert_below(1e-9, 14);
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn fog_only_ever_hides_more(a in 0.0_f64..600.0, more in 0.0_f64..10.0, sigma in 0.0_f64..0.1, way in 0.0_f64..1e3, far in 0.0_f64..1e3) {
        prop_assert!(transmittance(a + more) <= transmittance(a) && obscured(a + more) >= obscured(a));
        prop_assert!((transmittance(a) + obscured(a) - 1.0).abs() < 1e-15);
        prop_assert!(mean_decay(a + more) <= mean_decay(a) && mean_decay(a) >= transmittance(a));
        prop_assert!(contrast_at(sigma, way + far) <= contrast_at(sigma, way));
        let fog = |s: f64| single_range_fog_depth(sigma, 2.0, s, 30.0, 1.0);
        prop_assert!(fog(way + far) >= fog(way) && fog(way) >= sigma * way * (1.0 - 1e-15), "never less than what is left");
        prop_assert!(card_coverage(sigma, way) <= 1.0 && card_coverage(sigma, way + far) >= card_coverage(sigma, way));
    }

    #[test]
    fn looks_of_fog_stay_between_their_ends(x in 0.0_f64..1.0, more in 0.0_f64..0.5, weight in 0.0_f64..1.0, r in 0.0_f64..1.0, g in 0.0_f64..1.0, b in 0.0_f64..1.0) {
        prop_assert!(artist_fog_amount(x + more) >= artist_fog_amount(x) && (0.0..=1.0).contains(&artist_fog_amount(x)));
        prop_assert!(fog_density(1e-3, 4.0, x + more) >= fog_density(1e-3, 4.0, x));
        let luma = |c: [f64; 3]| c.iter().zip(LUMA_LINEAR).map(|(a, b)| a * b).sum::<f64>();
        let grey = desaturated([r, g, b], weight, LUMA_LINEAR);
        prop_assert!((luma(grey) - luma([r, g, b])).abs() < 1e-15, "luminance is kept");
        let spread = |c: [f64; 3]| c.iter().copied().fold(0.0, f64::max) - c.iter().copied().fold(1.0, f64::min);
        prop_assert!((spread(grey) - (1.0 - weight) * spread([r, g, b])).abs() < 1e-15);
    }

    #[test]
    fn angles_and_reflectances_grow_with_the_index(n in 1.0_f64..9.0, more in 1e-6_f64..1.0) {
        prop_assert!(brewster_rad(n + more) > brewster_rad(n) && critical_angle_rad(n + more) < critical_angle_rad(n));
        prop_assert!(field_of_view_rad(n + more) > field_of_view_rad(n) && field_of_view_rad(n) < 2.0 * PI);
        prop_assert!(normal_reflectance(n + more) > normal_reflectance(n));
        // Brewster's angles of both sides are complementary.
        prop_assert!((brewster_rad(n) + brewster_rad(1.0 / n) - FRAC_PI_2).abs() < 1e-15);
        let (a, b) = (retro_reflection(n.min(1.8)), retro_reflection(n.min(1.8) + 0.05));
        prop_assert!(b >= a && a >= 0.0);
    }
}
