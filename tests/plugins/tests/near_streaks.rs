//! Settings of near streaks.

use bevy::prelude::*;
use rain_plugins::prelude::*;

#[test]
fn shutters_go_down_to_a_tenth_of_a_millisecond() {
    let with = |exposure_s: f32| RainView {
        exposure_s,
        ..default()
    };
    assert!(with(1e-4).validated().is_ok() && with(0.25).validated().is_ok());
    let error = with(5e-5).validated().expect_err("too short");
    assert!(error.to_string().contains("exposure_s"), "{error}");
}
