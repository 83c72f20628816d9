//! The path of a flash: tortuous, branched.
//!
//! Midpoint displacement: each straight piece is halved and its middle moved across it by a normal share of its length,
//! so that the channel turns alike at every scale, as Hill 1968 found. The share is set so that it turns by 16° between
//! pieces, his mean.

use core::f64::consts::TAU;

use glam::DVec3;

use super::draws::Draws;
use super::flash::{Flash, FlashKind};
use crate::ops;

/// Deviation of a middle's displacement along each axis across a piece, as a share of its length.
const ROUGHNESS: f64 = 0.0465;
/// Height of the charge that flashes come from, over the ground. Units: m. Source: Rakov & Uman 2003, 6–8 km.
const CHARGE_M: f64 = 6500.0;
/// Halvings of the channel under the cloud, of its parts in the cloud, of branches: pieces of some 5, 100 and 10 m.
const SEEN_LEVELS: u32 = 8;
const CLOUD_LEVELS: u32 = 6;
const BRANCH_LEVELS: u32 = 5;

/// The path of a flash, in world coordinates (m).
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    main: Vec<DVec3>,
    seen: usize,
    branches: Vec<Vec<DVec3>>,
}

impl Channel {
    /// The path of a flash; the same for the same flash.
    #[must_use]
    pub fn of(flash: &Flash) -> Self {
        let mut draws = flash.draws();
        match flash.kind {
            FlashKind::ToGround => Self::to_ground(flash, &mut draws),
            FlashKind::InCloud => Self::in_cloud(flash, &mut draws),
        }
    }

    fn to_ground(flash: &Flash, draws: &mut Draws) -> Self {
        let ground = flash.place_m;
        let base = ground + flash.cloud_base_m * (0.22 * across(draws) + DVec3::Y);
        let charge = base.with_y(ground.y + CHARGE_M) + 1000.0 * across(draws);
        let end = charge + draws.between(500.0, 4000.0) * across(draws).normalize_or(DVec3::X);
        let mut main = vec![ground];
        wander(&mut main, base, SEEN_LEVELS, draws);
        // What a kink near the ground throws below it runs along it.
        for point in &mut main {
            point.y = point.y.max(ground.y);
        }
        let seen = main.len();
        wander(&mut main, charge, CLOUD_LEVELS, draws);
        wander(&mut main, end, CLOUD_LEVELS, draws);
        let mut branches = Vec::new();
        let count = 4 + (draws.unit() * 5.0) as usize;
        for _ in 0..count {
            // The lower part of a channel has few branches.
            let at = (draws.between(0.3, 0.97) * (seen - 1) as f64) as usize;
            let length = flash.cloud_base_m * draws.between(0.12, 0.4);
            branch(
                &mut branches,
                main[at],
                main[at.saturating_sub(8)],
                length,
                ground.y,
                draws,
            );
            let own = branches.len() - 1;
            for _ in 0..(draws.unit() * 3.0) as usize {
                let from = &branches[own];
                let at = (draws.between(0.2, 0.8) * (from.len() - 1) as f64) as usize;
                let (start, ahead) = (from[at], from[(at + 4).min(from.len() - 1)]);
                branch(&mut branches, start, ahead, 0.4 * length, ground.y, draws);
            }
        }
        Self { main, seen, branches }
    }

    fn in_cloud(flash: &Flash, draws: &mut Draws) -> Self {
        let height = flash.cloud_base_m + draws.between(700.0, 3000.0);
        let start = flash.place_m + height * DVec3::Y;
        let way = across(draws).normalize_or(DVec3::X);
        let end = start + draws.between(2000.0, 8000.0) * way + draws.between(-500.0, 1500.0) * DVec3::Y;
        let mut main = vec![start];
        wander(&mut main, end, CLOUD_LEVELS + 1, draws);
        Self {
            main,
            seen: 0,
            branches: Vec::new(),
        }
    }

    /// The channel itself, from the ground (or its start within the cloud) on.
    #[must_use]
    pub fn main(&self) -> &[DVec3] {
        &self.main
    }

    /// The part of [`Channel::main`] under the cloud; empty for a flash within it.
    #[must_use]
    pub fn seen(&self) -> &[DVec3] {
        &self.main[..self.seen]
    }

    /// The part within the cloud.
    #[must_use]
    pub fn hidden(&self) -> &[DVec3] {
        &self.main[self.seen.saturating_sub(1)..]
    }

    /// Its branches and their own, each from where it leaves.
    #[must_use]
    pub fn branches(&self) -> &[Vec<DVec3>] {
        &self.branches
    }

    /// Middle of the part within the cloud.
    #[must_use]
    pub fn glow_centre(&self) -> DVec3 {
        let hidden = self.hidden();
        hidden.iter().sum::<DVec3>() / hidden.len() as f64
    }
}

/// Mean angle by which a path turns from piece to piece, when only every `step`-th point counts. Units: rad.
///
/// 0 for fewer than three points, and for a step of 0. Error: 1e-12.
#[must_use]
pub fn mean_turn_rad(path: &[DVec3], step: usize) -> f64 {
    if step == 0 {
        return 0.0;
    }
    let points: Vec<DVec3> = path.iter().step_by(step).copied().collect();
    let turns = points.windows(3).filter_map(|p| {
        let (a, b) = (p[1] - p[0], p[2] - p[1]);
        (a != DVec3::ZERO && b != DVec3::ZERO).then(|| ops::atan2(a.cross(b).length(), a.dot(b)))
    });
    let (sum, count) = turns.fold((0.0, 0.0), |(sum, count), turn| (sum + turn, count + 1.0));
    if count > 0.0 { sum / count } else { 0.0 }
}

/// A level vector of normal components.
fn across(draws: &mut Draws) -> DVec3 {
    let [x, z] = draws.normals();
    DVec3::new(x, 0.0, z)
}

/// Adds a branch that leaves `start` 20° to 55° off the way to `ahead`, never below a tenth of its length over the
/// ground.
fn branch(all: &mut Vec<Vec<DVec3>>, start: DVec3, ahead: DVec3, length: f64, ground: f64, draws: &mut Draws) {
    let way = (ahead - start).normalize_or(DVec3::NEG_Y);
    let angle = draws.between(0.35, 0.95);
    let turn = TAU * draws.unit();
    let [u, v] = frame(way);
    let off = u * ops::cos(turn) + v * ops::sin(turn);
    let mut end = start + length * (way * ops::cos(angle) + off * ops::sin(angle));
    end.y = end.y.max(ground + 0.1 * length);
    let mut path = vec![start];
    wander(&mut path, end, BRANCH_LEVELS, draws);
    for point in &mut path {
        point.y = point.y.max(ground);
    }
    all.push(path);
}

/// Two unit vectors across a unit vector and each other.
fn frame(way: DVec3) -> [DVec3; 2] {
    way.any_orthonormal_pair().into()
}

/// Goes on from the path's end to `to`, in 2^levels pieces.
fn wander(path: &mut Vec<DVec3>, to: DVec3, levels: u32, draws: &mut Draws) {
    let Some(&from) = path.last() else { return };
    if levels == 0 {
        path.push(to);
        return;
    }
    let way = to - from;
    let [u, v] = frame(way.normalize_or(DVec3::Y));
    let [a, b] = draws.normals();
    let middle = 0.5 * (from + to) + ROUGHNESS * way.length() * (a * u + b * v);
    wander(path, middle, levels - 1, draws);
    wander(path, to, levels - 1, draws);
}
