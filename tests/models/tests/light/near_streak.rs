//! Near drops: their bodies, outlines and swings, and the patterns that they draw along their streaks.

use core::f64::consts::{PI, TAU};

use glam::{Vec2, Vec3};
use rain_core::optics::{
    DropBody, StreakAngles, WATER_INDEX, disc_share_within, drop_glint, light_lobe, outline_heights, outline_radius,
    streak_pattern, swing_at, swinging_body, time_inside,
};
use rain_core::rainfall::{DropOutline, Oscillation, mode_frequency_hz};

use super::NOT_NUMBERS;
use crate::check::Worst;

/// Every place of the disc of `body` on a grid: what the ray there sees, and the area it stands for in radii².
fn disc(body: DropBody, view: Vec3, places: u16) -> Vec<(Vec2, [rain_core::optics::DropRay; 3])> {
    let [up, down] = outline_heights(body, view.y);
    let right = Vec3::new(-view.z, 0.0, view.x).normalize();
    let upward = right.cross(view);
    let mut seen = Vec::new();
    let step = |i: u16, low: f32, high: f32| low + (high - low) * (f32::from(i) + 0.5) / f32::from(places);
    for i in 0..places {
        for j in 0..places {
            let at = Vec2::new(step(i, -1.0, 1.0), step(j, -down, up));
            let normal = body.enter(right * at.x + upward * at.y, view);
            if let Some(rays) = normal.and_then(|normal| body.rays::<3>(view, normal, WATER_INDEX)) {
                seen.push((at, rays));
            }
        }
    }
    seen
}

#[test]
fn a_swinging_body_is_the_outlines_halves() {
    let (mut upper, mut lower) = (Worst::default(), Worst::default());
    let mut swung = Worst::default();
    for i in 0..=120 {
        let mm = 0.05 * f64::from(i);
        let outline = DropOutline::new(mm);
        let (known, _) = DropBody::of_outline(&outline);
        let body = swinging_body(mm as f32, 0.0);
        upper.absolute(body.upper().into(), known.upper().into(), || format!("{mm} mm"));
        lower.absolute(body.lower().into(), known.lower().into(), || format!("{mm} mm"));
        for deflection in [-0.15, -0.07, 0.07, 0.15] {
            let (known, _) = DropBody::of_outline(&outline.deformed([deflection, 0.0]));
            let body = swinging_body(mm as f32, deflection as f32);
            for (ours, known) in [(body.upper(), known.upper()), (body.lower(), known.lower())] {
                swung.absolute(ours.into(), known.into(), || format!("{mm} mm, {deflection}"));
            }
        }
    }
    upper.assert_below(7e-4, 100);
    lower.assert_below(4e-3, 100);
    swung.assert_below(0.05, 400);
}

#[test]
fn drops_swing_by_their_height_and_the_tail_is_where_the_head_was() {
    let (mut worst, mut greatest) = (Worst::default(), 0.0_f64);
    for (mm, fall) in [(1.5, 5.4), (3.0, 8.0), (5.0, 9.1)] {
        for i in 0..200 {
            let (start, height) = (0.013 * f64::from(i), 40.0 - 0.61 * f64::from(i));
            let time = 0.003 * f64::from(i);
            let head_then = swing_at(mm, start, height + fall * time, fall);
            // The same drop, told by time: it has fallen for `time` since.
            let turns = start - mode_frequency_hz(2, mm) * (height + fall * time) / fall;
            let mut drop = Oscillation::sustained(mm, turns);
            worst.absolute(head_then, drop.deflections()[0], || format!("{mm} mm at {height} m"));
            drop.advance(time);
            worst.absolute(swing_at(mm, start, height, fall), drop.deflections()[0], || {
                format!("{mm} mm at {height} m, {time} s after")
            });
            greatest = greatest.max(head_then.abs());
        }
    }
    // The swing's own 1e-15 of the turns made, some thousands, and as much by way of the time.
    worst.assert_below(1e-11, 1000);
    assert!(greatest > 0.14);
    assert!(swing_at(0.8, 0.25, 0.0, 5.0) == 0.0, "small drops are round");
}

#[test]
fn outlines_keep_the_disc_and_the_width_on_average() {
    let mut area = Worst::default();
    for (mm, deflection, sine) in [
        (1.0, 0.0, 0.0),
        (3.0, 0.1, 0.0),
        (4.0, -0.12, 0.3),
        (6.0, 0.15, -0.7),
        (5.0, 0.0, 1.0),
    ] {
        let outline = outline_heights(swinging_body(mm, deflection), sine);
        let radius = f64::from(outline_radius(outline));
        // Chords of the two half ellipses, in radii of the disc, by the midpoint rule in the angle.
        let steps = 4000;
        let sum: f64 = (0..steps)
            .map(|i| {
                let angle = PI * (f64::from(i) + 0.5) / f64::from(steps);
                angle.sin() * angle.sin() * PI / f64::from(steps)
            })
            .sum::<f64>()
            * f64::from(outline[0] + outline[1]);
        area.absolute(sum * radius * radius / PI, 1.0, || format!("{mm} {deflection} {sine}"));
    }
    area.assert_below(3e-7, 5);
    // Over a period the mean width is that at rest.
    for mm in [2.0_f32, 4.0, 6.0] {
        let radius = |turns: f64| {
            let deflection = Oscillation::sustained(mm.into(), turns).deflections()[0];
            f64::from(outline_radius(outline_heights(
                swinging_body(mm, deflection as f32),
                0.0,
            )))
        };
        let mean = (0..64).map(|i| radius(f64::from(i) / 64.0)).sum::<f64>() / 64.0;
        assert!((mean / radius(0.0) - 1.0).abs() < 0.01, "{mm} mm: {mean}");
        assert!(radius(0.75) / radius(0.25) > 1.03, "{mm} mm swings");
    }
}

#[test]
fn seen_level_an_outline_is_that_of_its_halves() {
    let mut worst = Worst::default();
    let body = swinging_body(4.0, 0.05);
    for sine in [-0.6_f32, 0.0, 0.8] {
        let [up, down] = outline_heights(body, sine);
        let level = f64::from(1.0 - sine * sine).sqrt();
        for (height, known) in [(up, body.upper()), (down, body.lower())] {
            worst.absolute(height.into(), (f64::from(known) * level).hypot(f64::from(sine)), || {
                format!("{sine}")
            });
        }
    }
    worst.assert_below(3e-7, 6);
    // A line that passes the outline passes the body, and the other way round.
    let (view, [up, down]) = (Vec3::NEG_Z, outline_heights(body, 0.0));
    for (height, sign) in [(up, 1.0), (down, -1.0)] {
        for x in [-0.9_f32, 0.0, 0.4] {
            let rim = sign * height * (1.0 - x * x).sqrt();
            assert!(body.enter(Vec3::new(x, 0.999 * rim, 0.0), view).is_some());
            assert!(body.enter(Vec3::new(x, 1.001 * rim, 0.0), view).is_none());
        }
    }
}

#[test]
fn a_crossing_is_that_of_small_steps() {
    let outline = [0.9, 0.65];
    let inside = |p: Vec2| {
        let y = p.y / if p.y < 0.0 { outline[1] } else { outline[0] };
        p.x * p.x + y * y < 1.0
    };
    let mut compared = 0;
    let mut worst = Worst::default();
    for i in 0..60 {
        let angle = 0.7 * f64::from(i);
        let path = Vec2::new(angle.cos() as f32, angle.sin() as f32);
        let point = Vec2::new(
            (0.9 * (2.1 * f64::from(i)).sin()) as f32,
            (0.8 * (1.3 * f64::from(i)).cos()) as f32,
        );
        let steps = 400_000;
        let times: Vec<f32> = (0..steps)
            .map(|k| 8.0 * (k as f32 + 0.5) / steps as f32 - 4.0)
            .filter(|t| inside(point - *t * path))
            .collect();
        let Some([first, last]) = time_inside(point, path, outline) else {
            assert!(times.len() < 3, "{point} along {path}");
            continue;
        };
        compared += 1;
        // Half a step of the search is its own error, and rounding beside it.
        worst.absolute(first.into(), f64::from(times[0]) - 1e-5, || {
            format!("{point} along {path}")
        });
        worst.absolute(last.into(), f64::from(times[times.len() - 1]) + 1e-5, || {
            format!("{point} along {path}")
        });
    }
    worst.assert_below(2.0 * 1e-5, 60);
    assert!(compared > 40);
    assert!(time_inside(Vec2::new(1.2, 0.0), Vec2::Y, outline).is_none());
}

#[test]
fn a_drop_shows_165_degrees_of_its_surroundings_upside_down() {
    let round = DropBody::new(1.0, 1.0);
    let view = Vec3::NEG_Z;
    // Degrees by which the straight ray of a place is turned from the line of sight, up and to the right.
    let turned = |body: DropBody, x: f32, y: f32| {
        let normal = body.enter(Vec3::new(x, y, 0.0), view).expect("hit");
        let ray = body.rays::<3>(view, normal, WATER_INDEX).expect("unit vectors")[1].direction;
        (ray.y.atan2(-ray.z).to_degrees(), ray.x.atan2(-ray.z).to_degrees())
    };
    let (top, bottom) = (turned(round, 0.0, 0.9999).0, turned(round, 0.0, -0.9999).0);
    assert!((bottom - top - 165.0).abs() < 3.0 && top < 0.0, "{top} to {bottom}");
    let (left, right) = (turned(round, -0.9999, 0.0).1, turned(round, 0.9999, 0.0).1);
    assert!((left - right - 165.0).abs() < 3.0 && right < 0.0, "{left} to {right}");
    for mm in [1.0, 2.0, 4.0] {
        for deflection in [-0.1, 0.0, 0.1] {
            let body = swinging_body(mm, if mm > 1.0 { deflection } else { 0.0 });
            for y in [0.2, 0.4, 0.55] {
                let (above, below) = (turned(body, 0.1, y).0, turned(body, 0.1, -y).0);
                assert!(above < 0.0 && below > 0.0, "{mm} mm: {above} above, {below} below");
            }
        }
    }
}

#[test]
fn lobes_hold_all_their_light() {
    let (mut sum_error, mut worst) = (Worst::default(), Worst::default());
    for sharpness in [0.5_f32, 3.0, 30.0, 100.0] {
        let steps = 400_000;
        let sum: f64 = (0..steps)
            .map(|i| f64::from(light_lobe(2.0 * (i as f32 + 0.5) / steps as f32 - 1.0, sharpness)))
            .sum::<f64>()
            * TAU
            * 2.0
            / f64::from(steps);
        sum_error.absolute(sum, 1.0, || format!("{sharpness}"));
        for cosine in [-1.0_f32, -0.3, 0.4, 0.99, 1.0] {
            let (c, k) = (f64::from(cosine), f64::from(sharpness));
            let known = k / (TAU * (1.0 - (-2.0 * k).exp())) * (k * (c - 1.0)).exp();
            worst.relative(light_lobe(cosine, sharpness).into(), known, 1e-30, || {
                format!("{cosine} {sharpness}")
            });
        }
    }
    sum_error.assert_below(1e-5, 4);
    // A difference from 1 that is rounded to single precision, times the sharpness.
    worst.assert_below(2e-5, 20);
}

#[test]
fn near_and_far_drops_send_as_much_light() {
    // Even light: what the three rays bring, over the disc, against 95 % of it in the mean of far drops.
    for (mm, elevation) in [(1.0_f32, 0.0_f32), (3.0, 0.2), (5.0, -0.2)] {
        let view = Vec3::new(0.0, elevation.sin(), -elevation.cos());
        let seen = disc(swinging_body(mm, 0.0), view, 120);
        let mean = seen
            .iter()
            .map(|(_, rays)| f64::from(rays.iter().map(|ray| ray.weight).sum::<f32>()))
            .sum::<f64>()
            / seen.len() as f64;
        assert!((0.962 * mean / 0.95 - 1.0).abs() < 0.05, "{mm} mm: {mean}");
    }
    // A distant light: mean over the disc against that of a sphere, within a cone about the line of sight.
    let spread = 0.15_f32;
    for (mm, allowed) in [(1.0_f32, 0.08), (2.0, 0.12), (4.0, 0.3)] {
        let seen = disc(swinging_body(mm, 0.0), Vec3::NEG_Z, 100);
        let mean_at = |theta: f64, azimuth: f64| {
            let light = Vec3::new(
                (theta.sin() * azimuth.cos()) as f32,
                (theta.sin() * azimuth.sin()) as f32,
                -theta.cos() as f32,
            );
            let sum: f64 = seen
                .iter()
                .map(|(_, rays)| f64::from(drop_glint(rays, light, 1.0 / (spread * spread))))
                .sum();
            sum / seen.len() as f64
        };
        let (steps, turns) = (24, 16);
        let cone = 0.9;
        let mut sum = 0.0;
        for i in 0..steps {
            let theta = cone * (f64::from(i) + 0.5) / f64::from(steps);
            for k in 0..turns {
                let azimuth = TAU * (f64::from(k) + 0.5) / f64::from(turns);
                sum += mean_at(theta, azimuth) * theta.sin() * cone / f64::from(steps) * TAU / f64::from(turns);
            }
        }
        let known = 0.884 * disc_share_within(cone, WATER_INDEX.into());
        assert!((sum / known - 1.0).abs() < allowed, "{mm} mm: {sum}, a sphere {known}");
    }
}

#[test]
fn patterns_go_by_view_and_light_angles() {
    let body = swinging_body(3.0, 0.0);
    let across: Vec<f32> = (-19_i8..=19).map(|i| 0.05 * f32::from(i)).collect();
    let pattern = |body: DropBody, view: f32, elevation: f32, azimuth: f32| -> Vec<f32> {
        let angles = StreakAngles {
            view_elevation_rad: view,
            light_elevation_rad: elevation,
            light_azimuth_rad: azimuth,
        };
        across.iter().map(|x| streak_pattern(body, &angles, *x, 0.12)).collect()
    };
    let peak = |pattern: &[f32]| -> (f32, f32) {
        across
            .iter()
            .zip(pattern)
            .fold((0.0, 0.0), |best, (x, v)| if *v > best.1 { (*x, *v) } else { best })
    };
    // A light to the right shines on the left of the drop, further out the further it stands.
    let mut last = 0.0;
    for azimuth in [0.2, 0.5, 0.8] {
        let right = pattern(body, 0.0, 0.1, azimuth);
        let (at, value) = peak(&right);
        assert!(at < last && value > 0.0, "{azimuth}: {at}");
        last = at;
        // The other side is its mirror picture.
        let left = pattern(body, 0.0, 0.1, -azimuth);
        for (a, b) in right.iter().zip(left.iter().rev()) {
            assert!((a - b).abs() < 2e-3 * value, "{azimuth}: {a} {b}");
        }
    }
    // A light behind the drop stands on the axis; one behind the eye shines far less.
    let (at, ahead) = peak(&pattern(body, 0.0, 0.0, 0.0));
    assert!(at.abs() < 0.06, "{at}");
    assert!(peak(&pattern(body, 0.0, 0.2, core::f32::consts::PI)).1 < 0.2 * ahead);
    // Each of the three angles and the swing make a pattern of their own, and neighbours pass into each other.
    let reference = pattern(body, 0.0, 0.3, 0.4);
    let difference = |other: &[f32]| {
        let off: f32 = reference.iter().zip(other).map(|(a, b)| (a - b).abs()).sum();
        off / reference.iter().sum::<f32>()
    };
    for (other, near) in [
        (pattern(body, 0.4, 0.3, 0.4), pattern(body, 0.004, 0.3, 0.4)),
        (pattern(body, 0.0, 0.7, 0.4), pattern(body, 0.0, 0.304, 0.4)),
        (pattern(body, 0.0, 0.3, 0.8), pattern(body, 0.0, 0.3, 0.404)),
        (
            pattern(swinging_body(3.0, 0.15), 0.0, 0.3, 0.4),
            pattern(swinging_body(3.0, 0.0015), 0.0, 0.3, 0.4),
        ),
    ] {
        let (far, near) = (difference(&other), difference(&near));
        assert!(far > 0.08 && near < 0.05 && near < 0.2 * far, "{far} {near}");
    }
    // Directions are those of the angles.
    let angles = StreakAngles {
        view_elevation_rad: -0.3,
        light_elevation_rad: 0.5,
        light_azimuth_rad: 0.7,
    };
    let [view, light] = angles.directions();
    assert!((view - Vec3::new(0.0, -0.3_f32.sin(), -0.3_f32.cos())).length() < 3e-7);
    let known = Vec3::new(
        0.5_f32.cos() * 0.7_f32.sin(),
        0.5_f32.sin(),
        -0.5_f32.cos() * 0.7_f32.cos(),
    );
    assert!((light - known).length() < 3e-7);
}

#[test]
fn near_streaks_answer_every_number() {
    for bad in NOT_NUMBERS {
        let single = bad as f32;
        for body in [swinging_body(single, 0.1), swinging_body(3.0, single)] {
            assert!(body.upper().is_finite() && body.lower() > 0.0);
        }
        assert!(swing_at(bad, 0.1, 1.0, 5.0).abs() <= 0.15 && swing_at(3.0, bad, 1.0, 5.0).abs() <= 0.15);
        assert!(swing_at(3.0, 0.1, bad, 5.0).abs() <= 0.15 && swing_at(3.0, 0.1, 1.0, bad).abs() <= 0.15);
        let outline = outline_heights(swinging_body(3.0, 0.0), single);
        assert!(outline.iter().all(|h| *h > 0.0 && *h <= 1.0));
        assert!(outline_radius([single, 0.8]) > 0.0);
        assert!(time_inside(Vec2::splat(single), Vec2::Y, [0.9, single]).is_none_or(|[a, b]| a < b));
        assert!(time_inside(Vec2::ZERO, Vec2::new(0.0, single), [0.9, 0.8]).is_none_or(|[a, b]| a < b));
        assert!(light_lobe(single, 10.0).is_finite() && light_lobe(0.5, single).is_finite());
        let angles = StreakAngles {
            view_elevation_rad: single,
            light_elevation_rad: single,
            light_azimuth_rad: single,
        };
        assert!(streak_pattern(swinging_body(3.0, 0.0), &angles, single, single) >= 0.0);
    }
    assert!(time_inside(Vec2::ZERO, Vec2::ZERO, [0.9, 0.8]).is_none());
}
