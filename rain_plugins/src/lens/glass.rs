//! The glass of a camera: what is on it and what of it a frame shows.

use std::sync::Arc;

use bevy::prelude::*;
use rain_core::lens::{Glass, GlassImpacts, Wipers};
use rain_core::rainfall::Spectrum;
use rain_render::gpu_types::LensDrop;

use super::view::LensDrops;
use crate::rainfall::ViewMotion;

/// Longest a running drop is drawn, over its width.
const MOST_STRETCH: f32 = 1.8;

/// What impacts are made from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Source {
    pub spectrum: Spectrum,
    pub normal: bevy::math::DVec3,
    pub air_m_s: bevy::math::DVec3,
    pub gust_m_s: f64,
}

/// The water on the glass of a camera with [`LensDrops`](super::LensDrops).
#[derive(Component, Clone, Debug)]
pub struct LensGlass {
    pub(super) glass: Glass,
    /// The last settings that validated.
    pub(super) settings: LensDrops,
    pub(super) motion: ViewMotion,
    /// The second up to which it has been followed.
    pub(super) now_s: f64,
    pub(super) impacts: Option<(Source, GlassImpacts)>,
    pub(crate) shot: Option<LensShot>,
    /// Kept from frame to frame so that nothing is allocated.
    spare: Vec<Arc<Vec<LensDrop>>>,
}

impl Default for LensGlass {
    fn default() -> Self {
        Self {
            glass: Glass::new(0),
            settings: LensDrops::default(),
            motion: ViewMotion::default(),
            now_s: 0.0,
            impacts: None,
            shot: None,
            spare: Vec::new(),
        }
    }
}

impl LensGlass {
    /// The drops, the mist, where their water went.
    #[must_use]
    pub fn glass(&self) -> &Glass {
        &self.glass
    }

    /// Whether this frame draws the glass.
    #[must_use]
    pub fn draws(&self) -> bool {
        self.shot.is_some()
    }

    /// These settings, or the last ones that were valid.
    pub(super) fn last_good(&mut self, drops: &LensDrops) -> LensDrops {
        if let Ok(good) = drops.validated() {
            self.settings = good;
        }
        self.settings
    }

    /// The drops `since_s` after the last tick.
    pub(super) fn drops_after(&mut self, since_s: f64) -> Arc<Vec<LensDrop>> {
        if let Some(old) = self.shot.take() {
            self.spare.push(old.drops);
            self.spare.truncate(3);
        }
        let free = self.spare.iter().position(|drops| Arc::strong_count(drops) == 1);
        let mut drops = free.map(|i| self.spare.swap_remove(i)).unwrap_or_default();
        if let Some(drops) = Arc::get_mut(&mut drops) {
            drops.clear();
            drops.extend(self.glass.drops().iter().map(|drop| {
                let [vx, vy] = drop.velocity_m_s;
                let velocity = Vec2::new(vx as f32, vy as f32);
                let radius = drop.radius_m as f32;
                LensDrop {
                    place: [0, 1].map(|i| (drop.place_m[i] + drop.velocity_m_s[i] * since_s) as f32),
                    along: velocity.normalize_or(Vec2::X).to_array(),
                    radius,
                    // Chosen by eye: a drop at 0.2 m/s is half as long again.
                    stretch: (1.0 + 2.5 * velocity.length()).min(MOST_STRETCH),
                    key: drop.key,
                    pad_a: 0,
                }
            }));
        }
        drops
    }
}

/// A view's glass at a moment.
#[derive(Clone, Debug)]
pub(crate) struct LensShot {
    pub drops: Arc<Vec<LensDrop>>,
    pub wipers: Wipers,
    pub half_tan: Vec2,
    pub distance_m: f32,
    pub aperture_m: f32,
    pub mist: f32,
    pub mist_per_s: f32,
}
