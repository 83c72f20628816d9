// One of the rain areas that a pass has bound as `areas: array<vec4<f32>>`, packed as rain_core packs them: a row of numbers
// (areas, share outside, the weather's rate, what the pass adds), then three rows and the corners of each.

struct PackedArea {
    // Signed distance of the place from its outline, m, and width of its soft edge, m.
    distance: f32,
    transition: f32,
    rain: vec3<f32>,
    // Row of the next.
    next: u32,
}

// The area at `row` as it lies to a place (x, z).
fn packed_area(row: u32, place: vec2<f32>) -> PackedArea {
    let at = areas[row];
    let outline = areas[row + 1u];
    let rain = areas[row + 2u];
    let corners = u32(rain.w);
    let p = place - at.xy;
    var distance = -1e30;
    if (outline.w > 1.5) {
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
    } else if (outline.w > 0.5) {
        let along = vec2<f32>(dot(at.zw, p), at.z * p.y - at.w * p.x);
        distance = rain_ellipse_distance(along, outline.xy);
    }
    return PackedArea(distance, outline.z, rain.xyz, row + 3u + (corners + 1u) / 2u);
}
