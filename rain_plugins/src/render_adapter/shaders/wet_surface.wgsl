// A StandardMaterial that gets wet: darker body, water film on top, puddles where water stands, dry under cover.

#import bevy_pbr::{
    pbr_fragment::pbr_input_from_standard_material,
    pbr_functions::{alpha_discard, calculate_view},
    pbr_bindings::{depth_map_texture, depth_map_sampler},
    mesh_functions::{get_tag, get_world_from_local},
    mesh_view_bindings::view,
    view_transformations::{direction_view_to_world, frag_coord_to_ndc, position_ndc_to_view},
}
#import rain::surface::{
    SurfaceParams, rain_exposure, rain_exposure_bias, rain_catch, rain_point_wetness, rain_point_film, rain_film_roughness,
    rain_wet_albedo,
    rain_standing_water, rain_refraction_shift, rain_shift_in_pixels, rain_under_water, rain_wind_slopes,
    rain_painted_puddle_water, rain_crack_water, rain_puddle_noise, rain_noise_puddle, rain_normal_aslant, rain_udn,
    rain_film_texel, rain_memory_of, rain_memory_share, rain_puddle_rim, rain_water_map,
    rain_across_and_along, rain_rut_height, rain_film_wave_velocity, rain_film_wave_slope, rain_film_wavelets,
    rain_beads,
    rain_caustic_at, rain_water_fresnel,
    ArtistLook, rain_artist_surface, rain_lagarde_porosity, rain_fixed_state, RAIN_MASK_EXPOSURE, rain_mask_texel,
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
    lighting,
    mesh_view_bindings::lights,
    mesh_view_types::DIRECTIONAL_LIGHT_FLAGS_SHADOWS_ENABLED_BIT,
    shadows::fetch_directional_shadow,
    view_transformations::position_world_to_view,
}
#endif

struct Wetting {
    // x: strength 0..1, y: porosity (below 0: from roughness), z: 1 when the mesh's tag holds a wetness of its own,
    // w: wetness set by hand (below 0: none).
    take: vec4<f32>,
    // Painted puddles. x: source (0 none, 1 vertex colours, 2 texture), y: margin, z: least flood level, w: depth m.
    paint: vec4<f32>,
    // x: fixed, y: height map, z: what to show (1 channels, 2 ripples, 3 water), w unused.
    paint_flags: vec4<f32>,
    // Noise puddles. x, y: 1 / size along x and z, 1/m, z: seed, w: level (below 0: the weather's).
    noise: vec4<f32>,
    // x: present, y: height map, z: width of the drenched ground, w: share of the noise.
    noise_flags: vec4<f32>,
    // x: look (0 physical, else a source's rules), y: fixed state (0 none, 1 dry .. 4 puddle), z: 1 for level faces
    // alone, w: share of drops that stand on it (below 0: from roughness).
    look: vec4<f32>,
    // Wheel ruts of noise puddles. x, y: cosine and sine of the lanes' direction, z: offset m, w: depth.
    ruts: vec4<f32>,
    // x: lane m, y: half track m, z: standard deviation m, w: 1 where there are any.
    rut_shape: vec4<f32>,
    // Flow of the mesh's own. x, y: velocity m/s, z: speed of the flow map m/s, 0 without, w: strength.
    flow: vec4<f32>,
}

@group(#{MATERIAL_BIND_GROUP}) @binding(100) var<uniform> wetting: Wetting;
@group(#{MATERIAL_BIND_GROUP}) @binding(101) var rain_cover_map: texture_depth_2d;
@group(#{MATERIAL_BIND_GROUP}) @binding(102) var<storage, read> rain_surface: SurfaceParams;
@group(#{MATERIAL_BIND_GROUP}) @binding(103) var rain_level_map: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(104) var rain_ripple_map: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(105) var rain_sampler: sampler;
@group(#{MATERIAL_BIND_GROUP}) @binding(106) var rain_wave_map: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(107) var rain_reflection_map: texture_2d_array<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(108) var rain_painted: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(109) var rain_film_map: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(110) var rain_near_map: texture_2d_array<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(114) var rain_wave_normals: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(115) var rain_more_wave_normals: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(116) var rain_flow_map: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(117) var rain_caustic_map: texture_2d<f32>;

// Perceptual roughness of still water: a mirror, as far as lamps of finite size let it be one.
const WATER_ROUGHNESS: f32 = 0.045;
// Perceptual roughness of a closed film on a rough road: it follows the stones in part. Chosen by eye.
const FILM_ROUGHNESS: f32 = 0.22;
// Reflectance of water: F0 = 0.02 = 0.16 r².
const WATER_REFLECTANCE: f32 = 0.357;
// Depth of a puddle that a material or component asks for, m.
const FIXED_PUDDLE_M: f32 = 0.008;

// Slopes of the water's surface, and the variance of those too small to be seen singly.
struct WaterSurface {
    slope: vec2<f32>,
    variance: f32,
}

fn water_surface(p: vec3<f32>, ddx: vec2<f32>, ddy: vec2<f32>, depth: f32, exposure: f32) -> WaterSurface {
    var out: WaterSurface;
    let look = rain_surface.water;
    // Waves and rings need water under them.
    let room = smoothstep(0.001, 0.006, depth);
    if (room <= 0.0) {
        return out;
    }
    out.slope = rain_wind_slopes(look, p.xz, rain_surface.eye.w) * room;
    if (look.ripples.w > 0.5) {
        let ring = textureSampleGrad(rain_ripple_map, rain_sampler, p.xz * look.ripples.x + look.ripples.yz,
            ddx * look.ripples.x, ddy * look.ripples.x);
        let strength = look.absorption.w * exposure * room;
        out.slope += ring.xy * strength;
        out.variance += max(ring.z, 0.0) * strength * strength;
    }
    if (look.waves.w > 0.5) {
        let uv = (p.xz - look.waves.xy) * look.waves.z;
        let wave = textureSampleGrad(rain_wave_map, rain_sampler, uv, ddx * look.waves.z, ddy * look.waves.z);
        let inside = f32(all(uv > vec2<f32>(0.01)) && all(uv < vec2<f32>(0.99)));
        out.slope += wave.xy * inside;
        out.variance += max(wave.z, 0.0) * inside;
    }
    if (look.map.w > 0.0) {
        out.slope = rain_udn(out.slope, look.map.w * room * wave_normals(p, ddx, ddy));
    }
    return out;
}

// What lies aslant in the two moving normal maps together.
fn wave_normals(p: vec3<f32>, ddx: vec2<f32>, ddy: vec2<f32>) -> vec2<f32> {
    let a = rain_surface.water.map;
    let b = rain_surface.water.more_map;
    let first = textureSampleGrad(rain_wave_normals, rain_sampler, p.xz * a.x + a.yz, ddx * a.x, ddy * a.x);
    let second = textureSampleGrad(rain_more_wave_normals, rain_sampler, p.xz * b.x + b.yz, ddx * b.x, ddy * b.x);
    return 0.5 * (rain_normal_aslant(first.xy) + rain_normal_aslant(second.xy));
}

// What the ground at `p` remembers; near the view the finer map knows more.
fn remembered(p: vec3<f32>) -> vec3<f32> {
    let levels = rain_surface.levels;
    let far = rain_film_texel(rain_film_map, rain_sampler, levels, p);
    if (far.w <= 0.0) {
        return vec3<f32>(0.0);
    }
    return rain_memory_of(levels, p, rain_water_map(rain_near_map, rain_sampler, rain_surface.map, p.xz, far));
}

// What artists placed at a point.
struct Placed {
    // Water gathered, 0..1, and its depth, m.
    water: f32,
    depth: f32,
    // Where rain wets and where it rings, 0..1.
    wettable: f32,
    ripples: f32,
    // Film of drenched ground, 0..1.
    film: f32,
}

fn placed_water(paint: vec4<f32>, height: f32, p: vec2<f32>) -> Placed {
    var out = Placed(0.0, 0.0, 1.0, 1.0, 0.0);
    let levels = rain_surface.artist;
    if (wetting.paint.x > 0.5) {
        out.wettable = paint.b;
        out.ripples = paint.r;
        let flood = max(levels.z, wetting.paint.z);
        var water = rain_painted_puddle_water(flood, paint.g, wetting.paint.y);
        if (wetting.paint_flags.x > 0.5) {
            water = 1.0 - paint.a;
        }
        if (wetting.paint_flags.y > 0.5) {
            water = max(water, rain_crack_water(levels.y, height) * paint.b);
        }
        out.water = water;
        out.depth = water * wetting.paint.w;
    }
    if (wetting.noise_flags.x > 0.5) {
        var eye = rain_surface.eye.xz;
        var at = p;
        var rut = 0.0;
        if (wetting.rut_shape.w > 0.5) {
            eye = rain_across_and_along(eye, wetting.ruts.xy);
            at = rain_across_and_along(p, wetting.ruts.xy);
            rut = rain_rut_height(eye.x - wetting.ruts.z + at.x, wetting.rut_shape.xyz, wetting.ruts.w);
        }
        let noise = rain_puddle_noise(eye, at, wetting.noise.xy, u32(wetting.noise.z));
        let map = 1.0 - (1.0 - wetting.noise_flags.w * noise) * (1.0 - rut);
        let level = select(levels.z, wetting.noise.w, wetting.noise.w >= 0.0);
        let relief = select(0.0, height, wetting.noise_flags.y > 0.5);
        let puddle = rain_noise_puddle(level, map, relief, wetting.noise_flags.z);
        out.depth = max(out.depth, 0.01 * puddle.x);
        out.water = max(out.water, puddle.y);
        out.film = puddle.z;
    }
    return out;
}

// Slopes of the wavelets on the film that runs over `normal`, and the variance of those too small to be seen. `film` is the
// share of the point under a film, `own` the mesh's flow, m/s.
fn running_film(p: vec3<f32>, ddx: vec2<f32>, ddy: vec2<f32>, normal: vec3<f32>, film: f32, own: vec2<f32>) -> WaterSurface {
    var out: WaterSurface;
    let place = rain_surface.water.place;
    // Above the texture, mm; steep faces have films too thin for waves.
    let above = max(rain_surface.state.y - rain_surface.state.z, 0.0) * film * smoothstep(0.5, 0.8, normal.y);
    // Faces a few tenths of a percent aslant are level but for rounding; a mesh's own flow needs no slope.
    let runs = max(smoothstep(0.002, 0.006, length(normal.xz)), smoothstep(0.0, 0.01, length(own)));
    let strength = place.z * wetting.flow.w * runs;
    if (strength * above <= 0.0) {
        return out;
    }
    let velocity = rain_film_wave_velocity(normal, above, place.w) + own;
    let steep = strength * rain_film_wave_slope(above, length(velocity));
    if (steep < 1e-4) {
        return out;
    }
    let footprint = sqrt(max(dot(ddx, ddx), dot(ddy, ddy)));
    let waves = rain_film_wavelets(rain_surface.eye.xz, p.xz, rain_surface.eye.w, velocity, footprint);
    out.slope = steep * waves.xy;
    out.variance = steep * steep * waves.z;
    return out;
}

// Drops that stand on a face: how the normal leans, the share of the pixel under drops, and under such as are too small
// to be seen.
struct Beaded {
    lean: vec3<f32>,
    cover: f32,
    hidden: f32,
}

// `wide`: width of the pixel on the face, m.
fn beaded(world: vec3<f32>, wide: f32, normal: vec3<f32>, instance: u32, wetness: f32) -> Beaded {
    let frame = get_world_from_local(instance);
    let x = normalize(frame[0].xyz);
    let y = normalize(frame[1].xyz);
    let z = normalize(frame[2].xyz);
    // In the mesh's own frame, in metres: drops stay where they are on what moves.
    let off = world - frame[3].xyz;
    let n = abs(vec3<f32>(dot(normal, x), dot(normal, y), dot(normal, z)));
    var across = x;
    var down = z;
    var steep = 0.0;
    var seed = 11u;
    if (n.y < max(n.x, n.z)) {
        across = select(x, z, n.x > n.z);
        down = -y;
        steep = smoothstep(0.5, 0.9, y.y);
        seed = select(23u, 37u, n.x > n.z);
    }
    let found = rain_beads(vec2<f32>(dot(off, across), dot(off, down)), wide, rain_surface.eye.w, seed, wetness, steep);
    return Beaded(across * found.x + down * found.y, found.z, found.w);
}

// Beyond this from the origin single precision has steps that show in waves, m.
const FAR_M: f32 = 4096.0;

// Place of a pixel relative to the eye of the parameters, m. Far from the origin its horizontal part comes from the
// pixel's own depth, which has no steps; the height has none where the ground lies near 0.
fn from_anchor(world: vec3<f32>, pixel: vec4<f32>) -> vec3<f32> {
    let p = world - rain_surface.eye.xyz;
    if (max(abs(rain_surface.eye.x), abs(rain_surface.eye.z)) < FAR_M) {
        return p;
    }
    let own = direction_view_to_world(position_ndc_to_view(frag_coord_to_ndc(pixel)));
    let apart = view.world_position - rain_surface.eye.xyz;
    return vec3<f32>(own.x + apart.x, p.y, own.z + apart.z);
}

// The mesh's normal, or that of the face where it has none or a broken one.
fn usable_normal(given: vec3<f32>, world: vec3<f32>, to_eye: vec3<f32>, is_front: bool) -> vec3<f32> {
    let flat = cross(dpdx(world), dpdy(world));
    let square = dot(given, given);
    if (square > 1e-12 && square < 1e12) {
        return given;
    }
    let area = length(flat);
    let own = select(vec3<f32>(0.0, 1.0, 0.0), flat / area, area > 0.0);
    return own * select(-1.0, 1.0, dot(own, to_eye) > 0.0) * select(-1.0, 1.0, is_front);
}

@fragment
fn fragment(in: VertexOutput, @builtin(front_facing) is_front: bool) -> FragmentOutput {
    var input = in;
    let cover = rain_surface.cover;
    let p = from_anchor(in.world_position.xyz, in.position);
    let to_eye = calculate_view(in.world_position, view.clip_from_view[3].w == 1.0);
    input.world_normal = usable_normal(in.world_normal, in.world_position.xyz, to_eye, is_front);
    let face = normalize(input.world_normal) * select(-1.0, 1.0, is_front);

    // Standing water bends the view of its bottom.
    let level = smoothstep(0.85, 0.95, face.y);
    let standing = rain_standing_water(rain_level_map, rain_surface.levels, p) * select(0.0, 1.0, level > 0.0);
    var depth = standing;
    var paint = vec4<f32>(1.0);
    // Height of the material's relief, 1 at its top.
    var height = 0.0;
    var own_flow = wetting.flow.xy;
#ifdef VERTEX_COLORS
    if (wetting.paint.x > 0.5 && wetting.paint.x < 1.5) {
        paint = in.color;
        input.color = vec4<f32>(1.0);
    }
#endif
#ifdef VERTEX_UVS_A
    if (wetting.paint.x > 1.5) {
        paint = textureSample(rain_painted, rain_sampler, in.uv);
    }
    if (wetting.flow.z > 0.0) {
        own_flow += wetting.flow.z * (2.0 * textureSample(rain_flow_map, rain_sampler, in.uv).xy - 1.0);
    }
    if (wetting.paint_flags.y + wetting.noise_flags.y > 0.5) {
        height = 1.0 - textureSample(depth_map_texture, depth_map_sampler, in.uv).r;
    }
#endif
    let placed = placed_water(paint, height, p.xz);
    depth = max(depth, placed.depth);
    let is_fixed = wetting.look.y > 0.5;
    let fixed = rain_fixed_state(u32(wetting.look.y));
    depth = select(depth, level * FIXED_PUDDLE_M * fixed.z, is_fixed);
    let ddx = dpdx(p.xz);
    let ddy = dpdy(p.xz);
#ifdef VERTEX_UVS_A
    let pixels = rain_shift_in_pixels(rain_refraction_shift(to_eye, min(depth, 0.3)), ddx, ddy, 24.0);
    input.uv += pixels.x * dpdx(in.uv) + pixels.y * dpdy(in.uv);
#endif
    var pbr = pbr_input_from_standard_material(input, is_front);
    let own = pbr.material;
    let grain = pbr.N;

    let normal = normalize(pbr.world_normal);
    let to_rain = normalize(vec3<f32>(-cover.wind.x * cover.inverse_speed, 1.0, -cover.wind.y * cover.inverse_speed));
    let ground = remembered(p);
    let memory = rain_memory_share(ground.z, normal.y);
    // What the ground remembers, a thing's own wetness and walls in the lee need no look at what covers now; rings do.
    var exposure = wetting.take.x * placed.wettable * rain_catch(normal.y, dot(normal, to_rain));
    if (exposure > 0.0 && (depth > 0.0 || (memory < 1.0 && wetting.take.z < 0.5))) {
        exposure *= rain_exposure(rain_cover_map, cover, p + 0.03 * normal, rain_exposure_bias(cover, normal));
    }
    var puddle = level * wetting.take.x * max(rain_puddle_rim(standing), placed.water);
    // Wetness of the pores and share under a film.
    var wet = vec2<f32>(rain_point_wetness(rain_surface.state, exposure), rain_point_film(rain_surface.state, exposure));
    wet = mix(wet, ground.xy * wetting.take.x * placed.wettable, memory);
    if (wetting.take.z > 0.5) {
        // A thing that moves carries its water with it, under cover too.
        wet = unpack2x16unorm(get_tag(in.instance_index)) * wetting.take.x * rain_catch(normal.y, dot(normal, to_rain));
    }
    wet.x = select(wet.x, wetting.take.w * wetting.take.x, wetting.take.w >= 0.0);
    // Drenched ground is soaked, too.
    wet = max(wet, vec2<f32>(placed.film * level * wetting.take.x));
    wet *= mix(1.0, smoothstep(0.5, 0.8, normal.y), wetting.look.z);
    wet = select(wet, fixed.xy, is_fixed);
    puddle = select(puddle, level * fixed.z, is_fixed);
    let wetness = max(wet.x, smoothstep(0.0, 0.5, puddle));
    // Water runs off what is steep.
    let film = max(wet.y * smoothstep(0.2, 0.8, normal.y), puddle);

    // Rough dielectrics are porous and darken; smooth ones and metals only take the film.
    let guessed = smoothstep(0.35, 0.75, pbr.material.perceptual_roughness) * (1.0 - pbr.material.metallic);
    let porosity = select(guessed, wetting.take.y, wetting.take.y >= 0.0);
    let dry = pbr.material.base_color.rgb;
    let soaked = mix(dry, rain_wet_albedo(dry), porosity * (1.0 - pbr.material.metallic));
    var body = mix(dry, soaked, wetness);
    body = mix(body, rain_under_water(dry, rain_surface.water, max(depth, 0.0), to_eye.y), puddle);
    pbr.material.base_color = vec4<f32>(body, pbr.material.base_color.a);
    // Damp pores shine a little; a closed film is as smooth as drops leave it.
    let damp = mix(pbr.material.perceptual_roughness, 0.45, 0.75 * wetness);
    var rough = rain_film_roughness(min(pbr.material.perceptual_roughness, damp), FILM_ROUGHNESS, film);
    rough = min(pbr.material.perceptual_roughness, rough);
    // Reflections: a film follows the road's grain, standing water does not.
    let water = water_surface(p, ddx, ddy, depth, exposure * placed.ripples);
    let running = running_film(p, ddx, ddy, normal, wet.y * (1.0 - puddle), own_flow);
    let tilt = vec3<f32>(running.slope.x, 0.0, running.slope.y);
    rough = pow(pow(rough, 4.0) + running.variance, 0.25);
    let flat = normalize(mix(pbr.N, normal, 0.75 * film) - tilt);
    let surface = normalize(vec3<f32>(-water.slope.x, 1.0, -water.slope.y));
    pbr.N = normalize(mix(flat, surface, puddle));
    // Slopes too small to be seen widen the mirror: alpha² grows by their variance, the sum of both axes.
    let mirror = pow(WATER_ROUGHNESS, 4.0) + water.variance;
    pbr.material.perceptual_roughness = clamp(mix(rough, pow(mirror, 0.25), puddle), 0.03, 1.0);
    pbr.material.metallic *= 1.0 - puddle;
    pbr.material.reflectance = mix(pbr.material.reflectance, vec3<f32>(WATER_REFLECTANCE), film);
    if (wetting.look.x > 0.5) {
        // A source's own rules: wet ground keeps its grain, water is flat.
        let look = ArtistLook(dry, 1.0 - own.perceptual_roughness, 0.16 * own.reflectance * own.reflectance);
        let by_gloss = rain_lagarde_porosity(look.gloss, own.metallic);
        let porous = select(by_gloss, wetting.take.y, wetting.take.y >= 0.0);
        let by_rules = rain_artist_surface(u32(wetting.look.x), look, porous, own.metallic, wet.x, puddle);
        pbr.material.base_color = vec4<f32>(by_rules.albedo, own.base_color.a);
        let polished = max(1.0 - by_rules.gloss, puddle * pow(mirror, 0.25));
        pbr.material.perceptual_roughness = clamp(polished, WATER_ROUGHNESS, 1.0);
        pbr.material.reflectance = sqrt(by_rules.normal_reflectance / 0.16);
        pbr.N = normalize(mix(normalize(grain - tilt), surface, puddle));
    }
    // On what is smooth water stands in drops.
    let by_roughness = 1.0 - smoothstep(0.3, 0.5, own.perceptual_roughness);
    // A source's own rules and fixed states know none.
    let guessed_drops = select(by_roughness, 0.0, wetting.look.x > 0.5 || is_fixed);
    let drops = select(guessed_drops, wetting.look.w, wetting.look.w >= 0.0) * (1.0 - puddle);
    let wide = max(length(dpdx(in.world_position.xyz)), length(dpdy(in.world_position.xyz)));
    let standing_drops = drops * max(wet.y, 0.8 * wet.x);
    if (standing_drops > 0.0) {
        let beads = beaded(in.world_position.xyz, wide, face, in.instance_index, standing_drops);
        pbr.N = normalize(pbr.N - beads.lean);
        let faint = rain_film_roughness(0.6, max(pbr.material.perceptual_roughness, WATER_ROUGHNESS), 1.0 - beads.hidden);
        pbr.material.perceptual_roughness = mix(faint, WATER_ROUGHNESS, beads.cover);
        pbr.material.reflectance = mix(pbr.material.reflectance, vec3<f32>(WATER_REFLECTANCE), beads.cover);
    }
    // Both ends of Fresnel's curve go with the square of this.
    let shine = mix(1.0, rain_surface.water.more_map.w, puddle);
    pbr.material.reflectance *= sqrt(shine);

    pbr.material.base_color = alpha_discard(pbr.material, pbr.material.base_color);
#ifdef PREPASS_PIPELINE
    return deferred_output(in, pbr);
#else
    let mirrored = mirrored_radiance(p, pbr.N, to_eye, pbr.material.perceptual_roughness, film);
    pbr.specular_occlusion *= 1.0 - mirrored.w;
    var out: FragmentOutput;
    if (view.exposure < RAIN_MASK_EXPOSURE) {
        out.color = rain_mask_texel(wetness, select(0.0, max(depth, 0.0), puddle > 0.0));
        return out;
    }
    if (wetting.paint_flags.z > 0.5) {
        let shown = select(select(vec3<f32>(placed.water), vec3<f32>(paint.r), wetting.paint_flags.z < 2.5), paint.rgb,
            wetting.paint_flags.z < 1.5);
        out.color = vec4<f32>(shown, 1.0);
        return out;
    }
    out.color = apply_pbr_lighting(pbr);
    let reflected = lighting::F_AB(pbr.material.perceptual_roughness, max(dot(pbr.N, to_eye), 1e-4));
    out.color += vec4<f32>(mirrored.xyz * mirrored.w * shine * (0.02 * reflected.x + reflected.y), 0.0);
#ifdef RAIN_CAUSTICS
    if (rain_surface.caustics.w > 0.0) {
        let thrown = thrown_light(p, face, wide, in.position.xy);
        out.color += vec4<f32>(body * (1.0 - pbr.material.metallic) * 0.3183099 * thrown, 0.0);
    }
#endif
    out.color = main_pass_post_lighting_processing(pbr, out.color);
    return out;
#endif
}

#ifndef PREPASS_PIPELINE
#ifdef RAIN_CAUSTICS
// Exposed light that a puddle throws onto a face at `p`; `wide`: width of the pixel on it, m.
fn thrown_light(p: vec3<f32>, face: vec3<f32>, wide: f32, pixel: vec2<f32>) -> vec3<f32> {
    let towards = rain_surface.caustics.xyz;
    // Against the mirrored ray.
    let back = vec3<f32>(towards.x, -towards.y, towards.z);
    let facing = dot(face, back);
    if (facing <= 0.0) {
        return vec3<f32>(0.0);
    }
    // Where the ray left the ground: level enough that its height is soon found.
    let levels = rain_surface.levels;
    var at = p.xz + 0.4 * face.xz;
    var ground = -1e9;
    for (var i = 0; i < 3; i++) {
        let texel = rain_film_texel(rain_film_map, rain_sampler, levels, vec3<f32>(at.x, p.y, at.y));
        if (texel.w <= 0.0) {
            return vec3<f32>(0.0);
        }
        ground = levels.base + texel.z;
        at = p.xz + towards.xz * (max(p.y - ground, 0.0) / towards.y);
    }
    let depth = rain_standing_water(rain_level_map, levels, vec3<f32>(at.x, ground, at.y));
    let way = (p.y - ground - depth) / towards.y;
    if (depth <= 0.0 || way <= 0.0) {
        return vec3<f32>(0.0);
    }
    let water = vec3<f32>(p.x + towards.x * way, ground + depth, p.z + towards.z * way);
    let place = water + rain_surface.eye.xyz;
    // What is not the brightest light is thrown too weakly to be seen.
    var sun = vec3<f32>(0.0);
    for (var i = 0u; i < lights.n_directional_lights; i++) {
        let light = &lights.directional_lights[i];
        if (dot((*light).direction_to_light, towards) < 0.99999) {
            continue;
        }
        sun = (*light).color.rgb * view.exposure;
        if (((*light).flags & DIRECTIONAL_LIGHT_FLAGS_SHADOWS_ENABLED_BIT) != 0u) {
            let from_view = position_world_to_view(place);
            sun *= fetch_directional_shadow(i, vec4<f32>(place, 1.0), vec3<f32>(0.0, 1.0, 0.0), from_view.z, pixel);
        }
        break;
    }
    if (all(sun <= vec3<f32>(0.0))) {
        return vec3<f32>(0.0);
    }
    var lines = 1.0;
    let ripples = rain_surface.water.ripples;
    // Rings too fine for the pixel leave even light.
    let shown = smoothstep(0.001, 0.006, depth) * (1.0 - smoothstep(0.01, 0.05, wide));
    if (ripples.w > 0.5 && shown > 0.0) {
        let uv = water.xz * ripples.x + ripples.yz;
        let values = textureSampleLevel(rain_caustic_map, rain_sampler, uv, 0.0);
        let open = rain_exposure(rain_cover_map, rain_surface.cover, water + vec3<f32>(0.0, 0.03, 0.0), 0.03);
        lines = mix(1.0, rain_caustic_at(values, way), shown * open);
    }
    let mirrored = rain_water_fresnel(towards.y) * rain_surface.water.more_map.w * rain_puddle_rim(depth);
    return rain_surface.caustics.w * mirrored * facing * lines * sun;
}

#endif
// Exposed radiance of this view's mirror image that the surface at `p` shows, and how much of its mirror image that is.
fn mirrored_radiance(p: vec3<f32>, normal: vec3<f32>, to_eye: vec3<f32>, roughness: f32, film: f32) -> vec4<f32> {
    // The mirror of this view's eye.
    var layer = 0;
    for (; layer < 4; layer++) {
        let eye = rain_surface.mirrors[layer].eye;
        let looks_there = dot(rain_surface.mirrors[layer].plane.yzw, view.world_from_view[2].xyz) < -0.9999;
        if (eye.w > 0.0 && distance(eye.xyz, view.world_position) < 0.01 && looks_there) {
            break;
        }
    }
    if (layer == 4) {
        return vec4<f32>(0.0);
    }
    let reflection = rain_surface.mirrors[layer];
    // What lies far off the mirror's plane, a high pavement or a step, shows its surroundings' map instead.
    let off = 1.0 - smoothstep(0.2, 0.6, abs(p.y - reflection.plane.x));
    let share = reflection.eye.w * film * (1.0 - smoothstep(0.3, 0.5, roughness)) * smoothstep(0.6, 0.9, normal.y) * off;
    if (share <= 0.0) {
        return vec4<f32>(0.0);
    }
    // The mirror's plane is one height; what is reflected is taken to be as far away as a house across the road.
    let towards = reflect(-to_eye, normal);
    let clip = reflection.clip_from_eye * vec4<f32>(p + 6.0 * towards, 1.0);
    if (clip.w <= 0.0) {
        return vec4<f32>(0.0);
    }
    let uv = clip.xy / clip.w * vec2<f32>(0.5, -0.5) + 0.5;
    let edge = min(min(uv.x, 1.0 - uv.x), min(uv.y, 1.0 - uv.y));
    // A rough film blurs by its lobe, at a grazing angle far more along the view than across it.
    let size = vec2<f32>(textureDimensions(rain_reflection_map));
    let lobe = 0.8 * roughness * roughness;
    let across = lobe * max(to_eye.y, 0.12);
    let level = log2(max(across * size.y, 1.0));
    let middle = clamp(uv, vec2<f32>(0.002), vec2<f32>(0.998));
    let shown = share * smoothstep(0.0, 0.05, edge);
    // Still water mirrors sharply: its lobe is smaller than a texel.
    if (lobe * size.y < 0.75) {
        return vec4<f32>(textureSampleLevel(rain_reflection_map, rain_sampler, middle, layer, 0.0).xyz, shown);
    }
    var weights = array<f32, 7>(0.07, 0.13, 0.19, 0.22, 0.19, 0.13, 0.07);
    var sum = vec3<f32>(0.0);
    for (var i = 0; i < 7; i++) {
        let at = uv + vec2<f32>(0.0, lobe * (f32(i) - 3.0) / 3.0);
        let inside = clamp(at, vec2<f32>(0.002), vec2<f32>(0.998));
        sum += weights[i] * textureSampleLevel(rain_reflection_map, rain_sampler, inside, layer, level).xyz;
    }
    return vec4<f32>(sum, shown);
}
#endif
