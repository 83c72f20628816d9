// One of the rain areas that a pass has bound as `areas: array<vec4<f32>>`, packed as rain_core packs them: a row of numbers
// (areas, share outside, the weather's rate, what the pass adds), then three rows and the corners of each.

struct PackedArea {
    // Signed distance of the place from its outline, m, and width of its soft edge, m.
    distance: f32,
    transition: f32,
    rain: vec3<f32>,
    // Share of its rain that is painted at the place; 1 where nothing is.
    density: f32,
    painted: bool,
    // Row of the next.
    next: u32,
}

// One of the values of a density whose values begin at row `first`: twelve a row, three a number.
fn density_value(first: u32, index: u32) -> f32 {
    let three = u32(areas[first + index / 12u][(index % 12u) / 3u]);
    return f32((three >> (8u * (index % 3u))) & 255u) / 255.0;
}

// The painted share at a place from the area's centre. `row`: half the size and the cells, the values behind.
fn density_at(row: u32, place: vec2<f32>) -> f32 {
    let head = areas[row];
    let at = clamp((place / (2.0 * head.xy) + 0.5) * head.zw - 0.5, vec2<f32>(0.0), head.zw - 1.0);
    let low = min(vec2<u32>(at), vec2<u32>(head.zw) - 2u);
    let t = at - vec2<f32>(low);
    let width = u32(head.z);
    let first = low.y * width + low.x;
    let near = mix(density_value(row + 1u, first), density_value(row + 1u, first + 1u), t.x);
    let far = mix(density_value(row + 1u, first + width), density_value(row + 1u, first + width + 1u), t.x);
    return mix(near, far, t.y);
}

// The area at `row` as it lies to a place (x, z).
fn packed_area(row: u32, place: vec2<f32>) -> PackedArea {
    let at = areas[row];
    let outline = areas[row + 1u];
    let rain = areas[row + 2u];
    let corners = u32(rain.w);
    let p = place - at.xy;
    var distance = -1e30;
    let painted = outline.w > 3.5;
    let kind = outline.w - select(0.0, 4.0, painted);
    if (kind > 1.5) {
        var edges = vec2<f32>(1e30, 1.0);
        let last = areas[row + 3u + (corners - 1u) / 2u];
        var before = select(last.xy, last.zw, corners % 2u == 0u);
        for (var c = 0u; c < corners; c += 1u) {
            let two = areas[row + 3u + c / 2u];
            let corner = select(two.xy, two.zw, c % 2u == 1u);
            edges = rain_polygon_edge(edges, p, before, corner);
            before = corner;
        }
        distance = edges.y * sqrt(edges.x);
    } else if (kind > 0.5) {
        let along = vec2<f32>(dot(at.zw, p), at.z * p.y - at.w * p.x);
        distance = rain_ellipse_distance(along, outline.xy);
    }
    var next = row + 3u + (corners + 1u) / 2u;
    var density = 1.0;
    if (painted) {
        density = density_at(next, p);
        next += 1u + (u32(areas[next].z) * u32(areas[next].w) + 11u) / 12u;
    }
    return PackedArea(distance, outline.z, rain.xyz, density, painted, next);
}

// Rain rate at a place (x, z), mm/h.
fn packed_rate(place: vec2<f32>) -> f32 {
    let head = areas[0];
    var found = vec2<f32>(head.y * head.z, 1.0);
    var row = 1u;
    for (var i = 0u; i < u32(head.x); i += 1u) {
        let area = packed_area(row, place);
        found = rain_area_joined(found, area.rain, rain_area_weight(area.distance, area.transition) * area.density, head.z);
        row = area.next;
    }
    return clamp(found.x * found.y, 0.0, 500.0);
}
