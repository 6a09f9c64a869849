//! The mating of a genetic algorithm: two children of two parents, by crossover and mutation.

use statistics::rng::Stream;

/// Share of pairs that are crossed; the others are only mutated.
const CROSSED: f64 = 0.9;
/// Distribution index of the crossover: children scatter around their parents by about a third of their distance.
const CROSSOVER_INDEX: f64 = 3.0;
/// Share of children that also move along the difference of two members.
const DRIFTING: f64 = 0.2;
/// Longest usual mutation, in prior widths.
const MUTATION: f64 = 0.5;
/// Shortest mutation as a share of the longest.
const SHORTEST: f64 = 1e-6;

/// The positions that a mating draws from.
pub(super) struct MatingPair<'a> {
    pub(super) first: &'a [f64],
    pub(super) second: &'a [f64],
    /// Two members; some children move along their difference.
    pub(super) drift_pair: [&'a [f64]; 2],
}

/// Returns two children, not yet within the bounds.
///
/// Half of the crossed pairs have one spread factor for all coordinates, so that children lie on the line through their parents
/// and keep correlations; the others have one for each coordinate. For the same reason some children move along the difference of
/// two members, N(0, 1) times as far. Every coordinate mutates with probability 1 / dimension, a child that is not crossed in at
/// least one: N(0, s^2) with ln s uniform over six decades, which serves exploration and convergence alike.
pub(super) fn children(pair: &MatingPair, stream: &mut Stream) -> [Vec<f64>; 2] {
    let MatingPair { first, second, .. } = pair;
    let (mut first_child, mut second_child) = (first.to_vec(), second.to_vec());
    let crossed = stream.uniform() < CROSSED && first != second;
    if crossed {
        let on_a_line = stream.uniform() < 0.5;
        let mut factor = spread_factor(stream);
        for k in 0..first_child.len() {
            if k > 0 && !on_a_line {
                factor = spread_factor(stream);
            }
            let (a, b) = (first[k], second[k]);
            first_child[k] = 0.5 * ((1.0 + factor) * a + (1.0 - factor) * b);
            second_child[k] = 0.5 * ((1.0 - factor) * a + (1.0 + factor) * b);
        }
    }
    for child in [&mut first_child, &mut second_child] {
        if stream.uniform() < DRIFTING {
            drift(child, pair.drift_pair, stream);
        }
        mutate(child, !crossed, stream);
    }
    [first_child, second_child]
}

/// Moves a child along the difference of two members.
fn drift(child: &mut [f64], [from, to]: [&[f64]; 2], stream: &mut Stream) {
    let length = stream.normal_pair().0;
    for (t, (a, b)) in child.iter_mut().zip(from.iter().zip(to)) {
        *t += length * (b - a);
    }
}

/// Returns the distance of two children over that of their parents: beta with density (n + 1) beta^n / 2 below 1 and (n + 1)
/// beta^-(n + 2) / 2 above.
fn spread_factor(stream: &mut Stream) -> f64 {
    let u = stream.uniform();
    let exponent = 1.0 / (CROSSOVER_INDEX + 1.0);
    if u <= 0.5 {
        libm::pow(2.0 * u, exponent)
    } else {
        libm::pow(0.5 / (1.0 - u), exponent)
    }
}

/// Mutates each coordinate with probability 1 / dimension; if `is_forced`, at least one.
fn mutate(child: &mut [f64], is_forced: bool, stream: &mut Stream) {
    let forced = if is_forced {
        stream.below(child.len())
    } else {
        child.len()
    };
    let share = 1.0 / child.len() as f64;
    for (k, t) in child.iter_mut().enumerate() {
        if stream.uniform() < share || k == forced {
            let length = MUTATION * libm::exp(stream.uniform() * libm::log(SHORTEST));
            *t += length * stream.normal_pair().0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn children_are_spread_as_their_parents_are_on_average() {
        // E[beta] = (n+1)/2 [1/(n+2) + 1/n] = 2 (1/5 + 1/3) = 16/15 for n = 3.
        let mut stream = Stream::new(1, 0, 0, 0);
        let mean = (0..100_000).map(|_| spread_factor(&mut stream)).sum::<f64>() / 1e5;
        assert!((mean - 16.0 / 15.0).abs() < 0.01, "{mean}");
    }

    #[test]
    fn every_child_is_somebody_new() {
        for seed in 0..200 {
            let mut stream = Stream::new(seed, 0, 0, 0);
            let parents = [[0.0, 1.0, 2.0], [0.5, 1.0, -2.0]];
            let pair = |second: usize| MatingPair {
                first: &parents[0],
                second: &parents[second],
                drift_pair: [&parents[0], &parents[1]],
            };
            for child in children(&pair(1), &mut stream) {
                assert!(child != parents[0] && child != parents[1], "{seed}: {child:?}");
            }
            let twin = children(&pair(0), &mut stream);
            assert!(twin[0] != parents[0] && twin[1] != parents[0]);
        }
    }
}
