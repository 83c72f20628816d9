//! A terminal-speed law as a table for linear look-up.

/// Speeds at N + 1 diameters from 0 to 6.4 mm, equally spaced: what a texture or a shader's array would hold.
///
/// Error: of the monotone cubic 0.0205 m/s with 64 steps, 0.0095 with 128, 0.0035 with 256. The
/// polynomial of [`terminal_velocity_f32`](super::terminal_velocity_f32) is as fast and needs no memory.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpeedTable<const N: usize> {
    speeds: [f32; N],
    last: f32,
}

impl<const N: usize> SpeedTable<N> {
    /// Largest diameter. Units: mm.
    pub const MAX_MM: f32 = 6.4;

    /// Tabulates `speed_m_s`, a law in mm and m/s. Allocates nothing. N at least 1.
    pub fn new(speed_m_s: impl Fn(f64) -> f64) -> Self {
        let at = |i: usize| speed_m_s(f64::from(Self::MAX_MM) * i as f64 / N as f64) as f32;
        Self {
            speeds: core::array::from_fn(at),
            last: at(N),
        }
    }

    /// Speed between two entries. Units: m/s.
    ///
    /// `diameter_mm` in mm, held in [0, 6.4]; NaN counts as 0.
    #[must_use]
    pub fn speed_m_s(&self, diameter_mm: f32) -> f32 {
        let d = if diameter_mm > 0.0 {
            diameter_mm.min(Self::MAX_MM)
        } else {
            0.0
        };
        let place = d * (N as f32 / Self::MAX_MM);
        let i = (place as usize).min(N - 1);
        let (from, to) = (self.speeds[i], self.speeds.get(i + 1).copied().unwrap_or(self.last));
        from + (place - i as f32) * (to - from)
    }
}
