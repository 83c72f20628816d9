//! Steps in water of the last moments, which views show.

use std::collections::VecDeque;

use bevy::prelude::*;
use rain_core::hash::pcg3d;
use rain_core::splash::FOOT_SPLASH_S;
use rain_ecs::prelude::*;
use rain_render::splash::{MAX_FEET, StepSplash};

/// A step that has splashed.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Step {
    /// On the water. Units: m, world.
    place: Vec3,
    /// The clock's time then. Units: s.
    at_s: f64,
    strength: f32,
    key: [u32; 3],
}

/// The latest steps, as many as a view draws; the newest last.
#[derive(Resource, Clone, Debug, Default)]
pub(super) struct RecentSteps(VecDeque<Step>);

/// The clock's time of this frame, which lies between ticks. Units: s.
pub(super) fn frame_time_s(clock: &RainClock) -> f64 {
    clock.now_s() + f64::from(clock.interpolation()) * clock.tick_ns() as f64 * 1e-9
}

impl RecentSteps {
    fn add(&mut self, splash: &FootSplash, seed: u64, now_s: f64) {
        let place = splash.place + splash.depth_m * Vec3::Y;
        if !place.is_finite() {
            return;
        }
        if self.0.len() == MAX_FEET {
            self.0.pop_front();
        }
        let moment = (1e3 * now_s) as u64 ^ seed;
        let key = pcg3d([
            place.x.to_bits() ^ moment as u32,
            place.z.to_bits() ^ (moment >> 32) as u32,
            splash.strength.to_bits(),
        ]);
        self.0.push_back(Step {
            place,
            at_s: now_s,
            strength: splash.strength,
            key,
        });
    }

    /// Forgets those whose drops have landed, and after a leap back in time those to come.
    fn forget(&mut self, now_s: f64) {
        self.0
            .retain(|step| (0.0..f64::from(FOOT_SPLASH_S)).contains(&(now_s - step.at_s)));
    }

    /// What is in the air at `now_s`; places in the world.
    pub(super) fn shown(&self, now_s: f64) -> Vec<StepSplash> {
        let shown = |step: &Step| StepSplash {
            place_m: step.place,
            age_s: (now_s - step.at_s) as f32,
            strength: step.strength,
            key: step.key,
        };
        self.0.iter().map(shown).collect()
    }
}

pub(super) fn keep_steps(
    clock: Res<RainClock>,
    seed: Res<RainSeed>,
    mut splashes: MessageReader<FootSplash>,
    mut recent: ResMut<RecentSteps>,
) {
    if splashes.is_empty() && recent.0.is_empty() {
        return;
    }
    let now_s = frame_time_s(&clock);
    recent.forget(now_s);
    for splash in splashes.read() {
        recent.add(splash, seed.0, now_s);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_few_land_and_are_not_seen_before_they_were() {
        let splash = |x: f32| FootSplash {
            foot: None,
            place: Vec3::new(x, 0.5, 0.0),
            depth_m: 0.02,
            strength: 0.7,
            sound: SurfaceSound {
                wetness: SoundWetness::Puddle,
                class: SurfaceClass::Asphalt,
            },
        };
        let mut recent = RecentSteps::default();
        for i in 0..20_u8 {
            recent.add(&splash(i.into()), 3, 10.0);
        }
        recent.add(&splash(f32::NAN), 3, 10.0);
        let shown = recent.shown(10.25);
        assert_eq!(shown.len(), MAX_FEET);
        assert_eq!(shown[MAX_FEET - 1].place_m, Vec3::new(19.0, 0.52, 0.0));
        assert!(
            shown
                .iter()
                .all(|step| (step.age_s - 0.25).abs() < 1e-6 && step.strength == 0.7)
        );
        assert!(shown.windows(2).all(|pair| pair[0].key != pair[1].key));
        let mut rewound = recent.clone();
        recent.forget(10.49);
        rewound.forget(9.9);
        assert_eq!((recent.shown(10.49).len(), rewound.shown(9.9).len()), (MAX_FEET, 0));
        recent.forget(10.51);
        assert!(recent.shown(10.51).is_empty());
    }
}
