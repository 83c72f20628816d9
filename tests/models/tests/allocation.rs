//! No update and no question that a game asks each frame allocates. Basins are counted in their own file.

mod air;
mod cover;
mod ground;

use glam::{DVec3, Vec4};
use rain_core::canopy::{CanopyKind, CanopyProperties, CanopyStore, DripClock, DripPlan, DripSizes, LeafType};
use rain_core::rainfall::{
    ClassWeights, Container, DiameterTable, Distribution, DropOutline, DropSizes, FieldMotion, Oscillation, RainKind,
    RainViewVolume, Spectrum, WindResponse, terminal_velocity,
};
use rain_core::waves::{DropImpact, Push, SweptSource, WaveField, WaveSettings};
use rain_core::wheels::{SprayEmitter, SprayMechanism, Tyre, WheelWater};

/// Allocations of `update`.
fn allocations(update: impl FnOnce()) -> u64 {
    allocation_counter::measure(update).count_total
}

/// What a camera 60° wide sees in one frame.
fn view() -> RainViewVolume {
    let plane = |x: f32, y: f32| Vec4::new(x, y, -0.6, 0.0);
    RainViewVolume {
        eye_m: DVec3::new(10.3, 1.7, -4.0),
        eye_velocity_m_s: DVec3::ZERO,
        side_planes: [plane(0.8, 0.0), plane(-0.8, 0.0), plane(0.0, 0.8), plane(0.0, -0.8)],
        focal_px: 620.0,
        solid_angle_sr: 1.0,
        exposure_s: 1.0 / 60.0,
        turn_rad: 0.0,
        parallel: None,
    }
}

#[test]
fn the_counter_counts() {
    assert_eq!(allocations(|| drop(std::hint::black_box(vec![1_u8; 9]))), 1);
}

#[test]
fn a_change_of_rain_allocates_nothing() {
    let count = allocations(|| {
        for i in 0..100 {
            let rate = 0.5 * f64::from(i);
            let spectrum = Spectrum::new(Distribution::Thunderstorm, rate).expect("inside the domain");
            std::hint::black_box(ClassWeights::new(&spectrum));
            let sizes = DropSizes::new(RainKind::Gamma, rate).expect("inside the domain");
            std::hint::black_box(DiameterTable::<64>::on_ground(&sizes, 0.2, 6.0, terminal_velocity).ok());
        }
    });
    assert_eq!(count, 0);
}

#[test]
fn a_view_is_filled_without_allocating_once_it_has_been_as_full() {
    let spectrum = Spectrum::new(Distribution::MarshallPalmer, 25.0).expect("inside the domain");
    let view = view();
    let mut motion = FieldMotion::default();
    motion.set_velocity(DVec3::new(3.0, 0.0, 0.0), 1.2);
    let mut container = Container::default();
    for _ in 0..40 {
        motion.advance(1.0 / 60.0);
        assert!(container.fill(7, &spectrum, &motion, &view, 0.7, 100_000));
    }
    let drops = container.records.len();
    let count = allocations(|| {
        for _ in 0..20 {
            motion.advance(1.0 / 60.0);
            assert!(container.fill(7, &spectrum, &motion, &view, 0.6, 100_000));
        }
    });
    assert_eq!(count, 0);
    assert!(drops > 500, "{drops}");
}

#[test]
fn drops_in_the_air_are_moved_without_allocating() {
    let mut wind = WindResponse::following(DVec3::ZERO);
    let mut swing = Oscillation::sustained(4.0, 0.2);
    let outline = DropOutline::new(4.0);
    let count = allocations(|| {
        for i in 0..200 {
            let gust = DVec3::new(f64::from(i % 7), 0.0, 1.0);
            wind.advance(6.5, gust, -gust, 1.0 / 32.0);
            swing.advance(1.0 / 60.0);
            std::hint::black_box(swing.outline(&outline).radius(0.3));
        }
    });
    assert_eq!(count, 0);
}

#[test]
fn canopies_and_wheels_allocate_nothing() {
    let properties = CanopyProperties {
        kind: CanopyKind::Broadleaf,
        ..CanopyProperties::default()
    };
    let mut store = CanopyStore::new(properties).expect("inside the domain");
    let sizes = DripSizes::measured(LeafType::BroadleafMatte);
    let plan = DripPlan::new(3, &sizes, &[0.5, 1.0, 2.0, 3.0], 4.0, 2.0).expect("inside the domain");
    let mut clock = DripClock::default();
    let tyre = Tyre::default();
    let mut emitter = SprayEmitter::default();
    let count = allocations(|| {
        for i in 0..500 {
            let fluxes = store.advance(f64::from(i % 40), 0.2, 1.0 / 32.0);
            clock.advance(fluxes.drip_m3(50.0));
            for place in 0..plan.len() {
                std::hint::black_box((clock.released(&plan, place), sizes.drawn_mm(3, place as u32, i)));
            }
            let water = WheelWater::new(&tyre, 0.1 * f64::from(i), 0.5);
            std::hint::black_box(emitter.advance(water.of(SprayMechanism::Tread), 1.0 / 32.0, 1e-3));
        }
    });
    assert_eq!(count, 0);
}

#[test]
fn waves_step_and_are_disturbed_without_allocating() {
    let mut field = WaveField::new(&WaveSettings::default()).expect("the default is valid");
    let drop = DropImpact {
        x_m: 1.0,
        z_m: 0.9,
        diameter_mm: 3.0,
        speed_m_s: 8.0,
    };
    let wheel = SweptSource {
        from_m: [0.5, 0.5],
        to_m: [0.8, 0.6],
        width_m: 0.05,
        push: Push::Impulse(0.5),
    };
    let mut slopes = vec![[0.0; 2]; field.heights().len()];
    field.add_drop(&drop).expect("inside the domain");
    let count = allocations(|| {
        for _ in 0..20 {
            field.add_drop(&drop).expect("inside the domain");
            field.add_swept(&wheel).expect("inside the domain");
            field.advance(16_666_667);
            field.write_slopes(&mut slopes);
        }
    });
    assert_eq!(count, 0);
    assert!(slopes.iter().any(|slope| slope[0] != 0.0));
}
