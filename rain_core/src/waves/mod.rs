//! Waves on shallow water: dispersion, damped wave equation, sources, borders.
