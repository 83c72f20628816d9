// Look-ups in the depth map along the rain. Positions are relative to the eye.

// Height above the eye of the first thing met by the ray that reaches the reference plane at `projected`;
// far below everything where the map knows nothing.
fn rain_cover_height(map: texture_depth_2d, cover: CoverParams, projected: vec2<f32>) -> f32 {
    let uv = (projected - cover.centre) * cover.inverse_extent + 0.5;
    if (cover.present < 0.5 || any(uv < vec2<f32>(0.0)) || any(uv >= vec2<f32>(1.0))) {
        return -1e9;
    }
    let texel = vec2<i32>(uv * cover.texels);
    let depth = textureLoad(map, texel, 0);
    if (depth <= 0.0) {
        return -1e9;
    }
    return cover.top - (1.0 - depth) * cover.range;
}

// Where the mean ray through `p` meets the reference plane.
fn rain_cover_project(cover: CoverParams, p: vec3<f32>) -> vec2<f32> {
    return p.xz + (p.y - cover.plane) * cover.inverse_speed * cover.wind;
}

// Whether rain of fall speed 1 / `inverse_speed` is stopped before `p`: three starts, one correction each.
fn rain_covered(map: texture_depth_2d, cover: CoverParams, p: vec3<f32>, inverse_speed: f32) -> bool {
    let base = rain_cover_project(cover, p);
    let slope = (inverse_speed - cover.inverse_speed) * cover.wind;
    // Closer than this below the surface counts as on it.
    let above = p.y + 0.02;
    var starts = array<f32, 3>(p.y, max(cover.highest, p.y), 0.5 * (p.y + max(cover.highest, p.y)));
    for (var i = 0; i < 3; i++) {
        var eta = starts[i];
        let h = rain_cover_height(map, cover, base - (eta - p.y) * slope);
        if (h > above) {
            eta = h;
        }
        let again = rain_cover_height(map, cover, base - (eta - p.y) * slope);
        if (again > above && (abs(again - eta) < 0.35 || again > eta)) {
            return true;
        }
    }
    return false;
}

// How far above a surface of this normal its own texels may lie, m: a filter two texels wide on a slope.
fn rain_exposure_bias(cover: CoverParams, normal: vec3<f32>) -> f32 {
    let texel = 1.0 / (cover.inverse_extent * cover.texels);
    let slope = length(normal.xz) / max(abs(normal.y), 0.15);
    return 0.03 + min(2.5 * texel * slope, 0.6);
}

// Share of the rain that reaches `p`, 0..1, along the mean ray: 4 x 4 texels around it, weighted.
// What lies less than `bias` above `p` does not cover it.
fn rain_exposure(map: texture_depth_2d, cover: CoverParams, p: vec3<f32>, bias: f32) -> f32 {
    if (cover.present < 0.5) {
        return 1.0;
    }
    let uv = (rain_cover_project(cover, p) - cover.centre) * cover.inverse_extent + 0.5;
    if (any(uv < vec2<f32>(0.0)) || any(uv >= vec2<f32>(1.0))) {
        return 1.0;
    }
    let position = uv * cover.texels - 0.5;
    let corner = floor(position);
    let f = position - corner;
    let height = 1.0 - (cover.top - p.y) / cover.range;
    let last = vec2<i32>(i32(cover.texels) - 1);
    var sum = 0.0;
    for (var y = -1; y <= 2; y++) {
        for (var x = -1; x <= 2; x++) {
            let texel = clamp(vec2<i32>(corner) + vec2<i32>(x, y), vec2<i32>(0), last);
            let open = select(0.0, 1.0, textureLoad(map, texel, 0) <= height + bias / cover.range);
            // A tent two texels wide on each side.
            let w = max(vec2<f32>(0.0), 1.0 - 0.5 * abs(vec2<f32>(f32(x), f32(y)) - f));
            sum += open * w.x * w.y;
        }
    }
    return clamp(sum * 0.25, 0.0, 1.0);
}
