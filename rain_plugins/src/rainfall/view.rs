//! Each view's drops: what those that a marked camera draws this frame are chosen from.

use std::sync::Arc;

use bevy::math::{DVec2, DVec3, Vec4};
use bevy::prelude::*;
use rain_core::error::{ConfigError, in_range};
use rain_core::rainfall::areas::AreaField;
use rain_core::rainfall::{
    Container, DetailLaw, DropChoice, FADE_END, Follow, FollowSettings, LEAD_CAP_M, MAX_LAMPS, RANGE_CAP_M,
    RainViewVolume, RateLadder, Spectrum, UnevenRain, expected_drops, quality_for_budget,
};
use rain_ecs::prelude::*;
use rain_render::rainfall::Shutter;

use super::cards::{CardViewFrame, LatticeState, fill_cards};
use super::frame_budget::{RainFrameBudget, RainShare, hold_frame_budget};
use super::lamps::{ViewLamps, choose_lamps};
use super::motion::ViewMotion;
use super::panes::{SeenThrough, ViewPanes, choose_panes, mark_blended};
use super::parallel::parallel_volume;
use super::settings::CardSettings;
use crate::cover::AirAroundView;
use crate::held::keep_good;
use crate::report::{PassName, RainReport, SkipReason};
use crate::schedule::RainViewSystems;

/// Largest accepted number of streaks in a view.
pub const MAX_STREAK_BUDGET: u32 = 4_000_000;

/// Lamps that light a view's rain by default on a software adapter.
const SOFTWARE_LAMPS: usize = 16;

/// Largest accepted contrast gain.
pub const MAX_CONTRAST: f32 = 32.0;

/// Put on the 3D camera that should see rain.
///
/// Requires nothing else: with a `DepthPrepass` on the camera, streaks fade softly where they meet the scene; without
/// one they end at a hard depth test.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default)]
#[require(ViewMotion, RainViewFrame, CardViewFrame, ViewLamps, ViewPanes)]
pub struct RainView {
    /// Draws rain in this view.
    pub enabled: bool,
    /// How many streaks to draw singly; `None`: 30,000 on a software adapter, 100,000 on a GPU. Domain: [0, 4·10⁶].
    /// The number is spent on the drops with the most contrast. [`RainFrameBudget`] draws a share of it where frames would
    /// take too long.
    pub streak_budget: Option<u32>,
    /// Gain on streak contrast alone: 1 is physical, 1…32. Default: 4, by eye: physical streaks are 1–3 % opaque and
    /// vanish in a game's picture; above 8 rain looks drawn.
    pub contrast: f32,
    /// Shutter time, of the scene's clock: in slow motion a camera's own is as much shorter. Units: s. Domain: [0.0001, 0.25].
    /// Default: 1/60. Longer: longer and fainter streaks.
    pub exposure_s: f32,
    /// Distance over which streaks fade where they meet the scene (needs `DepthPrepass` and `Msaa::Off`). Units: m. Default: 0.15.
    pub soft_m: f32,
    /// Draws only the drops in a container that follows the view: a semi-cylinder or a block. Default: none, all of the
    /// view as far as drops are drawn singly.
    #[reflect(ignore)]
    pub container: Option<FollowSettings>,
    /// Draws fewer single drops, and larger ones, by their distance over 15 m. Default: none, every drop as large as it is.
    /// That keeps the optical depth, and so does [`DetailLaw::OpticalDepth`]; up to 15 m [`DetailLaw::QUADRATIC`] takes out
    /// 30 % less light, [`DetailLaw::GAUSSIAN`] 48 % less.
    #[reflect(ignore)]
    pub detail: Option<DetailLaw>,
    /// Draws the rain beyond the single drops as cards of many drops each; see [`super::CardSettings`]. `None`: on a GPU,
    /// not on a software adapter, where they cost several times as much as the single drops.
    pub cards: Option<bool>,
    /// Draws showers that are seen from outside as particles of many drops each, over a haze that is as much thinner; how
    /// many is set by [`HazeSettings::far_rain`](crate::haze::HazeSettings::far_rain), and without haze there are none. `None`: on
    /// a GPU, not on a software adapter.
    pub far_rain: Option<bool>,
    /// Streaks that are wider than a pixel and a half show what their drops do: the surroundings refracted upside down, glints
    /// of the sun and of the strongest lamp, and how they swing; wholly from four pixels on. The others stay as they are.
    /// `Some(false)`: all streaks are even strips. `None`: on a GPU, not on a software adapter, where a picture full of wide
    /// streaks takes ten times as long.
    pub near_patterns: Option<bool>,
    /// How many of the scene's point and spot lights light the rain, those first that give most to the rain ahead. Domain: [0, 64].
    /// `None`: 64 on a GPU, 16 on a software adapter. In a street of 176 lamps 48 leave out 0.04 % of the light, 16 a
    /// quarter at a third of the time for each drop that is lit.
    pub lamps: Option<u32>,
    /// Orthographic views only: how far ahead of the camera the middle of the drawn rain lies, which reaches 15 m before and
    /// behind it. Units: m. Domain: [−10⁴, 10⁴]. `None`: just before the ground at height 0 that the picture's lower rim sees, so that
    /// rain is even all over it; 10 m where it sees none. Splashes, puddles, lamps and the map of cover are kept for what is seen
    /// there in the middle of the picture; with `None` for the ground at height 0 there.
    pub focus_m: Option<f32>,
}

impl Default for RainView {
    fn default() -> Self {
        Self {
            enabled: true,
            streak_budget: None,
            contrast: 4.0,
            exposure_s: 1.0 / 60.0,
            soft_m: 0.15,
            container: None,
            detail: None,
            cards: None,
            far_rain: None,
            near_patterns: None,
            lamps: None,
            focus_m: None,
        }
    }
}

impl RainView {
    /// These settings, if every field lies in its domain.
    ///
    /// # Errors
    /// Names the first field that is not finite or outside its domain.
    pub fn validated(self) -> Result<Self, ConfigError> {
        in_range(
            "contrast",
            f64::from(self.contrast),
            1.0,
            f64::from(MAX_CONTRAST),
            "1 to 32",
        )?;
        in_range(
            "exposure_s",
            f64::from(self.exposure_s),
            f64::from(1e-4_f32),
            0.25,
            "0.0001 to 0.25 s",
        )?;
        in_range("soft_m", f64::from(self.soft_m), 0.0, 10.0, "0 to 10 m")?;
        let budget = self.streak_budget.unwrap_or_default();
        in_range(
            "streak_budget",
            f64::from(budget),
            0.0,
            f64::from(MAX_STREAK_BUDGET),
            "0 to 4000000",
        )?;
        in_range(
            "lamps",
            f64::from(self.lamps.unwrap_or_default()),
            0.0,
            MAX_LAMPS as f64,
            "0 to 64",
        )?;
        let focus = f64::from(self.focus_m.unwrap_or_default());
        in_range("focus_m", focus, -1e4, 1e4, "-10000 to 10000 m")?;
        if let Some(container) = self.container {
            container.validated()?;
        }
        if let Some(law) = self.detail {
            law.validated()?;
        }
        Ok(self)
    }
}

impl RainView {
    /// The number of streaks in force.
    pub(super) fn budget(&self, software: SoftwareAdapter, share: &RainShare) -> u32 {
        share.of(self.streak_budget.unwrap_or(if software.0 { 30_000 } else { 100_000 }))
    }

    /// Whether cards are drawn.
    pub(super) fn draws_cards(&self, software: SoftwareAdapter) -> bool {
        self.cards.unwrap_or(!software.0)
    }

    /// Whether near streaks have patterns.
    fn draws_patterns(&self, software: SoftwareAdapter) -> bool {
        self.near_patterns.unwrap_or(!software.0)
    }

    /// How many lamps light its rain.
    pub(super) fn most_lamps(&self, software: SoftwareAdapter) -> usize {
        let most = if software.0 { SOFTWARE_LAMPS } else { MAX_LAMPS };
        self.lamps.map_or(most, |lamps| lamps as usize)
    }

    /// Whether far rain is drawn.
    pub(crate) fn draws_far_rain(&self, software: SoftwareAdapter) -> bool {
        self.far_rain.unwrap_or(!software.0)
    }
}

/// Quality κ that a view had.
#[derive(Clone, Copy, Debug)]
struct Quality {
    kappa: f64,
    /// What it is going to be, and for what.
    target: f64,
    of: QualityOf,
    /// When. Units: s.
    set_s: f64,
    /// Of the picture.
    size_px: UVec2,
}

/// What the quality that a budget allows depends on: in a view that only moves through steady rain it stays.
#[derive(Clone, Copy, Debug, PartialEq)]
struct QualityOf {
    spectrum: Spectrum,
    focal_px: f64,
    solid_angle_sr: f64,
    /// Of a view without perspective; its height follows from the focal length.
    width_m: f64,
    exposure_s: f64,
    budget: u32,
    /// How much more the view holds because it moves, in steps of 3 %.
    growth: i32,
}

/// What a view draws this frame; extracted to the render world.
#[derive(Component, Clone, Debug, Default)]
pub struct RainViewFrame {
    /// What its drops are chosen from, where it has any.
    pub choice: Option<DropChoice>,
    /// Shutter and quality.
    pub shutter: Option<Shutter>,
    /// The last valid settings.
    settings: RainView,
    /// Quality in force.
    quality: Option<Quality>,
    /// Where a container that was asked for stands.
    follow: Option<Follow>,
    /// Motion over the exposure.
    pub motion: ViewMotion,
}

impl RainViewFrame {
    /// Whether this frame draws rain.
    #[must_use]
    pub fn draws(&self) -> bool {
        self.shutter.is_some()
    }

    /// Focal length, 0 where the view has drawn no rain yet. Units: px.
    #[must_use]
    pub fn focal_px(&self) -> f64 {
        self.choice.as_ref().map_or(0.0, |choice| choice.view.focal_px)
    }

    /// The drops that this frame draws singly, for those who want to know them: the GPU chooses the same ones for itself.
    /// None where it draws no rain. Takes some 100 ns a drop.
    #[must_use]
    pub fn drops(&self) -> Container {
        let mut drops = Container::default();
        if let Some(choice) = self.choice.as_ref().filter(|_| self.draws()) {
            // Beyond the limit the GPU leaves out the same ones.
            let _complete = choice.fill(&mut drops);
        }
        drops
    }
}

/// Software adapters get a smaller default budget.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct SoftwareAdapter(pub(crate) bool);

/// Rates and spectra under rain areas; their memory is used again.
#[derive(Default)]
pub(crate) struct LocalSpectra {
    field: AreaField,
    ladder: Option<Arc<RateLadder>>,
    /// Those of the latest frames: one may still be in the render world.
    kept: Vec<Arc<UnevenRain>>,
}

impl LocalSpectra {
    /// The rain from place to place, `after_s` seconds after the last tick.
    fn uneven(&mut self, areas: &RainAreas, distribution: Distribution, after_s: f64) -> Arc<UnevenRain> {
        areas.field_after(after_s, &mut self.field);
        let ladder = match self.ladder.take() {
            Some(old) if old.distribution() == distribution => old,
            _ => Arc::new(RateLadder::new(distribution)),
        };
        self.ladder = Some(ladder.clone());
        let weather_mm_h = areas.weather_mm_h();
        let free = self.kept.iter().position(|kept| Arc::strong_count(kept) == 1);
        let mut rain = free.map(|i| self.kept.swap_remove(i)).unwrap_or_else(|| {
            Arc::new(UnevenRain {
                areas: AreaField::default(),
                ladder: ladder.clone(),
                weather_mm_h,
            })
        });
        if let Some(rain) = Arc::get_mut(&mut rain) {
            std::mem::swap(&mut rain.areas, &mut self.field);
            rain.ladder = ladder;
            rain.weather_mm_h = weather_mm_h;
        }
        self.kept.push(rain.clone());
        self.kept.truncate(4);
        rain
    }
}

/// Rain in the air: says what the drops of all [`RainView`]s are chosen from, and fills their cards.
pub struct RainfallPlugin;

impl Plugin for RainfallPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<RainView>()
            .register_type::<SeenThrough>()
            .add_message::<AssetEvent<StandardMaterial>>()
            .init_resource::<SoftwareAdapter>()
            .init_resource::<AirAroundView>()
            .init_resource::<CardSettings>()
            .init_resource::<LatticeState>()
            .register_type::<RainFrameBudget>()
            .init_resource::<RainFrameBudget>()
            .init_resource::<RainShare>()
            .add_systems(PreUpdate, hold_frame_budget)
            .add_systems(
                PostUpdate,
                (
                    (choose_drops, choose_lamps, fill_cards).chain(),
                    (mark_blended, choose_panes).chain(),
                )
                    .in_set(RainViewSystems::Views),
            );
    }
}

/// A view whose lead makes it hold more within this by another step gets another κ. Units: m.
const LEAD_SAMPLE_M: f64 = 3.0;

/// A step of the logarithm of how much more a view holds. Units: none.
const LEAD_STEP: f64 = 0.03;

/// κ follows its target with this time constant, so that a change of rain does not jump. Units: s.
const QUALITY_TIME_S: f64 = 1.0;

pub(crate) fn choose_drops(
    time: Res<Time>,
    clock: Res<RainClock>,
    field: Res<RainfallField>,
    seed: Res<RainSeed>,
    software: Res<SoftwareAdapter>,
    share: Res<RainShare>,
    report: Res<RainReport>,
    air: Res<AirAroundView>,
    areas: Option<Res<RainAreas>>,
    mut local: Local<LocalSpectra>,
    mut errors: MessageWriter<RainConfigError>,
    mut views: Query<(
        Entity,
        Ref<RainView>,
        &Camera,
        &Projection,
        &GlobalTransform,
        &mut ViewMotion,
        &mut RainViewFrame,
    )>,
) {
    // Seconds since the last tick: frames lie between ticks.
    let since_tick = f64::from(clock.interpolation()) * clock.tick_ns() as f64 * 1e-9;
    let now = clock.now_s() + since_tick;
    let areas = areas.as_deref().filter(|areas| !areas.is_uniform());
    let uneven = areas.map(|areas| local.uneven(areas, field.distribution(), since_tick));
    let mut any = false;
    for (entity, view, camera, projection, transform, mut motion, mut frame) in &mut views {
        any = true;
        frame.shutter = None;
        let (_, rotation, position) = transform.to_scale_rotation_translation();
        motion.observe(position, rotation, time.delta_secs());
        if view.is_changed() {
            keep_good(view.validated(), &mut frame.settings, entity, &mut errors);
        }
        let settings = frame.settings;
        let size = camera.physical_viewport_size().unwrap_or_default();
        let clip_from_view = projection.get_clip_from_view();
        let orthographic = matches!(projection, Projection::Orthographic(_));
        let volume = if orthographic {
            parallel_volume(clip_from_view, size, transform, &motion, &settings)
        } else {
            view_volume(clip_from_view, size, transform, &motion, settings.exposure_s)
        };
        // The heaviest rain that the view's drops may be in.
        let spectrum = uneven.as_ref().map_or(*field.spectrum(), |rain| {
            let half = volume.parallel.map_or(DVec3::ZERO, |parallel| 0.5 * parallel.across_m);
            let amid = volume.eye_m + half;
            let reach = FADE_END * RANGE_CAP_M + LEAD_CAP_M + half.length();
            let rates = rain
                .areas
                .rates_within(DVec2::new(amid.x, amid.z), reach, rain.weather_mm_h);
            field.spectrum_at(rates[1])
        });
        let closed_in = air.closed_in == Some(entity);
        let raining = spectrum.intensity_mm_h > 0.0;
        let supported = orthographic || matches!(projection, Projection::Perspective(_));
        let skip = not_drawn(&settings, camera, supported, raining, closed_in);
        if let Some(reason) = skip {
            report.skipped(PassName::Rainfall, reason);
            continue;
        }
        let budget = settings.budget(*software, &share);
        let of = QualityOf {
            spectrum,
            focal_px: volume.focal_px,
            solid_angle_sr: volume.solid_angle_sr,
            width_m: volume.parallel.map_or(0.0, |parallel| parallel.across_m.length()),
            exposure_s: volume.exposure_s,
            budget,
            growth: (volume.lead_growth(LEAD_SAMPLE_M).ln() / LEAD_STEP).round() as i32,
        };
        let target = match frame.quality {
            Some(quality) if quality.of == of => quality.target,
            _ => quality_for_budget(&spectrum, &volume, f64::from(budget)).max(1e-6),
        };
        let kappa = match frame.quality {
            // Low-passed while the view runs; at once after a pause or in a picture of another size, when nobody sees the jump.
            Some(quality) if (0.0..0.5).contains(&(now - quality.set_s)) && quality.size_px == size => {
                let blend = 1.0 - (-(now - quality.set_s) / QUALITY_TIME_S).exp();
                quality.kappa * (target / quality.kappa).powf(blend)
            }
            _ => target,
        };
        frame.quality = Some(Quality {
            kappa,
            target,
            of,
            set_s: now,
            size_px: size,
        });

        // Both thin by the distance from an eye.
        let container = settings.container.filter(|_| !orthographic);
        let detail = settings.detail.filter(|_| !orthographic);
        let follow = container.map(|region| {
            let ahead = rotation * Vec3::NEG_Z;
            let heading = f64::from(ahead.x).atan2(f64::from(-ahead.z));
            let eye = position.as_dvec3();
            let mut follow = frame.follow.unwrap_or_else(|| Follow::new(eye, heading));
            let half_view = f64::from(1.0 / clip_from_view.x_axis.x).atan();
            follow.follow(&region, eye, heading, half_view);
            (follow, region)
        });
        frame.follow = follow.map(|(follow, _)| follow);

        frame.choice = Some(DropChoice {
            seed: seed.0,
            spectrum,
            motion: field.motion_after(since_tick),
            view: volume,
            kappa,
            // Numbers are means, without the margins at the view's sides; twice as many is the bound on memory.
            most_drops: 1024 + (2.0 * f64::from(budget).min(expected_drops(&spectrum, &volume, kappa))) as u32,
            uneven: uneven.clone(),
            region: follow,
            detail,
        });
        frame.motion = *motion;
        frame.shutter = Some(Shutter {
            exposure_s: settings.exposure_s,
            contrast: settings.contrast,
            kappa: kappa as f32,
            soft_m: settings.soft_m,
            patterned: settings.draws_patterns(*software) && !orthographic,
            detail,
        });
    }
    if !any {
        report.skipped(PassName::Rainfall, SkipReason::NoView);
    }
}

impl RainViewFrame {
    /// The last valid settings.
    pub(super) fn settings(&self) -> RainView {
        self.settings
    }
}

/// Why a view draws no rain; `None`: it does.
pub(super) fn not_drawn(
    settings: &RainView,
    camera: &Camera,
    supported: bool,
    raining: bool,
    closed_in: bool,
) -> Option<SkipReason> {
    let size = camera.physical_viewport_size().unwrap_or_default();
    if !camera.is_active || size.x == 0 || size.y == 0 {
        Some(SkipReason::NoView)
    } else if !settings.enabled || settings.streak_budget == Some(0) {
        Some(SkipReason::Disabled)
    } else if !raining {
        Some(SkipReason::NoRain)
    } else if !supported {
        Some(SkipReason::Unsupported)
    } else if closed_in {
        Some(SkipReason::Indoors)
    } else {
        None
    }
}

/// The view as the container needs it.
pub(crate) fn view_volume(
    clip_from_view: Mat4,
    size: UVec2,
    transform: &GlobalTransform,
    motion: &ViewMotion,
    exposure_s: f32,
) -> RainViewVolume {
    let (_, rotation, position) = transform.to_scale_rotation_translation();
    let (sx, sy) = (clip_from_view.x_axis.x, clip_from_view.y_axis.y);
    let (tx, ty) = (1.0 / sx, 1.0 / sy);
    let plane = |n: Vec3| -> Vec4 { (rotation * n.normalize()).extend(0.0) };
    let product = f64::from(tx * ty);
    let ratio = product / (f64::from(1.0 + tx * tx) * f64::from(1.0 + ty * ty)).sqrt();
    RainViewVolume {
        eye_m: position.as_dvec3(),
        eye_velocity_m_s: motion.velocity_m_s,
        side_planes: [
            plane(Vec3::new(1.0, 0.0, -tx)),
            plane(Vec3::new(-1.0, 0.0, -tx)),
            plane(Vec3::new(0.0, 1.0, -ty)),
            plane(Vec3::new(0.0, -1.0, -ty)),
        ],
        focal_px: f64::from(0.5 * size.y as f32 * sy),
        solid_angle_sr: 4.0 * libm::asin(ratio.min(1.0)),
        exposure_s: f64::from(exposure_s),
        // A long lens that turns by half its view would hold twice as many drops as there is room for.
        turn_rad: f64::from((motion.turn_rad_s.length() * exposure_s).min(0.25 * tx.min(ty))),
        parallel: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_many_lamps_count_as_the_view_says_or_the_device_can_do() {
        let of = |lamps: Option<u32>, software: bool| {
            RainView {
                lamps,
                ..RainView::default()
            }
            .most_lamps(SoftwareAdapter(software))
        };
        assert_eq!(
            [of(None, true), of(None, false), of(Some(0), false), of(Some(40), true)],
            [16, 64, 0, 40]
        );
        let many = RainView {
            lamps: Some(65),
            ..RainView::default()
        };
        assert!(many.validated().is_err_and(|error| error.to_string().contains("lamps")));
    }

    #[test]
    fn a_view_that_turns_says_so_but_by_no_more_than_a_quarter_of_itself() {
        let turn_of = |fov: f32, turn_rad_s: f32| {
            let clip = Mat4::perspective_infinite_reverse_rh(fov, 16.0 / 9.0, 0.1);
            let mut motion = ViewMotion::default();
            motion.turn_rad_s = Vec3::Y * turn_rad_s;
            view_volume(clip, UVec2::new(1280, 720), &GlobalTransform::IDENTITY, &motion, 0.02).turn_rad
        };
        assert_eq!(turn_of(1.0, 0.0), 0.0);
        assert!((turn_of(1.0, 3.0) - 0.06).abs() < 1e-7);
        assert!((turn_of(0.1, 3.0) - 0.25 * 0.05_f64.tan()).abs() < 1e-6);
    }
}
