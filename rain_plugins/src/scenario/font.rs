//! The one font of plots and captions, built in: a fresh machine has none.

use std::sync::OnceLock;

use plotters::style::{FontStyle, register_font};

/// Family name to draw with after [`ready`].
pub(super) const FAMILY: &str = "rain";

/// Makes [`FAMILY`] known to the plotter; whether that worked.
pub(super) fn ready() -> bool {
    static READY: OnceLock<bool> = OnceLock::new();
    *READY.get_or_init(|| register_font(FAMILY, FontStyle::Normal, epaint_default_fonts::UBUNTU_LIGHT).is_ok())
}
