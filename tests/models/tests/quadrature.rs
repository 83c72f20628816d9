//! The Gauss–Legendre rules against roots found by halving, over every number of points in use.

use proptest::prelude::*;
use rain_core::quadrature::GaussLegendre;
use rain_reference::numerics::gauss_legendre;

use crate::check::Worst;

/// Nodes and weights of the rule of N points, and polynomials up to its degree on [−1, 1] and elsewhere.
fn compare<const N: usize>([nodes, weights, sums, single, beyond]: &mut [Worst; 5]) {
    let rule = GaussLegendre::<N>::RULE;
    for (i, [x, w]) in gauss_legendre(N).into_iter().enumerate() {
        nodes.absolute(rule.nodes[i], x, || format!("node {i} of {N}"));
        weights.absolute(rule.weights[i], w, || format!("weight {i} of {N}"));
    }
    for degree in 0..=2 * N as i32 {
        for (a, b) in [(-1.0, 1.0), (0.0, 1.0), (0.3, 0.9), (1.0, -0.5)] {
            // (x − a)^degree: its integral is known without a difference.
            let span: f64 = b - a;
            let exact = span.powi(degree + 1) / f64::from(degree + 1);
            let place = || format!("{N} points, degree {degree} on {a} to {b}");
            let f = |x: f64| (x - a).powi(degree);
            let sum = rule.integrate(a, b, f);
            if degree == 2 * N as i32 {
                beyond.relative(sum, exact, 0.0, place);
            } else {
                sums.relative(sum, exact, 0.0, place);
                sums.relative(rule.integrate_panels(a, b, 3, f), exact, 0.0, place);
                if degree < 8 {
                    let sum = rule.integrate_f32(0.0, span as f32, |x| x.powi(degree));
                    single.relative(
                        f64::from(sum),
                        f64::from(span as f32).powi(degree + 1) / f64::from(degree + 1),
                        0.0,
                        place,
                    );
                }
            }
        }
    }
}

#[test]
fn rules_of_every_size_have_their_roots_and_integrate_polynomials() {
    let mut all = [(); 5].map(|()| Worst::default());
    compare::<1>(&mut all);
    compare::<2>(&mut all);
    compare::<3>(&mut all);
    compare::<4>(&mut all);
    compare::<5>(&mut all);
    compare::<8>(&mut all);
    compare::<16>(&mut all);
    compare::<24>(&mut all);
    compare::<32>(&mut all);
    compare::<64>(&mut all);
    let [nodes, weights, sums, single, beyond] = all;
    nodes.assert_below(1e-15, 150);
    weights.assert_below(4e-15, 150);
    sums.assert_below(4e-14, 2000);
    single.assert_below(1e-6, 200);
    assert!(beyond.error > 0.1, "one degree more goes unseen");
}

#[test]
fn rules_take_what_is_no_interval() {
    let rule = GaussLegendre::<8>::RULE;
    assert_eq!(rule.integrate(2.0, 2.0, |x| x), 0.0);
    assert_eq!(rule.integrate(0.0, 1.0, |_| 0.0), 0.0);
    let mut calls = 0;
    let sum = rule.integrate_panels(0.0, 3.0, 0, |x| {
        calls += 1;
        assert!(x > 0.0 && x < 3.0, "inside");
        1.0
    });
    assert!(calls == 8 && (sum - 3.0).abs() < 1e-14, "no panel is one panel");
    assert!((rule.integrate(-1e300, 1e300, |_| 1e-300) - 2.0).abs() < 1e-14);
    assert!(rule.integrate(f64::NAN, 1.0, |x| x).is_nan(), "no number, no integral");
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, rng_seed: proptest::test_runner::RngSeed::Fixed(23), ..ProptestConfig::default() })]

    #[test]
    fn integrals_add_up_and_turn_with_their_limits(
        a in -10.0_f64..10.0, b in -10.0_f64..10.0, c in -10.0_f64..10.0, k in 0.1_f64..0.5, panels in 1_u32..9,
    ) {
        let rule = GaussLegendre::<24>::RULE;
        let f = |x: f64| (k * x).sin() + 2.0;
        let whole = rule.integrate(a, c, f);
        let scale = 3.0 * ((b - a).abs() + (c - b).abs());
        prop_assert!((rule.integrate(a, b, f) + rule.integrate(b, c, f) - whole).abs() <= 1e-14 * scale);
        prop_assert!((rule.integrate(c, a, f) + whole).abs() <= 1e-14 * scale);
        prop_assert!((rule.integrate_panels(a, c, panels, f) - whole).abs() <= 1e-14 * scale);
        prop_assert!(whole * (c - a) >= 0.0, "what is positive adds up to something positive");
        let single = f64::from(rule.integrate_f32(a as f32, c as f32, |x| (k as f32 * x).sin() + 2.0));
        prop_assert!((single - whole).abs() <= 3e-6 * 3.0 * (a.abs() + c.abs() + 1.0));
    }
}
