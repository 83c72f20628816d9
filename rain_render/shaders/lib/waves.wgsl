// Waves on shallow water; the twins of rain_core::waves.

// erf(x), the rational function of erf_f32.
fn rain_erf(argument: f32) -> f32 {
    let x = clamp(argument, -4.0, 4.0);
    let t = x * x;
    let p = ((((1.9867844e-6 * t + 2.8456634e-4) * t + 3.883352e-3) * t + 5.310177e-2) * t + 1.935452e-1) * t
        + 1.1283792;
    let q = ((((3.742022e-5 * t + 1.1855736e-3) * t + 1.5207266e-2) * t + 1.1535007e-1) * t + 5.048575e-1) * t + 1.0;
    return clamp(x * p / q, -1.0, 1.0);
}

// Mean of a Gaussian over the way of a source and s²∇² of it, at a place along (from the middle) and across, over the
// width s; `length` over s. Short ways by the series of even derivatives, where the difference of two erf cancels.
fn rain_swept(middle: f32, across: f32, length: f32) -> vec2<f32> {
    let a2 = across * across;
    let half = 0.5 * length;
    if (a2 >= 100.0 || abs(middle) - half >= 10.0) {
        return vec2<f32>(0.0);
    }
    let x = middle * middle;
    if (length < 1.0) {
        let f1 = x - 1.0;
        let f2 = (x - 6.0) * x + 3.0;
        let f3 = ((x - 15.0) * x + 45.0) * x - 15.0;
        let f4 = (((x - 28.0) * x + 210.0) * x - 420.0) * x + 105.0;
        let f5 = ((((x - 45.0) * x + 630.0) * x - 3150.0) * x + 4725.0) * x - 945.0;
        let q = length * length;
        let mean = 1.0 + q * (f1 / 24.0 + q * (f2 / 1920.0 + q * (f3 / 322560.0 + q * (f4 / 92897280.0))));
        let curve = f1 + q * (f2 / 24.0 + q * (f3 / 1920.0 + q * (f4 / 322560.0 + q * (f5 / 92897280.0))));
        return exp(-0.5 * (a2 + x)) * vec2<f32>(mean, mean * (a2 - 1.0) + curve);
    }
    let a = middle + half;
    let b = middle - half;
    let root = 0.70710678;
    let mean = 1.2533141 / length * (rain_erf(a * root) - rain_erf(b * root));
    let curve = (b * exp(-0.5 * b * b) - a * exp(-0.5 * a * a)) / length;
    return exp(-0.5 * a2) * vec2<f32>(mean, mean * (a2 - 1.0) + curve);
}

// c² of the face between two cells over that of the fastest wave, from their relative depths; 0 at a shore.
fn rain_wave_face(a: f32, b: f32) -> f32 {
    return select(0.0, 0.5 * (a + b), a > 0.0 && b > 0.0);
}

// The next height of a cell from the two before and the sum over its faces. `keep` shrinks all heights alike, so that
// u = keepⁿ times the water that does not shrink; with 1 it is the step of WaveField. Tiny heights become 0, for a
// quiet pond must not run into denormal numbers.
fn rain_wave_next(u: f32, before: f32, sum: f32, g: f32, courant_squared: f32, keep: f32) -> f32 {
    let next = keep * (u + (g * (u - keep * before) + (0.5 + 0.5 * g) * courant_squared * sum));
    return select(next, 0.0, abs(next) < 1e-20);
}

// Share of u - u⁻ that an absorbing rim leaves, by the distance of a cell's middle from the edge, in cells.
fn rain_wave_rim(distance: f32, rim: f32, strongest: f32) -> f32 {
    let depth = max(1.0 - distance / rim, 0.0);
    let a = strongest * depth * depth;
    return (1.0 - a) / (1.0 + a);
}
