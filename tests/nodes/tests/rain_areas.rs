//! Rain areas in the shader against the CPU's single and double precision, alone and in the water map.

use glam::{DVec2, DVec3};
use rain_core::rainfall::areas::{
    AreaField, AreaFieldF32, AreaRain, AreaSettings, AreaShape, DensityMap, border_weight_f32, ellipse_distance,
    polygon_distance,
};
use rain_core::weather::{ColumnF32, ColumnRules, SurfaceClass};
use rain_render::cover::open_sky;
use rain_render::water_map::{
    GroundCell, GroundPlace, WaterMap, WaterMapFrame, WaterMapGpu, WaterMapInput, WaterMapPasses, WaterMapSettings,
};

use crate::device::{device, kernel, library};

fn places(count: u32, half: f32) -> impl Iterator<Item = [f32; 2]> {
    (0..count).map(move |i| {
        let at = f64::from(i) + 0.5;
        [0.754_877_666_246_693, 0.569_840_290_998_053].map(|k| ((at * k).fract() * 2.0 - 1.0) as f32 * half)
    })
}

#[test]
fn distances_and_weights_are_the_cpus() {
    let Some(gpu) = device() else { return };
    let radii = [[100.0, 30.0], [30.0, 100.0], [50.0, 50.0], [400.0, 5.0], [0.5, 0.2]];
    let input: Vec<[f32; 4]> = radii
        .iter()
        .flat_map(|r: &[f32; 2]| places(2000, 300.0).map(|p| [p[0], p[1], r[0], r[1]]))
        .collect();
    let square = "let a = vec2<f32>(-20.0, -30.0); let b = vec2<f32>(50.0, -10.0); let c = vec2<f32>(10.0, 5.0); \
                  let d = vec2<f32>(30.0, 60.0); var e = rain_polygon_edge(vec2<f32>(1e30, 1.0), v.xy, d, a); \
                  e = rain_polygon_edge(e, v.xy, a, b); e = rain_polygon_edge(e, v.xy, b, c); \
                  e = rain_polygon_edge(e, v.xy, c, d);";
    let body = format!(
        "let v = input[i]; {square} output[i] = vec4<f32>(rain_ellipse_distance(v.xy, v.zw), e.y * sqrt(e.x), \
         rain_area_weight(v.x, v.z), rain_area_weight(v.x, 0.0));"
    );
    let found: Vec<[f32; 4]> = gpu.compute(&kernel(&library(), "vec4<f32>", "vec4<f32>", &body), &input, &[]);
    let corners = [[-20.0, -30.0], [50.0, -10.0], [10.0, 5.0], [30.0, 60.0]].map(DVec2::from);
    let mut worst = [0.0_f64; 3];
    for (i, f) in input.iter().zip(&found) {
        let p = DVec2::new(f64::from(i[0]), f64::from(i[1]));
        let radii = DVec2::new(f64::from(i[2]), f64::from(i[3]));
        let scale = radii.max_element() + p.length();
        worst[0] = worst[0].max((f64::from(f[0]) - ellipse_distance(p, radii)).abs() / scale);
        let exact = polygon_distance(p, &corners);
        // A point on the border to rounding may be on either side.
        let off = if exact.abs() < 1e-3 {
            f64::from(f[1].abs()) - exact.abs()
        } else {
            f64::from(f[1]) - exact
        };
        worst[1] = worst[1].max(off.abs() / (70.0 + p.length()));
        worst[2] = worst[2].max(f64::from((f[2] - border_weight_f32(i[0], i[2])).abs()));
        assert_eq!(f[3], border_weight_f32(i[0], 0.0), "{i:?}");
    }
    assert!(worst[0] < 4e-6 && worst[1] < 4e-6 && worst[2] < 1e-6, "{worst:?}");
    assert!(
        found.iter().any(|f| f[0] < 0.0) && found.iter().any(|f| f[1] < 0.0),
        "or nothing was inside"
    );
}

fn area(centre_m: DVec2, shape: AreaShape, rain: AreaRain, transition_m: f64) -> AreaSettings {
    let area = AreaSettings {
        centre_m,
        shape,
        rain,
        transition_m,
        ..AreaSettings::default()
    };
    area.check().expect("valid");
    area
}

/// 9 × 7 cells, bright and dark.
pub fn painting(size_m: DVec2) -> DensityMap {
    let values = (0..63_u32).map(|i| ((i * 97 + i * i * 31) % 256) as u8).collect();
    DensityMap::new(size_m, [9, 7], values).expect("a painting")
}

#[test]
fn the_water_map_gets_each_texels_own_rain() {
    let Some(gpu) = device() else { return };
    let settings = WaterMapSettings {
        texels: 64,
        cell_m: 0.25,
        levels: 2,
        interval_s: 0.0,
        seen_share: 0.0,
    };
    let at = DVec2::new(1000.0, -2000.0);
    let mut field = AreaField::new(0.5);
    let star: Vec<DVec2> = [[-6.0, -4.0], [5.0, -5.0], [1.0, 0.0], [6.0, 6.0], [-5.0, 3.0]]
        .map(DVec2::from)
        .to_vec();
    for area in [
        area(
            at + DVec2::new(-3.0, 1.0),
            AreaShape::Polygon { corners_m: star },
            AreaRain::Rate(60.0),
            1.0,
        ),
        AreaSettings {
            density: Some(painting(DVec2::new(12.0, 8.0))),
            ..area(
                at + DVec2::new(8.0, -6.0),
                AreaShape::Ellipse {
                    radii_m: DVec2::new(9.0, 3.0),
                    heading_rad: 0.6,
                },
                AreaRain::OfWeather(4.0),
                2.0,
            )
        },
        area(at, AreaShape::Circle { radius_m: 2.0 }, AreaRain::Scale(0.0), 1.5),
        area(
            at + 500.0,
            AreaShape::Circle { radius_m: 50.0 },
            AreaRain::Rate(400.0),
            5.0,
        ),
    ] {
        field.push(&area, DVec2::ZERO, 0.0);
    }
    let (weather, heaviest) = (10.0, field.rates_within(at, 40.0, 10.0)[1]);
    assert_eq!(heaviest, 60.0);
    let passes = WaterMapPasses::new(&gpu.device);
    let texture = gpu.device.create_texture(&settings.map_texture());
    let mut water = WaterMapGpu::new(&gpu.device, &passes, &settings, &texture);
    let mut map = WaterMap::new(&settings).unwrap();
    let rules = ColumnRules::from(&SurfaceClass::Asphalt.properties());
    let place = GroundPlace {
        build: 1,
        corner_m: [at.x - 40.0, at.y - 40.0],
        cell_m: 0.25,
        cells: [320; 2],
        base_m: 0.0,
        rules: SurfaceClass::ALL.map(|class| ColumnRules::from(&class.properties())),
    };
    let cell = GroundCell {
        height_m: 0.0,
        class: SurfaceClass::Asphalt.index() as u8,
        exposure: 255,
    };
    map.set_ground(&place, std::iter::repeat_n(cell, 320 * 320)).unwrap();
    map.follow([at.x, at.y], &[]);
    let (mut frame, mut packed) = (WaterMapFrame::default(), AreaFieldF32::default());
    let open = WaterMapInput {
        cover: open_sky(),
        cover_map: None,
        levels: None,
    };
    // The first step fills the texels, the second rains for 12 s.
    for time in [0.0, 12.0] {
        map.advance(heaviest * time / 3600.0, 0.0, time, false).unwrap();
        map.take(&mut frame, |_, _| ColumnF32::default());
        let origin: DVec3 = frame.origin_m();
        assert!(field.pack(DVec2::new(origin.x, origin.z), 40.0, &mut packed));
        assert_eq!(packed.areas, 3, "what is far is left out");
        frame.set_areas(&packed, weather, heaviest);
        water.prepare(&gpu.device, &gpu.queue, &passes, &frame, &open);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        water.encode(&mut pass, &passes);
        drop(pass);
        gpu.queue.submit([encoder.finish()]);
    }
    let texels: Vec<[f32; 3]> = bytemuck::pod_collect_to_vec(&gpu.read(water.water(), water.water().size()));
    let (mut worst, mut dry, mut soft) = (0.0_f64, 0, 0);
    for i in 0..64 {
        for j in 0..64 {
            let p = at + DVec2::new(f64::from(i) - 31.5, f64::from(j) - 31.5) * 0.25;
            let texel = texels[map.texel_at(0, [p.x, p.y]).expect("on the map")];
            let rate = field.rate_at(p, weather);
            dry += u32::from(rate == 0.0);
            soft += u32::from(rate > 6.0 && rate < 55.0);
            let right = ColumnF32::default().advanced(&rules, rate as f32, 0.0, 12.0);
            let found = texel[0] + texel[1];
            worst = worst.max(f64::from((found - right.pores_mm - right.film_mm).abs()));
        }
    }
    // 0.2 mm have fallen at most.
    assert!(worst < 1e-5, "{worst}");
    assert!(dry > 20 && soft > 100, "{dry} {soft}");
}
