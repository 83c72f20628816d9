//! Whether tests that draw can run here.

use std::sync::OnceLock;

use rain_plugins::scenario::headless::require_adapter;

/// Whether there is a graphics adapter. Without one the test says so on stderr and should return.
///
/// # Panics
/// Without an adapter, where `RAIN_GPU=required` is set (`cargo xtask test` sets it): then a skip would hide a broken
/// set-up.
#[must_use]
pub fn available() -> bool {
    static FOUND: OnceLock<Result<String, String>> = OnceLock::new();
    match FOUND.get_or_init(|| require_adapter().map_err(|e| e.to_string())) {
        Ok(_) => true,
        Err(reason) => {
            let required = std::env::var("RAIN_GPU").is_ok_and(|v| v == "required");
            assert!(!required, "RAIN_GPU=required, but {reason}");
            eprintln!("skipped: {reason}");
            false
        }
    }
}
