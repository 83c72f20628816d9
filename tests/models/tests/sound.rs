//! The sound of rain.

use rain_core::sound::{SOUND_RINGS, WATER_SOUND_SHARE, heard_share, rain_sound_w_m2, sound_level_db, sound_share};
use rain_core::weather::SurfaceClass;

use crate::check::Worst;

#[test]
fn rain_sounds_by_its_energy_and_by_what_it_lands_on() {
    let mut worst = Worst::default();
    for i in 0..=50_u32 {
        let rate = 10.0 * f64::from(i);
        let energy = 28.3 * (1.0 - 0.52 * (-0.042 * rate).exp()) * rate / 3600.0;
        worst.relative(rain_sound_w_m2(rate, 1e-6), 1e-6 * energy, 1e-12, || format!("{rate}"));
    }
    worst.assert_below(1e-14, 51);
    for (rate, share) in [(f64::NAN, 1e-6), (-1.0, 1e-6), (10.0, f64::NAN), (10.0, -1.0)] {
        assert_eq!(rain_sound_w_m2(rate, share), 0.0);
    }
    assert_eq!(rain_sound_w_m2(1e9, 1e-6), rain_sound_w_m2(500.0, 1e-6));
    // A roof in the standard heavy rain: 65 to 70 dB close to it. A street in heavy rain: 55 to 60 dB.
    let roof = sound_level_db(rain_sound_w_m2(40.0, sound_share(SurfaceClass::Roof)));
    let heard: f64 = SOUND_RINGS
        .iter()
        .map(|[r, area]| heard_share(*area, r.hypot(1.7)))
        .sum();
    let street = sound_level_db(heard * rain_sound_w_m2(25.0, sound_share(SurfaceClass::Asphalt)));
    assert!(
        (64.0..71.0).contains(&roof) && (52.0..60.0).contains(&street),
        "{roof} {street}"
    );
    assert!(sound_share(SurfaceClass::Grass) < sound_share(SurfaceClass::Stone));
    assert!(WATER_SOUND_SHARE < sound_share(SurfaceClass::Asphalt));
}

#[test]
fn levels_and_spreading_are_their_formulas() {
    let (mut level, mut heard) = (Worst::default(), Worst::default());
    for i in 0..=60 {
        let intensity = 1e-12 * 10_f64.powf(0.2 * f64::from(i));
        level.absolute(sound_level_db(intensity), 2.0 * f64::from(i), || format!("{intensity}"));
        let d = 0.5 + f64::from(i);
        heard.relative(
            heard_share(3.0, d),
            3.0 / (2.0 * core::f64::consts::PI * d * d),
            0.0,
            || format!("{d}"),
        );
    }
    level.assert_below(1e-13, 61);
    heard.assert_below(1e-15, 61);
    assert_eq!(
        (sound_level_db(0.0), sound_level_db(f64::NAN), sound_level_db(-1.0)),
        (0.0, 0.0, 0.0)
    );
    assert_eq!(heard_share(1.0, 0.0), heard_share(1.0, 0.5));
    assert_eq!(heard_share(f64::NAN, 1.0), 0.0);
}
