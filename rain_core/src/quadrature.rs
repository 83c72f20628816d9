//! Gauss–Legendre quadrature.
