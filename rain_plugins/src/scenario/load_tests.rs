use std::path::Path;

use rain_core::weather::{Transition, WeatherPreset};

use super::super::error::ScenarioError;
use super::super::expectation::{Check, Statistic};
use super::super::file::{Captures, Interpolation, Mask, Scenario, ScenePart, Sky};
use super::super::output::tests::Folder;
use super::super::weather::{WeatherMode, core_timeline};

const FULL: &str = r#"// A scenario that says everything once.
Scenario(
    name: "storm",
    seed: 42,
    duration_s: 600,
    scene: [
        (file: "street.glb", name: "street", puddles: Painted(margin: 0.3), depth_map: (file: "depth.png", relief: 0.02)),
        (file: "shelter.glb", translation: (4, 0, -2), yaw_deg: 90, scale: 1.5),
    ],
    environment: (
        sky: Overcast(
            zenith_luminance_cd_m2: 800,
            tint: (0.9, 0.95, 1.1),
            zenith_to_horizon: 3,
            cloud_contrast: 0.05,
            skyline_deg: 14,
            skyline_tint: (0.3, 0.3, 0.3),
            ground_tint: (0.1, 0.1, 0.1),
        ),
        exposure_ev100: 9.5,
        sun: (direction: (0.2, -1, 0), illuminance_lux: 2000),
        lamps: 2,
        fog_visibility_m: 4000,
        bloom: false,
    ),
    weather: (
        keys: [
            (time_s: 0, intensity_mm_h: 0, wind_m_s: (1, 0, 0), air_temperature_c: 12, relative_humidity: 0.9, net_radiation_w_m2: 20),
            (time_s: 120, intensity_mm_h: 40),
            (time_s: 600, intensity_mm_h: 0),
        ],
        transition: linear,
        base: (pressure_pa: 99000),
        mode: Artist,
        wetness: 0.75,
        water_level: 0.25,
        hole_level: 0.5,
        gusts: (intensity: 0.25, time_scale_s: 6),
        lightning: (flashes_per_km2_min: 0.0625, centre_m: (100, -50), nearest_m: 700),
        levels: (keys: [(time_s: 0, wetness: 0), (time_s: 8, wetness: 1, water_level: 0.125)], period_s: 20),
    ),
    areas: (
        outside: 0.5,
        list: [
            (name: "shower", centre: (3, 7), shape: Circle(radius_m: 60), rain: Rate(80), transition_m: 12, velocity_m_s: (2, 0), start_s: 30, fade_in_s: 10),
            (shape: Polygon(corners_m: [(0, 0), (4, 0), (4, 4), (0, 4)]), rain: Scale(0), path: [(time_s: 0), (time_s: 9, moved: (1, 2))]),
        ],
    ),
    water: (
        wave_strength: 0.5,
        wave_slope: 0.0625,
        wave_velocity_m_s: (0.25, -0.5),
        puddle_reflection: 0.875,
        caustics: 1.5,
        simulation: false,
    ),
    vehicles: [
        (
            name: "truck",
            file: "truck.glb",
            scale: 1.2,
            path: [(time_s: 0, position: (0, 0, -50)), (time_s: 10, position: (0, 0, 50))],
            interpolation: CatmullRom,
            wheel_prefix: "wheel-",
            wheel_radius_m: 0.4,
            headlights: true,
        ),
    ],
    camera: (
        keys: [
            (time_s: 0, eye: (3, 1.7, 9), target: (0, 1, 0), fov_y_deg: 45),
            (time_s: 300, eye: (0, 1.7, 3), target: (0, 1, -9), cut: true),
        ],
        interpolation: CatmullRom,
    ),
    rain: (enabled: true, streak_budget: 100000, contrast: 6, exposure_s: 0.008, look: LagardePorous),
    captures: Even(start_s: 60, end_s: 600, count: 4),
    outputs: (size: (640, 360), frames: true, masks: [Rain, Wet, Depth], contact_sheet: true, timeline: false),
    domain: (min: (-20, -30), max: (20, 30)),
    warm_up_frames: 5,
    expectations: [
        (text: "it rains", check: Mask(mask: Rain, statistic: Mean, region: (0, 0.5, 1, 1), depth_m: (0, 20)), at: Capture(1), min: 0.001, max: 0.9),
        (check: Mask(mask: Wet, statistic: FractionAbove(0.5)), at: Last, min: 0.2),
        (check: Mask(mask: Depth, statistic: Max), max: 65.535),
        (check: Rises(mask: Wet, statistic: Mean, from: 0, to: 2, factor: 1.5)),
        (check: Falls(mask: Rain, statistic: Max, from: 1, to: 3)),
        (check: Weather(quantity: Wetness, time_s: 600, surface: concrete), equals: 1, tolerance: 0.05),
        (check: Pass(name: "cover"), min: 1, max: 10),
        (check: Budget(Residual), max: 1e-9),
        (check: Count(of: Drops, over_frames: Maximum), min: 100),
    ],
)
"#;

const FULL_WITH_LAVA: &str = "(expectations: [(check: Weather(quantity: Wetness, time_s: 1, surface: lava), min: 0)])";

fn parse(text: &str) -> Result<Scenario, ScenarioError> {
    Scenario::parse(text, Path::new("storm.ron"))
}

#[test]
fn a_full_scenario_is_read() {
    let s = parse(FULL).unwrap();
    assert_eq!(
        (s.name.as_str(), s.seed, s.duration_s, s.warm_up_frames),
        ("storm", 42, 600.0, 5)
    );
    assert_eq!(
        (s.scene[1].translation, s.scene[1].yaw_deg, s.scene[1].scale),
        ([4.0, 0.0, -2.0], 90.0, 1.5)
    );
    let Sky::Overcast(sky) = &s.environment.sky;
    assert_eq!((sky.zenith_luminance_cd_m2, sky.skyline_deg), (800.0, 14.0));
    assert_eq!(s.environment.sun.as_ref().unwrap().illuminance_lux, 2000.0);
    assert_eq!(s.environment.fog_visibility_m, Some(4000.0));
    assert_eq!(
        (s.weather.mode, s.weather.transition),
        (WeatherMode::Artist, Transition::Linear)
    );
    assert_eq!((s.weather.wetness, s.weather.water_level), (Some(0.75), Some(0.25)));
    let (gusts, lightning) = (s.weather.gusts.unwrap(), s.weather.lightning.unwrap());
    assert_eq!((gusts.intensity, gusts.lateral, gusts.time_scale_s), (0.25, 0.75, 6.0));
    assert_eq!((lightning.flashes_per_km2_min, lightning.centre_m.x), (0.0625, 100.0));
    let look = s.water.appearance();
    assert_eq!(
        (
            look.wave_strength,
            look.wave_slope,
            look.puddle_reflection,
            look.caustics
        ),
        (0.5, Some(0.0625), 0.875, 1.5)
    );
    assert_eq!(look.wave_velocity_m_s, Some(bevy::math::Vec2::new(0.25, -0.5)));
    assert!(!s.water.simulation && look.ripple_strength == 1.0);
    let timeline = core_timeline(&s).unwrap();
    let keys = timeline.keys();
    assert_eq!(keys.len(), 3);
    assert_eq!(keys[2].conditions.pressure_pa, 99_000.0);
    assert_eq!(
        (keys[1].conditions.intensity_mm_h, keys[1].conditions.air_temperature_c),
        (40.0, 12.0)
    );
    assert_eq!(s.vehicles[0].interpolation, Interpolation::CatmullRom);
    assert!(s.vehicles[0].headlights && s.camera.keys[1].cut && !s.camera.keys[0].cut);
    assert_eq!(s.captures.times_s(), [60.0, 240.0, 420.0, 600.0]);
    assert_eq!(s.outputs.masks, [Mask::Rain, Mask::Wet, Mask::Depth]);
    assert_eq!(s.domain.as_ref().unwrap().max, [20.0, 30.0]);
    let Check::Mask(mask) = &s.expectations[1].check else {
        panic!("{:?}", s.expectations[1])
    };
    assert_eq!(mask.statistic, Statistic::FractionAbove(0.5));
    assert_eq!(mask.region, [0.0, 0.0, 1.0, 1.0]);
}

#[test]
fn text_round_trip() {
    let before = parse(FULL).unwrap();
    let text = before.to_ron().unwrap();
    assert_eq!(parse(&text).unwrap(), before, "{text}");
}

#[test]
fn defaults_and_short_forms() {
    let s = parse("()").unwrap();
    assert_eq!(
        s,
        Scenario {
            name: "storm".into(),
            ..Scenario::default()
        }
    );
    assert_eq!(core_timeline(&s).unwrap().at(300.0).unwrap().intensity_mm_h, 0.0);
    let s = parse(r#"(scene: "a.glb", weather: (preset: heavy_rain), captures: Times([1, 2.5]))"#).unwrap();
    assert_eq!(s.scene, [ScenePart::from_file("a.glb")]);
    assert_eq!(s.weather.preset, Some(WeatherPreset::HeavyRain));
    assert_eq!(core_timeline(&s).unwrap().at(300.0).unwrap().intensity_mm_h, 10.0);
    assert_eq!(s.captures, Captures::Times(vec![1.0, 2.5]));
    assert_eq!(s.captures.resampled(3, 600.0).times_s(), [1.0, 1.75, 2.5]);
    assert_eq!(Captures::default().resampled(2, 600.0).times_s(), [0.0, 600.0]);
    assert_eq!(Captures::Times(vec![5.0]).resampled(2, 600.0).times_s(), [5.0, 600.0]);
    assert_eq!(
        Captures::Even {
            start_s: 5.0,
            end_s: 9.0,
            count: 1
        }
        .times_s(),
        [5.0]
    );
}

#[test]
fn broken_text_is_reported_with_its_place() {
    for (text, line, part) in [
        ("(\n  seed: 3,\n  colour: 4,\n)", 3, "colour"),
        ("(\n  environment: (\n    skyy: 3)\n)", 3, "skyy"),
        ("(\n\n  seed: \"three\")", 3, "integer"),
        ("(seed: -1)", 1, ""),
        ("(\n  captures: Sometimes([1]))", 2, "Sometimes"),
        ("(\n  scene: [(file: \"a.glb\",\n size: 3)])", 3, "size"),
        ("(\n  scene: 3)", 2, "file name"),
        ("(\n  seed: 3", 2, ""),
        ("(\n  expectations: [(min: 3)])", 2, "check"),
        (
            "(\n  weather: (\n    base: (relative_humidity: 90)))",
            3,
            "relative_humidity is 90, allowed: 0 to 1",
        ),
        ("(\n  weather: (preset: hail))", 2, "hail"),
        (FULL_WITH_LAVA, 1, "lava"),
    ] {
        match parse(text).unwrap_err() {
            ScenarioError::Syntax {
                file,
                line: at,
                column,
                message,
            } => {
                assert_eq!(
                    (file.as_path(), at),
                    (Path::new("storm.ron"), line),
                    "{text}: {message}"
                );
                assert!(column > 0 && message.contains(part), "{text}: {message}");
            }
            other => panic!("{text}: {other}"),
        }
    }
    let message = parse("(\n  seed: 3,\n  colour: 4,\n)").unwrap_err().to_string();
    assert!(message.starts_with("storm.ron:3:"), "{message}");
}

/// The full scenario with `from` replaced by `to`: what it is refused for.
fn refused(from: &str, to: &str) -> (String, String, String) {
    assert_eq!(FULL.matches(from).count(), 1, "{from}");
    let text = FULL.replace(from, to);
    match parse(&text).unwrap_err() {
        ScenarioError::Field {
            file,
            line,
            column,
            field,
            value,
            allowed,
        } => {
            assert_eq!(file, Path::new("storm.ron"));
            // The place is that of the change, or of what encloses it.
            let changed = FULL.find(from).unwrap();
            let at: usize = text.lines().take(line - 1).map(|l| l.len() + 1).sum::<usize>() + column - 1;
            // A mask that is missing is reported where it is wanted.
            let wanted_elsewhere = field.starts_with("expectations") && from.starts_with('[');
            assert!(
                wanted_elsewhere || at <= changed + to.len(),
                "{field} at {line}:{column}"
            );
            (field, value, allowed)
        }
        other => panic!("{to}: {other}"),
    }
}

#[test]
fn values_out_of_domain_name_the_field() {
    for (from, to, field, allowed) in [
        ("duration_s: 600", "duration_s: NaN", "duration_s", "2592000 s"),
        ("duration_s: 600", "duration_s: -1", "duration_s", "above 0"),
        ("duration_s: 600", "duration_s: inf", "duration_s", "above 0"),
        ("(4, 0, -2)", "(4, NaN, -2)", "scene[1].translation[1]", "m"),
        ("scale: 1.5", "scale: 0", "scene[1].scale", "0.0001 to 10000"),
        (
            "zenith_luminance_cd_m2: 800",
            "zenith_luminance_cd_m2: inf",
            "environment.sky.zenith_luminance_cd_m2",
            "cd/m²",
        ),
        ("wetness: 0.75", "wetness: 1.5", "weather.wetness", "0 to 1"),
        ("water_level: 0.25", "water_level: NaN", "weather.water_level", "0 to 1"),
        ("hole_level: 0.5", "hole_level: -1", "weather.hole_level", "0 to 1"),
        (
            "water_level: 0.125",
            "water_level: 2",
            "weather.levels.keys[1].water_level",
            "0 to 1",
        ),
        ("period_s: 20", "period_s: 7", "weather.levels.period_s", "not before"),
        (
            "(time_s: 8, wetness",
            "(time_s: 0, wetness",
            "weather.levels.keys[1].time_s",
            "later than",
        ),
        ("margin: 0.3", "margin: 0", "scene[0].puddles.margin", "0.0001 to 1"),
        ("relief: 0.02", "relief: 2", "scene[0].depth_map.relief", "0 to 1"),
        ("wave_slope: 0.0625", "wave_slope: 0.75", "water.wave_slope", "0 to 0.5"),
        (
            "puddle_reflection: 0.875",
            "puddle_reflection: -1",
            "water.puddle_reflection",
            "0 to 1",
        ),
        ("caustics: 1.5", "caustics: 11", "water.caustics", "0 to 10"),
        ("(0.9, 0.95, 1.1)", "(0, 0, 0)", "environment.sky.tint", "not all 0"),
        ("(0.2, -1, 0)", "(0, 0, 0)", "environment.sun.direction", "not zero"),
        (
            "fog_visibility_m: 4000",
            "fog_visibility_m: 0",
            "environment.fog_visibility_m",
            "1 to 1000000 m",
        ),
        (
            "intensity_mm_h: 40",
            "intensity_mm_h: -40",
            "weather.keys[1].intensity_mm_h",
            "0 to 500 mm/h",
        ),
        (
            "intensity_mm_h: 40",
            "intensity_mm_h: NaN",
            "weather.keys[1].intensity_mm_h",
            "0 to 500 mm/h",
        ),
        ("time_s: 120", "time_s: 0", "weather.keys[1].time_s", "later than"),
        ("radius_m: 60", "radius_m: 0", "areas.list[0].shape", "0.1 to 1e6 m"),
        ("Rate(80)", "Rate(501)", "areas.list[0].rain", "0 to 500 mm/h"),
        (
            "(4, 0), (4, 4)",
            "(4, 4), (4, 0)",
            "areas.list[1].shape",
            "does not cross itself",
        ),
        ("outside: 0.5", "outside: 2", "areas.outside", "0 to 1"),
        (
            "intensity: 0.25",
            "intensity: 0.75",
            "weather.gusts.intensity",
            "0 to 0.5",
        ),
        (
            "nearest_m: 700",
            "nearest_m: -1",
            "weather.lightning.nearest_m",
            "0 to 0.9",
        ),
        (
            "wind_m_s: (1, 0, 0)",
            "wind_m_s: (1, inf, 0)",
            "weather.keys[0].wind_m_s",
            "80 m/s",
        ),
        ("mode: Artist", "preset: heavy_rain", "weather", "one of them"),
        (
            "(time_s: 10, position",
            "(time_s: NaN, position",
            "vehicles[0].path[1].time_s",
            "s",
        ),
        (
            "(time_s: 10, position",
            "(time_s: 0, position",
            "vehicles[0].path[1].time_s",
            "later than",
        ),
        ("(0, 0, 50)", "(0, 0, 1e7)", "vehicles[0].path[1].position[2]", "m"),
        (
            "wheel_radius_m: 0.4",
            "wheel_radius_m: 0",
            "vehicles[0].wheel_radius_m",
            "0.01 to 10 m",
        ),
        (
            "fov_y_deg: 45",
            "fov_y_deg: 180",
            "camera.keys[0].fov_y_deg",
            "1 to 170",
        ),
        (
            "target: (0, 1, -9)",
            "target: (0, 1.7, 3)",
            "camera.keys[1].target",
            "from the eye",
        ),
        (
            "interpolation: CatmullRom,\n    ),\n    rain",
            "attached: (vehicle: \"truck\"),\n    ),\n    rain",
            "camera",
            "one of them",
        ),
        (
            "interpolation: CatmullRom,\n    ),\n    rain",
            "orthographic_m: 0,\n    ),\n    rain",
            "camera.orthographic_m",
            "0.1 to 1000 m",
        ),
        ("contrast: 6", "contrast: 0.5", "rain.contrast", "1 to 32"),
        ("contrast: 6", "lamps: 65", "rain.lamps", "0 to 64"),
        (
            "streak_budget: 100000",
            "streak_budget: 4000001",
            "rain.streak_budget",
            "4000000",
        ),
        (
            "streak_budget: 100000",
            "splash_budget: 1000001",
            "rain.splash_budget",
            "1000000",
        ),
        ("count: 4", "count: 10001", "captures", "at most 10000"),
        ("end_s: 600, count", "end_s: 601, count", "captures.end_s", "0 to 600"),
        ("(640, 360)", "(640, 0)", "outputs.size[1]", "1 to 8192"),
        ("(640, 360)", "(8193, 10)", "outputs.size[0]", "1 to 8192"),
        (
            "[Rain, Wet, Depth]",
            "[Rain, Wet, Depth, Wet]",
            "outputs.masks[3]",
            "once",
        ),
        (
            "[Rain, Wet, Depth]",
            "[Rain, Wet]",
            "expectations[0].check.depth_m",
            "Depth",
        ),
        (
            "[Rain, Wet, Depth]",
            "[Rain, Depth]",
            "expectations[1].check.mask",
            "outputs.masks",
        ),
        ("max: (20, 30)", "max: (20, -30)", "domain.max[1]", "above -30"),
        ("warm_up_frames: 5", "warm_up_frames: 1001", "warm_up_frames", "1000"),
        (
            "warm_up_frames: 5",
            "drains: [(position: (0, 0), area_m2: -1)]",
            "drains[0].area_m2",
            "0 to 1000 m²",
        ),
        (
            "warm_up_frames: 5",
            "spouts: [(position: (0, 3, 0), form: Eave(length_m: -2))]",
            "spouts[0].form.length_m",
            "0.01 to 1000 m",
        ),
        (
            "warm_up_frames: 5",
            "spouts: [(position: (0, 3, 0), form: Pipe(diameter_m: 0.1), catchment_m2: -2)]",
            "spouts[0].catchment_m2",
            "0 to 1e6 m²",
        ),
        (
            "warm_up_frames: 5",
            "run_ups: [(capture: 4, seconds: 1)]",
            "run_ups[0].capture",
            "0 to 3",
        ),
        (
            "warm_up_frames: 5",
            "run_ups: [(capture: 1, seconds: 1), (capture: 1, seconds: 2)]",
            "run_ups[1].capture",
            "each once",
        ),
        (
            "warm_up_frames: 5",
            "run_ups: [(capture: 3, seconds: 61)]",
            "run_ups[0].seconds",
            "0 to 60 s",
        ),
        ("Capture(1)", "Capture(4)", "expectations[0].at", "0 to 3"),
        ("from: 1, to: 3", "from: 1, to: 9", "expectations[4].check.to", "0 to 3"),
        (
            "(0, 0.5, 1, 1)",
            "(0, 0.5, 1, 0.5)",
            "expectations[0].check.region",
            "top < bottom",
        ),
        (
            "FractionAbove(0.5)",
            "FractionAbove(NaN)",
            "expectations[1].check.statistic",
            "0 to 1",
        ),
        ("factor: 1.5", "factor: 0.5", "expectations[3].check.factor", "1 to"),
        (
            "factor: 1.5))",
            "factor: 1.5), min: 2)",
            "expectations[3]",
            "factor alone",
        ),
        (
            "equals: 1, tolerance: 0.05",
            "tolerance: 0.05",
            "expectations[5]",
            "equals, min or max",
        ),
        (
            "equals: 1, tolerance: 0.05",
            "equals: 1, min: 0",
            "expectations[5]",
            "not both",
        ),
        (
            "tolerance: 0.05",
            "tolerance: NaN",
            "expectations[5].tolerance",
            "0 or more",
        ),
        (
            "time_s: 600, surface",
            "time_s: 700, surface",
            "expectations[5].check.time_s",
            "0 to 600",
        ),
        (
            "name: \"cover\"",
            "name: \"covers\"",
            "expectations[6].check.name",
            "streak_textures",
        ),
        (
            "min: 1, max: 10",
            "min: 11, max: 10",
            "expectations[6].min",
            "at most max",
        ),
        ("max: 1e-9", "max: inf", "expectations[7].max", "finite"),
    ] {
        let (found, value, range) = refused(from, to);
        assert_eq!(found, field, "{to}: {value}, {range}");
        assert!(range.contains(allowed), "{to}: {range}");
    }
}

#[test]
fn the_place_of_a_value_is_exact() {
    let text = FULL.replace("(0, 0, 50)", "(0, 0, 1e7)");
    let line = text.lines().position(|l| l.contains("1e7")).unwrap();
    let column = text.lines().nth(line).unwrap().find("1e7").unwrap();
    let error = parse(&text).unwrap_err().to_string();
    let place = format!(
        "storm.ron:{}:{}: vehicles[0].path[1].position[2] is 10000000, allowed: ",
        line + 1,
        column + 1
    );
    assert!(error.starts_with(&place), "{error}");
}

#[test]
fn names_must_refer() {
    let text = r#"(vehicles: [(name: "a", file: "a.glb", path: [(time_s: 0)])], camera: (attached: (vehicle: "b")))"#;
    assert!(
        parse(text)
            .unwrap_err()
            .to_string()
            .contains("camera.attached.vehicle is `b`, allowed: the name of a vehicle (a)")
    );
    assert!(parse(&text.replace("\"b\"", "\"a\"")).is_ok());
    let text = text.replace("file: \"a.glb\", ", "");
    assert!(
        parse(&text)
            .unwrap_err()
            .to_string()
            .contains("vehicles[0].file is empty")
    );
    let none = r#"(outputs: (masks: [Rain]), expectations: [(check: Mask(mask: Rain, statistic: Max), min: 0)])"#;
    assert!(parse(none).unwrap_err().to_string().contains("the scenario has none"));
}

#[test]
fn files_are_found_beside_the_scenario() {
    let folder = Folder::new("load");
    let path = folder.0.join("rain.ron");
    std::fs::write(&path, r#"(weather: (csv: "rain.csv", transition: hold))"#).unwrap();
    let missing = Scenario::load(&path).unwrap_err().to_string();
    assert!(missing.contains("rain.csv"), "{missing}");
    let csv = |text: &str| {
        std::fs::write(folder.0.join("rain.csv"), text).unwrap();
        Scenario::load(&path)
    };
    let good = csv("time_s,intensity_mm_h,wind_x_m_s\n# gauge 7\n0,0,2\n300, 12.5, 3\n600,4,3\n").unwrap();
    assert_eq!(good.name, "rain");
    assert_eq!(good.folder, folder.0);
    let at = |time_s: f64| {
        let now = core_timeline(&good).unwrap().at(time_s).unwrap();
        (now.intensity_mm_h, now.wind_m_s.x)
    };
    assert_eq!(
        [at(0.0), at(299.0), at(300.0), at(700.0)],
        [(0.0, 2.0), (0.0, 2.0), (12.5, 3.0), (4.0, 3.0)]
    );
    for (text, line, part) in [
        ("time_s,intensity\n0,1\n", 1, "unknown column \"intensity\""),
        ("time_s\n0\n", 1, "\"intensity_mm_h\""),
        (
            "time_s,intensity_mm_h\n0,1\n10,lots\n",
            3,
            "column 2: intensity_mm_h is \"lots\"",
        ),
        ("time_s,intensity_mm_h\n0,1\n10,NaN\n", 3, "0 to 500 mm/h"),
        ("time_s,intensity_mm_h\n0,1\n0,2\n", 3, "does not come after"),
    ] {
        match csv(text).unwrap_err() {
            ScenarioError::Csv { line: at, message, .. } => {
                assert_eq!(at, line, "{text}: {message}");
                assert!(message.contains(part), "{text}: {message}");
            }
            other => panic!("{other}"),
        }
    }
    let nowhere = Scenario::load(folder.0.join("nowhere.ron")).unwrap_err();
    assert!(matches!(nowhere, ScenarioError::Io { .. }) && nowhere.to_string().contains("nowhere.ron"));
}
