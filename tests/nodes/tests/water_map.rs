//! The water map against the column in double precision and against the ground of the simulation.

use glam::{DVec2, DVec3};
use rain_core::hash::{pcg3d, unit_f32};
use rain_core::surface::closed_film_share;
use rain_core::surface::ground::{Ground, GroundDomain, GroundScene, GroundSettings};
use rain_core::weather::{ColumnF32, ColumnForcing, ColumnRules, SurfaceClass, SurfaceColumn};
use rain_render::cover::{CoverPlacement, open_sky};
use rain_render::water_map::{
    GroundCell, GroundPlace, WaterMap, WaterMapFrame, WaterMapGpu, WaterMapInput, WaterMapPasses, WaterMapRest,
    WaterMapSettings, WaterPress,
};

use crate::device::{Device, device, kernel, library};

/// Small and coarse: 16 m and 32 m of texels as large as the ground's cells and twice that.
fn small() -> WaterMapSettings {
    WaterMapSettings {
        texels: 64,
        cell_m: 0.25,
        levels: 2,
        interval_s: 0.0,
        seen_share: 0.0,
    }
}

fn place(cells: u32) -> GroundPlace {
    GroundPlace {
        build: 1,
        corner_m: [-0.125 * f64::from(cells); 2],
        cell_m: 0.25,
        cells: [cells; 2],
        base_m: 10.0,
        rules: SurfaceClass::ALL.map(|class| ColumnRules::from(&class.properties())),
    }
}

/// Level ground in stripes of classes, every cell with its own exposure.
fn striped(cells: u32) -> Vec<GroundCell> {
    (0..cells * cells)
        .map(|i| GroundCell {
            height_m: 0.5,
            class: ((i % cells / 3) % SurfaceClass::COUNT as u32) as u8,
            exposure: (pcg3d([i, 5, 5])[0] & 255) as u8,
        })
        .collect()
}

struct Rig {
    passes: WaterMapPasses,
    gpu: WaterMapGpu,
    frame: WaterMapFrame,
    map: WaterMap,
    texture: wgpu::Texture,
}

impl Rig {
    fn new(gpu: &Device, settings: &WaterMapSettings) -> Self {
        let passes = WaterMapPasses::new(&gpu.device);
        let texture = gpu.device.create_texture(&settings.map_texture());
        Self {
            gpu: WaterMapGpu::new(&gpu.device, &passes, settings, &texture),
            passes,
            frame: WaterMapFrame::default(),
            map: WaterMap::new(settings).unwrap(),
            texture,
        }
    }

    /// Does a frame if there is one.
    fn frame(&mut self, gpu: &Device, water: impl Fn(u32, u32) -> ColumnF32) -> bool {
        let open = WaterMapInput {
            cover: open_sky(),
            cover_map: None,
            levels: None,
        };
        self.frame_under(gpu, &open, water)
    }

    fn frame_under(&mut self, gpu: &Device, input: &WaterMapInput, water: impl Fn(u32, u32) -> ColumnF32) -> bool {
        if self.map.rest(false).is_some() {
            return false;
        }
        self.map.take(&mut self.frame, water);
        self.gpu
            .prepare(&gpu.device, &gpu.queue, &self.passes, &self.frame, input);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        self.gpu.encode(&mut pass, &self.passes);
        drop(pass);
        gpu.queue.submit([encoder.finish()]);
        true
    }

    /// Pores, film and soil clock of every texel.
    fn water(&self, gpu: &Device) -> Vec<[f32; 3]> {
        bytemuck::pod_collect_to_vec(&gpu.read(self.gpu.water(), self.gpu.water().size()))
    }

    fn at(&self, water: &[[f32; 3]], level: usize, x: f64, z: f64) -> [f32; 3] {
        water[self.map.texel_at(level, [x, z]).expect("a texel of the level")]
    }
}

fn dry(_: u32, _: u32) -> ColumnF32 {
    ColumnF32::default()
}

/// Relative distance, or of 0.1 mm.
fn apart(found: f32, right: f64) -> f64 {
    (f64::from(found) - right).abs() / right.abs().max(0.1)
}

#[test]
fn the_shader_takes_the_step_of_the_column() {
    let Some(gpu) = device() else { return };
    let random = |a: u32, b: u32| pcg3d([a, b, 12]).map(unit_f32);
    let class = |i: u32| SurfaceClass::ALL[i as usize % SurfaceClass::COUNT];
    let input: Vec<[f32; 8]> = (0..20_000)
        .map(|i| {
            let rules = ColumnRules::from(&class(i).properties());
            let ([a, b, c], [d, e, f]) = (random(i, 1), random(i, 2));
            let film = if a > 0.66 { (14.0 * b - 10.0).exp() } else { 0.0 };
            let rain = if d < 0.3 { 0.0 } else { (9.0 * d - 3.5).exp() };
            [
                rules.capacity_mm * (1.5 * a).min(1.0),
                film,
                4000.0 * c,
                rain,
                1.2 * (e - 0.3).max(0.0),
                (11.0 * f - 3.0).exp(),
                0.0,
                0.0,
            ]
        })
        .collect();
    let rules: Vec<rain_render::gpu_types::ColumnRules> = SurfaceClass::ALL
        .iter()
        .map(|class| rain_render::gpu_types::ColumnRules::from(&ColumnRules::from(&class.properties())))
        .collect();
    let buffer = gpu.buffer(bytemuck::cast_slice(&rules), wgpu::BufferUsages::STORAGE);
    let library = format!(
        "{}\nstruct Case {{ water: vec4<f32>, more: vec4<f32> }}
        @group(0) @binding(2) var<storage, read> rules: array<ColumnRules>;\n",
        library()
    );
    let body = "let c = input[i];
        let done = rain_column(c.water.xyz, rules[i % 7u], c.water.w / 3600.0, c.more.x / 3600.0, c.more.y);
        output[i] = vec4<f32>(done, 0.0);";
    let found: Vec<[f32; 4]> = gpu.compute(
        &kernel(&library, "Case", "vec4<f32>", body),
        &input,
        &[buffer.as_entire_binding()],
    );
    let mut worst = 0.0_f64;
    for (i, ([pores_mm, film_mm, soil_s, rain, evaporation, dt, ..], found)) in (0..).zip(input.iter().zip(found)) {
        let start = ColumnF32 {
            pores_mm: *pores_mm,
            film_mm: *film_mm,
            soil_s: *soil_s,
        };
        let right = start.advanced(&ColumnRules::from(&class(i).properties()), *rain, *evaporation, *dt);
        worst = worst
            .max(apart(found[0], f64::from(right.pores_mm)))
            .max(apart(found[1], f64::from(right.film_mm)))
            .max((f64::from(found[2]) - f64::from(right.soil_s)).abs() / f64::from(right.soil_s).max(10.0));
    }
    eprintln!("shader against single precision: {worst:.1e}");
    assert!(worst < 1e-3, "{worst:.1e}");
}

#[test]
fn the_map_follows_the_column_in_double_precision_through_a_day_of_weather() {
    let Some(gpu) = device() else { return };
    let mut rig = Rig::new(&gpu, &small());
    let (ground, cells) = (place(128), striped(128));
    rig.map.set_ground(&ground, cells.iter().copied()).unwrap();
    rig.map.follow([0.0, 0.0], &[]);
    rig.map.advance(1e-9, 0.0, 0.25, false).unwrap();
    assert!(rig.frame(&gpu, dry), "the map is filled");
    let mut columns = vec![SurfaceColumn::default(); cells.len()];
    let mut worst = 0.0_f64;
    for step in 0..300_u32 {
        let [a, b, c] = pcg3d([step / 20, 3, 9]).map(unit_f32);
        let rain = if a < 0.4 { 0.0 } else { (6.0 * b - 1.5).exp() };
        let forcing = |share: f64| ColumnForcing {
            rain_mm_h: f64::from(rain) * share,
            evaporation_mm_h: 0.5 * f64::from(c),
        };
        let dt = f64::from(0.25 + 20.0 * pcg3d([step, 4, 9]).map(unit_f32)[0].powi(2));
        let open = forcing(1.0);
        let evaporation_mm = open.evaporation_mm_h * dt / 3600.0;
        rig.map
            .advance(open.rain_mm_h * dt / 3600.0, evaporation_mm, dt, false)
            .unwrap();
        assert!(rig.frame(&gpu, dry));
        // 32 of the classes' and exposures' cells, at both levels' middle.
        for i in 0..32 {
            let index = (64 + i % 3) * 128 + 44 + i;
            let cell = cells[index];
            let properties = SurfaceClass::ALL[usize::from(cell.class)].properties();
            columns[index]
                .advance(&properties, forcing(f64::from(cell.exposure) / 255.0), dt)
                .unwrap();
        }
        if step % 30 == 29 {
            let water = rig.water(&gpu);
            for i in 0..32 {
                let index = (64 + i % 3) * 128 + 44 + i;
                let at = |n: usize| ground.corner_m[0] + (n as f64 + 0.5) * 0.25;
                let [pores, film, _] = rig.at(&water, 0, at(index % 128), at(index / 128));
                worst = worst
                    .max(apart(pores, columns[index].pores_mm()))
                    .max(apart(film, columns[index].water_level_mm()));
            }
        }
    }
    let wet = columns.iter().map(SurfaceColumn::water_level_mm).fold(0.0, f64::max);
    eprintln!("map against double precision: {worst:.1e}, fullest film {wet:.2} mm");
    assert!(worst < 1e-3 && wet > 0.5, "{worst:.1e} {wet}");
}

#[test]
fn what_is_scrolled_over_is_kept_bit_for_bit_and_new_texels_start_from_the_ground() {
    let Some(gpu) = device() else { return };
    let mut rig = Rig::new(&gpu, &small());
    let cells = striped(128);
    rig.map.set_ground(&place(128), cells.iter().copied()).unwrap();
    let seed = |x: u32, z: u32| ColumnF32 {
        pores_mm: 1e-3 * x as f32,
        film_mm: 0.25 + 1e-3 * z as f32,
        soil_s: (x + z) as f32,
    };
    // No rain, no evaporation: only the move is seen.
    rig.map.follow([0.0, 0.0], &[]);
    assert!(rig.frame(&gpu, seed));
    let seeds = rig.frame.seeds();
    assert_eq!(seeds, 128 * 128, "all cells under the coarse level");
    rig.map
        .press(&WaterPress {
            from_m: [-3.0, 0.1],
            to_m: [3.0, 0.4],
            half_width_m: 0.3,
            share: 0.8,
            thrown: 1.0,
        })
        .unwrap();
    assert!(rig.frame(&gpu, seed) && rig.frame.stamps() == 2 && !rig.frame.advances());
    let before = rig.water(&gpu);
    assert!(rig.at(&before, 0, 0.0, 0.3)[1] < 0.15, "pressed");
    let places: Vec<[f64; 2]> = (0..4096)
        .map(|i| [f64::from(i % 64), f64::from(i / 64)].map(|n| 0.25 * n - 7.9))
        .collect();
    let first: Vec<_> = places.iter().map(|p| rig.at(&before, 0, p[0], p[1])).collect();
    for eye in [[2.6, 0.0], [2.6, -3.1], [7.0, 4.0]] {
        let old = rig.map.clone();
        rig.map.follow(eye, &[]);
        assert!(rig.frame(&gpu, seed));
        assert!(rig.frame.seeds() < seeds, "only what is new is asked for");
        let after = rig.water(&gpu);
        let (mut kept, mut new) = (0, 0);
        for (place, first) in places.iter().zip(&first) {
            let Some(texel) = rig.map.texel_at(0, *place) else {
                continue;
            };
            if old.texel_at(0, *place).is_some() {
                assert_eq!(after[texel], *first, "{place:?}");
                kept += 1;
            }
        }
        for i in 0..4096 {
            let place = [f64::from(i % 64), f64::from(i / 64)].map(|n| 0.25 * n - 7.9);
            let place = [place[0] + eye[0], place[1] + eye[1]];
            if let (Some(texel), None) = (rig.map.texel_at(0, place), old.texel_at(0, place)) {
                let cell = place.map(|at| ((at + 16.0) / 0.25).floor() as u32);
                let right = seed(cell[0], cell[1]);
                assert_eq!(after[texel], [right.pores_mm, right.film_mm, right.soil_s], "{place:?}");
                new += 1;
            }
        }
        assert!(kept > 500 && new > 100, "{kept} kept, {new} new");
    }
    // A texture of the new levels is where the material looks for it.
    let places = rig.map.place().seen_from([7.0, 4.0]);
    assert!(
        places.fine[3] > 4.0 && places.middle[3] > 10.0 && places.coarse == [0.0; 4],
        "{places:?}"
    );
    // It lies at one place for every eye.
    let far = rig.map.place().seen_from([50.0, 0.0]);
    assert_eq!(
        (places.fine_centre, far.fine_centre, far.fine[3]),
        ([0.0; 2], [-43.0, 4.0], places.fine[3])
    );
    assert_eq!(rig.texture.depth_or_array_layers(), 2);
}

#[test]
fn levels_lie_amid_views_that_fit_and_around_the_leading_one_otherwise() {
    let settings = small();
    let [fine, coarse] = [0, 1].map(|level| settings.spread_m(level));
    assert!(fine > 3.0 && coarse > 1.9 * fine, "{fine} and {coarse} m");
    let cells = striped(256);
    let leading = [-1.3, 0.4];
    // How far the second view is, and which levels lie amid both.
    for (apart, amid) in [
        (0.0, [true, true]),
        (0.9 * fine, [true, true]),
        (1.1 * fine, [false, true]),
        (0.9 * coarse, [false, true]),
        (1.1 * coarse, [false, false]),
        (1e4, [false, false]),
        (f64::NAN, [false, false]),
    ] {
        let mut map = WaterMap::new(&settings).unwrap();
        map.set_ground(&place(256), cells.iter().copied()).unwrap();
        let second = [leading[0] - apart, leading[1] + 0.5 * apart];
        map.follow(leading, &[second, leading]);
        assert_eq!(map.rest(false), None);
        map.take(&mut WaterMapFrame::default(), dry);
        let places = map.place().seen_from(leading);
        let middle = [-0.5 * apart, 0.25 * apart].map(|at| at as f32);
        for (found, amid) in [places.fine_centre, places.middle_centre].into_iter().zip(amid) {
            let right = if amid { middle } else { [0.0; 2] };
            let off = [0, 1].map(|axis| (found[axis] - right[axis]).abs());
            assert!(off[0].max(off[1]) < 1e-5, "{apart} m apart: {found:?}, not {right:?}");
        }
        // A view that fits stands on the level, and no border is nearer to it than half of what one view alone has.
        for (level, far) in [(0, places.fine[3]), (1, places.middle[3])] {
            assert!(f64::from(far) > 0.6 * settings.holds_m(level), "{places:?}");
            if amid[level] {
                assert!(map.texel_at(level, second).is_some() && map.texel_at(level, leading).is_some());
                assert!(
                    f64::from(far) * 0.75 - 0.5 * apart > 0.25 * settings.holds_m(level),
                    "{apart}: {places:?}"
                );
            }
        }
    }
}

/// A level ground of asphalt over a square.
fn asphalt(half_m: f64) -> Ground {
    let corner = |x: f64, z: f64| DVec3::new(x * half_m, 0.0, z * half_m);
    let mut scene = GroundScene::default();
    let triangles = [
        [corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0)],
        [corner(-1.0, -1.0), corner(1.0, 1.0), corner(1.0, -1.0)],
    ];
    scene.set(1, &triangles, SurfaceClass::Asphalt, true);
    let settings = GroundSettings {
        domain: Some(GroundDomain {
            low_m: [-half_m; 2],
            high_m: [half_m; 2],
        }),
        interval_steps: 1,
        basin_steps: 1,
        ..GroundSettings::default()
    };
    Ground::build(&scene, &settings).unwrap()
}

#[test]
fn presses_take_and_lay_what_they_do_on_the_simulations_ground() {
    let Some(gpu) = device() else { return };
    let mut ground = asphalt(8.0);
    let forcing = ColumnForcing {
        rain_mm_h: 20.0,
        evaporation_mm_h: 0.0,
    };
    for _ in 0..300 {
        ground.advance(&forcing, 1.0, 1).unwrap();
    }
    let mut rig = Rig::new(&gpu, &WaterMapSettings { levels: 1, ..small() });
    let cells: Vec<GroundCell> = (0..64 * 64)
        .map(|i| GroundCell {
            height_m: ground.ground_heights()[i],
            class: ground.classes()[i],
            exposure: 255,
        })
        .collect();
    rig.map.set_ground(&place(64), cells.iter().copied()).unwrap();
    rig.map.follow([0.0, 0.0], &[]);
    rig.frame(&gpu, |x, z| ground.cell_water((z * 64 + x) as usize));
    for (from, to, half, share, thrown) in [
        ([-3.0, 1.0], [3.0, 1.0], 0.25, 0.7, 0.0),
        ([-2.0, -3.0], [1.5, 2.0], 0.4, 0.9, 0.25),
        ([4.0, 4.0], [4.0, 4.0], 0.3, 0.5, 0.0),
        ([6.9, -5.0], [9.5, -5.0], 0.2, 1.0, 0.5),
    ] {
        ground
            .press(DVec2::from(from), DVec2::from(to), half, share, thrown)
            .unwrap();
        rig.map
            .press(&WaterPress {
                from_m: from,
                to_m: to,
                half_width_m: half,
                share,
                thrown,
            })
            .unwrap();
    }
    assert!(rig.frame(&gpu, dry) && rig.frame.stamps() == 4);
    let compare = |rig: &Rig, ground: &Ground| {
        let water = rig.water(&gpu);
        (0..64 * 64).fold((0.0_f64, f64::INFINITY, 0.0_f64), |(worst, least, most), i| {
            let at = |n: usize| -8.0 + (n as f64 + 0.5) * 0.25;
            let right = f64::from(ground.cell_water(i).film_mm);
            let film = rig.at(&water, 0, at(i % 64), at(i / 64))[1];
            (worst.max(apart(film, right)), least.min(right), most.max(right))
        })
    };
    let (worst, least, most) = compare(&rig, &ground);
    eprintln!("presses: {worst:.1e} apart, films {least:.3} to {most:.3} mm");
    assert!(worst < 1e-3 && least < 0.3 * most, "{worst:.1e}, {least} to {most}");
    // Under more rain the tracks fill again, on both alike.
    for _ in 0..900 {
        ground.advance(&forcing, 1.0, 1).unwrap();
    }
    rig.map.advance(20.0 * 900.0 / 3600.0, 0.0, 900.0, false).unwrap();
    assert!(rig.frame(&gpu, dry));
    let (worst, filled, most) = compare(&rig, &ground);
    assert!(worst < 1e-3 && filled > 0.8 * most, "{worst:.1e}, {filled} to {most}");
}

#[test]
fn a_roof_keeps_its_ground_dry_and_leaves_a_dry_patch_until_it_rains_on_it() {
    let Some(gpu) = device() else { return };
    let mut rig = Rig::new(&gpu, &small());
    let cells = vec![
        GroundCell {
            height_m: 0.0,
            class: 0,
            exposure: 255,
        };
        128 * 128
    ];
    rig.map.set_ground(&place(128), cells.iter().copied()).unwrap();
    rig.map.follow([0.0, 0.0], &[]);
    // A roof of 4 m at 3 m height, or none.
    let roof = |present: bool| {
        let texels = 256;
        let metres = |i: u32| (f64::from(i) + 0.5) / 256.0 * 40.0 - 20.0;
        let placement = CoverPlacement {
            centre_m: DVec2::ZERO,
            plane_m: 10.0,
            extent_m: 40.0,
            top_m: 20.0,
            range_m: 20.0,
            highest_m: 13.0,
            wind_m_s: DVec2::ZERO,
            inverse_speed_s_m: 0.17,
            texels,
        };
        let depths: Vec<f32> = (0..texels * texels)
            .map(|i| {
                let under = metres(i % texels).abs() < 2.0 && metres(i / texels).abs() < 2.0 && present;
                if under { 0.65 } else { 0.5 }
            })
            .collect();
        (placement, crate::cover_parity::depth_texture(&gpu, texels, &depths))
    };
    let mut rain = |minutes: f64, present: bool| {
        let (placement, view) = roof(present);
        rig.map
            .advance(10.0 * minutes / 60.0, 0.0, 60.0 * minutes, false)
            .unwrap();
        let input = WaterMapInput {
            cover: placement.params(DVec3::new(0.0, 10.0, 0.0)),
            cover_map: Some(&view),
            levels: None,
        };
        assert!(rig.frame_under(&gpu, &input, dry));
        let water = rig.water(&gpu);
        [0.0, 5.0].map(|x| rig.at(&water, 0, x, 0.1)[1])
    };
    rain(1.0, true);
    let [under, beside] = rain(10.0, true);
    assert!(under == 0.0 && beside > 0.5, "{under} {beside}");
    // The roof is gone; a second later the patch is still dry, after a while it is not.
    let [patch, beside] = rain(1.0 / 60.0, false);
    assert!(patch == 0.0 && beside > 0.5, "{patch} {beside}");
    let [patch, _] = rain(6.0, false);
    assert!(patch > 0.3, "{patch}");
}

#[test]
fn nothing_is_done_while_dry_settled_or_unchanged() {
    let Some(gpu) = device() else { return };
    let settings = WaterMapSettings {
        seen_share: 0.002,
        interval_s: 0.25,
        ..small()
    };
    let mut rig = Rig::new(&gpu, &settings);
    assert_eq!(rig.map.rest(true), Some(WaterMapRest::NoGround));
    let cells = vec![
        GroundCell {
            height_m: 0.0,
            class: 0,
            exposure: 255,
        };
        128 * 128
    ];
    rig.map.set_ground(&place(128), cells.iter().copied()).unwrap();
    rig.map.follow([0.0, 0.0], &[]);
    rig.map.advance(0.0, 0.1, 1.0, false).unwrap();
    assert_eq!(rig.map.rest(true), Some(WaterMapRest::Dry));
    assert!(!rig.map.is_shown());
    // 10 mm/h on asphalt with 0.5 mm of pores: 1/500 of them every 0.36 s.
    let mut steps = 0;
    for _ in 0..600 {
        rig.map.advance(10.0 / 60.0 / 3600.0, 0.0, 1.0 / 60.0, false).unwrap();
        steps += u32::from(rig.frame(&gpu, dry));
    }
    assert!((26..=29).contains(&steps), "{steps} steps in 10 s");
    // No rain, no evaporation: what is wet stays, and nothing is done.
    assert!(!rig.frame(&gpu, dry));
    for _ in 0..600 {
        rig.map.advance(0.0, 0.0, 1.0 / 60.0, false).unwrap();
        assert_eq!(rig.map.rest(false), Some(WaterMapRest::Settled));
    }
    // It dries at 0.5 mm/h in steps of seven seconds, and rests once all has dried.
    let mut steps = 0;
    for _ in 0..600 {
        rig.map.advance(0.0, 0.5 / 3600.0, 1.0, false).unwrap();
        if rig.map.rest(true) != Some(WaterMapRest::Dry) {
            steps += u32::from(rig.frame(&gpu, dry));
        }
    }
    assert!((20..60).contains(&steps), "{steps} steps");
    assert_eq!(rig.map.rest(true), Some(WaterMapRest::Dry));
    assert!(!rig.map.is_shown(), "nothing is remembered any more");
}

#[test]
fn a_film_that_runs_off_is_followed_until_only_the_texture_holds_water() {
    let Some(gpu) = device() else { return };
    let settings = WaterMapSettings {
        seen_share: 0.002,
        interval_s: 0.25,
        ..small()
    };
    let mut rig = Rig::new(&gpu, &settings);
    let cell = GroundCell {
        height_m: 0.0,
        class: 0,
        exposure: 255,
    };
    rig.map
        .set_ground(&place(128), vec![cell; 128 * 128].iter().copied())
        .unwrap();
    rig.map.follow([0.0, 0.0], &[]);
    for _ in 0..1200 {
        rig.map.advance(40.0 / 3600.0, 0.0, 1.0, false).unwrap();
        rig.frame(&gpu, dry);
    }
    let share = |rig: &Rig| {
        let film = rig.at(&rig.water(&gpu), 0, 1.0, 1.0)[1];
        closed_film_share(film.into(), 0.8)
    };
    assert!(share(&rig) > 0.99, "{}", share(&rig));
    // A minute at a time: many steps at first, few when little is left above the texture.
    let mut steps = Vec::new();
    let mut shares = Vec::new();
    for _ in 0..40 {
        let mut minute = 0;
        for _ in 0..60 {
            rig.map.advance(0.0, 0.0, 1.0, false).unwrap();
            minute += u32::from(rig.frame(&gpu, dry));
        }
        steps.push(minute);
        shares.push(share(&rig));
    }
    assert!(steps[0] > 20 && steps[39] <= 1, "{steps:?}");
    assert!(shares.windows(2).all(|pair| pair[1] <= pair[0] + 1e-3), "{shares:?}");
    // Half an hour after: 0.8 mm and (22.6)^(-1.5) = 0.009 mm above.
    let wanted = closed_film_share(0.8093, 0.8);
    assert!((shares[29] - wanted).abs() < 0.01, "{} not {wanted}", shares[29]);
}

#[test]
fn bad_numbers_are_refused_by_name_and_change_nothing() {
    type Set = fn(&mut WaterMapSettings, f64);
    let fields: [(&str, Set, f64); 5] = [
        ("texels", |s, v| s.texels = v as u32, 100.0),
        ("cell_m", |s, v| s.cell_m = v, 0.0),
        ("levels", |s, v| s.levels = v as u32, 4.0),
        ("interval_s", |s, v| s.interval_s = v, -1.0),
        ("seen_share", |s, v| s.seen_share = v, 0.2),
    ];
    for (name, set, bad) in fields {
        for bad in [bad, f64::NAN] {
            let mut settings = WaterMapSettings::default();
            set(&mut settings, bad);
            let message = WaterMap::new(&settings).expect_err("refused").to_string();
            assert!(message.starts_with(name), "{message}");
        }
    }
    let mut map = WaterMap::new(&small()).unwrap();
    let cells = striped(128);
    for bad in [f64::NAN, f64::INFINITY, -1.0, 1e12] {
        assert!(map.advance(bad, 0.0, 1.0, false).is_err());
        assert!(map.advance(0.0, bad, 1.0, false).is_err());
        assert!(map.advance(0.0, 0.0, bad, false).is_err());
        let press = WaterPress {
            from_m: [0.0; 2],
            to_m: [1.0, 0.0],
            half_width_m: bad,
            share: 0.5,
            thrown: 0.0,
        };
        assert!(map.press(&press).is_err());
        let ground = GroundPlace {
            cell_m: bad,
            ..place(128)
        };
        assert!(map.set_ground(&ground, cells.iter().copied()).is_err());
        map.follow([bad * 1e9, 0.0], &[]);
    }
    assert!(
        map.set_ground(&place(64), cells.iter().copied()).is_err(),
        "too many cells"
    );
    assert_eq!(map.rest(false), Some(WaterMapRest::NoGround));
    assert!(map.set_ground(&place(128), cells.iter().copied()).is_ok());
}
