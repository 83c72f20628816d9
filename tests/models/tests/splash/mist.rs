//! Mist of splashes: numbers of droplets, their flight, and the layers they make.

use rain_core::rainfall::{Distribution, Spectrum, terminal_velocity};
use rain_core::splash::{
    ImpactNumbers, MIST_SIZE, MistFlight, MistGround, MistLayer, MistLayers, SecondaryDrop, friction_velocity_m_s,
    mist_droplets, rouse_number, secondary_drop_number, splash_excess, splash_threshold_diameter_mm,
};

use super::{BAD, spectrum};

/// The speeds that the smallest thrown drops leave with: 0.4 of the impact's at 55°.
const RISE: f64 = 0.4 * 0.819_152_044_288_991_8;

#[test]
fn secondary_drops_are_as_many_as_measured() {
    // Okawa et al. 2006 with the numbers of water at 20 °C, on a film as thick as the drop.
    for d in [2.0, 3.0, 4.0] {
        let v = terminal_velocity(d);
        let numbers = ImpactNumbers::new(d, v);
        let k = numbers.weber * numbers.ohnesorge.powf(-0.4);
        let expected = 7.84e-6 * k.powf(1.8);
        let found = secondary_drop_number(d, v, d);
        assert!((found / expected - 1.0).abs() < 1e-13, "{d}: {found} {expected}");
        // Thicker water throws fewer, thinner films are held.
        let deep = secondary_drop_number(d, v, 4.0 * d) / found;
        assert!((deep - 4_f64.powf(-0.3)).abs() < 1e-13);
        assert_eq!(
            secondary_drop_number(d, v, 0.5 * d),
            secondary_drop_number(d, v, 0.1 * d)
        );
    }
    // At the threshold of a deep film (K = 2100 + 5880 · 1.2^1.44) some tens, below it none.
    let edge = splash_threshold_diameter_mm(3.0);
    let v = |d: f64| terminal_velocity(d);
    assert_eq!(secondary_drop_number(0.999 * edge, v(0.999 * edge), 3.0), 0.0);
    let least = secondary_drop_number(1.001 * edge, v(1.001 * edge), 3.0);
    assert!(least > 20.0 && least < 120.0, "{least}");
    // A drop of 3 mm at its terminal speed: about a thousand.
    let many = secondary_drop_number(3.0, v(3.0), 3.0);
    assert!(many > 700.0 && many < 1200.0, "{many}");
    for bad in BAD {
        assert!(secondary_drop_number(bad, 6.0, 0.1).is_finite());
        assert!(secondary_drop_number(2.0, bad, 0.1).is_finite());
        assert!(secondary_drop_number(2.0, 6.0, bad).is_finite());
    }
}

#[test]
fn mist_is_what_is_not_thrown_singly_and_no_more_than_a_quarter_of_the_drop() {
    for i in 1..=60 {
        let d = 0.1 * f64::from(i);
        let v = terminal_velocity(d);
        for film in [0.0, 0.1, 1.0] {
            let droplets = mist_droplets(d, v, film);
            let all = secondary_drop_number(d, v, film);
            let excess = splash_excess(d, v, film);
            let drawn = if excess > 1.0 {
                5.0 + 25.0 * ((excess - 1.0) / 18.0).min(1.0)
            } else {
                0.0
            };
            let expected = (all - drawn).clamp(0.0, 2000.0);
            assert!((droplets - expected).abs() < 1e-13 * all.max(1.0), "{d} {film}");
            let water = droplets * MIST_SIZE.powi(3);
            assert!(water <= 0.25 + 1e-12, "{d} {film}: {water}");
        }
    }
}

#[test]
fn droplets_fly_as_the_steps_of_their_way_add_up() {
    for (d, rise) in [
        (0.05, 1.5),
        (0.1, 2.1),
        (0.15, 2.6),
        (0.25, 3.0),
        (0.4, 0.5),
        (0.1, 1e-3),
    ] {
        let fall = terminal_velocity(d);
        let tau = fall / 9.806_65;
        // Simpson's rule over the time of flight, which is found by halving.
        let height = |t: f64| -fall * t - (rise + fall) * tau * (-t / tau).exp_m1();
        let (mut low, mut high) = (1e-3 * rise / 9.8, 10.0);
        for _ in 0..200 {
            let mid = 0.5 * (low + high);
            if height(mid) > 0.0 {
                low = mid;
            } else {
                high = mid;
            }
        }
        let time = low;
        let n = 20_000;
        let sum: f64 = (0..=n)
            .map(|i| {
                let weight = if i == 0 || i == n {
                    1.0
                } else if i % 2 == 1 {
                    4.0
                } else {
                    2.0
                };
                weight * height(time * f64::from(i) / f64::from(n))
            })
            .sum();
        let mean = sum / (3.0 * f64::from(n));
        let peak_time = tau * (rise / fall).ln_1p();
        let flight = MistFlight::new(d, rise);
        for (found, expected) in [
            (flight.time_s, time),
            (flight.mean_height_m, mean),
            (flight.peak_m, height(peak_time)),
        ] {
            assert!(
                (found / expected - 1.0).abs() < 1e-10 + 1e-11 / rise.powi(2),
                "{d} {rise}: {found} {expected}"
            );
        }
        // The way that drawn drops take.
        let drawn = SecondaryDrop {
            diameter_mm: d as f32,
            velocity_m_s: glam::Vec3::new(0.0, rise as f32, 0.0),
        };
        let found = f64::from(drawn.place_m(peak_time as f32).y);
        assert!(
            (found / flight.peak_m - 1.0).abs() < 2e-3,
            "{d} {rise}: {found} {}",
            flight.peak_m
        );
    }
    for bad in BAD {
        let flight = MistFlight::new(bad, 1.0);
        assert!(flight.time_s.is_finite() && flight.mean_height_m >= 0.0 && flight.peak_m >= flight.mean_height_m);
        let flight = MistFlight::new(0.2, bad);
        assert!(flight.time_s.is_finite() && flight.mean_height_m >= 0.0 && flight.peak_m >= flight.mean_height_m);
    }
    // Fine drops of large rain rise by a hand's breadth.
    let flight = MistFlight::new(0.15, RISE * terminal_velocity(3.0));
    assert!(flight.peak_m > 0.05 && flight.peak_m < 0.2, "{flight:?}");
}

#[test]
fn wind_over_ground_has_the_log_laws_friction_and_lifts_what_falls_slower() {
    // Over short grass u* is about a fifteenth of the wind at 10 m.
    assert!((friction_velocity_m_s(10.0, 0.03) / (4.0 / (1000.0_f64 / 3.0).ln()) - 1.0).abs() < 1e-15);
    assert!(friction_velocity_m_s(10.0, 1.0) > 2.0 * friction_velocity_m_s(10.0, 0.03));
    let rouse = |d: f64, wind: f64| rouse_number(terminal_velocity(d), friction_velocity_m_s(wind, 0.03));
    assert!((rouse_number(0.28, 0.7) - 1.0).abs() < 1e-15);
    // Droplets of 0.1 mm (0.25 m/s) begin to be carried at some 4 m/s and are from 12 m/s on; rain never is.
    assert!(rouse(0.1, 2.0) > 2.5 && rouse(0.1, 12.0) < 1.0, "{}", rouse(0.1, 10.0));
    assert!(rouse(2.0, 30.0) > 2.5);
    for bad in BAD {
        assert!(friction_velocity_m_s(bad, 0.03).is_finite() && friction_velocity_m_s(10.0, bad) > 0.0);
        assert!(rouse_number(bad, 0.5).is_finite() && rouse_number(0.2, bad).is_finite());
    }
}

#[test]
fn the_depth_of_a_layer_is_its_integral() {
    let layer = MistLayer {
        extinction_per_m: 0.07,
        height_m: 0.06,
    };
    for (from, to, way) in [(1.6, 0.0, 20.0), (0.0, 0.1, 0.3), (0.05, 0.05, 3.0), (0.3, 0.02, 1.0)] {
        let n = 200_000;
        let sum: f64 = (0..n)
            .map(|i| {
                let t = (f64::from(i) + 0.5) / f64::from(n);
                let height: f64 = from + (to - from) * t;
                0.07 * (-height / 0.06).exp()
            })
            .sum();
        let expected = sum * way / f64::from(n);
        let found = layer.depth(from, to, way);
        assert!((found / expected - 1.0).abs() < 1e-6, "{from} {to}: {found} {expected}");
        assert_eq!(found, layer.depth(to, from, way));
        // Closed: halves add up.
        let half = 0.5 * (from + to);
        let parts = layer.depth(from, half, 0.5 * way) + layer.depth(half, to, 0.5 * way);
        assert!((found / parts - 1.0).abs() < 1e-12);
    }
    for bad in BAD {
        assert!(layer.depth(bad, 0.1, 1.0).is_finite() && layer.depth(0.1, 0.2, bad).is_finite());
    }
    assert_eq!(MistLayer::default().depth(0.0, 0.0, 1.0), 0.0);
}

/// Both layers by sums over single diameters.
fn summed(spectrum: &Spectrum, ground: &MistGround, q: f64) -> [f64; 4] {
    let from = splash_threshold_diameter_mm(ground.film_mm);
    let n = 40_000;
    let step = (6.0 - from) / f64::from(n);
    let mut sums = [0.0; 4];
    for i in 0..n {
        let d = from + (f64::from(i) + 0.5) * step;
        let v = terminal_velocity(d);
        let fine = 0.05 * d;
        let source = spectrum.concentration(d) * v * step * mist_droplets(d, v, ground.film_mm);
        let section = q * core::f64::consts::FRAC_PI_4 * (1e-3 * fine).powi(2) * source;
        let flight = MistFlight::new(fine, RISE * v);
        sums[0] += section * flight.time_s;
        sums[1] += section * flight.time_s * flight.mean_height_m;
        let friction = 0.4 * ground.wind_m_s / (10.0 / ground.roughness_m).ln();
        if friction > 0.0 {
            let w = terminal_velocity(fine);
            let p = w / (0.4 * friction);
            let a = flight.peak_m;
            let top = 0.16 / (10.0 / ground.roughness_m).ln() * ground.fetch_m;
            let held = section / w;
            let moment = |n: f64| (top.powf(n - p) * a.powf(p) - a.powf(n)) / (n - p);
            sums[2] += held * moment(1.0);
            sums[3] += held * moment(2.0);
        }
    }
    let layer = |column: f64, moment: f64| {
        let height = moment / column;
        [column / height, height]
    };
    let [a, b] = layer(sums[0], sums[1]);
    let [c, e] = if sums[2] > 0.0 {
        layer(sums[2], sums[3])
    } else {
        [0.0; 2]
    };
    [a, b, c, e]
}

#[test]
fn layers_of_mist_are_their_sums_over_diameters() {
    for rate in [2.0, 20.0, 90.0] {
        for wind_m_s in [0.0, 3.0, 10.0, 20.0] {
            for film_mm in [0.0, 0.1, 1.0] {
                let ground = MistGround {
                    film_mm,
                    wind_m_s,
                    ..MistGround::default()
                };
                let mist = MistLayers::new(&spectrum(rate), &ground, 2.0).expect("valid");
                let expected = summed(&spectrum(rate), &ground, 2.0);
                let found = [
                    mist.thrown.extinction_per_m,
                    mist.thrown.height_m,
                    mist.carried.extinction_per_m,
                    mist.carried.height_m,
                ];
                for (found, expected) in found.into_iter().zip(expected) {
                    assert!(
                        (found - expected).abs() <= 5e-5 * expected,
                        "{rate} {wind_m_s} {film_mm}: {found} {expected}"
                    );
                }
            }
        }
    }
}

#[test]
fn mist_grows_with_rain_and_wind_carries_it_up_from_ten_metres_a_second_on() {
    let mist = |rate: f64, wind_m_s: f64| {
        let ground = MistGround {
            wind_m_s,
            ..MistGround::default()
        };
        MistLayers::new(&spectrum(rate), &ground, 2.0).expect("valid")
    };
    let mut before = 0.0;
    for rate in [1.0, 5.0, 20.0, 50.0, 90.0, 150.0] {
        let layer = mist(rate, 0.0).thrown;
        assert!(layer.extinction_per_m > before, "{rate}");
        // Thrown as high as a hand is broad.
        assert!(layer.height_m > 0.02 && layer.height_m < 0.15, "{rate}: {layer:?}");
        assert_eq!(mist(rate, 0.0).carried, MistLayer::default());
        before = layer.extinction_per_m;
    }
    // Near the ground the mist of heavy rain is thicker than the rain itself; in light rain it is nothing.
    let rain = |rate: f64| rain_core::haze::extinction_per_m(&spectrum(rate), 2.0);
    assert!(mist(50.0, 0.0).thrown.extinction_per_m > rain(50.0));
    let column = |rate: f64| mist(rate, 0.0).thrown.depth(0.0, 10.0, 10.0);
    assert!(
        column(1.0) < 1e-4 && column(90.0) > 0.01,
        "{} {}",
        column(1.0),
        column(90.0)
    );
    // At the height of the eye: nothing in a breeze, a share of the rain's in a storm.
    let at_eye = |wind: f64| {
        let layer = mist(50.0, wind).carried;
        layer.extinction_per_m * (-1.6 / layer.height_m.max(1e-9)).exp()
    };
    let shares: Vec<f64> = [3.0, 6.0, 10.0, 15.0, 20.0, 30.0]
        .map(|w| at_eye(w) / rain(50.0))
        .into();
    assert!(shares.windows(2).all(|w| w[1] > w[0]), "{shares:?}");
    assert!(shares[0] < 0.02 && shares[4] > 0.1, "{shares:?}");
    // What is thrown does not depend on the wind.
    assert_eq!(mist(50.0, 0.0).thrown, mist(50.0, 20.0).thrown);
}

#[test]
fn mist_of_bad_ground_is_refused_and_of_no_rain_is_none() {
    let good = MistGround::default();
    let rain = spectrum(50.0);
    for bad in [f64::NAN, f64::INFINITY, -1.0] {
        for ground in [
            MistGround { film_mm: bad, ..good },
            MistGround { wind_m_s: bad, ..good },
            MistGround {
                roughness_m: bad,
                ..good
            },
            MistGround { fetch_m: bad, ..good },
        ] {
            assert!(MistLayers::new(&rain, &ground, 2.0).is_err(), "{ground:?}");
        }
        assert!(
            MistLayers::new(&rain, &good, bad)
                .expect("held")
                .thrown
                .extinction_per_m
                .is_finite()
        );
    }
    let none = Spectrum::new(Distribution::MarshallPalmer, 0.0).expect("valid");
    assert_eq!(
        MistLayers::new(&none, &good, 2.0).expect("valid"),
        MistLayers::default()
    );
}
