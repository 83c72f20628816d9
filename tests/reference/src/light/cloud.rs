//! Light through a cloud, photon by photon.

/// Share of diffuse light that a slab of drops lets through over black ground: `photons` walk at random, turned at each drop
/// by the angle of Henyey & Greenstein 1941. Numbers from a fixed seed.
pub fn slab_transmittance(depth: f64, asymmetry: f64, photons: u32) -> f64 {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut unit = || {
        // SplitMix64.
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut through = 0;
    for _ in 0..photons {
        // Downwards by Lambert's law.
        let (mut at, mut down) = (0.0, (1.0 - unit()).sqrt());
        loop {
            at -= (1.0 - unit()).ln() * down;
            if at < 0.0 {
                break;
            }
            if at > depth {
                through += 1;
                break;
            }
            let g: f64 = asymmetry;
            let share = (1.0 - g * g) / (1.0 - g + 2.0 * g * unit());
            let turned = (1.0 + g * g - share * share) / (2.0 * g);
            let around = (2.0 * core::f64::consts::PI * unit()).cos();
            let sines = ((1.0 - down * down) * (1.0 - turned * turned)).max(0.0).sqrt();
            down = (down * turned + sines * around).clamp(-1.0, 1.0);
        }
    }
    f64::from(through) / f64::from(photons)
}
