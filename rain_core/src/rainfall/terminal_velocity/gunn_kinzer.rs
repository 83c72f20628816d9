//! The measured table and the monotone cubic through it: the truth at sea level.

/// Gunn & Kinzer 1949, still air at 20 °C and 1013 hPa: D in mm, v in m/s; the first row is the origin.
pub const GUNN_KINZER: [(f64, f64); 35] = [
    (0.0, 0.0),
    (0.1, 0.27),
    (0.2, 0.72),
    (0.3, 1.17),
    (0.4, 1.62),
    (0.5, 2.06),
    (0.6, 2.47),
    (0.7, 2.87),
    (0.8, 3.27),
    (0.9, 3.67),
    (1.0, 4.03),
    (1.2, 4.64),
    (1.4, 5.17),
    (1.6, 5.65),
    (1.8, 6.09),
    (2.0, 6.49),
    (2.2, 6.90),
    (2.4, 7.27),
    (2.6, 7.57),
    (2.8, 7.82),
    (3.0, 8.06),
    (3.2, 8.26),
    (3.4, 8.44),
    (3.6, 8.60),
    (3.8, 8.72),
    (4.0, 8.83),
    (4.2, 8.92),
    (4.4, 8.98),
    (4.6, 9.03),
    (4.8, 9.07),
    (5.0, 9.09),
    (5.2, 9.12),
    (5.4, 9.14),
    (5.6, 9.16),
    (5.8, 9.17),
];

const ROWS: usize = GUNN_KINZER.len();

/// Slope of the curve at each row, m/s per mm: Fritsch & Butland's weighted harmonic mean inside, a one-sided parabola
/// at the ends.
const SLOPES: [f64; ROWS] = slopes();

const fn secant(i: usize) -> f64 {
    (GUNN_KINZER[i + 1].1 - GUNN_KINZER[i].1) / (GUNN_KINZER[i + 1].0 - GUNN_KINZER[i].0)
}

const fn slopes() -> [f64; ROWS] {
    let mut slopes = [0.0; ROWS];
    let mut i = 1;
    while i < ROWS - 1 {
        let (before, after) = (
            GUNN_KINZER[i].0 - GUNN_KINZER[i - 1].0,
            GUNN_KINZER[i + 1].0 - GUNN_KINZER[i].0,
        );
        // The table rises everywhere, so no secant is 0 and none changes sign.
        let (w1, w2) = (2.0 * after + before, after + 2.0 * before);
        slopes[i] = (w1 + w2) / (w1 / secant(i - 1) + w2 / secant(i));
        i += 1;
    }
    // Both ends of the table are evenly spaced. The last slope is held at 0 or above, as the first is anyway.
    slopes[0] = 1.5 * secant(0) - 0.5 * secant(1);
    let last = 1.5 * secant(ROWS - 2) - 0.5 * secant(ROWS - 3);
    slopes[ROWS - 1] = if last > 0.0 { last } else { 0.0 };
    slopes
}

/// Terminal speed in still air at 20 °C and 1013 hPa: monotone cubic (PCHIP) through [`GUNN_KINZER`]. Units: m/s.
///
/// `diameter_mm` in mm, domain [0, ∞): 9.17 above 5.8 mm; a negative or NaN diameter returns 0. Monotone, within
/// [0, 9.17]. Source: Gunn & Kinzer 1949; Fritsch & Butland 1984 for the curve.
///
/// Error: 1e-13 m/s against the same curve in the reference; against nature that of the measurements, about 1 %.
#[must_use]
pub fn gunn_kinzer(diameter_mm: f64) -> f64 {
    let d = if diameter_mm > 0.0 { diameter_mm.min(5.8) } else { 0.0 };
    // Rows every 0.1 mm up to 1 mm, every 0.2 mm above. A row too far by rounding changes nothing: the curve is smooth.
    let i = if d < 1.0 {
        (d * 10.0) as usize
    } else {
        (10 + ((d - 1.0) * 5.0) as usize).min(ROWS - 2)
    };
    let ((d0, v0), (d1, v1)) = (GUNN_KINZER[i], GUNN_KINZER[i + 1]);
    let h = d1 - d0;
    let t = (d - d0) / h;
    let s = 1.0 - t;
    let v = s * s * ((1.0 + 2.0 * t) * v0 + t * h * SLOPES[i]) + t * t * ((1.0 + 2.0 * s) * v1 - s * h * SLOPES[i + 1]);
    // Rounding where the last pieces are all but flat.
    v.clamp(0.0, GUNN_KINZER[ROWS - 1].1)
}
