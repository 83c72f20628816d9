// The sources' own rules for wet surfaces, line by line those of rain_core::surface::artist_look. Gloss 1 is a mirror.

struct ArtistLook {
    albedo: vec3<f32>,
    gloss: f32,
    // Reflectance at normal incidence.
    normal_reflectance: vec3<f32>,
}

// Lagarde 2013, equations 1 and 2.
fn rain_lagarde_wet(look: ArtistLook, wetness: f32) -> ArtistLook {
    let gloss = min(look.gloss * mix(1.0, 2.5, wetness), 1.0);
    return ArtistLook(look.albedo * mix(1.0, 0.3, wetness), gloss, look.normal_reflectance);
}

// Lagarde 2013, part 3b: porosity of a dielectric by its gloss.
fn rain_lagarde_porosity(gloss: f32, metalness: f32) -> f32 {
    return clamp((0.5 - gloss) / 0.4, 0.0, 1.0) * (1.0 - metalness);
}

// Lagarde 2013, part 3b.
fn rain_lagarde_porous_wet(look: ArtistLook, porosity: f32, wetness: f32) -> ArtistLook {
    let factor = mix(1.0, 0.2, porosity);
    let gloss = mix(1.0, look.gloss, mix(1.0, factor, 0.5 * wetness));
    return ArtistLook(look.albedo * mix(1.0, factor, wetness), gloss, look.normal_reflectance);
}

// Lagarde 2013, equation 3: under accumulated water.
fn rain_lagarde_flooded(look: ArtistLook, water: f32) -> ArtistLook {
    return ArtistLook(look.albedo, mix(look.gloss, 1.0, water), mix(look.normal_reflectance, vec3<f32>(0.02), water));
}

// Nguyenova 2021, listing L2.
fn rain_nguyenova_puddle(look: ArtistLook, amount: f32) -> ArtistLook {
    return ArtistLook(look.albedo * mix(1.0, 0.8, amount), mix(look.gloss, 1.0, amount), look.normal_reflectance);
}

// A surface of a wet level under accumulated water. Rules: 1 Lagarde, 2 Lagarde with porosity, 3 Nguyenova.
//
// Error: 1e-6.
fn rain_artist_surface(
    rules: u32, look: ArtistLook, porosity: f32, metalness: f32, wet_level: f32, water: f32,
) -> ArtistLook {
    let level = clamp(wet_level, 0.0, 1.0);
    let a = clamp(water, 0.0, 1.0);
    let wetness = clamp(level + a, 0.0, 1.0);
    var wet = rain_lagarde_flooded(rain_lagarde_wet(look, wetness), a);
    if (rules == 2u) {
        wet = rain_lagarde_flooded(rain_lagarde_porous_wet(look, clamp(porosity, 0.0, 1.0), wetness), a);
    } else if (rules == 3u) {
        wet = rain_nguyenova_puddle(rain_lagarde_wet(look, level), a);
    }
    wet.albedo = mix(wet.albedo, look.albedo, clamp(metalness, 0.0, 1.0));
    return wet;
}

// Pore saturation, share under a film and share under standing water of a fixed state: 1 dry, 2 wet, 3 drenched, 4
// puddle (Nakamae et al. 1990).
fn rain_fixed_state(state: u32) -> vec3<f32> {
    var states = array<vec3<f32>, 4>(
        vec3<f32>(0.0),
        vec3<f32>(1.0, 0.0, 0.0),
        vec3<f32>(1.0, 0.5, 0.5),
        vec3<f32>(1.0),
    );
    return states[clamp(state, 1u, 4u) - 1u];
}
