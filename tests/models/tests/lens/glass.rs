//! A glass over time: its ledger, what runs, what is wiped.

use glam::DVec3;
use rain_core::constants::GRAVITY;
use rain_core::lens::{Glass, GlassForcing, GlassImpacts, GlassShape, MAX_GLASS_DROPS, WiperArm, WiperMode};
use rain_core::rainfall::{Distribution, Spectrum};

const SHAPE: GlassShape = GlassShape { half_m: [0.5, 0.3] };

fn on_windscreen(rate: f64, speed: f64) -> GlassImpacts {
    let spectrum = Spectrum::new(Distribution::MarshallPalmer, rate).expect("a rate");
    let normal = DVec3::new(0.0, 60_f64.to_radians().cos(), -60_f64.to_radians().sin());
    GlassImpacts::new(&spectrum, normal, DVec3::new(0.0, 0.0, speed), 1.0)
}

fn upright(impacts: &GlassImpacts) -> GlassForcing<'_> {
    GlassForcing {
        impacts,
        exposure: 1.0,
        gravity_m_s2: [0.0, -GRAVITY],
        air_m_s: [0.0; 2],
        stagnation_m_s: 0.0,
        deficit_kg_m3: 4e-3,
        mode: WiperMode::Off,
    }
}

/// Water that is not accounted for, as a share of what arrived.
fn missing(glass: &Glass) -> f64 {
    let l = glass.ledger();
    let gone = l.left_m3 + l.wiped_m3 + l.dried_m3;
    (l.arrived_m3 - gone - glass.water_m3()).abs() / l.arrived_m3
}

fn arm() -> WiperArm {
    WiperArm {
        pivot_m: [0.0, -0.35],
        blade_m: [0.05, 0.5],
        turn_rad: [3.0, 0.2],
    }
}

#[test]
fn water_on_a_glass_is_accounted_for() {
    let impacts = on_windscreen(25.0, 0.0);
    let mut glass = Glass::new(7);
    glass.wipers.arms[0] = Some(arm());
    let mut forcing = upright(&impacts);
    for second in 0..60 {
        forcing.mode = if second > 30 { WiperMode::Slow } else { WiperMode::Off };
        for _ in 0..32 {
            glass.advance(&SHAPE, &forcing, 1.0 / 32.0);
        }
        assert!(missing(&glass) <= 1e-12, "{second}: {:?}", glass.ledger());
        assert!(glass.drops().len() <= MAX_GLASS_DROPS);
    }
    let l = *glass.ledger();
    assert!(l.left_m3 > 0.0 && l.wiped_m3 > 0.0 && l.dried_m3 > 0.0, "{l:?}");
    // The share of the flux that is followed.
    let single = (300.0 / (impacts.number_per_m2_s * 0.6)).min(1.0);
    assert!(
        single < 1.0 && l.arrived_m3 > 0.3 * impacts.water_m_s * 0.6 * 60.0,
        "{single} {l:?}"
    );
}

#[test]
fn the_same_seed_wets_a_glass_alike() {
    let impacts = on_windscreen(10.0, 15.0);
    let run = |seed| {
        let mut glass = Glass::new(seed);
        for _ in 0..200 {
            glass.advance(&SHAPE, &upright(&impacts), 1.0 / 32.0);
        }
        glass
    };
    assert_eq!(run(3), run(3));
    assert_ne!(run(3), run(4));
    let mut glass = run(3);
    let before = glass.clone();
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        glass.advance(&SHAPE, &upright(&impacts), bad);
    }
    assert_eq!(glass, before);
}

#[test]
fn impacts_on_a_glass_are_as_many_as_fall() {
    // A small upright lens in gusts: all impacts are followed. Over many seeds the mean number is the flux.
    let spectrum = Spectrum::new(Distribution::MarshallPalmer, 25.0).expect("a rate");
    let impacts = GlassImpacts::new(&spectrum, DVec3::NEG_Z, DVec3::ZERO, 1.0);
    let shape = GlassShape { half_m: [0.04, 0.03] };
    let mut volume = 0.0;
    let seeds = 400;
    for seed in 0..seeds {
        let mut glass = Glass::new(seed);
        glass.advance(&shape, &upright(&impacts), 8.0);
        volume += glass.ledger().arrived_m3;
    }
    let wanted = impacts.water_m_s * 4.0 * 0.04 * 0.03 * 8.0 * f64::from(seeds);
    // Some 10^4 drops whose volumes scatter by twice their mean: 2 % of deviation, five of them.
    assert!((volume / wanted - 1.0).abs() < 0.1, "{volume}, not {wanted}");
}

#[test]
fn large_drops_run_down_and_air_drives_them_up_and_out() {
    let heavy = on_windscreen(100.0, 0.0);
    let after = |forcing: &GlassForcing| {
        let mut glass = Glass::new(1);
        for _ in 0..320 {
            glass.advance(&SHAPE, forcing, 1.0 / 32.0);
        }
        glass
    };
    let still = after(&upright(&heavy));
    let running: Vec<_> = still.drops().iter().filter(|d| d.velocity_m_s != [0.0; 2]).collect();
    assert!(!running.is_empty() && running.iter().all(|d| d.velocity_m_s[1] < 0.0));
    // Smaller drops stay, running ones are the larger.
    let largest_at_rest = still
        .drops()
        .iter()
        .filter(|d| d.velocity_m_s == [0.0; 2])
        .map(|d| d.radius_m)
        .fold(0.0, f64::max);
    assert!(running.iter().all(|d| d.radius_m > 0.9 * largest_at_rest));
    // At speed they climb, and at the sides they go outwards.
    let fast = after(&GlassForcing {
        air_m_s: [0.0, 35.0],
        stagnation_m_s: 30.0,
        ..upright(&heavy)
    });
    let running: Vec<_> = fast.drops().iter().filter(|d| d.velocity_m_s != [0.0; 2]).collect();
    assert!(!running.is_empty() && running.iter().all(|d| d.velocity_m_s[1] > 0.0));
    let mean = |right: bool| {
        let side = running
            .iter()
            .filter(|d| (d.place_m[0] > 0.25) == right && d.place_m[0].abs() > 0.25);
        side.map(|d| d.velocity_m_s[0]).sum::<f64>()
    };
    assert!(mean(true) > 0.0 && mean(false) < 0.0);
}

#[test]
fn wipers_clear_what_they_sweep_and_covered_glass_dries() {
    let impacts = on_windscreen(25.0, 10.0);
    let mut glass = Glass::new(5);
    glass.wipers.arms[0] = Some(arm());
    let mut forcing = upright(&impacts);
    forcing.gravity_m_s2 = [0.0, -0.5 * GRAVITY];
    for _ in 0..320 {
        glass.advance(&SHAPE, &forcing, 1.0 / 32.0);
    }
    let swept = |glass: &Glass| {
        let (mut inside, mut outside) = (0, 0);
        for drop in glass.drops() {
            let (x, y) = (drop.place_m[0], drop.place_m[1] + 0.35);
            let inside_arc = (0.1..0.45).contains(&x.hypot(y)) && (0.4..2.8).contains(&y.atan2(x));
            if inside_arc { inside += 1 } else { outside += 1 }
        }
        (inside, outside)
    };
    let before = swept(&glass);
    forcing.mode = WiperMode::Fast;
    let no_rain = GlassImpacts::default();
    let dry = GlassForcing {
        impacts: &no_rain,
        ..forcing
    };
    for _ in 0..40 {
        glass.advance(&SHAPE, &dry, 1.0 / 32.0);
    }
    let after = swept(&glass);
    assert!(before.0 > 100 && after.0 == 0, "{before:?}, then {after:?}");
    assert!(after.1 > 0, "beside the arc drops stay");
    // Switched off, they end their cycle first.
    let off = GlassForcing {
        mode: WiperMode::Off,
        ..dry
    };
    glass.advance(&SHAPE, &off, 1.0 / 32.0);
    assert!(!glass.wipers.rests() && glass.wipers.mode == WiperMode::Fast);
    for _ in 0..30 {
        glass.advance(&SHAPE, &off, 1.0 / 32.0);
    }
    assert!(glass.wipers.rests() && glass.wipers.mode == WiperMode::Off);
    // Under a roof nothing comes, and what is there dries.
    let roofed = GlassForcing {
        exposure: 0.0,
        mode: WiperMode::Off,
        ..forcing
    };
    let arrived = glass.ledger().arrived_m3;
    glass.advance(&SHAPE, &roofed, 60.0);
    assert!(glass.ledger().arrived_m3 == arrived && !glass.is_dry());
    for _ in 0..100 {
        glass.advance(&SHAPE, &roofed, 3600.0);
    }
    assert!(glass.is_dry(), "{}", glass.drops().len());
    assert!(missing(&glass) <= 1e-12);
}
