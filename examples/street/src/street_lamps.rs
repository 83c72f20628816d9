//! Street lamps on curved arms, and hanging lanterns.

use crate::layout::{LAMP_ARM, LAMP_LIGHT_Y};
use crate::materials::{Mat, Parts};
use crate::mesh::{ALL, Frame, cos_sin};
use glam::{Vec3, vec3};

/// Builds one lamp post with its foot at the origin and its arm towards +X.
pub fn post(parts: &mut Parts) {
    let iron = parts.get(Mat::Iron);
    let profile = [
        (0.0, -0.1),
        (0.17, -0.1),
        (0.17, 0.1),
        (0.13, 0.16),
        (0.11, 0.75),
        (0.13, 0.8),
        (0.085, 0.9),
        (0.06, 1.6),
        (0.045, 4.55),
        (0.07, 4.6),
        (0.07, 4.66),
        (0.04, 4.7),
    ];
    iron.lathe(Vec3::ZERO, &profile, 12, 1.0);
    // The arm: a quarter turn up and over, ending above the lamp.
    let high = LAMP_LIGHT_Y + 0.42;
    let bend = high - 4.7;
    let mut points = vec![vec3(0.0, 4.68, 0.0)];
    for k in 0..=8 {
        let (c, s) = cos_sin(std::f32::consts::FRAC_PI_2 * (k as f32 / 8.0));
        points.push(vec3(bend * (1.0 - c), 4.7 + bend * s, 0.0));
    }
    points.push(vec3(LAMP_ARM + 0.1, high, 0.0));
    for w in points.windows(2) {
        iron.tube(w[0], w[1], [0.032, 0.032], 8, 1.0, false);
    }
    iron.lathe(
        vec3(LAMP_ARM + 0.1, high, 0.0),
        &[(0.0, -0.045), (0.045, 0.0), (0.0, 0.045)],
        8,
        1.0,
    );
    // A stay under the arm.
    iron.tube(
        vec3(0.04, 4.3, 0.0),
        vec3(0.52, high - 0.06, 0.0),
        [0.014, 0.014],
        6,
        1.0,
        false,
    );
    let head = vec3(LAMP_ARM, LAMP_LIGHT_Y, 0.0);
    let hood = [
        (0.3, 0.02),
        (0.31, 0.05),
        (0.24, 0.16),
        (0.11, 0.24),
        (0.06, 0.3),
        (0.035, 0.42),
        (0.0, 0.43),
    ];
    iron.lathe(head, &hood, 16, 1.0);
    iron.lathe(head, &[(0.225, 0.045), (0.3, 0.02)], 16, 1.0);
    parts.get(Mat::Glow).lathe(
        head,
        &[(0.0, -0.1), (0.1, -0.085), (0.18, -0.03), (0.225, 0.045)],
        16,
        1.0,
    );
}

/// A lantern that hangs from a ceiling at height `ceiling`, its light at `p`.
pub fn lantern(parts: &mut Parts, p: Vec3, ceiling: f32) {
    let f = Frame::world(p);
    let iron = parts.get(Mat::Iron);
    iron.tube(
        p + Vec3::Y * 0.2,
        vec3(p.x, ceiling, p.z),
        [0.012, 0.012],
        6,
        1.0,
        false,
    );
    iron.lathe(p, &[(0.17, 0.13), (0.17, 0.15), (0.03, 0.23), (0.0, 0.23)], 8, 1.0);
    iron.block(&f, [-0.1, -0.19, -0.1], [0.1, -0.17, 0.1], 1.0, ALL);
    parts
        .get(Mat::Glow)
        .lathe(p, &[(0.0, -0.17), (0.085, -0.17), (0.14, 0.13), (0.0, 0.135)], 8, 1.0);
}
