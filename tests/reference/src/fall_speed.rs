//! Terminal velocity: measurements, the sources' fits, Beard 1976.

/// Gunn & Kinzer 1949: diameters, mm.
pub const DIAMETERS_MM: [f64; 34] = [
    0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.2, 1.4, 1.6, 1.8, 2.0, 2.2, 2.4, 2.6, 2.8, 3.0, 3.2, 3.4, 3.6,
    3.8, 4.0, 4.2, 4.4, 4.6, 4.8, 5.0, 5.2, 5.4, 5.6, 5.8,
];

/// Gunn & Kinzer 1949: speeds at [`DIAMETERS_MM`], m/s.
pub const SPEEDS_M_S: [f64; 34] = [
    0.27, 0.72, 1.17, 1.62, 2.06, 2.47, 2.87, 3.27, 3.67, 4.03, 4.64, 5.17, 5.65, 6.09, 6.49, 6.90, 7.27, 7.57, 7.82,
    8.06, 8.26, 8.44, 8.60, 8.72, 8.83, 8.92, 8.98, 9.03, 9.07, 9.09, 9.12, 9.14, 9.16, 9.17,
];

/// The monotone cubic of Fritsch & Butland 1984 through the table and the origin, m/s.
pub fn measured(d: f64) -> f64 {
    if d.is_nan() || d <= 0.0 {
        return 0.0;
    }
    let mut x = vec![0.0];
    x.extend(DIAMETERS_MM);
    let mut y = vec![0.0];
    y.extend(SPEEDS_M_S);
    let last = x.len() - 1;
    if d >= x[last] {
        return y[last];
    }
    let slope = |k: usize| (y[k + 1] - y[k]) / (x[k + 1] - x[k]);
    let tangent = |k: usize| {
        if k == 0 || k == last {
            // The three-point formula at an end, limited so that the curve keeps the table's direction.
            let (near, far) = if k == 0 { (0, 1) } else { (last - 1, last - 2) };
            let (h0, h1) = (x[near + 1] - x[near], x[far + 1] - x[far]);
            let m = ((2.0 * h0 + h1) * slope(near) - h0 * slope(far)) / (h0 + h1);
            if m * slope(near) <= 0.0 {
                0.0
            } else {
                m.min(3.0 * slope(near))
            }
        } else {
            let (h0, h1) = (x[k] - x[k - 1], x[k + 1] - x[k]);
            let (w0, w1) = (2.0 * h1 + h0, h1 + 2.0 * h0);
            (w0 + w1) / (w0 / slope(k - 1) + w1 / slope(k))
        }
    };
    let k = (0..last).rev().find(|k| x[*k] <= d).unwrap_or(0);
    // Newton's form of the cubic through both points with both tangents.
    let h = x[k + 1] - x[k];
    let s = d - x[k];
    let c2 = (3.0 * slope(k) - 2.0 * tangent(k) - tangent(k + 1)) / h;
    let c3 = (tangent(k) + tangent(k + 1) - 2.0 * slope(k)) / (h * h);
    y[k] + s * tangent(k) + s * s * c2 + s * s * s * c3
}

/// The nine-coefficient fit: v = D Σ cᵢ (D/3 − 1)ⁱ.
pub fn fit(d: f64) -> f64 {
    let c = [
        2.689075, -1.586889, 0.307166, 0.3041052, 0.7087815, -2.31128, 0.2226069, 3.065767, -1.875321,
    ];
    let d = d.clamp(0.0, 5.8);
    let t: f64 = d / 3.0 - 1.0;
    d * c.iter().enumerate().map(|(i, c)| c * t.powi(i as i32)).sum::<f64>()
}

/// Density of moist air, kg/m³; vapour pressure by Bolton 1980.
pub fn air_density(p: f64, t: f64, humidity: f64) -> f64 {
    let e = humidity * 611.2 * (17.67 * t / (t + 243.5)).exp();
    (p - 0.378 * e) / (287.05 * (t + 273.15))
}

/// Viscosity of air, Pa s.
pub fn air_viscosity(t: f64) -> f64 {
    let warm = (1.718 + 0.0049 * t) * 1e-5;
    if t >= 0.0 { warm } else { warm - 1.2e-10 * t * t }
}

/// Density of water by Kell 1975, kg/m³.
pub fn water_density(t: f64) -> f64 {
    let t = t.max(-30.0);
    let above = 999.83952 + 16.945176 * t - 7.9870401e-3 * t.powi(2) - 46.170461e-6 * t.powi(3)
        + 105.56302e-9 * t.powi(4)
        - 280.54253e-12 * t.powi(5);
    above / (1.0 + 16.879850e-3 * t)
}

/// Beard 1976 in SI units: `d` in m, `p` in Pa, `t` in °C.
pub fn beard(d: f64, p: f64, t: f64) -> f64 {
    let g = 9.80665;
    let water = water_density(t);
    let air = p / (287.05 * (t + 273.15));
    let mu = air_viscosity(t);
    let sigma = 0.0761 - 1.55e-4 * t;
    let excess = water - air;
    let path = 6.62e-8 * (mu / 1.818e-5) * (101325.0 / p) * ((t + 273.15) / 293.15).sqrt();
    let slip = 1.0 + 2.51 * path / d;
    if d <= 0.0 {
        return 0.0;
    }
    let d = d.min(7e-3);
    if d < 19e-6 {
        return slip * excess * g * d * d / (18.0 * mu);
    }
    if d < 1.07e-3 {
        let davies = 4.0 * air * excess * g * d.powi(3) / (3.0 * mu * mu);
        let x = davies.ln();
        let b = [
            -3.18657,
            0.992696,
            -0.00153193,
            -0.000987059,
            -0.000578878,
            0.0000855176,
            -0.00000327815,
        ];
        let y: f64 = b.iter().enumerate().map(|(i, b)| b * x.powi(i as i32)).sum();
        return mu * slip * y.exp() / (air * d);
    }
    let bond = 4.0 * excess * g * d * d / (3.0 * sigma);
    let property = sigma.powi(3) * air.powi(2) / (mu.powi(4) * excess * g);
    let x = (bond * property.powf(1.0 / 6.0)).ln();
    let b = [-5.00015, 5.23778, -2.04914, 0.475294, -0.0542819, 0.00238449];
    let y: f64 = b.iter().enumerate().map(|(i, b)| b * x.powi(i as i32)).sum();
    mu * property.powf(1.0 / 6.0) * y.exp() / (air * d)
}

/// The sources' fits at sea level as printed, by name; no clamp.
///
/// # Panics
/// On a name that no source has.
pub fn printed(name: &str, d: f64) -> f64 {
    match name {
        "foote-du-toit" => [
            -0.085731540,
            3.3265862,
            4.3843578,
            -6.8813414,
            4.7570205,
            -1.9046601,
            0.46339978,
            -0.067607898,
            0.0054455480,
            -0.00018631087,
        ]
        .iter()
        .enumerate()
        .map(|(i, a): (usize, &f64)| a * d.powi(i as i32))
        .sum(),
        "brandes" => -0.1021 + 4.932 * d - 0.9551 * d.powi(2) + 0.07934 * d.powi(3) - 0.002362 * d.powi(4),
        "atlas" => 9.65 - 10.3 * (-0.6 * d).exp(),
        "best" => 9.32 * (1.0 - (-(d / 1.77).powf(1.147)).exp()),
        "weber" => 200.0 * (d / 2000.0).sqrt(),
        "atlas-ulbrich" => 3.78 * d.powf(0.67),
        _ => panic!("no fit called {name}"),
    }
}

/// Yoshida's eqs. 2–4 by iteration, as the source does: `d` in m.
pub fn yoshida(d: f64) -> f64 {
    let (g, water, air, mu) = (9.80665, 998.2, 1.2041, 1.816e-5);
    let stokes = g * d * d * (water - air) / (18.0 * mu);
    if stokes * d * air / mu <= 1.0 {
        return stokes;
    }
    let mut v: f64 = 1.0;
    for _ in 0..2000 {
        let re = v * d * air / mu;
        let drag = (0.55 + 4.8 / re.sqrt()).powi(2);
        v = (4.0 * g * d * (water - air) / (3.0 * air * drag)).sqrt();
    }
    v
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_kept_and_the_curve_rises() {
        for (d, v) in DIAMETERS_MM.into_iter().zip(SPEEDS_M_S) {
            assert!((measured(d) - v).abs() < 1e-12, "{d}");
        }
        assert!((1..600).all(|i| measured(f64::from(i) * 0.01) >= measured(f64::from(i - 1) * 0.01)));
    }
}
