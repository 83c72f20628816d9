//! Splash thresholds and crowns.
