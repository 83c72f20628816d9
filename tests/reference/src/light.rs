//! Fresnel reflection, refraction in a drop, extinction.
