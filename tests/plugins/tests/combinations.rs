//! Every combination of a view's settings: the rain of all passes shows in the open and nowhere else, and its mask is the same.

use std::time::Duration;

use bevy::camera::visibility::RenderLayers;
use bevy::camera::{Hdr, ScalingMode};
use bevy::core_pipeline::oit::OrderIndependentTransparencySettings;
use bevy::core_pipeline::prepass::background_motion_vectors::NoBackgroundMotionVectors;
use bevy::core_pipeline::prepass::{DepthPrepass, MotionVectorPrepass};
use bevy::prelude::*;
use rain_plugins::prelude::*;
use rain_plugins::render_adapter::{MaskKind, RainMasks, mask_image};
use test_support::app::TestApp;
use test_support::gpu;

use crate::blending::{changed, screened, set_viewport};
use crate::haze::{SIZE, read};

/// A part of the target with borders on all sides.
const PART: [u32; 4] = [32, 12, 80, 44];

/// What a camera has.
#[derive(Clone, Copy, Debug)]
struct Settings {
    deferred: bool,
    four_samples: bool,
    high_range: bool,
    depth_prepass: bool,
    /// Rain is drawn after blur where there are any.
    motion_vectors: bool,
    /// Bevy's order-independent transparency.
    sorted_by_pixel: bool,
    part: bool,
    /// The screen is on another layer, which the camera sees too.
    layers: bool,
    /// Of the rain such a view shows single drops and splashes.
    orthographic: bool,
}

impl Settings {
    /// Each with each, where Bevy allows it: deferred shading, transparency by pixel take one sample. Orthographic views with
    /// each of samples, range, prepass and part.
    fn all(deferred: bool) -> impl Iterator<Item = Self> {
        let bit = |code: u32, at: u32| code >> at & 1 == 1;
        (0..256).filter_map(move |code| {
            let settings = Self {
                deferred,
                four_samples: bit(code, 0),
                high_range: bit(code, 1),
                depth_prepass: deferred || bit(code, 2),
                motion_vectors: bit(code, 3),
                sorted_by_pixel: bit(code, 4),
                part: bit(code, 5),
                layers: bit(code, 6),
                orthographic: bit(code, 7),
            };
            let one_sample = deferred || settings.sorted_by_pixel || settings.motion_vectors;
            let twice = deferred && !bit(code, 2);
            let other = settings.motion_vectors || settings.sorted_by_pixel || settings.layers;
            let left_out = twice || settings.four_samples && one_sample || settings.orthographic && other;
            (!left_out).then_some(settings)
        })
    }

    fn apply(self, test: &mut TestApp, screen: Entity) {
        let camera = test.camera;
        let mut own = test.world().entity_mut(camera);
        own.insert(if self.four_samples { Msaa::Sample4 } else { Msaa::Off });
        set(&mut own, self.high_range, Hdr);
        // The prepass of a deferred view is the scene's.
        if !self.deferred {
            set(&mut own, self.depth_prepass, DepthPrepass);
        }
        // Bevy 0.19.1 cannot draw the sky's own in a deferred view: its pass there lacks their texture.
        own.insert(NoBackgroundMotionVectors);
        set(&mut own, self.motion_vectors, MotionVectorPrepass);
        set(
            &mut own,
            self.sorted_by_pixel,
            OrderIndependentTransparencySettings::default(),
        );
        set_viewport(&mut own, self.part.then_some(PART));
        own.insert(if self.orthographic {
            Projection::Orthographic(OrthographicProjection {
                scaling_mode: ScalingMode::FixedVertical { viewport_height: 0.5 },
                ..OrthographicProjection::default_3d()
            })
        } else {
            Projection::default()
        });
        let layer = usize::from(self.layers);
        own.insert(RenderLayers::from_layers(&[0, layer]));
        test.world().entity_mut(screen).insert(RenderLayers::layer(layer));
    }
}

fn set<B: Bundle>(camera: &mut EntityWorldMut, on: bool, bundle: B) {
    if on {
        camera.insert(bundle);
    } else {
        camera.remove::<B>();
    }
}

/// Draws all of the rain or none of it.
fn show(test: &mut TestApp, on: bool) {
    let camera = test.camera;
    let view = RainView {
        enabled: on,
        streak_budget: Some(6_000),
        cards: Some(on),
        contrast: 16.0,
        soft_m: 0.0,
        ..default()
    };
    let haze = HazeSettings {
        enabled: on,
        ..default()
    };
    test.world().entity_mut(camera).insert((view, haze));
    test.world().resource_mut::<SplashSettings>().enabled = on;
}

/// An image for each of a view's masks; that of the rain first.
fn with_masks(test: &mut TestApp) -> Handle<Image> {
    let [rain, wet, depth, water] =
        [MaskKind::Rain, MaskKind::Surface, MaskKind::Surface, MaskKind::Surface].map(|kind| {
            let image = mask_image(kind, SIZE[0], SIZE[1]);
            test.world().resource_mut::<Assets<Image>>().add(image)
        });
    let camera = test.camera;
    test.world().entity_mut(camera).insert(RainMasks {
        rain: rain.clone(),
        wet,
        depth,
        water,
    });
    rain
}

/// Mean of a mask over a rectangle.
fn mean(mask: &[f64], [x, y, width, height]: [u32; 4]) -> f64 {
    let row = |y: u32| (y * SIZE[0] + x) as usize..(y * SIZE[0] + x + width) as usize;
    let sum: f64 = (y..y + height).flat_map(|y| &mask[row(y)]).sum();
    sum / f64::from(width * height)
}

/// Checks each combination; gives the number of them.
fn check_all(deferred: bool) -> usize {
    let (mut test, screen) = screened(SIZE, deferred);
    let mask = with_masks(&mut test);
    show(&mut test, true);
    // One moment of the rain for all of them.
    test.leap(1);
    let mut known: [Option<Vec<f64>>; 8] = [const { None }; 8];
    let mut checked = 0;
    for settings in Settings::all(deferred) {
        settings.apply(&mut test, screen);
        show(&mut test, true);
        test.frames(3, Duration::ZERO);
        test.reset();
        let with = test.picture();
        for pass in [PassName::Rainfall, PassName::Lattice, PassName::Splash, PassName::Haze] {
            let drawn = [PassName::Rainfall, PassName::Splash].contains(&pass) || !settings.orthographic;
            assert_eq!(test.recorded(pass) > 0, drawn, "{settings:?}: {}", pass.as_str());
        }
        let whole = [0, 0, SIZE[0], SIZE[1]];
        let [x, y, width, height] = if settings.part { PART } else { whole };
        let half = width / 2;
        if settings.four_samples {
            assert_eq!(test.recorded(PassName::Masks), 0, "{settings:?}: masks take one sample");
        } else {
            let found = read(&mut test, &mask);
            let open = mean(&found, [x + half + 1, y, half - 1, height]);
            let behind = mean(&found, [x, y, half - 1, height]);
            let outside = mean(&found, whole) * f64::from(SIZE[0] * SIZE[1])
                - mean(&found, [x, y, width, height]) * f64::from(width * height);
            assert!(open > 0.05, "{settings:?}: {open} of the open is covered");
            assert!(
                behind < 0.1 * open,
                "{settings:?}: {behind} before the screen, {open} beside it"
            );
            assert!(outside.abs() < 1e-9, "{settings:?}: {outside} outside the view");
            // Nothing but the view's part, and whether cards can fade at the scene's depth, decides what the rain covers.
            let case = 4 * usize::from(settings.orthographic)
                + 2 * usize::from(settings.part)
                + usize::from(settings.depth_prepass);
            let known = known[case].get_or_insert_with(|| found.clone());
            let off = known.iter().zip(&found).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(off < 2e-3, "{settings:?}: the mask is another by {off}");
        }
        show(&mut test, false);
        test.frames(2, Duration::ZERO);
        let pictures = [with, test.picture()];
        let open = changed(&pictures, [x + half + 1, y, half - 1, height]);
        let behind = changed(&pictures, [x, y, half - 1, height]);
        assert!(
            open > (half * height / 8) as usize,
            "{settings:?}: {open} pixels in the open"
        );
        assert!(
            behind * 10 <= open,
            "{settings:?}: {behind} of {open} pixels before the screen"
        );
        assert_eq!(
            changed(&pictures, whole),
            changed(&pictures, [x, y, width, height]),
            "{settings:?}: outside the view"
        );
        checked += 1;
    }
    checked
}

#[test]
fn every_combination_of_forward_settings_shows_rain_where_it_is_and_one_mask() {
    if !gpu::available() {
        return;
    }
    assert_eq!(check_all(false), 96);
}

#[test]
fn every_combination_of_deferred_settings_shows_rain_where_it_is_and_one_mask() {
    if !gpu::available() {
        return;
    }
    assert_eq!(check_all(true), 36);
}
