// Rain areas, as rain_core::rainfall::areas computes them in single precision.

// Signed distance of `place` from the ellipse with these radii about the origin, m: negative inside. Newton's method on
// 1/|q(w)|, concave and rising in w, from the left. Error: 4e-6 of the larger radius and the distance.
fn rain_ellipse_distance(place: vec2<f32>, radii: vec2<f32>) -> f32 {
    let turned = radii.x < radii.y;
    let r = select(radii, radii.yx, turned);
    let p = abs(select(place, place.yx, turned));
    let gap = (r.x - r.y) * (r.x + r.y);
    var w = max(r.y * p.y, r.x * p.x - gap);
    var q = vec2<f32>(r.x, 0.0);
    if (w > 1e-6 * r.y * r.y) {
        for (var i = 0; i < 24; i += 1) {
            let u = vec2<f32>(r.x * p.x / (w + gap), r.y * p.y / w);
            let square = dot(u, u);
            let slope = u.x * u.x / (w + gap) + u.y * u.y / w;
            let step = square / slope * (sqrt(square) - 1.0);
            w += max(step, 0.0);
            if (step <= 1e-7 * w) {
                break;
            }
        }
        q = vec2<f32>(r.x * (r.x * p.x / (w + gap)), r.y * (r.y * p.y / w));
    } else if (gap > 0.0) {
        let k = min(r.x * p.x / gap, 1.0);
        q = vec2<f32>(r.x * k, r.y * sqrt((1.0 - k) * (1.0 + k)));
    }
    let unit = p / r;
    return select(1.0, -1.0, dot(unit, unit) < 1.0) * length(p - q);
}

// One edge of a polygon from `a` to `b`: x of `found` is the least square of a distance so far, y is -1 inside and 1
// outside by the edges so far. Start with (1e30, 1); the signed distance is y sqrt(x).
fn rain_polygon_edge(found: vec2<f32>, place: vec2<f32>, a: vec2<f32>, b: vec2<f32>) -> vec2<f32> {
    let edge = b - a;
    let rel = place - a;
    let off = rel - clamp(dot(rel, edge) / dot(edge, edge), 0.0, 1.0) * edge;
    let crosses = ((a.y > place.y) != (b.y > place.y)) && ((edge.x * rel.y - edge.y * rel.x > 0.0) == (b.y > a.y));
    return vec2<f32>(min(found.x, dot(off, off)), select(found.y, -found.y, crosses));
}

// How much of an area's rain falls at a signed distance from its outline: 1 inside, 0 outside, 1/2 on it.
fn rain_area_weight(distance: f32, transition: f32) -> f32 {
    if (transition > 0.0) {
        let t = clamp(0.5 - distance / transition, 0.0, 1.0);
        return t * t * (3.0 - 2.0 * t);
    }
    return select(0.0, 1.0, distance < 0.0);
}

// Takes one more area into account: x of `found` is the rate of the showers so far, mm/h, y the product of the scales.
// `rain`: kind (0 a rate, 1 of the weather's, 2 a scale), its value, the area's strength.
fn rain_area_joined(found: vec2<f32>, rain: vec3<f32>, weight: f32, weather: f32) -> vec2<f32> {
    let w = rain.z * weight;
    if (rain.x > 1.5) {
        return vec2<f32>(found.x, found.y * (1.0 - w * (1.0 - rain.y)));
    }
    return vec2<f32>(max(found.x, w * rain.y * select(1.0, weather, rain.x > 0.5)), found.y);
}
