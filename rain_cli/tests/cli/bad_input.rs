//! What `rain model` refuses, and in which words.

use rain_cli::model::{Default, Kind, calculate, calculate_with, models};

#[track_caller]
fn refused(name: &str, arguments: &[&str], words: &[&str]) {
    let arguments: Vec<String> = arguments.iter().map(|a| (*a).to_owned()).collect();
    let error = calculate(name, &arguments).expect_err("refused").to_string();
    for word in words {
        assert!(error.contains(word), "`{word}` is not in: {error}");
    }
}

#[test]
fn unknown_models_and_keys_come_with_the_known_ones() {
    refused(
        "terminal-sped",
        &[],
        &["\"terminal-sped\"", "terminal-speed", "rainfall", "weather", "wheel"],
    );
    refused("", &[], &["no model is called"]);
    refused(
        "fall",
        &["diameter_mm=2", "hight_m=1"],
        &["fall has no key \"hight_m\"", "diameter_mm, height_m"],
    );
    refused("fall", &["diameter_mm=2", "=1"], &["no key \"\""]);
    refused("fall", &["diameter_mm"], &["\"diameter_mm\" is not key=value"]);
    refused("fall", &["Diameter_mm=2"], &["no key \"Diameter_mm\""]);
}

#[test]
fn keys_missing_or_twice_are_refused() {
    refused("fall", &["diameter_mm=2"], &["height_m is missing", "m"]);
    refused("fall", &[], &["diameter_mm is missing", "0.01 to 10 mm"]);
    refused(
        "fall",
        &["diameter_mm=2", "diameter_mm=2", "height_m=1"],
        &["diameter_mm is given twice"],
    );
}

#[test]
fn words_that_are_no_choice_are_refused() {
    refused(
        "terminal-speed",
        &["diameter_mm=2", "fit=bread"],
        &["fit is bread", "default, reference", "atlas-ulbrich"],
    );
    refused(
        "rainfall",
        &["intensity_mm_h=5", "renormalise=yes"],
        &["renormalise is yes", "true, false"],
    );
    refused(
        "waves",
        &["cells=1.5", "mode_x=1", "mode_y=0", "time_s=1"],
        &["cells is 1.5", "a whole number"],
    );
    refused(
        "canopy",
        &["lai=3", "kind=", "intensity_mm_h=3", "duration_s=1"],
        &["kind is \"\",", "broadleaf, needle"],
    );
}

/// Every number of every model: what is not finite, or beyond either end of its domain, is named with the domain.
#[test]
fn numbers_outside_their_domains_are_refused_everywhere() {
    let mut checked = 0;
    for model in models() {
        for key in model.keys {
            let mut bad: Vec<String> = ["NaN", "inf", "-inf", "1e999", "", "two", "1,5", " 1", "0x10"]
                .map(str::to_owned)
                .into();
            match key.kind {
                Kind::Number { min, max, above } => {
                    bad.push(format!("{}", max + 1e-3 * max.abs().max(1.0)));
                    bad.push(format!("{}", min - 1e-3 * min.abs().max(1.0)));
                    if above {
                        bad.push(format!("{min}"));
                    }
                }
                Kind::Count { min, max } => {
                    bad.push((u64::from(max) + 1).to_string());
                    bad.push((i64::from(min) - 1).to_string());
                }
                Kind::Choice(_) | Kind::Flag => {}
                Kind::File => continue,
            }
            for value in bad {
                let others = model
                    .example
                    .iter()
                    .filter(|a| !a.starts_with(&format!("{}=", key.name)));
                let arguments: Vec<String> = others
                    .map(|a| (*a).to_owned())
                    .chain([format!("{}={value}", key.name)])
                    .collect();
                let error = calculate(model.name, &arguments).expect_err("refused").to_string();
                let shown = match value.as_str() {
                    "" | " 1" => format!("{value:?}"),
                    _ => value,
                };
                let expected = format!("{} is {shown}, allowed: {}", key.name, key.allowed());
                assert_eq!(error, expected, "{}", model.name);
                checked += 1;
            }
        }
    }
    assert!(checked > 400, "only {checked}");
}

/// Both ends of every domain, and whatever the model does there, give finite numbers or a refusal in words.
#[test]
fn the_ends_of_every_domain_give_finite_results() {
    let storm = |_: &std::path::Path| Ok(b"time_s,intensity_mm_h\n0,0\n600,50\n1200,0\n".to_vec());
    let mut answered = 0;
    for model in models() {
        for key in model.keys {
            let ends: Vec<String> = match key.kind {
                Kind::Number { min, max, above: false } => vec![min.to_string(), max.to_string()],
                Kind::Number { min, max, above: true } => vec![(min + 1e-6 * max).to_string(), max.to_string()],
                // Large grids take long and are not at the end of anything.
                Kind::Count { min, .. } => vec![min.to_string()],
                Kind::Choice(words) => words.iter().map(|w| (*w).to_owned()).collect(),
                Kind::Flag => vec!["true".into(), "false".into()],
                Kind::File => continue,
            };
            for end in ends {
                let others = model
                    .example
                    .iter()
                    .filter(|a| !a.starts_with(&format!("{}=", key.name)));
                let arguments: Vec<String> = others
                    .map(|a| (*a).to_owned())
                    .chain([format!("{}={end}", key.name)])
                    .collect();
                match calculate_with(model.name, &arguments, &storm) {
                    Ok(output) => {
                        assert!(output.is_finite(), "{} {arguments:?}: {}", model.name, output.json());
                        answered += 1;
                    }
                    Err(error) => assert!(
                        error.to_string().contains("allowed"),
                        "{} {arguments:?}: {error}",
                        model.name
                    ),
                }
            }
        }
    }
    assert!(answered > 100, "only {answered}");
}

#[test]
fn defaults_are_allowed_values() {
    for model in models() {
        for key in model.keys {
            if let Default::Value(text) = key.default {
                let others = model
                    .example
                    .iter()
                    .filter(|a| !a.starts_with(&format!("{}=", key.name)));
                let arguments: Vec<String> = others
                    .map(|a| (*a).to_owned())
                    .chain([format!("{}={text}", key.name)])
                    .collect();
                let storm = |_: &std::path::Path| Ok(b"time_s,intensity_mm_h\n0,5\n".to_vec());
                let (given, left_out) = (
                    calculate_with(model.name, &arguments, &storm),
                    calculate_with(
                        model.name,
                        &model
                            .example
                            .iter()
                            .filter(|a| !a.starts_with(&format!("{}=", key.name)))
                            .map(|a| (*a).to_owned())
                            .collect::<Vec<_>>(),
                        &storm,
                    ),
                );
                assert!(given.is_ok(), "{} {}: {given:?}", model.name, key.name);
                assert_eq!(given, left_out, "{} {}", model.name, key.name);
            }
        }
    }
}

#[test]
fn weather_names_the_file_and_the_place_in_it() {
    let read = |text: &'static str| move |_: &std::path::Path| Ok(text.as_bytes().to_vec());
    let arguments = ["timeline=a.csv", "duration_s=10", "step_s=1"].map(str::to_owned);
    for (text, words) in [
        ("time_s,intensity_mm_h\n0,5\n1,x\n", ["a.csv", "line 3, column 2"]),
        ("time_s,intensity_mm_h\n0,5\n1,NaN\n", ["a.csv", "line 3, column 2"]),
        ("time_s,intensity_mm_h\n0,5\n1,-4\n", ["a.csv", "0 to 500 mm/h"]),
        ("time_s,intensity_mm_h\n5,5\n1,4\n", ["a.csv", "line 3"]),
        ("time_s\n5\n", ["a.csv", "intensity_mm_h"]),
        ("", ["a.csv", "line 1"]),
    ] {
        let error = calculate_with("weather", &arguments, &read(text))
            .expect_err("refused")
            .to_string();
        for word in words {
            assert!(error.contains(word), "`{word}` is not in: {error}");
        }
    }
    refused(
        "weather",
        &["timeline=/no/such.csv", "duration_s=1", "step_s=1"],
        &["/no/such.csv: "],
    );
    refused(
        "weather",
        &["timeline=a", "duration_s=1e8", "step_s=1"],
        &["duration_s/step_s", "up to 100000"],
    );
    refused(
        "weather",
        &["timeline=", "duration_s=1", "step_s=1"],
        &["timeline is \"\",", "path of a file"],
    );
}

#[test]
fn too_much_work_is_refused() {
    refused(
        "waves",
        &["cells=1024", "mode_x=1", "mode_y=0", "time_s=100000"],
        &["time_s", "allowed"],
    );
}

#[test]
fn values_that_cannot_be_seen_are_quoted() {
    refused(
        "fall",
        &["diameter_mm=", "height_m=1"],
        &["diameter_mm is \"\", allowed"],
    );
    refused(
        "fall",
        &["diameter_mm= 2", "height_m=1"],
        &["diameter_mm is \" 2\", allowed"],
    );
    refused(
        "fall",
        &["diameter_mm=2\n3", "height_m=1"],
        &["diameter_mm is \"2\\n3\", allowed"],
    );
    refused("terminal-speed", &["diameter_mm=2", "fit="], &["fit is \"\", allowed"]);
}

#[test]
fn infiltration_is_refused_in_the_names_of_its_keys() {
    let common = ["timeline=none.csv", "duration_s=1", "step_s=1", "surface=soil"];
    let with = |more: &'static str| [&common[..], &[more]].concat();
    for more in ["infiltration_initial_mm_h=0", "infiltration_final_mm_h=10000"] {
        refused(
            "weather",
            &with(more),
            &[
                "infiltration_initial_mm_h is ",
                "allowed: infiltration_final_mm_h, here ",
            ],
        );
    }
    for more in ["infiltration_decay_per_h=0", "infiltration_decay_per_h=1001"] {
        refused(
            "weather",
            &with(more),
            &["infiltration_decay_per_h is ", "0.000001 to 1000 1/h"],
        );
    }
}

#[test]
fn numbers_in_messages_are_short() {
    let arguments = ["timeline=none.csv", "duration_s=1e8", "step_s=1e-290"].map(str::to_owned);
    let error = calculate("weather", &arguments).expect_err("refused").to_string();
    assert!(error.contains("duration_s/step_s is 1") && error.len() < 80, "{error}");
}
