//! Extinction, visibility and fog of rain: one optical depth, shared between drawn drops and haze.
