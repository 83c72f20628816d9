//! `rain bake streaks` as a process: files, output, messages, exit codes.

use std::path::Path;

use rain_core::rainfall::{PackedStreaks, StreakTextureSettings};

use crate::program::{folder, json, rain, refused};

/// Small enough to be made in no time.
const SMALL: [&str; 4] = ["bake", "streaks", "--texels", "32"];

fn with<'a>(more: &[&'a str]) -> Vec<&'a str> {
    SMALL.iter().copied().chain(more.iter().copied()).collect()
}

#[test]
fn streak_textures_are_made_once_and_read_by_others() {
    let folder = folder();
    let out = folder.path().to_string_lossy().into_owned();
    let made = json(&with(&["--out", &out, "--json"]));
    assert_eq!(made["outcome"], "made");
    assert_eq!(made["why"], serde_json::Value::Null);
    assert_eq!(made["texels"], 32);
    let layers = made["layers"].as_array().expect("layers");
    assert_eq!(layers.len(), 24);
    // What a metre of rain takes out: drops of 0.5 to 6 mm at 25 mm/h, 1.216 per km without those below (8 %).
    let depth: f64 = layers[12..18]
        .iter()
        .map(|l| l["extinction_per_m"].as_f64().expect("a number"))
        .sum();
    assert!((depth / 1.12e-3 - 1.0).abs() < 0.02, "{depth}");
    let settings = StreakTextureSettings {
        texels: 32,
        ..StreakTextureSettings::default()
    };
    assert_eq!(made["key"], format!("{:016x}", settings.key()));
    let path = Path::new(made["file"].as_str().expect("a path"));
    let bytes = std::fs::read(path).expect("a file");
    let stored = PackedStreaks::from_ktx2(&bytes, &settings).expect("textures");
    assert_eq!(stored, PackedStreaks::bake(&settings).expect("a set"));
    // Again: read. Cut off: made anew, with the reason.
    assert_eq!(json(&with(&["--out", &out, "--json"]))["outcome"], "read");
    std::fs::write(path, &bytes[..bytes.len() / 2]).expect("written");
    let again = json(&with(&["--out", &out, "--json"]));
    assert_eq!(again["outcome"], "remade");
    assert!(again["why"].as_str().expect("a reason").contains("KTX2"), "{again}");
    assert_eq!(std::fs::read(path).expect("a file"), bytes);
    // Other settings are another file.
    let other = json(&with(&["--out", &out, "--seed", "2", "--json"]));
    assert!(other["outcome"] == "made" && other["file"] != made["file"]);
    let text = String::from_utf8_lossy(&rain(&with(&["--out", &out])).stdout).into_owned();
    assert!(
        text.contains("read; 24 layers of 32 texels a side") && text.lines().count() == 26,
        "{text}"
    );
}

#[test]
fn the_sources_set_and_any_other_can_be_asked_for() {
    let folder = folder();
    let out = folder.path().to_string_lossy().into_owned();
    let source = json(&with(&["--yoshida", "--out", &out, "--json"]));
    let layers = source["layers"].as_array().expect("layers");
    assert_eq!(layers.len(), 24);
    assert_eq!(
        (&layers[6]["intensity_mm_h"], &layers[6]["min_mm"]),
        (&5.0.into(), &0.9.into())
    );
    let other = json(&with(&[
        "--intensities-mm-h",
        "3,30",
        "--diameter-edges-mm",
        "0.5,1,6",
        "--tile-m",
        "0.5",
        "--exposure-s",
        "0.004",
        "--distribution",
        "thunderstorm",
        "--out",
        &out,
        "--json",
    ]));
    assert_eq!(other["layers"].as_array().map(Vec::len), Some(4));
    assert_eq!((&other["tile_m"], &other["exposure_s"]), (&0.5.into(), &0.004.into()));
}

#[test]
fn bad_settings_and_folders_are_refused_by_name() {
    let folder = folder();
    let out = folder.path().to_string_lossy().into_owned();
    let bad = |more: &[&str], words: &[&str]| {
        let mut all = with(more);
        all.extend(["--out", &out]);
        refused(&all, words);
    };
    bad(&["--tile-m", "-1"], &["tile_m is -1", "0.25 to 4 m"]);
    bad(&["--exposure-s", "nan"], &["exposure_s is NaN"]);
    bad(&["--intensities-mm-h", "5,1"], &["intensities_mm_h: entry 1"]);
    bad(&["--intensities-mm-h", "5,x"], &["x"]);
    bad(&["--distribution", "snow"], &["marshall-palmer"]);
    refused(
        &["bake", "streaks", "--texels", "33", "--out", &out],
        &["a power of two"],
    );
    refused(&["bake"], &["<FILE>"]);
    assert_eq!(std::fs::read_dir(folder.path()).expect("a folder").count(), 0);
    // A file where the folder should be.
    let file = folder.path().join("file");
    std::fs::write(&file, b"x").expect("written");
    refused(&with(&["--out", &file.to_string_lossy()]), &["file"]);
}
