//! Quadrature over a panel whose integrand has roots or thin layers at its ends.
//!
//! Gauss–Legendre in s on (0, 1) with `x = a + h S(s)`, `S = s² (3 − 2 s)`, `dx = h · 6 s (1 − s) ds`. Near an end the
//! distance to it is proportional to s²: the root of gamma and of the sinkage law become smooth there, and nodes cluster
//! where a slip velocity changes sign. A panel of zero length contributes zero, so an integral stays continuous when a
//! breakpoint enters or leaves the contact.

/// Number of nodes per panel.
pub(crate) const NODES: usize = 8;

/// S(s) at the nodes: place within the panel, from 0 to 1.
pub(crate) const PLACE: [f64; NODES] = [
    0.001_167_016_936_121_270_7,
    0.028_906_709_261_184_64,
    0.142_136_644_575_374_28,
    0.363_967_082_634_152_9,
    0.636_032_917_365_847_1,
    0.857_863_355_424_625_8,
    0.971_093_290_738_815_3,
    0.998_832_983_063_878_7,
];

/// Gauss weight times dS/ds; their sum is 1.
pub(crate) const WEIGHT: [f64; NODES] = [
    0.005_909_979_436_670_7,
    0.060_930_600_558_044_24,
    0.170_299_343_346_653_11,
    0.262_860_076_658_632,
    0.262_860_076_658_632,
    0.170_299_343_346_653_11,
    0.060_930_600_558_044_24,
    0.005_909_979_436_670_7,
];

/// Returns 1 − S(s) at node i, without the cancellation: the rule is symmetric.
pub(crate) const fn place_from_end(node: usize) -> f64 {
    PLACE[NODES - 1 - node]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_at_both_ends_are_integrated_to_nine_digits() {
        // ∫ sqrt(x (1 − x)) dx = π/8
        let sum: f64 = (0..NODES)
            .map(|i| WEIGHT[i] * (PLACE[i] * place_from_end(i)).sqrt())
            .sum();
        assert!((sum / (core::f64::consts::PI / 8.0) - 1.0).abs() < 1e-9, "{sum}");
    }

    #[test]
    fn constants_are_exact() {
        assert!((WEIGHT.iter().sum::<f64>() - 1.0).abs() < 1e-15);
    }
}
