//! `rain model weather`: a series that depends on no step, and a budget that closes.

use rain_cli::model::calculate_with;

const STORM: &str = "time_s,intensity_mm_h\n0,0\n120,60\n600,60\n700,0\n";

fn run(arguments: &[&str]) -> String {
    let arguments: Vec<String> = arguments.iter().map(|a| (*a).to_owned()).collect();
    let read = |_: &std::path::Path| Ok(STORM.as_bytes().to_vec());
    calculate_with("weather", &arguments, &read).expect("a series").json()
}

/// A number after `"key":` in the part of `json` that starts at `from`.
fn number(json: &str, from: &str, key: &str) -> f64 {
    let part = &json[json.find(from).expect("the part")..];
    let name = format!("\"{key}\":");
    let rest = &part[part.find(&name).expect("the key") + name.len()..];
    let end = rest.find([',', '}']).expect("an end");
    rest[..end].parse().expect("a number")
}

#[test]
fn rows_run_from_the_start_to_the_end() {
    let json = run(&["timeline=storm.csv", "duration_s=1000", "step_s=300"]);
    let times: Vec<f64> = json
        .match_indices("\"time_s\":")
        .map(|(at, name)| number(&json[at..], name, "time_s"))
        .collect();
    assert_eq!(times, [0.0, 300.0, 600.0, 900.0, 1000.0]);
    assert_eq!(number(&json, "\"series\"", "wetness"), 0.0);
}

#[test]
fn the_budget_closes_and_depends_on_no_step() {
    let fine = run(&["timeline=storm.csv", "duration_s=3600", "step_s=1", "surface=soil"]);
    let coarse = run(&["timeline=storm.csv", "duration_s=3600", "step_s=3600", "surface=soil"]);
    let get = |json: &str, key: &str| number(json, "\"budget\"", key);
    // The area under the storm: 2 min up, 8 min of 60 mm/h, 100 s down.
    let rain = 60.0 * (60.0 + 480.0 + 50.0) / 3600.0;
    for json in [&fine, &coarse] {
        assert!((get(json, "rain_mm") - rain).abs() < 1e-9);
        assert!(get(json, "residual_relative") < 1e-9);
        let parts = ["pores_mm", "film_mm", "evaporated_mm", "infiltrated_mm", "drained_mm"];
        let sum: f64 = parts.iter().map(|key| get(json, key)).sum();
        assert!((sum - rain).abs() < 1e-9, "{sum} {rain}");
    }
    for key in ["pores_mm", "film_mm", "evaporated_mm", "infiltrated_mm", "drained_mm"] {
        let (a, b) = (get(&fine, key), get(&coarse, key));
        assert!((a - b).abs() < 1e-6 * rain, "{key}: {a} {b}");
    }
    assert!(get(&fine, "infiltrated_mm") > 1.0);
}

#[test]
fn the_weathers_own_parameters_matter() {
    let drained = |extra: &[&str]| {
        let mut arguments = vec!["timeline=storm.csv", "duration_s=900", "step_s=900"];
        arguments.extend(extra);
        number(&run(&arguments), "\"budget\"", "drained_mm")
    };
    let asphalt = drained(&[]);
    assert!(asphalt > 1.0);
    assert_eq!(drained(&["surface=asphalt"]), asphalt);
    let level = drained(&["slope=0"]);
    assert!(level.abs() < 1e-12, "{level}");
    assert!(drained(&["slope=0.08"]) > asphalt);
    assert!(drained(&["pore_capacity_mm=5"]) < asphalt);
    assert!(drained(&["net_radiation_w_m2=1000", "wind_m_s=20", "relative_humidity=0"]) < asphalt);
    assert!(
        drained(&[
            "infiltration_initial_mm_h=200",
            "infiltration_final_mm_h=100",
            "infiltration_decay_per_h=4"
        ]) < 0.1
    );
}

#[test]
fn the_potential_evaporation_is_that_of_the_rows_own_moment() {
    const WARMING: &str = "time_s,intensity_mm_h,air_temperature_c\n0,0,5\n3600,0,30\n";
    let rates = |step: &str| -> Vec<f64> {
        let arguments = ["timeline=w.csv", "duration_s=3600", step].map(str::to_owned);
        let read = |_: &std::path::Path| Ok(WARMING.as_bytes().to_vec());
        let json = calculate_with("weather", &arguments, &read).expect("a series").json();
        let name = "\"evaporation_mm_h\":";
        json.match_indices(name)
            .map(|(at, _)| number(&json[at..], name, "evaporation_mm_h"))
            .collect()
    };
    let (coarse, fine) = (rates("step_s=1800"), rates("step_s=900"));
    assert_eq!(coarse, [fine[0], fine[2], fine[4]], "no step changes them");
    assert!(
        0.0 < coarse[0] && coarse[0] < coarse[1] && coarse[1] < coarse[2],
        "{coarse:?}"
    );
}
