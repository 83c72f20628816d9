//! How puddles look: mirrors, their strength and angle, waves on them, rings, and puddles that noise places by height.

use bevy::asset::RenderAssetUsages;
use bevy::prelude::*;
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};
use image::RgbImage;
use rain_core::surface::closed_film_share;
use rain_plugins::prelude::*;
use test_support::app::{FRAME, TestApp};
use test_support::{gpu, world};

use crate::pond::{At, Pond, SIZE, difference, mean, redness};

/// Low over the ground.
const GRAZING: Vec3 = Vec3::new(0.0, 0.9, 4.0);
/// From above.
const STEEP: Vec3 = Vec3::new(0.0, 4.0, 1.6);

const RED: Color = Color::linear_rgb(1.0, 0.0, 0.0);

#[test]
fn a_puddle_mirrors_by_fresnel_and_as_strongly_as_it_is_set_and_dry_ground_does_not() {
    if !gpu::available() {
        return;
    }
    let mut pond = Pond::after_rain(GRAZING, Vec3::ZERO);
    let before = pond.test.picture();
    pond.appearance(|water| water.puddle_reflection = 0.0);
    let unlit = pond.test.picture();
    pond.appearance(|water| water.puddle_reflection = 1.0);
    pond.wall(RED, [-12.0, 12.0], [-1.0, 30.0]);
    let (deep, dry) = (pond.pixels(|d| d > 0.008), pond.pixels(|d| d == 0.0));
    let red = |pond: &mut Pond, pixels: &[At]| {
        let picture = pond.test.picture();
        mean(&picture, pixels, redness)
    };
    let still = mean(&before, &deep, redness);
    let full = red(&mut pond, &deep) - still;
    assert!(full > 25.0, "the wall is mirrored: {full}");
    let ground = red(&mut pond, &dry) - mean(&before, &dry, redness);
    assert!(ground.abs() < 0.15 * full, "dry ground: {ground}, puddle {full}");

    // Its strength, live: none, half, all.
    pond.appearance(|water| water.puddle_reflection = 0.0);
    // Without reflection there is no sky in it either.
    let none = red(&mut pond, &deep) - mean(&unlit, &deep, redness);
    pond.appearance(|water| water.puddle_reflection = 0.5);
    let half = red(&mut pond, &deep) - still;
    assert!(none.abs() < 0.1 * full, "{none} of {full}");
    assert!(half > none + 0.25 * full && half < 0.8 * full, "{none} {half} {full}");
    pond.appearance(|water| water.puddle_reflection = 1.0);

    // Without a mirrored view there is nothing red to see; at no share of it neither.
    pond.appearance(|water| water.reflection_strength = 0.0);
    let unmirrored = red(&mut pond, &deep) - still;
    assert!(unmirrored.abs() < 0.1 * full, "{unmirrored} of {full}");
    pond.appearance(|water| water.reflection_strength = 1.0);

    // Nearly from above the ground shows instead: 2.3 % against 20 %.
    pond.look(STEEP, Vec3::new(0.0, 0.0, -0.2));
    pond.test.frames(4, FRAME);
    let deep = pond.pixels(|d| d > 0.008);
    let mirrored = red(&mut pond, &deep);
    pond.appearance(|water| water.reflection_strength = 0.0);
    let steep = mirrored - red(&mut pond, &deep);
    eprintln!("mirrored: {full:.1} grazing, {half:.1} at half, {none:.1} at none, {steep:.1} from above");
    assert!(steep < 0.35 * full, "{steep} from above, {full} at a grazing angle");
}

/// Change of red from row to row over these pixels, as a share of the red that there is: what a mirror keeps of bars.
fn sharpness(pictures: &[RgbImage], pixels: &[At]) -> f64 {
    let red = |[x, y]: At| {
        let all = pictures.iter().map(|p| redness(p.get_pixel(x, y).0.map(f64::from)));
        all.sum::<f64>() / pictures.len() as f64
    };
    let inside: std::collections::BTreeSet<At> = pixels.iter().copied().collect();
    let pairs = pixels.iter().filter(|at| inside.contains(&[at[0], at[1] + 1]));
    let (mut change, mut sum) = (0.0, 0.0);
    for &[x, y] in pairs {
        change += (red([x, y + 1]) - red([x, y])).abs();
        sum += red([x, y]).abs();
    }
    change / sum
}

#[test]
fn puddles_mirror_clearly_films_with_gloss_and_rain_blurs_the_mirror() {
    if !gpu::available() {
        return;
    }
    let mut pond = Pond::new(GRAZING, Vec3::ZERO);
    // Red bars before black.
    pond.wall(Color::BLACK, [-12.0, 12.0], [-1.0, 30.0]);
    for bar in 0..20_u8 {
        let low = 0.6 * f32::from(bar);
        pond.bar(RED, [low, low + 0.3]);
    }
    // The same places under a film alone and, when the hollow is full, under a puddle.
    pond.by_hand(Some(1.0), Some(0.3));
    let low: std::collections::BTreeSet<At> = pond.pixels(|d| d == 0.0).into_iter().collect();
    let filmed = [pond.test.picture()];
    pond.by_hand(Some(1.0), Some(1.0));
    let deep = pond.pixels(|d| d > 0.01);
    let shore: Vec<At> = pond
        .pixels(|d| d > 0.004)
        .into_iter()
        .filter(|at| low.contains(at))
        .collect();
    assert!(shore.len() > 50, "{} places", shore.len());
    let calm = [pond.test.picture()];
    let clear = sharpness(&calm, &deep);
    let (flooded, glossy) = (sharpness(&calm, &shore), sharpness(&filmed, &shore));
    let (puddle, wet) = (mean(&calm[0], &shore, redness), mean(&filmed[0], &shore, redness));
    eprintln!("bars: puddle {clear:.3}, shore {flooded:.3} of {puddle:.1}, as film {glossy:.3} of {wet:.1}");
    assert!(flooded > 1.25 * glossy, "puddle {flooded}, film {glossy}");
    assert!(wet > 4.0, "the film mirrors, too: {wet}, puddle {puddle}");

    // More rain, more rings, less of a mirror in what is seen over half a second; without rings it is as clear as ever.
    let mut last = clear;
    for intensity in [15.0, 60.0] {
        pond.weather(Weather::rain(intensity));
        pond.test.frames(200, FRAME);
        let seen: Vec<RgbImage> = (0..6)
            .map(|_| {
                pond.test.frames(5, FRAME);
                pond.test.picture()
            })
            .collect();
        let rainy = sharpness(&seen, &deep);
        eprintln!("{intensity} mm/h: {rainy:.3}");
        assert!(rainy < 0.97 * last, "{intensity} mm/h: {rainy}, {last} before");
        last = rainy;
    }
    pond.appearance(|water| water.ripple_strength = 0.0);
    let still = sharpness(&[pond.test.picture()], &deep);
    assert!(still > 0.95 * clear, "{still}, {clear} before the rain");
}

#[test]
fn waves_move_what_is_mirrored_by_strength_length_and_velocity() {
    if !gpu::available() {
        return;
    }
    let mut pond = Pond::after_rain(GRAZING, Vec3::ZERO);
    pond.wall(RED, [-12.0, -0.4], [-1.0, 30.0]);
    let (deep, dry) = (pond.pixels(|d| d > 0.008), pond.pixels(|d| d == 0.0));
    // Change of the picture in a third of a second, on the pond and beside it.
    let moving = |pond: &mut Pond| {
        let a = pond.test.picture();
        pond.test.frames(20, FRAME);
        let b = pond.test.picture();
        assert!(difference(&a, &b, &dry) < 0.3, "the ground is still");
        difference(&a, &b, &deep)
    };
    let calm = pond.test.picture();
    assert_eq!(moving(&mut pond), 0.0, "no wind, no waves");
    pond.appearance(|water| {
        water.wave_slope = Some(0.05);
        water.wave_velocity_m_s = Some(Vec2::new(0.2, 0.1));
    });
    let waves = moving(&mut pond);
    eprintln!("waves move {waves:.2}");
    assert!(waves > 2.0, "{waves}");
    pond.appearance(|water| water.wave_strength = 0.2);
    let weak = moving(&mut pond);
    assert!(weak < 0.7 * waves, "{weak} of {waves}");
    pond.appearance(|water| water.wave_strength = 0.0);
    assert_eq!(moving(&mut pond), 0.0);
    assert!(pond.test.picture() == calm, "the mirror is what it was");
    pond.appearance(|water| {
        water.wave_strength = 1.0;
        water.wave_velocity_m_s = Some(Vec2::ZERO);
    });
    assert_eq!(moving(&mut pond), 0.0, "waves without a velocity stand still");

    // Shorter waves break the picture into smaller pieces: neighbours differ more, against what is far.
    let broken = |pond: &mut Pond, length: f32| {
        pond.appearance(|water| {
            water.wave_velocity_m_s = Some(Vec2::new(0.2, 0.1));
            water.wave_length_m = length;
        });
        let picture = pond.test.picture();
        let change = |[x, y]: At| {
            redness(picture.get_pixel(x, y).0.map(f64::from)) - redness(calm.get_pixel(x, y).0.map(f64::from))
        };
        let apart = |step: u32| {
            let pairs: Vec<f64> = deep
                .iter()
                .filter(|at| at[0] + step < SIZE[0])
                .map(|&[x, y]| (change([x, y]) - change([x + step, y])).abs())
                .collect();
            pairs.iter().sum::<f64>() / pairs.len() as f64
        };
        apart(1) / apart(12)
    };
    let (long, short) = (broken(&mut pond, 2.0), broken(&mut pond, 0.15));
    eprintln!("neighbours: {short:.3} at 15 cm, {long:.3} at 2 m");
    assert!(short > 1.3 * long, "{short} at 15 cm, {long} at 2 m");
}

/// A linear image of four texels a side, each with these bytes.
fn image(pond: &mut Pond, texel: impl Fn(u32) -> [u8; 4]) -> Handle<Image> {
    let size = Extent3d {
        width: 16,
        height: 16,
        depth_or_array_layers: 1,
    };
    let data: Vec<u8> = (0..256_u32).flat_map(|i| texel(i % 16)).collect();
    let image = Image::new(
        size,
        TextureDimension::D2,
        data,
        TextureFormat::Rgba8Unorm,
        RenderAssetUsages::default(),
    );
    pond.test.world().resource_mut::<Assets<Image>>().add(image)
}

#[test]
fn two_normal_maps_run_over_puddles_in_place_of_the_winds_waves() {
    if !gpu::available() {
        return;
    }
    let mut pond = Pond::after_rain(GRAZING, Vec3::ZERO);
    pond.wall(RED, [-12.0, -0.4], [-1.0, 30.0]);
    let (deep, dry) = (pond.pixels(|d| d > 0.008), pond.pixels(|d| d == 0.0));
    let calm = pond.test.picture();
    let flat = image(&mut pond, |_| [128, 128, 255, 255]);
    // Slopes along x that rise and fall once a side.
    let wavy = image(&mut pond, |i| [if (i / 8) == 0 { 150 } else { 106 }, 128, 250, 255]);
    let set = |pond: &mut Pond, first: Option<Handle<Image>>, second: Option<Handle<Image>>| {
        pond.test.world().insert_resource(WaveNormalMaps {
            first,
            second,
            size_m: 0.6,
        });
        pond.appearance(|water| water.wave_velocity_m_s = Some(Vec2::new(0.3, 0.0)));
        pond.test.picture()
    };
    let still = set(&mut pond, Some(flat.clone()), None);
    assert!(difference(&calm, &still, &deep) < 1.0, "flat maps change nothing");
    let one = set(&mut pond, Some(wavy.clone()), Some(flat));
    assert!(
        difference(&calm, &one, &deep) > 2.0,
        "{}",
        difference(&calm, &one, &deep)
    );
    assert!(difference(&calm, &one, &dry) < 0.3, "dry ground has no waves");
    let both = set(&mut pond, Some(wavy), None);
    assert!(difference(&one, &both, &deep) > 1.0, "the second map adds its own");
    pond.test.frames(20, FRAME);
    let later = pond.test.picture();
    assert!(difference(&both, &later, &deep) > 1.0, "they run");
    pond.appearance(|water| water.wave_velocity_m_s = Some(Vec2::ZERO));
    let stopped = pond.test.picture();
    pond.test.frames(20, FRAME);
    assert!(
        difference(&stopped, &pond.test.picture(), &deep) == 0.0,
        "they stand without a velocity"
    );
    pond.appearance(|water| water.wave_strength = 0.0);
    assert!(difference(&calm, &pond.test.picture(), &deep) < 1.0);
    set(&mut pond, None, None);
    assert!(difference(&calm, &pond.test.picture(), &deep) < 1.0, "without maps");
}

#[test]
fn lamps_draw_long_streaks_on_wet_road_and_hazy_ones_on_rough() {
    if !gpu::available() {
        return;
    }
    let mut test = TestApp::new([160, 120], true);
    test.world().insert_resource(SurfaceSettings {
        enabled: false,
        ..default()
    });
    world::ground(test.world());
    let lights: Vec<Entity> = test
        .world()
        .query_filtered::<Entity, With<DirectionalLight>>()
        .iter(test.world())
        .collect();
    for light in lights {
        test.world().despawn(light);
    }
    test.world().insert_resource(GlobalAmbientLight::NONE);
    test.world().spawn((
        PointLight {
            intensity: 1e4,
            range: 60.0,
            radius: 0.15,
            ..default()
        },
        Transform::from_xyz(0.0, 2.5, -8.0),
    ));
    let weather = test.world().spawn(Weather::rain(0.0)).id();
    let camera = test.camera;
    test.world().entity_mut(camera).insert(RainView {
        streak_budget: Some(0),
        ..default()
    });
    test.look(Vec3::new(0.0, 1.3, 6.0), Vec3::new(0.0, 0.3, -6.0));
    test.frames(4, FRAME);
    // Brightest pixel of the ground, and how far half of that reaches along and across.
    let streak = |test: &mut TestApp| {
        let picture = test.picture();
        let bright = |x: u32, y: u32| picture.get_pixel(x, y).0.iter().map(|c| f64::from(*c)).sum::<f64>() / 3.0;
        let all = (62..120_u32).flat_map(|y| (0..160_u32).map(move |x| [x, y]));
        let [x, y] = all
            .max_by(|a, b| bright(a[0], a[1]).total_cmp(&bright(b[0], b[1])))
            .expect("pixels");
        let top = bright(x, y);
        let lit = |x: u32, y: u32| bright(x, y) > 0.5 * top;
        let high = (62..120).filter(|&row| lit(x, row)).count();
        let wide = (0..160).filter(|&column| lit(column, y)).count();
        (top, high, wide)
    };
    let dry = streak(&mut test);
    test.world().entity_mut(weather).insert(WaterByHand {
        wetness: Some(1.0),
        water_level: Some(1.0),
        ..WaterByHand::default()
    });
    test.frames(8, FRAME);
    let wet = streak(&mut test);
    // Half a film: rougher ground.
    test.world().entity_mut(weather).insert(WaterByHand {
        wetness: Some(1.0),
        water_level: Some(0.12),
        ..WaterByHand::default()
    });
    test.frames(8, FRAME);
    let rough = streak(&mut test);
    let shown = format!("dry {dry:?}, wet {wet:?}, rough {rough:?}");
    eprintln!("{shown}");
    assert!(wet.0 > dry.0 + 30.0 && wet.1 > 2 * wet.2, "{shown}");
    assert!(rough.0 < wet.0 - 5.0 && rough.2 > wet.2, "hazier and dimmer: {shown}");
}

/// A level plate from above whose depth map is high on the left half and low on the right.
struct Relief {
    test: TestApp,
    plate: Entity,
    weather: Entity,
}

const PLATE: [u32; 2] = [100, 100];

impl Relief {
    fn new() -> Self {
        let mut test = TestApp::new(PLATE, true);
        test.world().insert_resource(SurfaceSettings {
            enabled: false,
            ..default()
        });
        let size = Extent3d {
            width: 16,
            height: 16,
            depth_or_array_layers: 1,
        };
        // Depth: 0 is the top of the relief, 255 its bottom; 0.8 and 0.2 high.
        let data: Vec<u8> = (0..256_u32).map(|i| if i % 16 < 8 { 51 } else { 204 }).collect();
        let map = Image::new(
            size,
            TextureDimension::D2,
            data,
            TextureFormat::R8Unorm,
            RenderAssetUsages::default(),
        );
        let map = test.world().resource_mut::<Assets<Image>>().add(map);
        let material = test
            .world()
            .resource_mut::<Assets<StandardMaterial>>()
            .add(StandardMaterial {
                base_color: Color::linear_rgb(0.35, 0.35, 0.35),
                perceptual_roughness: 0.9,
                depth_map: Some(map),
                ..default()
            });
        let plane = test
            .world()
            .resource_mut::<Assets<Mesh>>()
            .add(Plane3d::default().mesh().size(8.0, 8.0));
        let plate = test
            .world()
            .spawn((Mesh3d(plane), MeshMaterial3d(material), Transform::default()))
            .id();
        let weather = test
            .world()
            .spawn((
                Weather::rain(0.0),
                WaterByHand {
                    wetness: Some(0.3),
                    water_level: None,
                    ..WaterByHand::default()
                },
            ))
            .id();
        let camera = test.camera;
        test.world().entity_mut(camera).insert(RainView {
            streak_budget: Some(0),
            ..default()
        });
        test.look(Vec3::new(0.0, 9.0, 0.01), Vec3::ZERO);
        // A muddy puddle is told from wet ground from straight above.
        test.world().insert_resource(WaterAppearance {
            turbidity_per_m: 800.0,
            mud_albedo: Vec3::new(0.5, 0.1, 0.02),
            ..default()
        });
        test.frames(8, FRAME);
        Self { test, plate, weather }
    }

    fn show(&mut self, noise: NoisePuddles) -> RgbImage {
        let plate = self.plate;
        self.test.world().entity_mut(plate).insert(noise);
        self.test.frames(4, FRAME);
        self.test.picture()
    }
}

/// Pixels by how red they are: a puddle is.
fn flooded(picture: &RgbImage, from: f64) -> Vec<At> {
    let all = (5..PLATE[1] - 5).flat_map(|y| (5..PLATE[0] - 5).map(move |x| [x, y]));
    all.filter(|[x, y]| redness(picture.get_pixel(*x, *y).0.map(f64::from)) > from)
        .collect()
}

#[test]
fn noise_puddles_follow_the_relief_grow_from_soft_borders_and_have_drenched_rims() {
    if !gpu::available() {
        return;
    }
    let mut relief = Relief::new();
    let base = NoisePuddles {
        seed: 4,
        size_m: 2.0,
        level: Some(0.0),
        drenched: 0.0,
        ..default()
    };
    let wet = relief.show(base);
    let none = flooded(&wet, 0.0)
        .iter()
        .map(|[x, y]| redness(wet.get_pixel(*x, *y).0.map(f64::from)))
        .fold(0.0, f64::max);
    let at = none + 12.0;
    assert!(flooded(&wet, at).is_empty());

    // The height map alone: between its two heights only the low half floods; below both and above both, none and all.
    let by_level = |relief: &mut Relief, level: f32| {
        let picture = relief.show(NoisePuddles {
            noise: 0.0,
            level: Some(level),
            ..base
        });
        let found = flooded(&picture, at);
        let right = found.iter().filter(|p| p[0] >= PLATE[0] / 2).count();
        [found.len() - right, right]
    };
    let half = 45 * 90;
    assert_eq!(by_level(&mut relief, 0.15), [0, 0]);
    let [left, right] = by_level(&mut relief, 0.6);
    // The map's filter takes a column of pixels from one height to the other.
    assert!(left <= 90 && right > half * 9 / 10, "{left} {right}");
    let [left, right] = by_level(&mut relief, 1.0);
    assert!(left > half * 9 / 10 && right > half * 9 / 10, "{left} {right}");

    // With the noise over it: puddles here and there, more of them where the relief is low.
    let mut last: Vec<At> = Vec::new();
    for level in [0.45, 0.7, 0.88] {
        let picture = relief.show(NoisePuddles {
            level: Some(level),
            ..base
        });
        let found = flooded(&picture, at);
        let right = found.iter().filter(|p| p[0] >= PLATE[0] / 2).count();
        assert!(
            right > 2 * (found.len() - right),
            "{level}: {right} of {} on the low side",
            found.len()
        );
        assert!(
            found.len() > last.len() + 100 && found.len() < 2 * half,
            "{level}: {}",
            found.len()
        );
        // It grows outwards: what was puddle stays one.
        let lost = last.iter().filter(|at| !found.contains(at)).count();
        assert!(lost <= last.len() / 50, "{level}: {lost} of {} lost", last.len());
        last = found;
    }

    // A soft border: between wet ground and puddle lies more than a line.
    let picture = relief.show(NoisePuddles {
        level: Some(0.7),
        size_m: 6.0,
        ..base
    });
    let reds: Vec<f64> = flooded(&picture, -255.0)
        .iter()
        .map(|[x, y]| redness(picture.get_pixel(*x, *y).0.map(f64::from)))
        .collect();
    let deepest = reds.iter().copied().fold(0.0, f64::max);
    let share = |from: f64, to: f64| {
        let level = |s: f64| none + s * (deepest - none);
        reds.iter().filter(|r| **r > level(from) && **r < level(to)).count()
    };
    eprintln!("border {}, puddle {}", share(0.2, 0.8), share(0.8, 1.1));
    assert!(
        share(0.2, 0.8) > 150 && share(0.8, 1.1) > 200,
        "{} {}",
        share(0.2, 0.8),
        share(0.8, 1.1)
    );

    // Drenched: a film around the puddle, where without it the ground is wet at most.
    let straight = relief.show(NoisePuddles {
        level: Some(0.6),
        ..base
    });
    let drenched = relief.show(NoisePuddles {
        level: Some(0.6),
        drenched: 0.3,
        ..base
    });
    let puddle = flooded(&straight, at);
    let all: Vec<At> = (5..95).flat_map(|y| (5..95).map(move |x| [x, y])).collect();
    let changed: Vec<At> = all
        .iter()
        .copied()
        .filter(|&p| difference(&straight, &drenched, &[p]) > 4.0)
        .collect();
    let around = changed.iter().filter(|p| !puddle.contains(p)).count();
    assert!(
        around > 200 && around > changed.len() * 3 / 4,
        "{around} of {} around",
        changed.len()
    );
    let untouched = all
        .iter()
        .filter(|&&p| difference(&straight, &drenched, &[p]) < 1.0 && !puddle.contains(&p))
        .count();
    assert!(untouched > 200, "what lies higher stays wet: {untouched}");
    // By hand, over all.
    let weather = relief.weather;
    relief.test.world().entity_mut(weather).insert(WaterByHand {
        wetness: Some(0.3),
        water_level: Some(0.7),
        ..WaterByHand::default()
    });
    let by_hand = relief.show(NoisePuddles { level: None, ..base });
    assert!(flooded(&by_hand, at).len() > 100, "the level set by hand fills them");
}

#[test]
fn puddles_displace_no_geometry() {
    if !gpu::available() {
        return;
    }
    let mut relief = Relief::new();
    // A horizon: the plate's far edge before an empty background.
    relief
        .test
        .world()
        .insert_resource(ClearColor(Color::linear_rgb(0.0, 0.0, 1.0)));
    relief.test.look(Vec3::new(0.0, 0.6, 6.0), Vec3::new(0.0, 0.4, 0.0));
    relief.test.frames(3, FRAME);
    let horizon =
        |picture: &RgbImage| -> Vec<bool> { picture.pixels().map(|p| p[2] > p[0].saturating_add(60)).collect() };
    let puddles = |level: f32| NoisePuddles {
        level: Some(level),
        ..default()
    };
    let dry = relief.show(puddles(0.0));
    let full = relief.show(puddles(1.0));
    assert!(dry != full, "there are puddles");
    let (before, after) = (horizon(&dry), horizon(&full));
    assert!(before.iter().any(|b| *b) && before.iter().any(|b| !*b));
    assert!(before == after, "the edge of the plate has moved");
}

#[test]
fn a_road_loses_its_mirror_after_the_rain_and_keeps_its_wetness() {
    if !gpu::available() {
        return;
    }
    let mut pond = Pond::new(GRAZING, Vec3::ZERO);
    pond.wall(Color::BLACK, [-12.0, 12.0], [-1.0, 30.0]);
    for bar in 0..20_u8 {
        let low = 0.6 * f32::from(bar);
        pond.bar(RED, [low, low + 0.3]);
    }
    let all = pond.pixels(|d| d <= 0.0);
    let dry = mean(&pond.test.picture(), &all, |[_, g, b]| 0.5 * (g + b));
    let damp = Weather {
        net_radiation_w_m2: 0.0,
        relative_humidity: 1.0,
        ..Weather::rain(0.0)
    };
    pond.weather(Weather {
        intensity_mm_h: 40.0,
        ..damp
    });
    pond.test.leap(1800);
    pond.weather(damp);
    pond.test.frames(4, FRAME);
    let (road, deep) = (pond.pixels(|d| d == 0.0), pond.pixels(|d| d > 0.01));
    let mut seen = Vec::new();
    for wait in [0, 300, 1500] {
        if wait > 0 {
            pond.test.leap(wait);
            pond.test.frames(4, FRAME);
        }
        let picture = [pond.test.picture()];
        let film = pond
            .test
            .world()
            .get::<WeatherState>(pond.weather)
            .expect("the weather")
            .water_level_mm(SurfaceClass::Asphalt);
        let (mirror, dark) = (
            mean(&picture[0], &road, redness),
            mean(&picture[0], &road, |[_, g, b]| 0.5 * (g + b)),
        );
        let on_pond = sharpness(&picture, &deep);
        eprintln!("film {film:.3} mm: road {mirror:.2}, {dark:.1} of {dry:.1}; pond {on_pond:.3}");
        assert!(dark < 0.8 * dry, "the road is wet");
        seen.push((film, mirror, on_pond));
    }
    let (_, wet, wet_pond) = seen[0];
    assert!(wet > 2.0, "it mirrors at the end of the rain: {wet}");
    // The mirror is as strong as the film is closed, over asphalt's 0.8 mm of texture.
    for (film, mirror, _) in &seen {
        let (found, closed) = (mirror / wet, closed_film_share(*film, 0.8));
        assert!(
            (found - closed).abs() < 0.1,
            "{found} of the mirror, {closed} closed: {seen:?}"
        );
    }
    assert!(seen[2].2 > 0.95 * wet_pond, "the puddle stays a mirror: {seen:?}");
}
