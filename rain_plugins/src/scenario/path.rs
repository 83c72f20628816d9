//! Where the camera and the vehicles are at a time: pure functions of time, in f64.
//!
//! Yaw turns about +Y from +Z towards +X, so a model that faces +Z looks along (sin yaw, 0, cos yaw).
//!
//! # Accuracy
//! Distance along a cubic piece is a 5-point Gauss–Legendre sum on four sub-pieces; on smooth paths its relative error is
//! below 1e-6, at a cusp (a reversal inside a piece) below 1e-2. On straight pieces it is exact.

use super::file::{Attached, Camera, CameraKey, Interpolation, Scenario, Vector, Vehicle};

/// A vehicle at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VehiclePose {
    /// Where the model's origin is. Units: m.
    pub position: Vector,
    /// Heading. Units: rad, (−π, π]. Standing, it keeps the heading it arrived with, or will leave with.
    pub yaw_rad: f64,
    /// Way gone since the first key. Units: m.
    pub distance_m: f64,
    /// Units: m/s. Zero before the first key and after the last.
    pub velocity_m_s: Vector,
}

/// The camera at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraPose {
    /// Where it is. Units: m.
    pub eye: Vector,
    /// What it looks at. Units: m.
    pub target: Vector,
    /// Vertical field of view. Units: degrees.
    pub fov_y_deg: f64,
    /// Number of cuts before this time: when it changes, nothing of the picture before remains valid.
    pub shot: usize,
}

/// Rotation of a wheel that rolled this far, forward positive. Units: rad.
#[must_use]
pub fn wheel_angle_rad(distance_m: f64, radius_m: f64) -> f64 {
    distance_m / radius_m
}

/// A point given in a vehicle's frame (+Z ahead, +Y up, +X to its left), in the world. Units: m.
#[must_use]
pub fn from_vehicle(pose: &VehiclePose, offset: &Vector) -> Vector {
    let (sin, cos) = (libm::sin(pose.yaw_rad), libm::cos(pose.yaw_rad));
    let [x, y, z] = pose.position;
    [
        x + cos * offset[0] + sin * offset[2],
        y + offset[1],
        z - sin * offset[0] + cos * offset[2],
    ]
}

/// A vehicle's way with its distances worked out once: one pose is then a binary search.
#[derive(Debug, Clone)]
pub struct VehiclePath {
    keys: Vec<Key<3>>,
    interpolation: Interpolation,
    /// Way from the first key to each key, m.
    distance_m: Vec<f64>,
    /// Heading on arrival at each key, rad.
    arrival_rad: Vec<f64>,
}

impl VehiclePath {
    /// From a validated vehicle (at least one key, times rising).
    #[must_use]
    pub fn new(vehicle: &Vehicle) -> Self {
        let keys: Vec<_> = vehicle
            .path
            .iter()
            .map(|k| Key {
                time_s: k.time_s,
                value: k.position,
            })
            .collect();
        let mut path = Self {
            interpolation: vehicle.interpolation,
            distance_m: vec![0.0],
            arrival_rad: Vec::new(),
            keys,
        };
        let mut headings: Vec<Option<f64>> = vec![None];
        for i in 1..path.keys.len() {
            path.distance_m.push(path.distance_m[i - 1] + path.length(i - 1, 1.0));
            // The last moving instant of a piece gives the heading on arrival, the first one that on departure.
            let mut moving = (0..=8).filter_map(|s| heading(&path.piece(i - 1, f64::from(s) / 8.0).1));
            let first = moving.next();
            let last = moving.next_back().or(first);
            if headings[i - 1].is_none() && first.is_some() {
                // Nothing moved before: it stood facing the way it leaves.
                headings.fill(first);
            }
            headings.push(last.or(headings[i - 1]));
        }
        path.arrival_rad = headings.into_iter().map(|h| h.unwrap_or(0.0)).collect();
        path
    }

    /// The pose at `time_s`.
    #[must_use]
    pub fn at(&self, time_s: f64) -> VehiclePose {
        let last = self.keys.len() - 1;
        let next = self.keys.partition_point(|k| k.time_s <= time_s);
        if next == 0 || next > last {
            let i = next.saturating_sub(1);
            return VehiclePose {
                position: self.keys[i].value,
                yaw_rad: self.arrival_rad[i],
                distance_m: self.distance_m[i],
                velocity_m_s: [0.0; 3],
            };
        }
        let i = next - 1;
        let (a, b) = (&self.keys[i], &self.keys[next]);
        let s = (time_s - a.time_s) / (b.time_s - a.time_s);
        let (position, velocity_m_s) = self.piece(i, s);
        VehiclePose {
            position,
            yaw_rad: heading(&velocity_m_s).unwrap_or(self.arrival_rad[i]),
            distance_m: self.distance_m[i] + self.length(i, s),
            velocity_m_s,
        }
    }

    fn piece(&self, i: usize, s: f64) -> (Vector, Vector) {
        piece(&self.keys, i, s, self.interpolation)
    }

    /// Way from key `i` to the share `s` of its piece, m.
    fn length(&self, i: usize, s: f64) -> f64 {
        // Abscissae and weights on (−1, 1), exact for degree 9 (Abramowitz & Stegun 1964, table 25.4).
        const GAUSS: [(f64, f64); 5] = [
            (0.0, 0.568_888_888_888_888_9),
            (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
            (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
            (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
            (0.906_179_845_938_664, 0.236_926_885_056_189_1),
        ];
        let duration = self.keys[i + 1].time_s - self.keys[i].time_s;
        if self.interpolation == Interpolation::Linear {
            return length(&self.piece(i, s).1) * duration * s;
        }
        let width = s / 4.0;
        (0..4)
            .flat_map(|k| GAUSS.map(|(x, w)| ((f64::from(k) + 0.5 + 0.5 * x) * width, w * 0.5 * width)))
            .map(|(at, weight)| length(&self.piece(i, at).1) * duration * weight)
            .sum()
    }
}

/// A camera's way, or the vehicle it rides on.
#[derive(Debug, Clone)]
pub enum CameraPath {
    /// On its own keys.
    Keys {
        /// Shots between cuts: eye, target and field of view in one vector.
        shots: Vec<Vec<Key<7>>>,
        /// How it gets from key to key.
        interpolation: Interpolation,
    },
    /// On a vehicle.
    Attached {
        /// The offsets.
        attached: Attached,
        /// The vehicle's way.
        path: Box<VehiclePath>,
    },
}

impl CameraPath {
    /// From a validated scenario.
    #[must_use]
    pub fn new(scenario: &Scenario) -> Self {
        let Camera {
            keys,
            interpolation,
            attached,
            ..
        } = &scenario.camera;
        if let Some(attached) = attached
            && let Some(vehicle) = scenario.vehicles.iter().find(|v| v.name == attached.vehicle)
        {
            return Self::Attached {
                attached: attached.clone(),
                path: Box::new(VehiclePath::new(vehicle)),
            };
        }
        let mut shots: Vec<Vec<Key<7>>> = Vec::new();
        let standing = [CameraKey::default()];
        for key in if keys.is_empty() { &standing } else { keys.as_slice() } {
            let ([ex, ey, ez], [tx, ty, tz]) = (key.eye, key.target);
            let flat = Key {
                time_s: key.time_s,
                value: [ex, ey, ez, tx, ty, tz, key.fov_y_deg],
            };
            match shots.last_mut() {
                Some(shot) if !key.cut => shot.push(flat),
                _ => shots.push(vec![flat]),
            }
        }
        Self::Keys {
            shots,
            interpolation: *interpolation,
        }
    }

    /// The pose at `time_s`.
    #[must_use]
    pub fn at(&self, time_s: f64) -> CameraPose {
        match self {
            Self::Attached { attached, path } => {
                let pose = path.at(time_s);
                CameraPose {
                    eye: from_vehicle(&pose, &attached.eye_offset),
                    target: from_vehicle(&pose, &attached.target_offset),
                    fov_y_deg: attached.fov_y_deg,
                    shot: 0,
                }
            }
            Self::Keys { shots, interpolation } => {
                let shot = shots.partition_point(|s| s[0].time_s <= time_s).saturating_sub(1);
                let keys = &shots[shot];
                let next = keys.partition_point(|k| k.time_s <= time_s);
                let [ex, ey, ez, tx, ty, tz, fov_y_deg] = if next == 0 || next == keys.len() {
                    keys[next.saturating_sub(1)].value
                } else {
                    let (a, b) = (&keys[next - 1], &keys[next]);
                    piece(
                        keys,
                        next - 1,
                        (time_s - a.time_s) / (b.time_s - a.time_s),
                        *interpolation,
                    )
                    .0
                };
                // A cubic may overshoot its keys; the lens may not.
                let fov_y_deg = fov_y_deg.clamp(1.0, 170.0);
                CameraPose {
                    eye: [ex, ey, ez],
                    target: [tx, ty, tz],
                    fov_y_deg,
                    shot,
                }
            }
        }
    }
}

/// Values at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Key<const N: usize> {
    /// When. Units: s.
    pub time_s: f64,
    /// What.
    pub value: [f64; N],
}

/// Value and its time derivative at the share `s` of the piece between keys `i` and `i + 1`.
fn piece<const N: usize>(keys: &[Key<N>], i: usize, s: f64, interpolation: Interpolation) -> ([f64; N], [f64; N]) {
    let (a, b) = (&keys[i], &keys[i + 1]);
    let duration = b.time_s - a.time_s;
    let slope = |from: &Key<N>, to: &Key<N>, n: usize| (to.value[n] - from.value[n]) / (to.time_s - from.time_s);
    let mut value = [0.0; N];
    let mut rate = [0.0; N];
    for n in 0..N {
        if interpolation == Interpolation::Linear {
            value[n] = a.value[n] + (b.value[n] - a.value[n]) * s;
            rate[n] = slope(a, b, n);
            continue;
        }
        // Hermite cubic; the tangent at a key is the slope between its neighbours.
        let start = slope(if i > 0 { &keys[i - 1] } else { a }, b, n) * duration;
        let end = slope(a, keys.get(i + 2).unwrap_or(b), n) * duration;
        let (p, q) = (a.value[n], b.value[n]);
        let (s2, s3) = (s * s, s * s * s);
        value[n] =
            (2.0 * s3 - 3.0 * s2 + 1.0) * p + (s3 - 2.0 * s2 + s) * start + (3.0 * s2 - 2.0 * s3) * q + (s3 - s2) * end;
        let change = 6.0 * (s - s2) * (q - p) + (3.0 * s2 - 4.0 * s + 1.0) * start + (3.0 * s2 - 2.0 * s) * end;
        rate[n] = change / duration;
    }
    (value, rate)
}

fn length(v: &Vector) -> f64 {
    (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt()
}

/// Heading of a horizontal velocity; none below 1 mm/s, where its direction is noise.
fn heading(velocity: &Vector) -> Option<f64> {
    (velocity[0].hypot(velocity[2]) > 1e-3).then(|| libm::atan2(velocity[0], velocity[2]))
}

#[cfg(test)]
mod tests {
    use super::super::file::PathKey;
    use super::*;

    fn vehicle(interpolation: Interpolation, keys: &[(f64, Vector)]) -> VehiclePath {
        let path = keys
            .iter()
            .map(|&(time_s, position)| PathKey { time_s, position })
            .collect();
        VehiclePath::new(&Vehicle {
            interpolation,
            path,
            ..Vehicle::default()
        })
    }

    #[test]
    fn straight_pieces() {
        let keys = [
            (0.0, [1.0, 0.0, 0.0]),
            (2.0, [1.0, 0.0, 0.0]),
            (4.0, [11.0, 0.0, 0.0]),
            (6.0, [11.0, 0.0, 0.0]),
            (8.0, [11.0, 0.0, -8.0]),
        ];
        let path = vehicle(Interpolation::Linear, &keys);
        let quarter = std::f64::consts::FRAC_PI_2;
        // Stands facing +X, where it will go.
        let start = path.at(1.0);
        assert_eq!(
            (start.position, start.velocity_m_s, start.distance_m),
            (keys[0].1, [0.0; 3], 0.0)
        );
        assert!((start.yaw_rad - quarter).abs() < 1e-12);
        assert!((path.at(-5.0).yaw_rad - quarter).abs() < 1e-12);
        let half = path.at(3.0);
        assert_eq!(
            (half.position, half.velocity_m_s, half.distance_m),
            ([6.0, 0.0, 0.0], [5.0, 0.0, 0.0], 5.0)
        );
        // Stands facing +X, where it came from, then goes along −Z.
        let rest = path.at(5.0);
        assert!((rest.yaw_rad - quarter).abs() < 1e-12 && rest.distance_m == 10.0);
        let back = path.at(7.0);
        assert!((back.yaw_rad.abs() - std::f64::consts::PI).abs() < 1e-12 && back.distance_m == 14.0);
        let end = path.at(1e9);
        assert_eq!(
            (end.position, end.velocity_m_s, end.distance_m),
            (keys[4].1, [0.0; 3], 18.0)
        );
        assert_eq!(wheel_angle_rad(end.distance_m, 0.5), 36.0);
        // Left of a vehicle facing +X is −Z.
        let left = from_vehicle(&half, &[1.0, 0.5, 2.0]);
        for (got, want) in left.iter().zip([8.0, 0.5, -1.0]) {
            assert!((got - want).abs() < 1e-12, "{left:?}");
        }
    }

    #[test]
    fn heading_north_is_kept_while_standing() {
        // Yaw 0 is a heading like any other: a stop after driving along +Z keeps it, though the next leg is along +X.
        let keys = [
            (0.0, [0.0; 3]),
            (1.0, [0.0, 0.0, 5.0]),
            (2.0, [0.0, 0.0, 5.0]),
            (3.0, [5.0, 0.0, 5.0]),
        ];
        let path = vehicle(Interpolation::Linear, &keys);
        assert_eq!(path.at(1.5).yaw_rad, 0.0);
        assert_eq!(path.at(0.5).yaw_rad, 0.0);
    }

    #[test]
    fn cubic_is_smooth_and_as_long_as_its_chords() {
        // A quarter circle of radius 10 m by 9 keys.
        let keys: Vec<_> = (0..9)
            .map(|i| {
                let angle = f64::from(i) * std::f64::consts::FRAC_PI_2 / 8.0;
                (f64::from(i) * 0.5, [10.0 * angle.sin(), 0.0, 10.0 * angle.cos()])
            })
            .collect();
        let path = vehicle(Interpolation::CatmullRom, &keys);
        for (time, position) in &keys {
            for (got, want) in path.at(*time).position.iter().zip(position) {
                assert!((got - want).abs() < 1e-12);
            }
        }
        let mut chords = 0.0;
        let mut before = path.at(0.0);
        for i in 1..=4000 {
            let now = path.at(f64::from(i) * 1e-3);
            let step: Vector = std::array::from_fn(|n| now.position[n] - before.position[n]);
            chords += length(&step);
            if i < 4000 {
                // Velocity is the derivative of position and has no jumps.
                let error: Vector =
                    std::array::from_fn(|n| step[n] / 1e-3 - 0.5 * (now.velocity_m_s[n] + before.velocity_m_s[n]));
                assert!(i == 1 || length(&error) < 1e-4, "{i}: {error:?}");
            }
            before = now;
        }
        let total = path.at(4.0).distance_m;
        assert!((total / chords - 1.0).abs() < 1e-6, "{total} {chords}");
        assert!((total / (5.0 * std::f64::consts::PI) - 1.0).abs() < 5e-3);
        // Half way round it goes along (+X, −Z).
        assert!((path.at(2.0).yaw_rad - 0.75 * std::f64::consts::PI).abs() < 1e-6);
    }

    #[test]
    fn cuts_jump_and_hold() {
        let key = |time_s: f64, x: f64, cut: bool| CameraKey {
            time_s,
            eye: [x, 1.0, 0.0],
            cut,
            ..CameraKey::default()
        };
        let mut scenario = Scenario::default();
        scenario.camera.keys = vec![
            key(0.0, 0.0, false),
            key(10.0, 10.0, false),
            key(20.0, 100.0, true),
            key(30.0, 110.0, false),
        ];
        for interpolation in [Interpolation::Linear, Interpolation::CatmullRom] {
            scenario.camera.interpolation = interpolation;
            let path = CameraPath::new(&scenario);
            for (time, x, shot) in [
                (-1.0, 0.0, 0),
                (5.0, 5.0, 0),
                (15.0, 10.0, 0),
                (20.0, 100.0, 1),
                (25.0, 105.0, 1),
                (99.0, 110.0, 1),
            ] {
                let pose = path.at(time);
                assert!((pose.eye[0] - x).abs() < 1e-9 && pose.shot == shot, "{time}: {pose:?}");
            }
        }
    }

    #[test]
    fn attached_camera_follows_the_vehicle() {
        let key = |time_s: f64, x: f64| PathKey {
            time_s,
            position: [x, 0.0, 0.0],
        };
        let truck = Vehicle {
            name: "truck".into(),
            path: vec![key(0.0, 0.0), key(10.0, -100.0)],
            ..Vehicle::default()
        };
        let attached = Attached {
            vehicle: "truck".into(),
            ..Attached::default()
        };
        let camera = Camera {
            attached: Some(attached),
            ..Camera::default()
        };
        let scenario = Scenario {
            vehicles: vec![truck],
            camera,
            ..Scenario::default()
        };
        let pose = CameraPath::new(&scenario).at(5.0);
        // Behind a truck that goes along −X is +X of it.
        assert!(
            (pose.eye[0] + 43.0).abs() < 1e-9 && (pose.eye[1] - 2.5).abs() < 1e-9,
            "{pose:?}"
        );
        assert!((pose.target[0] + 54.0).abs() < 1e-9, "{pose:?}");
    }
}
