// What is transparent stands between the eye and a point, or not. Positions are relative to the eye, in metres.

// Whether the line of sight to a point has passed through a pane before it gets there. Error: exact but for rounding.
fn rain_behind_pane(pane: GlassPane, point: vec3<f32>) -> bool {
    // In the pane's own frame.
    let eye = vec3<f32>(pane.along.w, pane.up.w, pane.across.w);
    let way = vec3<f32>(dot(pane.along.xyz, point), dot(pane.up.xyz, point), dot(pane.across.xyz, point));
    let inverse = 1.0 / select(way, vec3<f32>(1e-12), abs(way) < vec3<f32>(1e-12));
    let one = (-1.0 - eye) * inverse;
    let other = (1.0 - eye) * inverse;
    let enter = min(one, other);
    let leave = max(one, other);
    let last = min(min(leave.x, leave.y), leave.z);
    return max(max(enter.x, enter.y), enter.z) <= last && last > 0.0 && last < 1.0;
}
