//! A moving disc, seen while the shutter is open.

/// Share of `samples` moments of the exposure in which a disc of `diameter`, going `path` along +y from the origin,
/// covers the point (across, along).
pub fn covered_share(across: f64, along: f64, diameter: f64, path: f64, samples: u32) -> f64 {
    let hits = (0..samples)
        .filter(|&i| {
            let centre = path * (f64::from(i) + 0.5) / f64::from(samples);
            across.hypot(along - centre) <= 0.5 * diameter
        })
        .count();
    hits as f64 / f64::from(samples)
}

/// Sum over a grid of square pixels, each sampled at `sub`² points: opacity × area.
pub fn total(opacity: impl Fn(f64, f64) -> f64, diameter: f64, path: f64, pixel: f64, sub: u32) -> f64 {
    let (columns, rows) = (
        (diameter / pixel).ceil() as i32 + 2,
        ((path + diameter) / pixel).ceil() as i32 + 2,
    );
    let step = pixel / f64::from(sub);
    let mut sum = 0.0;
    for column in 0..columns * sub as i32 {
        let x = (f64::from(column) + 0.5) * step - 0.5 * pixel * f64::from(columns);
        for row in 0..rows * sub as i32 {
            let y = (f64::from(row) + 0.5) * step - 0.5 * diameter - pixel;
            sum += opacity(x, y) * step * step;
        }
    }
    sum
}

/// ∫(π/4)(D f/z)² over the share of the exposure behind the near plane; z linear from `start` to `end`. Units: px².
pub fn disc_sum_px2(diameter: f64, focal: f64, start: f64, end: f64, near: f64) -> f64 {
    let n = 200_000;
    (0..n)
        .map(|i| start + (end - start) * (f64::from(i) + 0.5) / f64::from(n))
        .filter(|&z| z >= near)
        .map(|z| core::f64::consts::FRAC_PI_4 * (diameter * focal / z).powi(2) / f64::from(n))
        .sum()
}
