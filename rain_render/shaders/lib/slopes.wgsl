// Slope maps of a water surface: x and y: slope along world x and z; z: variance of the slope lost to filtering, the
// sum of both axes, in the finest level that of waves too short for its texels; w: height above the level, mm.

// One texel of the next level from the four below it. The variance is taken around the mean, so nothing cancels.
fn rain_slope_mip(a: vec4<f32>, b: vec4<f32>, c: vec4<f32>, d: vec4<f32>) -> vec4<f32> {
    var mean = 0.25 * ((a + b) + (c + d));
    let da = a.xy - mean.xy;
    let db = b.xy - mean.xy;
    let dc = c.xy - mean.xy;
    let dd = d.xy - mean.xy;
    mean.z += 0.25 * ((dot(da, da) + dot(db, db)) + (dot(dc, dc) + dot(dd, dd)));
    return mean;
}
