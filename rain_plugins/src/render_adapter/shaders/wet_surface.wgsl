// A StandardMaterial that gets wet: darker body, water film on top, dry under cover.

#import bevy_pbr::{
    pbr_fragment::pbr_input_from_standard_material,
    pbr_functions::alpha_discard,
}
#import rain::surface::{
    SurfaceParams, rain_exposure, rain_exposure_bias, rain_catch, rain_point_wetness, rain_point_film, rain_wet_albedo,
}
#ifdef PREPASS_PIPELINE
#import bevy_pbr::{
    prepass_io::{VertexOutput, FragmentOutput},
    pbr_deferred_functions::deferred_output,
}
#else
#import bevy_pbr::{
    forward_io::{VertexOutput, FragmentOutput},
    pbr_functions::{apply_pbr_lighting, main_pass_post_lighting_processing},
}
#endif

// x: strength 0..1, y: porosity (below 0: from roughness), z, w unused.
@group(#{MATERIAL_BIND_GROUP}) @binding(100) var<uniform> material_wetting: vec4<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(101) var rain_cover_map: texture_depth_2d;
@group(#{MATERIAL_BIND_GROUP}) @binding(102) var<storage, read> rain_surface: SurfaceParams;

@fragment
fn fragment(in: VertexOutput, @builtin(front_facing) is_front: bool) -> FragmentOutput {
    var pbr = pbr_input_from_standard_material(in, is_front);

    let normal = normalize(pbr.world_normal);
    let p = in.world_position.xyz - rain_surface.eye.xyz;
    let cover = rain_surface.cover;
    let to_rain = normalize(vec3<f32>(-cover.wind.x * cover.inverse_speed, 1.0, -cover.wind.y * cover.inverse_speed));
    let exposure = material_wetting.x
        * rain_exposure(rain_cover_map, cover, p + 0.03 * normal, rain_exposure_bias(cover, normal))
        * rain_catch(normal.y, dot(normal, to_rain));
    let wetness = rain_point_wetness(rain_surface.state, exposure);
    // Water runs off what is steep.
    let film = rain_point_film(rain_surface.state, exposure) * smoothstep(0.2, 0.8, normal.y);

    // Rough dielectrics are porous and darken; smooth ones and metals only take the film.
    let guessed = smoothstep(0.35, 0.75, pbr.material.perceptual_roughness) * (1.0 - pbr.material.metallic);
    let porosity = select(guessed, material_wetting.y, material_wetting.y >= 0.0);
    let dry = pbr.material.base_color.rgb;
    let soaked = mix(dry, rain_wet_albedo(dry), porosity * (1.0 - pbr.material.metallic));
    pbr.material.base_color = vec4<f32>(mix(dry, soaked, wetness), pbr.material.base_color.a);
    // Damp pores shine a little; a closed film is as smooth as drops leave it.
    let damp = mix(pbr.material.perceptual_roughness, 0.45, 0.75 * wetness);
    let rough = mix(min(pbr.material.perceptual_roughness, damp), RAIN_FILM_ROUGHNESS, film);
    pbr.material.perceptual_roughness = min(pbr.material.perceptual_roughness, rough);
    // Reflectance of water: F0 = 0.02 = 0.16 r².
    pbr.material.reflectance = mix(pbr.material.reflectance, vec3<f32>(0.357), film);
    pbr.N = normalize(mix(pbr.N, normal, 0.75 * film));

    pbr.material.base_color = alpha_discard(pbr.material, pbr.material.base_color);
#ifdef PREPASS_PIPELINE
    return deferred_output(in, pbr);
#else
    var out: FragmentOutput;
    out.color = apply_pbr_lighting(pbr);
    out.color = main_pass_post_lighting_processing(pbr, out.color);
    return out;
#endif
}

// Perceptual roughness of a water film under falling rain (rings widen the mirror).
const RAIN_FILM_ROUGHNESS: f32 = 0.16;
