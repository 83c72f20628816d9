//! `rain check`.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use quick_junit::{NonSuccessKind, Report as JunitReport, TestCase, TestCaseStatus, TestSuite};
use rain_cli::print;
use rain_plugins::scenario::RunOptions;

#[derive(Debug, Args)]
pub struct CheckArgs {
    /// Scenario files, or folders that hold some.
    #[arg(required = true)]
    paths: Vec<PathBuf>,
    /// Where relative scene files are looked up (default: beside each scenario).
    #[arg(long)]
    assets: Option<PathBuf>,
    /// Where results go, one folder a scenario (default: target/check).
    #[arg(long, default_value = "target/check")]
    out: PathBuf,
    /// Write a JUnit XML file.
    #[arg(long)]
    junit: Option<PathBuf>,
    /// Print one JSON object on stdout.
    #[arg(long)]
    json: bool,
}

/// One checked line: a scenario's expectation, or a scenario that could not be run.
struct Row {
    scenario: String,
    text: String,
    passed: bool,
    detail: String,
}

/// Runs every scenario and prints `N passed, N failed`.
pub fn check(args: &CheckArgs) -> ExitCode {
    let scenarios = match collect(&args.paths) {
        Ok(list) if list.is_empty() => {
            let _ = writeln!(std::io::stderr(), "rain: no scenario (*.ron) in the paths given");
            return ExitCode::from(2);
        }
        Ok(list) => list,
        Err(message) => {
            let _ = writeln!(std::io::stderr(), "rain: {message}");
            return ExitCode::from(2);
        }
    };
    let mut rows = Vec::new();
    // The worst code wins: a device that is missing, then bad input, then an expectation that failed.
    let mut code = 0;
    for path in &scenarios {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let options = RunOptions {
            out: args.out.join(&name),
            assets: args.assets.clone(),
            ..RunOptions::default()
        };
        match super::run::execute(path, &options) {
            Ok(report) => {
                for e in &report.expectations {
                    rows.push(Row {
                        scenario: name.clone(),
                        text: e.text.clone(),
                        passed: e.passed,
                        detail: format!("value {}, expected {}", e.value, e.wanted()),
                    });
                }
                if report.expectations.is_empty() {
                    rows.push(Row {
                        scenario: name.clone(),
                        text: "runs".into(),
                        passed: true,
                        detail: String::new(),
                    });
                }
                code = code.max(u8::from(!report.passed()));
            }
            Err(error) => {
                code = code.max(error.exit_code());
                rows.push(Row {
                    scenario: name.clone(),
                    text: "runs".into(),
                    passed: false,
                    detail: error.to_string(),
                });
            }
        }
    }
    let failed = rows.iter().filter(|r| !r.passed).count();
    let passed = rows.len() - failed;
    if let Some(file) = &args.junit
        && let Err(error) = write_junit(file, &rows)
    {
        let _ = writeln!(std::io::stderr(), "rain: cannot write {}: {error}", file.display());
        code = code.max(2);
    }
    let text = if args.json {
        let list: Vec<_> = rows
            .iter()
            .map(
                |r| serde_json::json!({"scenario": r.scenario, "text": r.text, "passed": r.passed, "detail": r.detail}),
            )
            .collect();
        serde_json::json!({"passed": passed, "failed": failed, "rows": list}).to_string()
    } else {
        let mut text = String::new();
        for r in &rows {
            let mark = if r.passed { "ok  " } else { "FAIL" };
            // Writing to a string cannot fail.
            let _ = writeln!(text, "{mark} {}: {} {}", r.scenario, r.text, r.detail);
        }
        text + &format!("{passed} passed, {failed} failed")
    };
    print::finish(&text, code)
}

/// Every scenario of the paths, folders searched to the bottom, sorted.
fn collect(paths: &[PathBuf]) -> Result<BTreeSet<PathBuf>, String> {
    let mut found = BTreeSet::new();
    for path in paths {
        if path.is_dir() {
            search(path, &mut found)?;
        } else if path.is_file() {
            found.insert(path.clone());
        } else {
            return Err(format!("{}: not there", path.display()));
        }
    }
    Ok(found)
}

fn search(folder: &Path, found: &mut BTreeSet<PathBuf>) -> Result<(), String> {
    let wrong = |e: std::io::Error| format!("{}: {e}", folder.display());
    for entry in std::fs::read_dir(folder).map_err(wrong)? {
        let path = entry.map_err(wrong)?.path();
        if path.is_dir() {
            search(&path, found)?;
        } else if path.extension().is_some_and(|e| e == "ron") {
            found.insert(path);
        }
    }
    Ok(())
}

fn write_junit(file: &Path, rows: &[Row]) -> Result<(), String> {
    let mut report = JunitReport::new("rain check");
    let names: BTreeSet<&str> = rows.iter().map(|r| r.scenario.as_str()).collect();
    for name in names {
        let mut suite = TestSuite::new(name);
        for row in rows.iter().filter(|r| r.scenario == name) {
            let status = if row.passed {
                TestCaseStatus::success()
            } else {
                let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
                status.set_message(row.detail.clone());
                status
            };
            suite.add_test_case(TestCase::new(row.text.clone(), status));
        }
        report.add_test_suite(suite);
    }
    let xml = report.to_string().map_err(|e| e.to_string())?;
    // Written aside and renamed: a cut-off file must not look whole.
    let aside = file.with_extension("xml.unfinished");
    std::fs::write(&aside, xml).map_err(|e| e.to_string())?;
    std::fs::rename(&aside, file).map_err(|e| e.to_string())
}
