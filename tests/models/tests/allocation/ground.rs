//! Weather, what stands and runs on the ground, waves, drips, spray.

use std::hint::black_box;

use rain_core::canopy::{
    CanopyProperties, DripSizes, LeafType, canopy_shower, crown_place, drip_crest, drip_frequency_hz, nearest_drip,
    nearest_drip_f32, radial_shares,
};
use rain_core::surface::{
    FlowLaw, Grate, ParaboloidPuddle, SheetFlow, SoilTexture, SurfaceWeights, Water, fast_film_step_f32,
    film_roughness, film_step, saturated_albedo, under_water, wet_albedo_rgb,
};
use rain_core::waves::{Border, DropImpact, Ring, RingTable, WaveField, WaveSettings, slope_variance};
use rain_core::weather::{
    ArtistSettings, ArtistState, ColumnForcing, Keyframe, SurfaceClass, SurfaceColumn, Timeline, Transition,
    WeatherConditions, WeatherPreset, WeatherSurfaces, dalton_evaporation_mm_h, penman_evaporation_mm_h,
};
use rain_core::wheels::{
    SprayMechanism, Tyre, WheelTrail, hydroplanes, spray_droplet, spray_parcel_kg, spray_reach_m, track_film_mm,
    wet_grip,
};

use super::allocations;

fn timeline() -> Timeline {
    let key = |time_s: f64, preset: WeatherPreset| Keyframe {
        time_s,
        conditions: preset.conditions(),
        transition: Transition::Linear,
    };
    Timeline::new(vec![
        key(0.0, WeatherPreset::ALL[0]),
        key(30.0, WeatherPreset::ALL[3]),
        key(90.0, WeatherPreset::ALL[1]),
    ])
    .expect("times rise")
}

#[test]
fn weather_and_its_surfaces_advance_without_allocating() {
    let timeline = timeline();
    let mut surfaces = WeatherSurfaces::new(ArtistSettings::default()).expect("valid");
    let mut column = SurfaceColumn::default();
    let mut artist = ArtistState::default();
    let properties = SurfaceClass::ALL[1].properties();
    let mut bits = 0_u64;
    let count = allocations(|| {
        for i in 0..300 {
            let t = 0.4 * f64::from(i);
            let now = surfaces.advance_along(&timeline, t, t + 0.4).expect("times rise");
            surfaces
                .set_properties(SurfaceClass::ALL[1], properties)
                .expect("valid");
            surfaces.for_each_state_bits(|word| bits ^= word);
            for class in SurfaceClass::ALL {
                black_box((
                    surfaces.wetness(class),
                    surfaces.water_level_mm(class),
                    surfaces.column(class).ledger(),
                ));
            }
            let forcing = ColumnForcing {
                rain_mm_h: now.intensity_mm_h,
                evaporation_mm_h: penman_evaporation_mm_h(&now).max(0.0),
            };
            column.advance(&properties, forcing, 0.4).expect("valid");
            for settings in [ArtistSettings::dynamic_rain(), ArtistSettings::traffic()] {
                artist.advance(&settings, now.intensity_mm_h, 0.4).expect("valid");
            }
            black_box((
                column.state_bits(),
                column.wetness(&properties),
                dalton_evaporation_mm_h(&now),
            ));
            black_box((
                timeline.at(t).is_ok(),
                timeline.is_constant(t, t + 1.0),
                timeline.next_key_after(t),
            ));
            black_box((
                timeline.wind_path_m(t, t + 1.0).is_ok(),
                timeline.mean_intensity_mm_h(t, t + 1.0).is_ok(),
            ));
            black_box(now.lerp(&WeatherConditions::default(), 0.3));
        }
    });
    assert_eq!(count, 0);
    assert!(surfaces.rain_mm() > 0.01 && column.ledger().rain_mm > 0.01 && bits != 0);
}

#[test]
fn films_pores_and_puddles_allocate_nothing() {
    let flow = SheetFlow::new(FlowLaw::Manning { manning_n: 0.015 }, 0.02, 5.0, 50.0).expect("inside the domain");
    let puddle = ParaboloidPuddle::new(20.0).expect("inside the domain");
    let soil = SoilTexture::ALL[3].soil(0.3).expect("inside the domain");
    let grate = Grate {
        perimeter_m: 1.2,
        area_m2: 0.08,
    };
    let (mut film, mut texel, mut level, mut soaked) = (0.0, 0.0_f32, 0.01, 0.0);
    let count = allocations(|| {
        for i in 0..200 {
            let t = f64::from(i);
            film = film_step(film, 1e-5, 1.9, 0.5);
            texel = fast_film_step_f32(texel, 1e-5, 1.9, 0.5);
            level = puddle.level_after_m(level, 1e-6, 1e-7, 1.0);
            soaked = soil.infiltrated_mm(soaked, 40.0, 0.01);
            let state = SurfaceWeights::new(0.005 * t, 1e3 * film, 0.8).expect("inside the domain");
            black_box((state, flow.depth_m(2.0, t, 60.0), grate.drained_depth_m(0.05, 4.0, 1.0)));
            black_box((
                saturated_albedo(0.3, 0.01 * t),
                wet_albedo_rgb([0.3; 3]),
                film_roughness(0.6, 0.05, film, 0.8),
            ));
            black_box(under_water([0.3; 3], &Water::MUDDY, level, 0.8));
        }
    });
    assert_eq!(count, 0);
    assert!(film > 0.0 && texel > 0.0 && soaked > 1.0);
}

fn drop() -> DropImpact {
    DropImpact {
        x_m: 0.5,
        z_m: 0.5,
        diameter_mm: 3.0,
        speed_m_s: 8.0,
    }
}

#[test]
fn waves_of_any_border_on_a_bed_allocate_nothing() {
    for border in [
        Border::Wall,
        Border::Fixed,
        Border::Periodic,
        Border::Open { sponge_cells: 12 },
    ] {
        let mut field = WaveField::new(&WaveSettings {
            cells_x: 96,
            cells_z: 64,
            border,
            ..WaveSettings::default()
        })
        .expect("inside the domain");
        let depths: Vec<f32> = (0..96 * 64).map(|k| if k % 96 < 80 { 0.004 } else { 0.0 }).collect();
        field.set_depths(&depths).expect("shallow enough");
        let heights = vec![1e-4; 96 * 64];
        let count = allocations(|| {
            field.set_depths(&depths).expect("shallow enough");
            field.set_state(&heights, &[]).expect("finite");
            field.add_drop(&drop()).expect("inside the domain");
            for _ in 0..40 {
                field.advance(16_666_667);
            }
            black_box((field.volume_m3(), field.energy(), field.is_calm(1e-9), field.is_still()));
            field.settle(1.0);
        });
        assert_eq!(count, 0, "{border:?}");
    }
}

#[test]
fn fields_that_all_threads_step_allocate_nothing_in_the_pool_and_next_to_nothing_outside() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().expect("a pool");
    for border in [Border::Wall, Border::Periodic] {
        let mut field = WaveField::new(&WaveSettings {
            cells_x: 512,
            cells_z: 512,
            border,
            ..WaveSettings::default()
        })
        .expect("inside the domain");
        field.add_drop(&drop()).expect("inside the domain");
        let inside = pool.install(|| {
            field.step(16);
            allocations(|| field.step(400))
        });
        assert_eq!(inside, 0, "{border:?}");
        // What comes from outside goes through rayon's queue, which grows by blocks of 63.
        // What uses it first starts it.
        field.step(16);
        let outside = allocations(|| field.step(400));
        assert!(outside <= 400 / 16, "{border:?}: {outside}");
        assert!(field.heights().iter().any(|height| *height != 0.0));
    }
}

#[test]
fn rings_are_drawn_without_allocating() {
    let table = RingTable::new();
    let count = allocations(|| {
        let ring = Ring::new(&drop(), 0.005, 1.0).expect("inside the domain");
        for i in 0..100_u8 {
            black_box(table.height_and_slope(&ring, 0.01 * f32::from(i), 0.5));
        }
        black_box((table.lifetime_s(&ring, 1e-3), table.packet(0.3)));
        let rain = rain_core::rainfall::Spectrum::new(rain_core::rainfall::Distribution::MarshallPalmer, 10.0);
        black_box(slope_variance(&rain.expect("inside the domain"), 0.005, 1.0, 0.01));
    });
    assert_eq!(count, 0);
}

#[test]
fn drips_and_spray_allocate_nothing() {
    let sizes = DripSizes::measured(LeafType::NeedleCoated);
    let tyre = Tyre::default();
    let properties = CanopyProperties::default();
    let count = allocations(|| {
        for i in 0..200_u32 {
            let x = 0.1 * f64::from(i);
            black_box((crown_place(1, i, 4.0, 2.0), radial_shares(x)));
            black_box((nearest_drip(x, 0.5, x, 8.0), drip_crest(x, 0.5, x, 8.0)));
            black_box((nearest_drip_f32(x as f32, 0.5, 0.2, 8.0), drip_frequency_hz(1e-9, 4.0)));
            black_box((sizes.diameter_by_volume(0.005 * x), sizes.drawn_mm(1, 2, i)));
            black_box(canopy_shower(properties, 10.0, 0.5, 60.0 * x).is_ok());
            let trail = WheelTrail::new(&tyre, x, 0.5);
            for mechanism in [SprayMechanism::Tread, SprayMechanism::Bow] {
                black_box(spray_droplet(&tyre, mechanism, x as f32, 4, i));
                black_box(spray_parcel_kg(trail.thrown.of(mechanism), 1.0, 1000, 1e-9));
            }
            black_box((spray_reach_m(0.5, 20.0, 0.1), track_film_mm(0.1, 0.5, x, 30.0)));
            black_box((hydroplanes(&tyre, x, 2.0), wet_grip(&tyre, x, 2.0)));
        }
    });
    assert_eq!(count, 0);
}
