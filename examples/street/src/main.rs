//! Writes the generated street: `street OUT_DIR [SEED]`.

use std::io::Write;
use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let mut args = std::env::args().skip(1);
    let (dir, seed) = (args.next(), args.next());
    let seed = seed.map_or(Ok(street::DEFAULT_SEED), |s| s.parse());
    // What looks like an option is no folder.
    let dir = dir.filter(|dir| !dir.starts_with('-'));
    let (Some(dir), Ok(seed)) = (dir, seed) else {
        report("usage: street OUT_DIR [SEED]; SEED is a whole number from 0 to 2^64 - 1, default 7");
        return ExitCode::from(2);
    };
    match street::generate(Path::new(&dir), seed) {
        Ok(_) => {
            report(&format!(
                "wrote {}, {}, {} and {} to {dir}",
                street::STREET_FILE,
                street::CAR_FILE,
                street::COURT_FILE,
                street::PLAIN_FILE
            ));
            ExitCode::SUCCESS
        }
        Err(e) => {
            report(&format!("street: {e}"));
            ExitCode::from(1)
        }
    }
}

/// A line on stderr; a closed stderr is no reason to fail.
fn report(line: &str) {
    let _ = writeln!(std::io::stderr(), "{line}");
}
