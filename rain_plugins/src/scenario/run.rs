//! Runs a scenario from file to results.

use std::path::PathBuf;

use rain_ecs::prelude::*;
use thiserror::Error;

use super::contact::{ContactSheet, caption};
use super::error::ScenarioError;
use super::expect::{CaptureMasks, Evaluator, Evidence};
use super::file::{Mask, Scenario, ScenePart};
use super::masks;
use super::output::{CONTACT, OutputError, OutputFolder, REPORT, TIMELINE, above_name, frame_name, mask_name};
use super::plot;
use super::report::{Budget, Memory, PassRow, Report, Timings};
use super::session::Session;
use super::timeline::{Series, Timeline, surface_name};
use crate::report::PassName;

/// Why a run gave no results.
#[derive(Debug, Error)]
pub enum RunError {
    /// The scenario is wrong.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// A scene file is missing or broken.
    #[error("{}: {message}", file.display())]
    Asset {
        /// The file.
        file: PathBuf,
        /// What is wrong with it.
        message: String,
    },
    /// The scenario does not fit the settings given beside it.
    #[error("with the settings given beside the scenario, {0}")]
    Options(String),
    /// Results cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// A setting given beside the scenario is out of range.
    #[error("{field} is {value}, allowed: {allowed}")]
    Setting {
        /// Its name.
        field: &'static str,
        /// The value.
        value: String,
        /// The allowed range.
        allowed: &'static str,
    },
    /// There is no graphics adapter.
    #[error(
        "no usable graphics device: install a Vulkan driver (Debian: apt-get install mesa-vulkan-drivers libvulkan1)"
    )]
    NoAdapter,
    /// The scene's ground cannot be built as the scenario asks.
    #[error("the ground: {0}")]
    Ground(String),
    /// The renderer stopped.
    #[error("{0}")]
    Renderer(String),
}

impl RunError {
    /// The program's exit code: 2 for bad input, 3 for the graphics device.
    #[must_use]
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::NoAdapter | Self::Renderer(_) => 3,
            _ => 2,
        }
    }
}

/// What may be said beside the scenario file.
#[derive(Debug, Clone, Default)]
pub struct RunOptions {
    /// Replaces the scenario's scene.
    pub scene: Option<PathBuf>,
    /// Where relative scene files are looked up. Default: beside the scenario.
    pub assets: Option<PathBuf>,
    /// Where results go.
    pub out: PathBuf,
    /// Number of captures, spread evenly.
    pub frames: Option<u32>,
    /// Size of the pictures. Units: px.
    pub size: Option<[u32; 2]>,
    /// Seed.
    pub seed: Option<u64>,
}

/// How far a run is.
#[derive(Debug, Clone, PartialEq)]
pub enum Progress {
    /// Scene files are being read.
    Loading,
    /// So many of so many captures are done; the time reached in s.
    Captures {
        /// Captures done.
        done: usize,
        /// Captures in all.
        all: usize,
        /// Units: s.
        time_s: f64,
    },
    /// Results are being written.
    Writing,
}

/// Records over the run, at least.
const RECORDS: f64 = 240.0;

/// Runs a loaded scenario and writes its results.
///
/// # Errors
/// On bad input, without a graphics adapter, or when results cannot be written; then nothing that looks whole is left.
pub fn run(
    mut scenario: Scenario,
    options: &RunOptions,
    mut progress: impl FnMut(Progress),
) -> Result<Report, RunError> {
    apply(&mut scenario, options)?;
    let mut output = OutputFolder::begin(&options.out)?;
    progress(Progress::Loading);
    let assets = options.assets.clone().unwrap_or_else(|| scenario.folder.clone());
    let mut session = Session::new(&scenario, &assets)?;

    let captures = scenario.captures.times_s();
    let mut record = Recorder::new(&mut session, &scenario);
    let mut evaluator = Evaluator::new(&scenario);
    let mut sheet = ContactSheet::new(captures.len(), scenario.outputs.size);
    let mut frame_ms = Vec::new();
    record.sample(&mut session);
    for (index, &time_s) in captures.iter().enumerate() {
        let run_up = scenario.run_ups.iter().find(|r| r.capture == index);
        record.advance(&mut session, time_s - run_up.map_or(0.0, |r| r.seconds))?;
        if let Some(run_up) = run_up {
            session.run_up(time_s, run_up.seconds)?;
        }
        let capture = session.capture(time_s)?;
        record.sample(&mut session);
        record.timeline.captures_s.push(time_s);
        frame_ms.push(capture.frame_ms);
        if scenario.outputs.frames {
            output.write_picture(&frame_name(index), &capture.frame)?;
        }
        if let Some(above) = &capture.above {
            output.write_picture(&above_name(index), above)?;
        }
        for (mask, texels) in &capture.masks {
            let bytes = masks::encode(scenario.outputs.size, texels)
                .map_err(|e| RunError::Renderer(format!("mask {}: {e}", mask.suffix())))?;
            output.write(&mask_name(index, *mask), &bytes)?;
        }
        let intensity = record.timeline.intensity_mm_h.last().copied().unwrap_or(0.0);
        sheet.push(index, &capture.frame, caption(index, time_s, intensity));
        evaluator.capture(
            index,
            &CaptureMasks {
                size: scenario.outputs.size,
                rain: capture.mask(Mask::Rain),
                wet: capture.mask(Mask::Wet),
                depth: capture.mask(Mask::Depth),
                water: capture.mask(Mask::Water),
            },
        );
        progress(Progress::Captures {
            done: index + 1,
            all: captures.len(),
            time_s,
        });
    }
    record.advance(&mut session, scenario.duration_s)?;
    session.advance(scenario.duration_s)?;
    record.sample(&mut session);

    progress(Progress::Writing);
    let passes = pass_rows(&session);
    let counts = session.measured().counts();
    let (budget, _) = record.budget(&mut session);
    let expectations = evaluator.finish(&Evidence {
        timeline: &record.timeline,
        passes: &passes,
        budget: &budget,
        counts: &counts,
    });
    let report = Report {
        scenario: scenario.name.clone(),
        seed: scenario.seed,
        duration_s: scenario.duration_s,
        frames: captures.len() as u64,
        size: scenario.outputs.size,
        adapter: super::headless::adapter_name(session.app()),
        state_hash: format!("{:016x}", session.state_hash()),
        budget,
        passes,
        counts,
        expectations,
        timings: super::report::median(&frame_ms).map(|m| timings(m, scenario.rain.enabled)),
        memory: Some(Memory {
            gpu_bytes: Some(session.passes().gpu_memory_bytes as u64),
            cpu_bytes: peak_memory(),
        }),
    };
    let plot_error = |e: plot::PlotError| RunError::Renderer(format!("cannot plot: {e}"));
    if scenario.outputs.contact_sheet && !captures.is_empty() {
        output.write_picture(CONTACT, &sheet.finish().map_err(plot_error)?)?;
    }
    if scenario.outputs.timeline && record.timeline.times_s.len() > 1 {
        let picture = plot::timeline(&scenario.name, &record.timeline, [1280, 960]).map_err(plot_error)?;
        output.write_picture(TIMELINE, &picture)?;
    }
    let json = report
        .to_json()
        .map_err(|e| RunError::Renderer(format!("cannot write the report: {e}")))?;
    output.write(REPORT, json.as_bytes())?;
    output.finish()?;
    Ok(report)
}

fn timings(median: f64, rain: bool) -> Timings {
    let mut timings = Timings::default();
    if rain {
        timings.wet_frame_ms_median = Some(median);
    } else {
        timings.dry_frame_ms_median = Some(median);
    }
    timings
}

/// Settings given beside the file replace the file's; then everything is checked again.
fn apply(scenario: &mut Scenario, options: &RunOptions) -> Result<(), RunError> {
    if let Some(scene) = &options.scene {
        let absolute = std::path::absolute(scene).map_err(|e| RunError::Asset {
            file: scene.clone(),
            message: e.to_string(),
        })?;
        scenario.scene = vec![ScenePart::from_file(absolute.to_string_lossy())];
    }
    if let Some(count) = options.frames {
        if !(1..=10_000).contains(&count) {
            return Err(RunError::Setting {
                field: "--frames",
                value: count.to_string(),
                allowed: "1 to 10000",
            });
        }
        scenario.captures = scenario.captures.resampled(count, scenario.duration_s);
        // Expectations and run-ups name captures of the file's own list.
        scenario.expectations.clear();
        scenario.run_ups.clear();
    }
    if let Some(size) = options.size {
        scenario.outputs.size = size;
    }
    if let Some(seed) = options.seed {
        scenario.seed = seed;
    }
    scenario
        .validate()
        .map_err(|problem| RunError::Options(problem.to_string()))
}

/// Samples the weather along the way.
struct Recorder {
    timeline: Timeline,
    step_s: f64,
    area_m2: f64,
}

impl Recorder {
    fn new(session: &mut Session, scenario: &Scenario) -> Self {
        let area = match &scenario.domain {
            Some(d) => (d.max[0] - d.min[0]) * (d.max[1] - d.min[1]),
            None => session
                .scene_bounds()
                .map_or(1.0, |[x0, z0, x1, z1]| (x1 - x0) * (z1 - z0)),
        };
        Self {
            timeline: Timeline::default(),
            step_s: scenario.duration_s / RECORDS,
            area_m2: if area.is_finite() && area > 0.0 { area } else { 1.0 },
        }
    }

    /// Runs towards `time_s`, sampling on the way, and stops a little before it.
    fn advance(&mut self, session: &mut Session, time_s: f64) -> Result<(), RunError> {
        // Captures need a second of their own for the frames before them.
        let stop = time_s - 1.0;
        while session.now_s() + self.step_s < stop {
            session.advance(session.now_s() + self.step_s)?;
            self.sample(session);
        }
        Ok(())
    }

    fn sample(&mut self, session: &mut Session) {
        let now = session.now_s();
        if self.timeline.times_s.last().is_some_and(|last| now <= *last) {
            return;
        }
        let Some(weather) = session.weather() else { return };
        let t = &mut self.timeline;
        t.times_s.push(now);
        t.intensity_mm_h.push(weather.conditions().intensity_mm_h);
        let push = |list: &mut Vec<Series>, name: &str, value: f64| match list.iter_mut().find(|s| s.name == name) {
            Some(series) => series.values.push(value),
            None => {
                let mut series = Series::new(name);
                series.values.push(value);
                list.push(series);
            }
        };
        for class in SurfaceClass::ALL {
            let name = surface_name(class);
            push(&mut t.wetness, &name, weather.wetness(class));
            push(&mut t.water_level_mm, &name, weather.water_level_mm(class));
        }
        let (budget, m3_per_mm) = self.budget(session);
        let t = &mut self.timeline;
        for (name, m3) in [
            ("rain", budget.rain_m3),
            ("film", budget.film_m3),
            ("pores", budget.pores_m3),
            ("basins", budget.basins_m3),
            ("evaporated", budget.evaporated_m3),
            ("infiltrated", budget.infiltrated_m3),
            ("drained", budget.drained_m3),
        ] {
            let value = m3 / m3_per_mm;
            push(&mut t.budget_mm, name, value);
        }
    }

    /// The water of the whole domain, and what 1 mm over it is in m³: the ledger of the ground; without one, a surface
    /// column of the leading class times the area.
    fn budget(&self, session: &mut Session) -> (Budget, f64) {
        if let Some(ground) = session.app().world().get_resource::<SurfaceGround>()
            && let Some(built) = ground.ground()
        {
            let l = built.ledger();
            let budget = Budget {
                rain_m3: l.supplied_m3(),
                // What has left a cell and is not in its basin yet is film on its way.
                film_m3: l.film_m3 + l.underway_m3,
                pores_m3: l.pores_m3,
                basins_m3: l.basins_m3,
                airborne_m3: l.airborne_m3,
                evaporated_m3: l.evaporated_m3,
                infiltrated_m3: l.infiltrated_m3,
                drained_m3: l.drained_m3(),
                residual_relative: l.residual_relative,
                ..Budget::default()
            };
            return (budget, built.area_m2() * 1e-3);
        }
        let m3_per_mm = self.area_m2 * 1e-3;
        let Some(weather) = session.weather() else {
            return (Budget::default(), m3_per_mm);
        };
        let l = weather.column(SurfaceClass::Asphalt).ledger();
        let m3 = |mm: f64| mm * m3_per_mm;
        let budget = Budget {
            rain_m3: m3(l.rain_mm),
            film_m3: m3(l.film_mm),
            pores_m3: m3(l.pores_mm),
            evaporated_m3: m3(l.evaporated_mm),
            infiltrated_m3: m3(l.infiltrated_mm),
            drained_m3: m3(l.drained_mm),
            residual_relative: l.residual_relative(),
            ..Budget::default()
        };
        (budget, m3_per_mm)
    }
}

fn pass_rows(session: &Session) -> Vec<PassRow> {
    session
        .passes()
        .passes
        .iter()
        // Masks are measurements, not rain.
        .filter(|(name, _)| **name != PassName::Masks)
        .map(|(name, record)| {
            let spans: &[&str] = match name.as_str() {
                "splash" => &["rain_splash_make", "rain_splash"],
                "haze" => &["rain_haze_areas", "rain_haze"],
                "lattice" => &["rain_lattice"],
                "far_rain" => &["rain_far_rain"],
                "rainfall" => &["rain_rainfall_project", "rain_rainfall"],
                "water_map" => &["rain_water_map"],
                "lens" => &["rain_lens"],
                "ripples" => &["rain_ripples"],
                "waves" => &["rain_waves"],
                _ => &[],
            };
            let sum = |what: &str| -> Option<f64> {
                let values: Vec<f64> = spans
                    .iter()
                    .filter_map(|s| session.measured().median_of(&format!("render/{s}/{what}")))
                    .collect();
                (!values.is_empty()).then(|| values.iter().sum())
            };
            PassRow {
                name: name.as_str().into(),
                recorded_frames: record.recorded,
                skipped_frames: record.skipped.values().sum(),
                skip_reasons: record.skipped.iter().map(|(r, n)| (r.as_str().into(), *n)).collect(),
                gpu_ms_median: sum("elapsed_gpu"),
                cpu_ms_median: sum("elapsed_cpu"),
            }
        })
        .collect()
}

/// Largest resident size of this process so far. Units: bytes. `None` where the system does not say.
fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|l| l.starts_with("VmHWM:"))?;
    let kib: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kib * 1024)
}
