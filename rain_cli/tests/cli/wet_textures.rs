//! `rain bake wet-textures`: what it makes of images, and what it refuses.

use std::path::PathBuf;
use std::process::{Command, Output};

use image::{GrayImage, Luma, Rgb, RgbImage, Rgba, RgbaImage};
use rain_cli::wet_textures::{Look, WetTexturesArgs, bake};
use rain_core::surface::wet_albedo;
use tempfile::TempDir;

/// A folder with a base colour of 4 × 2 stone texels of rising brightness, an ORM texture and heights that rise along x.
fn material() -> (TempDir, WetTexturesArgs) {
    let folder = TempDir::new().expect("a temporary folder");
    let path = |name: &str| folder.path().join(name);
    RgbaImage::from_fn(4, 2, |x, y| Rgba([60 + 40 * x as u8, 80, 100 + 50 * y as u8, 200]))
        .save(path("base.png"))
        .expect("written");
    RgbImage::from_pixel(4, 2, Rgb([77, 230, 0]))
        .save(path("orm.png"))
        .expect("written");
    GrayImage::from_fn(4, 2, |x, _| Luma([85 * x as u8]))
        .save(path("height.png"))
        .expect("written");
    let args = WetTexturesArgs {
        base_color: path("base.png"),
        orm: Some(path("orm.png")),
        height: Some(path("height.png")),
        out: path("wet"),
        ..WetTexturesArgs::default()
    };
    (folder, args)
}

#[test]
fn wet_textures_are_darker_by_the_models_and_dry_ones_what_they_were() {
    let (_folder, args) = material();
    let dry = image::open(&args.base_color).expect("the base colour").into_rgba8();
    let same = bake(&WetTexturesArgs {
        wetness: Some(0.0),
        ..args.clone()
    })
    .expect("dry");
    assert!(same.base_color == dry && same.orm.pixels().all(|p| p.0 == [77, 230, 0]));
    assert!(same.reflectance.pixels().all(|p| p.0[0] == 128));

    let wet = bake(&args).expect("wet");
    let linear = |c: u8| {
        let c = f64::from(c) / 255.0;
        if c <= 0.040_45 {
            c / 12.92
        } else {
            ((c + 0.055) / 1.055).powf(2.4)
        }
    };
    for (found, dry) in wet.base_color.pixels().zip(dry.pixels()) {
        assert_eq!(found[3], 200, "alpha is kept");
        for c in 0..3 {
            // Half a step of 8 bits.
            let wanted = wet_albedo(linear(dry[c]));
            let (low, high) = (linear(found[c].saturating_sub(1)), linear(found[c].saturating_add(1)));
            assert!(wanted > low && wanted < high, "{found:?} of {dry:?}");
        }
    }
    // Rough stone, 230/255, damp: three quarters of the way to 0.45.
    let rough = 0.25 * 230.0 / 255.0 + 0.75 * 0.45;
    assert!(
        wet.orm
            .pixels()
            .all(|p| (f64::from(p[1]) - 255.0 * rough).abs() <= 0.5 && p[0] == 77)
    );
    let lagarde = bake(&WetTexturesArgs {
        look: Look::Lagarde,
        ..args
    })
    .expect("wet");
    assert!(lagarde.base_color.get_pixel(3, 0)[0] < wet.base_color.get_pixel(3, 0)[0]);
}

#[test]
fn water_stands_in_the_holes_of_the_height_map() {
    let (_folder, args) = material();
    let flooded = bake(&WetTexturesArgs {
        flood: Some(0.5),
        ..args
    })
    .expect("flooded");
    let rough: Vec<u8> = (0..4).map(|x| flooded.orm.get_pixel(x, 0)[1]).collect();
    // Water is min(0.5, 1 − height): 0.5, 0.5, 1/3, 0.
    assert!(
        rough[0] == rough[1] && rough[1] < rough[2] && rough[2] < rough[3],
        "{rough:?}"
    );
    let mirror: Vec<u8> = (0..4).map(|x| flooded.reflectance.get_pixel(x, 0)[0]).collect();
    assert!(
        mirror[3] == 128 && mirror[0] < mirror[2] && mirror[2] < mirror[3],
        "{mirror:?}"
    );
}

fn rain(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_rain"))
        .args(arguments)
        .output()
        .expect("the program starts")
}

#[test]
fn the_program_writes_three_textures_and_refuses_bad_input_by_name() {
    let (folder, args) = material();
    let text = |path: &PathBuf| path.to_string_lossy().into_owned();
    let (base, out) = (text(&args.base_color), text(&args.out));
    let (orm, height) = (text(&args.orm.expect("given")), text(&args.height.expect("given")));
    let with = |more: &[&str]| {
        let mut all = vec!["bake", "wet-textures", "--base-color", &base, "--out", &out];
        all.extend(more);
        rain(&all)
    };
    let done = with(&[
        "--orm",
        &orm,
        "--height",
        &height,
        "--flood",
        "0.4",
        "--look",
        "lagarde-porous",
        "--json",
    ]);
    assert_eq!(done.status.code(), Some(0), "{}", String::from_utf8_lossy(&done.stderr));
    let report: serde_json::Value = serde_json::from_slice(&done.stdout).expect("JSON");
    assert_eq!(report["size"], serde_json::json!([4, 2]));
    for name in ["base_color", "orm", "reflectance"] {
        let path = report[name].as_str().expect("a path");
        assert_eq!(image::open(path).expect("a PNG").width(), 4, "{path}");
    }

    let other = folder.path().join("other.png");
    GrayImage::new(3, 2).save(&other).expect("written");
    let broken = folder.path().join("broken.png");
    std::fs::write(&broken, b"\x89PNG\r\n\x1a\nno").expect("written");
    let (other, broken) = (text(&other), text(&broken));
    let cases: [(&[&str], &[&str]); 9] = [
        (&["--wetness", "1.5"], &["wetness is 1.5", "0 to 1"]),
        (&["--flood", "NaN", "--height", &height], &["flood is NaN", "0 to 1"]),
        (&["--flood", "0.5"], &["flood is 0.5", "without a height map"]),
        (&["--depth-m", "-1"], &["depth_m is -1"]),
        (&["--roughness", "2"], &["roughness is 2"]),
        (&["--height", &other], &["other.png", "3 × 2", "4 × 2"]),
        (&["--height", &base], &["base.png", "Rgba8", "grey"]),
        (&["--orm", &broken], &["broken.png", "cannot read"]),
        (&["--orm", "nowhere.png"], &["nowhere.png", "No such file"]),
    ];
    for (arguments, words) in cases {
        let refused = with(arguments);
        let err = String::from_utf8_lossy(&refused.stderr);
        assert_eq!(refused.status.code(), Some(2), "{arguments:?}: {err}");
        assert!(refused.stdout.is_empty(), "{arguments:?}");
        for word in words {
            assert!(err.contains(word), "`{word}` is not in: {err}");
        }
    }
    let unknown = with(&["--look", "shiny"]);
    assert_eq!(unknown.status.code(), Some(2));
    assert_eq!(
        rain(&["bake"]).status.code(),
        Some(2),
        "a file or what to bake is asked for"
    );
    std::fs::write(folder.path().join("file"), b"").expect("written");
    let file = text(&folder.path().join("file"));
    let no_folder = rain(&["bake", "wet-textures", "--base-color", &base, "--out", &file]);
    assert_eq!(
        no_folder.status.code(),
        Some(2),
        "a file stands where the folder should be"
    );
}
