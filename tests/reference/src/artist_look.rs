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
