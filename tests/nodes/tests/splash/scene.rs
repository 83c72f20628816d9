//! A scene of splashes without Bevy, seen from above: a field, a roof, a ramp, and nothing known beyond.

use glam::{DVec2, DVec3, IVec2, Mat4, Vec2, Vec3, Vec4};
use rain_core::hash::{pcg3d, unit_f32};
use rain_core::rainfall::{Distribution, Lamp, Spectrum, terminal_velocity_f32};
use rain_core::splash::{
    Impact, SPLASH_CELL_M, SPLASH_SLOTS, Splash, SplashAnchor, SplashExtent, SplashField, SplashMark, SplashShares,
};
use rain_render::cover::CoverPlacement;
use rain_render::glass::Pane;
use rain_render::gpu_types::{LevelMapParams, SplashDraw, SplashPart};
use rain_render::rainfall::Lighting;
use rain_render::splash::{
    SplashGpu, SplashInput, SplashTextures, SplashViewGpu, SpoutStream, StepSplash, encode_splash_make,
};

use crate::cover_parity::depth_texture;
use crate::device::Device;

const TEXELS: u32 = 512;
/// The roof: low x, low z, high x, high z, height. Units: m.
pub const ROOF: [f64; 5] = [-3.0, -2.0, -1.0, 2.0, 3.0];
/// Nothing is known from here on. Units: m.
pub const END_X: f64 = 4.0;
/// The ramp rises to −x from here, one in two. Units: m.
pub const RAMP_X: f64 = -4.0;
pub const SIZE: Vec2 = Vec2::new(800.0, 800.0);

/// A moment of the scene.
#[derive(Clone, Copy)]
pub struct Scene {
    /// Where its origin lies in the world. Units: m.
    pub origin_m: DVec3,
    /// The eye from there.
    pub eye_m: DVec3,
    pub wind_m_s: DVec2,
    pub rain_mm_h: f64,
    pub budget: f64,
    pub film_mm: f32,
    /// Depth of water everywhere. Units: m. 0: none.
    pub water_m: f32,
    pub now_s: f64,
    pub exposure_s: f32,
    pub reach_m: f32,
    pub near_reach_m: f32,
    pub contrast: f32,
    pub seed: u64,
    /// Height of the picture without perspective; its middle then sees the ground below the eye's place. Units: m. 0: with perspective.
    pub parallel_m: f32,
}

/// What a view may have beside the rain.
#[derive(Clone, Copy, Default)]
pub struct Extra<'a> {
    pub lamps: &'a [Lamp],
    pub panes: &'a [Pane],
    pub feet: &'a [StepSplash],
    pub mouths: &'a [SpoutStream],
}

impl Default for Scene {
    fn default() -> Self {
        Self {
            origin_m: DVec3::ZERO,
            eye_m: DVec3::new(-1.0, 7.0, 0.3),
            wind_m_s: DVec2::ZERO,
            rain_mm_h: 25.0,
            budget: 1e9,
            film_mm: 0.2,
            water_m: 0.0,
            now_s: 77.73,
            exposure_s: 1.0 / 60.0,
            reach_m: 12.0,
            near_reach_m: 0.0,
            contrast: 32.0,
            seed: 5,
            parallel_m: 0.0,
        }
    }
}

impl Scene {
    pub fn spectrum(&self) -> Spectrum {
        Spectrum::new(Distribution::MarshallPalmer, self.rain_mm_h).expect("valid")
    }

    pub fn extent(&self) -> SplashExtent {
        SplashExtent {
            reach_m: self.reach_m.into(),
            near_m: self.near_reach_m.into(),
            angle_rad: std::f64::consts::TAU,
            exposure_s: self.exposure_s.into(),
            film_mm: self.film_mm.into(),
        }
    }

    pub fn field(&self) -> SplashField {
        let spectrum = self.spectrum();
        SplashField::new(
            self.seed,
            &spectrum,
            &SplashShares::for_budget(&spectrum, &self.extent(), self.budget),
        )
    }

    fn eye_world(&self) -> DVec3 {
        self.origin_m + self.eye_m
    }

    fn placement(&self) -> CoverPlacement {
        CoverPlacement {
            centre_m: DVec2::new(self.origin_m.x, self.origin_m.z),
            plane_m: self.origin_m.y,
            extent_m: 30.0,
            top_m: self.origin_m.y + 9.0,
            range_m: 12.0,
            highest_m: self.origin_m.y + 8.0,
            wind_m_s: self.wind_m_s,
            inverse_speed_s_m: 0.169,
            texels: TEXELS,
        }
    }

    /// Height over a place from the scene's origin in still air, and the normal.
    pub fn ground(at: DVec2) -> Option<(f64, Vec3)> {
        if (ROOF[0]..ROOF[2]).contains(&at.x) && (ROOF[1]..ROOF[3]).contains(&at.y) {
            Some((ROOF[4], Vec3::Y))
        } else if at.x >= END_X {
            None
        } else if at.x < RAMP_X {
            Some((0.5 * (RAMP_X - at.x), Vec3::new(0.5, 1.0, 0.0).normalize()))
        } else {
            Some((0.0, Vec3::Y))
        }
    }

    /// Whether `at` is within `margin` of an edge or a bend.
    pub fn near_an_edge(at: DVec2, margin: f64) -> bool {
        let between = |v: f64, a: f64, b: f64| v > a - margin && v < b + margin;
        let round_roof = between(at.x, ROOF[0], ROOF[2]) && between(at.y, ROOF[1], ROOF[3]);
        let in_roof = between(at.x, ROOF[0] + 2.0 * margin, ROOF[2] - 2.0 * margin)
            && between(at.y, ROOF[1] + 2.0 * margin, ROOF[3] - 2.0 * margin);
        (round_roof && !in_roof) || (at.x - END_X).abs() < margin || (at.x - RAMP_X).abs() < margin
    }

    fn cover(&self, gpu: &Device) -> wgpu::TextureView {
        let p = self.placement();
        let drift = self.wind_m_s * p.inverse_speed_s_m;
        let texel = p.extent_m / f64::from(TEXELS);
        let depth: Vec<f32> = (0..TEXELS * TEXELS)
            .map(|i| {
                let q = (DVec2::new(f64::from(i % TEXELS), f64::from(i / TEXELS)) + 0.5) * texel - 0.5 * p.extent_m;
                let over = q - ROOF[4] * drift;
                let in_roof = (ROOF[0]..ROOF[2]).contains(&over.x) && (ROOF[1]..ROOF[3]).contains(&over.y);
                let height = if in_roof {
                    Some(ROOF[4])
                } else if self.wind_m_s == DVec2::ZERO {
                    Self::ground(q).map(|(height, _)| height)
                } else {
                    (q.x < END_X).then_some(0.0)
                };
                height.map_or(0.0, |h| (1.0 - (9.0 - h) / 12.0) as f32)
            })
            .collect();
        depth_texture(gpu, TEXELS, &depth)
    }

    /// Looking straight down, −z up on the screen. Infinite reverse-Z.
    pub fn clip_from_eye(&self) -> Mat4 {
        let view = Mat4::from_cols(Vec4::X, Vec4::Z, -Vec4::Y, Vec4::W);
        if self.parallel_m > 0.0 {
            let half = 0.5 * self.parallel_m;
            // Reverse-Z from 20 m above to 20 m below.
            return Mat4::orthographic_rh(-half, half, -half, half, 20.0, -20.0) * view;
        }
        let f = 1.0 / 0.6_f32.tan();
        let projection = Mat4::from_cols(
            Vec4::new(f, 0.0, 0.0, 0.0),
            Vec4::new(0.0, f, 0.0, 0.0),
            Vec4::new(0.0, 0.0, 0.0, -1.0),
            Vec4::new(0.0, 0.0, 0.05, 0.0),
        );
        projection * view
    }

    pub fn focal_px() -> f32 {
        0.5 * SIZE.y / 0.6_f32.tan()
    }

    /// Pixels of a metre at a point relative to the eye.
    pub fn px_per_m(&self, p: Vec3) -> f32 {
        if self.parallel_m > 0.0 {
            SIZE.y / self.parallel_m
        } else {
            Self::focal_px() / -p.y
        }
    }

    /// Pixel of a point relative to the eye.
    pub fn pixel(&self, p: Vec3) -> Vec2 {
        let clip = self.clip_from_eye() * p.extend(1.0);
        (Vec2::new(clip.x, clip.y) / clip.w * Vec2::new(0.5, -0.5) + 0.5) * SIZE
    }

    fn anchor(&self) -> SplashAnchor {
        SplashAnchor::new(self.eye_world(), self.now_s)
    }

    /// What the GPU makes of it, and how many parts there would have been.
    pub fn parts(&self, gpu: &Device, pipelines: &SplashGpu, capacity: u32) -> (Vec<SplashPart>, u32) {
        self.parts_with(gpu, pipelines, capacity, Extra::default())
    }

    /// The same with lamps, panes and steps.
    pub fn parts_with(
        &self,
        gpu: &Device,
        pipelines: &SplashGpu,
        capacity: u32,
        extra: Extra,
    ) -> (Vec<SplashPart>, u32) {
        let field = self.field();
        let (sin, cos) = 0.6_f32.sin_cos();
        let eye = self.eye_world();
        let levels = if self.water_m > 0.0 {
            LevelMapParams {
                corner: [-20.0, -20.0],
                inverse_cell: 1.0 / 40.0,
                base: (self.origin_m.y - eye.y) as f32,
                cells: [1.0, 1.0],
                present: 1.0,
                films: 0.0,
            }
        } else {
            LevelMapParams::default()
        };
        let input = SplashInput {
            field: &field,
            anchor: self.anchor(),
            clip_from_eye: self.clip_from_eye(),
            clip_from_eye_before: self.clip_from_eye(),
            side_planes: if self.parallel_m > 0.0 {
                [Vec3::X, -Vec3::X, Vec3::Z, -Vec3::Z].map(|n| n.extend(0.5 * self.parallel_m))
            } else {
                [
                    Vec3::new(cos, -sin, 0.0),
                    Vec3::new(-cos, -sin, 0.0),
                    Vec3::new(0.0, -sin, cos),
                    Vec3::new(0.0, -sin, -cos),
                ]
                .map(|n| n.extend(0.0))
            },
            parallel: (self.parallel_m > 0.0).then_some(Vec3::NEG_Y),
            wind_m_s: Vec3::new(self.wind_m_s.x as f32, 0.0, self.wind_m_s.y as f32),
            viewport_px: SIZE,
            focal_px: if self.parallel_m > 0.0 {
                SIZE.y / self.parallel_m
            } else {
                Self::focal_px()
            },
            near_m: if self.parallel_m > 0.0 { 0.0 } else { 0.05 },
            exposure_s: self.exposure_s,
            contrast: self.contrast,
            soft_m: 0.0,
            reach_m: self.reach_m,
            near_reach_m: self.near_reach_m,
            shares: [1.0; 2],
            film_mm: self.film_mm,
            capacity,
            lighting: Lighting {
                environment_scale: 0.0,
                environment_max_level: 0.0,
                ambient: Vec3::ONE,
                sun_direction: Vec3::Y,
                sun: Vec3::ZERO,
            },
            lamps: extra.lamps,
            panes: extra.panes,
            feet: extra.feet,
            mouths: extra.mouths,
            mouth_reach_m: 45.0,
            cover: self.placement().params(eye),
            levels,
        };
        let level = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d::default(),
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::R32Float,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        gpu.queue.write_texture(
            level.as_image_copy(),
            &self.water_m.to_le_bytes(),
            wgpu::TexelCopyBufferLayout::default(),
            level.size(),
        );
        let level = level.create_view(&wgpu::TextureViewDescriptor::default());
        let cover = self.cover(gpu);
        let mut view = SplashViewGpu::new(&gpu.device);
        let textures = SplashTextures {
            cover: Some(&cover),
            levels: Some(&level),
            ..SplashTextures::default()
        };
        view.prepare(&gpu.device, &gpu.queue, pipelines, &input, textures);
        let mut encoder = gpu
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            encode_splash_make(&mut pass, pipelines, &view);
        }
        gpu.queue.submit([encoder.finish()]);
        let draw: Vec<SplashDraw> =
            bytemuck::pod_collect_to_vec(&gpu.read(view.arguments(), size_of::<SplashDraw>() as u64));
        let draw = draw[0];
        assert_eq!((draw.instances, draw.first_vertex, draw.first_instance), (1, 0, 0));
        assert_eq!(draw.vertices, 6 * draw.found.min(capacity));
        let count = u64::from(draw.vertices / 6);
        if count == 0 {
            return (Vec::new(), draw.found);
        }
        let bytes = gpu.read(view.parts(), count * size_of::<SplashPart>() as u64);
        (bytemuck::pod_collect_to_vec(&bytes), draw.found)
    }

    /// The splashes that live now, by the CPU, in still air.
    pub fn living(&self) -> Vec<Living> {
        let field = self.field();
        let anchor = self.anchor();
        let span = (f64::from(self.reach_m) / SPLASH_CELL_M) as i32 + 1;
        let mut all = Vec::new();
        for back in 0..SPLASH_SLOTS {
            for z in -span..=span {
                for x in -span..=span {
                    let cell = IVec2::new(x, z);
                    field.for_each(anchor.cell.wrapping_add(cell), anchor.slot.wrapping_sub(back), |mark| {
                        let at = (cell.as_vec2() - anchor.fraction + Vec2::from(mark.place)) * SPLASH_CELL_M as f32;
                        all.extend(self.land(at, anchor.age_s(back, mark.moment), mark));
                    });
                }
            }
        }
        all
    }

    fn land(&self, at: Vec2, age_s: f32, mark: SplashMark) -> Option<Living> {
        let place = at.as_dvec2() + DVec2::new(self.eye_m.x, self.eye_m.z);
        let (height, normal) = Self::ground(place)?;
        let water = f64::from(self.water_m) - height;
        let flooded = self.water_m > 0.0 && (0.0..=0.6).contains(&water);
        let p = Vec3::new(
            at.x,
            (height - self.eye_m.y + if flooded { water } else { 0.0 }) as f32,
            at.y,
        );
        let speed = terminal_velocity_f32(mark.diameter_mm);
        let velocity = Vec3::new(0.0, -speed, 0.0);
        let vary = pcg3d([mark.key[1], mark.key[2], mark.key[0]]).map(unit_f32);
        let impact = Impact {
            diameter_mm: mark.diameter_mm,
            velocity_m_s: velocity,
            normal: if flooded { Vec3::Y } else { normal },
            film_mm: if flooded { (1e3 * water) as f32 } else { self.film_mm },
        };
        let splash = Splash::new(&impact, mark.key);
        let lives = (0.0..=mark.life_s).contains(&age_s);
        // Still air: every slope is hit as often as level ground.
        (lives && splash.count > 0 && p.length() < self.reach_m).then_some(Living {
            place,
            p,
            age_s,
            mark,
            impact,
            splash,
            vary,
        })
    }
}

/// A splash of the CPU's.
pub struct Living {
    /// From the scene's origin.
    pub place: DVec2,
    /// From the eye.
    pub p: Vec3,
    pub age_s: f32,
    pub mark: SplashMark,
    pub impact: Impact,
    pub splash: Splash,
    pub vary: [f32; 3],
}
