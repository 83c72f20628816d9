//! The source systems' shading of wet surfaces, line by line as their listings have it: factors as straight lines, no
//! `lerp`. All inputs lie in [0, 1].

/// Albedo, gloss, F₀.
pub type Look = [f64; 3];

/// HLSL's saturate.
fn saturate(x: f64) -> f64 {
    x.clamp(0.0, 1.0)
}

/// Lagarde 2013, equations 1 and 2; Nguyenova 2021, listing L1: 0.3 of the albedo and 2.5 times the gloss when wet.
pub fn wet([albedo, gloss, f0]: Look, w: f64) -> Look {
    [albedo - 0.7 * w * albedo, saturate(gloss + 1.5 * w * gloss), f0]
}

/// Lagarde 2013, equation 3: gloss 1 and F₀ 0.02 under water.
pub fn flooded([albedo, gloss, f0]: Look, a: f64) -> Look {
    [albedo, gloss + a * (1.0 - gloss), f0 + a * (0.02 - f0)]
}

/// Lagarde 2013, part 3b: porosity of a dielectric.
pub fn porosity(gloss: f64, metalness: f64) -> f64 {
    (1.0 - metalness) * saturate(((1.0 - gloss) - 0.5) / 0.4)
}

/// Lagarde 2013, part 3b: the most porous surface goes down to 0.2.
pub fn porous_wet([albedo, gloss, f0]: Look, porosity: f64, w: f64) -> Look {
    let loss = 0.8 * porosity * w;
    [albedo - loss * albedo, 1.0 - (1.0 - gloss) * (1.0 - 0.5 * loss), f0]
}

/// Lagarde 2013, equation 4.
pub fn cracks(level: f64, height: f64) -> f64 {
    let room = 1.0 - height;
    if level < room { level } else { room }
}

/// Lagarde 2013, equation 5.
pub fn painted(level: f64, depth: f64, margin: f64) -> f64 {
    if level <= depth {
        0.0
    } else if level >= depth + margin {
        1.0
    } else {
        level / margin - depth / margin
    }
}

/// Lagarde 2013, equation 6.
pub fn accumulated(cracks: f64, puddles: f64) -> f64 {
    if cracks > puddles { cracks } else { puddles }
}

/// Lagarde 2013, equation 7, the mask on the rain's part.
pub fn wetness(level: f64, mask: f64, accumulated: f64) -> f64 {
    saturate(level * mask + accumulated)
}

/// What a screen blend leaves dark: a + b − a b.
pub fn screen(a: f64, b: f64) -> f64 {
    a + b - a * b
}

/// Nguyenova 2021, listing L2.
pub fn puddle_amount(level: f64, blended: f64) -> f64 {
    if level > blended { level - blended } else { 0.0 }
}

/// Nguyenova 2021, listing L2: 0.8 of the albedo, gloss 1.
pub fn puddle([albedo, gloss, f0]: Look, p: f64) -> Look {
    [albedo - 0.2 * p * albedo, gloss + p * (1.0 - gloss), f0]
}

/// Ground between wet and puddle: a cubic from 0 to 1 over `width` below the level, scaled by level/width up to 1.
pub fn drenched(level: f64, blended: f64, width: f64) -> f64 {
    if width == 0.0 || blended >= level + width {
        return 0.0;
    }
    let scale = if level < width { level / width } else { 1.0 };
    if blended <= level {
        return scale;
    }
    // From the puddle's rim outwards, mirrored.
    let away = (blended - level) / width;
    scale * (1.0 - 3.0 * away.powi(2) + 2.0 * away.powi(3))
}

/// Noise that places puddles: three octaves of values at whole numbers, the same after 4096, each blended over its four neighbours by the
/// weights 1 − s and s, s = 10 f³ − 15 f⁴ + 6 f⁵; then spread from [0.25, 0.75] over [0, 1] by the cubic.
pub fn puddle_map(x: f64, z: f64, seed: u32) -> f64 {
    let mut sum = 0.0;
    for (octave, [scale, shift]) in [[1.0, 0.0], [2.0, 7.31], [4.0, -3.77]].into_iter().enumerate() {
        let at = [scale * x + shift, scale * z + shift];
        let [sx, sz] = at.map(|a| {
            let f = a - a.floor();
            10.0 * f.powi(3) - 15.0 * f.powi(4) + 6.0 * f.powi(5)
        });
        let mut value = 0.0;
        for (i, wx) in [(0, 1.0 - sx), (1, sx)] {
            for (j, wz) in [(0, 1.0 - sz), (1, sz)] {
                let cell = [at[0].floor() as i64 + i, at[1].floor() as i64 + j].map(|c| c.rem_euclid(4096) as u32);
                let word = crate::hash::pcg3d([cell[0], cell[1], seed + octave as u32])[0];
                value += wx * wz * f64::from(word >> 8) / 16_777_216.0;
            }
        }
        sum += value / f64::from(1 << octave);
    }
    let t = saturate(2.0 * (sum / 1.75) - 0.5);
    3.0 * t.powi(2) - 2.0 * t.powi(3)
}
