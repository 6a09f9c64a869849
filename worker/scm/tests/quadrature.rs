//! The closed forms of gamma, compared with sums over a footprint.

use scm::pressure_distribution::{PressureDistribution, RectangleDistribution};

const CELLS: u32 = 1_200;

/// gamma by its definition, on a grid of cells: the mean over the width at each place, with an overall mean of 1.
fn gamma_by_cells(length: f64, width: f64, exponent: f64) -> Vec<(f64, f64)> {
    let deepest = (length / 2.0).min(width / 2.0);
    let middle = |i: u32, extent: f64| (f64::from(i) + 0.5) / f64::from(CELLS) * extent;
    let rows: Vec<(f64, f64)> = (0..CELLS)
        .map(|i| {
            let x = middle(i, length);
            let across = (0..CELLS).map(|j| {
                let y = middle(j, width);
                let distance = x.min(length - x).min(y).min(width - y);
                (distance / deepest).powf(exponent)
            });
            (x.min(length - x), across.sum::<f64>() / f64::from(CELLS))
        })
        .collect();
    let mean = rows.iter().map(|row| row.1).sum::<f64>() / f64::from(CELLS);
    rows.into_iter().map(|(x, g)| (x, g / mean)).collect()
}

#[test]
fn gamma_averages_the_distance_to_the_border_over_the_width() {
    for (length, width) in [(0.04, 0.112), (0.1, 0.112), (0.112, 0.112), (0.1, 0.03)] {
        for exponent in [0.0, 0.3, 0.5, 1.0, 2.0] {
            let law = PressureDistribution::new(exponent);
            let distribution = RectangleDistribution::new(law, length, 0.5 * width);
            for (x, expected) in gamma_by_cells(length, width, exponent) {
                let [gamma] = distribution.gamma([x]);
                assert!((gamma - expected).abs() < 1e-3, "{law:?} {distribution:?} {x}");
            }
        }
    }
}

#[test]
fn gamma_has_mean_one() {
    for (length, width) in [(0.04, 0.112), (0.112, 0.112), (0.1, 0.03)] {
        for exponent in [0.0, 0.5, 0.7, 1.0, 3.0] {
            let law = PressureDistribution::new(exponent);
            let distribution = RectangleDistribution::new(law, length, 0.5 * width);
            // x = (l/2) s² (3 − 2 s) removes the root at the end from the sum
            let steps = 100_000;
            let mean: f64 = (0..steps)
                .map(|i| {
                    let s = (f64::from(i) + 0.5) / f64::from(steps);
                    let [gamma] = distribution.gamma([0.5 * length * s * s * (3.0 - 2.0 * s)]);
                    gamma * 6.0 * s * (1.0 - s) / f64::from(steps)
                })
                .sum();
            assert!((mean - 1.0).abs() < 1e-8, "{distribution:?}: {mean}");
        }
    }
}
