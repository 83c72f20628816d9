use super::*;
use crate::hash::{pcg3d, unit_f32};
use crate::weather::{ColumnForcing, SurfaceClass, SurfaceColumn};

/// Relative distance, or of 0.1 mm.
fn apart(found: f32, right: f64) -> f64 {
    (f64::from(found) - right).abs() / right.abs().max(0.1)
}

fn random(a: u32, b: u32) -> [f32; 3] {
    pcg3d([a, b, 77]).map(unit_f32)
}

/// The column in double precision with this water.
fn double(column: ColumnF32) -> SurfaceColumn {
    SurfaceColumn::holding(
        f64::from(column.pores_mm),
        f64::from(column.film_mm),
        f64::from(column.soil_s),
    )
}

#[test]
fn one_interval_of_any_length_ends_where_double_precision_does() {
    let (mut worst, mut short, mut worst_soil) = (0.0_f64, 0.0_f64, 0.0_f64);
    for class in SurfaceClass::ALL {
        let properties = class.properties();
        let rules = ColumnRules::from(&properties);
        for case in 0..4000_u32 {
            let [a, b, c] = random(case, class.index() as u32);
            let [d, e, f] = random(case, 100 + class.index() as u32);
            let start = ColumnF32 {
                pores_mm: rules.capacity_mm * (1.5 * a).min(1.0),
                film_mm: if a > 0.66 { ops::expf(14.0 * b - 10.0) } else { 0.0 },
                soil_s: if rules.is_permeable() { 4000.0 * c } else { 0.0 },
            };
            let rain = if d < 0.3 { 0.0 } else { ops::expf(9.0 * d - 3.5) };
            let evaporation = if e < 0.3 { 0.0 } else { 1.2 * e };
            let dt = ops::expf(11.0 * f - 3.0);
            let found = start.advanced(&rules, rain, evaporation, dt);
            let mut right = double(start);
            let forcing = ColumnForcing {
                rain_mm_h: f64::from(rain),
                evaporation_mm_h: f64::from(evaporation),
            };
            right.advance(&properties, forcing, f64::from(dt)).unwrap();
            let error = apart(found.pores_mm, right.pores_mm()).max(apart(found.film_mm, right.water_level_mm()));
            if dt <= 60.0 {
                short = short.max(error);
            }
            worst = worst.max(error);
            worst_soil = worst_soil.max((f64::from(found.soil_s) - right.tau).abs() / right.tau.max(10.0));
        }
    }
    eprintln!("worst of a minute: {short:.1e}, of an hour: {worst:.1e}, soil {worst_soil:.1e}");
    assert!(
        short < 1e-3 && worst < 3e-3 && worst_soil < 1e-2,
        "{short:.1e} {worst:.1e} {worst_soil:.1e}"
    );
}

#[test]
fn a_day_of_changing_weather_stays_within_a_thousandth() {
    let mut worst = 0.0_f64;
    for class in SurfaceClass::ALL {
        let properties = class.properties();
        let rules = ColumnRules::from(&properties);
        for exposure in [1.0_f32, 0.3] {
            let mut found = ColumnF32::default();
            let mut right = SurfaceColumn::default();
            let (mut time, mut spell) = (0.0_f32, 0);
            while time < 86_400.0 {
                spell += 1;
                let [a, b, c] = random(spell, 7);
                let rain = if a < 0.5 { 0.0 } else { ops::expf(6.0 * b - 1.5) } * exposure;
                let evaporation = 0.5 * c;
                for step in 0..200 {
                    let dt = 0.25 + 10.0 * random(step, spell)[0].powi(3);
                    found = found.advanced(&rules, rain, evaporation, dt);
                    let forcing = ColumnForcing {
                        rain_mm_h: f64::from(rain),
                        evaporation_mm_h: f64::from(evaporation),
                    };
                    right.advance(&properties, forcing, f64::from(dt)).unwrap();
                    time += dt;
                    worst = worst
                        .max(apart(found.pores_mm, right.pores_mm()))
                        .max(apart(found.film_mm, right.water_level_mm()));
                }
            }
            assert!(spell > 50);
        }
    }
    eprintln!("worst of a day: {worst:.1e}");
    assert!(worst < 1e-3, "{worst:.1e}");
}

#[test]
fn bad_numbers_are_moved_into_their_domain() {
    let rules = ColumnRules::from(&SurfaceClass::Grass.properties());
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, f32::MAX] {
        let water = ColumnF32 {
            pores_mm: bad,
            film_mm: bad,
            soil_s: bad,
        };
        for column in [
            water.advanced(&rules, 10.0, 1.0, 1.0),
            ColumnF32::default().advanced(&rules, bad, bad, bad),
            ColumnF32::default().advanced(&rules, 10.0, 0.0, bad),
        ] {
            let sound = [column.pores_mm, column.film_mm, column.soil_s]
                .iter()
                .all(|v| v.is_finite() && *v >= 0.0);
            assert!(sound && column.pores_mm <= rules.capacity_mm, "{bad}: {column:?}");
        }
    }
}
