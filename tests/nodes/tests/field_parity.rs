//! The drops that the GPU projects are the CPU's: places, diameters, speeds, and which of them are drawn.

use glam::{DVec3, Mat4, Vec2, Vec3, Vec4};
use rain_core::rainfall::{
    CLASS_COUNT, Container, DetailLaw, Distribution, DrawRange, DropChoice, FADE_END, FieldMotion, Lamp, MAX_LAMPS,
    ParallelView, RANGE_CAP_M, RainViewVolume, SizeClass, Spectrum, terminal_velocity, visible_range_m,
};
use rain_render::cover::open_sky;
use rain_render::glass::Pane;
use rain_render::gpu_types::Streak;
use rain_render::rainfall::{
    Drops, Lighting, RainfallGpu, RainfallInput, RainfallTextures, RainfallViewGpu, Shutter, encode_project,
};

use crate::device::{Device, device, kernel, library};

/// A view of the drop field without Bevy.
pub struct FieldView {
    pub size: Vec2,
    pub fov_y: f32,
    pub eye_m: glam::DVec3,
    pub eye_velocity_m_s: glam::DVec3,
    pub exposure_s: f32,
    pub kappa: f64,
    pub seconds: f64,
    pub wind_m_s: glam::DVec3,
    pub lamps: Vec<Lamp>,
    pub panes: Vec<Pane>,
    pub detail: Option<DetailLaw>,
    /// Width of the picture of a view without perspective, whose left side the eye is at. Units: m.
    pub width_m: Option<f32>,
}

impl Default for FieldView {
    fn default() -> Self {
        Self {
            size: Vec2::new(1280.0, 720.0),
            fov_y: 1.0,
            eye_m: glam::DVec3::new(100_003.7, 1.7, -43_210.4),
            eye_velocity_m_s: glam::DVec3::ZERO,
            exposure_s: 1.0 / 60.0,
            kappa: 1.0,
            seconds: 1234.5,
            wind_m_s: glam::DVec3::new(3.0, 0.0, -1.0),
            lamps: Vec::new(),
            panes: Vec::new(),
            detail: None,
            width_m: None,
        }
    }
}

/// The two halves of a word: the lower one first.
pub fn half_pair(word: u32) -> [f32; 2] {
    [word as u16, (word >> 16) as u16].map(|bits| half::f16::from_bits(bits).to_f32())
}

impl FieldView {
    pub fn focal_px(&self) -> f32 {
        if let Some(width) = self.width_m {
            return self.size.x / width * RANGE_CAP_M as f32;
        }
        0.5 * self.size.y / (0.5 * self.fov_y).tan()
    }

    /// Infinite reverse-Z, looking along −Z, near plane at 5 cm.
    fn clip_from_eye(&self) -> Mat4 {
        if let Some(width) = self.width_m {
            // From 100 m before the eye to 100 m behind it.
            return Mat4::from_cols(
                Vec4::new(2.0 / width, 0.0, 0.0, 0.0),
                Vec4::new(0.0, 2.0 * self.size.x / self.size.y / width, 0.0, 0.0),
                Vec4::new(0.0, 0.0, 1.0 / 200.0, 0.0),
                Vec4::new(-1.0, 0.0, 0.5, 1.0),
            );
        }
        let f = 1.0 / (0.5 * self.fov_y).tan();
        Mat4::from_cols(
            Vec4::new(f * self.size.y / self.size.x, 0.0, 0.0, 0.0),
            Vec4::new(0.0, f, 0.0, 0.0),
            Vec4::new(0.0, 0.0, 0.0, -1.0),
            Vec4::new(0.0, 0.0, 0.05, 0.0),
        )
    }

    /// The view as drops are chosen for it.
    fn volume(&self) -> RainViewVolume {
        let ty = (0.5 * self.fov_y).tan();
        let tx = ty * self.size.x / self.size.y;
        let plane = |n: Vec3| n.normalize().extend(0.0);
        let view = RainViewVolume {
            eye_m: self.eye_m,
            eye_velocity_m_s: self.eye_velocity_m_s,
            side_planes: [
                plane(Vec3::new(1.0, 0.0, -tx)),
                plane(Vec3::new(-1.0, 0.0, -tx)),
                plane(Vec3::new(0.0, 1.0, -ty)),
                plane(Vec3::new(0.0, -1.0, -ty)),
            ],
            focal_px: f64::from(self.focal_px()),
            solid_angle_sr: 1.0,
            exposure_s: f64::from(self.exposure_s),
            turn_rad: 0.0,
            parallel: None,
        };
        self.width_m.map_or(view, |width| {
            let height = width * self.size.y / self.size.x;
            RainViewVolume {
                side_planes: [
                    Vec4::X,
                    Vec4::new(-1.0, 0.0, 0.0, width),
                    Vec4::new(0.0, 1.0, 0.0, 0.5 * height),
                    Vec4::new(0.0, -1.0, 0.0, 0.5 * height),
                ],
                parallel: Some(ParallelView {
                    across_m: DVec3::X * f64::from(width),
                    height_m: height.into(),
                    ahead: DVec3::NEG_Z,
                }),
                ..view
            }
        })
    }

    /// What its drops are chosen from at a spectrum.
    pub fn choice(&self, seed: u64, spectrum: &Spectrum) -> DropChoice {
        let mut motion = FieldMotion::default();
        motion.set_velocity(self.wind_m_s, 1.2041);
        motion.advance(self.seconds);
        DropChoice {
            seed,
            spectrum: *spectrum,
            motion,
            view: self.volume(),
            kappa: self.kappa,
            most_drops: 1 << 21,
            uneven: None,
            region: None,
            detail: self.detail,
        }
    }

    /// The drops that this view draws at a spectrum.
    pub fn container(&self, seed: u64, spectrum: &Spectrum) -> Container {
        let mut container = Container::default();
        assert!(self.choice(seed, spectrum).fill(&mut container));
        container
    }

    /// What the nodes are given of them: contrast 1, even light under an open sky.
    pub fn input<'a>(&'a self, seed: u64, container: &'a Container) -> RainfallInput<'a> {
        self.input_of(Drops::Listed(container, seed))
    }

    /// The same for any drops.
    pub fn input_of<'a>(&'a self, drops: Drops<'a>) -> RainfallInput<'a> {
        let now = self.clip_from_eye();
        let shift = self.eye_velocity_m_s.as_vec3() * self.exposure_s;
        RainfallInput {
            drops,
            clip_from_eye: now,
            clip_from_eye_before: now * Mat4::from_translation(shift),
            eye_height_m: self.eye_m.y as f32,
            eye_velocity_m_s: self.eye_velocity_m_s.as_vec3(),
            viewport_px: Vec4::new(0.0, 0.0, self.size.x, self.size.y),
            focal_px: self.focal_px(),
            parallel: match drops {
                Drops::Chosen(choice) => choice.view.parallel,
                Drops::Listed(..) => self.volume().parallel,
            },
            near_m: 0.05,
            shutter: Shutter {
                exposure_s: self.exposure_s,
                contrast: 1.0,
                kappa: self.kappa as f32,
                soft_m: 0.0,
                patterned: false,
                detail: self.detail,
            },
            lighting: Lighting {
                environment_scale: 0.0,
                environment_max_level: 0.0,
                ambient: Vec3::ONE,
                sun_direction: Vec3::Y,
                sun: Vec3::ZERO,
            },
            lamps: &self.lamps,
            panes: &self.panes,
            cover: open_sky(),
        }
    }

    /// The streaks that the GPU makes of them.
    pub fn streaks(&self, gpu: &Device, pipelines: &RainfallGpu, seed: u64, container: &Container) -> Vec<Streak> {
        let input = self.input(seed, container);
        let mut view = RainfallViewGpu::new(&gpu.device);
        view.prepare(&gpu.device, &gpu.queue, pipelines, &input, RainfallTextures::default());
        let mut encoder = gpu
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            encode_project(&mut pass, pipelines, &view);
        }
        gpu.queue.submit([encoder.finish()]);
        let bytes = gpu.read(view.streaks(), (container.records.len() * size_of::<Streak>()) as u64);
        bytemuck::pod_collect_to_vec(&bytes)
    }

    /// Where a place relative to the eye is in the picture; the depth along the view axis as z. Units: px, m.
    pub fn project(&self, p: Vec3) -> Vec3 {
        let clip = self.clip_from_eye() * p.extend(1.0);
        let ndc = clip.truncate().truncate() / clip.w;
        ((ndc * Vec2::new(0.5, -0.5) + 0.5) * self.size).extend(clip.w)
    }
}

#[test]
fn projected_drops_are_where_the_cpu_puts_them_and_another_seed_is_found() {
    let Some(gpu) = device() else { return };
    let pipelines = RainfallGpu::new(&gpu.device);
    let spectrum = Spectrum::new(Distribution::MarshallPalmer, 25.0).expect("a spectrum");
    let view = FieldView::default();
    let seed = 0xFEDC_BA98_7654_3210;
    let container = view.container(seed, &spectrum);
    let streaks = view.streaks(&gpu, &pipelines, seed, &container);
    let range = DrawRange {
        kappa: view.kappa,
        focal_px: f64::from(view.focal_px()),
        exposure_s: f64::from(view.exposure_s),
    };
    let (mut compared, mut classes, mut worst) = (0, [0_u32; CLASS_COUNT], 0.0_f32);
    let mut misplaced_by_another_seed = 0;
    for (record, streak) in container.records.iter().zip(&streaks) {
        let p = record.position(seed, &container.classes);
        let class = (record.drop & 15) as usize;
        let before = p - container.classes[class].velocity_m_s * view.exposure_s;
        let (head, tail) = (view.project(p), view.project(before));
        let reach = FADE_END * range.at(SizeClass::new(class).min_mm);
        if head.z < 0.06 || tail.z < 0.06 || f64::from(p.length()) > reach || p.length() < 0.2 {
            // Cut at the near plane, faded away, or right at one of the two limits.
            continue;
        }
        assert!(streak.shape[2] > 0.0, "a drop at {p} is not drawn");
        let off = (Vec2::new(streak.ends[0], streak.ends[1]) - head.truncate())
            .length()
            .max((Vec2::new(streak.ends[2], streak.ends[3]) - tail.truncate()).length());
        worst = worst.max(off / head.truncate().length().max(1000.0) * 1000.0);
        let other = view.project(record.position(seed + 1, &container.classes));
        if (Vec2::new(streak.ends[0], streak.ends[1]) - other.truncate()).length() > 1.0 {
            misplaced_by_another_seed += 1;
        }
        compared += 1;
        classes[class] += 1;
    }
    assert!(
        compared > 5_000 && classes.iter().all(|n| *n > 0),
        "{compared} drops, {classes:?}"
    );
    // 1e-6 m at 0.2 m is 3e-3 px.
    assert!(worst < 0.02, "{worst} px");
    assert!(
        misplaced_by_another_seed * 100 > compared * 99,
        "{misplaced_by_another_seed} of {compared}"
    );
}

#[test]
fn without_perspective_streaks_are_parallel_and_as_wide_as_their_drops() {
    let Some(gpu) = device() else { return };
    let pipelines = RainfallGpu::new(&gpu.device);
    let spectrum = Spectrum::new(Distribution::MarshallPalmer, 25.0).expect("a spectrum");
    let view = FieldView {
        width_m: Some(12.0),
        kappa: 0.5,
        ..FieldView::default()
    };
    let container = view.container(9, &spectrum);
    let streaks = view.streaks(&gpu, &pipelines, 9, &container);
    let scale = view.size.x / 12.0;
    let (mut drawn, mut wide, mut away) = (0, 0, [0; 2]);
    for (record, streak) in container.records.iter().zip(&streaks) {
        let p = record.position(9, &container.classes);
        let class = SizeClass::new((record.drop & 15) as usize);
        if streak.shape[2] == 0.0 {
            continue;
        }
        drawn += 1;
        away[usize::from(p.z > 0.0)] += 1;
        let velocity = container.classes[(record.drop & 15) as usize].velocity_m_s;
        let head = Vec2::new(p.x, -p.y) * scale + Vec2::new(0.0, 0.5 * view.size.y);
        let tail = head - Vec2::new(velocity.x, -velocity.y) * (view.exposure_s * scale);
        let ends = [
            streak.ends[0] - head.x,
            streak.ends[1] - head.y,
            streak.ends[2] - tail.x,
            streak.ends[3] - tail.y,
        ];
        assert!(ends.iter().all(|off| off.abs() < 0.02), "{ends:?} at {p}");
        let width = 2.0 * streak.shape[2].abs();
        let [least, most] = [class.min_mm, class.max_mm].map(|d| (d as f32 * 1e-3 * scale).max(1.0));
        assert!(
            width > 0.999 * least && width < 1.001 * most,
            "{width} px, {least} to {most}"
        );
        wide += u32::from(width > 1.0);
        // Half of the way through the depth range at the eye, whatever lies beside it.
        assert!((streak.shape[0] - 0.5 - p.z / 200.0).abs() < 1e-5);
    }
    assert!(drawn > 3000 && wide == 0, "{drawn} drawn, {wide} wider than a pixel");
    assert!(
        away[0] > drawn / 3 && away[1] > drawn / 3,
        "{away:?} behind the eye's plane and before it"
    );
}

#[test]
fn what_a_fast_eye_has_nearly_met_is_not_drawn() {
    let Some(gpu) = device() else { return };
    let pipelines = RainfallGpu::new(&gpu.device);
    let spectrum = Spectrum::new(Distribution::MarshallPalmer, 100.0).expect("a spectrum");
    let view = FieldView {
        eye_velocity_m_s: DVec3::new(0.0, 0.0, -36.0),
        ..FieldView::default()
    };
    let path = view.eye_velocity_m_s.as_vec3() * -view.exposure_s;
    let (mut met, mut drawn, mut widest) = (0, 0, 0.0_f32);
    for seed in 0..4 {
        let container = view.container(seed, &spectrum);
        let streaks = view.streaks(&gpu, &pipelines, seed, &container);
        for (record, streak) in container.records.iter().zip(&streaks) {
            let p = record.position(seed, &container.classes);
            let nearest = p.distance(path * (p.dot(path) / path.length_squared()).clamp(0.0, 1.0));
            if nearest < 0.099 {
                met += 1;
                assert_eq!(streak.shape[2], 0.0, "the eye passes a drop at {p}");
            } else if streak.shape[2] != 0.0 {
                drawn += 1;
                widest = widest.max(2.0 * streak.shape[2].abs());
            }
        }
    }
    assert!(met > 20 && drawn > 10_000, "{met} met, {drawn} drawn");
    // The largest drops are 8 mm wide; half of a streak may be as near as the near plane.
    assert!(widest < view.focal_px() * 8e-3 / 0.06, "{widest} px");
}

#[test]
fn streaks_show_lamps_as_the_cpu_has_them() {
    let Some(gpu) = device() else { return };
    let pipelines = RainfallGpu::new(&gpu.device);
    let spectrum = Spectrum::new(Distribution::MarshallPalmer, 25.0).expect("a spectrum");
    let street_lamp = Lamp {
        range_m: 12.0,
        ..Lamp::point(Vec3::new(2.0, 3.0, -6.0), Vec3::new(30.0, 20.0, 10.0), 0.2)
    };
    let headlight = Lamp {
        direction: Vec3::NEG_Z,
        cos_inner: 0.97,
        cos_outer: 0.9,
        ..Lamp::point(Vec3::new(0.7, -0.6, 1.0), Vec3::splat(900.0), 0.2)
    };
    let view = FieldView {
        // As many as count, most of them out.
        lamps: [
            vec![Lamp::point(Vec3::Y, Vec3::ZERO, 0.1); MAX_LAMPS - 2],
            vec![street_lamp, headlight],
        ]
        .concat(),
        ..FieldView::default()
    };
    let container = view.container(3, &spectrum);
    let streaks = view.streaks(&gpu, &pipelines, 3, &container);
    let (mut lit, mut in_beam) = (0, 0);
    for (record, streak) in container.records.iter().zip(&streaks).filter(|(_, s)| s.shape[2] > 0.0) {
        let head = record.position(3, &container.classes);
        let class = (record.drop & 15) as usize;
        let middle = head - container.classes[class].velocity_m_s * (0.5 * view.exposure_s);
        let lamps: Vec3 = view.lamps.iter().map(|lamp| lamp.radiance(middle)).sum();
        // Under an even light of 1 a drop shows 0.884 + 0.066 of it.
        for (found, lamp) in streak.light.iter().zip(lamps.to_array()) {
            // The shader's 1e-3; places agree within 1e-5 m, which is 1e-4 of the light 0.2 m from a lamp, and ten times
            // that on the flank of the beam, 0.07 wide in its cosine; 0.95 has single precision's 1e-7.
            assert!(
                (found - 0.95 - lamp).abs() <= 2e-3 * lamp + 1e-6,
                "{found} {lamp} at {middle}"
            );
        }
        lit += u32::from(lamps.x > 0.01);
        in_beam += u32::from(headlight.radiance(middle).x > 0.0);
    }
    assert!(lit > 1000 && in_beam > 500, "{lit} {in_beam}");
}

#[test]
fn every_drop_beyond_its_range_is_hidden_and_every_one_inside_is_drawn() {
    let Some(gpu) = device() else { return };
    let pipelines = RainfallGpu::new(&gpu.device);
    let spectrum = Spectrum::new(Distribution::MarshallPalmer, 25.0).expect("a spectrum");
    let view = FieldView::default();
    let container = view.container(3, &spectrum);
    // The same records, drawn for half the quality: those between the two ranges must vanish.
    let strict = FieldView {
        kappa: 0.5,
        ..FieldView::default()
    };
    let streaks = strict.streaks(&gpu, &pipelines, 3, &container);
    let kept = strict.container(3, &spectrum).records.len();
    let drawn = streaks.iter().filter(|s| s.shape[2] > 0.0).count();
    assert!(
        container.records.len() > 3 * kept,
        "{} and {kept}",
        container.records.len()
    );
    // The container keeps what streaks reach in from beyond the sides and draws none closer than 0.1 m.
    assert!(
        drawn <= kept && drawn * 100 > kept * 97,
        "{drawn} drawn, {kept} within the range"
    );
}

#[test]
fn diameters_speeds_and_visible_ranges_agree_on_gpu_and_cpu() {
    let Some(gpu) = device() else { return };
    let (focal, exposure) = (623.5_f32, 1.0_f32 / 60.0);
    let mut input: Vec<[f32; 4]> = Vec::new();
    for class in SizeClass::all() {
        for i in 0..200_u32 {
            input.push([class.exp_min as f32, class.exp_span as f32, i as f32 / 200.0, 0.0]);
        }
    }
    let body = format!(
        "let d = rain_diameter_mm(input[i].x, input[i].y, input[i].z);
    output[i] = vec4<f32>(d, rain_terminal_velocity(d), rain_visible_range(d, {focal:?}, {exposure:?}), 0.0);"
    );
    let found = gpu.compute::<_, [f32; 4]>(&kernel(&library(), "vec4<f32>", "vec4<f32>", &body), &input, &[]);
    let mut worst = [0.0_f64; 3];
    for (i, f) in found.iter().enumerate() {
        let class = SizeClass::new(i / 200);
        let d = f64::from(class.diameter_mm(input[i][2]));
        assert!(d >= class.min_mm * 0.999_99 && d <= class.max_mm * 1.000_01);
        let expected = [
            d,
            terminal_velocity(d),
            visible_range_m(d, f64::from(focal), f64::from(exposure)),
        ];
        for k in 0..3 {
            worst[k] = worst[k].max((f64::from(f[k]) / expected[k] - 1.0).abs());
        }
    }
    // Vulkan lets `log` err by 3 units in the last place; e^(−2D) magnifies by at most 1/(2D), D ≥ 0.5 mm. The top
    // class subtracts two nearly equal numbers.
    assert!(worst[0] < 1e-4 && worst[1] < 1e-4 && worst[2] < 3e-4, "{worst:?}");
}
