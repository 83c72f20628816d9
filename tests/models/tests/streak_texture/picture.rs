//! Layers against the drops of their cube.

use rain_core::error::ConfigError;
use rain_core::rainfall::{
    ClassWeights, Distribution, Spectrum, StreakLayer, StreakTexture, StreakTextureSettings, StreakTextures,
};
use rain_reference::light::haze::geometric_extinction;
use rain_reference::light::streak::texel_opacity;

use super::{small, varied};
use crate::check::Worst;

fn spectrum(distribution: Distribution, intensity: f64) -> Spectrum {
    Spectrum::new(distribution, intensity).expect("a rate")
}

#[test]
fn mean_opacity_is_extinction_times_depth_in_every_layer_and_level() {
    let mut worst = Worst::default();
    let mut levels = Worst::default();
    for settings in varied() {
        let set = StreakTextures::bake(&settings).expect("a set");
        assert_eq!(set.textures.len(), settings.layer_count());
        for texture in &set.textures {
            let layer = &texture.layer;
            let s = spectrum(settings.distribution, layer.intensity_mm_h);
            let sigma = geometric_extinction(s.n0_per_m3_mm, s.slope_per_mm, layer.min_mm, layer.max_mm);
            let expected = 1.0 - (-sigma * settings.tile_m).exp();
            let place = || {
                format!(
                    "{} mm/h, {} mm of {}",
                    layer.intensity_mm_h,
                    layer.min_mm,
                    settings.key_text()
                )
            };
            worst.relative(texture.mean_opacity(0), expected, 1e-12, place);
            worst.relative(layer.mean_opacity(), expected, 1e-12, place);
            assert_eq!(texture.levels.len(), settings.level_count() as usize);
            for level in 1..texture.levels.len() {
                levels.relative(texture.mean_opacity(level), texture.mean_opacity(0), 1e-12, place);
            }
        }
    }
    // A streak longer than the cube overlaps itself.
    worst.assert_below(2e-3, 140);
    // Sums of single-precision means.
    levels.assert_below(1e-6, 500);
}

#[test]
fn a_count_taken_for_a_density_would_be_seen() {
    // The source's equation gives drops per mm of diameter; taken as a number of drops, classes of 0.2 mm hold five
    // times their rain.
    let settings = StreakTextureSettings::yoshida();
    let layers = settings.layers().expect("a set");
    let printed = 8000.0 * (-4.1 * 5.0_f64.powf(-0.21) * 1.0).exp();
    let layer = layers
        .iter()
        .find(|l| l.intensity_mm_h == 5.0 && l.min_mm == 0.9)
        .expect("1 mm at 5 mm/h");
    let ratio = printed / layer.number_per_m3;
    assert!((5.0..6.5).contains(&ratio), "{ratio}");
    // The source's counts with the class width, renormalised to the rate: 85.9 at 5 mm/h and 1 mm.
    assert!(
        (layer.number_per_m3 / 85.9 * 1.1806 - 1.0).abs() < 0.02,
        "{}",
        layer.number_per_m3
    );
}

#[test]
fn texels_are_means_of_the_streaks_over_their_area() {
    // Few texels, so that the slow reference can look at all of them at 24² points each.
    let settings = StreakTextureSettings {
        intensities_mm_h: vec![25.0],
        diameter_edges_mm: vec![1.0, 2.0, 6.0],
        texels: 32,
        tile_m: 0.25,
        exposure_s: 1.0 / 120.0,
        ..small()
    };
    for layer in settings.layers().expect("a set") {
        let texture = StreakTexture::draw(&layer, settings.texels);
        let streaks: Vec<[f64; 4]> = layer
            .tile_drops()
            .iter()
            .map(|d| [d.x, d.y, d.diameter, d.share].map(f64::from))
            .collect();
        let (mut off, mut sum) = (0.0, 0.0);
        for (i, &texel) in texture.levels[0].iter().enumerate() {
            let at = [i as u32 % 32, i as u32 / 32];
            let slow = texel_opacity(&streaks, layer.path_texels(), 32.0, at, 24);
            off += (f64::from(texel) * layer.unit - slow).abs();
            sum += slow;
        }
        assert!(sum > 0.03, "{sum}");
        let error = off / sum;
        assert!(error < 0.03, "{} mm: {error}", layer.min_mm);
        // Streaks a quarter longer are told apart.
        let mut other = 0.0;
        for (i, &texel) in texture.levels[0].iter().enumerate() {
            let at = [i as u32 % 32, i as u32 / 32];
            let slow = texel_opacity(&streaks, 1.25 * layer.path_texels(), 32.0, at, 4);
            other += (f64::from(texel) * layer.unit - slow).abs();
        }
        assert!(other / sum > 0.1, "{}", other / sum);
    }
}

#[test]
fn streaks_that_overlap_let_through_what_both_let_through() {
    // In heavy, short streaks the sum of opacities would be more than what is taken out of the light.
    let settings = StreakTextureSettings {
        intensities_mm_h: vec![500.0],
        diameter_edges_mm: vec![0.5, 6.0],
        texels: 128,
        tile_m: 4.0,
        exposure_s: 1e-3,
        ..small()
    };
    let layer = settings.layers().expect("a set")[0];
    let depth = layer.extinction_per_m * settings.tile_m;
    let texture = StreakTexture::draw(&layer, settings.texels);
    let mean = texture.mean_opacity(0);
    let expected = 1.0 - (-depth).exp();
    assert!((mean / expected - 1.0).abs() < 5e-4, "{mean}, {expected}");
    // Their sum, which is the optical depth, is more by half of it.
    assert!(depth / mean > 1.0 + 0.4 * depth && depth > 0.02, "{depth}, {mean}");
}

#[test]
fn pictures_wrap_around_in_both_directions() {
    let layer = small().layers().expect("a set")[0];
    let texture = StreakTexture::draw(&layer, 64);
    let value = |x: usize, y: usize| f64::from(texture.levels[0][y * 64 + x]);
    // Difference between neighbouring rows and columns, inside and across the border: streaks go on.
    let rows = |a: usize, b: usize| (0..64).map(|x| (value(x, a) - value(x, b)).abs()).sum::<f64>();
    let columns = |a: usize, b: usize| (0..64).map(|y| (value(a, y) - value(b, y)).abs()).sum::<f64>();
    let inside: f64 = (0..63).map(|i| rows(i, i + 1)).sum::<f64>() / 63.0;
    let apart: f64 = (0..32).map(|i| rows(i, i + 32)).sum::<f64>() / 32.0;
    assert!(
        rows(63, 0) < 2.0 * inside && inside < 0.5 * apart,
        "{} {inside} {apart}",
        rows(63, 0)
    );
    let inside: f64 = (0..63).map(|i| columns(i, i + 1)).sum::<f64>() / 63.0;
    assert!(columns(63, 0) < 2.0 * inside, "{} {inside}", columns(63, 0));
    // Nothing that crosses the border is lost: the mean is that of the layer, and rows at the border hold their part.
    let row = |y: usize| (0..64).map(|x| value(x, y)).sum::<f64>();
    let mean = (0..64).map(row).sum::<f64>() / 64.0;
    for y in [0, 63] {
        assert!((row(y) / mean - 1.0).abs() < 0.5, "{y}: {} of {mean}", row(y));
    }
}

#[test]
fn the_same_seed_gives_the_same_bits_on_any_number_of_threads() {
    let bake = |threads: usize, settings: &StreakTextureSettings| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .expect("threads");
        pool.install(|| StreakTextures::bake(settings)).expect("a set")
    };
    let one = bake(1, &small());
    assert_eq!(one, bake(4, &small()));
    let other = bake(1, &StreakTextureSettings { seed: 8, ..small() });
    assert_ne!(one.textures[0].levels, other.textures[0].levels);
    // Other places, the same rain.
    assert!((one.textures[1].mean_opacity(0) / other.textures[1].mean_opacity(0) - 1.0).abs() < 1e-3);
    // Two classes do not share their places.
    let [a, b] = [0, 1].map(|class| one.textures[class].layer.tile_drops());
    assert!(a.iter().zip(&b).all(|(a, b)| a.x != b.x));
}

#[test]
fn a_heavier_rain_keeps_every_streak_of_a_lighter_one() {
    let layers = StreakTextureSettings::default().layers().expect("a set");
    let mut kept = 0;
    for class in 0..6 {
        for pair in [0, 1, 2].map(|rate| [&layers[6 * rate + class], &layers[6 * (rate + 1) + class]]) {
            let [few, many] = pair.map(StreakLayer::tile_drops);
            assert!(few.len() <= many.len());
            for (a, b) in few.iter().zip(&many) {
                assert_eq!([a.x, a.y], [b.x, b.y]);
                // A heavier rain has larger drops, in the same class.
                let ratio = b.diameter / a.diameter;
                assert!((0.999_99..1.52).contains(&ratio), "{ratio}");
                kept += 1;
            }
            assert_eq!(pair[0].path_m, pair[1].path_m);
        }
    }
    assert!(kept > 1500, "{kept}");
}

#[test]
fn drops_are_counted_up_and_their_opacity_makes_up_for_it() {
    for settings in varied() {
        for layer in settings.layers().expect("a set") {
            let expected = layer.number_per_m3 * settings.tile_m.powi(3);
            assert_eq!(f64::from(layer.drops), expected.ceil().max(1.0));
            // A single drop is not of the mean size; many are.
            let bound = 1.0 + 1.5 / f64::from(layer.drops);
            assert!(layer.share <= bound, "{} of {expected}", layer.share);
            let drops = layer.tile_drops();
            assert_eq!(drops.len(), layer.drops as usize);
            let texel_mm = 1e3 * settings.tile_m / f64::from(settings.texels);
            let diameters = drops.iter().map(|d| f64::from(d.diameter) * texel_mm);
            assert!(
                diameters
                    .clone()
                    .all(|d| d > layer.min_mm * 0.999_99 && d < layer.max_mm * 1.000_01)
            );
            let side = settings.texels as f32;
            assert!(
                drops
                    .iter()
                    .all(|d| (0.0..side).contains(&d.x) && (0.0..side).contains(&d.y))
            );
        }
    }
}

#[test]
fn default_classes_are_pairs_of_the_drop_fields() {
    let layers = StreakTextureSettings::default().layers().expect("a set");
    for (index, layer) in layers.iter().enumerate() {
        let weights = ClassWeights::new(&spectrum(Distribution::MarshallPalmer, layer.intensity_mm_h));
        let class = 2 * (index % 6);
        let sigma: f64 = weights.extinction_per_m[class..class + 2].iter().sum();
        assert!((layer.extinction_per_m / sigma - 1.0).abs() < 1e-6, "{index}");
    }
    // Speeds rise with the class and stay at every rate.
    let speeds: Vec<f64> = layers[..6].iter().map(|l| l.speed_m_s).collect();
    assert!(speeds.windows(2).all(|pair| pair[1] > pair[0] + 0.1), "{speeds:?}");
    assert!(layers.iter().enumerate().all(|(i, l)| l.speed_m_s == speeds[i % 6]));
}

#[test]
fn a_dry_rate_and_odd_settings_are_refused_by_name() {
    let bad = |change: fn(&mut StreakTextureSettings)| {
        let mut settings = StreakTextureSettings::default();
        change(&mut settings);
        settings.layers().expect_err("refused").to_string()
    };
    for (message, start) in [
        (bad(|s| s.intensities_mm_h.clear()), "intensities_mm_h is empty"),
        (
            bad(|s| s.intensities_mm_h[0] = 0.0),
            "intensities_mm_h is 0, allowed: 0.01 to 500 mm/h",
        ),
        (bad(|s| s.intensities_mm_h[3] = f64::NAN), "intensities_mm_h is NaN"),
        (
            bad(|s| s.intensities_mm_h[1] = 1.0),
            "intensities_mm_h: entry 1 (1) does not come after",
        ),
        (bad(|s| s.diameter_edges_mm.truncate(1)), "diameter_edges_mm is empty"),
        (bad(|s| s.diameter_edges_mm[6] = 11.0), "diameter_edges_mm is 11"),
        (
            bad(|s| s.texels = 100),
            "texels is 100, allowed: a power of two from 32 to 2048",
        ),
        (bad(|s| s.texels = 16), "texels is 16"),
        (bad(|s| s.texels = 4096), "texels is 4096"),
        (bad(|s| s.texels = 0), "texels is 0"),
        (
            bad(|s| {
                s.texels = 2048;
                s.intensities_mm_h = (1..=9).map(f64::from).collect();
            }),
            "texels (bytes of all layers) is 603979740",
        ),
        (bad(|s| s.tile_m = 0.0), "tile_m is 0, allowed: 0.25 to 4 m"),
        (bad(|s| s.exposure_s = 0.5), "exposure_s is 0.5, allowed: 1e-4 to 0.1 s"),
        (bad(|s| s.exposure_s = f64::INFINITY), "exposure_s is inf"),
        (
            bad(|s| s.intensities_mm_h = (1..=50).map(f64::from).collect()),
            "layers (intensities_mm_h times classes) is 300, allowed: 1 to 256",
        ),
        (
            bad(|s| {
                s.distribution = Distribution::Drizzle;
                s.diameter_edges_mm = vec![0.1, 6.0];
                s.intensities_mm_h = vec![500.0];
                s.tile_m = 4.0;
                s.exposure_s = 1e-3;
            }),
            "tile_m (drops in a layer)",
        ),
    ] {
        assert!(message.starts_with(start), "{message}");
    }
    let error = StreakTextures::bake(&StreakTextureSettings {
        tile_m: -1.0,
        ..small()
    });
    assert!(matches!(error, Err(ConfigError::OutOfRange { field: "tile_m", .. })));
}

#[test]
fn every_setting_changes_the_key() {
    let base = StreakTextureSettings::default();
    let mut keys = std::collections::BTreeSet::from([base.key()]);
    let changes: [fn(&mut StreakTextureSettings); 8] = [
        |s| s.distribution = Distribution::Drizzle,
        |s| s.intensities_mm_h[0] = 1.5,
        |s| s.diameter_edges_mm[0] = 0.6,
        |s| s.texels = 256,
        |s| s.tile_m = 2.0,
        |s| s.exposure_s = 0.01,
        |s| s.seed = 2,
        |s| {
            s.diameter_edges_mm.pop();
        },
    ];
    for change in changes {
        let mut settings = base.clone();
        change(&mut settings);
        assert!(keys.insert(settings.key()), "{}", settings.key_text());
    }
    assert_eq!(base.key(), StreakTextureSettings::default().key());
}
