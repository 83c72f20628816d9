//! Puddles in the wheel ruts of a road: long and narrow, whichever way the road lies.

use glam::DVec3;

use super::*;
use crate::ops;
use crate::surface::basins::{BakeOptions, Basins, Grid};
use crate::weather::{ColumnForcing, SurfaceClass};

/// Half the length and half the width of the road. Units: m.
const HALF: [f64; 2] = [7.0, 3.5];

/// A road about the origin, turned by an angle: 0.3 % fall along it with a sag of 12 mm every 9 m, a crown.
#[derive(Clone, Copy)]
struct Road {
    cos: f64,
    sin: f64,
    camber: f64,
    rut_m: f64,
}

impl Road {
    fn new(angle_deg: f64, camber: f64, rut_m: f64) -> Self {
        let angle = angle_deg.to_radians();
        Self {
            cos: ops::cos(angle),
            sin: ops::sin(angle),
            camber,
            rut_m,
        }
    }

    /// A place across and along the road.
    fn on_road(self, x: f64, z: f64) -> [f64; 2] {
        [self.cos * x - self.sin * z, self.sin * x + self.cos * z]
    }

    fn at(self, across: f64, along: f64) -> DVec3 {
        let sag = 0.006 * ops::sin(along * core::f64::consts::TAU / 9.0);
        let ruts = [-2.5, -1.0, 1.0, 2.5].map(|middle| {
            let t = (across - middle) / 0.25;
            self.rut_m * ops::exp(-0.5 * t * t)
        });
        let y = sag - self.camber * across.abs() - 0.003 * along - ruts.iter().sum::<f64>();
        let (x, z) = (
            self.cos * across + self.sin * along,
            self.cos * along - self.sin * across,
        );
        DVec3::new(x, y, z)
    }

    /// Its basins, full, on square cells.
    fn pools(self, cell_m: f64) -> Vec<Pool> {
        let count = (18.0 / cell_m) as usize;
        let place = |i: usize| (i as f64 + 0.5) * cell_m - 9.0;
        let height = |cell: usize| {
            let [across, along] = self.on_road(place(cell % count), place(cell / count));
            let inside = along.abs() < HALF[0] && across.abs() < HALF[1];
            if inside { self.at(across, along).y } else { f64::NAN }
        };
        let heights: Vec<f64> = (0..count * count).map(height).collect();
        let options = BakeOptions {
            threshold_m: GroundSettings::default().puddle_threshold_m,
            ..BakeOptions::default()
        };
        let basins = Basins::bake(&Grid::new(count, count, cell_m, &heights), &options).expect("a grid");
        let water = |cell: usize| {
            let top = basins.top(basins.wettable_leaf_at(cell)?);
            let depth = basins.basins()[top as usize].spill_m? - heights[cell];
            (depth > 0.0).then_some((top, depth))
        };
        let cells = (0..count * count).filter_map(|cell| {
            let (pool, depth) = water(cell)?;
            Some((pool, self.on_road(place(cell % count), place(cell / count)), depth))
        });
        pools(cells, cell_m)
    }

    /// Triangles of 5 cm across and 25 cm along.
    fn triangles(self) -> Vec<[DVec3; 3]> {
        let corner = |i: u32, j: u32| self.at(f64::from(i) * 0.05 - HALF[1], f64::from(j) * 0.25 - HALF[0]);
        let quads = (0..140).flat_map(|i| (0..56).map(move |j| (i, j)));
        quads
            .flat_map(|(i, j)| {
                let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
                [[a, d, c], [a, c, b]]
            })
            .collect()
    }
}

/// Water of one puddle, by its moments.
#[derive(Clone, Copy, Debug, Default)]
struct Pool {
    volume_m3: f64,
    across_m: f64,
    /// Root of the second moments about its middle, those of the cells included.
    spread_m: [f64; 2],
}

impl Pool {
    fn elongation(&self) -> f64 {
        self.spread_m[1] / self.spread_m[0]
    }

    /// Distance of its middle from the nearest rut's. Units: m.
    fn off_rut_m(&self) -> f64 {
        (self.across_m.abs() - 1.0).abs().min((self.across_m.abs() - 2.5).abs())
    }
}

/// Puddles of more than 0.1 l by (pool, place across and along, depth).
fn pools(cells: impl Iterator<Item = (u32, [f64; 2], f64)>, cell_m: f64) -> Vec<Pool> {
    let mut sums = std::collections::BTreeMap::<u32, [f64; 5]>::new();
    for (pool, [u, v], depth) in cells {
        let sum = sums.entry(pool).or_default();
        for (sum, w) in sum.iter_mut().zip([1.0, u, v, u * u, v * v]) {
            *sum += w * depth * cell_m * cell_m;
        }
    }
    let pools = sums.values().map(|&[volume_m3, u, v, uu, vv]| {
        let spread = |first: f64, second: f64| {
            let mean = first / volume_m3;
            ops::sqrt(second / volume_m3 - mean * mean + cell_m * cell_m / 12.0)
        };
        Pool {
            volume_m3,
            across_m: u / volume_m3,
            spread_m: [spread(u, uu), spread(v, vv)],
        }
    });
    pools.filter(|pool| pool.volume_m3 > 1e-4).collect()
}

fn litres(pools: &[Pool]) -> f64 {
    pools.iter().map(|pool| 1e3 * pool.volume_m3).sum()
}

#[test]
fn puddles_lie_in_ruts_and_stretch_along_them_on_cells_of_an_eighth_of_a_metre() {
    for angle in [0.0, 17.0, 30.0, 45.0, 80.0] {
        let road = Road::new(angle, 0.02, 0.012);
        let (truth, found) = (road.pools(1.0 / 32.0), road.pools(0.125));
        assert_eq!(found.len(), truth.len(), "{angle}: {found:?}");
        for pool in &found {
            assert!(pool.elongation() > 6.0 && pool.off_rut_m() < 0.2, "{angle}: {pool:?}");
        }
        let share = litres(&found) / litres(&truth);
        assert!((0.6..1.1).contains(&share), "{angle}: {share} of the water");
    }
    // Cells as wide as a rut's flank are dams and gaps in it, unless it runs along their rows.
    let oblique = Road::new(30.0, 0.02, 0.012);
    let share = litres(&oblique.pools(0.25)) / litres(&oblique.pools(1.0 / 32.0));
    assert!(share < 0.4, "on cells of 0.25 m {share} of the water");
    // Without ruts a crown drains the road, and a road hollow across has puddles over all of its width.
    assert_eq!(litres(&Road::new(17.0, 0.02, 0.0).pools(0.125)), 0.0);
    let hollow = Road::new(17.0, -0.000_4, 0.0).pools(0.125);
    assert!(
        !hollow.is_empty() && hollow.iter().all(|pool| pool.elongation() < 1.0),
        "{hollow:?}"
    );
}

#[test]
fn heavy_rain_fills_ruts_to_long_puddles() {
    let road = Road::new(17.0, 0.02, 0.012);
    let mut scene = GroundScene::default();
    scene.set(1, &road.triangles(), SurfaceClass::Asphalt, true);
    let settings = GroundSettings {
        cell_m: 0.125,
        ..GroundSettings::default()
    };
    let mut ground = Ground::build(&scene, &settings).expect("a road");
    let rain = ColumnForcing {
        rain_mm_h: 50.0,
        evaporation_mm_h: 0.0,
    };
    for _ in 0..900 {
        ground.advance(&rain, 1.0, 32).expect("valid");
    }
    let frame = *ground.frame();
    let ([nx, nz], [ox, oz], cell_m) = (frame.cells(), frame.origin(), frame.cell_m());
    let cells = (0..nx * nz).filter_map(|cell| {
        let (x, z) = (
            ox + (cell % nx) as f64 * cell_m + 0.0625,
            oz + (cell / nx) as f64 * cell_m + 0.0625,
        );
        let y = ground.base_height_m() + f64::from(ground.ground_heights()[cell]);
        let depth = ground.water_at(DVec3::new(x, y, z)).puddle_m;
        let pool = ground.basins().top(ground.basins().wettable_leaf_at(cell)?);
        (depth > 0.0).then(|| (pool, road.on_road(x, z), depth))
    });
    let found = pools(cells, cell_m);
    assert!(found.len() >= 4 && litres(&found) > 1.0, "{found:?}");
    for pool in &found {
        assert!(pool.elongation() > 5.0 && pool.off_rut_m() < 0.2, "{pool:?}");
    }
}
