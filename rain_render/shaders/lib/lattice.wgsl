// Cards of the lattice, as rain_core::rainfall has them. Positions are relative to the eye, in metres.

// Weight of cards by the length of the horizontal part of a line of sight. Error: 1e-6.
fn rain_pitch_weight(cos_pitch: f32) -> f32 {
    return rain_ramp(0.5, 0.70710678, cos_pitch);
}

// Opacity of a card where a unit line of sight meets it, over that of a card that is seen square on. `facing`: x and z
// of its normal. Error: 1e-5 relative.
fn rain_card_slant(facing: vec2<f32>, sight: vec3<f32>) -> f32 {
    let head_on = -dot(sight.xz, facing);
    return rain_pitch_weight(length(sight.xz)) / max(head_on, 0.05);
}

// Place in the picture, in turns, of a point of a card's plane.
fn rain_card_place(card: Card, point: vec3<f32>) -> vec2<f32> {
    let from_middle = point - card.centre.xyz;
    let local = vec2<f32>(dot(from_middle.xz, vec2<f32>(card.facing.y, -card.facing.x)), from_middle.y);
    return card.place.xy + local.x * card.turn.xy + local.y * card.turn.zw;
}

// Offset of one of the card's pictures, in turns.
fn rain_card_offset(layers: vec4<u32>, sample: u32) -> vec2<f32> {
    let h = rain_pcg3d(vec3<u32>(layers.w, sample, layers.x));
    return select(vec2<f32>(rain_unit(h.x), rain_unit(h.y)), vec2<f32>(0.0), sample == 0u);
}
