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

// Whether rain of fall speed 1 / `inverse_speed` is stopped before `p`: three starts, one correction each, then walls.
// Error: 3 % of the points around roofs misclassified, 0.5 % otherwise than on the CPU.
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
    return rain_through_wall(map, cover, base, p.y, slope);
}

// The same for a patch of rain metres across: one start, one correction, no walls.
// Error: 6 % of the points around roofs otherwise than `rain_covered`.
fn rain_patch_covered(map: texture_depth_2d, cover: CoverParams, p: vec3<f32>, inverse_speed: f32) -> bool {
    let base = rain_cover_project(cover, p);
    let slope = (inverse_speed - cover.inverse_speed) * cover.wind;
    let above = p.y + 0.02;
    let h = rain_cover_height(map, cover, base);
    if (h > p.y + RAIN_BUILDING_HEIGHT_M) {
        return true;
    }
    return h > above && rain_cover_height(map, cover, base - (h - p.y) * slope) > above;
}

// Whether a drop would have to come through a wall to a point under the map's top: the way from the point up to the
// top's height is halved to where it passes the map's surface; what the map holds outside of there decides.
fn rain_through_wall(map: texture_depth_2d, cover: CoverParams, base: vec2<f32>, y: f32, slope: vec2<f32>) -> bool {
    let above = y + 0.02;
    let top = rain_cover_height(map, cover, base);
    if (top <= above) {
        return false;
    }
    var below_top = y;
    var over_map = top;
    var outside = rain_cover_height(map, cover, base - (top - y) * slope);
    for (var i = 0; i < 6; i++) {
        let eta = 0.5 * (below_top + over_map);
        let met = rain_cover_height(map, cover, base - (eta - y) * slope);
        if (met > eta) {
            below_top = eta;
        } else {
            over_map = eta;
            outside = met;
        }
    }
    return outside > above;
}

// Whether `p` lies so far below what its mean ray meets that this must be a building, solid down to its walls.
//
// The map holds tops and the walls that face the rain. Slow drops that pass outside a high roof would come in through
// the walls in its lee.
fn rain_inside_building(map: texture_depth_2d, cover: CoverParams, p: vec3<f32>) -> bool {
    return rain_cover_height(map, cover, rain_cover_project(cover, p)) > p.y + RAIN_BUILDING_HEIGHT_M;
}

// How far above a surface of this normal its own texels may lie, m: a filter two texels wide on a slope.
fn rain_exposure_bias(cover: CoverParams, normal: vec3<f32>) -> f32 {
    let texel = 1.0 / (cover.inverse_extent * cover.texels);
    let slope = length(normal.xz) / max(abs(normal.y), 0.15);
    return 0.03 + min(2.5 * texel * slope, 0.6);
}

// Whether the rays that pass `projected` reach down to `floor` (a height): bilinear over four texels, 0..1.
fn rain_open_at(map: texture_depth_2d, cover: CoverParams, projected: vec2<f32>, floor_height: f32) -> f32 {
    let uv = (projected - cover.centre) * cover.inverse_extent + 0.5;
    if (any(uv < vec2<f32>(0.0)) || any(uv >= vec2<f32>(1.0))) {
        return 1.0;
    }
    let position = uv * cover.texels - 0.5;
    let corner = floor(position);
    let f = position - corner;
    let last = vec2<i32>(i32(cover.texels) - 1);
    let a = clamp(vec2<i32>(corner), vec2<i32>(0), last);
    let b = min(a + 1, last);
    // Depth is linear in height.
    let limit = 1.0 - (cover.top - floor_height) / cover.range;
    let open = vec4<f32>(
        f32(textureLoad(map, a, 0) <= limit),
        f32(textureLoad(map, vec2<i32>(b.x, a.y), 0) <= limit),
        f32(textureLoad(map, vec2<i32>(a.x, b.y), 0) <= limit),
        f32(textureLoad(map, b, 0) <= limit),
    );
    return mix(mix(open.x, open.y, f.x), mix(open.z, open.w, f.x), f.y);
}

// Share of the rain that reaches `p`, 0..1. What lies less than `bias` above `p` does not cover it.
//
// Seven equal shares of the flux slant by their own 1/v (quantiles of the spectrum at 25 mm/h, relative to the mean);
// together they make the soft edge of a roof's dry ground. Error: the edge lies within 2 texels of geometry's;
// the shares within 0.04 of the means of the water's sevenths.
fn rain_exposure(map: texture_depth_2d, cover: CoverParams, p: vec3<f32>, bias: f32) -> f32 {
    if (cover.present < 0.5) {
        return 1.0;
    }
    let base = rain_cover_project(cover, p);
    let floor_height = p.y + bias;
    var spread = array<f32, 7>(-0.34, -0.26, -0.18, -0.10, -0.02, 0.16, 0.74);
    // Highest thing that any share could meet.
    var blocker = -1e9;
    let reach = max(cover.highest - p.y, 0.0) * cover.inverse_speed * cover.wind;
    for (var i = 0; i < 7; i += 2) {
        blocker = max(blocker, rain_cover_height(map, cover, base - reach * (0.5 * spread[i])));
    }
    let own = rain_cover_height(map, cover, base);
    blocker = select(blocker, own, own > floor_height);
    if (blocker <= floor_height) {
        return rain_open_at(map, cover, base, floor_height);
    }
    let slant = (blocker - p.y) * cover.inverse_speed * cover.wind;
    var sum = 0.0;
    for (var i = 0; i < 7; i++) {
        sum += rain_open_at(map, cover, base - slant * spread[i], floor_height);
    }
    return sum / 7.0;
}
