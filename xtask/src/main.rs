//! What a newcomer and CI run: `cargo xtask demo`, `cargo xtask test`, `cargo xtask lint`.
//!
//! Each command does its own set-up first, so it works on a machine that has Rust and nothing else. There are no
//! dependencies: this program compiles in a second or two. Messages go to stderr; the exit code is that of the step
//! that failed, 2 for wrong arguments, 3 where there is no Vulkan driver and none could be installed.

mod args;
mod driver;
mod platform;
mod steps;
mod tasks;

use std::io::Write as _;
use std::process::ExitCode;

use args::Task;

fn main() -> ExitCode {
    let task = match args::parse(std::env::args().skip(1)) {
        Ok(task) => task,
        Err(message) => {
            eprintln!("xtask: {message}\n\n{}", args::HELP);
            return ExitCode::from(2);
        }
    };
    let outcome = match task {
        Task::Help => std::io::stdout().write_all(args::HELP.as_bytes()).map_err(|_| 1),
        Task::Setup => driver::ensure(),
        Task::Demo { extra } => tasks::demo(&extra),
        Task::Test => tasks::test(),
        Task::Lint => tasks::lint(),
        Task::Ci => tasks::lint().and_then(|()| tasks::test()),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(code) => ExitCode::from(code),
    }
}
