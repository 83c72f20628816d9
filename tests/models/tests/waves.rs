//! Water waves: dispersion, discrete modes, open-water integrals.
