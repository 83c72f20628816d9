// Mist of splashes: layers of extinction over what rain hits, as rain_core::splash::MistLayer has them. What rain hits is
// what the depth map along the rain holds. Positions are relative to the eye.

// What lies deeper than this under the map's surface is under a roof, m; less is the map's rounding on slopes.
const RAIN_MIST_UNDER_M: f32 = 0.1;

// Places back along a line of sight at which the layer is looked up, in units of its height over the line's slope.
const RAIN_MIST_PLACES: u32 = 6u;
const RAIN_MIST_LAST: f32 = 6.3;
// Longest unit: lines along the ground leave it somewhere, m.
const RAIN_MIST_UNIT_M: f32 = 3.0;

// Pieces of the way about an edge, and how far before and behind it they reach, m.
const RAIN_MIST_PIECES: u32 = 12u;
const RAIN_MIST_ABOUT_M: f32 = 2.4;

// Less of a layer than this is not there.
const RAIN_MIST_LEAST: f32 = 1e-3;

// Share of a layer's extinction at its surface that is left at `p`: 0 under what covers and where nothing is known.
fn rain_mist_at(map: texture_depth_2d, cover: CoverParams, p: vec3<f32>, height: f32) -> f32 {
    let projected = rain_cover_project(cover, p);
    let place = ((projected - cover.centre) * cover.inverse_extent + 0.5) * cover.texels - 0.5;
    let corner = floor(place);
    let f = place - corner;
    let last = vec2<i32>(i32(cover.texels) - 1);
    let a = clamp(vec2<i32>(corner), vec2<i32>(0), last);
    let b = min(a + 1, last);
    let depth = vec4<f32>(
        textureLoad(map, a, 0),
        textureLoad(map, vec2<i32>(b.x, a.y), 0),
        textureLoad(map, vec2<i32>(a.x, b.y), 0),
        textureLoad(map, b, 0),
    );
    let over = p.y - cover.top + (1.0 - depth) * cover.range;
    let open = smoothstep(vec4<f32>(-RAIN_MIST_UNDER_M), vec4<f32>(-0.4 * RAIN_MIST_UNDER_M), over);
    let known = step(vec4<f32>(1e-9), depth);
    let share = exp(-max(over, vec4<f32>(0.0)) / height) * open * known;
    return mix(mix(share.x, share.y, f.x), mix(share.z, share.w, f.x), f.y);
}

// How much the map says about `p`: all inside, nothing outside, softly at its border.
fn rain_mist_mapped(cover: CoverParams, p: vec3<f32>) -> f32 {
    let off = abs((rain_cover_project(cover, p) - cover.centre) * cover.inverse_extent) * 2.0;
    return cover.present * (1.0 - smoothstep(0.88, 0.98, max(off.x, off.y)));
}

// Mean of a share between two places at which it is `a` and `b`: it falls as a layer's does; over an edge by a tenth.
fn rain_mist_mean(a: f32, b: f32) -> f32 {
    let high = max(a, b);
    let low = max(min(a, b), 0.1 * high);
    if (high < 1e-4) {
        return 0.0;
    }
    let x = log(high / low);
    return select(0.5 * (high + low), (high - low) / x, x > 0.02);
}

// Length of the layer before what is seen at the end of a line of sight, m.
fn rain_mist_reach(rise: f32, height: f32) -> f32 {
    return RAIN_MIST_LAST * min(height / max(abs(rise), 1e-4), RAIN_MIST_UNIT_M);
}

// Metres of the layer's extinction at its surface on the last part of a line of sight that ends after `way`, no more
// than `rain_mist_reach` of it; `share` is that at its end. Over even ground exact to 3e-3.
fn rain_mist_before(
    map: texture_depth_2d, cover: CoverParams, towards: vec3<f32>, way: f32, height: f32, start: f32, share: f32,
) -> f32 {
    let unit = rain_mist_reach(towards.y, height) / RAIN_MIST_LAST;
    var places = array<f32, RAIN_MIST_PLACES>(0.25, 0.7, 1.4, 2.5, 4.2, RAIN_MIST_LAST);
    var sum = 0.0;
    var at = way;
    var here = share;
    for (var i = 0u; i < RAIN_MIST_PLACES; i += 1u) {
        let next = max(way - unit * places[i], start);
        if (next >= at) {
            break;
        }
        let there = rain_mist_at(map, cover, towards * next, height);
        sum += (at - next) * rain_mist_mean(here, there);
        at = next;
        here = there;
    }
    return sum;
}

// The same about an edge that a line of sight passes over after `edge`, between `start` and `end`.
fn rain_mist_over(
    map: texture_depth_2d, cover: CoverParams, towards: vec3<f32>, edge: f32, start: f32, end: f32, height: f32,
) -> f32 {
    // Fine where a ledge may end. What is seen may be the edge at either end.
    var places = array<f32, RAIN_MIST_PIECES>(
        -1.7, -1.15, -0.7, -0.35, -0.12, 0.03, 0.18, 0.4, 0.75, 1.2, 1.75, RAIN_MIST_ABOUT_M);
    var at = max(edge - RAIN_MIST_ABOUT_M, start);
    var sum = 0.0;
    var share = rain_mist_at(map, cover, towards * at, height);
    for (var i = 0u; i < RAIN_MIST_PIECES; i += 1u) {
        let next = clamp(edge + places[i], start, end);
        if (next > at) {
            let there = rain_mist_at(map, cover, towards * next, height);
            sum += (next - at) * rain_mist_mean(share, there);
            at = next;
            share = there;
        }
    }
    return sum;
}

// The same over wide level ground that ends a line of sight from above. Error: 1e-6.
fn rain_mist_on_level(rise: f32, way: f32, height: f32) -> f32 {
    let slope = max(-rise, 0.01) / height;
    return rain_haze_share(way * slope) / slope;
}

// The same of a layer over a level floor `floor_height` from the eye, between two places on a line of sight. Error: 1e-5.
fn rain_mist_over_floor(floor_height: f32, rise: f32, start: f32, end: f32, height: f32) -> f32 {
    let a = rise * start - floor_height;
    let b = rise * end - floor_height;
    let high = max(a, b);
    let low = min(a, b);
    if (end <= start) {
        return 0.0;
    }
    if (high <= 0.0) {
        return end - start;
    }
    // Below the floor all of it.
    let under = select(0.0, -low / (high - low), low < 0.0);
    let from_low = max(low, 0.0);
    let x = (high - from_low) / height;
    let mean = exp(-min(from_low / height, 80.0)) * select(1.0 - 0.5 * x, rain_haze_share(x) / x, x > 1e-4);
    return (end - start) * (under + (1.0 - under) * mean);
}

// Height from the eye of the ground about it, m: what the map holds under the eye at 16 places within 12 m, low places
// more; 1e9 where it holds nothing there. `height` is the layer's.
fn rain_mist_floor(map: texture_depth_2d, cover: CoverParams, height: f32) -> f32 {
    if (cover.present < 0.5) {
        return 1e9;
    }
    var lowest = 1e9;
    var heights = array<f32, 16>();
    for (var i = 0u; i < 16u; i += 1u) {
        let turn = 2.3999632 * f32(i);
        let off = 12.0 * sqrt((f32(i) + 0.5) / 16.0) * vec2<f32>(cos(turn), sin(turn));
        let found = rain_cover_height(map, cover, rain_cover_project(cover, vec3<f32>(off.x, 0.0, off.y)));
        heights[i] = select(1e9, found, found > -1e8 && found < 0.0);
        lowest = min(lowest, heights[i]);
    }
    if (lowest > 0.0) {
        return 1e9;
    }
    var sum = 0.0;
    var count = 0.0;
    for (var i = 0u; i < 16u; i += 1u) {
        if (heights[i] < 0.0) {
            sum += exp(-min((heights[i] - lowest) / height, 80.0));
            count += 1.0;
        }
    }
    return lowest - height * log(sum / count);
}
