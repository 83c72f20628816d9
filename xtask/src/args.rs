//! The command line: which task, and what is handed on to the program that the task runs.

/// Text printed by `cargo xtask help` and after a wrong argument.
pub const HELP: &str = "\
Usage: cargo xtask TASK

  demo [ARGS]  set up, build, render the storm on the generated street (ARGS go to `rain run`)
  test         set up, then run every test
  lint         formatting, clippy and rustdoc, warnings are errors
  ci           lint, then test
  setup        only make sure that a Vulkan driver is there
  help         this text

Environment: CARGO_TARGET_DIR, RAIN_ASSETS (folder of glTF models for the tests), VK_DRIVER_FILES.
";

/// What to do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Task {
    /// Render the storm; `extra` is handed on to `rain run`.
    Demo {
        /// Arguments for `rain run`, in order.
        extra: Vec<String>,
    },
    /// Every test.
    Test,
    /// Formatting, clippy, rustdoc.
    Lint,
    /// Lint, then test.
    Ci,
    /// Only the Vulkan driver.
    Setup,
    /// Print [`HELP`].
    Help,
}

/// Reads the arguments after the program's name. No argument means [`Task::Help`].
///
/// # Errors
/// An unknown task, or arguments for a task that takes none; the message names them.
pub fn parse(args: impl IntoIterator<Item = String>) -> Result<Task, String> {
    let mut args = args.into_iter();
    let Some(name) = args.next() else { return Ok(Task::Help) };
    let mut extra: Vec<String> = args.collect();
    if extra.first().is_some_and(|first| first == "--") {
        extra.remove(0);
    }
    let task = match name.as_str() {
        "demo" => return Ok(Task::Demo { extra }),
        "test" => Task::Test,
        "lint" => Task::Lint,
        "ci" => Task::Ci,
        "setup" => Task::Setup,
        "help" | "--help" | "-h" => Task::Help,
        other => return Err(format!("unknown task `{other}`")),
    };
    if extra.is_empty() {
        Ok(task)
    } else {
        Err(format!("`{name}` takes no arguments, got `{}`", extra.join(" ")))
    }
}

/// The value of the last `--name VALUE` or `--name=VALUE` in `args`.
pub fn option<'a>(args: &'a [String], name: &str) -> Option<&'a str> {
    let mut found = None;
    for (index, arg) in args.iter().enumerate() {
        if arg == name {
            found = args.get(index + 1).map(String::as_str);
        } else if let Some(value) = arg.strip_prefix(name).and_then(|rest| rest.strip_prefix('=')) {
            found = Some(value);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(line: &str) -> Vec<String> {
        line.split_whitespace().map(str::to_owned).collect()
    }

    #[test]
    fn every_task_in_the_help_is_parsed() {
        let listed: Vec<&str> = HELP
            .lines()
            .filter_map(|line| line.strip_prefix("  "))
            .filter_map(|line| line.split_whitespace().next())
            .collect();
        assert_eq!(listed, ["demo", "test", "lint", "ci", "setup", "help"]);
        for name in listed {
            assert!(parse(words(name)).is_ok(), "{name}");
        }
    }

    #[test]
    fn nothing_means_help() {
        assert_eq!(parse(words("")), Ok(Task::Help));
        assert_eq!(parse(words("--help")), Ok(Task::Help));
    }

    #[test]
    fn demo_hands_its_arguments_on() {
        let extra = words("--frames 3 --size 640x360");
        assert_eq!(
            parse(words("demo --frames 3 --size 640x360")),
            Ok(Task::Demo { extra: extra.clone() })
        );
        assert_eq!(
            parse(words("demo -- --frames 3 --size 640x360")),
            Ok(Task::Demo { extra })
        );
    }

    #[test]
    fn unknown_task_and_stray_arguments_are_named() {
        assert!(parse(words("dmeo")).unwrap_err().contains("`dmeo`"));
        assert!(parse(words("test --nocapture")).unwrap_err().contains("`--nocapture`"));
    }

    #[test]
    fn options_are_found_in_both_spellings_and_the_last_wins() {
        let args = words("--out a --seed 4 --out=b");
        assert_eq!(option(&args, "--out"), Some("b"));
        assert_eq!(option(&args, "--seed"), Some("4"));
        assert_eq!(option(&args, "--ou"), None);
        assert_eq!(option(&words("--out"), "--out"), None);
    }
}
