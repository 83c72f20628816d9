//! Weather state: cost of an update per surface class and per tick, Horton against Green and Ampt.

use std::hint::black_box;

use rain_bench::study::{Study, Variant};
use rain_core::surface::SoilTexture;
use rain_core::weather::{
    ArtistSettings, ArtistState, ColumnForcing, SurfaceClass, SurfaceColumn, SurfaceProperties, WeatherConditions,
    WeatherSurfaces,
};
use rain_reference::weather::{Artist, Ground, Level, Water};

/// Every study of this file.
pub fn studies() -> Vec<Study> {
    vec![classes(), ticks(), whole(), artist(), infiltration()]
}

/// Rain mm/h, evaporation mm/h, seconds: wetting, drying, a burst, drying again.
const SPELLS: [(f64, f64, f64); 5] = [
    (12.0, 0.05, 600.0),
    (0.0, 0.4, 600.0),
    (60.0, 0.0, 300.0),
    (2.5, 0.1, 600.0),
    (0.0, 0.6, 900.0),
];

fn ground(p: &SurfaceProperties) -> Ground {
    Ground {
        pores_mm: p.pore_capacity_mm,
        texture_mm: p.texture_depth_mm,
        manning_n: p.manning_n,
        slope: p.slope,
        length_m: p.flow_length_m,
        initial_mm_h: p.infiltration.initial_mm_h,
        final_mm_h: p.infiltration.final_mm_h,
        decay_per_h: p.infiltration.decay_per_h,
        recovery_per_s: p.infiltration.recovery_per_s,
    }
}

/// One run through the spells in ticks of `tick`; film and pores at the ends of the spells.
fn run(p: &SurfaceProperties, tick: f64) -> [f64; 2 * SPELLS.len()] {
    let mut column = SurfaceColumn::default();
    let mut ends = [0.0; 2 * SPELLS.len()];
    for (i, &(rain_mm_h, evaporation_mm_h, seconds)) in SPELLS.iter().enumerate() {
        let forcing = ColumnForcing {
            rain_mm_h,
            evaporation_mm_h,
        };
        for _ in 0..(seconds / tick).round() as u32 {
            column.advance(p, black_box(forcing), tick).expect("valid");
        }
        ends[2 * i] = column.pores_mm();
        ends[2 * i + 1] = column.water_level_mm();
    }
    ends
}

fn reference(p: &SurfaceProperties) -> [f64; 2 * SPELLS.len()] {
    let mut water: Water = [0.0; 7];
    let mut ends = [0.0; 2 * SPELLS.len()];
    for (i, &(rain, evaporation, seconds)) in SPELLS.iter().enumerate() {
        water = ground(p).advanced(water, rain, evaporation, seconds, 0.05);
        (ends[2 * i], ends[2 * i + 1]) = (water[0], water[1]);
    }
    ends
}

fn largest(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

fn updates(tick: f64) -> u64 {
    SPELLS.iter().map(|s| (s.2 / tick).round() as u64).sum()
}

fn classes() -> Study {
    let variants = SurfaceClass::ALL
        .into_iter()
        .map(|class| {
            let (p, tick) = (class.properties(), 1.0 / 32.0);
            let error = largest(&run(&p, tick), &reference(&p));
            let variant = Variant::new(format!("{class:?}, tick 1/32 s"), error, updates(tick), move || {
                run(&p, tick).iter().sum()
            });
            if class == SurfaceClass::Asphalt {
                variant.default()
            } else {
                variant
            }
        })
        .collect();
    Study {
        name: "weather-class",
        title: "Weather state of one surface class",
        norm: "max |water - reference|, mm",
        unit: "class update",
        variants,
    }
}

fn ticks() -> Study {
    let all = SurfaceClass::ALL.map(SurfaceClass::properties);
    let exact = all.each_ref().map(reference);
    let variants = [1.0 / 144.0, 1.0 / 60.0, 1.0 / 32.0, 1.0, 10.0, 60.0, 300.0]
        .into_iter()
        .map(|tick: f64| {
            let off = all.iter().zip(&exact).map(|(p, exact)| largest(&run(p, tick), exact));
            let error = off.fold(0.0, f64::max);
            let name = if tick < 1.0 {
                format!("tick 1/{:.0} s", 1.0 / tick)
            } else {
                format!("tick {tick:.0} s")
            };
            let variant = Variant::new(name, error, 7 * updates(tick), move || {
                all.iter().map(|p| run(p, tick).iter().sum::<f64>()).sum()
            });
            if tick == 1.0 / 32.0 { variant.default() } else { variant }
        })
        .collect();
    Study {
        name: "weather-tick",
        title: "Weather state, mean of the seven classes, by tick",
        norm: "max |water - reference|, mm",
        unit: "class update",
        variants,
    }
}

/// All classes, the artists' levels and evaporation, as the engine calls it.
fn whole() -> Study {
    let conditions = SPELLS.map(|(intensity_mm_h, ..)| WeatherConditions {
        intensity_mm_h,
        ..WeatherConditions::default()
    });
    let all = move |tick: f64| {
        let mut surfaces = WeatherSurfaces::default();
        for (conditions, spell) in conditions.iter().zip(SPELLS) {
            for _ in 0..(spell.2 / tick).round() as u32 {
                surfaces.advance(black_box(conditions), tick).expect("valid");
            }
        }
        surfaces
    };
    let film = |s: &WeatherSurfaces| SurfaceClass::ALL.map(|class| s.water_level_mm(class));
    let exact = film(&all(300.0));
    let variants = [1.0 / 60.0, 1.0 / 32.0, 1.0]
        .into_iter()
        .map(|tick: f64| {
            let error = largest(&film(&all(tick)), &exact);
            let name = format!("seven classes, artists, evaporation; tick {tick:.4} s");
            let variant = Variant::new(name, error, 7 * updates(tick), move || film(&all(tick)).iter().sum());
            if tick == 1.0 / 32.0 { variant.default() } else { variant }
        })
        .collect();
    Study {
        name: "weather-surfaces",
        title: "Whole weather state, per class",
        norm: "max |film - film in one step per spell|, mm",
        unit: "class update",
        variants,
    }
}

fn artist() -> Study {
    let rains = [(2.0, 0.7), (0.0, 3.0), (7.0, 0.6), (0.0, 9.0)];
    let run = move |settings: &ArtistSettings, tick: f64| {
        let mut state = ArtistState::default();
        for (rain, seconds) in rains {
            for _ in 0..(seconds / tick).round() as u32 {
                state.advance(settings, black_box(rain), tick).expect("valid");
            }
        }
        [state.wetness, state.holes, state.puddles]
    };
    let count = |tick: f64| rains.iter().map(|r| (r.1 / tick).round() as u64).sum();
    let mut variants = Vec::new();
    for (name, settings, exponential) in [
        ("Lagarde, linear", ArtistSettings::dynamic_rain(), false),
        ("Nguyenova, exponential", ArtistSettings::traffic(), true),
    ] {
        let level = |l: rain_core::weather::ArtistLevel| Level {
            rise: l.rise_per_s,
            fall: l.fall_per_s,
            target: l.target,
        };
        let slow = Artist {
            exponential,
            levels: [level(settings.wetness), level(settings.holes), level(settings.puddles)],
            gate: settings.flood_gate,
            drizzle_mm_h: settings.drizzle_mm_h,
            delay_s: settings.drying_delay_s,
        };
        let end = rains
            .iter()
            .fold([0.0; 4], |y, &(rain, seconds)| slow.advanced(y, rain, seconds, 1e-4));
        for tick in [0.02, 0.1] {
            let error = largest(&run(&settings, tick), &end[..3]);
            let variant = Variant::new(format!("{name}, tick {tick} s"), error, count(tick), move || {
                run(&settings, tick).iter().sum()
            });
            variants.push(if variants.is_empty() {
                variant.default()
            } else {
                variant
            });
        }
    }
    Study {
        name: "weather-artist",
        title: "Artists' levels",
        norm: "max |level - level in steps of 0.1 ms|",
        unit: "update",
        variants,
    }
}

fn infiltration() -> Study {
    let horton = SurfaceClass::Soil.properties().infiltration;
    let soil = SoilTexture::SandyLoam.soil(0.3).expect("valid");
    let hours: Vec<f64> = (1..=256).map(|i| 0.01 * f64::from(i)).collect();
    let worst = |f: &dyn Fn(f64) -> f64, reference: &dyn Fn(f64) -> f64| {
        let sampled = hours.iter().step_by(16);
        sampled.map(|&t| (f(t) / reference(t) - 1.0).abs()).fold(0.0, f64::max)
    };
    let dry = ground(&SurfaceClass::Soil.properties());
    let slow_horton = |t: f64| rain_reference::numerics::simpson(0.0, 3600.0 * t, 2000, |tau| dry.capacity_mm_s(tau));
    let slow_front = |t: f64| rain_reference::surface::green_ampt(10.9, 0.3 * 110.1, 0.0, t);
    let (a, b, c) = (hours.clone(), hours.clone(), hours.clone());
    let variants = vec![
        Variant::new(
            "Horton, flooded",
            worst(&|t| horton.flooded_mm(3600.0 * t), &slow_horton),
            256,
            move || a.iter().map(|t| horton.flooded_mm(3600.0 * black_box(t))).sum(),
        )
        .default(),
        Variant::new(
            "Green-Ampt, flooded",
            worst(&|t| soil.flooded_mm(t), &slow_front),
            256,
            move || b.iter().map(|&t| soil.flooded_mm(black_box(t))).sum(),
        ),
        Variant::new(
            "Green-Ampt, rain 25 mm/h",
            worst(&|t| soil.infiltrated_mm(0.0, 25.0, t), &|t| {
                rain_reference::surface::green_ampt_rain(10.9, 0.3 * 110.1, 25.0, t)
            }),
            256,
            move || c.iter().map(|&t| soil.infiltrated_mm(0.0, 25.0, black_box(t))).sum(),
        ),
    ];
    Study {
        name: "infiltration",
        title: "Water into soil",
        norm: "max |F/F_ref - 1|",
        unit: "evaluation",
        variants,
    }
}
