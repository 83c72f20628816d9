//! The sources' own looks: arithmetic alone, no claim about nature.

use proptest::prelude::*;
use rain_core::surface::artist_look::{
    ArtistLook, ArtistRules, accumulated_water, artist_surface, crack_water, drenched_share, effective_wetness,
    lagarde_porosity, lagarde_porous_wet, lagarde_wet, nguyenova_puddle, nguyenova_puddle_amount,
    nguyenova_puddle_depth_mm, painted_puddle_water, screen_blend,
};
use rain_core::surface::puddle_map;
use rain_reference::artist_look as truth;

use super::{ANY, config};
use crate::check::Worst;

/// 0 to 1 in sixteenths, and numbers that are no sixteenths.
fn shares() -> impl Iterator<Item = f64> + Clone {
    (0..=16)
        .map(|i| f64::from(i) / 16.0)
        .chain([1e-9, 0.1, 1.0 / 3.0, 0.5001, 0.7, 0.95, 1.0 - 1e-9])
}

fn parts(look: ArtistLook) -> [f64; 3] {
    [look.albedo, look.gloss, look.f0]
}

#[test]
fn the_sources_looks_are_their_listings() {
    let (mut look_error, mut wrong) = (Worst::default(), Worst::default());
    for albedo in shares() {
        for gloss in shares() {
            let look = ArtistLook {
                albedo,
                gloss,
                f0: 0.04,
            };
            for w in shares() {
                let porosity = lagarde_porosity(gloss, 0.2);
                for (found, exact) in [
                    (lagarde_wet(look, w), truth::wet(parts(look), w)),
                    (look.flooded(w), truth::flooded(parts(look), w)),
                    (
                        lagarde_porous_wet(look, porosity, w),
                        truth::porous_wet(parts(look), porosity, w),
                    ),
                    (
                        lagarde_porous_wet(look, 1.0 - albedo, w),
                        truth::porous_wet(parts(look), 1.0 - albedo, w),
                    ),
                    (nguyenova_puddle(look, w), truth::puddle(parts(look), w)),
                ] {
                    for (a, b) in parts(found).into_iter().zip(exact) {
                        look_error.absolute(a, b, || format!("{look:?} {w}"));
                    }
                }
                wrong.absolute(
                    lagarde_wet(look, 1.05 * w).albedo,
                    truth::wet(parts(look), w)[0],
                    String::new,
                );
            }
        }
    }
    look_error.assert_below(5e-16, 100_000);
    assert!(wrong.error > 0.03, "a wetness 5 % off goes unseen");
}

#[test]
fn the_sources_waters_are_their_listings() {
    let (mut water, mut wrong) = (Worst::default(), Worst::default());
    let (mut margin, mut depth) = (Worst::default(), Worst::default());
    for a in shares() {
        for b in shares() {
            let place = || format!("{a} {b}");
            for (found, exact) in [
                (lagarde_porosity(a, b), truth::porosity(a, b)),
                (crack_water(a, b), truth::cracks(a, b)),
                (accumulated_water(a, b), truth::accumulated(a, b)),
                (screen_blend(a, b), truth::screen(a, b)),
                (nguyenova_puddle_amount(a, b), truth::puddle_amount(a, b)),
            ] {
                water.absolute(found, exact, place);
            }
            for c in shares() {
                water.absolute(effective_wetness(a, b, c), truth::wetness(a, b, c), place);
            }
            wrong.absolute(screen_blend(1.05 * a, b), truth::screen(a, b), String::new);
            for width in [1e-4, 0.01, 0.4, 1.0, 7.0] {
                // The difference of two levels is known to 1e-16; the margin divides it.
                margin.absolute(
                    width * painted_puddle_water(a, b, width),
                    width * truth::painted(a, b, width),
                    || format!("{a} {b} {width}"),
                );
            }
        }
        depth.relative(nguyenova_puddle_depth_mm(a), 10.0 * a, 1e-300, || format!("{a}"));
    }
    water.assert_below(4e-16, 10_000);
    margin.assert_below(3e-16, 2000);
    depth.assert_below(2e-16, 20);
    assert!(wrong.error > 0.03, "a map 5 % off goes unseen");
}

#[test]
fn the_sources_looks_take_what_is_no_share() {
    for a in ANY {
        // What lies outside counts as the nearest end, what is not a number as 0.
        let held = if a.is_nan() { 0.0 } else { a.clamp(0.0, 1.0) };
        let look = |x| ArtistLook {
            albedo: x,
            gloss: x,
            f0: x,
        };
        assert_eq!(lagarde_wet(look(a), a), lagarde_wet(look(held), held), "{a}");
        assert_eq!(look(a).flooded(a), look(held).flooded(held), "{a}");
        assert_eq!(
            lagarde_porous_wet(look(a), a, a),
            lagarde_porous_wet(look(held), held, held)
        );
        assert_eq!(nguyenova_puddle(look(a), a), nguyenova_puddle(look(held), held));
        for (found, expected) in [
            (lagarde_porosity(a, a), lagarde_porosity(held, held)),
            (crack_water(a, a), crack_water(held, held)),
            (
                painted_puddle_water(a, 0.25, 0.4),
                painted_puddle_water(held, 0.25, 0.4),
            ),
            (painted_puddle_water(0.5, a, 0.4), painted_puddle_water(0.5, held, 0.4)),
            (accumulated_water(a, a), held),
            (effective_wetness(a, a, a), effective_wetness(held, held, held)),
            (screen_blend(a, a), screen_blend(held, held)),
            (nguyenova_puddle_amount(a, 0.2), nguyenova_puddle_amount(held, 0.2)),
            (nguyenova_puddle_depth_mm(a), 10.0 * held),
        ] {
            assert_eq!(found, expected, "{a}");
        }
    }
    for margin in [f64::NAN, f64::NEG_INFINITY, -1.0, 0.0, 1e-300] {
        assert_eq!(
            painted_puddle_water(0.5, 0.499_99, margin),
            painted_puddle_water(0.5, 0.499_99, 1e-4)
        );
    }
    assert_eq!(painted_puddle_water(1.0, 0.0, f64::INFINITY), 0.0);
}

#[test]
fn the_drenched_ground_lies_between_wet_and_puddle() {
    let (mut share, mut wrong) = (Worst::default(), Worst::default());
    for level in shares() {
        for blended in shares() {
            assert_eq!(
                drenched_share(level, blended, 0.0),
                0.0,
                "wet passes straight into puddle"
            );
            for width in [1e-3, 0.05, 0.3, 1.0] {
                let found = drenched_share(level, blended, width);
                let exact = truth::drenched(level, blended, width);
                share.absolute(width * found, width * exact, || format!("{level} {blended} {width}"));
                wrong.absolute(
                    width * drenched_share(level, 0.95 * blended, width),
                    width * exact,
                    String::new,
                );
                assert!((0.0..=1.0).contains(&found));
                if blended >= level + width + 1e-12 || level == 0.0 {
                    assert_eq!(found, 0.0, "{level} {blended} {width}: wet ground, or none at all");
                }
                if level >= width && blended <= level {
                    assert_eq!(found, 1.0, "{level} {blended} {width}: puddle");
                }
            }
        }
    }
    share.assert_below(1e-15, 2000);
    assert!(wrong.error > 0.01, "a height 5 % off goes unseen");
    for a in ANY {
        let held = if a.is_nan() { 0.0 } else { a.clamp(0.0, 1.0) };
        assert_eq!(drenched_share(a, a, a), drenched_share(held, held, held), "{a}");
    }
}

#[test]
fn the_puddle_map_is_its_noise_and_has_no_tiles() {
    let (mut map, mut wrong) = (Worst::default(), Worst::default());
    let at = |i: u32| f64::from(i) * 0.137 - 300.0;
    for i in 0..4000_u32 {
        for (x, z, seed) in [
            (at(i), 0.3 * at(i) + 7.0, 5),
            (1e6 + at(i), -3.0 * at(i), 0xff_ffff - 2),
        ] {
            let exact = truth::puddle_map(x, z, seed);
            map.absolute(puddle_map(x, z, seed), exact, || format!("{x} {z} {seed}"));
            wrong.absolute(puddle_map(x, z, seed + 1), exact, String::new);
        }
    }
    map.assert_below(1e-12, 8000);
    assert!(wrong.error > 0.5, "another seed goes unseen");
    // What lies a shift away is as good as another map, whatever the shift: nothing repeats.
    for shift in [5.0, 8.0, 16.0, 50.0, 64.0, 100.0, 128.0, 256.0] {
        let pairs: Vec<(f64, f64)> = (0..8000_u32)
            .map(|i| {
                let (x, z) = (f64::from(i % 90) * 1.3, f64::from(i / 90) * 1.7);
                (puddle_map(x, z, 3), puddle_map(x + shift, z, 3))
            })
            .collect();
        let r = rain_reference::hash::correlation(&pairs);
        assert!(r.abs() < 0.1, "{shift}: {r}");
    }
    let near: Vec<(f64, f64)> = (0..2000_u32)
        .map(|i| (puddle_map(at(i), 0.0, 3), puddle_map(at(i) + 0.1, 0.0, 3)))
        .collect();
    assert!(
        rain_reference::hash::correlation(&near) > 0.7,
        "a neighbour is no other map"
    );
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, 1e10] {
        assert_eq!((puddle_map(bad, 0.0, 1), puddle_map(0.0, bad, 1)), (1.0, 1.0), "{bad}");
    }
}

proptest! {
    #![proptest_config(config(256))]

    #[test]
    fn more_water_is_darker_smoother_and_wetter(
        albedo in 0.0_f64..1.0, gloss in 0.0_f64..1.0, f0 in 0.0_f64..1.0, porosity in 0.0_f64..1.0,
        w in 0.0_f64..1.0, v in 0.0_f64..1.0, map in 0.0_f64..1.0, other in 0.0_f64..1.0,
    ) {
        let look = ArtistLook { albedo, gloss, f0 };
        let (less, more) = (w.min(v), w.max(v));
        for rule in [lagarde_wet, nguyenova_puddle, |look, w| lagarde_porous_wet(look, 0.7, w)] {
            let (dry, damp, wet) = (rule(look, 0.0), rule(look, less), rule(look, more));
            prop_assert_eq!(dry, look, "dry is as it was");
            prop_assert!(wet.albedo <= damp.albedo && damp.albedo <= albedo);
            prop_assert!(wet.gloss >= damp.gloss - 1e-15 && damp.gloss >= gloss - 1e-15);
            prop_assert_eq!(wet.f0, f0);
        }
        prop_assert!(lagarde_porous_wet(look, porosity, w).albedo <= lagarde_porous_wet(look, 0.5 * porosity, w).albedo);
        prop_assert!(lagarde_porosity(less, other) >= lagarde_porosity(more, other));
        prop_assert!(look.flooded(more).gloss >= look.flooded(less).gloss - 1e-15);
        prop_assert!(crack_water(more, map) >= crack_water(less, map) && crack_water(w, map) <= w);
        prop_assert!(painted_puddle_water(more, map, 0.4) >= painted_puddle_water(less, map, 0.4));
        prop_assert!(accumulated_water(w, v) == accumulated_water(v, w) && accumulated_water(w, v) == more);
        prop_assert!(effective_wetness(more, map, other) >= effective_wetness(less, map, other));
        prop_assert!(effective_wetness(w, 0.0, other) == other);
        prop_assert!((screen_blend(w, v) - screen_blend(v, w)).abs() < 1e-15 && screen_blend(w, v) >= more - 1e-15);
        prop_assert!(nguyenova_puddle_amount(more, map) >= nguyenova_puddle_amount(less, map));
        prop_assert!(nguyenova_puddle_depth_mm(more) >= nguyenova_puddle_depth_mm(less));
    }
}

#[test]
fn the_sources_looks_have_their_check_values() {
    // Nguyenova: wetness 0, 0.5, 1 gives the factors 1, 0.65, 0.3 and smoothness 0.3 → 0.3, 0.525, 0.75; 0.5 → 1.
    for (w, factor, gloss) in [(0.0, 1.0, 0.3), (0.5, 0.65, 0.525), (1.0, 0.3, 0.75)] {
        let wet = lagarde_wet(
            ArtistLook {
                albedo: 0.5,
                gloss: 0.3,
                f0: 0.04,
            },
            w,
        );
        assert!((wet.albedo - 0.5 * factor).abs() < 1e-15 && (wet.gloss - gloss).abs() < 1e-15);
    }
    let mirror = lagarde_wet(
        ArtistLook {
            albedo: 0.5,
            gloss: 0.5,
            f0: 0.04,
        },
        1.0,
    );
    assert_eq!(mirror.gloss, 1.0);
    // Blended map 0.4, level 0.7: p = 0.3, factor 0.94, smoothness 0.5 → 0.65, 3 mm; level 0.3: nothing.
    let p = nguyenova_puddle_amount(0.7, 0.4);
    assert!((p - 0.3).abs() < 1e-15 && (nguyenova_puddle_depth_mm(p) - 3.0).abs() < 1e-14);
    let under = nguyenova_puddle(
        ArtistLook {
            albedo: 1.0,
            gloss: 0.5,
            f0: 0.04,
        },
        p,
    );
    assert!((under.albedo - 0.94).abs() < 1e-15 && (under.gloss - 0.65).abs() < 1e-15);
    assert_eq!(nguyenova_puddle_amount(0.3, 0.4), 0.0);
    // Share of independent uniform maps under a level L: 1 − c + c ln c, c = 1 − L.
    for (level, share) in [(0.25, 0.034), (0.5, 0.153), (0.75, 0.403), (0.9, 0.670)] {
        let n = 400;
        let under = (0..n * n)
            .filter(|i| {
                let (a, b) = (
                    (f64::from(i % n) + 0.5) / f64::from(n),
                    (f64::from(i / n) + 0.5) / f64::from(n),
                );
                screen_blend(a, b) < level
            })
            .count();
        let found = under as f64 / f64::from(n * n);
        assert!((found - share).abs() < 1e-3, "{level}: {found}");
    }
    // Lagarde.
    assert!((painted_puddle_water(0.5, 0.3, 0.4) - 0.5).abs() < 1e-15);
    assert!(painted_puddle_water(0.7, 0.3, 0.4) > 1.0 - 1e-15 && painted_puddle_water(0.3, 0.3, 0.4) == 0.0);
    assert!((crack_water(0.5, 0.8) - 0.2).abs() < 1e-15 && crack_water(1.0, 0.0) == 1.0);
    assert_eq!(crack_water(1.0, 1.0), 0.0, "white never floods");
    assert_eq!(accumulated_water(0.2, 0.5), 0.5);
    assert_eq!(
        (effective_wetness(0.0, 1.0, 0.3), effective_wetness(0.9, 1.0, 0.3)),
        (0.3, 1.0)
    );
    assert_eq!(effective_wetness(1.0, 0.0, 0.0), 0.0, "sheltered");
    let puddle = ArtistLook {
        albedo: 0.2,
        gloss: 0.5,
        f0: 0.04,
    }
    .flooded(1.0);
    assert_eq!((puddle.gloss, puddle.f0, puddle.albedo), (1.0, 0.02, 0.2));
    let margin = ArtistLook {
        albedo: 0.2,
        gloss: 0.5,
        f0: 0.04,
    }
    .flooded(0.5);
    assert!((margin.gloss - 0.75).abs() < 1e-15 && (margin.f0 - 0.03).abs() < 1e-15);
    // Porosity: gloss 0.1 is porous, 0.5 is not, metals never are.
    assert_eq!(
        (
            lagarde_porosity(0.1, 0.0),
            lagarde_porosity(0.5, 0.0),
            lagarde_porosity(0.1, 1.0)
        ),
        (1.0, 0.0, 0.0)
    );
    let rough = ArtistLook {
        albedo: 0.5,
        gloss: 0.2,
        f0: 0.04,
    };
    let soaked = lagarde_porous_wet(rough, 1.0, 1.0);
    assert!((soaked.albedo - 0.1).abs() < 1e-15 && (soaked.gloss - (1.0 - 0.8 * 0.6)).abs() < 1e-15);
    assert_eq!(lagarde_porous_wet(rough, 0.0, 1.0), rough, "what is not porous stays");
}

#[test]
fn a_whole_surface_is_the_listings_one_after_the_other() {
    let (mut worst, mut wrong) = (Worst::default(), Worst::default());
    for albedo in [0.05, 0.35, 0.8] {
        for gloss in shares() {
            for metal in [0.0, 0.3, 1.0] {
                let look = ArtistLook {
                    albedo,
                    gloss,
                    f0: 0.04,
                };
                let porosity = lagarde_porosity(gloss, metal);
                for w in shares() {
                    for a in [0.0, 0.25, 0.7, 1.0] {
                        let wetness = truth::wetness(w, 1.0, a);
                        for rules in [ArtistRules::Lagarde, ArtistRules::LagardePorous, ArtistRules::Nguyenova] {
                            let [wet, g, f] = match rules {
                                ArtistRules::Lagarde => truth::flooded(truth::wet(parts(look), wetness), a),
                                ArtistRules::LagardePorous => {
                                    truth::flooded(truth::porous_wet(parts(look), porosity, wetness), a)
                                }
                                ArtistRules::Nguyenova => truth::puddle(truth::wet(parts(look), w), a),
                            };
                            let exact = [metal * albedo + (1.0 - metal) * wet, g, f];
                            let found = |w: f64| parts(artist_surface(rules, look, porosity, metal, w, a));
                            for (found, exact) in found(w).into_iter().zip(exact) {
                                worst.absolute(found, exact, || format!("{rules:?} {look:?} {metal} {w} {a}"));
                            }
                            wrong.absolute(found(w - 0.05)[0], exact[0], String::new);
                        }
                    }
                }
            }
        }
    }
    worst.assert_below(9e-16, 50_000);
    assert!(wrong.error > 0.02, "a wetness 5 % off goes unseen");
}

#[test]
fn the_four_types_of_ground_are_the_ends_of_wetness_and_water() {
    let ground = ArtistLook {
        albedo: 0.3,
        gloss: 0.1,
        f0: 0.04,
    };
    let by = |w: f64, a: f64| artist_surface(ArtistRules::Lagarde, ground, 0.0, 0.0, w, a);
    let [dry, wet, drenched, puddle] = [by(0.0, 0.0), by(1.0, 0.0), by(1.0, 0.5), by(1.0, 1.0)];
    assert_eq!(dry, ground);
    assert!((wet.albedo - 0.09).abs() < 1e-15 && (wet.gloss - 0.25).abs() < 1e-15 && wet.f0 == 0.04);
    assert!((puddle.albedo - 0.09).abs() < 1e-15 && puddle.gloss == 1.0 && puddle.f0 == 0.02);
    assert!((drenched.gloss - 0.625).abs() < 1e-15 && (drenched.f0 - 0.03).abs() < 1e-15);
    // A pool on ground that no rain wets is as wet as any (E9); metal keeps its colour.
    assert_eq!(by(0.0, 1.0), puddle);
    assert_eq!(
        artist_surface(ArtistRules::Nguyenova, ground, 0.0, 1.0, 1.0, 1.0).albedo,
        0.3
    );
    for bad in ANY {
        let found = parts(artist_surface(ArtistRules::LagardePorous, ground, bad, bad, bad, bad));
        assert!(found.iter().all(|v| (0.0..=1.0).contains(v)), "{bad}: {found:?}");
    }
}
