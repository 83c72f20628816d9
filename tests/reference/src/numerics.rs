//! Sums, roots and differential equations, the slow way.

/// ∫ₐᵇ f dx by the composite Simpson rule with `panels` pairs of intervals.
///
/// # Panics
/// When `panels` is 0.
pub fn simpson(a: f64, b: f64, panels: usize, f: impl Fn(f64) -> f64) -> f64 {
    assert!(panels > 0, "at least one panel");
    let h = (b - a) / (2 * panels) as f64;
    let mut sum = f(a) + f(b);
    for i in 1..2 * panels {
        sum += f(a + h * i as f64) * if i % 2 == 1 { 4.0 } else { 2.0 };
    }
    sum * h / 3.0
}

/// The root of a continuous `f` between `a` and `b`, where it has opposite signs, by 200 halvings.
pub fn bisect(mut a: f64, mut b: f64, f: impl Fn(f64) -> f64) -> f64 {
    let low = f(a);
    for _ in 0..200 {
        let mid = 0.5 * (a + b);
        if (f(mid) > 0.0) == (low > 0.0) {
            a = mid;
        } else {
            b = mid;
        }
    }
    0.5 * (a + b)
}

/// P_n(x) by Bonnet's recursion.
fn legendre(n: usize, x: f64) -> f64 {
    let (mut before, mut here) = (0.0, 1.0);
    for k in 1..=n {
        let k = k as f64;
        (before, here) = (here, ((2.0 * k - 1.0) * x * here - (k - 1.0) * before) / k);
    }
    here
}

/// Node and weight of the rule of `n` points on [−1, 1], rising: roots by halving between those of one point less, which
/// they enclose; weights 1/Σ (k + ½) P_k², k < n, where nothing cancels.
pub fn gauss_legendre(n: usize) -> Vec<[f64; 2]> {
    let mut roots: Vec<f64> = Vec::new();
    for points in 1..=n {
        let mut ends = vec![-1.0];
        ends.extend(&roots);
        ends.push(1.0);
        roots = ends
            .windows(2)
            .map(|pair| bisect(pair[0], pair[1], |x| legendre(points, x)))
            .collect();
    }
    let weight = |x: f64| 1.0 / (0..n).map(|k| (k as f64 + 0.5) * legendre(k, x).powi(2)).sum::<f64>();
    roots.into_iter().map(|x| [x, weight(x)]).collect()
}

/// dy/dt = f(t, y) from `t0` to `t1` by the classical fourth-order Runge–Kutta rule in `steps` equal steps.
pub fn runge_kutta<const N: usize>(
    t0: f64,
    t1: f64,
    mut y: [f64; N],
    steps: usize,
    f: impl Fn(f64, &[f64; N]) -> [f64; N],
) -> [f64; N] {
    let h = (t1 - t0) / steps as f64;
    let shift = |y: &[f64; N], k: &[f64; N], s: f64| core::array::from_fn(|i| y[i] + s * k[i]);
    for n in 0..steps {
        let t = t0 + h * n as f64;
        let k1 = f(t, &y);
        let k2 = f(t + 0.5 * h, &shift(&y, &k1, 0.5 * h));
        let k3 = f(t + 0.5 * h, &shift(&y, &k2, 0.5 * h));
        let k4 = f(t + h, &shift(&y, &k3, h));
        for i in 0..N {
            y[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
        }
    }
    y
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_answers() {
        assert!((simpson(0.0, 1.0, 100, f64::exp) - (core::f64::consts::E - 1.0)).abs() < 1e-11);
        assert!((bisect(0.0, 2.0, |x| x * x - 2.0) - 2_f64.sqrt()).abs() < 1e-15);
        let [y] = runge_kutta(0.0, 1.0, [1.0], 1000, |_, y| [-y[0]]);
        assert!((y - (-1_f64).exp()).abs() < 1e-13);
    }
}
