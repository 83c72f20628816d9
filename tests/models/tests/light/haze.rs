//! Extinction, visibility, height profile, the artists' fog.

use proptest::prelude::*;
use rain_core::haze::{
    EXTINCTION_EFFICIENCY, FogFade, HeightHaze, KOSCHMIEDER_CONTRAST, LUMA_GAMMA, LUMA_LINEAR, MAX_VISIBILITY_M,
    METEOROLOGICAL_CONTRAST, ToyShopGlow, artist_fog_amount, contrast_at, desaturated, extinction_for_visibility_per_m,
    extinction_per_m, fog_density, inscattered, inscattered_f32, mean_decay, mean_decay_f32, obscured, obscured_f32,
    transmittance, transmittance_f32, visibility_m,
};
use rain_core::rainfall::{Distribution, Spectrum};
use rain_core::weather::relative_intensity;
use rain_reference::light::haze as reference;

use super::{NOT_NUMBERS, config};
use crate::check::Worst;

/// Marshall–Palmer as published, N₀ = 8000.
pub fn published(r: f64) -> Spectrum {
    let mut spectrum = Spectrum::new(Distribution::MarshallPalmer, r).expect("valid");
    spectrum.n0_per_m3_mm = 8000.0;
    spectrum
}

#[test]
fn extinction_and_visibility_match_the_published_values() {
    let table = [
        (1.0, 0.36466, 10.728, 8.215, 0.9642, 0.30794),
        (5.0, 1.00517, 3.892, 2.980, 0.9044, 0.85144),
        (10.0, 1.55557, 2.515, 1.926, 0.8559, 1.33504),
        (25.0, 2.77071, 1.412, 1.081, 0.7580, 2.4480),
        (50.0, 4.28785, 0.912, 0.699, 0.6513, 3.9094),
        (100.0, 6.63572, 0.590, 0.451, 0.5150, 6.2988),
    ];
    for (r, sigma, koschmieder, meteorological, transmitted, renormalised) in table {
        let ours = extinction_per_m(&published(r), EXTINCTION_EFFICIENCY);
        assert!((ours * 1e3 - sigma).abs() < 6e-6, "{r}: {ours}");
        assert!((sigma - 0.36466 * r.powf(0.63)).abs() < 2e-5 * sigma);
        assert!(
            (visibility_m(ours, KOSCHMIEDER_CONTRAST) * 1e-3 - koschmieder).abs() < 6e-4,
            "{r}"
        );
        assert!(
            (visibility_m(ours, METEOROLOGICAL_CONTRAST) * 1e-3 - meteorological).abs() < 6e-4,
            "{r}"
        );
        assert!((contrast_at(ours, 100.0) - transmitted).abs() < 6e-5, "{r}");
        // The library carries R with its own fall speeds, within 0.4 % of the measured ones.
        let own = extinction_per_m(&Spectrum::new(Distribution::MarshallPalmer, r).expect("valid"), 2.0);
        assert!((own * 1e3 / renormalised - 1.0).abs() < 4e-3, "{r}: {own}");
    }
}

#[test]
fn extinction_is_the_sum_over_drops() {
    let mut worst = Worst::default();
    for distribution in [
        Distribution::MarshallPalmer,
        Distribution::Drizzle,
        Distribution::Thunderstorm,
    ] {
        for r in [0.05, 1.0, 25.0, 200.0] {
            let s = Spectrum::new(distribution, r).expect("valid");
            let slow =
                2.0 * reference::geometric_extinction(s.n0_per_m3_mm, s.slope_per_mm, 0.0, 60.0 / s.slope_per_mm);
            worst.relative(extinction_per_m(&s, 2.0), slow, 1e-30, || {
                format!("{distribution:?} {r}")
            });
        }
    }
    worst.assert_below(1e-10, 12);
    let dry = Spectrum::new(Distribution::MarshallPalmer, 0.0).expect("valid");
    assert_eq!(extinction_per_m(&dry, 2.0), 0.0);
    assert_eq!(visibility_m(0.0, 0.02), MAX_VISIBILITY_M);
    let rain = published(5.0);
    assert_eq!(extinction_per_m(&rain, f64::NAN), extinction_per_m(&rain, 2.0));
    assert_eq!(extinction_per_m(&rain, -1.0), 0.0);
    assert!(extinction_per_m(&rain, f64::INFINITY).is_finite());
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn transmittance_multiplies_and_adds_up(a in 0.0_f64..30.0, b in 0.0_f64..30.0) {
        prop_assert!((transmittance(a + b) / (transmittance(a) * transmittance(b)) - 1.0).abs() < 1e-14);
        prop_assert!((transmittance(a) + obscured(a) - 1.0).abs() < 1e-15);
        let fog = inscattered([1.0, 0.2, 0.0], [0.3, 0.3, 0.3], a);
        prop_assert!(fog.iter().all(|l| (0.0..=1.0).contains(l)));
        // Two stretches of the same fog are one.
        let twice = inscattered(fog, [0.3; 3], b);
        let once = inscattered([1.0, 0.2, 0.0], [0.3; 3], a + b);
        prop_assert!((0..3).all(|i| (twice[i] - once[i]).abs() < 1e-15));
        prop_assert!((f64::from(inscattered_f32(1.0, 0.3, a as f32)) - inscattered([1.0; 3], [0.3; 3], f64::from(a as f32))[0]).abs() < 3e-7);
    }

    #[test]
    fn visibility_and_extinction_are_inverse(log in -7.0_f64..1.0, threshold in 0.001_f64..0.5) {
        let sigma = 10_f64.powf(log);
        let v = visibility_m(sigma, threshold);
        prop_assert!((extinction_for_visibility_per_m(v, threshold) / sigma - 1.0).abs() < 1e-12 || v == MAX_VISIBILITY_M);
        prop_assert!(v == MAX_VISIBILITY_M || (contrast_at(sigma, v) - threshold).abs() < 1e-12);
        prop_assert!(visibility_m(sigma * 1.1, threshold) <= v);
    }

    #[test]
    fn height_haze_is_the_same_both_ways_and_adds_up(
        from in -50.0_f64..200.0, to in -50.0_f64..200.0, way in 0.1_f64..1e4, share in 0.01_f64..0.99, scale in 1.0_f64..500.0
    ) {
        let haze = HeightHaze::new(0.01, 0.0, scale).expect("valid");
        let depth = haze.depth(from, to, way);
        prop_assert!((haze.depth(to, from, way) - depth).abs() <= 1e-13 * depth);
        let middle = from + (to - from) * share;
        let pieces = haze.depth(from, middle, way * share) + haze.depth(middle, to, way * (1.0 - share));
        prop_assert!((pieces - depth).abs() <= 1e-12 * depth, "{pieces} {depth}");
        let (low, high) = (haze.extinction_per_m(from.max(to)), haze.extinction_per_m(from.min(to)));
        prop_assert!(depth >= low * way * (1.0 - 1e-12) && depth <= high * way * (1.0 + 1e-12));
    }

    #[test]
    fn fog_fades_in_closed_form(up in 0.0_f64..20.0, down in 0.0_f64..20.0, share in 0.0_f64..1.0) {
        let (mut whole, mut cut) = (FogFade::default(), FogFade::default());
        whole.advance(true, up, 10.0);
        cut.advance(true, up * share, 10.0);
        cut.advance(true, up * (1.0 - share), 10.0);
        prop_assert!((whole.share() - cut.share()).abs() < 1e-14);
        prop_assert!((whole.share() - (up / 10.0).min(1.0)).abs() < 1e-14);
        whole.advance(false, down, 10.0);
        prop_assert!((0.0..=1.0).contains(&whole.share()));
    }
}

#[test]
fn single_precision_haze_is_the_double_one() {
    let (mut through, mut lost, mut mean) = (Worst::default(), Worst::default(), Worst::default());
    for i in -300..=80 {
        let x = if i < 0 { 10_f32.powf(i as f32 * 0.1) } else { i as f32 };
        let wide = f64::from(x);
        through.relative(f64::from(transmittance_f32(x)), transmittance(wide), 1e-30, || {
            format!("{x}")
        });
        lost.relative(f64::from(obscured_f32(x)), obscured(wide), 1e-38, || format!("{x}"));
        mean.relative(f64::from(mean_decay_f32(x)), mean_decay(wide), 1e-30, || format!("{x}"));
    }
    through.assert_below(2e-7, 380);
    lost.assert_below(2e-7, 380);
    mean.assert_below(3e-7, 380);
}

#[test]
fn the_profile_is_integrated_exactly() {
    let mut worst = Worst::default();
    for scale in [0.5, 10.0, 300.0, 1e7] {
        let haze = HeightHaze::new(0.02, 5.0, scale).expect("valid");
        for (from, to) in [
            (0.0, 0.0),
            (6.0, 6.0),
            (6.0, 6.0001),
            (5.0, 30.0),
            (-20.0, 12.0),
            (9.0, 6.0),
            (-9.0, -1.0),
        ] {
            let slow = reference::profile_depth(0.02, 5.0, scale, from, to, 250.0);
            worst.relative(haze.depth(from, to, 250.0), slow, 1e-30, || {
                format!("H {scale} {from} to {to}")
            });
        }
    }
    worst.assert_below(2e-10, 28);
    // Near-level ways are no special case, and straight up the whole column is σ₀ H.
    let haze = HeightHaze::new(0.02, 0.0, 50.0).expect("valid");
    assert!((haze.depth(10.0, 10.0 + 1e-9, 100.0) / haze.depth(10.0, 10.0, 100.0) - 1.0).abs() < 1e-10);
    assert!((haze.depth(0.0, 1e9, 1e9) - 1.0).abs() < 1e-12);
    assert!((mean_decay(1e-12) - 1.0).abs() < 1e-12 && mean_decay(0.0) == 1.0);
    let wrong = HeightHaze::new(0.021, 5.0, 10.0).expect("valid");
    assert!(
        (wrong.depth(6.0, 9.0, 10.0) / reference::profile_depth(0.02, 5.0, 10.0, 6.0, 9.0, 10.0) - 1.0).abs() > 0.04
    );
}

#[test]
fn marching_converges_to_the_closed_form() {
    let haze = HeightHaze::new(0.05, 0.0, 8.0).expect("valid");
    let exact = transmittance(haze.depth(0.0, 30.0, 60.0));
    let off = |steps| (reference::marched(60.0, steps, |s| haze.extinction_per_m(0.5 * s)) - exact).abs();
    assert!(
        off(10) > 1e-3 && off(40) < off(10) / 3.0 && off(10_000) < 1e-4,
        "{} {} {}",
        off(10),
        off(40),
        off(10_000)
    );
}

#[test]
fn haze_answers_every_number() {
    for bad in NOT_NUMBERS {
        assert!((0.0..=1.0).contains(&transmittance(bad)) && (0.0..=1.0).contains(&obscured(bad)));
        let single = bad as f32;
        assert!((0.0..=1.0).contains(&transmittance_f32(single)) && (0.0..=1.0).contains(&obscured_f32(single)));
        assert!((0.0..=1.0).contains(&mean_decay(bad)) && (0.0..=1.0).contains(&mean_decay_f32(single)));
        assert!(visibility_m(bad, bad).is_finite() && extinction_for_visibility_per_m(bad, bad).is_finite());
        assert!((0.0..=1.0).contains(&contrast_at(bad, 1.0)));
        let haze = HeightHaze::new(0.1, 0.0, 10.0).expect("valid");
        for depth in [
            haze.depth(bad, 1.0, 1.0),
            haze.depth(1.0, bad, 1.0),
            haze.depth(1.0, 2.0, bad),
            haze.depth(bad, bad, bad),
        ] {
            assert!(depth.is_finite() && depth >= 0.0, "{bad}: {depth}");
        }
        assert!(haze.extinction_per_m(bad).is_finite());
        for (base, height, scale) in [
            (f64::NAN, 0.0, 1.0),
            (bad - 200.0, 0.0, 1.0),
            (0.1, f64::INFINITY, 1.0),
            (0.1, 0.0, 0.0),
        ] {
            assert!(HeightHaze::new(base, height, scale).is_err());
        }
        assert!(artist_fog_amount(bad).is_finite() && fog_density(bad, bad, bad).is_finite());
        assert!(
            desaturated([0.1, 0.2, 0.3], bad, LUMA_LINEAR)
                .iter()
                .all(|c| c.is_finite())
        );
        let mut fade = FogFade::default();
        fade.advance(true, bad, bad);
        assert!((0.0..=1.0).contains(&fade.share()));
        assert!(ToyShopGlow::new(bad.min(0.0), 0.5, 1.0).is_err() && ToyShopGlow::new(10.0, 2.0, 1.0).is_err());
        let glow = ToyShopGlow::new(10.0, 0.8, 0.5).expect("valid");
        assert!((0.0..=0.8).contains(&glow.factor(bad, bad)) && (0.0..=0.8).contains(&glow.factor(0.5, bad)));
    }
}

#[test]
fn the_artists_fog_has_the_rows_of_its_source() {
    for (intensity, amount) in [(0.0, 0.0), (0.33, 0.15), (0.66, 0.4), (1.0, 1.0), (2.0, 1.0)] {
        assert!((artist_fog_amount(intensity) - amount).abs() < 1e-15, "{intensity}");
    }
    // Heavier rain, denser fog.
    let density = |r: f64| fog_density(1e-3, 4.0, artist_fog_amount(relative_intensity(r)));
    assert!((0..100).all(|i| density(f64::from(i + 1) * 0.1) > density(f64::from(i) * 0.1)));
    assert!((density(10.0) - 5e-3).abs() < 1e-15);

    // Eq. 13 and its check.
    let colour = [0.5, 0.6, 0.8];
    let grey = desaturated(colour, 1.0, LUMA_GAMMA);
    assert!(grey.iter().all(|c| (c - 0.5929).abs() < 6e-5), "{grey:?}");
    assert_eq!(desaturated(colour, 0.0, LUMA_GAMMA), colour);
    let half = desaturated(colour, 0.5, LUMA_LINEAR);
    let luma = |c: [f64; 3]| c.iter().zip(LUMA_LINEAR).map(|(a, b)| a * b).sum::<f64>();
    assert!((luma(half) - luma(colour)).abs() < 1e-15);
    let mut fade = FogFade::default();
    fade.advance(true, 1.0, 0.0);
    assert_eq!(fade.share(), 1.0);
}

#[test]
fn bright_pixels_glow_instead_of_fogging() {
    let glow = ToyShopGlow::new(10.0, 0.6, 2.0).expect("valid");
    assert!((glow.factor(0.5, 2.0) - 0.4).abs() < 1e-15);
    assert_eq!(glow.factor(0.9, 0.0), 0.6);
    assert_eq!(glow.factor(0.9, 10.0), 0.0);
    assert_eq!(glow.factor(0.9, 50.0), 0.0);
    let (colour, halo) = glow.apply([1.0, 0.5, 0.0], [0.5; 3], 0.1, 0.4);
    assert!((colour[0] - 0.8).abs() < 1e-15 && (colour[2] - 0.2).abs() < 1e-15);
    // lerp(glow, φ P.w + glow, φ).
    let printed = 0.1 * (1.0 - 0.4) + (0.4 * 2.0 + 0.1) * 0.4;
    assert!((halo - printed).abs() < 1e-15);
}
