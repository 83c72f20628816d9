//! Where the wet mask changes from dry to wet.

use test_support::shots::Pixel;

/// Side of a texel of the default cover map. Units: m.
pub const COVER_TEXEL_M: f64 = 60.0 / 1024.0;

/// Flux mean of 1/v at 25 mm/h: the rain-rate weighted value of `docs/physics.md` (impacts per area), computed there by
/// quadrature and not by this repository's code. Units: s/m.
pub const MEAN_INVERSE_SPEED_25_MM_H: f64 = 0.1690;

/// 1/v of the drop that halves the rain at 25 mm/h: 2.0483 mm (median volume on the ground, `docs/physics.md`), 6.59
/// m/s between the entries of Gunn & Kinzer 1949 for 2.0 and 2.2 mm. Units: s/m.
pub const MEDIAN_INVERSE_SPEED_25_MM_H: f64 = 1.0 / 6.59;

/// Width of the bins along which the mask is averaged. Units: m.
const BIN_M: f64 = 0.04;

/// Mean wetness along an axis, in bins: (place in m, wetness).
pub fn profile(pixels: &[Pixel], place: impl Fn(&Pixel) -> f64) -> Vec<(f64, f64)> {
    let mut bins: std::collections::BTreeMap<i64, (f64, f64)> = std::collections::BTreeMap::new();
    for p in pixels {
        let bin = bins.entry((place(p) / BIN_M).floor() as i64).or_default();
        bin.0 += p.wet;
        bin.1 += 1.0;
    }
    bins.into_iter()
        .map(|(bin, (sum, count))| ((bin as f64 + 0.5) * BIN_M, sum / count))
        .collect()
}

/// Where a profile crosses `level`, linear between bins; every crossing in order.
pub fn crossings(profile: &[(f64, f64)], level: f64) -> Vec<f64> {
    profile
        .windows(2)
        .filter(|w| (w[0].1 - level) * (w[1].1 - level) < 0.0)
        .map(|w| w[0].0 + (level - w[0].1) / (w[1].1 - w[0].1) * (w[1].0 - w[0].0))
        .collect()
}

/// Where a border with the same area under it would be sharp: wet (`open`) below it, dry above it. The profile must
/// reach from all wet to all dry, in either order.
pub fn mean_border(profile: &[(f64, f64)], open: f64) -> f64 {
    let (first, last) = (profile[0], profile[profile.len() - 1]);
    let wet: f64 = profile
        .windows(2)
        .map(|w| 0.5 * (w[0].1 + w[1].1) / open * (w[1].0 - w[0].0))
        .sum();
    if first.1 > last.1 { first.0 + wet } else { last.0 - wet }
}

#[test]
fn a_step_is_found_where_it_is() {
    let step = |x: f64| Pixel {
        at: [0, 0],
        rain: 0.0,
        water: 0.0,
        wet: ((x - 1.25) / 0.2 + 0.5).clamp(0.0, 1.0),
        surface: Some([x, 0.0, 0.0].into()),
        brightness: 0.0,
    };
    let pixels: Vec<Pixel> = (0..3000).map(|i| step(f64::from(i) * 1e-3)).collect();
    let profile = profile(&pixels, |p| p.surface.map_or(0.0, |s| s.x));
    let found = crossings(&profile, 0.5);
    assert!(found.len() == 1 && (found[0] - 1.25).abs() < 0.01, "{found:?}");
    // Wet above the step, dry below.
    assert!((mean_border(&profile, 1.0) - 1.25).abs() < 0.01);
}
