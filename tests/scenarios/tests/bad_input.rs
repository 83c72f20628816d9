//! What is wrong with the input is said with its place, ends with the right exit code, and leaves no report.

use std::path::{Path, PathBuf};
use std::process::Command;

use rain_plugins::scenario::{RunError, RunOptions, Scenario, run};
use tempfile::TempDir;
use test_support::{assets, gpu};

/// A folder with a scenario of this text, and where its results would go.
struct Input {
    folder: TempDir,
}

impl Input {
    fn new(text: &str) -> Self {
        let folder = TempDir::new().expect("a temporary folder");
        std::fs::write(folder.path().join("scenario.ron"), text).expect("the scenario is written");
        Self { folder }
    }

    fn file(self, name: &str, bytes: &[u8]) -> Self {
        std::fs::write(self.folder.path().join(name), bytes).expect("a file is written");
        self
    }

    fn scenario(&self) -> PathBuf {
        self.folder.path().join("scenario.ron")
    }

    fn out(&self) -> PathBuf {
        self.folder.path().join("out")
    }

    /// Runs it as the program does; `change` edits the options.
    fn run(&self, change: impl FnOnce(&mut RunOptions)) -> Result<(), RunError> {
        let mut options = RunOptions {
            out: self.out(),
            ..RunOptions::default()
        };
        change(&mut options);
        let scenario = Scenario::load(self.scenario())?;
        run(scenario, &options, |_| {}).map(|_| ())
    }

    /// Asserts that it is refused as bad input with all of `words` in the message, and that no report is left.
    fn refused(&self, words: &[&str]) {
        self.refused_with(words, |_| {});
    }

    fn refused_with(&self, words: &[&str], change: impl FnOnce(&mut RunOptions)) {
        let error = self.run(change).expect_err("bad input is refused");
        let message = error.to_string();
        assert_eq!(error.exit_code(), 2, "{message}");
        for word in words {
            assert!(message.contains(word), "`{word}` is not in: {message}");
        }
        let left = leftovers(&self.out());
        assert!(left.is_empty(), "left in the output folder: {left:?}");
    }
}

/// Files of a run in its output folder.
fn leftovers(out: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(out).into_iter().flatten().flatten();
    entries.map(|e| e.file_name().to_string_lossy().into_owned()).collect()
}

/// A scenario that runs, small and short.
const GOOD: &str =
    "(duration_s: 2, captures: Times([1]), outputs: (size: (16, 9), contact_sheet: false, timeline: false))";

#[test]
fn good_input_leaves_a_report() {
    if !gpu::available() {
        return;
    }
    let input = Input::new(GOOD);
    input.run(|_| {}).expect("a run");
    let mut left = leftovers(&input.out());
    left.sort();
    assert_eq!(left, ["frame_0000.png", "report.json"]);
    // A later run that fails takes the report of the earlier one with it: nothing that looks whole is left.
    std::fs::write(
        input.scenario(),
        GOOD.replace("duration_s: 2", "duration_s: 2, scene: \"gone.glb\""),
    )
    .expect("a file");
    assert_eq!(input.run(|_| {}).map_err(|e| e.exit_code()), Err(2));
    assert_eq!(leftovers(&input.out()), Vec::<String>::new());
}

#[test]
fn broken_ron_is_refused_with_line_and_column() {
    Input::new("(\n  duration_s: 2,\n  captres: Times([1]),\n)").refused(&["scenario.ron:3:", "captres"]);
    Input::new("(\n  duration_s: 2 3,\n)").refused(&["scenario.ron:2:"]);
    Input::new("").refused(&["scenario.ron:1:1"]);
}

#[test]
fn numbers_out_of_range_are_refused_with_field_value_and_place() {
    for (text, words) in [
        ("(\n  duration_s: NaN,\n)", ["scenario.ron:2:", "duration_s", "NaN"]),
        ("(\n  duration_s: -5,\n)", ["scenario.ron:2:", "duration_s", "-5"]),
        (
            "(\n\n  rain: (exposure_s: inf),\n)",
            ["scenario.ron:3:", "rain.exposure_s", "inf"],
        ),
        (
            "(\n  weather: (keys: [(time_s: 0, intensity_mm_h: -1)]),\n)",
            ["scenario.ron:2:", "intensity_mm_h", "-1"],
        ),
        (
            "(\n  outputs: (size: (0, 0)),\n)",
            ["scenario.ron:2:", "outputs.size", "0"],
        ),
        (
            "(\n  outputs: (size: (99999, 9)),\n)",
            ["scenario.ron:2:", "outputs.size", "99999"],
        ),
        (
            "(\n  rain: (streak_budget: 4000001),\n)",
            ["scenario.ron:2:", "streak_budget", "4000001"],
        ),
        (
            "(\n  captures: Even(start_s: 0, end_s: 1, count: 4000000000),\n)",
            ["scenario.ron:2:", "captures", "4000000000"],
        ),
        (
            "(\n  warm_up_frames: 4000000,\n)",
            ["scenario.ron:2:", "warm_up_frames", "4000000"],
        ),
        (
            "(\n  captures: Times([1e300]),\n)",
            ["scenario.ron:2:", "captures", "1000000"],
        ),
    ] {
        Input::new(text).refused(&words);
    }
}

#[test]
fn a_broken_weather_table_is_refused_with_its_line() {
    let text = "(duration_s: 9, weather: (csv: \"rain.csv\"))";
    let table = |rows: &str| format!("time_s,intensity_mm_h\n{rows}");
    let refused = |rows: &str, words: &[&str]| Input::new(text).file("rain.csv", table(rows).as_bytes()).refused(words);
    refused("0,5\n60,wet\n", &["rain.csv:3", "wet"]);
    refused("0,5\n60,NaN\n", &["rain.csv:3"]);
    refused("0,5\n60,-2\n", &["rain.csv:3", "-2"]);
    refused("60,5\n0,1\n", &["rain.csv:3"]);
    Input::new(text).refused(&["rain.csv"]);
}

#[test]
fn missing_and_broken_models_are_refused_by_name() {
    let text = GOOD.replacen('(', "(scene: \"model.glb\", ", 1);
    Input::new(&text).refused(&["model.glb"]);
    Input::new(&text).file("model.glb", b"").refused(&["model.glb"]);
    Input::new(&text)
        .file("model.glb", b"not a model at all")
        .refused(&["model.glb", "glTF"]);
    // A real file, cut in its middle.
    let (folder, _) = assets::street_folder();
    let whole = std::fs::read(folder.join(street::CAR_FILE)).expect("the car");
    for share in [2, 50] {
        let cut = &whole[..whole.len() * share / 100];
        Input::new(&text).file("model.glb", cut).refused(&["model.glb"]);
    }
}

#[test]
fn a_drain_beside_the_scene_is_refused_by_its_place() {
    let text = GOOD.replacen('(', "(scene: \"car.glb\", drains: [(position: (500, 0))], ", 1);
    let (folder, _) = assets::street_folder();
    let car = std::fs::read(folder.join(street::CAR_FILE)).expect("the car");
    Input::new(&text).file("car.glb", &car).refused(&["ground", "500"]);
}

#[test]
fn settings_beside_the_scenario_are_checked_as_well() {
    let input = Input::new(GOOD);
    input.refused_with(&["size", "0"], |o| o.size = Some([0, 0]));
    input.refused_with(&["--frames", "0"], |o| o.frames = Some(0));
    input.refused_with(&["--frames", "4000000000"], |o| o.frames = Some(4_000_000_000));
    input.refused_with(&["gone.glb"], |o| o.scene = Some("gone.glb".into()));
}

#[test]
fn an_output_folder_that_cannot_be_written_is_refused_by_name() {
    let input = Input::new(GOOD).file("taken", b"a file stands where the folder should be");
    let taken = input.folder.path().join("taken");
    for out in [taken.clone(), taken.join("deeper")] {
        let error = input.run(|o| o.out = out.clone()).expect_err("no folder");
        assert_eq!(error.exit_code(), 2, "{error}");
        assert!(error.to_string().contains("taken"), "{error}");
    }
    assert!(taken.is_file(), "the file that was there is still there");
}

/// The `rain` program that was built beside this test.
fn program() -> PathBuf {
    let test = std::env::current_exe().expect("this program");
    let debug = test.ancestors().nth(2).expect("target/debug/deps/…");
    let program = debug.join(format!("rain{}", std::env::consts::EXE_SUFFIX));
    assert!(
        program.is_file(),
        "{} is not built: test the whole workspace",
        program.display()
    );
    program
}

#[test]
fn the_program_exits_with_2_on_bad_input_and_3_without_a_graphics_device_and_leaves_no_report() {
    let run = |input: &Input, no_driver: bool| {
        let mut command = Command::new(program());
        command
            .arg("run")
            .arg(input.scenario())
            .arg("--out")
            .arg(input.out())
            .arg("--json");
        if no_driver {
            // No Vulkan driver and nothing to fall back to.
            for variable in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"] {
                command.env(variable, "/nonexistent/driver.json");
            }
        }
        command.output().expect("the program starts")
    };
    let without_device = Input::new(GOOD);
    let output = run(&without_device, true);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(3), "{message}");
    assert!(message.contains("Vulkan driver"), "{message}");
    assert!(output.stdout.is_empty(), "nothing on stdout");
    assert_eq!(leftovers(&without_device.out()), Vec::<String>::new());

    let bad = Input::new("(\n  duration_s: NaN,\n)");
    let output = run(&bad, false);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(
        message.contains("scenario.ron:2:") && message.contains("duration_s"),
        "{message}"
    );
    assert!(output.stdout.is_empty() && leftovers(&bad.out()).is_empty());

    // The same good input with the device that is here.
    if gpu::available() {
        let output = run(&without_device, false);
        assert_eq!(
            output.status.code(),
            Some(0),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON on stdout");
        assert_eq!(report["frames"], 1);
        assert!(without_device.out().join("report.json").is_file());
    }
}
