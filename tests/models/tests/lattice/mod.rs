//! Cards of the lattice: the optical depth of the rain, motion, direction, light.

mod coverage;
mod light;
mod place;

use glam::{DVec3, Vec3};
use rain_core::rainfall::{
    Card, CardCounts, Distribution, FieldMotion, Lamp, LatticePlan, LatticeSettings, LatticeSharing, LatticeView,
    RainViewVolume, Spectrum, StreakTextureSettings,
};

const EXPOSURE_S: f64 = 1.0 / 60.0;

fn spectrum(intensity: f64) -> Spectrum {
    Spectrum::new(Distribution::MarshallPalmer, intensity).expect("a rate")
}

/// Unit normals, relative to the eye, of a frustum of `half` angle (tangent) about `axis`.
fn frustum(eye_m: DVec3, axis: Vec3, half: f32) -> RainViewVolume {
    let (right, up) = axis.any_orthonormal_pair();
    let plane = |side: Vec3| (axis * half + side).normalize().extend(0.0);
    RainViewVolume {
        eye_m,
        eye_velocity_m_s: DVec3::ZERO,
        side_planes: [plane(right), plane(-right), plane(up), plane(-up)],
        focal_px: 623.5,
        solid_angle_sr: 1.0,
        exposure_s: EXPOSURE_S,
        turn_rad: 0.0,
        parallel: None,
    }
}

/// Everything that decides a view's cards.
#[derive(Debug, Clone)]
struct Case {
    lattice: LatticeSettings,
    textures: StreakTextureSettings,
    volume: RainViewVolume,
    intensity: f64,
    motion: FieldMotion,
    kappa: f64,
    lamps: Vec<Lamp>,
    ambient: Vec3,
}

impl Default for Case {
    fn default() -> Self {
        Self {
            lattice: LatticeSettings::default(),
            textures: StreakTextureSettings {
                texels: 128,
                ..StreakTextureSettings::default()
            },
            volume: frustum(DVec3::new(31.4, 1.7, -27.2), Vec3::new(0.3, 0.1, -1.0).normalize(), 0.6),
            intensity: 25.0,
            motion: FieldMotion::default().after(100.0),
            kappa: 1.0,
            lamps: Vec::new(),
            ambient: Vec3::ONE,
        }
    }
}

impl Case {
    fn plan(&self) -> LatticePlan {
        LatticePlan::new(self.lattice.clone(), &self.textures).expect("a plan")
    }

    fn cards_with(&self, plan: &LatticePlan, haze: Option<&LatticeSharing>) -> (Vec<Card>, CardCounts) {
        let mut cards = Vec::new();
        let counts = plan.fill(
            &LatticeView {
                volume: &self.volume,
                spectrum: &spectrum(self.intensity),
                local: None,
                motion: &self.motion,
                kappa: self.kappa,
                lamps: &self.lamps,
                ambient: self.ambient,
                seed: 3,
                haze,
            },
            &mut cards,
        );
        (cards, counts)
    }

    fn cards(&self) -> Vec<Card> {
        self.cards_with(&self.plan(), None).0
    }
}

fn centre(card: &Card) -> Vec3 {
    Vec3::new(card.centre[0], card.centre[1], card.centre[2])
}
