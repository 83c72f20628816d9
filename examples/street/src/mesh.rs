//! A triangle mesh under construction: positions, unit normals, texture coordinates, tangents, indices.

use glam::{Vec2, Vec3, Vec4, vec2};
use rain_core::ops;

/// One face of a block in its frame.
pub const FRONT: u8 = 1;
/// The face away from the viewer.
pub const BACK: u8 = 2;
/// The face at the low end of `s`.
pub const LEFT: u8 = 4;
/// The face at the high end of `s`.
pub const RIGHT: u8 = 8;
/// The upper face.
pub const TOP: u8 = 16;
/// The lower face.
pub const BOTTOM: u8 = 32;
/// All six faces.
pub const ALL: u8 = 63;

/// Cosine and sine of an angle in radians, equal on every platform.
#[must_use]
pub fn cos_sin(angle: f32) -> (f32, f32) {
    (ops::cos(f64::from(angle)) as f32, ops::sin(f64::from(angle)) as f32)
}

/// A right-handed place to build at: `right` along a façade, up, and `out` of it.
#[derive(Debug, Clone, Copy)]
pub struct Frame {
    /// Where (0, 0, 0) is, in metres.
    pub origin: Vec3,
    /// Unit vector of `s`, horizontal.
    pub right: Vec3,
    /// Unit vector of `d`, horizontal.
    pub out: Vec3,
}

impl Frame {
    /// A frame whose façade faces `out`; a viewer in front of it sees `s` grow to the right.
    #[must_use]
    pub fn facing(origin: Vec3, out: Vec3) -> Self {
        Self {
            origin,
            right: Vec3::Y.cross(out),
            out,
        }
    }

    /// The world's axes: s = x, d = z.
    #[must_use]
    pub fn world(origin: Vec3) -> Self {
        Self::facing(origin, Vec3::Z)
    }

    /// The point at `s` along, `y` up, `d` out, in metres.
    #[must_use]
    pub fn at(&self, s: f32, y: f32, d: f32) -> Vec3 {
        self.origin + self.right * s + Vec3::Y * y + self.out * d
    }
}

/// A mesh; every vertex has a normal, a texture coordinate and a tangent.
#[derive(Debug, Clone, Default)]
pub struct Mesh {
    /// Metres.
    pub positions: Vec<Vec3>,
    /// Unit vectors.
    pub normals: Vec<Vec3>,
    /// Texture tiles; v grows down the image.
    pub uvs: Vec<Vec2>,
    /// Unit vector along growing u, and the sign of the bitangent (towards the top of the image).
    pub tangents: Vec<Vec4>,
    /// Linear RGBA in [0, 1] of each vertex, or empty: none.
    pub colors: Vec<Vec4>,
    /// Three per triangle, counter-clockwise seen from outside.
    pub indices: Vec<u32>,
}

impl Mesh {
    /// Number of triangles.
    #[must_use]
    pub fn triangles(&self) -> usize {
        self.indices.len() / 3
    }

    /// Adds a vertex and returns its index; the tangent is made perpendicular to the normal.
    pub fn vertex(&mut self, p: Vec3, n: Vec3, uv: Vec2, along_u: Vec3, sign: f32) -> u32 {
        let i = self.positions.len() as u32;
        let t = along_u - n * along_u.dot(n);
        let t = if t.length_squared() > 1e-12 {
            t.normalize()
        } else {
            n.any_orthonormal_vector()
        };
        self.positions.push(p);
        self.normals.push(n);
        self.uvs.push(uv);
        self.tangents.push(t.extend(sign));
        i
    }

    /// Adds a flat quad; corners counter-clockwise seen from outside. A quad without area adds nothing.
    pub fn quad_uv(&mut self, p: [Vec3; 4], uv: [Vec2; 4]) {
        let normal = (p[2] - p[0]).cross(p[3] - p[1]);
        if normal.length_squared() < 1e-14 {
            return;
        }
        let n = normal.normalize();
        let (t, sign) = tangent(n, [p[0], p[1], p[2]], [uv[0], uv[1], uv[2]]);
        let i = [0, 1, 2, 3].map(|k| self.vertex(p[k], n, uv[k], t, sign));
        self.triangle(i[0], i[1], i[2]);
        self.triangle(i[0], i[2], i[3]);
    }

    /// Adds a flat quad with texture coordinates in metres divided by `tile`.
    pub fn quad(&mut self, p: [Vec3; 4], tile: f32) {
        let n = (p[2] - p[0]).cross(p[3] - p[1]).normalize_or_zero();
        self.quad_uv(p, p.map(|q| planar(n, q) / tile));
    }

    /// Adds a flat triangle with texture coordinates in metres divided by `tile`.
    pub fn tri(&mut self, p: [Vec3; 3], tile: f32) {
        let normal = (p[1] - p[0]).cross(p[2] - p[0]);
        if normal.length_squared() < 1e-14 {
            return;
        }
        let n = normal.normalize();
        let uv = p.map(|q| planar(n, q) / tile);
        let (t, sign) = tangent(n, p, uv);
        let i = [0, 1, 2].map(|k| self.vertex(p[k], n, uv[k], t, sign));
        self.triangle(i[0], i[1], i[2]);
    }

    /// Adds a triangle over vertices that exist; one without area is left out.
    pub fn triangle(&mut self, a: u32, b: u32, c: u32) {
        let [pa, pb, pc] = [a, b, c].map(|i| self.positions[i as usize]);
        if (pb - pa).cross(pc - pa).length() > 2e-8 {
            self.indices.extend([a, b, c]);
        }
    }

    /// Adds the chosen `faces` of a block given by its two corners in a frame.
    pub fn block(&mut self, f: &Frame, low: [f32; 3], high: [f32; 3], tile: f32, faces: u8) {
        let [s0, y0, d0] = low;
        let [s1, y1, d1] = high;
        let mut face = |bit: u8, c: [[f32; 3]; 4]| {
            if faces & bit != 0 {
                self.quad(c.map(|[s, y, d]| f.at(s, y, d)), tile);
            }
        };
        face(FRONT, [[s0, y0, d1], [s1, y0, d1], [s1, y1, d1], [s0, y1, d1]]);
        face(BACK, [[s1, y0, d0], [s0, y0, d0], [s0, y1, d0], [s1, y1, d0]]);
        face(LEFT, [[s0, y0, d0], [s0, y0, d1], [s0, y1, d1], [s0, y1, d0]]);
        face(RIGHT, [[s1, y0, d1], [s1, y0, d0], [s1, y1, d0], [s1, y1, d1]]);
        face(TOP, [[s0, y1, d1], [s1, y1, d1], [s1, y1, d0], [s0, y1, d0]]);
        face(BOTTOM, [[s0, y0, d0], [s1, y0, d0], [s1, y0, d1], [s0, y0, d1]]);
    }

    /// Adds a smooth surface of `nu` by `nv` quads; `f` gives position and texture coordinate of a lattice point.
    /// Seen from outside, u runs to the right and v up. `closed` joins the normals of the first and last u.
    pub fn surface(&mut self, nu: usize, nv: usize, closed: bool, f: impl Fn(usize, usize) -> (Vec3, Vec2)) {
        let w = nu + 1;
        let points: Vec<(Vec3, Vec2)> = (0..(nv + 1) * w).map(|k| f(k % w, k / w)).collect();
        let mut normals = vec![Vec3::ZERO; points.len()];
        let quads = || (0..nv).flat_map(|j| (0..nu).map(move |i| j * w + i));
        for k in quads() {
            let corners = [k, k + 1, k + w + 1, k + w];
            let n = (points[corners[2]].0 - points[corners[0]].0).cross(points[corners[3]].0 - points[corners[1]].0);
            for c in corners {
                normals[c] += n;
            }
        }
        for j in 0..=nv {
            if closed {
                let sum = normals[j * w] + normals[j * w + nu];
                normals[j * w] = sum;
                normals[j * w + nu] = sum;
            }
            // A row drawn together into one point is a pole: all its vertices share one normal.
            let row = j * w..(j + 1) * w;
            if points[row.clone()]
                .iter()
                .all(|p| p.0.distance_squared(points[j * w].0) < 1e-12)
            {
                let sum: Vec3 = normals[row.clone()].iter().sum();
                normals[row].fill(sum);
            }
        }
        let first = self.positions.len() as u32;
        for (k, &(p, uv)) in points.iter().enumerate() {
            let n = normals[k].normalize_or(Vec3::Y);
            let k0 = if k % w == nu { k - 1 } else { k };
            let along = points[k0 + 1].0 - points[k0].0;
            let along = if points[k0 + 1].1.x >= points[k0].1.x {
                along
            } else {
                -along
            };
            // A row up the surface goes up the image when v falls with it.
            let j0 = if k / w == nv { k - w } else { k };
            let up = (points[j0 + w].0 - points[j0].0)
                * if points[j0 + w].1.y <= points[j0].1.y {
                    1.0
                } else {
                    -1.0
                };
            let sign = if n.cross(along).dot(up) >= 0.0 { 1.0 } else { -1.0 };
            self.vertex(p, n, uv, along, sign);
        }
        for k in quads() {
            let [a, b, c, d] = [k, k + 1, k + w + 1, k + w].map(|i| first + i as u32);
            self.triangle(a, b, c);
            self.triangle(a, c, d);
        }
    }

    /// Adds a tube from `a` to `b` (radii in metres), without end caps unless `capped`.
    pub fn tube(&mut self, a: Vec3, b: Vec3, radii: [f32; 2], sides: usize, tile: f32, capped: bool) {
        let axis = (b - a).normalize_or(Vec3::Y);
        let x = axis.any_orthonormal_vector();
        let z = x.cross(axis);
        let length = a.distance(b);
        let ring = |i: usize, centre: Vec3, r: f32| {
            let (c, s) = cos_sin(-(i as f32) / sides as f32 * std::f32::consts::TAU);
            centre + (x * c + z * s) * r
        };
        let around = std::f32::consts::TAU * radii[0] / tile;
        self.surface(sides, 1, true, |i, j| {
            let t = j as f32;
            let r = radii[0] + (radii[1] - radii[0]) * t;
            let p = ring(i, a + (b - a) * t, r);
            (p, vec2(i as f32 / sides as f32 * around, -t * length / tile))
        });
        if capped {
            for i in 1..sides - 1 {
                self.tri(
                    [ring(0, b, radii[1]), ring(i, b, radii[1]), ring(i + 1, b, radii[1])],
                    tile,
                );
                self.tri(
                    [ring(0, a, radii[0]), ring(i + 1, a, radii[0]), ring(i, a, radii[0])],
                    tile,
                );
            }
        }
    }

    /// Adds a body of revolution about the vertical through `centre`; `profile` is (radius, height) from below to above.
    pub fn lathe(&mut self, centre: Vec3, profile: &[(f32, f32)], sides: usize, tile: f32) {
        for pair in profile.windows(2) {
            let [(r0, y0), (r1, y1)] = [pair[0], pair[1]];
            let slant = ((r1 - r0) * (r1 - r0) + (y1 - y0) * (y1 - y0)).sqrt();
            self.surface(sides, 1, true, |i, j| {
                let (r, y) = if j == 0 { (r0, y0) } else { (r1, y1) };
                let (c, s) = cos_sin(-(i as f32) / sides as f32 * std::f32::consts::TAU);
                let u = i as f32 / sides as f32 * std::f32::consts::TAU * r0.max(r1) / tile;
                (
                    centre + Vec3::new(r * c, y, r * s),
                    vec2(u, -(y0 + j as f32 * slant) / tile),
                )
            });
        }
    }

    /// Adds all of `other`.
    pub fn append(&mut self, other: &Self) {
        let first = self.positions.len() as u32;
        self.positions.extend(&other.positions);
        self.normals.extend(&other.normals);
        self.uvs.extend(&other.uvs);
        self.tangents.extend(&other.tangents);
        self.indices.extend(other.indices.iter().map(|i| i + first));
    }
}

/// Texture coordinate, in metres, of a point on a plane with normal `n`: walls upright, floors along x and z.
fn planar(n: Vec3, p: Vec3) -> Vec2 {
    if n.y.abs() > 0.95 {
        return vec2(p.x, p.z);
    }
    let right = Vec3::Y.cross(n).normalize_or(Vec3::X);
    vec2(p.dot(right), -p.dot(n.cross(right)))
}

/// Direction of growing u on a triangle and the sign that makes the bitangent point up the image.
fn tangent(n: Vec3, p: [Vec3; 3], uv: [Vec2; 3]) -> (Vec3, f32) {
    let (e1, e2) = (p[1] - p[0], p[2] - p[0]);
    let (d1, d2) = (uv[1] - uv[0], uv[2] - uv[0]);
    let det = d1.x * d2.y - d2.x * d1.y;
    if det.abs() < 1e-12 {
        return (n.any_orthonormal_vector(), 1.0);
    }
    let t = (e1 * d2.y - e2 * d1.y) / det;
    let down = (e2 * d1.x - e1 * d2.x) / det;
    (t, if n.cross(t).dot(-down) >= 0.0 { 1.0 } else { -1.0 })
}
