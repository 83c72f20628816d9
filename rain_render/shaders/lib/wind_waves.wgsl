// Waves that wind makes on small water, as exact far from the world's origin as at it.

// Slope of one train of unit amplitude at `p`, relative to the eye, `time` in s. `direction` counts the directions of a
// full turn from x, `cycles` its waves over the tile's side, `start` a part of a turn.
//
// Its wave vector and its frequency are whole numbers of cycles in the tile and in the period of time: the eye's place in
// both is all that it needs to know of the world.
fn rain_wind_train(look: WaterLook, p: vec2<f32>, time: f32, direction: f32, cycles: f32, start: f32) -> vec2<f32> {
    let angle = direction * (6.2831853 / RAIN_WIND_DIRECTIONS);
    let wave = round(cycles * vec2<f32>(cos(angle), sin(angle)));
    let waves = length(wave);
    let per_m = look.ambient.y / RAIN_WIND_TILE;
    let turns = round(length(look.ambient.zw) * waves * per_m * RAIN_WAVE_PERIOD_S);
    // Whole seconds in whole numbers: their product has more digits than a float.
    let second = floor(time);
    let done = f32((u32(turns) * u32(second)) % u32(RAIN_WAVE_PERIOD_S)) + turns * (time - second);
    let phase = fract(dot(wave, look.place.xy)) + dot(wave, p * per_m) - fract(done / RAIN_WAVE_PERIOD_S) + start;
    return wave / waves * cos(6.2831853 * fract(phase));
}

// Slopes (dh/dx, dh/dz) of wind waves at `p`, relative to the eye, `time` in s from 0 to RAIN_WAVE_PERIOD_S: five octaves
// within 40 degrees of the wind, each half as long and a third as steep as the one before it.
//
// An octave's direction lies between two of a full turn's and is shared by their trains: when the wind turns, trains
// rise and fall where they are. A train that turned with it would race by, the faster the farther from the origin.
fn rain_wind_slopes(look: WaterLook, p: vec2<f32>, time: f32) -> vec2<f32> {
    if (look.ambient.x <= 0.0 || all(look.ambient.zw == vec2<f32>(0.0))) {
        return vec2<f32>(0.0);
    }
    let along = atan2(look.ambient.w, look.ambient.z);
    var angles = array<f32, 5>(0.1, -0.52, 0.44, -0.23, 0.68);
    var slopes = vec2<f32>(0.0);
    var cycles = RAIN_WIND_TILE;
    // Mean squares 1, 1/1.7, ... of each octave sum up to look.ambient.x.
    var square = look.ambient.x * 0.4428;
    for (var i = 0; i < 5; i++) {
        let direction = (along + angles[i]) * (RAIN_WIND_DIRECTIONS / 6.2831853);
        let lower = floor(direction);
        let share = smoothstep(0.0, 1.0, direction - lower);
        let size = sqrt(2.0 * square);
        // The same number for the same direction, however often it was turned.
        let first = lower - RAIN_WIND_DIRECTIONS * floor(lower / RAIN_WIND_DIRECTIONS);
        let second = select(first + 1.0, 0.0, first > RAIN_WIND_DIRECTIONS - 1.5);
        let start = 0.271 * f32(i);
        slopes += size * sqrt(1.0 - share) * rain_wind_train(look, p, time, first, cycles, start + 0.618 * first);
        slopes += size * sqrt(share) * rain_wind_train(look, p, time, second, cycles, start + 0.618 * second);
        cycles *= 2.13;
        square /= 1.7;
    }
    return slopes;
}
