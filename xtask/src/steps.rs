//! Runs programs one after the other, timed, and says at the end how long each took.

use std::process::Command;
use std::time::{Duration, Instant};

/// A list of steps that ran, with their times; prints its table when dropped, so also after a failure.
#[derive(Debug, Default)]
pub struct Steps {
    done: Vec<(String, Duration, bool)>,
}

impl Steps {
    /// Runs `command` and waits for it.
    ///
    /// # Errors
    /// The exit code of the program (1 where a signal ended it or it did not start), after a message.
    pub fn run(&mut self, name: &str, command: &mut Command) -> Result<(), u8> {
        eprintln!("\nxtask: {name}: {}", line(command));
        let start = Instant::now();
        let outcome = match command.status() {
            Ok(status) if status.success() => Ok(()),
            Ok(status) => {
                eprintln!("xtask: {name} failed ({status})");
                Err(code(status.code()))
            }
            Err(error) => {
                eprintln!(
                    "xtask: {} did not start: {error}",
                    command.get_program().to_string_lossy()
                );
                Err(1)
            }
        };
        self.done.push((name.to_owned(), start.elapsed(), outcome.is_ok()));
        outcome
    }

    /// One line per step: name, seconds, and a word where it failed.
    fn table(&self) -> String {
        let width = self
            .done
            .iter()
            .map(|(name, ..)| name.chars().count())
            .max()
            .unwrap_or(0);
        let mut text = String::new();
        for (name, time, passed) in &self.done {
            let mark = if *passed { "" } else { "  failed" };
            text += &format!("  {name:width$} {:8.1} s{mark}\n", time.as_secs_f64());
        }
        text
    }
}

impl Drop for Steps {
    fn drop(&mut self) {
        if !self.done.is_empty() {
            eprint!("\nxtask: times\n{}", self.table());
        }
    }
}

/// A child's exit code as ours: never 0 after a failure, whatever its width on this system.
fn code(child: Option<i32>) -> u8 {
    child
        .and_then(|code| u8::try_from(code).ok())
        .filter(|code| *code != 0)
        .unwrap_or(1)
}

/// The command as one would type it (for reading, not quoted for a shell).
fn line(command: &Command) -> String {
    std::iter::once(command.get_program())
        .chain(command.get_args())
        .map(|word| word.to_string_lossy())
        .collect::<Vec<_>>()
        .join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exit_codes_are_handed_on() {
        assert_eq!(code(Some(101)), 101);
        assert_eq!(code(Some(3)), 3);
        assert_eq!(code(None), 1);
        assert_eq!(code(Some(-1_073_741_819)), 1);
        assert_eq!(code(Some(256)), 1);
    }

    #[test]
    fn a_failing_program_gives_its_code_and_is_listed() {
        let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        let mut steps = Steps::default();
        assert_eq!(steps.run("version", Command::new(&cargo).arg("--version")), Ok(()));
        assert_eq!(
            steps.run("nonsense", Command::new(&cargo).arg("--no-such-flag")),
            Err(1)
        );
        assert_eq!(steps.run("absent", &mut Command::new("no-such-program-at-all")), Err(1));
        let table = steps.table();
        assert_eq!(table.lines().count(), 3, "{table}");
        assert_eq!(table.matches("failed").count(), 2, "{table}");
        assert!(!table.lines().next().unwrap().contains("failed"), "{table}");
    }

    #[test]
    fn the_line_reads_like_a_command() {
        assert_eq!(line(Command::new("cargo").args(["fmt", "--all"])), "cargo fmt --all");
    }
}
