//! Statistics that a good hash passes.

/// χ²/dof of `values` in [0, 1) sorted into `bins` equal bins against the uniform distribution.
///
/// Expected for a uniform source: 1 with a standard deviation of √(2/(bins − 1)).
///
/// # Panics
/// When a value is outside [0, 1).
pub fn chi_squared_per_degree(values: impl IntoIterator<Item = f64>, bins: usize) -> f64 {
    let mut counts = vec![0_u64; bins];
    let mut total = 0_u64;
    for value in values {
        assert!((0.0..1.0).contains(&value), "{value} is outside [0, 1)");
        counts[(value * bins as f64) as usize] += 1;
        total += 1;
    }
    let expected = total as f64 / bins as f64;
    let sum: f64 = counts
        .iter()
        .map(|count| (*count as f64 - expected).powi(2) / expected)
        .sum();
    sum / (bins - 1) as f64
}

/// χ²/dof of pairs in [0, 1)² sorted into `side` × `side` bins.
pub fn chi_squared_of_pairs(pairs: impl IntoIterator<Item = (f64, f64)>, side: usize) -> f64 {
    let cell = |(a, b): (f64, f64)| ((a * side as f64).floor() + b) / side as f64;
    chi_squared_per_degree(pairs.into_iter().map(cell), side * side)
}

/// Pearson's correlation of pairs.
pub fn correlation(pairs: &[(f64, f64)]) -> f64 {
    let n = pairs.len() as f64;
    let (ma, mb) = (
        pairs.iter().map(|p| p.0).sum::<f64>() / n,
        pairs.iter().map(|p| p.1).sum::<f64>() / n,
    );
    let sum = |f: &dyn Fn(&(f64, f64)) -> f64| pairs.iter().map(f).sum::<f64>();
    sum(&|p| (p.0 - ma) * (p.1 - mb)) / (sum(&|p| (p.0 - ma).powi(2)) * sum(&|p| (p.1 - mb).powi(2))).sqrt()
}

/// `pcg` in 64-bit arithmetic, reduced by hand. Source: Jarzynski & Olano 2020.
pub fn pcg(v: u32) -> u32 {
    const WORD: u64 = 1 << 32;
    let state = (u64::from(v) * 747_796_405 + 2_891_336_453) % WORD;
    let shifted = (state >> ((state >> 28) + 4)) ^ state;
    let word = shifted * 277_803_737 % WORD;
    ((word >> 22) ^ word) as u32
}

/// `pcg3d` in 128-bit arithmetic, reduced by hand. Source: Jarzynski & Olano 2020.
pub fn pcg3d(v: [u32; 3]) -> [u32; 3] {
    const WORD: u128 = 1 << 32;
    let mut s = v.map(|c| (u128::from(c) * 1_664_525 + 1_013_904_223) % WORD);
    for round in 0..2 {
        for (target, a, b) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
            s[target] = (s[target] + s[a] * s[b]) % WORD;
        }
        if round == 0 {
            s = s.map(|c| c ^ (c >> 16));
        }
    }
    s.map(|c| c as u32)
}
