//! Every model of `rain model` against the check values of `docs/physics.md`, typed in.

use rain_cli::model::{Output, calculate, models};

/// Runs a model on arguments separated by spaces.
#[track_caller]
fn run(name: &str, arguments: &str) -> Output {
    let arguments: Vec<String> = arguments.split_whitespace().map(str::to_owned).collect();
    calculate(name, &arguments).unwrap_or_else(|error| panic!("{name} {arguments:?}: {error}"))
}

/// A returned value close to `expected`, absolutely.
#[track_caller]
fn near(output: &Output, key: &str, expected: f64, within: f64) {
    let value = output
        .get(key)
        .unwrap_or_else(|| panic!("no {key} in {}", output.json()));
    assert!(
        (value - expected).abs() <= within,
        "{key} is {value}, expected {expected}"
    );
}

/// The same relative to the expected value.
#[track_caller]
fn close(output: &Output, key: &str, expected: f64, relative: f64) {
    near(output, key, expected, relative * expected.abs());
}

#[test]
fn every_model_of_the_interface_is_there_with_its_keys_and_results() {
    let table: [(&str, &str, &str); 15] = [
        (
            "terminal-speed",
            "diameter_mm pressure_pa temperature_c fit",
            "speed_m_s",
        ),
        (
            "rainfall",
            "intensity_mm_h distribution renormalise min_diameter_mm",
            "n0_per_m3_mm lambda_per_mm flux_mm_h number_per_m3 impacts_per_m2_s median_volume_diameter_air_mm \
             median_volume_diameter_ground_mm extinction_per_km",
        ),
        ("drop-shape", "diameter_mm", "axis_ratio volume_mm3 oscillation_hz"),
        (
            "fall",
            "diameter_mm height_m",
            "speed_m_s time_s distance_to_99_percent_m",
        ),
        ("streak", "diameter_mm exposure_s", "length_m opacity"),
        ("fresnel", "angle_deg ior", "reflectance"),
        (
            "visibility",
            "intensity_mm_h distance_m",
            "extinction_per_km transmittance visibility_km",
        ),
        (
            "canopy",
            "lai kind intensity_mm_h duration_s evaporation_mm_h",
            "capacity_mm saturation_time_s storage_mm free_throughfall_mm drip_mm stemflow_mm throughfall_mm \
             evaporated_mm fallen_mm drip_fraction",
        ),
        (
            "sheet-flow",
            "manning_n slope length_m intensity_mm_h",
            "depth_mm equilibrium_time_s",
        ),
        (
            "road-film",
            "texture_depth_mm length_m intensity_mm_h slope fit",
            "depth_mm",
        ),
        ("hydroplaning", "pressure_kpa", "speed_km_h"),
        (
            "wheel",
            "speed_km_h width_mm film_mm tread_mm pressure_kpa",
            "intercepted_kg_s adhesion_kg_s tread_kg_s bow_kg_s side_kg_s hydroplaning",
        ),
        ("wet-albedo", "albedo", "wet_albedo ratio"),
        (
            "waves",
            "cells mode_x mode_y time_s courant speed_m_s length_m",
            "amplitude discrete_amplitude exact_amplitude energy_drift",
        ),
        ("weather", "timeline duration_s step_s", "series budget"),
    ];
    let models = models();
    assert_eq!(models.len(), table.len());
    for (name, keys, returns) in table {
        let model = models
            .iter()
            .find(|m| m.name == name)
            .unwrap_or_else(|| panic!("no {name}"));
        for key in keys.split_whitespace() {
            assert!(model.keys.iter().any(|k| k.name == key), "{name} has no key {key}");
        }
        let found: Vec<&str> = model.returns.iter().map(|r| r.name).collect();
        for wanted in returns.split_whitespace() {
            assert!(found.contains(&wanted), "{name} does not return {wanted}");
        }
    }
}

#[test]
fn what_models_say_they_return_is_what_comes_back() {
    for model in models().into_iter().filter(|m| m.name != "weather") {
        let output = run(model.name, &model.example.join(" "));
        let found: Vec<&str> = output.names().collect();
        let said: Vec<&str> = model.returns.iter().map(|r| r.name).collect();
        assert_eq!(found, said, "{}", model.name);
        assert!(output.is_finite(), "{}: {}", model.name, output.json());
    }
}

#[test]
fn terminal_speeds() {
    for (fit, diameter, speed) in [
        ("default", 0.5, 2.0511),
        ("default", 1.0, 4.0047),
        ("default", 2.0, 6.5156),
        ("default", 5.0, 9.0961),
        ("reference", 1.0, 4.03),
        ("reference", 2.0, 6.49),
        ("gunn-kinzer", 3.4, 8.44),
        ("gunn-kinzer", 9.0, 9.17),
        ("beard", 0.1, 0.24957),
        ("beard", 0.5, 2.01688),
        ("beard", 1.0, 4.00553),
        ("beard", 2.0, 6.50877),
        ("beard", 5.0, 9.08752),
        ("weber", 2.0, 6.3246),
        ("atlas", 2.0, 6.5477),
        ("best", 2.0, 6.3702),
        ("atlas-ulbrich", 1.0, 3.78),
        ("brandes", 1.0, 3.95178),
    ] {
        let output = run("terminal-speed", &format!("diameter_mm={diameter} fit={fit}"));
        near(&output, "speed_m_s", speed, 6e-5);
    }
    near(&run("terminal-speed", "diameter_mm=0"), "speed_m_s", 0.0, 0.0);
    // Foote & du Toit stay near the measurements where they were fitted.
    near(
        &run("terminal-speed", "diameter_mm=2 fit=foote-du-toit"),
        "speed_m_s",
        6.49,
        0.033,
    );
    for (diameter, speed) in [(0.5, 2.09414), (1.0, 4.17021), (3.0, 8.42109), (5.0, 9.54588)] {
        for fit in ["beard", "reference"] {
            let output = run(
                "terminal-speed",
                &format!("diameter_mm={diameter} pressure_pa=90000 temperature_c=12 fit={fit}"),
            );
            close(&output, "speed_m_s", speed, 2e-5);
        }
        let output = run(
            "terminal-speed",
            &format!("diameter_mm={diameter} pressure_pa=90000 temperature_c=12"),
        );
        close(&output, "speed_m_s", speed, 0.03);
    }
}

#[test]
fn rainfall_in_bulk() {
    // R, N₀, Λ, N_t, D₀ in the air, on the ground, σ_geo.
    for (rate, n0, lambda, number, air, ground, geometric) in [
        (1.0, 6755.6, 4.1, 1647.7, 0.89562, 1.0957, 0.15397),
        (5.0, 6776.5, 2.9242, 2317.4, 1.2558, 1.4977, 0.42572),
        (10.0, 6865.8, 2.5280, 2715.9, 1.4525, 1.7144, 0.66752),
        (25.0, 7068.0, 2.0855, 3389.1, 1.7607, 2.0483, 1.2240),
        (50.0, 7294.1, 1.8030, 4045.5, 2.0366, 2.3388, 1.9547),
        (100.0, 7593.8, 1.5588, 4871.7, 2.3557, 2.6649, 3.1494),
    ] {
        let output = run("rainfall", &format!("intensity_mm_h={rate}"));
        close(&output, "n0_per_m3_mm", n0, 3e-5);
        close(&output, "lambda_per_mm", lambda, 3e-5);
        close(&output, "flux_mm_h", rate, 1e-9);
        close(&output, "number_per_m3", number, 4e-5);
        close(&output, "median_volume_diameter_air_mm", air, 4e-5);
        close(&output, "median_volume_diameter_ground_mm", ground, 4e-5);
        close(&output, "extinction_per_km", 2.0 * geometric, 5e-5);
    }
}

#[test]
fn rainfall_that_reaches_the_ground() {
    for (rate, all, large) in [
        (1.0, 1518.8, 636.7),
        (5.0, 3039.0, 1785.1),
        (25.0, 6149.7, 4452.0),
        (100.0, 11416.0, 9256.7),
    ] {
        close(
            &run("rainfall", &format!("intensity_mm_h={rate}")),
            "impacts_per_m2_s",
            all,
            1e-4,
        );
        let output = run("rainfall", &format!("intensity_mm_h={rate} min_diameter_mm=0.5"));
        close(&output, "impacts_per_m2_s", large, 1e-4);
    }
    // A smallest drop selects and does not renormalise.
    let (all, large) = (
        run("rainfall", "intensity_mm_h=25"),
        run("rainfall", "intensity_mm_h=25 min_diameter_mm=0.5"),
    );
    assert_eq!(all.get("n0_per_m3_mm"), large.get("n0_per_m3_mm"));
    assert!(large.get("flux_mm_h") < all.get("flux_mm_h"));
}

#[test]
fn rainfall_of_other_kinds_and_as_published() {
    for (kind, n0, ratios) in [
        ("marshall-palmer", 8000.0, [1.1842, 1.1806, 1.1319, 1.0535]),
        ("drizzle", 30000.0, [0.8952, 0.9252, 0.9215, 0.8901]),
        ("widespread", 7000.0, [1.0362, 1.0330, 0.9904, 0.9218]),
        ("thunderstorm", 1400.0, [0.9158, 0.8808, 0.8106, 0.7255]),
    ] {
        for (rate, ratio) in [1.0, 5.0, 25.0, 100.0].into_iter().zip(ratios) {
            let published = run(
                "rainfall",
                &format!("intensity_mm_h={rate} distribution={kind} renormalise=false"),
            );
            near(&published, "n0_per_m3_mm", n0, 1e-9);
            close(&published, "flux_mm_h", ratio * rate, 8e-5);
            let own = run("rainfall", &format!("intensity_mm_h={rate} distribution={kind}"));
            close(&own, "flux_mm_h", rate, 1e-9);
            close(&own, "n0_per_m3_mm", n0 / ratio, 8e-5);
        }
    }
    // N₀ = 8000: σ = 0.36466 R^0.63 per km.
    let published = run("rainfall", "intensity_mm_h=25 renormalise=false");
    close(&published, "extinction_per_km", 2.77071, 1e-5);
    close(
        &run("rainfall", "intensity_mm_h=9 distribution=gamma"),
        "flux_mm_h",
        9.0,
        1e-9,
    );
}

#[test]
fn drops_flatten_swing_and_fall() {
    for (diameter, ratio, hertz) in [
        (0.5, 0.9990, 972.55),
        (1.0, 0.9826, 343.85),
        (2.0, 0.9276, 121.57),
        (3.0, 0.8558, 66.17),
        (5.0, 0.7061, 30.75),
    ] {
        let output = run("drop-shape", &format!("diameter_mm={diameter}"));
        near(&output, "axis_ratio", ratio, 6e-5);
        close(&output, "oscillation_hz", hertz, 2e-4);
        close(
            &output,
            "volume_mm3",
            core::f64::consts::PI / 6.0 * diameter * diameter * diameter,
            1e-12,
        );
    }
    // The closed form with the measured terminal speed, in brackets in the table.
    for (diameter, heights) in [
        (1, [2.585, 3.233, 3.751, 3.991, 4.030]),
        (2, [2.889, 3.857, 4.927, 5.864, 6.486]),
        (3, [2.997, 4.082, 5.381, 6.700, 8.022]),
        (4, [3.050, 4.187, 5.586, 7.072, 8.758]),
        (5, [3.081, 4.245, 5.686, 7.231, 9.012]),
    ] {
        for (height, speed) in [0.5, 1.0, 2.0, 4.0, 16.0].into_iter().zip(heights) {
            let output = run("fall", &format!("diameter_mm={diameter} height_m={height}"));
            near(&output, "speed_m_s", speed, 6e-4);
        }
    }
    let output = run("fall", "diameter_mm=2 height_m=0");
    assert_eq!((output.get("speed_m_s"), output.get("time_s")), (Some(0.0), Some(0.0)));
    // The reference's distances; the closed form keeps within a few per cent of them.
    for (diameter, distance) in [(1, 4.08), (2, 9.38), (3, 13.25), (4, 14.68), (5, 14.59)] {
        let output = run("fall", &format!("diameter_mm={diameter} height_m=1"));
        close(&output, "distance_to_99_percent_m", distance, 0.06);
    }
}

#[test]
fn streaks_are_as_long_as_the_way() {
    for (diameter, length_cm, opacity) in [
        (0.5, 3.433, 0.01456),
        (1.0, 6.717, 0.01489),
        (2.0, 10.817, 0.01849),
        (3.0, 13.433, 0.02233),
        (4.0, 14.717, 0.02718),
    ] {
        let output = run(
            "streak",
            &format!("diameter_mm={diameter} exposure_s=0.016666666666666666"),
        );
        near(&output, "length_m", length_cm * 1e-2, 6e-6);
        near(&output, "opacity", opacity, 6e-6);
    }
    // A frozen drop is opaque.
    let frozen = run("streak", "diameter_mm=2 exposure_s=0");
    assert_eq!((frozen.get("length_m"), frozen.get("opacity")), (Some(0.0), Some(1.0)));
}

#[test]
fn light_is_reflected_and_lost() {
    for (angle, share) in [
        (0, 0.020373),
        (30, 0.021436),
        (45, 0.027898),
        (60, 0.059691),
        (75, 0.212378),
        (85, 0.583523),
        (88, 0.804043),
    ] {
        near(
            &run("fresnel", &format!("angle_deg={angle}")),
            "reflectance",
            share,
            6e-7,
        );
    }
    near(&run("fresnel", "angle_deg=90"), "reflectance", 1.0, 1e-12);
    near(&run("fresnel", "angle_deg=40 ior=1"), "reflectance", 0.0, 1e-12);
    // From inside: the same at normal incidence, all beyond the critical angle of 48.607°.
    near(
        &run("fresnel", "angle_deg=0 ior=0.7501875468867217"),
        "reflectance",
        0.020373,
        6e-7,
    );
    near(
        &run("fresnel", "angle_deg=48.7 ior=0.7501875468867217"),
        "reflectance",
        1.0,
        1e-12,
    );
    let below = run("fresnel", "angle_deg=48.5 ior=0.7501875468867217");
    assert!(below.get("reflectance").is_some_and(|r| r < 0.95), "{}", below.json());
    for (rate, extinction) in [
        (1, 0.30794),
        (5, 0.85144),
        (10, 1.33504),
        (25, 2.4480),
        (50, 3.9094),
        (100, 6.2988),
    ] {
        let output = run("visibility", &format!("intensity_mm_h={rate} distance_m=100"));
        close(&output, "extinction_per_km", extinction, 4e-5);
        close(&output, "visibility_km", 3.912 / extinction, 4e-5);
        near(&output, "transmittance", f64::exp(-0.1 * extinction), 1e-5);
    }
}

#[test]
fn crowns_hold_drip_and_lose_nothing() {
    // Intercepted rain of 10 mm/h needs 10/(1 − e^(−κ LAI)) in the open field.
    let field = 10.0 / (1.0 - f64::exp(-2.0));
    for (time, q, stored) in [(108, 0.25, 0.2625), (216, 0.5, 0.45), (324, 0.75, 0.5625)] {
        let output = run("canopy", &format!("lai=4 intensity_mm_h={field} duration_s={time}"));
        near(&output, "capacity_mm", 0.6, 1e-12);
        close(&output, "saturation_time_s", 7200.0 * 0.6 / field, 1e-12);
        near(&output, "drip_fraction", q, 1e-9);
        near(&output, "storage_mm", stored, 1e-9);
        near(&output, "stemflow_mm", 0.0, 1e-12);
    }
    for (time, q, stored) in [
        (60, 0.131443, 0.147365),
        (200, 0.432582, 0.406822),
        (432, 0.873827, 0.590448),
        (3000, 0.95, 0.5985),
    ] {
        let output = run(
            "canopy",
            &format!("lai=4 intensity_mm_h={field} duration_s={time} evaporation_mm_h=0.5 max_drip_fraction=1"),
        );
        near(&output, "drip_fraction", q, 6e-7);
        near(&output, "storage_mm", stored, 6e-7);
    }
    for kind in ["broadleaf", "needle"] {
        let output = run(
            "canopy",
            &format!("lai=3 kind={kind} intensity_mm_h=20 duration_s=1800 evaporation_mm_h=0.3"),
        );
        let get = |key: &str| output.get(key).expect("a number");
        near(&output, "fallen_mm", 10.0, 1e-9);
        let parts = get("throughfall_mm") + get("stemflow_mm") + get("storage_mm") + get("evaporated_mm");
        near(&output, "fallen_mm", parts, 1e-12);
        near(
            &output,
            "throughfall_mm",
            get("free_throughfall_mm") + get("drip_mm"),
            1e-12,
        );
        near(&output, "capacity_mm", if kind == "needle" { 0.6 } else { 0.45 }, 1e-12);
        near(&output, "free_throughfall_mm", 10.0 * f64::exp(-1.5), 1e-9);
    }
    let bare = run("canopy", "lai=0 intensity_mm_h=20 duration_s=1800");
    near(&bare, "throughfall_mm", 10.0, 1e-9);
    near(&bare, "saturation_time_s", 0.0, 0.0);
}

#[test]
fn water_runs_off_and_covers_the_texture() {
    for (n, slope, length, rate, depth, time) in [
        (0.015, 0.02, 5.0, 50.0, 0.83239, 59.932),
        (0.011, 0.025, 7.5, 25.0, 0.54384, 78.313),
        (0.05, 0.01, 4.0, 100.0, 2.79793, 100.725),
    ] {
        let output = run(
            "sheet-flow",
            &format!("manning_n={n} slope={slope} length_m={length} intensity_mm_h={rate}"),
        );
        close(&output, "depth_mm", depth, 1e-5);
        close(&output, "equilibrium_time_s", time, 1e-5);
    }
    for (texture, length, rate, slope, old, new) in [
        (0.5, 5.0, 50.0, 0.02, 0.9310, 1.0036),
        (1.0, 7.5, 25.0, 0.015, 0.3783, 0.5221),
        (0.8, 10.0, 100.0, 0.025, 1.9826, 2.3102),
    ] {
        let road = format!("texture_depth_mm={texture} length_m={length} intensity_mm_h={rate} slope={slope}");
        near(&run("road-film", &road), "depth_mm", old, 6e-5);
        near(
            &run("road-film", &format!("{road} fit=gallaway71")),
            "depth_mm",
            old,
            6e-5,
        );
        near(
            &run("road-film", &format!("{road} fit=gallaway79")),
            "depth_mm",
            new,
            6e-5,
        );
    }
    let dry = run(
        "road-film",
        "texture_depth_mm=0.5 length_m=5 intensity_mm_h=0 slope=0.02",
    );
    near(&dry, "depth_mm", -0.5, 1e-12);
}

#[test]
fn wheels_meet_water() {
    for (pressure, speed) in [(180, 85.2), (220, 94.2), (250, 100.4), (700, 168.0)] {
        near(
            &run("hydroplaning", &format!("pressure_kpa={pressure}")),
            "speed_km_h",
            speed,
            0.06,
        );
    }
    for (film, all, adhesion, tread, rest) in [
        (0.05, 0.24955, 0.18716, 0.06239, 0.0),
        (0.5, 2.4955, 0.37433, 0.62388, 1.4973),
        (2.0, 9.982, 0.37433, 0.99820, 8.60947),
    ] {
        let output = run("wheel", &format!("speed_km_h=90 width_mm=200 film_mm={film}"));
        near(&output, "intercepted_kg_s", all, 6e-6);
        near(&output, "adhesion_kg_s", adhesion, 6e-6);
        near(&output, "tread_kg_s", tread, 6e-6);
        let pushed = output.get("bow_kg_s").unwrap_or(0.0) + output.get("side_kg_s").unwrap_or(0.0);
        assert!((pushed - rest).abs() < 6e-5, "{pushed} {rest}");
    }
    let floats = |arguments: &str| run("wheel", arguments).json().contains("\"hydroplaning\":true");
    assert!(floats("speed_km_h=130 width_mm=200 film_mm=10 tread_mm=1.6"));
    assert!(!floats("speed_km_h=50 width_mm=200 film_mm=10 tread_mm=1.6"));
    assert!(!floats("speed_km_h=130 width_mm=200 film_mm=0.1"));
}

#[test]
fn wet_ground_is_darker() {
    for (dry, wet, ratio) in [
        (0.05, 0.02461, 0.4922),
        (0.10, 0.05056, 0.5056),
        (0.20, 0.10691, 0.5345),
        (0.50, 0.32247, 0.6449),
        (0.80, 0.64929, 0.8116),
        (0.95, 0.88491, 0.9315),
    ] {
        let output = run("wet-albedo", &format!("albedo={dry}"));
        near(&output, "wet_albedo", wet, 6e-6);
        near(&output, "ratio", ratio, 6e-5);
    }
    let black = run("wet-albedo", "albedo=0");
    near(&black, "wet_albedo", 0.0, 1e-12);
    assert!(
        black.get("ratio").is_some_and(|r| r > 0.47 && r < 0.4922),
        "{}",
        black.json()
    );
}

#[test]
fn waves_follow_the_discrete_and_nearly_the_exact_solution() {
    for (cells, x, y, courant, discrete, exact) in [
        (32, 2, 1, 0.5, -0.143_430_758_327, -0.096357),
        (64, 5, 3, 0.7, 0.923_685_186_284, 0.938754),
    ] {
        // 500 steps.
        let time = 500.0 * courant / f64::from(cells) / 0.2214;
        let output = run(
            "waves",
            &format!("cells={cells} mode_x={x} mode_y={y} time_s={time} courant={courant}"),
        );
        near(&output, "discrete_amplitude", discrete, 1e-11);
        near(&output, "amplitude", discrete, 1e-10);
        near(&output, "exact_amplitude", exact, 6e-7);
        near(&output, "energy_drift", 0.0, 1e-12);
    }
    let still = run("waves", "cells=16 mode_x=0 mode_y=0 time_s=3");
    near(&still, "amplitude", 1.0, 1e-12);
    near(
        &run("waves", "cells=16 mode_x=1 mode_y=0 time_s=0"),
        "amplitude",
        1.0,
        1e-12,
    );
}
