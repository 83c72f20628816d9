//! Rainbows: light that leaves drops after one and two inner reflections, by wavelength, drop size and the sun's disc.
//!
//! # Accuracy
//! Spheres. Large drops: geometric optics, between the bows nothing but outer reflection (Alexander's dark band). Near the
//! bows Airy's theory, uniform in the angle (Berry 1966; Chester, Friedman & Ursell 1957): each ray's own amplitude, so that
//! light averaged over the fringes is that of the rays. It fails where a drop is not large against the wavelength, below a
//! radius of 10 µm. Falling drops above 1 mm are flat: their bow is bright near the horizon and missing above. Every order
//! after the second inner reflection is left out (0.3 % of the light).

mod airy;
mod colour;
mod rays;
mod table;

pub use colour::water_index;
pub use rays::BowRays;
pub use table::{BOW_KNOTS, BOW_SPAN_DEG, BOW_STEP_DEG, RainbowPhase, RainbowTables, bow_place};
