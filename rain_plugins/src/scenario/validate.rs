//! Checks a scenario: every number finite and in its domain, names that refer to something, bounded counts.

use std::collections::BTreeSet;

use rain_core::error::ConfigError;
use rain_core::rainfall::MAX_LAMPS;
use rain_ecs::prelude::{GustSettings, LevelCurve, LightningSettings};
use thiserror::Error;

use super::areas::MAX_AREAS;
use super::expectation::{At, Check, Expectation, MaskCheck, Statistic};
use super::file::{Camera, Captures, Environment, Mask, Scenario, Sky, Vehicle};
use super::puddles::Puddles;
use super::report::PASS_NAMES;
use super::weather::MAX_KEYS;
use crate::splash::MAX_SPLASH_BUDGET;

/// Longest run. Units: s (30 days).
pub const MAX_DURATION_S: f64 = 2_592_000.0;
/// Most parts in a scene.
pub const MAX_PARTS: usize = 4096;
/// Most vehicles.
pub const MAX_VEHICLES: usize = 256;
/// Most captures.
pub const MAX_CAPTURES: usize = 10_000;
/// Most expectations.
pub const MAX_EXPECTATIONS: usize = 10_000;
/// Widest and highest picture. Units: pixels.
pub const MAX_SIZE: u32 = 8192;
/// Most quads for streaks.
pub const MAX_STREAK_BUDGET: u32 = 4_000_000;

const WORLD_M: f64 = 1_000_000.0;

/// The first thing wrong with a scenario.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{field} is {value}, allowed: {allowed}")]
pub struct FieldProblem {
    /// Path of the field, such as `vehicles[0].path[2].time_s`.
    pub field: String,
    /// Its value.
    pub value: String,
    /// What is allowed, with unit.
    pub allowed: String,
}

type Checked = Result<(), FieldProblem>;

fn problem(field: impl Into<String>, value: impl ToString, allowed: impl Into<String>) -> Checked {
    Err(FieldProblem {
        field: field.into(),
        value: value.to_string(),
        allowed: allowed.into(),
    })
}

fn number(field: &str, value: f64, min: f64, max: f64, unit: &str) -> Checked {
    // NaN fails both comparisons.
    if value >= min && value <= max {
        return Ok(());
    }
    let unit = if unit.is_empty() {
        String::new()
    } else {
        format!(" {unit}")
    };
    problem(field, value, format!("{min} to {max}{unit}"))
}

fn numbers(field: &str, values: &[f64], min: f64, max: f64, unit: &str) -> Checked {
    values
        .iter()
        .enumerate()
        .try_for_each(|(i, v)| number(&format!("{field}[{i}]"), *v, min, max, unit))
}

fn count(field: &str, value: usize, max: usize, what: &str) -> Checked {
    if value <= max {
        Ok(())
    } else {
        problem(field, format!("a list of {value}"), format!("at most {max} {what}"))
    }
}

fn file_name(field: &str, name: &str) -> Checked {
    if name.trim().is_empty() {
        problem(field, "empty", "the name of a glTF or GLB file")
    } else {
        Ok(())
    }
}

/// The field of `at` that does not validate, or `at` itself.
fn config(at: &str, error: ConfigError) -> Checked {
    match error {
        ConfigError::OutOfRange { field, value, allowed } => problem(format!("{at}.{field}"), value, allowed),
        ConfigError::NotIncreasing {
            index, value, previous, ..
        } => problem(
            format!("{at}.keys[{index}].time_s"),
            value,
            format!("later than the one before it ({previous} s)"),
        ),
        ConfigError::Empty { field } => problem(format!("{at}.{field}"), "empty", "at least one"),
    }
}

fn rising(field: &str, time: f64, before: Option<f64>) -> Checked {
    match before {
        Some(before) if time <= before => problem(field, time, format!("later than the one before it ({before} s)")),
        _ => Ok(()),
    }
}

impl Scenario {
    /// Checks every field; the first problem is returned.
    ///
    /// # Errors
    /// The path of the field, its value and what is allowed.
    pub fn validate(&self) -> Result<(), FieldProblem> {
        if !(self.duration_s > 0.0 && self.duration_s <= MAX_DURATION_S) {
            return problem(
                "duration_s",
                self.duration_s,
                format!("above 0 up to {MAX_DURATION_S} s"),
            );
        }
        count("scene", self.scene.len(), MAX_PARTS, "parts")?;
        for (i, part) in self.scene.iter().enumerate() {
            let at = format!("scene[{i}]");
            file_name(&format!("{at}.file"), &part.file)?;
            numbers(&format!("{at}.translation"), &part.translation, -WORLD_M, WORLD_M, "m")?;
            number(&format!("{at}.yaw_deg"), part.yaw_deg, -36_000.0, 36_000.0, "degrees")?;
            number(&format!("{at}.scale"), part.scale, 1e-4, 1e4, "")?;
            if let Some(Err(error)) = part.puddles.as_ref().map(Puddles::check) {
                return config(&format!("{at}.puddles"), error);
            }
            if let Some(map) = &part.depth_map {
                number(&format!("{at}.depth_map.relief"), map.relief, 0.0, 1.0, "")?;
            }
        }
        count("drains", self.drains.len(), MAX_PARTS, "drains")?;
        for (i, drain) in self.drains.iter().enumerate() {
            let at = format!("drains[{i}]");
            numbers(&format!("{at}.position"), &drain.position, -WORLD_M, WORLD_M, "m")?;
            number(&format!("{at}.perimeter_m"), drain.perimeter_m, 0.0, 1000.0, "m")?;
            number(&format!("{at}.area_m2"), drain.area_m2, 0.0, 1000.0, "m²")?;
        }
        count("spouts", self.spouts.len(), MAX_PARTS, "spouts")?;
        for (i, spout) in self.spouts.iter().enumerate() {
            let at = format!("spouts[{i}]");
            numbers(&format!("{at}.position"), &spout.position, -WORLD_M, WORLD_M, "m")?;
            number(&format!("{at}.yaw_deg"), spout.yaw_deg, -36_000.0, 36_000.0, "degrees")?;
            if let Err((part, error)) = spout.check() {
                return config(&format!("{at}{part}"), error);
            }
        }
        environment(&self.environment)?;
        self.check_weather()?;
        number("areas.outside", self.areas.outside, 0.0, 1.0, "")?;
        count("areas.list", self.areas.list.len(), MAX_AREAS, "areas")?;
        for (i, area) in self.areas.list.iter().enumerate() {
            area.check()
                .or_else(|(name, value, allowed)| problem(format!("areas.list[{i}].{name}"), value, allowed))?;
        }
        self.check_vehicles()?;
        camera(&self.camera, &self.vehicles)?;
        if self.rain.streak_budget > MAX_STREAK_BUDGET {
            return problem(
                "rain.streak_budget",
                self.rain.streak_budget,
                format!("0 to {MAX_STREAK_BUDGET} quads"),
            );
        }
        if self.rain.splash_budget > MAX_SPLASH_BUDGET {
            return problem(
                "rain.splash_budget",
                self.rain.splash_budget,
                format!("0 to {MAX_SPLASH_BUDGET} crowns and drops"),
            );
        }
        number("rain.glow", self.rain.glow, 0.0, 100.0, "")?;
        number("rain.rainbow", self.rain.rainbow, 0.0, 100.0, "")?;
        number("rain.splash_mist", self.rain.splash_mist, 0.0, 100.0, "")?;
        number("rain.bloom", self.rain.bloom, 0.0, 100.0, "")?;
        number("rain.cloud_base_m", self.rain.cloud_base_m, -1e5, 1e5, "m")?;
        number("rain.contrast", self.rain.contrast, 1.0, 32.0, "")?;
        let lamps = f64::from(self.rain.lamps.unwrap_or_default());
        number("rain.lamps", lamps, 0.0, MAX_LAMPS as f64, "")?;
        number("rain.exposure_s", self.rain.exposure_s, 1e-4, 0.25, "s")?;
        if let Err(ConfigError::OutOfRange { field, value, allowed }) = self.water.appearance().validated() {
            return problem(format!("water.{field}"), value, allowed);
        }
        self.check_captures()?;
        self.check_run_ups()?;
        self.check_outputs()?;
        self.check_domain()?;
        if self.warm_up_frames > 1000 {
            return problem("warm_up_frames", self.warm_up_frames, "0 to 1000 frames");
        }
        count(
            "expectations",
            self.expectations.len(),
            MAX_EXPECTATIONS,
            "expectations",
        )?;
        self.expectations
            .iter()
            .enumerate()
            .try_for_each(|(i, e)| self.check_expectation(&format!("expectations[{i}]"), e))
    }

    fn check_weather(&self) -> Checked {
        let weather = &self.weather;
        let given = [
            !weather.keys.is_empty(),
            weather.csv.is_some(),
            weather.preset.is_some(),
        ];
        if given.iter().filter(|g| **g).count() > 1 {
            return problem("weather", "more than one of keys, csv and preset", "one of them");
        }
        count("weather.keys", weather.keys.len(), MAX_KEYS, "keys")?;
        if let Err(ConfigError::OutOfRange { field, value, allowed }) = weather.base.validated() {
            return problem(format!("weather.base.{field}"), value, allowed);
        }
        number("weather.wetness", weather.wetness.unwrap_or(0.0), 0.0, 1.0, "")?;
        number("weather.water_level", weather.water_level.unwrap_or(0.0), 0.0, 1.0, "")?;
        number("weather.hole_level", weather.hole_level.unwrap_or(0.0), 0.0, 1.0, "")?;
        if let Some(Err(error)) = weather.gusts.map(GustSettings::validated) {
            return config("weather.gusts", error);
        }
        if let Some(Err(error)) = weather.lightning.map(LightningSettings::validated) {
            return config("weather.lightning", error);
        }
        if let Some(levels) = &weather.levels {
            count("weather.levels.keys", levels.keys.len(), MAX_KEYS, "keys")?;
        }
        for (i, key) in weather.levels.iter().flat_map(|levels| &levels.keys).enumerate() {
            if let Err(error) = LevelCurve::new(vec![key.core()], None) {
                return config(&format!("weather.levels.keys[{i}]"), error);
            }
        }
        if let Err(error) = weather.level_curve() {
            return config("weather.levels", error);
        }
        for (i, key) in weather.keys.iter().enumerate() {
            key.check(i.checked_sub(1).map(|i| &weather.keys[i]), &weather.base)
                .or_else(|(name, value, allowed)| problem(format!("weather.keys[{i}].{name}"), value, allowed))?;
        }
        Ok(())
    }

    fn check_vehicles(&self) -> Checked {
        count("vehicles", self.vehicles.len(), MAX_VEHICLES, "vehicles")?;
        let mut names = BTreeSet::new();
        for (i, vehicle) in self.vehicles.iter().enumerate() {
            let at = format!("vehicles[{i}]");
            if vehicle.name.trim().is_empty() {
                return problem(format!("{at}.name"), "empty", "a name");
            }
            if !names.insert(&vehicle.name) {
                return problem(
                    format!("{at}.name"),
                    format!("`{}`", vehicle.name),
                    "a name that no other vehicle has",
                );
            }
            file_name(&format!("{at}.file"), &vehicle.file)?;
            number(&format!("{at}.scale"), vehicle.scale, 1e-4, 1e4, "")?;
            number(&format!("{at}.wheel_radius_m"), vehicle.wheel_radius_m, 0.01, 10.0, "m")?;
            if vehicle.path.is_empty() {
                return problem(format!("{at}.path"), "empty", format!("1 to {MAX_KEYS} keys"));
            }
            count(&format!("{at}.path"), vehicle.path.len(), MAX_KEYS, "keys")?;
            for (k, key) in vehicle.path.iter().enumerate() {
                let at = format!("{at}.path[{k}]");
                number(
                    &format!("{at}.time_s"),
                    key.time_s,
                    -MAX_DURATION_S,
                    MAX_DURATION_S,
                    "s",
                )?;
                rising(
                    &format!("{at}.time_s"),
                    key.time_s,
                    k.checked_sub(1).map(|k| vehicle.path[k].time_s),
                )?;
                numbers(&format!("{at}.position"), &key.position, -WORLD_M, WORLD_M, "m")?;
            }
        }
        Ok(())
    }

    fn check_captures(&self) -> Checked {
        count("captures", self.captures.len(), MAX_CAPTURES, "captures")?;
        let duration = self.duration_s;
        match &self.captures {
            Captures::Times(times) => {
                for (i, time) in times.iter().enumerate() {
                    let at = format!("captures[{i}]");
                    number(&at, *time, 0.0, duration, "s (the duration)")?;
                    rising(&at, *time, i.checked_sub(1).map(|i| times[i]))?;
                }
            }
            Captures::Even { start_s, end_s, count } => {
                number("captures.end_s", *end_s, 0.0, duration, "s (the duration)")?;
                number("captures.start_s", *start_s, 0.0, *end_s, "s (end_s)")?;
                if *count > 1 && start_s == end_s {
                    return problem(
                        "captures.start_s",
                        start_s,
                        "less than end_s, for more than one capture",
                    );
                }
            }
        }
        Ok(())
    }

    fn check_run_ups(&self) -> Checked {
        let mut seen = BTreeSet::new();
        for (i, run_up) in self.run_ups.iter().enumerate() {
            let at = format!("run_ups[{i}]");
            if run_up.capture >= self.captures.len() || !seen.insert(run_up.capture) {
                let last = self.captures.len().saturating_sub(1);
                return problem(
                    format!("{at}.capture"),
                    run_up.capture,
                    format!("0 to {last}, each once"),
                );
            }
            number(&format!("{at}.seconds"), run_up.seconds, 0.0, 60.0, "s")?;
        }
        Ok(())
    }

    fn check_outputs(&self) -> Checked {
        for (i, size) in self.outputs.size.iter().enumerate() {
            if *size == 0 || *size > MAX_SIZE {
                return problem(format!("outputs.size[{i}]"), size, format!("1 to {MAX_SIZE} pixels"));
            }
        }
        let mut masks = BTreeSet::new();
        for (i, mask) in self.outputs.masks.iter().enumerate() {
            if !masks.insert(mask) {
                return problem(
                    format!("outputs.masks[{i}]"),
                    format!("{mask:?}"),
                    "each mask at most once",
                );
            }
        }
        Ok(())
    }

    fn check_domain(&self) -> Checked {
        let Some(domain) = &self.domain else { return Ok(()) };
        numbers("domain.min", &domain.min, -WORLD_M, WORLD_M, "m")?;
        numbers("domain.max", &domain.max, -WORLD_M, WORLD_M, "m")?;
        for axis in 0..2 {
            let extent = domain.max[axis] - domain.min[axis];
            if !(extent > 0.0 && extent <= 100_000.0) {
                let allowed = format!("above {} and at most 100000 m from it", domain.min[axis]);
                return problem(format!("domain.max[{axis}]"), domain.max[axis], allowed);
            }
        }
        Ok(())
    }

    fn check_expectation(&self, at: &str, expectation: &Expectation) -> Checked {
        let captures = self.captures.len();
        let capture = |field: String, index: usize| {
            if index < captures {
                return Ok(());
            }
            let allowed = match captures {
                0 => "a capture, but the scenario has none".to_owned(),
                n => format!("0 to {} (the captures)", n - 1),
            };
            problem(field, index, allowed)
        };
        let any_capture = |field: String| capture(field, 0);
        match &expectation.check {
            Check::Mask(mask) => {
                match expectation.at {
                    At::Capture(index) => capture(format!("{at}.at"), index)?,
                    At::All | At::Last => any_capture(format!("{at}.at"))?,
                }
                self.check_mask(&format!("{at}.check"), mask)?;
            }
            Check::Rises(change) | Check::Falls(change) => {
                self.check_mask(&format!("{at}.check"), &change.mask_check())?;
                capture(format!("{at}.check.from"), change.from)?;
                capture(format!("{at}.check.to"), change.to)?;
                number(&format!("{at}.check.factor"), change.factor, 1.0, 1e6, "")?;
            }
            Check::Weather(weather) => {
                number(
                    &format!("{at}.check.time_s"),
                    weather.time_s,
                    0.0,
                    self.duration_s,
                    "s (the duration)",
                )?;
            }
            Check::Pass(pass) => {
                if !PASS_NAMES.contains(&pass.name.as_str()) {
                    let allowed = PASS_NAMES.join(", ");
                    return problem(format!("{at}.check.name"), format!("`{}`", pass.name), allowed);
                }
            }
            Check::Budget(_) | Check::Count(_) => {}
        }
        bounds(at, expectation)
    }

    fn check_mask(&self, at: &str, check: &MaskCheck) -> Checked {
        let written = |mask: Mask| self.outputs.masks.contains(&mask);
        if !written(check.mask) {
            return problem(
                format!("{at}.mask"),
                format!("{:?}", check.mask),
                "a mask listed in outputs.masks",
            );
        }
        if let Statistic::FractionAbove(level) = check.statistic {
            let (max, unit) = match check.mask {
                Mask::Depth => (65.535, "m"),
                Mask::Water => (0.655_35, "m"),
                Mask::Rain | Mask::Wet => (1.0, ""),
            };
            number(&format!("{at}.statistic"), level, 0.0, max, unit)?;
        }
        numbers(&format!("{at}.region"), &check.region, 0.0, 1.0, "")?;
        let [left, top, right, bottom] = check.region;
        if left >= right || top >= bottom {
            return problem(
                format!("{at}.region"),
                format!("{:?}", check.region),
                "left < right and top < bottom",
            );
        }
        if let Some([near, far]) = check.depth_m {
            number(&format!("{at}.depth_m[0]"), near, 0.0, WORLD_M, "m")?;
            number(&format!("{at}.depth_m[1]"), far, near, WORLD_M, "m")?;
            if near >= far {
                return problem(format!("{at}.depth_m"), format!("{near}, {far}"), "least < greatest");
            }
            if !written(Mask::Depth) {
                return problem(
                    format!("{at}.depth_m"),
                    "given",
                    "nothing without Depth in outputs.masks",
                );
            }
        }
        Ok(())
    }
}

fn bounds(at: &str, expectation: &Expectation) -> Checked {
    let Expectation {
        equals,
        min,
        max,
        tolerance,
        ..
    } = expectation;
    for (name, bound) in [("equals", equals), ("min", min), ("max", max)] {
        if let Some(bound) = bound
            && !bound.is_finite()
        {
            return problem(format!("{at}.{name}"), bound, "a finite number");
        }
    }
    if !(tolerance.is_finite() && *tolerance >= 0.0) {
        return problem(format!("{at}.tolerance"), tolerance, "0 or more");
    }
    let ranged = min.is_some() || max.is_some();
    if matches!(expectation.check, Check::Rises(_) | Check::Falls(_)) {
        if ranged || equals.is_some() {
            return problem(at, "a change with a bound", "factor alone, without equals, min and max");
        }
        return Ok(());
    }
    match (equals, ranged) {
        (Some(_), true) => problem(at, "equals and a range", "equals, or min and max, not both"),
        (None, false) => problem(at, "without a bound", "equals, min or max"),
        _ => match (min, max) {
            (Some(min), Some(max)) if min > max => problem(format!("{at}.min"), min, format!("at most max ({max})")),
            _ => Ok(()),
        },
    }
}

fn environment(environment: &Environment) -> Checked {
    let Sky::Overcast(sky) = &environment.sky;
    let at = "environment.sky";
    number(
        &format!("{at}.zenith_luminance_cd_m2"),
        sky.zenith_luminance_cd_m2,
        0.0,
        100_000.0,
        "cd/m²",
    )?;
    numbers(&format!("{at}.tint"), &sky.tint, 0.0, 10.0, "")?;
    if sky.tint == [0.0; 3] {
        return problem(format!("{at}.tint"), "(0, 0, 0)", "not all 0");
    }
    number(
        &format!("{at}.zenith_to_horizon"),
        sky.zenith_to_horizon,
        0.1,
        100.0,
        "",
    )?;
    number(&format!("{at}.cloud_contrast"), sky.cloud_contrast, 0.0, 0.5, "")?;
    number(&format!("{at}.skyline_deg"), sky.skyline_deg, 0.0, 60.0, "degrees")?;
    numbers(&format!("{at}.skyline_tint"), &sky.skyline_tint, 0.0, 1.0, "")?;
    numbers(&format!("{at}.ground_tint"), &sky.ground_tint, 0.0, 1.0, "")?;
    number(
        "environment.exposure_ev100",
        environment.exposure_ev100,
        -10.0,
        25.0,
        "EV",
    )?;
    if let Some(sun) = &environment.sun {
        let length = sun.direction.iter().map(|c| c * c).sum::<f64>().sqrt();
        if !(length > 1e-6 && length < 1e6) {
            return problem(
                "environment.sun.direction",
                format!("{:?}", sun.direction),
                "a finite vector, not zero",
            );
        }
        number(
            "environment.sun.illuminance_lux",
            sun.illuminance_lux,
            0.0,
            200_000.0,
            "lx",
        )?;
    }
    number("environment.lamps", environment.lamps, 0.0, 1000.0, "")?;
    environment
        .fog_visibility_m
        .map_or(Ok(()), |v| number("environment.fog_visibility_m", v, 1.0, 1e6, "m"))
}

fn camera(camera: &Camera, vehicles: &[Vehicle]) -> Checked {
    if let Some(height_m) = camera.orthographic_m {
        number("camera.orthographic_m", height_m, 0.1, 1000.0, "m")?;
    }
    if let Some(attached) = &camera.attached {
        if !camera.keys.is_empty() {
            return problem("camera", "keys and attached", "one of them");
        }
        if !vehicles.iter().any(|v| v.name == attached.vehicle) {
            let names: Vec<_> = vehicles.iter().map(|v| v.name.as_str()).collect();
            let allowed = format!("the name of a vehicle ({})", names.join(", "));
            return problem("camera.attached.vehicle", format!("`{}`", attached.vehicle), allowed);
        }
        numbers("camera.attached.eye_offset", &attached.eye_offset, -1000.0, 1000.0, "m")?;
        numbers(
            "camera.attached.target_offset",
            &attached.target_offset,
            -1000.0,
            1000.0,
            "m",
        )?;
        number("camera.attached.fov_y_deg", attached.fov_y_deg, 1.0, 170.0, "degrees")?;
        return looks(
            "camera.attached.target_offset",
            &attached.eye_offset,
            &attached.target_offset,
        );
    }
    count("camera.keys", camera.keys.len(), MAX_KEYS, "keys")?;
    for (i, key) in camera.keys.iter().enumerate() {
        let at = format!("camera.keys[{i}]");
        number(
            &format!("{at}.time_s"),
            key.time_s,
            -MAX_DURATION_S,
            MAX_DURATION_S,
            "s",
        )?;
        rising(
            &format!("{at}.time_s"),
            key.time_s,
            i.checked_sub(1).map(|i| camera.keys[i].time_s),
        )?;
        numbers(&format!("{at}.eye"), &key.eye, -WORLD_M, WORLD_M, "m")?;
        numbers(&format!("{at}.target"), &key.target, -WORLD_M, WORLD_M, "m")?;
        number(&format!("{at}.fov_y_deg"), key.fov_y_deg, 1.0, 170.0, "degrees")?;
        looks(&format!("{at}.target"), &key.eye, &key.target)?;
    }
    Ok(())
}

fn looks(field: &str, eye: &[f64; 3], target: &[f64; 3]) -> Checked {
    let apart = eye.iter().zip(target).any(|(e, t)| (e - t).abs() > 1e-3);
    if apart {
        Ok(())
    } else {
        problem(field, format!("{target:?}"), "at least 1 mm from the eye")
    }
}
