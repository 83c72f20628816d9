//! Our side of `benches/peers/models.py`: works on numbers from a file, times its own work, hands the results back.
//!
//! `rain_peer WHAT IN OUT [NX NZ]`: IN and OUT are little-endian doubles; prints `{"seconds": …}`.
#![allow(clippy::print_stdout, reason = "a program's results")]

use std::hint::black_box;
use std::process::ExitCode;
use std::time::Instant;

use rain_core::rainfall::{BeardAir, terminal_velocity, terminal_velocity_f32};
use rain_core::surface::basins::{BakeOptions, Basins, Grid};

/// Seconds for `work` over all numbers, and its results, in memory that was touched before.
fn each<T: Copy>(numbers: &[T], touched: T, work: impl Fn(T) -> T) -> (f64, Vec<T>) {
    let mut out = vec![touched; numbers.len()];
    let (seconds, ()) = timed(|| {
        for (out, number) in out.iter_mut().zip(numbers) {
            *out = work(*number);
        }
    });
    (seconds, out)
}

/// Seconds that `work` takes, and what it returns.
fn timed<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let start = Instant::now();
    let result = black_box(work());
    (start.elapsed().as_secs_f64(), result)
}

fn run(arguments: &[String]) -> Result<(), String> {
    let [what, source, result, size @ ..] = arguments else {
        return Err("rain_peer WHAT IN OUT [NX NZ]".to_owned());
    };
    let bytes = std::fs::read(source).map_err(|error| format!("{source}: {error}"))?;
    let numbers: Vec<f64> = bytes
        .chunks_exact(8)
        .map(|chunk| f64::from_le_bytes(chunk.try_into().unwrap_or_default()))
        .collect();
    let (seconds, out) = match what.as_str() {
        "speed" => each(&numbers, 1.0, terminal_velocity),
        "speed-f32" => {
            let diameters: Vec<f32> = numbers.iter().map(|d| *d as f32).collect();
            let (seconds, speeds) = timed(|| {
                diameters
                    .iter()
                    .map(|d| terminal_velocity_f32(*d))
                    .collect::<Vec<f32>>()
            });
            (seconds, speeds.into_iter().map(f64::from).collect())
        }
        "beard" => {
            let air = BeardAir::standard();
            each(&numbers, 1.0, |d| air.terminal_velocity(d))
        }
        "bake" => {
            let [nx, nz] = size else {
                return Err("bake needs NX and NZ".to_owned());
            };
            let count = |text: &String| text.parse::<usize>().map_err(|error| format!("{text}: {error}"));
            let grid = Grid::new(count(nx)?, count(nz)?, 1.0, &numbers);
            // Every pit counts, as with the others.
            let options = BakeOptions {
                threshold_m: 0.0,
                ..BakeOptions::default()
            };
            let (seconds, basins) = timed(|| Basins::bake(&grid, &options));
            let basins = basins.map_err(|error| error.to_string())?;
            (seconds, basins.filled(&numbers).map_err(|error| error.to_string())?)
        }
        other => return Err(format!("`{other}` is none of speed, speed-f32, beard, bake")),
    };
    let bytes: Vec<u8> = out.iter().flat_map(|value| value.to_le_bytes()).collect();
    std::fs::write(result, bytes).map_err(|error| format!("{result}: {error}"))?;
    println!("{{\"seconds\": {seconds:e}}}");
    Ok(())
}

fn main() -> ExitCode {
    match run(&std::env::args().skip(1).collect::<Vec<_>>()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::from(2)
        }
    }
}
