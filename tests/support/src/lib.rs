//! What the rendering tests share: a graphics device or a reason to skip, small worlds, a headless app, pictures whose
//! pixels know where in the world they lie, and perceptual goldens.

pub mod app;
pub mod assets;
pub mod golden;
pub mod gpu;
pub mod shots;
pub mod world;
