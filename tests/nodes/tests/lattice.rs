//! The lattice's cards on a GPU: the optical depth of the CPU's, light, cover, and the scene's depth.

use bytemuck::{Pod, Zeroable};
use glam::{DVec2, DVec3, Mat4, Vec3, Vec4};
use rain_core::hash::{pcg3d, unit_f32};
use rain_core::rainfall::{
    Card, Distribution, FieldMotion, Lamp, LatticePlan, LatticeSettings, LatticeView, MAX_LAMPS, RainViewVolume,
    Spectrum, StreakTextureSettings, StreakTextures, pitch_weight,
};
use rain_render::cover::{CoverPlacement, open_sky};
use rain_render::gpu_types::{CoverParams, LampParams};
use rain_render::lattice::{LatticeGpu, LatticeInput, LatticeViewGpu, encode_lattice, encode_lattice_coverage};
use rain_render::rainfall::{COVERAGE_FORMAT, DEPTH_FORMAT, Lighting, RainfallTextures};
use rain_render::streak_textures::{StreakArray, StreakTextureGpu, encode_streak_textures};

use crate::device::{Device, device, kernel, library};
use crate::maps::{from_half, read_map};

const SIDE: u32 = 128;
const NEAR_M: f32 = 0.1;
/// Tangent of half the view's angle.
const HALF: f32 = 0.5;
const EYE: DVec3 = DVec3::new(12.0, 1.7, -5.0);
const COLOUR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// A scene: textures, cards of a heavy rain ahead, pipelines.
struct Scene {
    cards: Vec<Card>,
    set: StreakTextures,
    array: StreakArray,
    gpu: LatticeGpu,
}

impl Scene {
    fn new(gpu: &Device) -> Self {
        let textures = StreakTextureSettings {
            texels: 256,
            ..StreakTextureSettings::default()
        };
        let pipelines = StreakTextureGpu::new(&gpu.device);
        let mut array = StreakArray::new(&gpu.device, &gpu.queue, &pipelines, &textures).expect("a set");
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        encode_streak_textures(&mut encoder, &pipelines, &mut array);
        gpu.queue.submit([encoder.finish()]);
        let mut lattice = LatticeGpu::new(&gpu.device);
        lattice.prepare_pipelines(&gpu.device, COLOUR, 1, true, false);
        lattice.prepare_pipelines(&gpu.device, COLOUR, 4, false, false);
        Self {
            cards: cards(&textures, 100.0),
            set: StreakTextures::bake(&textures).expect("a set"),
            array,
            gpu: lattice,
        }
    }
}

fn cards(textures: &StreakTextureSettings, intensity: f64) -> Vec<Card> {
    let plan = LatticePlan::new(LatticeSettings::default(), textures).expect("a plan");
    let plane = |n: Vec3| n.normalize().extend(0.0);
    let volume = RainViewVolume {
        eye_m: EYE,
        eye_velocity_m_s: DVec3::ZERO,
        side_planes: [
            plane(Vec3::new(1.0, 0.0, -HALF)),
            plane(Vec3::new(-1.0, 0.0, -HALF)),
            plane(Vec3::new(0.0, 1.0, -HALF)),
            plane(Vec3::new(0.0, -1.0, -HALF)),
        ],
        focal_px: 623.5,
        solid_angle_sr: 1.0,
        exposure_s: 1.0 / 60.0,
        turn_rad: 0.0,
        parallel: None,
    };
    let mut cards = Vec::new();
    plan.fill(
        &LatticeView {
            volume: &volume,
            spectrum: &Spectrum::new(Distribution::MarshallPalmer, intensity).expect("a rate"),
            local: None,
            motion: &FieldMotion::default().after(50.0),
            kappa: 1.0,
            lamps: &[],
            ambient: Vec3::ONE,
            seed: 3,
            haze: None,
        },
        &mut cards,
    );
    assert!(cards.len() > 500, "{}", cards.len());
    cards
}

/// Infinite reverse-Z, looking along −Z.
fn clip_from_eye() -> Mat4 {
    let f = 1.0 / HALF;
    Mat4::from_cols(
        Vec4::new(f, 0.0, 0.0, 0.0),
        Vec4::new(0.0, f, 0.0, 0.0),
        Vec4::new(0.0, 0.0, 0.0, -1.0),
        Vec4::new(0.0, 0.0, NEAR_M, 0.0),
    )
}

fn lighting(ambient: f32) -> Lighting {
    Lighting {
        environment_scale: 0.0,
        environment_max_level: 0.0,
        ambient: Vec3::splat(ambient),
        sun_direction: Vec3::Y,
        sun: Vec3::ZERO,
    }
}

/// What a drop shows in surroundings of radiance 1: refracted and reflected shares.
const SHOWN: f64 = 0.884 + 0.066;

/// A picture to take.
struct Shot<'a> {
    cards: &'a [Card],
    ambient: f32,
    fog: Vec3,
    lamps: &'a [Lamp],
    contrast: f32,
    /// Height of a roof over everything. Units: m.
    roof_m: Option<f64>,
    /// Distance of a wall along the view. Units: m.
    wall_m: Option<f32>,
    /// Whether the wall is read instead of tested.
    soft: bool,
    samples: u32,
}

impl<'a> Shot<'a> {
    fn of(cards: &'a [Card]) -> Self {
        Self {
            cards,
            ambient: 1.0,
            fog: Vec3::ZERO,
            lamps: &[],
            contrast: 1.0,
            roof_m: None,
            wall_m: None,
            soft: false,
            samples: 1,
        }
    }
}

fn texture(gpu: &Device, format: wgpu::TextureFormat, side: u32, samples: u32) -> wgpu::Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d {
            width: side,
            height: side,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: samples,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: if samples > 1 {
            wgpu::TextureUsages::RENDER_ATTACHMENT
        } else {
            wgpu::TextureUsages::RENDER_ATTACHMENT
                | wgpu::TextureUsages::TEXTURE_BINDING
                | wgpu::TextureUsages::COPY_SRC
        },
        view_formats: &[],
    })
}

/// A depth texture of one value.
fn depth(gpu: &Device, value: f32, side: u32, samples: u32) -> wgpu::TextureView {
    let view = texture(gpu, DEPTH_FORMAT, side, samples).create_view(&Default::default());
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        depth_stencil_attachment: Some(attachment(&view, wgpu::LoadOp::Clear(value))),
        ..Default::default()
    });
    gpu.queue.submit([encoder.finish()]);
    view
}

fn attachment(view: &wgpu::TextureView, load: wgpu::LoadOp<f32>) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations {
            load,
            store: wgpu::StoreOp::Store,
        }),
        stencil_ops: None,
    }
}

/// Draws a shot over black (or `background`), and its coverage where asked for.
fn shoot(gpu: &Device, scene: &Scene, shot: &Shot, background: f64, coverage: bool) -> wgpu::Texture {
    let roof = shot.roof_m.map(|_| depth(gpu, 1.0, 64, 1));
    let wall = shot.wall_m.map_or(0.0, |wall| NEAR_M / wall);
    let tested = depth(gpu, wall, SIDE, shot.samples);
    let read = depth(gpu, wall, SIDE, 1);
    let input = LatticeInput {
        cards: shot.cards,
        clip_from_eye: clip_from_eye(),
        near_m: NEAR_M,
        contrast: shot.contrast,
        lighting: lighting(shot.ambient),
        fog: shot.fog,
        lamps: shot.lamps,
        panes: &[],
        cover: shot.roof_m.map_or_else(open_sky, roof_params),
    };
    let mut view = LatticeViewGpu::new(&gpu.device);
    view.prepare(
        &gpu.device,
        &gpu.queue,
        &scene.gpu,
        &input,
        &scene.array,
        RainfallTextures {
            cover: roof.as_ref(),
            scene_depth: shot.soft.then_some(&read),
            environment: None,
        },
    );
    assert_eq!(view.cards() as usize, shot.cards.len());
    let format = if coverage { COVERAGE_FORMAT } else { COLOUR };
    let target = texture(gpu, format, SIDE, 1);
    let target_view = target.create_view(&Default::default());
    let many = (shot.samples > 1).then(|| texture(gpu, format, SIDE, shot.samples).create_view(&Default::default()));
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: many.as_ref().unwrap_or(&target_view),
                depth_slice: None,
                resolve_target: many.as_ref().map(|_| &target_view),
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color {
                        r: background,
                        g: background,
                        b: background,
                        a: 0.25,
                    }),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: Some(attachment(&tested, wgpu::LoadOp::Load)),
            ..Default::default()
        });
        if coverage {
            encode_lattice_coverage(&mut pass, &scene.gpu, &view, shot.samples);
        } else {
            encode_lattice(&mut pass, &scene.gpu, &view, COLOUR, shot.samples);
        }
    }
    gpu.queue.submit([encoder.finish()]);
    target
}

/// A level roof at a height over everything.
fn roof_params(height_m: f64) -> CoverParams {
    CoverPlacement {
        centre_m: DVec2::new(EYE.x, EYE.z),
        plane_m: 0.0,
        extent_m: 200.0,
        top_m: height_m,
        range_m: height_m + 20.0,
        highest_m: height_m,
        wind_m_s: DVec2::ZERO,
        inverse_speed_s_m: 0.169,
        texels: 64,
    }
    .params(EYE)
}

/// Pixels of a shot, red.
fn red(gpu: &Device, scene: &Scene, shot: &Shot) -> Vec<f64> {
    read_map(gpu, &shoot(gpu, scene, shot, 0.0, false), 0)
        .iter()
        .map(|pixel| f64::from(pixel[0]))
        .collect()
}

fn mean(pixels: &[f64]) -> f64 {
    pixels.iter().sum::<f64>() / pixels.len() as f64
}

/// Opacity of the CPU's cards in a pixel, at its middle, and at all pixels.
fn cpu_opacity(cards: &[Card], set: &StreakTextures, level: usize, x: f32, y: f32) -> f64 {
    let sight = Vec3::new(
        HALF * (2.0 * x / SIDE as f32 - 1.0),
        HALF * (1.0 - 2.0 * y / SIDE as f32),
        -1.0,
    )
    .normalize();
    1.0 - cards
        .iter()
        .filter_map(|card| Some(1.0 - f64::from(card.opacity(&card.meet(sight)?, set, level))))
        .product::<f64>()
}

fn cpu_picture(cards: &[Card], set: &StreakTextures, level: usize) -> Vec<f64> {
    // Four points a pixel.
    (0..SIDE * SIDE)
        .map(|i| {
            let (x, y) = ((i % SIDE) as f32, (i / SIDE) as f32);
            let at = |dx, dy| cpu_opacity(cards, set, level, x + dx, y + dy);
            0.25 * (at(0.25, 0.25) + at(0.75, 0.25) + at(0.25, 0.75) + at(0.75, 0.75))
        })
        .collect()
}

#[test]
fn the_picture_has_the_opacity_of_the_cpus_cards() {
    let Some(gpu) = device() else { return };
    let scene = Scene::new(&gpu);
    let found: Vec<f64> = red(&gpu, &scene, &Shot::of(&scene.cards))
        .iter()
        .map(|p| p / SHOWN)
        .collect();
    let expected = cpu_picture(&scene.cards, &scene.set, 0);
    let (a, b) = (mean(&found), mean(&expected));
    assert!(b > 0.03, "{b}");
    // Half floats are added up over a hundred cards a pixel.
    assert!((a / b - 1.0).abs() < 0.02, "{a}, {b} on the CPU");
    // Pixel by pixel, near cards from a level as coarse as pixels: alike; with the pictures' places
    // moved on the cards it is less so.
    let near = &scene.cards[scene.cards.len() - 150..];
    let found = red(&gpu, &scene, &Shot::of(near));
    let expected = cpu_picture(near, &scene.set, 3);
    let likeness = |one: &[f64], other: &[f64]| {
        let (ma, mb) = (mean(one), mean(other));
        let sum = |f: &dyn Fn(f64, f64) -> f64| one.iter().zip(other).map(|(&x, &y)| f(x - ma, y - mb)).sum::<f64>();
        sum(&|x, y| x * y) / (sum(&|x, _| x * x) * sum(&|_, y| y * y)).sqrt()
    };
    let moved: Vec<Card> = near
        .iter()
        .map(|card| Card {
            place: [card.place[0] + 0.3, card.place[1] + 0.4, card.place[2], card.place[3]],
            ..*card
        })
        .collect();
    let (right, wrong) = (
        likeness(&found, &expected),
        likeness(&found, &cpu_picture(&moved, &scene.set, 3)),
    );
    assert!(right > 0.93 && wrong < right - 0.1, "{right} {wrong}");
    // Lighter rain takes out less light, by its extinction.
    let light = cards(&scene.set.settings, 25.0);
    let ratio = mean(&red(&gpu, &scene, &Shot::of(&light))) / mean(&red(&gpu, &scene, &Shot::of(&scene.cards)));
    assert!((0.2..0.55).contains(&ratio), "{ratio}");
    // No cards, no picture.
    assert_eq!(mean(&red(&gpu, &scene, &Shot::of(&[]))), 0.0);
}

#[test]
fn cards_cover_what_is_behind_and_leave_alpha_alone() {
    let Some(gpu) = device() else { return };
    let scene = Scene::new(&gpu);
    // Strong streaks of near cards, since half floats lose what is taken from white in small steps.
    let near = &scene.cards[scene.cards.len() - 150..];
    let strong = |ambient: f32| Shot {
        ambient,
        contrast: 16.0,
        ..Shot::of(near)
    };
    let over_white = read_map(&gpu, &shoot(&gpu, &scene, &strong(0.0), 1.0, false), 0);
    let shown = mean(&red(&gpu, &scene, &strong(1.0))) / SHOWN;
    let left = mean(&over_white.iter().map(|p| f64::from(p[1])).collect::<Vec<f64>>());
    assert!(
        shown > 0.03 && (1.0 - left - shown).abs() < 0.05 * shown,
        "{left} {shown}"
    );
    assert!(over_white.iter().all(|p| (p[3] - 0.25).abs() < 1e-3));
    let opacity = mean(&red(&gpu, &scene, &Shot::of(&scene.cards))) / SHOWN;
    // A contrast of 4 is four layers of each card.
    let four = Shot {
        contrast: 4.0,
        ..Shot::of(&scene.cards)
    };
    let four = mean(&red(&gpu, &scene, &four)) / SHOWN;
    assert!((four / (4.0 * opacity) - 0.93).abs() < 0.07, "{four} {opacity}");
    // The same with four samples.
    let many = Shot {
        samples: 4,
        ..Shot::of(&scene.cards)
    };
    assert!((mean(&red(&gpu, &scene, &many)) / SHOWN / opacity - 1.0).abs() < 0.02);
}

#[test]
fn it_is_dark_where_no_light_falls_and_bright_about_a_lamp() {
    let Some(gpu) = device() else { return };
    let scene = Scene::new(&gpu);
    let night = |lamps: &[Lamp]| {
        red(
            &gpu,
            &scene,
            &Shot {
                ambient: 0.0,
                lamps,
                ..Shot::of(&scene.cards)
            },
        )
    };
    assert_eq!(mean(&night(&[])), 0.0);
    let half = |pixels: &[f64], right: bool| {
        let chosen: Vec<f64> = (0..SIDE * SIDE)
            .filter(|i| (i % SIDE >= SIDE / 2) == right)
            .map(|i| pixels[i as usize])
            .collect();
        mean(&chosen)
    };
    // A lamp to the right, ten metres ahead.
    let lamp = Lamp::point(Vec3::new(3.0, 0.0, -10.0), Vec3::splat(20.0), 0.1);
    let lit = night(&[lamp]);
    assert!(half(&lit, true) > 3.0 * half(&lit, false) && half(&lit, false) > 0.0);
    // A spot that shines to the right leaves the left dark.
    let spot = Lamp {
        direction: Vec3::X,
        cos_inner: 0.9,
        cos_outer: 0.8,
        ..Lamp::point(Vec3::new(0.3, 0.0, -8.0), Vec3::splat(50.0), 0.1)
    };
    let beam = night(&[spot]);
    assert!(
        half(&beam, true) > 1e-5 && half(&beam, false) == 0.0,
        "{}",
        half(&beam, false)
    );
    // Twice the lamps, twice the light.
    let twice = night(&[lamp, lamp]);
    assert!((mean(&twice) / mean(&lit) - 2.0).abs() < 0.02);
    // Wherever in the list a lamp stands it is as bright, and beyond the last place it is not there.
    let dark = Lamp {
        intensity: Vec3::ZERO,
        ..lamp
    };
    for place in [31, 32, MAX_LAMPS - 1, MAX_LAMPS] {
        let mut lamps = vec![dark; place];
        lamps.push(lamp);
        let found = mean(&night(&lamps));
        let expected = if place < MAX_LAMPS { mean(&lit) } else { 0.0 };
        assert!((found - expected).abs() < 1e-6, "{place}: {found}, {expected}");
    }
}

#[test]
fn a_roof_keeps_cards_dry_below_it() {
    let Some(gpu) = device() else { return };
    let scene = Scene::new(&gpu);
    let open = red(&gpu, &scene, &Shot::of(&scene.cards));
    let under = |roof_m: f64| {
        red(
            &gpu,
            &scene,
            &Shot {
                roof_m: Some(roof_m),
                ..Shot::of(&scene.cards)
            },
        )
    };
    // Above everything: nothing rains. At the eye's height: the upper half of the picture as before, the lower dry.
    assert_eq!(mean(&under(60.0)), 0.0);
    let level = under(EYE.y);
    let rows = |pixels: &[f64], from: u32, to: u32| mean(&pixels[(from * SIDE) as usize..(to * SIDE) as usize]);
    assert_eq!(rows(&level, SIDE / 2 + 2, SIDE), 0.0);
    assert!((rows(&level, 0, SIDE / 2 - 2) / rows(&open, 0, SIDE / 2 - 2) - 1.0).abs() < 1e-3);
}

#[test]
fn walls_hide_what_is_behind_them_softly_where_depth_is_read() {
    let Some(gpu) = device() else { return };
    let scene = Scene::new(&gpu);
    let behind = |wall_m: Option<f32>, soft: bool| {
        mean(&red(
            &gpu,
            &scene,
            &Shot {
                wall_m,
                soft,
                ..Shot::of(&scene.cards)
            },
        ))
    };
    let open = behind(None, false);
    assert!((behind(None, true) / open - 1.0).abs() < 1e-3);
    for soft in [false, true] {
        assert_eq!(behind(Some(0.5), soft), 0.0);
        let steps = [4.0, 8.0, 14.0, 22.0, 60.0].map(|wall| behind(Some(wall), soft));
        assert!(steps.windows(2).all(|pair| pair[1] > pair[0]), "{steps:?}");
        assert!((steps[4] / open - 1.0).abs() < 1e-3, "{steps:?} {open}");
    }
    // A wall that moves by centimetres takes whole layers of cells away at once where it is tested, not where it is read.
    let largest_step = |soft: bool| {
        let at: Vec<f64> = (0..20).map(|i| behind(Some(12.0 + 0.1 * i as f32), soft)).collect();
        at.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max) / open
    };
    let (tested, read) = (largest_step(false), largest_step(true));
    assert!(read < 0.7 * tested, "{read} {tested}");
}

#[test]
fn haze_before_cards_takes_their_light() {
    let Some(gpu) = device() else { return };
    let scene = Scene::new(&gpu);
    let mut hazy = scene.cards.clone();
    for card in &mut hazy {
        card.place[3] = 0.25;
    }
    let clear = mean(&red(&gpu, &scene, &Shot::of(&scene.cards)));
    let dimmed = mean(&red(&gpu, &scene, &Shot::of(&hazy)));
    assert!((dimmed / clear - 0.25).abs() < 0.01, "{dimmed} {clear}");
    let foggy = mean(&red(
        &gpu,
        &scene,
        &Shot {
            fog: Vec3::splat(SHOWN as f32),
            ..Shot::of(&hazy)
        },
    ));
    assert!((foggy / clear - 1.0).abs() < 0.01, "{foggy} {clear}");
}

#[test]
fn the_mask_has_what_swept_drops_cover() {
    let Some(gpu) = device() else { return };
    let scene = Scene::new(&gpu);
    let target = shoot(&gpu, &scene, &Shot::of(&scene.cards), 0.0, true);
    // One channel of half floats.
    let bytes = u64::from(SIDE * SIDE * 2);
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: bytes,
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    encoder.copy_texture_to_buffer(
        target.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(SIDE * 2),
                rows_per_image: Some(SIDE),
            },
        },
        wgpu::Extent3d {
            width: SIDE,
            height: SIDE,
            depth_or_array_layers: 1,
        },
    );
    gpu.queue.submit([encoder.finish()]);
    let halves: Vec<u16> = bytemuck::pod_collect_to_vec(&gpu.read(&buffer, bytes));
    let covered = mean(&halves.iter().map(|&h| f64::from(from_half(h))).collect::<Vec<f64>>());
    let opacity = mean(&red(&gpu, &scene, &Shot::of(&scene.cards))) / SHOWN;
    // A streak of 1/60 s covers some fifty times what its drop takes out of the light at a time.
    assert!(covered > 5.0 * opacity && covered <= 1.0, "{covered} {opacity}");
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Point {
    place: [f32; 4],
    lamp: LampParams,
}

#[test]
fn lamps_and_slants_are_the_cpus() {
    let Some(gpu) = device() else { return };
    let random = |i: u32, k: u32| pcg3d([i, k, 3]).map(|h| 2.0 * unit_f32(h) - 1.0);
    let lamps: Vec<Lamp> = (0..512)
        .map(|i| {
            let place = Vec3::from(random(i, 0)) * 12.0;
            let point = Lamp::point(place, (Vec3::from(random(i, 1)) + 1.5) * 40.0, 0.2);
            if i % 2 == 0 {
                return point;
            }
            Lamp {
                direction: Vec3::from(random(i, 2)).normalize(),
                cos_inner: 0.7,
                cos_outer: -0.2,
                ..point
            }
        })
        .collect();
    let inputs: Vec<Point> = (0..)
        .zip(&lamps)
        .map(|(i, lamp)| {
            let [x, y, z] = random(i, 4).map(|v| v * 10.0);
            Point {
                place: [x, y, z, 0.0],
                lamp: LampParams::from(lamp),
            }
        })
        .collect();
    let source = kernel(
        &format!("{}\nstruct Point {{ place: vec4<f32>, lamp: LampParams }}", library()),
        "Point",
        "vec4<f32>",
        "let at = input[i].place.xyz;
        output[i] = vec4<f32>(
            rain_lamp_radiance(input[i].lamp, at),
            rain_card_slant(-normalize(at.xz), normalize(at)) + 16.0 * f32(
                rain_lamp_bound(input[i].lamp, at + vec3<f32>(0.3, -0.2, 0.4), 0.6)
                    < 0.9999 * rain_lamp_radiance(input[i].lamp, at).r),
        );",
    );
    let outputs: Vec<[f32; 4]> = gpu.compute(&source, &inputs, &[]);
    let mut lit = 0;
    for ((found, input), lamp) in outputs.iter().zip(&inputs).zip(&lamps) {
        let place = Vec3::new(input.place[0], input.place[1], input.place[2]);
        let expected = lamp.radiance(place);
        for (found, expected) in found.iter().zip(expected.to_array()) {
            assert!(
                (found - expected).abs() <= 1e-3 * expected + 1e-7,
                "{found} {expected} at {place}"
            );
        }
        lit += usize::from(expected.x > 0.0);
        // 16 is added where a bound about a point 0.54 m away is broken.
        // A card that faces the eye straight: the line's level part is what it is met by.
        let level = f64::from(place.x.hypot(place.z) / place.length());
        let slant = pitch_weight(level) / level.max(0.05);
        assert!((f64::from(found[3]) - slant).abs() < 1e-4, "{} {slant}", found[3]);
    }
    assert!(lit > 300, "{lit}");
}
