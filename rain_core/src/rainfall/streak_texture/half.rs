//! Half floats, as textures hold them.

/// A half float as single precision: exact.
pub(super) fn from_half(half: u16) -> f32 {
    let sign = if half & 0x8000 == 0 { 1.0 } else { -1.0 };
    let (exponent, mantissa) = (u32::from(half >> 10 & 31), u32::from(half & 1023));
    match exponent {
        // 2^-24, an exact power.
        0 => sign * mantissa as f32 * f32::from_bits(103 << 23),
        31 if mantissa == 0 => sign * f32::INFINITY,
        31 => f32::NAN,
        e => sign * f32::from_bits((e + 112) << 23 | mantissa << 13),
    }
}

/// The nearest half float, ties to even; what is too large is the largest one. `x` is finite and not negative.
pub(super) fn to_half(x: f32) -> u16 {
    // NaN counts as 0.
    let x = if x > 0.0 { x.min(65_504.0) } else { 0.0 };
    if x < f32::from_bits(113 << 23) {
        // Below 2^-14 halves are multiples of 2^-24; adding 2^-1 rounds to just those.
        let bits = (x + 0.5).to_bits();
        return (bits - 0.5_f32.to_bits()) as u16;
    }
    let bits = x.to_bits();
    let rounded = bits + 0xFFF + (bits >> 13 & 1);
    ((rounded >> 13) - (112 << 10)) as u16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_half_survives_and_what_lies_between_goes_to_the_nearest() {
        let mut previous = 0.0;
        for half in 0..=0x7BFF_u16 {
            let x = from_half(half);
            assert_eq!(to_half(x), half, "{half:#x}");
            if half > 0 {
                assert!(x > previous);
                let middle = 0.5 * (previous + x);
                // Ties go to the even one.
                assert_eq!(to_half(middle), half - (half & 1), "{half:#x}");
                let nudge = (x - previous) * 0.01;
                assert_eq!(to_half(middle + nudge), half);
                assert_eq!(to_half(middle - nudge), half - 1);
            }
            previous = x;
        }
        assert_eq!(to_half(1e9), 0x7BFF);
        assert_eq!(from_half(0x3C00), 1.0);
        assert_eq!(from_half(0xC000), -2.0);
        assert!(from_half(0x7C00).is_infinite() && from_half(0x7C01).is_nan());
    }
}
