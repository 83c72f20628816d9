// Wavelets on a film that runs down sloping ground: the twins of rain_core::surface::film_waves.

// Velocity (x, z) of wavelets on `film` mm above the texture, m/s. `per_slope` is 5/3 / n over 100: with the depth in mm.
// Error: 1e-5 relative.
fn rain_film_wave_velocity(normal: vec3<f32>, film: f32, per_slope: f32) -> vec2<f32> {
    let sine = length(normal.xz);
    if (sine <= 0.0 || normal.y <= 0.0 || film <= 0.0) {
        return vec2<f32>(0.0);
    }
    return normal.xz * (per_slope * pow(film, 0.6666667) * normal.y / sqrt(sine));
}

// Root mean square slope of the wavelets. Error: 1e-6.
fn rain_film_wave_slope(film: f32, speed: f32) -> f32 {
    if (film <= 0.0) {
        return 0.0;
    }
    let froude = 0.6 * speed / sqrt(9.80665e-3 * film);
    return 0.05 * smoothstep(0.0, 1.5, froude) * min(5.0 * film, 1.0);
}

// Slopes of value noise of one octave; `block`, `p` and the lattice as in rain_value_noise. `aside` is in points.
fn rain_noise_slope(block: vec2<f32>, p: vec2<f32>, points: f32, aside: vec2<f32>, seed: u32) -> vec2<f32> {
    let place = p * points + aside;
    let corner = floor(place);
    let f = place - corner;
    let t = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    let steep = 30.0 * f * f * (f - 1.0) * (f - 1.0);
    let cell = vec2<i32>(block) * i32(256.0 * points) + vec2<i32>(corner);
    let near = bitcast<vec2<u32>>(cell) & vec2<u32>(4095u);
    let far = (near + 1u) & vec2<u32>(4095u);
    let a = rain_unit(rain_pcg3d(vec3<u32>(near, seed)).x);
    let b = rain_unit(rain_pcg3d(vec3<u32>(far.x, near.y, seed)).x);
    let c = rain_unit(rain_pcg3d(vec3<u32>(near.x, far.y, seed)).x);
    let d = rain_unit(rain_pcg3d(vec3<u32>(far, seed)).x);
    return steep * vec2<f32>(mix(b - a, d - c, t.y), mix(c - a, d - b, t.x));
}

// Share of an octave's slopes that a pixel of this width can show.
fn rain_flow_resolved(points: f32, footprint: f32) -> f32 {
    return 1.0 - smoothstep(0.5, 2.0, footprint * points);
}

// Slope along the flow of one octave: noise drawn out across the flow.
fn rain_flow_octave(block: vec2<f32>, p: vec2<f32>, along: vec2<f32>, points: f32, seed: u32) -> f32 {
    let across = vec2<f32>(-along.y, along.x);
    let sum = rain_noise_slope(block, p, points, -across, seed) + rain_noise_slope(block, p, points, vec2<f32>(0.0), seed)
        + rain_noise_slope(block, p, points, across, seed);
    return dot(sum, along) / RAIN_FLOW_NOISE;
}

// Slopes of wavelets of unit root mean square slope that `velocity` carries along at `p`, relative to the eye at world
// (x, z) `eye`; `time` in s from 0 to 4096. z: variance of the slopes that a pixel `footprint` m wide cannot show.
// Error: 2e-3.
fn rain_film_wavelets(eye: vec2<f32>, p: vec2<f32>, time: f32, velocity: vec2<f32>, footprint: f32) -> vec3<f32> {
    let speed = length(velocity);
    let shown = vec2<f32>(rain_flow_resolved(8.0, footprint), rain_flow_resolved(32.0, footprint));
    let hidden = 1.0 - dot(shown * shown, vec2<f32>(0.6, 0.4));
    if (speed <= 0.0 || shown.x <= 0.0) {
        return vec3<f32>(0.0, 0.0, select(0.0, hidden, speed > 0.0));
    }
    let along = velocity / speed;
    let block = floor(eye / 256.0);
    let q = (eye - 256.0 * block) + p;
    var sum = 0.0;
    var squares = 0.0;
    for (var phase = 0u; phase < 2u; phase++) {
        let turns = time / RAIN_FLOW_PERIOD_S + 0.5 * f32(phase);
        let part = fract(turns);
        let weight = 1.0 - abs(2.0 * part - 1.0);
        let source = q - (part - 0.5) * RAIN_FLOW_PERIOD_S * velocity;
        let seed = 2u * (u32(turns) & 2047u) + phase;
        var slope = 0.7745967 * shown.x * rain_flow_octave(block, source, along, 8.0, seed);
        if (shown.y > 0.0) {
            slope += 0.6324555 * shown.y * rain_flow_octave(block, source, along, 32.0, seed + 4096u);
        }
        sum += weight * slope;
        squares += weight * weight;
    }
    return vec3<f32>(along * sum * inverseSqrt(squares), hidden);
}
