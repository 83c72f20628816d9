//! Results on stdout, and what happens when they cannot be written.

use std::io::{self, ErrorKind, Write};
use std::process::ExitCode;

/// Prints a result and ends with `code`; where it cannot be written, says so on stderr and ends with 2.
///
/// A pipe that nobody reads any more (`rain model | head`) is no error. Where stdout was closed before the program
/// began, the standard library has put the null device in its place: then nothing fails.
#[must_use]
pub fn finish(text: &str, code: u8) -> ExitCode {
    written(write(&mut io::stdout(), text), code)
}

/// The exit code after writing to stdout, which would have been `code`.
#[must_use]
pub fn written(result: io::Result<()>, code: u8) -> ExitCode {
    match result {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            let _ = writeln!(io::stderr(), "rain: cannot write to stdout: {error}");
            ExitCode::from(2)
        }
        _ => ExitCode::from(code),
    }
}

fn write(out: &mut impl Write, text: &str) -> io::Result<()> {
    writeln!(out, "{text}")?;
    out.flush()
}
