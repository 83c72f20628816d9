//! Mouths of eaves and pipes near a view, as they pour this frame.

use bevy::math::{DVec3, Vec2};
use bevy::prelude::*;
use rain_core::hash::pcg3d;
use rain_core::spout::{EaveMouth, Outflow, SpoutFall, eave_mouth, eave_mouths};
use rain_core::surface::ground::Ground;
use rain_ecs::prelude::*;
use rain_render::splash::{MAX_MOUTHS, SpoutStream};

/// Mouths are drawn to here. Units: m.
pub(super) const SPOUT_REACH_M: f32 = 45.0;
/// How far down ground is looked for where none is known. Units: m.
const DEEPEST_M: f64 = 15.0;
/// Parcels of a mouth that a view can show in the air.
const PARCELS: f64 = 44.0;
/// Half, a quarter and an eighth of an eave's mouths are seen to here, the others farther; each fades over 30 % more.
/// Units: m.
const THINNED_M: [f32; 3] = [8.0, 16.0, 28.0];

/// Share to which mouth `index` of an eave is seen at a distance, and what those that are seen stand for.
fn thinned(index: u32, distance_m: f32) -> [f32; 2] {
    let seen = |level: usize| {
        THINNED_M
            .get(level)
            .map_or(1.0, |&end| 1.0 - ((distance_m / end - 1.0) / 0.3).clamp(0.0, 1.0))
    };
    let mean = 0.5 * seen(0) + 0.25 * seen(1) + 0.125 * seen(2) + 0.125;
    [seen(index.trailing_zeros().min(3) as usize), 1.0 / mean]
}

/// Parcels of mouths in the air. Units: none.
pub(super) fn in_air(mouths: &[SpoutStream]) -> u32 {
    mouths
        .iter()
        .map(|mouth| (mouth.limit_s / mouth.period_s).ceil())
        .sum::<f32>() as u32
}

/// What all spouts of a frame have in common.
pub(super) struct Pouring<'a> {
    /// Since the last tick, which the flows are means of. Units: s.
    pub since_tick_s: f64,
    pub wind_m_s: DVec3,
    pub ground: Option<&'a Ground>,
    pub seed: u64,
}

impl Pouring<'_> {
    /// How long what falls from `mouth` may fall.
    fn limit_s(&self, mouth: DVec3, fall: &SpoutFall) -> f64 {
        let ground = self.ground.and_then(|ground| ground.height_at(mouth.x, mouth.z));
        // A little farther: kerbs and hollows beside it.
        let height = ground.map_or(DEEPEST_M, |ground| mouth.y - ground + 0.3);
        fall.time_to_fall_s(height.clamp(0.1, 60.0)).min(10.0)
    }

    /// Adds the mouths of a spout that are seen from `eye`; places in the world.
    pub fn add(&self, eye: Vec3, spout: (Entity, &SpoutWater, &GlobalTransform), out: &mut Vec<SpoutStream>) {
        let (entity, water, pose) = spout;
        let (Some(spout), flow) = (water.spout(), water.flow_m3_s()) else {
            return;
        };
        let (_, rotation, place) = pose.to_scale_rotation_translation();
        let half = match spout.form {
            SpoutForm::Eave { length_m } => 0.5 * length_m,
            SpoutForm::Pipe { .. } => 0.0,
        };
        // What is not a number is nowhere near.
        let near = place.distance(eye) < SPOUT_REACH_M + half;
        if flow <= 0.0 || !near || !rotation.is_finite() {
            return;
        }
        let forward = rotation * Vec3::NEG_Z;
        let outward = Vec2::new(forward.x, forward.z).normalize_or_zero();
        let poured = water.poured_m3() + flow * self.since_tick_s;
        let [key, ..] = pcg3d([entity.index_u32(), self.seed as u32, (self.seed >> 32) as u32]);
        match spout.form {
            SpoutForm::Pipe { diameter_m } => {
                let outflow = Outflow::of_pipe(flow, diameter_m.into());
                let distance = place.distance(eye);
                if let Some(outflow) = outflow.filter(|_| distance < SPOUT_REACH_M) {
                    let drops = poured / outflow.drop_m3;
                    out.push(self.stream(place, forward, outward, &outflow, drops, 1.0, [key, 0]));
                }
            }
            SpoutForm::Eave { length_m } => {
                let along = rotation * Vec3::X;
                let count = eave_mouths(length_m.into());
                let spacing = length_m / count as f32;
                for index in 0..count {
                    // Where it stands but for a third of the spacing: most far ones go before anything is worked out.
                    let about = spacing * (index as f32 + 0.5) - 0.5 * length_m;
                    let distance = (place + along * about).distance(eye);
                    let [seen, weight] = thinned(index, distance);
                    if distance >= SPOUT_REACH_M || seen <= 0.0 || out.len() >= MAX_MOUTHS {
                        continue;
                    }
                    let EaveMouth { along_m, share, phase } = eave_mouth(index, count, length_m.into(), key);
                    let at = place + along * (along_m as f32 - 0.5 * length_m);
                    let share = share / f64::from(count);
                    let Some(outflow) = Outflow::of_eave(flow * share) else {
                        continue;
                    };
                    let drops = poured * share / outflow.drop_m3 + phase;
                    let weight = seen * weight;
                    out.push(self.stream(at, Vec3::NEG_Y, outward, &outflow, drops, weight, [key, index]));
                }
            }
        }
    }

    /// One mouth that has let go `drops` so far, each shown as `weight` of them.
    fn stream(
        &self,
        place: Vec3,
        direction: Vec3,
        outward: Vec2,
        outflow: &Outflow,
        drops: f64,
        weight: f32,
        key: [u32; 2],
    ) -> SpoutStream {
        // A jet that lands whole is not slowed by the air.
        let of_drop = SpoutFall::new(DVec3::NEG_Y * outflow.speed_m_s, Some(outflow.drop_mm()), self.wind_m_s);
        let whole = outflow.breakup_s > of_drop.time_to_fall_s(2.0);
        let drop_mm = (!whole).then(|| outflow.drop_mm());
        let fall = SpoutFall::new(direction.as_dvec3() * outflow.speed_m_s, drop_mm, self.wind_m_s);
        let limit_s = self.limit_s(place.as_dvec3(), &fall);
        // As many drops to a parcel as let a view show all in the air, in octaves: the parcels stay as they are while the
        // flow changes.
        let in_air = limit_s * outflow.drops_per_s();
        let merged = f64::from((in_air / PARCELS).max(1.0).ceil() as u32)
            .log2()
            .ceil()
            .exp2();
        SpoutStream {
            place_m: place,
            velocity_m_s: fall.velocity_m_s().as_vec3(),
            terminal_m_s: fall.terminal_m_s() as f32,
            period_s: (merged / outflow.drops_per_s()) as f32,
            released: drops / merged,
            limit_s: limit_s as f32,
            outward,
            jet_m: outflow.diameter_m as f32 * weight,
            breakup_s: outflow.breakup_s as f32,
            drop_mm: outflow.drop_mm() as f32,
            weight: weight * merged as f32,
            key,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fewer_mouths_are_seen_far_away_and_stand_for_all() {
        for distance in [1.0, 7.9, 9.0, 12.0, 19.0, 25.0, 33.0, 44.0_f32] {
            let sum: f32 = (0..64)
                .map(|index| {
                    let [seen, weight] = thinned(index, distance);
                    seen * weight
                })
                .sum();
            // Mouth 0 of 64 is one of the eighth.
            assert!((sum - 64.0).abs() < 1e-3, "{distance}: {sum}");
        }
        assert!((0..64).filter(|&i| thinned(i, 44.0)[0] > 0.0).count() == 8);
    }
}
