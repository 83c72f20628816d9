//! Canopy store and drips.
