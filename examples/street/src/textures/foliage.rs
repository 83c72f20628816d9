//! Bark, and sprays of leaves cut out by their alpha.

use super::{Picture, Texel, bake, srgb};
use crate::mesh::cos_sin;
use crate::noise::{Rng, fbm, smoothstep};
use glam::{Vec2, Vec3, Vec4, vec2, vec3};

/// Size of the bark tile, metres.
pub const BARK_M: f32 = 0.8;

/// The two kinds of trees on the street.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Leaf {
    /// Round, pointed leaves of a lime tree.
    Broad,
    /// Narrow leaflets of an ash.
    Slender,
}

/// Furrowed grey-brown bark, green on one side.
#[must_use]
pub fn bark(seed: u32) -> Vec<Picture> {
    bake("bark", [256, 256], [BARK_M; 2], move |u, v| {
        let ridge =
            1.0 - 2.0 * (fbm(seed ^ 400, u + 0.05 * fbm(seed ^ 401, u, v, 6, 6, 2), v, 14, 4, 4) - 0.5).abs() * 2.4;
        let ridge = ridge.clamp(0.0, 1.0);
        let moss = smoothstep(0.45, 0.75, fbm(seed ^ 402, u, v, 2, 3, 3));
        let c = vec3(0.13, 0.105, 0.08)
            .lerp(vec3(0.04, 0.033, 0.027), ridge)
            .lerp(vec3(0.075, 0.09, 0.04), 0.5 * moss);
        let mut t = Texel::new(c, -0.012 * ridge, 0.95);
        t.open = 1.0 - 0.5 * ridge;
        t
    })
}

/// One leaf on the card: centre and half axes in pixels, and its colour.
struct Blade {
    base: Vec2,
    along: Vec2,
    length: f32,
    width: f32,
    colour: Vec3,
}

/// Half the width of a leaf, as a share of its greatest, at `t` from stalk (0) to tip (1).
fn outline(kind: Leaf, t: f32) -> f32 {
    match kind {
        Leaf::Broad => (t * 3.2).min(1.0).sqrt() * (1.0 - t).max(0.0).sqrt() * 1.25,
        Leaf::Slender => 4.0 * t * (1.0 - t),
    }
}

/// A spray of leaves on a twig that enters at the middle of the lower edge: RGBA, alpha 0 or 255 but for a soft rim.
#[must_use]
pub fn spray(seed: u64, kind: Leaf) -> Picture {
    const SIZE: u32 = 512;
    let (name, count, length, aspect) = match kind {
        Leaf::Broad => ("leaves-broad", 96, 60.0, 0.42),
        Leaf::Slender => ("leaves-slender", 120, 64.0, 0.17),
    };
    let mut rng = Rng::new(seed, 40 + kind as u32);
    let green = match kind {
        Leaf::Broad => [vec3(0.055, 0.1, 0.02), vec3(0.12, 0.155, 0.03), vec3(0.26, 0.19, 0.03)],
        Leaf::Slender => [
            vec3(0.05, 0.085, 0.022),
            vec3(0.095, 0.125, 0.035),
            vec3(0.2, 0.16, 0.035),
        ],
    };
    // Twigs: the main one and side twigs that leave it in turn.
    let root = vec2(256.0, 511.0);
    let mut twigs = vec![(root, vec2(262.0, 70.0))];
    for k in 0..7 {
        let t = 0.12 + 0.12 * k as f32;
        let from = root.lerp(vec2(262.0, 70.0), t);
        let side = if k % 2 == 0 { 1.0 } else { -1.0 };
        let (c, s) = cos_sin(side * rng.range(0.6, 1.1));
        twigs.push((from, from + vec2(s, -c) * rng.range(120.0, 215.0) * (1.15 - 0.6 * t)));
    }
    let mut blades = Vec::new();
    for k in 0..count {
        let (a, b) = twigs[k % twigs.len()];
        let t = rng.range(0.22, 1.0);
        let base = a.lerp(b, t);
        let dir = (b - a).normalize();
        let side = if rng.unit() < 0.5 { 1.0 } else { -1.0 };
        let (c, s) = cos_sin(side * rng.range(0.25, 1.25));
        let along = vec2(dir.x * c - dir.y * s, dir.x * s + dir.y * c);
        let hue = rng.unit();
        let colour = if hue > 0.93 {
            green[1].lerp(green[2], rng.unit())
        } else {
            green[0].lerp(green[1], hue * hue)
        };
        let length = length * rng.range(0.7, 1.1);
        blades.push(Blade {
            base,
            along,
            length,
            width: length * aspect,
            colour: colour * rng.range(0.8, 1.1),
        });
    }
    let mean = green[0].lerp(green[1], 0.4);
    let mut pixels = vec![mean.extend(0.0); (SIZE * SIZE) as usize];
    for &(a, b) in &twigs {
        paint(&mut pixels, SIZE, a.min(b) - 4.0, a.max(b) + 4.0, |p| {
            let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
            let d = p.distance(a.lerp(b, t)) - (3.0 - 2.0 * t);
            (d < 0.0).then_some(vec3(0.07, 0.05, 0.03))
        });
    }
    for leaf in &blades {
        let reach = Vec2::splat(leaf.length * 1.05);
        paint(&mut pixels, SIZE, leaf.base - reach, leaf.base + reach, |p| {
            let q = p - leaf.base;
            let t = q.dot(leaf.along) / leaf.length;
            let side = q.dot(leaf.along.perp()) / leaf.width;
            if !(0.0..=1.0).contains(&t) || side.abs() > outline(kind, t) {
                return None;
            }
            // Midrib and side veins are paler; one half of a folded leaf is in shade.
            let vein = ((t * 9.0 - side.abs() * 1.6).fract() - 0.5).abs() < 0.07 || side.abs() < 0.05;
            let fold = if side > 0.0 { 1.0 } else { 0.82 };
            Some(leaf.colour * fold * if vein { 1.3 } else { 1.0 - 0.25 * side.abs() })
        });
    }
    Picture::new(name, SIZE, SIZE, 4, |x, y| {
        let p = pixels[(y * SIZE + x) as usize];
        [srgb(p.x), srgb(p.y), srgb(p.z), (p.w * 255.0) as u8]
    })
}

/// Lets `f` colour the pixels of a rectangle; `None` leaves a pixel as it is.
fn paint(pixels: &mut [Vec4], size: u32, low: Vec2, high: Vec2, f: impl Fn(Vec2) -> Option<Vec3>) {
    let range = |a: f32, b: f32| (a.max(0.0) as u32)..(b.clamp(0.0, size as f32) as u32);
    for y in range(low.y, high.y) {
        for x in range(low.x, high.x) {
            if let Some(c) = f(vec2(x as f32 + 0.5, y as f32 + 0.5)) {
                pixels[(y * size + x) as usize] = c.extend(1.0);
            }
        }
    }
}
