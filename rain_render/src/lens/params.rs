//! What a host hands over for a view.

use glam::{UVec2, UVec4, Vec2};
use rain_core::lens::Wipers;

use crate::gpu_types::{LensDrop, LensView};

/// A view through a glass.
#[derive(Debug, Clone, Copy)]
pub struct LensInput<'a> {
    /// The drops.
    pub drops: &'a [LensDrop],
    /// Arms, mode and time.
    pub wipers: &'a Wipers,
    /// Corner and size of the view in its target. Units: px.
    pub viewport_px: UVec4,
    /// Size of the target. Units: px.
    pub target_px: UVec2,
    /// Tangents of half the view's angles.
    pub half_tan: Vec2,
    /// From the eye to the glass. Units: m.
    pub distance_m: f32,
    /// Width of what sees through the glass. Units: m.
    pub aperture_m: f32,
    /// Share of glass that was not wiped that the mist covers. Units: none.
    pub mist: f32,
    /// How fast clear glass is covered. Units: 1/s.
    pub mist_per_s: f32,
}

impl LensInput<'_> {
    /// The parameters.
    pub(super) fn view(&self) -> LensView {
        let wipers = self.wipers;
        let [period, moving] = wipers.mode.cycle_s().unwrap_or([1.0; 2]);
        let swing = wipers.swing();
        LensView {
            viewport: self.viewport_px.as_vec4().to_array(),
            arms: wipers.arms.map(|arm| {
                arm.map_or([0.0; 4], |arm| {
                    let ([x, y], [begin, end]) = (arm.pivot_m, arm.blade_m);
                    [x as f32, y as f32, begin as f32, end as f32]
                })
            }),
            turns: wipers.arms.map(|arm| {
                arm.map_or([0.0, 1.0, 0.0, 0.0], |arm| {
                    let [rest, far] = arm.turn_rad;
                    [rest as f32, far as f32, 1.0, (rest + swing * (far - rest)) as f32]
                })
            }),
            cycle: [
                period as f32,
                moving as f32,
                (wipers.time_s % period) as f32,
                wipers.time_s.min(1e6) as f32,
            ],
            size: self.target_px.as_vec2().to_array(),
            half_tan: self.half_tan.to_array(),
            distance: self.distance_m,
            aperture: self.aperture_m,
            mist: self.mist,
            mist_per_s: self.mist_per_s,
            wiping: f32::from(u8::from(wipers.mode.cycle_s().is_some())),
            ..LensView::default()
        }
    }
}
