//! Lightning and thunder: how many flashes, how their paths turn, what they send and what is heard.

use glam::{DVec2, DVec3};
use rain_core::lightning::{
    Channel, Flash, FlashKind, FlashLight, LONGEST_FLASH_S, LUMENS_PER_M_A, LightningSettings, THUNDER_STEPS, Thunder,
    for_each_flash, mean_turn_rad, sound_speed_m_s, thunder_reach_m,
};
use rain_reference::lightning as reference;

use crate::check::Worst;

fn storm(flashes_per_km2_min: f64) -> LightningSettings {
    LightningSettings {
        flashes_per_km2_min,
        ..LightningSettings::default()
    }
}

fn flashes(settings: &LightningSettings, seed: u64, from_s: f64, to_s: f64) -> Vec<Flash> {
    let mut found = Vec::new();
    for_each_flash(settings, seed, from_s, to_s, |flash| found.push(flash));
    found
}

/// Flashes of a kind.
fn some(kind: FlashKind, count: usize) -> Vec<Flash> {
    let mut found = flashes(&storm(0.15), 5, 0.0, 4000.0);
    found.retain(|flash| flash.kind == kind);
    found.truncate(count);
    assert_eq!(found.len(), count);
    found
}

fn corners(path: &[DVec3]) -> Vec<[f64; 3]> {
    path.iter().map(|p| p.to_array()).collect()
}

#[test]
fn flashes_are_as_many_as_set_and_the_same_however_time_is_cut() {
    let settings = storm(0.02);
    let mean = settings.flashes_per_s();
    assert!((mean - 0.02 * core::f64::consts::PI * 144.0 / 60.0).abs() < 1e-12);
    let seconds = 20_000;
    let all = flashes(&settings, 3, 0.0, f64::from(seconds));
    let mut counts = vec![0_usize; seconds as usize];
    for flash in &all {
        counts[flash.time_s as usize] += 1;
    }
    // The chance of each count is Poisson's.
    let mut chance = (-mean).exp();
    for k in 0..4_usize {
        let found = counts.iter().filter(|count| **count == k).count() as f64;
        let expected = chance * f64::from(seconds);
        let deviation = (expected * (1.0 - chance)).sqrt();
        assert!((found - expected).abs() < 5.0 * deviation, "{k}: {found}, {expected}");
        chance *= mean / (k + 1) as f64;
    }
    // Half the rate keeps half of them; another seed has others.
    let fewer = flashes(&storm(0.01), 3, 0.0, f64::from(seconds));
    assert!(fewer.iter().all(|flash| {
        all.iter()
            .any(|other| other.id == flash.id && other.time_s == flash.time_s)
    }));
    let share = fewer.len() as f64 / all.len() as f64;
    assert!((share - 0.5).abs() < 0.03, "{share}");
    assert!(flashes(&settings, 4, 0.0, 100.0) != flashes(&settings, 3, 0.0, 100.0));
    // Cut anywhere: the same flashes.
    let mut cut = Vec::new();
    let mut from = 0.0;
    for i in 0..400_u32 {
        let to = from + 0.013 + f64::from(i % 7) * 0.31;
        cut.extend(flashes(&settings, 3, from, to));
        from = to;
    }
    let mut whole = flashes(&settings, 3, 0.0, from);
    let by_time = |a: &Flash, b: &Flash| a.time_s.total_cmp(&b.time_s);
    cut.sort_by(by_time);
    whole.sort_by(by_time);
    assert!(whole.len() > 50 && cut == whole, "{} {}", cut.len(), whole.len());
    let nothing = |from: f64, to: f64| flashes(&settings, 3, from, to).is_empty();
    assert!(nothing(5.0, 5.0) && nothing(9.0, 2.0) && nothing(f64::NAN, f64::NAN) && nothing(-50.0, 0.0));
    assert!(nothing(0.0, f64::INFINITY) && flashes(&storm(0.0), 3, 0.0, 1000.0).is_empty());
}

#[test]
fn flashes_lie_in_their_disc_which_moves() {
    let settings = LightningSettings {
        centre_m: DVec2::new(500.0, -300.0),
        velocity_m_s: DVec2::new(8.0, 3.0),
        radius_m: 6000.0,
        nearest_m: 900.0,
        flashes_per_km2_min: 0.5,
        ..LightningSettings::default()
    };
    let all = flashes(&settings, 11, 0.0, 600.0);
    let off = |flash: &Flash| {
        let centre = settings.centre_at(flash.time_s);
        DVec2::new(flash.place_m.x, flash.place_m.z).distance(centre)
    };
    let struck: Vec<&Flash> = all.iter().filter(|flash| flash.kind == FlashKind::ToGround).collect();
    assert!(all.iter().all(|flash| off(flash) <= 6000.0));
    assert!(struck.iter().all(|flash| off(flash) >= 900.0 - 1e-6));
    // Even over the disc: half of the area lies within the radius over √2.
    let inner = all.iter().filter(|flash| off(flash) < 6000.0 / 2.0_f64.sqrt()).count() as f64 / all.len() as f64;
    let share = struck.len() as f64 / all.len() as f64;
    assert!(
        (inner - 0.5).abs() < 0.05 && (share - 0.27).abs() < 0.05,
        "{inner} {share}"
    );
}

#[test]
fn strokes_are_as_many_and_as_far_apart_as_measured() {
    let struck = some(FlashKind::ToGround, 900);
    let count: f64 = struck.iter().map(|flash| flash.strokes().len() as f64).sum::<f64>() / 900.0;
    // Thomson et al. 1984: 4.0; at most 15 take 1 % off.
    assert!((count / 4.0 - 1.0).abs() < 0.08, "{count}");
    let gaps: Vec<f64> = struck
        .iter()
        .flat_map(|flash| {
            flash
                .strokes()
                .windows(2)
                .map(|s| (s[1].after_s - s[0].after_s, s[0].continuing_s))
        })
        .filter(|(_, continuing)| *continuing == 0.0)
        .map(|(gap, _)| gap.log10())
        .collect();
    let mean = gaps.iter().sum::<f64>() / gaps.len() as f64;
    let deviation = (gaps.iter().map(|g| (g - mean).powi(2)).sum::<f64>() / gaps.len() as f64).sqrt();
    assert!((10_f64.powf(mean) / 0.069 - 1.0).abs() < 0.05, "{}", 10_f64.powf(mean));
    assert!((deviation - 0.32).abs() < 0.02, "{deviation}");
    let median = |later: bool| {
        let mut peaks: Vec<f64> = struck
            .iter()
            .flat_map(|flash| flash.strokes().iter().enumerate())
            .filter_map(|(index, stroke)| ((index > 0) == later).then_some(stroke.peak_a))
            .collect();
        peaks.sort_by(f64::total_cmp);
        peaks[peaks.len() / 2]
    };
    assert!((median(false) / 30e3 - 1.0).abs() < 0.1 && (median(true) / 12e3 - 1.0).abs() < 0.1);
    for flash in struck.iter().chain(&some(FlashKind::InCloud, 300)) {
        assert!(flash.duration_s() <= LONGEST_FLASH_S && flash.strokes()[0].after_s == 0.0);
        assert!(
            flash
                .strokes()
                .windows(2)
                .all(|s| s[1].after_s >= s[0].after_s + s[0].continuing_s)
        );
    }
}

#[test]
fn mean_currents_are_those_of_their_strokes_summed() {
    let mut worst = Worst::default();
    let mut bent = Worst::default();
    for flash in some(FlashKind::ToGround, 12) {
        let peak = flash.strokes().iter().fold(0.0_f64, |most, s| most.max(s.peak_a));
        for (from, to) in [
            (-0.01, 0.0066),
            (0.0, 0.0001),
            (0.0001, 0.0168),
            (0.05, 0.0667),
            (-1.0, 4.0),
            (0.09, 0.3),
        ] {
            let [all, first] = flash.mean_current_a(flash.time_s + from, flash.time_s + to);
            let sum: f64 = flash
                .strokes()
                .iter()
                .map(|s| reference::mean_current(s.peak_a, s.continuing_s, from - s.after_s, to - s.after_s))
                .sum();
            worst.absolute(all / peak, sum / peak, || format!("{} from {from}", flash.id));
            bent.absolute(all / peak, 1.1 * sum / peak, || format!("{} from {from}", flash.id));
            let of_first = reference::mean_current(flash.strokes()[0].peak_a, 0.0, from, to);
            worst.absolute(first / peak, of_first / peak, || {
                format!("first of {} from {from}", flash.id)
            });
        }
        // Two halves make the whole; after it there is nothing.
        let [whole, half, rest] = [(0.0, 0.02), (0.0, 0.007), (0.007, 0.02)]
            .map(|(a, b)| (b - a) * flash.mean_current_a(flash.time_s + a, flash.time_s + b)[0]);
        assert!((half + rest - whole).abs() < 1e-9 * peak);
        let over = flash.time_s + flash.duration_s();
        assert!(flash.mean_current_a(over, over + 0.02)[0] < 1.0, "{}", flash.id);
        assert_eq!(flash.mean_current_a(2.0, 2.0), [0.0; 2]);
        assert_eq!(flash.mean_current_a(f64::NAN, 2.0), [0.0; 2]);
    }
    // Times of some 10³ s leave 10⁻¹³ s of a pulse of 10⁻⁴ s.
    worst.assert_below(1e-8, 100);
    assert!(bent.error > 1e-3, "a wrong current is found");
}

#[test]
fn channels_turn_by_sixteen_degrees_at_every_scale() {
    let mut angles = [0.0; 3];
    let channels: Vec<Channel> = some(FlashKind::ToGround, 200).iter().map(Channel::of).collect();
    for channel in &channels {
        for (angle, step) in angles.iter_mut().zip([1, 4, 16]) {
            *angle += mean_turn_rad(channel.seen(), step).to_degrees() / 200.0;
        }
    }
    // Hill 1968: 16°, whatever the length of the pieces.
    assert!((angles[0] - 16.0).abs() < 1.0, "{angles:?}");
    assert!(
        angles.iter().all(|angle| (angle / 16.0 - 1.0).abs() < 0.2),
        "{angles:?}"
    );
    // A corner of 90° and none.
    let corner = [
        DVec3::ZERO,
        DVec3::X,
        DVec3::new(1.0, 2.0, 0.0),
        DVec3::new(1.0, 4.0, 0.0),
    ];
    assert!((mean_turn_rad(&corner, 1) - core::f64::consts::FRAC_PI_4).abs() < 1e-12);
    assert_eq!((mean_turn_rad(&corner, 0), mean_turn_rad(&corner[..2], 1)), (0.0, 0.0));
}

#[test]
fn channels_join_ground_and_cloud_and_are_the_same_again() {
    for flash in some(FlashKind::ToGround, 60) {
        let channel = Channel::of(&flash);
        assert_eq!(channel, Channel::of(&flash));
        assert_eq!(channel.seen()[0], flash.place_m);
        let top = channel.seen().last().expect("a point");
        assert!((top.y - flash.place_m.y - flash.cloud_base_m).abs() < 1e-6);
        assert_eq!(channel.hidden()[0], *top);
        assert!(channel.branches().len() >= 4);
        for branch in channel.branches() {
            assert!(branch.iter().all(|p| p.y >= flash.place_m.y && p.is_finite()));
        }
        let joined =
            |p: &DVec3| channel.main().contains(p) || channel.branches().iter().any(|other| other[1..].contains(p));
        assert!(channel.branches().iter().all(|branch| joined(&branch[0])));
    }
    for flash in some(FlashKind::InCloud, 60) {
        let channel = Channel::of(&flash);
        assert!(channel.seen().is_empty() && channel.branches().is_empty());
        assert!(
            channel
                .main()
                .iter()
                .all(|p| p.y > flash.place_m.y + flash.cloud_base_m)
        );
    }
}

#[test]
fn all_light_of_a_channel_arrives_somewhere() {
    let mut worst = Worst::default();
    let mut glow = Worst::default();
    for flash in some(FlashKind::ToGround, 8) {
        let channel = Channel::of(&flash);
        for (x, z) in [(600.0, 0.0), (-900.0, 1500.0), (4000.0, -2500.0), (0.0, 12_000.0)] {
            let place = flash.place_m + DVec3::new(x, 1.7, z);
            let found = FlashLight::at(&flash, &channel, place);
            let main = LUMENS_PER_M_A * reference::line_illuminance(&corners(channel.seen()), place.to_array());
            let branches: f64 = channel
                .branches()
                .iter()
                .map(|branch| 0.3 * LUMENS_PER_M_A * reference::line_illuminance(&corners(branch), place.to_array()))
                .sum();
            let at = || format!("{} from {x} {z}", flash.id);
            worst.relative(found.direct_lux_a[0], main, 0.0, at);
            worst.relative(found.direct_lux_a[1], branches, 0.0, at);
            let mean = place.distance(flash.place_m + 600.0 * DVec3::Y);
            assert!(
                (found.distance_m / mean - 1.0).abs() < 0.35,
                "{} {mean}",
                found.distance_m
            );
            assert!(found.towards.is_normalized() && found.towards.y > 0.0);
        }
        // What leaves the base lands on the plain: a tenth of what the channel sends in the cloud.
        let centre = channel.glow_centre();
        let (mut landed, rings) = (0.0, 400);
        for ring in 0..rings {
            let r = 100.0 * 1.015_f64.powi(ring);
            for i in 0..8 {
                let (sin, cos) = (f64::from(i) * core::f64::consts::FRAC_PI_4).sin_cos();
                let place = DVec3::new(centre.x + r * cos, flash.place_m.y, centre.z + r * sin);
                let area = core::f64::consts::TAU / 8.0 * r * r * 1.015_f64.ln();
                landed += FlashLight::at(&flash, &channel, place).glow_lux_a * area;
            }
        }
        let length: f64 = channel.hidden().windows(2).map(|p| p[0].distance(p[1])).sum();
        glow.relative(landed, 0.1 * LUMENS_PER_M_A * length, 0.0, || format!("{}", flash.id));
    }
    worst.assert_below(2e-3, 60);
    glow.assert_below(0.03, 8);
    let flash = some(FlashKind::InCloud, 1)[0];
    let light = FlashLight::at(&flash, &Channel::of(&flash), flash.place_m);
    assert!(light.direct_lux_a == [0.0; 2] && light.glow_lux_a > 0.0 && light.glow_cd_m2_a > 0.0);
    let dark = FlashLight::at(&flash, &Channel::of(&flash), DVec3::NAN);
    assert_eq!((dark.glow_lux_a, dark.direct_lux_a), (0.0, [0.0; 2]));
}

#[test]
fn a_stroke_near_by_outshines_street_lamps() {
    // 30 kA at 1 km, in a frame of 1/60 s: some hundreds of lux; street lamps give ten.
    let settings = storm(0.5);
    let near = flashes(&settings, 2, 0.0, 600.0)
        .into_iter()
        .find(|flash| flash.kind == FlashKind::ToGround && (25e3..35e3).contains(&flash.strokes()[0].peak_a))
        .expect("one of many");
    let light = FlashLight::at(&near, &Channel::of(&near), near.place_m + 1000.0 * DVec3::X);
    let [main, first] = near.mean_current_a(near.time_s, near.time_s + 1.0 / 60.0);
    let lux = main * light.direct_lux_a[0] + first * light.direct_lux_a[1];
    assert!((100.0..1000.0).contains(&lux), "{lux}");
}

#[test]
fn sound_goes_at_the_speed_of_an_ideal_gas_and_is_bent_off_the_ground() {
    let (mut speed, mut reach, mut traced) = (Worst::default(), Worst::default(), Worst::default());
    for i in 0..=30_u32 {
        let celsius = -60.0 + 4.0 * f64::from(i);
        let own = (1.4_f64 * 287.05 * (celsius + 273.15)).sqrt();
        speed.relative(sound_speed_m_s(celsius), own, 0.0, || format!("{celsius}"));
        assert!((sound_speed_m_s(celsius) / reference::sound_speed(celsius) - 1.0).abs() < 1e-4);
        for height in [1.0, 50.0, 400.0, 1500.0, 4000.0] {
            let kelvin = celsius + 273.15;
            let formula = 2.0 * (kelvin * height / 0.0075).sqrt();
            reach.relative(thunder_reach_m(height, 0.0, celsius), formula, 0.0, || {
                format!("{height} {celsius}")
            });
            let ray = reference::grazing_ray(height, kelvin, 0.0075);
            traced.relative(thunder_reach_m(height, 0.0, celsius), ray, 0.0, || {
                format!("{height} {celsius}")
            });
        }
    }
    speed.assert_below(1e-15, 31);
    reach.assert_below(1e-14, 150);
    traced.assert_below(0.03, 150);
    // 331 m/s at 0 °C, 343 at 20 °C; Fleagle 1949: 25 km from 4 km.
    assert!((sound_speed_m_s(0.0) - 331.3).abs() < 0.1 && (sound_speed_m_s(20.0) - 343.2).abs() < 0.1);
    assert!((thunder_reach_m(4000.0, 0.0, 15.0) / 25e3 - 1.0).abs() < 0.02);
    assert_eq!(
        thunder_reach_m(100.0, 100.0, 15.0),
        2.0 * thunder_reach_m(100.0, -5.0, 15.0)
    );
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(sound_speed_m_s(bad).is_finite() && thunder_reach_m(bad, bad, bad).is_finite());
    }
}

#[test]
fn thunder_comes_from_the_nearest_piece_and_lasts_to_the_farthest() {
    let air_c = 12.0;
    let speed = reference::sound_speed(air_c);
    let mut levels = Vec::new();
    for flash in some(FlashKind::ToGround, 40) {
        let channel = Channel::of(&flash);
        let mut before = f64::INFINITY;
        for away in [500.0, 1500.0, 4000.0, 9000.0, 15_000.0] {
            let ear = flash.place_m + DVec3::new(away, 1.7, 0.0);
            let Some(thunder) = Thunder::heard(&flash, &channel, ear, air_c) else {
                panic!("within 15 km all is heard")
            };
            // Nothing arrives before the nearest of all points could, nor after the farthest.
            let far = |p: &DVec3| reference::distance(p.to_array(), ear.to_array());
            let nearest = channel.main().iter().map(far).fold(f64::INFINITY, f64::min);
            let farthest = channel.main().iter().map(far).fold(0.0, f64::max);
            assert!(thunder.delay_s * speed > nearest - 60.0, "{thunder:?} {nearest}");
            assert!((thunder.delay_s + thunder.duration_s) * speed < farthest + 60.0);
            if away < 2000.0 {
                assert!(thunder.delay_s * speed < nearest + 60.0, "{thunder:?} {nearest}");
            }
            assert!((thunder.delay_s * speed / thunder.distance_m - 1.0).abs() < 1e-4);
            let shares: f32 = thunder.course.iter().sum();
            assert!((shares - 1.0).abs() < 1e-5 && thunder.course.len() == THUNDER_STEPS);
            assert!(thunder.exposure_j_m2 < before, "quieter farther away");
            before = thunder.exposure_j_m2;
            if away == 1500.0 {
                levels.push(thunder.level_db);
            }
            // Its loudest moment is its level.
            let steps = (0..THUNDER_STEPS).map(|i| (i as f64 + 0.5) / THUNDER_STEPS as f64 * thunder.duration_s);
            let loudest = steps.filter_map(|t| thunder.level_at(t)).fold(0.0, f64::max);
            assert!((loudest - thunder.level_db).abs() < 1e-4, "{loudest} {thunder:?}");
            assert_eq!(thunder.level_at(-0.1), None);
            assert_eq!(thunder.level_at(thunder.duration_s + 0.1), None);
        }
        // Far away the low part is silent, and at last all of it.
        let ear = flash.place_m + 20_000.0 * DVec3::X;
        if let Some(thunder) = Thunder::heard(&flash, &channel, ear, air_c) {
            assert!(thunder.from_m.y - flash.place_m.y > 1500.0, "{thunder:?}");
        }
        assert_eq!(
            Thunder::heard(&flash, &channel, flash.place_m + 60e3 * DVec3::X, air_c),
            None
        );
        assert_eq!(Thunder::heard(&flash, &channel, DVec3::NAN, air_c), None);
    }
    levels.sort_by(f64::total_cmp);
    // Loud at 1.5 km: some 90 to 110 dB.
    assert!((85.0..115.0).contains(&levels[20]), "{levels:?}");
}
