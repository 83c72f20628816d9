//! What is fed, and what counts as a failure.

use std::panic::{AssertUnwindSafe, catch_unwind};

use rain_core::surface::height_field::{HeightField, ImportLimits};
use rain_core::weather::{WeatherConditions, read_hyetograph};

use crate::repair::repair;

/// Limits of imports under test: small, so that what they bound shows.
pub const LIMITS: ImportLimits = ImportLimits {
    cells: 1 << 16,
    triangles: 1 << 12,
    bytes: 1 << 20,
};

/// Memory that any input may take, and more for each of its bytes. Units: bytes.
pub const MEMORY: u64 = 32 << 20;
/// Memory for each byte of input (a parsed JSON value is a hundred times its text). Units: bytes.
pub const MEMORY_PER_BYTE: u64 = 512;

/// Something that reads what others wrote.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Target {
    /// Rain rates over time.
    Hyetograph,
    /// A table of heights.
    Csv,
    /// An image of heights.
    Png,
    /// A scene.
    Gltf,
    /// Arguments of `rain model`, one a line.
    Model,
}

impl Target {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Hyetograph, Self::Csv, Self::Png, Self::Gltf, Self::Model];

    /// Its name on the command line and in `regressions/`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Hyetograph => "hyetograph",
            Self::Csv => "csv",
            Self::Png => "png",
            Self::Gltf => "gltf",
            Self::Model => "model",
        }
    }

    /// The target of this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|target| target.name() == name)
    }

    /// Feeds it. Returns whether the input was taken for valid.
    ///
    /// # Panics
    /// Never, or the code under test has a fault.
    #[must_use]
    pub fn run(self, bytes: &[u8]) -> bool {
        match self {
            Self::Hyetograph => hyetograph(bytes),
            Self::Csv => csv(bytes),
            Self::Png => png(bytes),
            Self::Gltf => gltf(bytes),
            Self::Model => model(bytes),
        }
    }
}

/// A hyetograph, read and asked.
fn hyetograph(bytes: &[u8]) -> bool {
    match read_hyetograph(bytes, &WeatherConditions::default()) {
        Ok(timeline) => {
            let mean = timeline.mean_conditions(-10.0, 1000.0).expect("times in the domain");
            assert!(mean.intensity_mm_h.is_finite() && mean.validated().is_ok(), "{mean:?}");
            true
        }
        Err(error) => {
            assert!(error.line >= 1 && error.column >= 1, "{error}");
            false
        }
    }
}

/// What must hold of any height field that was taken for valid.
fn field_holds(field: &HeightField) {
    let [nx, nz] = field.cells();
    assert_eq!(field.heights().len(), nx * nz);
    assert!(nx * nz <= LIMITS.cells);
    assert!(field.heights().iter().all(|h| !h.is_infinite()));
}

fn csv(bytes: &[u8]) -> bool {
    let result = HeightField::from_csv(bytes, 0.5, &LIMITS);
    result.is_ok_and(|field| {
        field_holds(&field);
        true
    })
}

fn png(bytes: &[u8]) -> bool {
    let result = HeightField::from_png(bytes, 0.5, 10.0, &LIMITS);
    result.is_ok_and(|field| {
        field_holds(&field);
        true
    })
}

fn gltf(bytes: &[u8]) -> bool {
    let result = HeightField::from_gltf(bytes, None, 0.25, &LIMITS);
    result.is_ok_and(|import| {
        field_holds(&import.field);
        true
    })
}

/// The lines as arguments. Files that they name must not be read: a fuzzer makes up any path.
fn model(bytes: &[u8]) -> bool {
    let Ok(text) = core::str::from_utf8(bytes) else {
        return false;
    };
    let mut lines = text.lines();
    let Some(name) = lines.next() else {
        return false;
    };
    // A wave may take a minute and be meant; its keys are read as all the others are.
    if name == "waves" {
        return false;
    }
    let arguments: Vec<String> = lines.map(str::to_owned).collect();
    let no_files = |path: &std::path::Path| Err(std::io::Error::other(format!("{} is not read here", path.display())));
    let Ok(output) = rain_cli::model::calculate_with(name, &arguments, &no_files) else {
        return false;
    };
    assert!(output.is_finite(), "{name} {arguments:?}: {}", output.json());
    true
}

/// What went wrong.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Failure {
    /// A panic, with its message.
    Panic(String),
    /// More memory at once than [`MEMORY`] and [`MEMORY_PER_BYTE`] allow. Units: bytes.
    Memory(u64),
}

/// Feeds a target the input as it is and with its shell mended, for fuzzers that know nothing of checksums.
///
/// # Errors
/// As [`attempt`].
pub fn attempt_mended(target: Target, bytes: &[u8]) -> Result<bool, Failure> {
    let valid = attempt(target, bytes)?;
    let mut mended = bytes.to_vec();
    repair(target, &mut mended);
    if mended == bytes {
        return Ok(valid);
    }
    attempt(target, &mended)
}

/// Feeds a target and watches. Returns whether the input was valid.
///
/// # Errors
/// When it panicked or took too much memory.
pub fn attempt(target: Target, bytes: &[u8]) -> Result<bool, Failure> {
    let mut result = Ok(false);
    let used = allocation_counter::measure(|| {
        result = catch_unwind(AssertUnwindSafe(|| target.run(bytes))).map_err(|payload| {
            let text = payload
                .downcast_ref::<String>()
                .cloned()
                .or_else(|| payload.downcast_ref::<&str>().map(|s| (*s).to_owned()));
            Failure::Panic(text.unwrap_or_default())
        });
    });
    let allowed = MEMORY + MEMORY_PER_BYTE * bytes.len() as u64;
    if result.is_ok() && used.bytes_max > allowed {
        return Err(Failure::Memory(used.bytes_max));
    }
    result
}
