// Where rain lands: the upper side of what the map along the rain holds. Positions are relative to the eye.

struct RainLanding {
    // Height above the eye; not valid where `found` is 0.
    height: f32,
    found: f32,
    normal: vec3<f32>,
}

// Height and slope (by x and z of the reference plane) of the map between its texels; w: 1 where the four texels around
// belong to one surface.
fn rain_cover_surface(map: texture_depth_2d, cover: CoverParams, projected: vec2<f32>) -> vec4<f32> {
    let position = ((projected - cover.centre) * cover.inverse_extent + 0.5) * cover.texels - 0.5;
    let corner = floor(position);
    let f = position - corner;
    if (cover.present < 0.5 || any(corner < vec2<f32>(0.0)) || any(corner > vec2<f32>(cover.texels - 2.0))) {
        return vec4<f32>(0.0);
    }
    let a = vec2<i32>(corner);
    let depth = vec4<f32>(
        textureLoad(map, a, 0),
        textureLoad(map, a + vec2<i32>(1, 0), 0),
        textureLoad(map, a + vec2<i32>(0, 1), 0),
        textureLoad(map, a + vec2<i32>(1, 1), 0),
    );
    let least = min(min(depth.x, depth.y), min(depth.z, depth.w));
    let most = max(max(depth.x, depth.y), max(depth.z, depth.w));
    let per_texel = cover.inverse_extent * cover.texels;
    // Steeper than about 60 degrees is a wall or an edge.
    if (least <= 0.0 || (most - least) * cover.range > 0.03 + 2.5 / per_texel) {
        return vec4<f32>(0.0);
    }
    let height = cover.top - (1.0 - depth) * cover.range;
    let along = mix(height.xz, height.yw, vec2<f32>(f.x));
    let slope = vec2<f32>(mix(height.y - height.x, height.w - height.z, f.y), along.y - along.x) * per_texel;
    return vec4<f32>(mix(along.x, along.y, f.y), slope, 1.0);
}

// A place that the mean rain meets over (x, z) `at`: the highest thing, else what lies near the eye or near
// the reference plane; three corrections each.
// Error: on level ground and roofs 1 mm; within a texel of an edge nothing is found.
fn rain_landing(map: texture_depth_2d, cover: CoverParams, at: vec2<f32>) -> RainLanding {
    var out: RainLanding;
    var starts = array<f32, 3>(cover.highest, min(cover.highest, 0.0), min(cover.highest, cover.plane));
    for (var start = 0; start < 3; start++) {
        var height = starts[start];
        for (var i = 0; i < 3; i++) {
            height = rain_cover_height(map, cover, rain_cover_project(cover, vec3<f32>(at.x, height, at.y)));
        }
        if (height < -1e8) {
            continue;
        }
        let surface = rain_cover_surface(map, cover, rain_cover_project(cover, vec3<f32>(at.x, height, at.y)));
        // Where rain slants past an edge no height agrees with its own ray.
        if (surface.w < 0.5 || abs(surface.x - height) > 0.15) {
            continue;
        }
        // The map's plane is sheared: dy = s·(dx + drift dy).
        let drift = cover.inverse_speed * cover.wind;
        let slope = surface.yz / max(1.0 - dot(surface.yz, drift), 0.2);
        out.height = surface.x;
        out.found = 1.0;
        out.normal = normalize(vec3<f32>(-slope.x, 1.0, -slope.y));
        return out;
    }
    return out;
}
