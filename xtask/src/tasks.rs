//! The tasks: what each runs, in which order, with which environment.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::args;
use crate::driver;
use crate::steps::Steps;

/// The workspace always builds with this one feature set, so that Bevy compiles once.
const WORKSPACE: [&str; 2] = ["--workspace", "--all-features"];

/// The scenario that the demo renders, relative to the repository.
const STORM: &str = "examples/scenarios/storm_street.ron";

/// The repository's folder.
fn root() -> PathBuf {
    let xtask = std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_else(|| env!("CARGO_MANIFEST_DIR").into());
    Path::new(&xtask)
        .parent()
        .map_or_else(|| PathBuf::from("."), Path::to_path_buf)
}

/// Where cargo builds: `CARGO_TARGET_DIR` (relative to the folder one is in), else `target` in the repository.
fn target_dir(root: &Path, here: &Path, variable: Option<OsString>) -> PathBuf {
    match variable.filter(|dir| !dir.is_empty()) {
        Some(dir) => here.join(dir),
        None => root.join("target"),
    }
}

/// The folder with real glTF models that stands beside a clone, where there is one.
fn assets_beside(root: &Path) -> Option<PathBuf> {
    let assets = root.parent()?.join("shared").join("assets");
    assets.is_dir().then_some(assets)
}

/// `cargo` in the repository. On CI the lock file must be complete.
fn cargo(root: &Path, subcommand: &str) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.current_dir(root).arg(subcommand);
    if is_ci(std::env::var("CI").ok().as_deref()) && subcommand != "fmt" {
        command.arg("--locked");
    }
    command
}

/// Whether the value of `CI` means that this is a CI run.
fn is_ci(value: Option<&str>) -> bool {
    value.is_some_and(|value| !matches!(value, "" | "0" | "false"))
}

/// The environment in which programs that draw run: a private runtime folder, which Mesa and winit ask for.
fn drawing<'a>(command: &'a mut Command, target: &Path) -> &'a mut Command {
    if cfg!(target_os = "linux") && std::env::var_os("XDG_RUNTIME_DIR").is_none() {
        let dir = target.join("runtime");
        if private_dir(&dir).is_ok() {
            command.env("XDG_RUNTIME_DIR", dir);
        }
    }
    command
}

/// Makes a folder that only its owner can enter.
#[cfg(unix)]
fn private_dir(dir: &Path) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt as _;
    std::fs::create_dir_all(dir)?;
    std::fs::set_permissions(dir, std::fs::Permissions::from_mode(0o700))
}

/// Makes a folder.
#[cfg(not(unix))]
fn private_dir(dir: &Path) -> std::io::Result<()> {
    std::fs::create_dir_all(dir)
}

/// The folder one is in.
fn here(root: &Path) -> PathBuf {
    std::env::current_dir().unwrap_or_else(|_| root.to_path_buf())
}

/// Builds, generates the street, renders the storm on it. `extra` goes to `rain run`; `--out` and `--assets` in it
/// replace the demo's own folders.
///
/// # Errors
/// The exit code of the step that failed.
pub fn demo(extra: &[String]) -> Result<(), u8> {
    driver::ensure()?;
    let root = root();
    let here = here(&root);
    let target = target_dir(&root, &here, std::env::var_os("CARGO_TARGET_DIR"));
    let out = args::option(extra, "--out").map_or_else(|| target.join("demo"), |dir| here.join(dir));
    let scene = target.join("demo").join("scene");
    let program = |name: &str| {
        target
            .join("debug")
            .join(format!("{name}{}", std::env::consts::EXE_SUFFIX))
    };

    let mut steps = Steps::default();
    steps.run("build", cargo(&root, "build").args(WORKSPACE).arg("--bins"))?;
    if out == target.join("demo") && out.exists() {
        // Pictures of an earlier run would mix with those of this one.
        if let Err(error) = std::fs::remove_dir_all(&out) {
            eprintln!("xtask: cannot empty {}: {error}", out.display());
            return Err(1);
        }
    }
    steps.run("street", Command::new(program("street")).arg(&scene))?;
    let mut rain = Command::new(program("rain"));
    rain.arg("run").arg(root.join(STORM));
    if args::option(extra, "--assets").is_none() {
        rain.arg("--assets").arg(&scene);
    }
    if args::option(extra, "--out").is_none() {
        rain.arg("--out").arg(&out);
    }
    let outcome = steps.run("storm", drawing(rain.args(extra), &target));
    drop(steps);
    if out.join("report.json").is_file() {
        eprintln!(
            "\nxtask: pictures, contact.png, timeline.png and report.json are in {}",
            out.display()
        );
    }
    outcome
}

/// Every test: unit and integration tests of the workspace, then the documentation's examples. Tests that draw fail
/// where there is no adapter, since set-up has made sure of one.
///
/// # Errors
/// The exit code of the step that failed.
pub fn test() -> Result<(), u8> {
    driver::ensure()?;
    let root = root();
    let target = target_dir(&root, &here(&root), std::env::var_os("CARGO_TARGET_DIR"));
    let mut steps = Steps::default();
    let mut tests = cargo(&root, "test");
    tests
        .args(WORKSPACE)
        // All that fails is told at once: a run takes minutes.
        .args(["--lib", "--bins", "--tests", "--no-fail-fast"])
        .env("RAIN_GPU", "required")
        // With RUST_BACKTRACE set, wgpu-core would take one for every lock; panics have theirs all the same.
        .env("RUST_LIB_BACKTRACE", "0");
    let mut doc_tests = cargo(&root, "test");
    // The whole workspace: with `-p` features would differ, and Bevy would be compiled once more.
    doc_tests.args(WORKSPACE).arg("--doc");
    if std::env::var_os("RAIN_ASSETS").is_none()
        && let Some(assets) = assets_beside(&root)
    {
        eprintln!("xtask: real models from {}", assets.display());
        tests.env("RAIN_ASSETS", &assets);
    }
    // A test starts the `rain` program, which `cargo test` alone would not build.
    steps.run("programs", cargo(&root, "build").args(WORKSPACE).arg("--bins"))?;
    steps.run("tests", drawing(&mut tests, &target))?;
    steps.run("doc tests", drawing(&mut doc_tests, &target))
}

/// Formatting, clippy, rustdoc; the cheapest first.
///
/// # Errors
/// The exit code of the step that failed.
pub fn lint() -> Result<(), u8> {
    let root = root();
    let mut steps = Steps::default();
    steps.run("fmt", cargo(&root, "fmt").args(["--all", "--check"]))?;
    steps.run(
        "clippy",
        cargo(&root, "clippy")
            .args(WORKSPACE)
            .args(["--all-targets", "--", "-D", "warnings"]),
    )?;
    let mut flags = std::env::var_os("RUSTDOCFLAGS").unwrap_or_default();
    flags.push(" -D warnings");
    steps.run(
        "rustdoc",
        cargo(&root, "doc")
            .args(WORKSPACE)
            .arg("--no-deps")
            .env("RUSTDOCFLAGS", flags),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_root_is_the_repository() {
        assert!(root().join("xtask").join("src").join("tasks.rs").is_file());
    }

    #[test]
    fn the_target_folder_follows_the_variable() {
        let (root, here) = (Path::new("/repo"), Path::new("/home/me"));
        assert_eq!(target_dir(root, here, None), Path::new("/repo/target"));
        assert_eq!(target_dir(root, here, Some(OsString::new())), Path::new("/repo/target"));
        assert_eq!(target_dir(root, here, Some("out".into())), Path::new("/home/me/out"));
        assert_eq!(target_dir(root, here, Some("/fast/out".into())), Path::new("/fast/out"));
    }

    #[test]
    fn ci_is_told_from_a_desk() {
        assert!(is_ci(Some("true")) && is_ci(Some("1")));
        assert!(!is_ci(None) && !is_ci(Some("")) && !is_ci(Some("false")) && !is_ci(Some("0")));
    }

    #[test]
    fn models_are_found_only_where_they_are() {
        let base = std::env::temp_dir().join(format!("xtask-assets-{}", std::process::id()));
        let clone = base.join("clone");
        std::fs::create_dir_all(&clone).unwrap();
        let before = assets_beside(&clone);
        let assets = base.join("shared").join("assets");
        std::fs::create_dir_all(&assets).unwrap();
        let after = assets_beside(&clone);
        std::fs::remove_dir_all(&base).unwrap();
        assert_eq!(before, None);
        assert_eq!(after, Some(assets));
    }
}
