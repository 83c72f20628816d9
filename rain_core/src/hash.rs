//! Counter-based randomness: integers in, integers out, no hidden state.
//!
//! The same functions exist in WGSL (`rain_render/shaders/lib/hash.wgsl`); a test compares the two bit for bit.

/// PCG-RXS-M-XS on 32 bits. Source: Jarzynski & Olano 2020. Error: none, integers.
#[must_use]
pub fn pcg(v: u32) -> u32 {
    let s = v.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let w = ((s >> ((s >> 28) + 4)) ^ s).wrapping_mul(277_803_737);
    (w >> 22) ^ w
}

/// Three independent 32-bit hashes of three integers. Source: Jarzynski & Olano 2020, `pcg3d`. Error: none, integers.
#[must_use]
pub fn pcg3d(v: [u32; 3]) -> [u32; 3] {
    let [mut x, mut y, mut z] = v.map(|c| c.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    x = x.wrapping_add(y.wrapping_mul(z));
    y = y.wrapping_add(z.wrapping_mul(x));
    z = z.wrapping_add(x.wrapping_mul(y));
    x ^= x >> 16;
    y ^= y >> 16;
    z ^= z >> 16;
    x = x.wrapping_add(y.wrapping_mul(z));
    y = y.wrapping_add(z.wrapping_mul(x));
    z = z.wrapping_add(x.wrapping_mul(y));
    [x, y, z]
}

/// Uniform in [0, 1) from the upper 24 bits; never rounds to 1. Error: none; h/2³² is cut to 2⁻²⁴.
#[must_use]
pub fn unit_f32(h: u32) -> f32 {
    (h >> 8) as f32 * (1.0 / 16_777_216.0)
}

/// Uniform in (0, 1): the centre of one of 2²³ intervals, so its logarithm is finite. Error: none; h/2³² is moved by no
/// more than 2⁻²⁴.
#[must_use]
pub fn open_unit_f32(h: u32) -> f32 {
    // 24 bits and a half need 25: one bit less keeps the sum exact and below 1.
    ((h >> 9) as f32 + 0.5) * (1.0 / 8_388_608.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_values() {
        let expected = [129_708_002, 2_831_084_092, 2_055_130_248, 4_099_845_390, 3_861_530_882];
        for (v, e) in [0, 1, 2, 12_345, u32::MAX].into_iter().zip(expected) {
            assert_eq!(pcg(v), e, "pcg({v})");
        }
        assert_eq!(pcg3d([0, 0, 0]), [2_611_992_518, 2_833_812_075, 1_058_359_340]);
        assert_eq!(pcg3d([1, 2, 3]), [4_204_755_366, 1_223_881_804, 1_500_469_937]);
        assert_eq!(pcg3d([u32::MAX, 7, 100]), [3_966_546_475, 1_036_824_485, 2_596_798_289]);
    }

    #[test]
    fn unit_values_stay_inside() {
        assert_eq!(unit_f32(0), 0.0);
        assert!(unit_f32(u32::MAX) < 1.0);
        assert!(open_unit_f32(0) > 0.0 && open_unit_f32(u32::MAX) < 1.0);
    }
}
