//! Water that was saved and put back goes on as it did.

use rain_core::waves::Push;
use rain_render::waves::{Disturbance, SavedWaves, WaveTileSettings};

use super::{Puddles, bare, largest, pond};
use crate::device::{Device, device};

/// Waves of half a second in a pond.
fn waving(gpu: &Device, settings: &WaveTileSettings) -> Puddles {
    let mut puddles = Puddles::new(gpu, settings);
    let half = 0.5 * puddles.tile.side_m();
    puddles.tile.follow([half; 2], pond);
    run(gpu, &mut puddles, 0..30);
    puddles
}

/// Frames of a sixtieth of a second; the tile moves away by and by, and something drops now and then.
fn run(gpu: &Device, puddles: &mut Puddles, frames: std::ops::Range<u32>) {
    let half = 0.5 * puddles.tile.side_m();
    for index in frames {
        let stone = Disturbance {
            from_m: [0.5, 0.6],
            to_m: [0.55, 0.6],
            width_m: 0.05,
            push: Push::Height(0.004),
        };
        let way = half + 0.01 * f64::from(index);
        puddles.tile.follow([way, half], pond);
        let drops = index % 7 == 2;
        puddles.frame(gpu, 16_666_667, if drops { core::slice::from_ref(&stone) } else { &[] });
    }
}

fn save(gpu: &Device, puddles: &Puddles) -> SavedWaves {
    let [now, before] = puddles.rig.levels(gpu);
    puddles.tile.save([&now, &before]).unwrap()
}

#[test]
fn waves_that_are_put_back_go_on_bit_for_bit() {
    let Some(gpu) = device() else { return };
    let settings = bare();
    let mut first = waving(&gpu, &settings);
    let saved = save(&gpu, &first);
    assert!(
        saved.heights_m.iter().all(|level| largest(level) > 1e-4),
        "there are waves"
    );
    // Into a tile that has seen other waves, and into a new one.
    let mut other = waving(&gpu, &settings);
    run(&gpu, &mut other, 40..49);
    let mut fresh = Puddles::new(&gpu, &settings);
    run(&gpu, &mut first, 30..70);
    let end = save(&gpu, &first);
    for puddles in [&mut other, &mut fresh] {
        puddles.tile.restore(&saved).unwrap();
        run(&gpu, puddles, 30..70);
        assert_eq!(save(&gpu, puddles), end);
    }
    // Without its heights the water is another.
    let mut flat = saved;
    flat.heights_m.iter_mut().flatten().for_each(|height| *height = 0.0);
    fresh.tile.restore(&flat).unwrap();
    run(&gpu, &mut fresh, 30..70);
    assert_ne!(save(&gpu, &fresh).heights_m, end.heights_m);
}
