//! Rain areas against a search along their outlines; the rule by which they combine; containers and their laws.

mod containers;
mod density;
mod far;
mod far_rain;
mod rates;

use glam::DVec2;
use rain_core::rainfall::areas::{AreaField, AreaRain, AreaSettings, AreaShape};
use rain_reference::areas::{Area, Outline, Rain};

/// An area and its slow twin.
fn pair(centre: [f64; 2], shape: AreaShape, rain: AreaRain, transition: f64, strength: f64) -> (AreaSettings, Area) {
    let (turn, outline) = match &shape {
        AreaShape::Unbounded => (0.0, Outline::Plane),
        AreaShape::Circle { radius_m } => (0.0, Outline::Ellipse([*radius_m; 2])),
        AreaShape::Ellipse { radii_m, heading_rad } => (*heading_rad, Outline::Ellipse(radii_m.to_array())),
        AreaShape::Polygon { corners_m } => (0.0, Outline::Polygon(corners_m.iter().map(DVec2::to_array).collect())),
    };
    let slow = Area {
        centre,
        turn,
        outline,
        edge: transition,
        strength,
        rain: match rain {
            AreaRain::Rate(rate) => Rain::Shower(rate),
            AreaRain::OfWeather(share) => Rain::Multiple(share),
            AreaRain::Scale(factor) => Rain::Factor(factor),
        },
    };
    let settings = AreaSettings {
        centre_m: centre.into(),
        shape,
        rain,
        transition_m: transition,
        ..AreaSettings::default()
    };
    settings.check().expect("valid");
    (settings, slow)
}

fn ellipse(a: f64, b: f64, heading_rad: f64) -> AreaShape {
    AreaShape::Ellipse {
        radii_m: DVec2::new(a, b),
        heading_rad,
    }
}

/// A star with five points, which is no convex outline.
fn star(radius: f64) -> AreaShape {
    let corners = (0..10).map(|i| {
        let angle = f64::from(i) * core::f64::consts::PI / 5.0;
        DVec2::from_angle(angle) * if i % 2 == 0 { radius } else { 0.4 * radius }
    });
    AreaShape::Polygon {
        corners_m: corners.collect(),
    }
}

/// The areas as they are at time 0.
fn field(areas: &[&AreaSettings], outside: f64) -> AreaField {
    let mut field = AreaField::new(outside);
    for area in areas {
        field.push(area, DVec2::ZERO, 0.0);
    }
    field
}

/// A world with one of everything.
fn mixed() -> (AreaField, Vec<Area>) {
    let all = [
        pair(
            [10.0, -20.0],
            ellipse(120.0, 40.0, 0.7),
            AreaRain::Rate(40.0),
            30.0,
            1.0,
        ),
        pair([90.0, 15.0], star(80.0), AreaRain::OfWeather(3.0), 10.0, 1.0),
        pair(
            [40.0, 0.0],
            AreaShape::Circle { radius_m: 25.0 },
            AreaRain::Scale(0.0),
            15.0,
            1.0,
        ),
        pair(
            [-60.0, 60.0],
            ellipse(30.0, 90.0, -0.2),
            AreaRain::Scale(1.5),
            40.0,
            1.0,
        ),
        pair([0.0, 0.0], AreaShape::Unbounded, AreaRain::Rate(0.5), 0.0, 1.0),
    ];
    let fast: Vec<&AreaSettings> = all.iter().map(|(area, _)| area).collect();
    (field(&fast, 0.5), all.iter().map(|(_, slow)| slow.clone()).collect())
}

/// Places in a square of ±200 m, the same every time.
fn places(count: u32) -> impl Iterator<Item = DVec2> {
    // Additive recurrence of the plastic number (Roberts 2018): even and never twice the same.
    (0..count).map(|i| {
        let at = f64::from(i) + 0.5;
        DVec2::new(
            (at * 0.754_877_666_246_693).fract(),
            (at * 0.569_840_290_998_053).fract(),
        ) * 400.0
            - 200.0
    })
}
