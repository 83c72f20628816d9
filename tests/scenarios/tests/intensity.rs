//! More rain, more drops; the same drops.

use std::path::Path;

use rain_plugins::scenario::file::Mask;
use test_support::gpu;
use test_support::shots::{Plan, Shot, View, mean, steady};

/// A narrow view and a budget that is never reached, so that quality is the same at every intensity: every drop of at
/// least 0.5 mm within 15 m is drawn. With the usual budget the number of drops would be the same at every intensity,
/// and quality would fall instead.
fn plan(intensity_mm_h: f64, seed: u64) -> Plan {
    let view = View::new([0.0, 30.0, 0.0], [0.0, 30.0, -10.0]).fov(10.0);
    let mut plan = Plan::new(steady(intensity_mm_h, [1.0, 0.0, 0.5]), 3.0, &[view]);
    plan.scenario.rain.streak_budget = 2_000_000;
    // Single drops alone.
    plan.scenario.rain.cards = Some(false);
    plan.scenario.outputs.masks = vec![Mask::Rain];
    plan.scenario.warm_up_frames = 1;
    plan.scenario.seed = seed;
    plan
}

/// The shot and the number of drops of its last frame.
fn shoot(intensity_mm_h: f64, seed: u64) -> (Shot, u32) {
    let plan = plan(intensity_mm_h, seed);
    let mut session = plan.session(Path::new("."), |_| {});
    let shot = plan.shoot(&mut session).remove(0);
    let drops = session.passes().drops.back().copied().unwrap_or(0);
    (shot, drops)
}

/// Drops of at least 0.5 mm per m³ at 10 and 50 mm/h, from renormalised Marshall–Palmer spectra of the bulk check in
/// `docs/physics.md`: N₀/Λ · e^(−Λ/2).
const NUMBER_10: f64 = 6865.8 / 2.5280 * 0.282_53;
const NUMBER_50: f64 = 7294.1 / 1.8030 * 0.405_96;

#[test]
fn rain_pixels_and_drops_rise_with_intensity_at_equal_quality() {
    if !gpu::available() {
        return;
    }
    let shots = [0.0, 2.0, 10.0, 50.0].map(|r| shoot(r, 1));
    let cover = shots.each_ref().map(|(shot, _)| mean(&shot.pixels(), |p| p.rain));
    let drops = shots.each_ref().map(|(_, n)| f64::from(*n));
    assert_eq!((cover[0], drops[0]), (0.0, 0.0), "dry");
    for i in 1..4 {
        assert!(cover[i] > 1.2 * cover[i - 1] + 1e-4, "coverage {cover:?}");
        assert!(drops[i] > 1.2 * drops[i - 1] + 100.0, "drops {drops:?}");
    }
    let (ratio, expected) = (drops[3] / drops[2], NUMBER_50 / NUMBER_10);
    assert!(
        (ratio / expected - 1.0).abs() < 0.03,
        "{ratio}, the spectra say {expected}"
    );
}

#[test]
fn heavier_rain_keeps_every_streak_and_another_seed_does_not() {
    if !gpu::available() {
        return;
    }
    let covered = |r: f64, seed: u64| -> Vec<f64> { shoot(r, seed).0.pixels().iter().map(|p| p.rain).collect() };
    let (light, heavier, other) = (covered(10.0, 1), covered(12.0, 1), covered(12.0, 2));
    // Half floats are blended one streak after the other: each step may round by 2⁻¹¹.
    let lost = |of: &[f64]| light.iter().zip(of).filter(|(a, b)| **b < **a - 0.01).count();
    assert_eq!(lost(&heavier), 0, "pixels lost coverage");
    let gained = light.iter().zip(&heavier).filter(|(a, b)| **b > **a + 0.01).count();
    assert!(gained > 100, "{gained} pixels gained");
    assert!(lost(&other) > 1000, "{} pixels with another seed", lost(&other));
}

/// How far single streaks stand out from the rain around them: the spread of the coverage over its mean.
fn standing_out(shot: &Shot) -> f64 {
    let pixels = shot.pixels();
    let middle = mean(&pixels, |p| p.rain);
    mean(&pixels, |p| (p.rain - middle).powi(2)).sqrt() / middle
}

#[test]
fn single_streaks_are_told_apart_in_light_rain_and_not_in_heavy_rain() {
    if !gpu::available() {
        return;
    }
    let [light, moderate, heavy] = [1.0, 5.0, 50.0].map(|intensity| standing_out(&shoot(intensity, 1).0));
    assert!(light > 0.5, "light {light}, moderate {moderate}, heavy {heavy}");
    assert!(
        moderate < 0.7 * light && heavy < 0.25 * light,
        "light {light}, moderate {moderate}, heavy {heavy}"
    );
}
