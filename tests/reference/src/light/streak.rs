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

/// Share of [0, path] that lies within half a chord of `along`: by the distance of both middles.
pub fn overlap(along: f64, chord: f64, path: f64) -> f64 {
    let reach = chord + 0.5 * path - (along - 0.5 * path).abs();
    reach.clamp(0.0, f64::min(2.0 * chord, path)) / path
}

/// 1 − (1 − α)^g for g a multiple of a half: layer over layer.
pub fn layered(alpha: f64, halves: u32) -> f64 {
    let over = |below: f64, layer: f64| below + layer * (1.0 - below);
    let whole = (0..halves / 2).fold(0.0, |sum, _| over(sum, alpha));
    if halves % 2 == 1 {
        over(whole, alpha / (1.0 + (1.0 - alpha).sqrt()))
    } else {
        whole
    }
}

/// ∫(π/4)(D f/z)² over the share of the exposure behind the near plane, as [`disc_sum_px2`], cut exactly.
pub fn disc_integral_px2(diameter: f64, focal: f64, start: f64, end: f64, near: f64) -> f64 {
    let at = |z: f64| ((z - start) / (end - start)).clamp(0.0, 1.0);
    let (from, to) = if start < near {
        (at(near), 1.0)
    } else if end < near {
        (0.0, at(near))
    } else {
        (0.0, 1.0)
    };
    crate::numerics::simpson(from, to, 20_000, |t| {
        core::f64::consts::FRAC_PI_4 * (diameter * focal / (start + (end - start) * t)).powi(2)
    })
}

/// Mean over a texel, at `sub`² points, of what streaks take out of the light behind them, 1 − ∏(1 − α).
///
/// `streaks`: [x, y where it begins, diameter, share of whole drops] in texels, all `path` long along +y, in a picture
/// of `side` texels that wraps around.
pub fn texel_opacity(streaks: &[[f64; 4]], path: f64, side: f64, texel: [u32; 2], sub: u32) -> f64 {
    let mut sum = 0.0;
    for i in 0..sub * sub {
        let at = |k: u32, corner: u32| f64::from(corner) + (f64::from(k) + 0.5) / f64::from(sub);
        let (x, y) = (at(i % sub, texel[0]), at(i / sub, texel[1]));
        let mut through = 1.0;
        for [streak_x, streak_y, diameter, share] in streaks {
            // Every image of the streak that may reach the texel.
            for turn in -1..=2 {
                let along = y - streak_y + side * f64::from(turn);
                if along < -diameter || along > path + diameter {
                    continue;
                }
                for across in [x - streak_x, x - streak_x + side, x - streak_x - side] {
                    let square = 0.25 * diameter * diameter - across * across;
                    if square > 0.0 {
                        through *= 1.0 - share * overlap(along, square.sqrt(), path);
                    }
                }
            }
        }
        sum += 1.0 - through;
    }
    sum / f64::from(sub * sub)
}
