//! `rain model`, `rain bake` and `rain bench` as processes: output, messages, exit codes.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use serde_json::Value;

pub fn rain(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_rain"))
        .args(arguments)
        .output()
        .expect("the program starts")
}

/// What it prints as JSON; nothing may go to stderr.
#[track_caller]
pub fn json(arguments: &[&str]) -> Value {
    let output = rain(arguments);
    let (out, err) = (
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr),
    );
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {err}");
    assert!(err.is_empty(), "{arguments:?}: {err}");
    assert_eq!(out.trim_end().lines().count(), 1, "one object on one line: {out}");
    serde_json::from_str(&out).unwrap_or_else(|error| panic!("{error}: {out}"))
}

/// Exit code 2, nothing on stdout, and all of `words` on stderr.
#[track_caller]
pub fn refused(arguments: &[&str], words: &[&str]) {
    let output = rain(arguments);
    let err = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {err}");
    assert!(output.stdout.is_empty(), "{arguments:?}");
    for word in words {
        assert!(err.contains(word), "`{word}` is not in: {err}");
    }
}

#[track_caller]
fn near(value: &Value, expected: f64) {
    let found = value.as_f64().unwrap_or_else(|| panic!("no number: {value}"));
    assert!(
        (found - expected).abs() <= 1e-9 * expected.abs().max(1.0),
        "{found} is not {expected}"
    );
}

/// A folder that is removed at the end.
fn file(folder: &tempfile::TempDir, name: &str, bytes: &[u8]) -> String {
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).expect("written");
    path.to_string_lossy().into_owned()
}

pub fn folder() -> tempfile::TempDir {
    tempfile::TempDir::new().expect("a temporary folder")
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_error_and_a_closed_pipe_is_not() {
    let folder = folder();
    let heights = file(&folder, "h.csv", b"1,1,1\n1,0,1\n1,1,1\n");
    for arguments in [
        vec!["model", "fall", "diameter_mm=5", "height_m=2"],
        vec!["model", "fall", "diameter_mm=5", "height_m=2", "--json"],
        vec!["model"],
        vec!["bake", &heights],
        vec!["bake", &heights, "--json"],
        vec!["--help"],
        vec!["--version"],
    ] {
        let start = |stdout: Stdio| {
            Command::new(env!("CARGO_BIN_EXE_rain"))
                .args(&arguments)
                .stdout(stdout)
                .stderr(Stdio::piped())
                .spawn()
                .expect("the program starts")
        };
        let full = std::fs::OpenOptions::new().write(true).open("/dev/full");
        let output = start(full.expect("every Linux has it").into()).wait_with_output();
        let output = output.expect("it ends");
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
        assert!(
            message.starts_with("rain: cannot write to stdout: ") && message.contains("space"),
            "{arguments:?}: {message}"
        );
        // Whoever was to read has gone.
        let (reader, writer) = std::io::pipe().expect("a pipe");
        drop(reader);
        let output = start(writer.into()).wait_with_output().expect("it ends");
        assert_eq!(output.status.code(), Some(0), "{arguments:?}");
        assert!(
            output.stderr.is_empty(),
            "{arguments:?}: {}",
            String::from_utf8_lossy(&output.stderr)
        );
    }
}

#[test]
fn a_model_prints_one_json_object_or_a_table() {
    let speed = json(&["model", "terminal-speed", "diameter_mm=2", "fit=beard", "--json"]);
    assert!((speed["speed_m_s"].as_f64().expect("a number") - 6.50877).abs() < 1e-5);
    let wheel = json(&[
        "model",
        "--json",
        "wheel",
        "speed_km_h=90",
        "width_mm=200",
        "film_mm=0.5",
    ]);
    assert_eq!(wheel["hydroplaning"], Value::Bool(false));
    assert_eq!(wheel.as_object().map(serde_json::Map::len), Some(6));
    let table = rain(&["model", "drop-shape", "diameter_mm=2"]);
    let text = String::from_utf8_lossy(&table.stdout).into_owned();
    assert_eq!(table.status.code(), Some(0));
    assert!(
        text.contains("axis_ratio") && text.contains("121.5") && text.contains("Hz"),
        "{text}"
    );
}

#[test]
fn models_are_listed() {
    let text = String::from_utf8_lossy(&rain(&["model"]).stdout).into_owned();
    for name in ["terminal-speed", "rainfall", "canopy", "waves", "weather"] {
        assert!(text.contains(&format!("{name}: ")), "{name} is not in: {text}");
    }
    let list = json(&["model", "--list", "--json"]);
    assert_eq!(list["models"].as_array().map(Vec::len), Some(15));
    let one = String::from_utf8_lossy(&rain(&["model", "--list", "fall"]).stdout).into_owned();
    assert!(one.starts_with("fall: ") && !one.contains("canopy: "), "{one}");
}

#[test]
fn bad_arguments_end_with_2_and_a_message() {
    refused(
        &["model", "terminal-speed", "diameter_mm=NaN"],
        &["rain: diameter_mm is NaN, allowed: 0 to 10 mm"],
    );
    refused(
        &["model", "terminal-speed", "diameter_mm=-1", "--json"],
        &["diameter_mm is -1", "0 to 10 mm"],
    );
    refused(&["model", "terminal-speed", "diameter_mm=inf"], &["diameter_mm is inf"]);
    refused(&["model", "terminal-speed"], &["diameter_mm is missing"]);
    refused(
        &["model", "terminal-speed", "diameter_mm=1", "size=2"],
        &["no key \"size\"", "diameter_mm, pressure_pa"],
    );
    refused(&["model", "fluxcapacitor"], &["fluxcapacitor", "terminal-speed"]);
    refused(
        &["model", "--list", "fluxcapacitor"],
        &["fluxcapacitor", "terminal-speed"],
    );
    refused(&["model", "fall", "--fast"], &["--fast"]);
}

#[test]
fn weather_reads_its_file() {
    let folder = folder();
    let storm = file(&folder, "storm.csv", b"time_s,intensity_mm_h\n0,0\n60,30\n120,0\n");
    let timeline = format!("timeline={storm}");
    let weather = json(&["model", "weather", &timeline, "duration_s=120", "step_s=60", "--json"]);
    let series = weather["series"].as_array().expect("a series");
    assert_eq!(series.len(), 3);
    near(&series[1]["time_s"], 60.0);
    near(&series[1]["intensity_mm_h"], 30.0);
    assert!(series[2]["wetness"].as_f64() > Some(0.0) && series[2]["water_level_mm"].is_number());
    near(&weather["budget"]["rain_mm"], 0.5);
    let bad = format!(
        "timeline={}",
        file(&folder, "bad.csv", b"time_s,intensity_mm_h\n0,1\n1,much\n")
    );
    refused(
        &["model", "weather", &bad, "duration_s=9", "step_s=1"],
        &["bad.csv: line 3, column 2", "much"],
    );
    refused(
        &["model", "weather", "timeline=gone.csv", "duration_s=9", "step_s=1"],
        &["gone.csv: "],
    );
}

#[test]
fn a_table_of_heights_is_baked() {
    let folder = folder();
    // A hollow of 3 × 1 cells, 1 m and twice 0.5 m below its spill level of 1 m, and a rim that is open to one side.
    let heights = file(
        &folder,
        "hollow.csv",
        b"9,9,9,9,9\n9,0.5,0,0.5,9\n9,9,1,9,9\n9,9,0.2,9,9\n",
    );
    let bake = json(&["bake", &heights, "--cell-m", "2", "--json"]);
    assert_eq!(bake["cells"], serde_json::json!([5, 4]));
    near(&bake["cell_m"], 2.0);
    let basins = bake["basins"].as_array().expect("basins");
    assert_eq!(basins.len(), 1, "{bake}");
    let basin = &basins[0];
    near(&basin["x_m"], 5.0);
    near(&basin["z_m"], 3.0);
    near(&basin["bottom_m"], 0.0);
    near(&basin["spill_m"], 1.0);
    near(&basin["volume_m3"], 8.0);
    near(&basin["area_m2"], 12.0);
    near(&bake["total_volume_m3"], 8.0);
    assert!(basin["parent"].is_null() && basin["overflows_to"].is_null(), "{basin}");
    // Shut in, all becomes one basin in the end, and that cannot spill.
    let closed = json(&["bake", &heights, "--cell-m", "2", "--closed", "--json"]);
    let top = closed["basins"]
        .as_array()
        .expect("basins")
        .iter()
        .filter(|b| b["parent"].is_null());
    let top: Vec<&Value> = top.collect();
    assert!(
        top.iter().any(|b| b["spill_m"].is_null() && b["volume_m3"].is_null()),
        "{closed}"
    );
    let text = String::from_utf8_lossy(&rain(&["bake", &heights]).stdout).into_owned();
    assert!(text.contains("5 × 4 cells") && text.contains("1 basins"), "{text}");
}

#[test]
fn a_flat_table_and_a_hole_hold_nothing() {
    let folder = folder();
    for (name, text) in [
        ("flat.csv", "1,1,1\n1,1,1\n1,1,1\n"),
        ("one.csv", "1\n"),
        ("hole.csv", "2,2,2\n2,NaN,2\n2,2,2\n"),
    ] {
        let bake = json(&["bake", &file(&folder, name, text.as_bytes()), "--json"]);
        assert_eq!(bake["basins"], serde_json::json!([]), "{name}");
        assert_eq!(bake["total_volume_m3"].to_string(), "0.0", "{name}");
    }
    // What is not flat to the last bit is a basin in a table, unless told otherwise.
    let uneven = file(&folder, "uneven.csv", b"1,1,1\n1,0.99999,1\n1,1,1\n");
    assert_eq!(
        json(&["bake", &uneven, "--json"])["basins"].as_array().map(Vec::len),
        Some(1)
    );
    let coarse = json(&["bake", &uneven, "--threshold-m", "0.0001", "--json"]);
    assert_eq!(coarse["basins"].as_array().map(Vec::len), Some(0));
}

#[test]
fn an_image_is_baked_at_its_scale() {
    let folder = folder();
    let path = folder.path().join("pit.png");
    // White rim, black pit.
    let image = image::ImageBuffer::from_fn(3, 3, |x, z| image::Luma([if (x, z) == (1, 1) { 0 } else { 65535_u16 }]));
    image.save(&path).expect("written");
    let bake = json(&[
        "bake",
        &path.to_string_lossy(),
        "--cell-m",
        "0.5",
        "--height-scale-m",
        "2",
        "--json",
    ]);
    near(&bake["total_volume_m3"], 2.0 * 0.25);
    near(&bake["basins"][0]["spill_m"], 2.0);
}

/// A mesh of the ground over a grid of knots, two triangles a square, as accessors and primitives want it.
fn ground(knots: u32, step: f32, height: impl Fn(f32, f32) -> f32) -> (Vec<u8>, Vec<u8>) {
    let (mut positions, mut indices) = (Vec::new(), Vec::new());
    for j in 0..knots {
        for i in 0..knots {
            let (x, z) = (i as f32 * step, j as f32 * step);
            for v in [x, height(x, z), z] {
                positions.extend(v.to_le_bytes());
            }
            if i + 1 < knots && j + 1 < knots {
                let a = j * knots + i;
                for corner in [a, a + knots, a + 1, a + 1, a + knots, a + knots + 1] {
                    indices.extend(corner.to_le_bytes());
                }
            }
        }
    }
    (positions, indices)
}

/// A GLB file of one mesh of ground under `nodes`, its second use (mesh 1) alpha-masked.
fn scene(knots: u32, step: f32, height: impl Fn(f32, f32) -> f32, nodes: &str) -> Vec<u8> {
    let (positions, indices) = ground(knots, step, height);
    let (points, corners) = (positions.len() / 12, indices.len() / 4);
    let roots = nodes.matches("\"mesh\"").count();
    let roots: Vec<String> = (0..roots).map(|i| i.to_string()).collect();
    let mesh = r#"{"attributes":{"POSITION":0},"indices":1"#;
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[{}]}}],"nodes":[{nodes}],
        "meshes":[{{"primitives":[{mesh}}}]}},{{"primitives":[{mesh},"material":0}}]}}],
        "materials":[{{"alphaMode":"MASK"}}],"buffers":[{{"byteLength":{}}}],
        "bufferViews":[{{"buffer":0,"byteLength":{}}},{{"buffer":0,"byteOffset":{},"byteLength":{}}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":{points},"type":"VEC3"}},
        {{"bufferView":1,"componentType":5125,"count":{corners},"type":"SCALAR"}}]}}"#,
        roots.join(","),
        positions.len() + indices.len(),
        positions.len(),
        positions.len(),
        indices.len(),
    );
    let mut text = json.into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let binary = [positions, indices].concat();
    let mut out = b"glTF\x02\0\0\0".to_vec();
    out.extend(((28 + text.len() + binary.len()) as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", text), (b"BIN\0", binary)] {
        out.extend((chunk.len() as u32).to_le_bytes());
        out.extend(kind);
        out.extend(chunk);
    }
    out
}

#[test]
fn a_scene_of_several_nodes_holds_the_water_of_its_hollows() {
    let folder = folder();
    // A bowl y = r²/2 − 1/2 inside r = 1, a flat rim at 0 around it: ∫ = −π/4 m³. Knots every 2⁻⁵ m from 0 to 4 m.
    let bowl = |x: f32, z: f32| {
        let r2 = (x - 2.0) * (x - 2.0) + (z - 2.0) * (z - 2.0);
        (0.5 * r2 - 0.5).min(0.0)
    };
    // One at its place and one 4 m along x, half as deep, mirrored; above both a masked sheet and a canopy.
    let nodes = r#"{"mesh":0},{"mesh":0,"translation":[8,0,0],"scale":[-1,0.5,1]},
        {"mesh":1,"translation":[0,3,0]},{"mesh":0,"name":"canopy","translation":[0,5,0]}"#;
    let path = file(&folder, "bowls.glb", &scene(129, 1.0 / 32.0, bowl, nodes));
    let bake = json(&["bake", &path, "--cell-m", "0.03125", "--json"]);
    assert_eq!(bake["cells"], serde_json::json!([256, 128]));
    let basins = bake["basins"].as_array().expect("basins");
    assert_eq!(basins.len(), 2, "{bake}");
    let quarter_pi = core::f64::consts::FRAC_PI_4;
    for (depth, centre, volume) in [(0.5, 2.0, quarter_pi), (0.25, 6.0, 0.5 * quarter_pi)] {
        let found = |b: &&Value| b["x_m"].as_f64().is_some_and(|x| (x - centre).abs() < 0.05);
        let basin = basins
            .iter()
            .find(found)
            .unwrap_or_else(|| panic!("no basin at x = {centre}: {bake}"));
        let get = |key: &str| basin[key].as_f64().unwrap_or_else(|| panic!("{key} in {basin}"));
        assert!(
            (get("z_m") - 2.0).abs() < 0.05 && get("spill_m").abs() < 1e-6,
            "{basin}"
        );
        assert!((get("bottom_m") + depth).abs() < 1e-3, "{basin}");
        // Cells of 3 cm sum a smooth bowl to better than a thousandth.
        assert!((get("volume_m3") / volume - 1.0).abs() < 1e-3, "{basin}");
        assert!((get("area_m2") / core::f64::consts::PI - 1.0).abs() < 0.04, "{basin}");
        assert!(basin["overflows_to"].is_null() && basin["parent"].is_null(), "{basin}");
    }
}

#[test]
fn bad_files_end_with_2_and_a_place() {
    let folder = folder();
    refused(&["bake", "no-such.csv"], &["no-such.csv"]);
    refused(
        &["bake", &file(&folder, "a.csv", b"1,2\n3,x\n")],
        &["a.csv: line 2, column 2", "\"x\""],
    );
    refused(
        &["bake", &file(&folder, "a.obj", b"v 0 0 0\n")],
        &["a.obj", ".glb, .gltf, .png, .csv"],
    );
    refused(
        &["bake", &file(&folder, "a.png", b"no image")],
        &["a.png", "cannot read the image"],
    );
    refused(
        &["bake", &file(&folder, "a.glb", b"glTF\x02\0\0\0\x03\0\0\0")],
        &["a.glb", "GLB"],
    );
    refused(&["bake", &file(&folder, "b.gltf", b"{")], &["b.gltf"]);
    let good = file(&folder, "good.csv", b"1,2\n3,4\n");
    for cell in ["0", "-1", "NaN", "inf", "1e9"] {
        refused(
            &["bake", &good, &format!("--cell-m={cell}")],
            &["cell_m", "0.0001 to 10000 m"],
        );
    }
    refused(&["bake", &good, "--threshold-m=NaN"], &["threshold_m"]);
    refused(&["bake"], &["FILE"]);
}

#[test]
fn real_models_are_baked() {
    let Some(assets) = std::env::var_os("RAIN_ASSETS").filter(|v| !v.is_empty()) else {
        eprintln!("skipped: RAIN_ASSETS names no folder of real models");
        return;
    };
    let assets: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(assets);
    // The fountain has a rim around its water, the truck an open bed; plain pavement has at most seams.
    for (name, least) in [
        ("pavement-fountain.glb", 1e-4),
        ("vehicle-truck-yellow.glb", 1e-2),
        ("grass.glb", 0.0),
        ("road-corner.glb", 0.0),
    ] {
        let path = assets.join(name);
        let bake = json(&["bake", &path.to_string_lossy(), "--cell-m", "0.02", "--json"]);
        let total = bake["total_volume_m3"].as_f64().expect("a number");
        assert!(total >= least && total < 1.0, "{name}: {total} m³");
        for basin in bake["basins"].as_array().expect("basins") {
            let get = |key: &str| basin[key].as_f64().unwrap_or_else(|| panic!("{key} in {basin}"));
            assert!(
                get("spill_m") > get("bottom_m") && get("volume_m3") > 0.0 && get("area_m2") > 0.0,
                "{basin}"
            );
        }
    }
}

#[test]
fn bench_runs_in_a_checkout_only() {
    let outside = folder();
    let output = Command::new(env!("CARGO_BIN_EXE_rain"))
        .args(["bench", "models", "--quick"])
        .current_dir(outside.path())
        .output()
        .expect("the program starts");
    let err = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{err}");
    assert!(err.contains("benches/models/Cargo.toml"), "{err}");
    // Without cargo it says so.
    let output = Command::new(env!("CARGO_BIN_EXE_rain"))
        .args(["bench", "models", "--only", "nothing"])
        .env("CARGO", "/no/such/cargo")
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("the program starts");
    let err = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{err}");
    assert!(err.contains("/no/such/cargo does not start"), "{err}");
    for (words, said) in [
        (["peers", "--counts", "10000,0"], "0 is not in 1..=1000000"),
        (["peers", "--rounds", "0"], "0 is not in 1..=1000"),
        (["peers", "--rounds", "1"], "/no/such/cargo does not start"),
    ] {
        let output = Command::new(env!("CARGO_BIN_EXE_rain"))
            .arg("bench")
            .args(words)
            .env("CARGO", "/no/such/cargo")
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .output()
            .expect("the program starts");
        let err = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{err}");
        assert!(err.contains(said), "{err}");
    }
}

#[test]
fn messages_name_the_line_that_an_editor_shows() {
    let folder = folder();
    for end in ["\n", "\r\n"] {
        let rain = [
            "# a storm",
            "",
            "time_s,intensity_mm_h",
            "0,1",
            "",
            "# then",
            "60,heavy",
        ]
        .join(end);
        let timeline = format!("timeline={}", file(&folder, "rain.csv", rain.as_bytes()));
        refused(
            &["model", "weather", &timeline, "duration_s=9", "step_s=1"],
            &["rain.csv: line 7, column 2: intensity_mm_h is \"heavy\""],
        );
        let heights = ["# heights", "9,9", "", "9,low"].join(end);
        refused(
            &["bake", &file(&folder, "heights.csv", heights.as_bytes())],
            &["heights.csv: line 4, column 2: the height is \"low\""],
        );
    }
}

#[test]
fn options_of_bake_are_checked_whatever_the_file() {
    let folder = folder();
    let path = file(&folder, "pit.csv", b"9,9,9\n9,1,9\n9,9,9\n");
    refused(
        &["bake", &path, "--cell-m", "-1"],
        &["cell_m is -1, allowed: 0.0001 to 10000 m"],
    );
    refused(
        &["bake", &path, "--height-scale-m", "nan"],
        &["height_scale_m is NaN, allowed: -1e7 to 1e7 m"],
    );
    refused(&["bake", &path, "--cell-m", "1e300"], &["cell_m is 1e300, allowed"]);
}
