//! A roof of known edges: no rain under it, dry below it, a soft border where geometry puts it, walls by their side.

use std::path::Path;

use test_support::shots::{Pixel, Plan, View, mean, raining, steady};
use test_support::{gpu, world};

use crate::border::{
    COVER_TEXEL_M, MEAN_INVERSE_SPEED_25_MM_H, MEDIAN_INVERSE_SPEED_25_MM_H, crossings, mean_border, profile,
};

/// When everything under the open sky is soaked at 25 mm/h. Units: s.
const SOAKED_S: f64 = 180.0;

/// Level ground, strictly inside |z| < 1 m, so that only the borders across x count.
fn strip(shot: &test_support::shots::Shot) -> Vec<Pixel> {
    shot.where_surface(|p| p.y.abs() < 0.02 && p.z.abs() < 1.0)
}

fn x(pixel: &Pixel) -> f64 {
    pixel.surface.map_or(f64::NAN, |p| p.x)
}

#[test]
fn no_streak_under_a_roof_and_streaks_beside_it_in_the_same_frame() {
    if !gpu::available() {
        return;
    }
    let views = [
        View::new([0.0, 1.7, 4.0], [0.0, 0.3, -4.0]),
        View::new([0.0, 1.7, 4.0], [0.0, 1.7, 40.0]),
    ];
    let plan = Plan::new(steady(50.0, [0.0; 3]), 20.0, &views);
    let mut session = plan.session(Path::new("."), |world| {
        world::ground(world);
        world::roof(world);
    });
    let shots = plan.shoot(&mut session);
    // From an eye under the roof, the whole line of sight to a surface under the roof is under it. A streak is 15 cm
    // long and its edge is known to a texel.
    let reach = f64::from(world::ROOF_HALF) - 0.2;
    let under = shots[0].where_surface(|p| p.x.abs() < reach && p.z.abs() < reach && p.y < 3.9);
    assert!(under.len() > 4000, "{} pixels show the sheltered ground", under.len());
    assert_eq!(raining(&under), 0, "of {} pixels", under.len());
    // The same eye, turned to the open ground beyond the edge.
    let open = shots[1].where_surface(|p| p.z > f64::from(world::ROOF_HALF) + 0.5);
    assert!(raining(&open) * 5 > open.len(), "{} of {}", raining(&open), open.len());
}

#[test]
fn the_ground_is_dry_under_a_roof_and_wet_beside_it_with_a_soft_border() {
    if !gpu::available() {
        return;
    }
    let edge = -f64::from(world::ROOF_HALF);
    let views = [View::new([edge, 3.4, 0.0], [edge, 0.0, 0.0])];
    let plan = Plan::new(steady(25.0, [0.0; 3]), SOAKED_S, &views);
    let mut session = plan.session(Path::new("."), |world| {
        world::without_ground(world);
        world::ground(world);
        world::roof(world);
    });
    let ground = strip(&plan.shoot(&mut session)[0]);
    let dry: Vec<Pixel> = ground.iter().copied().filter(|p| x(p) > edge + 0.3).collect();
    let wet: Vec<Pixel> = ground.iter().copied().filter(|p| x(p) < edge - 0.3).collect();
    assert!(
        dry.len() > 500 && wet.len() > 500,
        "{} dry, {} wet",
        dry.len(),
        wet.len()
    );
    assert_eq!(dry.iter().filter(|p| p.wet > 0.0).count(), 0);
    assert!(mean(&wet, |p| p.wet) > 0.95, "{}", mean(&wet, |p| p.wet));
    // Soft: values between, but not wider than the look-up's tent.
    let between: Vec<f64> = ground.iter().filter(|p| p.wet > 0.05 && p.wet < 0.9).map(x).collect();
    assert!(!between.is_empty(), "a hard border");
    for place in between {
        assert!(
            (place - edge).abs() < 3.0 * COVER_TEXEL_M,
            "half wet at {place}, edge {edge}"
        );
    }
}

#[test]
fn wind_moves_the_dry_patch_by_height_times_wind_over_fall_speed() {
    if !gpu::available() {
        return;
    }
    let (half, low, high) = (
        f64::from(world::ROOF_HALF),
        f64::from(world::ROOF_LOW),
        f64::from(world::ROOF_HIGH),
    );
    for wind in [0.0, 4.0] {
        // On the windward side rain must clear the underside's edge, on the lee side the top's. Slow drops drift
        // further than fast ones: the border is soft, half the rain within its median, and its area that of the mean.
        let at = |inverse_speed: f64| {
            let drift = wind * inverse_speed;
            [-half + low * drift, half + high * drift]
        };
        let (mean_at, median_at) = (at(MEAN_INVERSE_SPEED_25_MM_H), at(MEDIAN_INVERSE_SPEED_25_MM_H));
        let over = |place: f64, eye: f64| View::new([place, eye, 0.0], [place, 0.0, 0.0]);
        let lee = if wind > 0.0 { 6.0 } else { 3.4 };
        let views = [over(mean_at[0] + 0.5, 3.4), over(mean_at[1] + 0.5, lee)];
        let plan = Plan::new(steady(25.0, [wind, 0.0, 0.0]), SOAKED_S, &views);
        let mut session = plan.session(Path::new("."), |world| {
            world::without_ground(world);
            world::ground(world);
            world::roof(world);
        });
        for (i, shot) in plan.shoot(&mut session).iter().enumerate() {
            let profile = profile(&strip(shot), x);
            let open = profile.iter().map(|p| p.1).fold(0.0, f64::max);
            assert!(open > 0.95, "wind {wind}, side {i}: {open} in the open");
            let dry = profile.iter().map(|p| p.1).fold(1.0, f64::min);
            assert!(dry < 0.01, "wind {wind}, side {i}: {dry} under the roof");
            let found = crossings(&profile, 0.5 * open);
            assert_eq!(found.len(), 1, "wind {wind}, side {i}: borders at {found:?}");
            assert!(
                (found[0] - median_at[i]).abs() < 2.0 * COVER_TEXEL_M,
                "wind {wind} m/s, side {i}: half the rain at {} m, geometry says {} m",
                found[0],
                median_at[i]
            );
            // The look-up softens over a texel more, and not the same on both sides.
            let mean = mean_border(&profile, open);
            assert!(
                (mean - mean_at[i]).abs() < 3.0 * COVER_TEXEL_M,
                "wind {wind} m/s, side {i}: mean border at {mean} m, geometry says {} m",
                mean_at[i]
            );
        }
    }
}

#[test]
fn a_wall_in_the_lee_stays_drier_than_the_windward_wall() {
    if !gpu::available() {
        return;
    }
    let views = [
        View::new([-6.0, 1.5, 0.0], [0.0, 1.5, 0.0]),
        View::new([6.0, 1.5, 0.0], [0.0, 1.5, 0.0]),
    ];
    let plan = Plan::new(steady(25.0, [8.0, 0.0, 0.0]), SOAKED_S, &views);
    let mut session = plan.session(Path::new("."), |world| {
        world::without_ground(world);
        world::ground(world);
        let (low, high) = ([-1.0, 0.0, -4.0].into(), [1.0, 3.0, 4.0].into());
        world::block(world, "house", low, high, world::STONE);
    });
    let shots = plan.shoot(&mut session);
    let wall = |i: usize, side: f64| {
        shots[i].where_surface(|p| (p.x - side).abs() < 0.03 && p.y > 0.3 && p.y < 2.7 && p.z.abs() < 3.7)
    };
    let (windward, lee) = (wall(0, -1.0), wall(1, 1.0));
    assert!(windward.len() > 500 && lee.len() > 500);
    let (windward, lee) = (mean(&windward, |p| p.wet), mean(&lee, |p| p.wet));
    assert!(windward > 0.2, "windward {windward}");
    assert!(lee < 0.1 * windward, "lee {lee}, windward {windward}");
}
