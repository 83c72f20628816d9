//! The simulation's ground in the picture: levels of its puddles, its films and pores, and the ground under the view.

use std::sync::Arc;

use bevy::math::DVec2;
use bevy::prelude::*;
use half::f16;
use rain_core::surface::closed_film_share_f32;
use rain_ecs::prelude::*;

use super::state::SurfaceState;
use super::water::{LEVEL_TEXELS, NO_WATER_M, WaterLevels};
use crate::rainfall::{RainView, ViewPlace, leading_view};

/// Where the levels come from.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LevelsFromGround {
    /// Build, level version and first cell that the levels show.
    shown: Option<(u64, u64, UVec2)>,
}

impl LevelsFromGround {
    /// Build of the ground and first cell that are shown, if the levels come from it.
    pub(super) fn window(&self) -> Option<(u64, UVec2)> {
        self.shown.map(|(builds, _, first)| (builds, first))
    }
}

/// Films and pores of the ground, for the picture; in the cells of [`WaterLevels`].
///
/// What the ground remembers is seen: a floor that dries slowly under a new roof, a road that stays wet under a car that
/// has just come.
#[derive(Resource, Clone, Debug, Default)]
pub struct GroundFilms {
    /// For each cell: share under a closed film, pore saturation, height above the levels' base in m, 1. Empty: the
    /// picture goes by the weather and by what covers now. As half floats.
    pub texels: Arc<Vec<[u16; 4]>>,
    /// Counts changes.
    pub version: u64,
    /// What is shown: build, version of the films, first cell; and when it was taken. Units: ns.
    shown: Option<(u64, u64, UVec2, u64)>,
}

/// Films are followed this often: they change slowly, and every change is uploaded. Units: ns.
const FILMS_NS: u64 = 250_000_000;

/// Height of a cell without ground: nothing is near it. Units: m.
const NO_GROUND_M: f32 = -3e4;

/// Shows the ground's films and pores when they have changed; in the physical way only, which is the ground's, and where
/// nothing is set by hand.
pub(super) fn follow_films(
    mut films: ResMut<GroundFilms>,
    mut scratch: Local<[Vec<f32>; 2]>,
    levels: Res<WaterLevels>,
    shown: Res<LevelsFromGround>,
    surface: Res<SurfaceState>,
    clock: Res<RainClock>,
    ground: Option<Res<SurfaceGround>>,
) {
    let source = ground.as_ref().and_then(|g| Some((g.ground()?, shown.shown?)));
    let shown_as_it_is = surface.artist.w < 0.5 && !surface.by_hand.is_set();
    let Some((ground, (builds, _, first))) = source.filter(|_| shown_as_it_is) else {
        if films.shown.take().is_some() {
            films.texels = Arc::default();
            films.version += 1;
        }
        return;
    };
    let (version, now) = (ground.film_version(), clock.now_ns());
    let fresh = films
        .shown
        .is_none_or(|(b, v, f, at)| (b, f) != (builds, first) || (v != version && now.abs_diff(at) >= FILMS_NS));
    if !fresh {
        return;
    }
    let [nx, nz] = ground.frame().cells();
    let [film, saturation] = &mut *scratch;
    film.resize(nx * nz, 0.0);
    saturation.resize(nx * nz, 0.0);
    ground.films_into(film);
    ground.saturations_into(saturation);
    let texture = SurfaceClass::ALL.map(|class| ground.properties(class).texture_depth_mm as f32);
    let texel = |cell: usize| {
        let height = ground.ground_heights()[cell];
        let share = closed_film_share_f32(film[cell], texture[usize::from(ground.classes()[cell])]);
        [
            share,
            saturation[cell],
            if height.is_nan() { NO_GROUND_M } else { height },
            1.0,
        ]
        .map(|value| f16::from_f32(value).to_bits())
    };
    let rows = first.y as usize..(first.y + levels.cells.y) as usize;
    let columns = first.x as usize..(first.x + levels.cells.x) as usize;
    films.texels = Arc::new(
        rows.flat_map(|z| columns.clone().map(move |x| z * nx + x))
            .map(texel)
            .collect(),
    );
    films.version += 1;
    films.shown = Some((builds, version, first, now));
}

/// The window of a larger ground moves by this many cells at once.
const SNAP: u32 = 64;

/// First cell and number of cells of what is shown along one axis, around cell `eye`.
fn window(cells: u32, eye: f64) -> (u32, u32) {
    if cells <= LEVEL_TEXELS {
        return (0, cells);
    }
    let first = (eye - f64::from(LEVEL_TEXELS / 2)).clamp(0.0, f64::from(cells - LEVEL_TEXELS)) as u32;
    (first / SNAP * SNAP, LEVEL_TEXELS)
}

/// Shows the ground's puddles when their levels, or the level set by hand, have changed.
pub(super) fn follow_ground(
    mut levels: ResMut<WaterLevels>,
    mut shown: ResMut<LevelsFromGround>,
    mut surface: ResMut<SurfaceState>,
    mut all: Local<Vec<f32>>,
    ground: Option<Res<SurfaceGround>>,
    views: Query<(Entity, &Camera, ViewPlace), With<RainView>>,
) {
    let eye = leading_view(views).map(|view| view.place());
    let built = ground.as_ref().and_then(|g| Some((g.ground()?, g.rebuilds())));
    let Some((ground, builds)) = built else {
        if shown.shown.take().is_some() {
            levels.cells = UVec2::ZERO;
            levels.set_levels(Vec::new());
        }
        return;
    };
    let frame = ground.frame();
    let [nx, nz] = frame.cells();
    let (corner, cell_m) = (DVec2::from(frame.origin()), frame.cell_m());
    let at = eye.unwrap_or(surface.anchor).xz().as_dvec2();
    let cell = ((at - corner) / cell_m).floor();
    let (first_x, columns) = window(nx as u32, cell.x);
    let (first_z, rows) = window(nz as u32, cell.y);
    let first = UVec2::new(first_x, first_z);
    surface.ground_m = ground
        .cell_at(at.x, at.y)
        .map(|i| ground.ground_heights()[i])
        .and_then(|height| {
            let height = (ground.base_height_m() + f64::from(height)) as f32;
            height.is_finite().then_some(height)
        });
    let by_hand = surface.by_hand.water_level;
    // No version counts that far.
    let version = by_hand.map_or_else(|| ground.level_version(), |share| !share.to_bits());
    let now = (builds, version, first);
    if shown.shown == Some(now) {
        return;
    }
    let same_place = shown.shown.is_some_and(|(b, _, f)| (b, f) == (builds, first));
    shown.shown = Some(now);
    all.resize(nx * nz, NO_WATER_M);
    match by_hand {
        Some(share) => ground.levels_filled(share, &mut all),
        None => ground.levels(&mut all),
    }
    let cut = |values: &[f32]| -> Vec<f32> {
        let row = |z: usize| {
            let start = (first_z as usize + z) * nx + first_x as usize;
            values[start..start + columns as usize].iter().copied()
        };
        (0..rows as usize).flat_map(row).collect()
    };
    if !same_place {
        levels.ground_m = Arc::new(cut(ground.ground_heights()));
        levels.corner_m = corner + first.as_dvec2() * cell_m;
        levels.cell_m = cell_m;
        levels.cells = UVec2::new(columns, rows);
        levels.base_m = ground.base_height_m();
    }
    levels.set_levels(cut(&all));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_window_holds_the_eye_and_stays_inside() {
        assert_eq!(window(300, 5.0), (0, 300));
        for eye in [-1e9, 0.0, 600.0, 1500.0, 2999.0, 1e9, f64::NAN] {
            let (first, cells) = window(3000, eye);
            assert!(cells == LEVEL_TEXELS && first + cells <= 3000, "{eye}: {first}");
            if (0.0..3000.0).contains(&eye) {
                let place = eye - f64::from(first);
                assert!(
                    (0.0..f64::from(LEVEL_TEXELS) + f64::from(SNAP)).contains(&place),
                    "{eye}: {first}"
                );
            }
        }
        assert_eq!(window(3000, 1500.0).0 % SNAP, 0);
    }
}
