//! Monotone piecewise cubic Hermite interpolation (PCHIP).
//!
//! Slopes at inner nodes are the weighted harmonic mean of the neighbouring secants where these have the same sign, otherwise 0; at
//! the ends the three-point formula, limited to keep the shape (F. N. Fritsch, R. E. Carlson, SIAM J. Numer. Anal. 17 (1980)
//! 238-246; F. N. Fritsch, J. Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300-304).

/// Nodes in increasing order with values and slopes.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Pchip {
    nodes: Vec<f64>,
    values: Vec<f64>,
    slopes: Vec<f64>,
}

impl Pchip {
    /// At least three nodes, strictly increasing: the caller has checked that.
    pub(super) fn through(nodes: Vec<f64>, values: Vec<f64>) -> Self {
        let widths: Vec<f64> = nodes.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let secants: Vec<f64> = values.windows(2).zip(&widths).map(|(pair, h)| (pair[1] - pair[0]) / h).collect();
        let last = secants.len() - 1;
        let slopes = (0..nodes.len())
            .map(|i| match i {
                0 => end_slope([widths[0], widths[1]], [secants[0], secants[1]]),
                i if i > last => end_slope([widths[last], widths[last - 1]], [secants[last], secants[last - 1]]),
                i => inner_slope([widths[i - 1], widths[i]], [secants[i - 1], secants[i]]),
            })
            .collect();
        Self { nodes, values, slopes }
    }

    pub(super) fn nodes(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.nodes.iter().copied().zip(self.values.iter().copied())
    }

    /// Value and slope; `x` lies between the first and the last node.
    pub(super) fn evaluate(&self, x: f64) -> (f64, f64) {
        let i = self.nodes.partition_point(|node| *node <= x).clamp(1, self.nodes.len() - 1) - 1;
        let width = self.nodes[i + 1] - self.nodes[i];
        let t = (x - self.nodes[i]) / width;
        let (rise, left, right) =
            (self.values[i + 1] - self.values[i], self.slopes[i] * width, self.slopes[i + 1] * width);
        // Cubic c1 t + c2 t^2 + c3 t^3 above the left value.
        let c2 = 3.0 * rise - 2.0 * left - right;
        let c3 = left + right - 2.0 * rise;
        let value = self.values[i] + t * (left + t * (c2 + t * c3));
        (value, (left + t * (2.0 * c2 + 3.0 * t * c3)) / width)
    }
}

fn inner_slope([h0, h1]: [f64; 2], [d0, d1]: [f64; 2]) -> f64 {
    if d0 * d1 <= 0.0 {
        return 0.0;
    }
    let (w0, w1) = (2.0 * h1 + h0, h1 + 2.0 * h0);
    (w0 + w1) / (w0 / d0 + w1 / d1)
}

fn end_slope([h0, h1]: [f64; 2], [d0, d1]: [f64; 2]) -> f64 {
    let slope = ((2.0 * h0 + h1) * d0 - h0 * d1) / (h0 + h1);
    if slope * d0 <= 0.0 {
        0.0
    } else if d0 * d1 <= 0.0 && slope.abs() > 3.0 * d0.abs() {
        3.0 * d0
    } else {
        slope
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interpolation_keeps_monotone_data_monotone() {
        // A step: a cubic spline would overshoot by 10 %.
        let found = Pchip::through(vec![0.0, 1.0, 2.0, 3.0, 4.0], vec![0.0, 0.0, 0.5, 1.0, 1.0]);
        let mut last = 0.0;
        for n in 0..=400 {
            let (value, slope) = found.evaluate(f64::from(n) * 0.01);
            // A rounding of 1.
            assert!(value >= last - 1e-15 && slope >= -1e-15, "{n}");
            last = value;
        }
        assert_eq!(found.evaluate(4.0).0, 1.0);
    }

    #[test]
    fn a_straight_line_is_reproduced_and_the_slope_is_the_derivative() {
        let nodes = vec![0.0, 0.3, 1.0, 2.5];
        let found = Pchip::through(nodes.clone(), nodes.iter().map(|x| 2.0 - 3.0 * x).collect());
        for x in [0.0, 0.1, 0.7, 2.0, 2.5] {
            let (value, slope) = found.evaluate(x);
            // Roundings of numbers of order 5.
            assert!((value - (2.0 - 3.0 * x)).abs() < 4e-15 && (slope + 3.0).abs() < 2e-14, "{x}");
        }
    }
}
