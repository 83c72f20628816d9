// What lies behind what is drawn, over the bindings `view` and `scene_depth` of a pass.

// Distance from what is drawn at a place of the target to the scene behind it, in lengths of the fade.
fn gap_before_scene(place: vec2<f32>, depth: f32) -> f32 {
    // Infinite reverse-Z: distance = near / depth.
    let scene = view.near / max(textureLoad(scene_depth, vec2<i32>(place), 0), 1e-7);
    let own = view.near / max(depth, 1e-7);
    return (scene - own) / view.soft;
}
