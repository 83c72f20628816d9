// Water that pours from eaves and pipes, as rain_core::spout computes it.

// Where water is `age` s after it left a mouth, from there, m. Error: 2e-5 m against the CPU's for drops, 2e-4 m for jets.
fn rain_spout_place(velocity: vec3<f32>, terminal: f32, wind: vec3<f32>, age: f32) -> vec3<f32> {
    let time = terminal / 9.80665;
    let tau = age / time;
    let start = max(-velocity.y / terminal, 0.0);
    let level = time * (1.0 - exp(-tau));
    let down = tau + log(0.5 * (1.0 + start) + 0.5 * (1.0 - start) * exp(-2.0 * tau));
    let sideways = wind * age + (velocity - wind) * level;
    return vec3<f32>(sideways.x, -terminal * time * down, sideways.z);
}

// When it has fallen `height` m, s. Error: 1e-3 s against the CPU's.
fn rain_spout_time(velocity: vec3<f32>, terminal: f32, height: f32) -> f32 {
    let time = terminal / 9.80665;
    let start = max(-velocity.y / terminal, 0.0);
    // e^z − 1 by its series where it is small: nothing cancels.
    let z = max(height, 0.0) / (terminal * time);
    let more = select(exp(z) - 1.0, z * (1.0 + 0.5 * z * (1.0 + z / 3.0)), z < 0.05);
    let root = sqrt(more * (2.0 + more) + start * start);
    return time * log((1.0 + more + root) / (1.0 + start));
}

// Downward speed after `age` s, m/s. Error: 1e-4 relative, of 0.1 m/s at least, to the CPU's.
fn rain_spout_speed(velocity: vec3<f32>, terminal: f32, age: f32) -> f32 {
    let start = max(-velocity.y / terminal, 0.0);
    let slope = tanh(min(age * 9.80665 / terminal, 10.0));
    return terminal * (start + slope) / (1.0 + start * slope);
}
