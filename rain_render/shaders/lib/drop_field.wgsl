// The frozen drop field, as rain_core::rainfall computes it.

// `stream` is the class's random stream, `cell` the absolute lattice cell.
fn rain_cell_key(stream: vec3<u32>, cell: vec3<i32>) -> vec3<u32> {
    return rain_pcg3d(stream ^ bitcast<vec3<u32>>(cell));
}

// Hash of drop `index`: rank increment, diameter, phase of its swing.
fn rain_drop_marks(key: vec3<u32>, index: u32) -> vec3<u32> {
    return rain_pcg3d(vec3<u32>(key.x ^ (index * 0x9E3779B9u), key.y + index, key.z));
}

// Place inside the cell, in cells.
fn rain_drop_place(key: vec3<u32>, index: u32) -> vec3<f32> {
    let h = rain_pcg3d(vec3<u32>(key.y ^ (index * 0x85EBCA6Bu), key.z + index, key.x));
    return vec3<f32>(rain_unit(h.x), rain_unit(h.y), rain_unit(h.z));
}

// Presence of a drop with this rank where the threshold of its diameter is `limit` > 0: 1 inside, a soft ramp there.
fn rain_soft_presence(rank: f32, limit: f32) -> f32 {
    return clamp(0.5 + (1.0 - rank / limit) / (2.0 * RAIN_SOFT_EDGE), 0.0, 1.0);
}

// Inverse of the reference distribution inside a class, mm. Error: 1e-4 relative to the CPU's.
fn rain_diameter_mm(exp_min: f32, exp_span: f32, u: f32) -> f32 {
    return -0.5 * log(exp_min - u * exp_span);
}

// Terminal velocity of a diameter in mm, m/s: least squares to Gunn & Kinzer 1949. Error: 1e-4 relative to the CPU's.
fn rain_terminal_velocity(diameter_mm: f32) -> f32 {
    let d = min(diameter_mm, 5.8);
    let t = d / 3.0 - 1.0;
    var p = -1.875321;
    p = p * t + 3.065767;
    p = p * t + 0.2226069;
    p = p * t - 2.31128;
    p = p * t + 0.7087815;
    p = p * t + 0.3041052;
    p = p * t + 0.307166;
    p = p * t - 1.586889;
    p = p * t + 2.689075;
    return d * p;
}

// A drop of a view's records.
struct FieldDrop {
    // Relative to the eye, m.
    place: vec3<f32>,
    diameter: f32,
    // In [0, 1), its own.
    chance: f32,
}

// The drop that a record of class `k` names; `diameter` in mm. Error: 1e-5 m.
fn rain_field_drop(record: DropRecord, k: RainfallClass) -> FieldDrop {
    let index = (record.drop >> 4u) & 0xFFFu;
    let relative = vec3<i32>(
        i32(record.cell & 1023u),
        i32((record.cell >> 10u) & 1023u),
        i32((record.cell >> 20u) & 1023u),
    ) - 512;
    let key = rain_cell_key(k.stream.xyz, k.cell.xyz + relative);
    let place = rain_drop_place(key, index);
    let marks = rain_drop_marks(key, index);
    let diameter_mm = rain_diameter_mm(k.diameter.x, k.diameter.y, rain_unit(marks.y));
    let p = (vec3<f32>(relative) - k.fraction.xyz + place) * k.fraction.w;
    return FieldDrop(p, diameter_mm, rain_unit(marks.z));
}
