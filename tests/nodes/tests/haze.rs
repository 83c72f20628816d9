//! Haze on a GPU against the account of optical depth, rain areas and lamps in double precision.

use glam::{DVec3, Mat4, Quat, Vec3, Vec4};
use rain_core::haze::{
    FogTable, HazeSharing, LUMA_LINEAR, RateExtinction, cone_span_m, desaturated, extinction_per_m, lamp_glow_per_m,
};
use rain_core::rainfall::{CLASS_COUNT, Distribution, Lamp, Spectrum};
use rain_core::splash::MistLayers;
use rain_render::cover::open_sky;
use rain_render::gpu_types::CoverParams;
use rain_render::haze::{
    HazeAreas, HazeBow, HazeFar, HazeFog, HazeGpu, HazeInput, HazeSplash, HazeTextures, HazeViewGpu, encode_haze,
    encode_haze_areas,
};
use rain_render::rainfall::{DEPTH_FORMAT, Lighting};

use crate::device::{Device, device, kernel, library};
use crate::maps::read_map;

mod air;
mod areas;
mod splash_mist;

const SIDE: u32 = 64;
const NEAR_M: f32 = 0.1;
/// Tangent of half the view's angle.
const HALF: f32 = 0.5;
const COLOUR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Halves have 11 bits: a value is rounded by 2⁻¹¹ of itself at most, and blended once.
const HALF_STEP: f64 = 1.0 / 1024.0;

fn spectrum(rate: f64) -> Spectrum {
    Spectrum::new(Distribution::MarshallPalmer, rate).expect("a rate")
}

/// What a test varies.
struct Shot<'a> {
    rotation: Quat,
    rate: f64,
    drawn_m: [f32; 64],
    areas: Option<HazeAreas<'a>>,
    far: Option<HazeFar>,
    cloud_m: f32,
    thin_m: f32,
    fog: Option<HazeFog>,
    mist_per_m: f32,
    bow: Option<HazeBow<'a>>,
    /// Layers of mist over level ground at this height from the eye, covered at the height of a roof.
    splash: Option<(MistLayers, f32, Option<f32>)>,
    /// Where it stands, and its illuminance.
    sun: [Vec3; 2],
    lamps: &'a [Lamp],
    ambient: Vec3,
    background: [f64; 3],
    /// Distance of a wall across the view; none: sky.
    wall_m: Option<f32>,
    /// Height of a mirror over the eye, in whose picture nothing nearer is drawn.
    mirror_m: Option<f32>,
    samples: u32,
}

impl Default for Shot<'_> {
    fn default() -> Self {
        Self {
            rotation: Quat::IDENTITY,
            rate: 25.0,
            drawn_m: [0.0; 64],
            areas: None,
            far: None,
            cloud_m: 1000.0,
            thin_m: 0.0,
            fog: None,
            mist_per_m: 0.0,
            bow: None,
            splash: None,
            sun: [Vec3::Y, Vec3::ZERO],
            lamps: &[],
            ambient: Vec3::ZERO,
            background: [1.0; 3],
            wall_m: Some(100.0),
            mirror_m: None,
            samples: 1,
        }
    }
}

/// Where a map of one depth, a half, lies that covers all at a height from the eye.
fn level_cover(height_m: f32) -> CoverParams {
    CoverParams {
        inverse_extent: 1.0 / 60.0,
        top: height_m + 10.0,
        range: 20.0,
        highest: height_m,
        plane: height_m,
        texels: 16.0,
        present: 1.0,
        ..open_sky()
    }
}

/// Longest way of the tests. Units: m.
const LIMIT_M: f32 = 20_000.0;

impl Shot<'_> {
    /// The unit line of sight of a pixel.
    fn towards(&self, x: u32, y: u32) -> DVec3 {
        let ndc = |i: u32| f64::from(2 * i + 1) / f64::from(SIDE) - 1.0;
        let ahead = DVec3::new(ndc(x) * f64::from(HALF), -ndc(y) * f64::from(HALF), -1.0);
        (self.rotation.as_dquat() * ahead).normalize()
    }

    /// Clip from view.
    fn projection(&self) -> Mat4 {
        let f = 1.0 / HALF;
        let mut projection = Mat4::from_cols(
            Vec4::new(f, 0.0, 0.0, 0.0),
            Vec4::new(0.0, f, 0.0, 0.0),
            Vec4::new(0.0, 0.0, 0.0, -1.0),
            Vec4::new(0.0, 0.0, NEAR_M, 0.0),
        );
        if let Some(height) = self.mirror_m {
            // The near plane is the mirror: the third row after Lengyel 2005, as Bevy has it.
            let plane = (self.rotation.inverse() * Vec3::Y).extend(-height);
            let corner = projection.inverse() * Vec4::new(plane.x.signum(), plane.y.signum(), 0.0, 1.0);
            let row = Vec4::NEG_Z - plane * (-corner.z / plane.dot(corner));
            projection.x_axis.z = row.x;
            projection.y_axis.z = row.y;
            projection.z_axis.z = row.z;
            projection.w_axis.z = row.w;
        }
        projection
    }

    /// How far a line of sight goes in a picture whose near plane is a mirror. Units: m.
    fn mirrored_way(&self, towards: DVec3) -> f64 {
        let clip_from_eye = self.projection().as_dmat4() * glam::DMat4::from_quat(self.rotation.inverse().as_dquat());
        let clip = clip_from_eye * towards.extend(0.0);
        let depth = self.wall_m.map_or(0.0, |wall| f64::from(NEAR_M / wall));
        let place = clip_from_eye.inverse() * glam::DVec4::new(clip.x / clip.w, clip.y / clip.w, depth, 1.0);
        let way = if place.w > 0.0 {
            (place.truncate() / place.w).length()
        } else {
            f64::INFINITY
        };
        way.min(f64::from(self.cloud_m) / towards.y).min(LIMIT_M.into())
    }

    /// How far that reaches under the cloud. Units: m.
    fn way(&self, towards: DVec3) -> f64 {
        let ahead = towards.dot(self.rotation.as_dquat() * DVec3::NEG_Z);
        let wall = self.wall_m.map_or(f64::INFINITY, |wall| f64::from(wall) / ahead);
        let out = if towards.y > 0.0 {
            f64::from(self.cloud_m) / towards.y
        } else {
            f64::INFINITY
        };
        wall.min(out).min(LIMIT_M.into())
    }

    fn take(&self, gpu: &Device) -> Vec<[f32; 4]> {
        let projection = self.projection();
        let texture = |format, samples, more: wgpu::TextureUsages| {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d {
                    width: SIDE,
                    height: SIDE,
                    depth_or_array_layers: 1,
                },
                mip_level_count: 1,
                sample_count: samples,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | more,
                view_formats: &[],
            })
        };
        let depth =
            texture(DEPTH_FORMAT, self.samples, wgpu::TextureUsages::TEXTURE_BINDING).create_view(&Default::default());
        // A map whose depth is a half everywhere.
        let cover = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d {
                width: 16,
                height: 16,
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: DEPTH_FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        let cover = cover.create_view(&Default::default());
        let rates = RateExtinction::new(Distribution::MarshallPalmer, 2.0);
        let input = HazeInput {
            clip_from_eye: projection * Mat4::from_quat(self.rotation.inverse()),
            forward: self.rotation * Vec3::NEG_Z,
            viewport_px: Vec4::new(0.0, 0.0, SIDE as f32, SIDE as f32),
            lighting: Lighting {
                environment_scale: 0.0,
                environment_max_level: 0.0,
                ambient: self.ambient,
                sun_direction: self.sun[0],
                sun: self.sun[1],
            },
            extinction_per_m: extinction_per_m(&spectrum(self.rate), 2.0) as f32,
            efficiency: 2.0,
            drawn_m: self.drawn_m,
            rates: &rates,
            areas: self.areas,
            far: self.far,
            cloud_m: self.cloud_m,
            thin_m: self.thin_m,
            limit_m: LIMIT_M,
            fog: self.fog,
            mist_per_m: self.mist_per_m,
            mirror_m: self.mirror_m,
            bow: self.bow,
            splash: self.splash.map(|(mist, ground, roof)| HazeSplash {
                mist,
                cover: level_cover(roof.unwrap_or(ground)),
            }),
            lamps: self.lamps,
        };
        let mut haze = HazeGpu::new(&gpu.device);
        haze.prepare_pipelines(&gpu.device, COLOUR, self.samples, false, self.splash.is_some());
        let mut view = HazeViewGpu::new(&gpu.device);
        let textures = HazeTextures {
            scene_depth: &depth,
            environment: None,
            cover: Some(&cover),
        };
        view.prepare(&gpu.device, &gpu.queue, &haze, &input, textures, self.samples);
        let target = texture(
            COLOUR,
            1,
            wgpu::TextureUsages::COPY_SRC | wgpu::TextureUsages::TEXTURE_BINDING,
        );
        let target_view = target.create_view(&Default::default());
        let many = (self.samples > 1)
            .then(|| texture(COLOUR, self.samples, wgpu::TextureUsages::empty()).create_view(&Default::default()));
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(self.wall_m.map_or(0.0, |wall| NEAR_M / wall)),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &cover,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0.5),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        encode_haze_areas(&mut encoder.begin_compute_pass(&Default::default()), &haze, &view);
        let [r, g, b] = self.background;
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: many.as_ref().unwrap_or(&target_view),
                depth_slice: None,
                resolve_target: many.as_ref().map(|_| &target_view),
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a: 0.25 }),
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..Default::default()
        });
        encode_haze(&mut pass, &haze, &view, COLOUR, self.samples);
        drop(pass);
        gpu.queue.submit([encoder.finish()]);
        read_map(gpu, &target, 0)
    }

    /// Calls `check` with the line of sight and the colour of every pixel.
    fn each(&self, gpu: &Device, mut check: impl FnMut(DVec3, [f64; 3])) {
        for (i, texel) in (0..).zip(self.take(gpu)) {
            assert_eq!(texel[3], 0.25, "the target's alpha stays");
            let rgb = [texel[0], texel[1], texel[2]].map(f64::from);
            check(self.towards(i % SIDE, i / SIDE), rgb);
        }
    }
}

#[test]
fn haze_takes_out_what_drops_do_not() {
    let Some(gpu) = device() else { return };
    for rate in [5.0, 25.0, 100.0] {
        let s = spectrum(rate);
        let ranges: [f64; CLASS_COUNT] = core::array::from_fn(|k| 1.0 + k as f64);
        // Classes as steps of diameter, so that the table and the account say the same.
        let range_of = |d: f64| {
            let edges = rain_core::rainfall::CLASS_EDGES_MM;
            let class = edges.windows(2).position(|e| d >= e[0] && d < e[1]);
            class.map_or(0.0, |k| ranges[k])
        };
        for cards in [false, true] {
            let sharing = HazeSharing::new(&s, 2.0, ranges, cards).expect("an account");
            let table = FogTable::new(&s, 2.0, cards, range_of).expect("a table");
            for wall in [0.5, 3.0, 12.0, 30.0, 200.0, 1500.0] {
                let shot = Shot {
                    rate,
                    drawn_m: table.drawn_m(),
                    wall_m: Some(wall),
                    ..Shot::default()
                };
                // That of the table: metres of σ_geo; and what halves hold.
                let allowed = 0.02 * extinction_per_m(&s, 1.0) + HALF_STEP;
                shot.each(&gpu, |towards, rgb| {
                    let way = shot.way(towards);
                    let expected = sharing.fog_transmittance(way);
                    assert!(
                        (rgb[0] - expected).abs() < allowed,
                        "{rate} mm/h {way} m: {} {expected}",
                        rgb[0]
                    );
                    // Drops and haze together are the whole rain.
                    let drawn = sharing.drawn_depth(way);
                    let all = drawn - rgb[0].ln();
                    let total = sharing.total_depth(way);
                    if total < 3.0 {
                        assert!(
                            (all - total).abs() < 0.05 * total + 2.0 * HALF_STEP / rgb[0],
                            "{way}: {all} {total}"
                        );
                    }
                });
            }
        }
    }
}

#[test]
fn sky_is_veiled_up_to_the_cloud_and_an_eye_above_it_sees_haze_below_alone() {
    let Some(gpu) = device() else { return };
    let extinction = extinction_per_m(&spectrum(25.0), 2.0);
    let mut clear = 0;
    for (cloud, pitch) in [(300.0, 0.5), (300.0, -0.3), (-200.0, 0.3), (-200.0, -0.3)] {
        let shot = Shot {
            cloud_m: cloud,
            rotation: Quat::from_rotation_x(pitch),
            wall_m: None,
            ..Shot::default()
        };
        shot.each(&gpu, |towards, rgb| {
            let expected = if cloud > 0.0 {
                (-extinction * shot.way(towards)).exp()
            } else if towards.y < 0.0 {
                let from = f64::from(cloud) / towards.y;
                (-extinction * (f64::from(LIMIT_M) - from).max(0.0)).exp()
            } else {
                1.0
            };
            clear += usize::from(expected == 1.0);
            assert!(
                (rgb[0] - expected).abs() < 2.0 * HALF_STEP,
                "{cloud} {towards}: {} {expected}",
                rgb[0]
            );
        });
    }
    assert!(clear > 1000, "{clear}");
}

#[test]
fn haze_in_even_light_changes_nothing_and_draws_colours_to_that_of_the_light() {
    let Some(gpu) = device() else { return };
    let even = Shot {
        ambient: Vec3::splat(0.6),
        background: [0.6; 3],
        wall_m: Some(400.0),
        ..Shot::default()
    };
    even.each(&gpu, |_, rgb| assert!((rgb[0] - 0.6).abs() < HALF_STEP, "{rgb:?}"));
    let coloured = Shot {
        ambient: Vec3::splat(0.5),
        background: [0.9, 0.1, 0.1],
        wall_m: Some(400.0),
        ..Shot::default()
    };
    coloured.each(&gpu, |towards, rgb| {
        let share = (-extinction_per_m(&spectrum(25.0), 2.0) * coloured.way(towards)).exp();
        assert!((rgb[0] - (0.9 * share + 0.5 * (1.0 - share))).abs() < 2.0 * HALF_STEP);
        assert!((rgb[1] - (0.1 * share + 0.5 * (1.0 - share))).abs() < 2.0 * HALF_STEP);
    });
}

#[test]
fn the_artists_fog_has_its_own_density_and_loses_its_colour() {
    let Some(gpu) = device() else { return };
    for desaturation in [0.0_f32, 0.7, 1.0] {
        let shot = Shot {
            ambient: Vec3::ONE,
            background: [0.0; 3],
            fog: Some(HazeFog {
                density_per_m: 0.004,
                colour: Vec3::new(0.2, 0.5, 0.9),
                coloured: 1.0,
                desaturation,
                share: 1.0,
            }),
            ..Shot::default()
        };
        let colour = desaturated([0.2, 0.5, 0.9], desaturation.into(), LUMA_LINEAR);
        shot.each(&gpu, |towards, rgb| {
            let share = -(-0.004 * shot.way(towards)).exp_m1();
            for (found, own) in rgb.into_iter().zip(colour) {
                assert!((found - own * share).abs() < 2.0 * HALF_STEP, "{found} {}", own * share);
            }
        });
    }
}

#[test]
fn a_lamp_glows_as_its_integral_says() {
    let Some(gpu) = device() else { return };
    let rate = 50.0;
    let geometric = extinction_per_m(&spectrum(rate), 1.0);
    let lamps = [
        Lamp::point(Vec3::new(2.0, 1.0, -20.0), Vec3::new(400.0, 300.0, 200.0), 0.05),
        Lamp {
            direction: Vec3::NEG_Y,
            cos_inner: 0.7,
            cos_outer: 0.7,
            ..Lamp::point(Vec3::new(-3.0, 4.0, -15.0), Vec3::splat(500.0), 0.1)
        },
    ];
    for wall in [Some(12.0), Some(60.0), None] {
        for lamp in &lamps {
            let shot = Shot {
                rate,
                background: [0.0; 3],
                wall_m: wall,
                lamps: core::slice::from_ref(lamp),
                ..Shot::default()
            };
            let mut lit = 0;
            shot.each(&gpu, |towards, rgb| {
                let (mut from, mut to) = (0.0, shot.way(towards));
                if lamp.cos_outer > -1.0 {
                    let axis = lamp.direction.as_dvec3();
                    let span = cone_span_m(lamp.position_m.as_dvec3(), axis, lamp.cos_outer.into(), towards);
                    (from, to) = (span[0], span[1].min(to));
                }
                // Behind the wall the eye does not see it.
                let hidden = wall.is_some_and(|wall| wall < 15.0);
                let glow = if hidden {
                    0.0
                } else {
                    let place = lamp.position_m.as_dvec3();
                    lamp_glow_per_m(place, towards, from, to, lamp.radius_m.into(), 2.0 * geometric)
                };
                for (found, own) in rgb.into_iter().zip(lamp.intensity.as_dvec3().to_array()) {
                    let expected = own * glow * geometric;
                    // Single precision at a cone's edge: the angle from the apex to 1e-6.
                    assert!(
                        (found - expected).abs() < 2.0 * HALF_STEP * expected + 1e-3,
                        "{towards}: {found} {expected}"
                    );
                    lit += usize::from(found > 0.01);
                }
            });
            assert_eq!(lit > 200, wall != Some(12.0), "{lit}");
        }
    }
}

#[test]
fn glow_and_cones_are_the_cpus() {
    let Some(gpu) = device() else { return };
    let unit = |i: u32, k: u32| f64::from((i * 7919 + k * 104_729) % 1999) / 999.5 - 1.0;
    let rows: Vec<[f32; 4]> = (0..3000)
        .flat_map(|i| {
            let d = DVec3::new(unit(i, 4), unit(i, 5), unit(i, 6))
                .normalize_or(DVec3::X)
                .as_vec3();
            let lamp = [unit(i, 1), unit(i, 2), unit(i, 3)].map(|v| (v * 30.0) as f32);
            let axis = DVec3::new(unit(i, 8), unit(i, 9), unit(i, 10))
                .normalize_or(DVec3::Y)
                .as_vec3();
            [
                [lamp[0], lamp[1], lamp[2], (0.006 * unit(i, 7).abs()) as f32],
                [d.x, d.y, d.z, (30.0 * unit(i, 11).abs()) as f32],
                [axis.x, axis.y, axis.z, (0.5 + 0.4 * unit(i, 12)) as f32],
            ]
        })
        .collect();
    let body = "let a = input[3u * (i / 3u)]; let b = input[3u * (i / 3u) + 1u]; let c = input[3u * (i / 3u) + 2u];
        let cone = rain_cone_span(a.xyz, c.xyz, c.w, b.xyz);
        output[i] = vec4<f32>(rain_lamp_glow(a.xyz, b.xyz, 1.0, 1.0 + b.w, 0.05, a.w), cone, rain_haze_share(a.w));";
    let found: Vec<[f32; 4]> = gpu.compute(&kernel(&library(), "vec4<f32>", "vec4<f32>", body), &rows, &[]);
    let mut cones = 0;
    for (row, found) in rows.chunks(3).zip(found.chunks(3)) {
        let v = |r: [f32; 4]| Vec3::new(r[0], r[1], r[2]).as_dvec3();
        let (lamp, towards, axis) = (v(row[0]), v(row[1]), v(row[2]));
        let expected = lamp_glow_per_m(lamp, towards, 1.0, 1.0 + f64::from(row[1][3]), 0.05, row[0][3].into());
        let glow = f64::from(found[0][0]);
        assert!(
            (glow - expected).abs() < 1e-3 * expected + 1e-7,
            "{row:?}: {glow} {expected}"
        );
        let share = -(-f64::from(row[0][3])).exp_m1();
        assert!(
            (f64::from(found[0][3]) - share).abs() < 1e-6 * share.max(0.1),
            "{share}"
        );
        let cosine = f64::from(row[2][3]);
        let [from, to] = cone_span_m(lamp, axis, cosine, towards);
        // Where the line runs along the cone, the place is where rounding wants it.
        let along = axis.dot(towards);
        if to > from && to < 200.0 && (along * along - cosine * cosine).abs() > 0.05 && to - from > 0.5 {
            let off = (f64::from(found[0][1]) - from)
                .abs()
                .max((f64::from(found[0][2]) - to).abs());
            assert!(off < 0.02, "{row:?}: {found:?} {from} {to}");
            cones += 1;
        }
    }
    assert!(cones > 100, "{cones}");
}

#[test]
fn four_samples_show_what_one_shows() {
    let Some(gpu) = device() else { return };
    let one = Shot {
        ambient: Vec3::splat(0.3),
        ..Shot::default()
    };
    let four = Shot {
        samples: 4,
        ambient: Vec3::splat(0.3),
        ..Shot::default()
    };
    for (a, b) in one.take(&gpu).iter().zip(four.take(&gpu)) {
        assert!((a[0] - b[0]).abs() < 2.0 * HALF_STEP as f32, "{a:?} {b:?}");
    }
}
