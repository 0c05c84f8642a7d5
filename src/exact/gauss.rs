//! Gauss-Legendre quadrature with 8 nodes on [0, 1]. On an interval of one over the fastest rate `p` of a motion, the
//! integral of a product of two of its components (rate `2 p`) is exact to `(2)^17 (8!)^4 / (17 (16!)^3) = 2e-18`.

/// Nodes and weights.
pub(super) const NODES: [(f64, f64); 8] = [
    (0.019_855_071_751_231_884, 0.050_614_268_145_188_13),
    (0.101_666_761_293_186_63, 0.111_190_517_226_687_24),
    (0.237_233_795_041_835_5, 0.156_853_322_938_943_64),
    (0.408_282_678_752_175_1, 0.181_341_891_689_181),
    (0.591_717_321_247_825, 0.181_341_891_689_181),
    (0.762_766_204_958_164_5, 0.156_853_322_938_943_64),
    (0.898_333_238_706_813_4, 0.111_190_517_226_687_24),
    (0.980_144_928_248_768_1, 0.050_614_268_145_188_13),
];

/// Integral of `f` from `from` to `to`, in steps of at most `step`. Calls `f(t, weight)` at every node.
pub(super) fn integrate(from: f64, to: f64, step: f64, mut f: impl FnMut(f64, f64)) {
    let steps = ((to - from) / step).ceil().max(1.0);
    let width = (to - from) / steps;
    for n in 0..steps as u64 {
        let left = from + n as f64 * width;
        for (node, weight) in NODES {
            f(left + node * width, weight * width);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_up_to_degree_15_are_integrated_exactly_and_16_is_not() {
        let integral = |degree: i32| NODES.iter().map(|(x, w)| w * x.powi(degree)).sum::<f64>();
        for degree in 0..=15 {
            // Rounding of eight terms of a sum of at most 1.
            assert!((integral(degree) - 1.0 / f64::from(degree + 1)).abs() < 2e-16, "{degree}");
        }
        assert!((integral(16) - 1.0 / 17.0).abs() > 1e-12);
    }

    #[test]
    fn a_cosine_squared_is_integrated_to_rounding() {
        let mut sum = 0.0;
        integrate(0.0, 20.0, 1.0, |t, weight| sum += weight * t.cos().powi(2));
        // Exact: 10 + sin(40)/4; 160 terms of size below 0.2.
        assert!((sum - (10.0 + 40.0_f64.sin() / 4.0)).abs() < 1e-14);
    }
}
