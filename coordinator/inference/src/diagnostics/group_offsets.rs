//! Offsets that groups of repeats share, beside the scatter of the repeats.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// Degrees of freedom of repeats below which their scatter is not estimated.
const MIN_FREEDOM: usize = 3;
/// Largest ratio of the offsets' sd to the scatter; the prior leaves 2e-9 beyond it.
const MAX_RATIO: f64 = 6.0;
/// Number of ratios at which the integrand is evaluated.
const RATIOS: usize = 1200;
/// Eigenvalue, in units of one measurement, below which a combination of offsets has no effect on repeats.
const NO_EFFECT: f64 = 1e-9;

/// What repeats of conditions tell about offsets of their groups.
#[derive(Debug, Clone, PartialEq)]
pub struct GroupOffsets {
    /// Natural logarithm of the Bayes factor of offsets against none.
    pub log_bayes_factor: f64,
    /// Probability that the groups have offsets, from even prior odds.
    pub probability: f64,
    /// Posterior mean of the sd of the offsets, where they exist.
    pub offset_sd: f64,
    /// Posterior mean of the sd of repeats within a group, where offsets exist.
    pub repeat_sd: f64,
    /// Posterior mean of the sd of repeats where there are no offsets.
    pub repeat_sd_without: f64,
    /// Offset of each group; `None` for a group whose conditions no other group has.
    pub offsets: Vec<Option<GroupOffset>>,
}

/// The offset of a group from the mean of the groups that common conditions link it to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroupOffset {
    /// Posterior mean.
    pub mean: f64,
    /// Posterior standard deviation.
    pub sd: f64,
}

/// A reason why repeats tell nothing about offsets of groups.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NoGroupOffsets {
    /// The conditions are repeated fewer than three times.
    FewRepeats,
    /// The repeats of each condition are equal.
    EqualRepeats,
    /// No condition is measured in two groups.
    GroupsFollowConditions,
    /// The offsets explain every difference of repeats, so that none is left to estimate their scatter from.
    NoRepeatWithinGroup,
}

/// Returns what measurements tell about offsets of groups.
///
/// # Equation
/// `y_i = m_c(i) + b_g(i) + e_i` with condition c and group g of measurement i; `m` with a flat prior, `b ~ N(0, s^2)`,
/// `e ~ N(0, sigma^2)`, prior `1 / sigma`, and `r = s / sigma` half-normal of scale 1. Subtracting the means of the conditions
/// removes `m`; with Z the groups' columns so centred, `W = Z'Z = U diag(l) U'`, `p = U'Z'y`, S the sum of squares and n the degrees
/// of freedom of repeats, and sigma integrated in closed form,
/// `BF = E_r[prod (1 + r^2 l)^(-1/2) (Q(r) / S)^(-n/2)]`, `Q(r) = S - sum p^2 r^2 / (1 + r^2 l)`. The improper priors are those of
/// both models and cancel. The expectation over r is a sum over 1200 midpoints in [0, 6].
///
/// # Arguments
/// - `conditions`, `groups`: indices from 0, one of each for every value.
///
/// # Errors
/// [`NoGroupOffsets`] where the measurements are confounded or too few.
///
/// # Validity
/// One scatter for all conditions. Groups without a common condition, even through others, are linked by nothing: their offsets
/// are relative to different means.
///
/// # Source
/// Random effects beside fixed effects with their likelihood restricted to contrasts: Patterson & Thompson 1971,
/// doi:10.1093/biomet/58.3.545. Checked by `tests::the_bayes_factor_is_that_of_the_multivariate_normal` and the tests beside it.
pub fn group_offsets(
    values: &[f64],
    conditions: &[usize],
    groups: &[usize],
) -> Result<GroupOffsets, NoGroupOffsets> {
    let repeats = Repeats::new(values, conditions, groups)?;
    let step = MAX_RATIO / RATIOS as f64;
    let at_ratios: Vec<AtRatio> = (0..RATIOS)
        .map(|k| repeats.at_ratio((k as f64 + 0.5) * step))
        .collect();
    let largest = at_ratios.iter().map(|at| at.log_weight).fold(f64::MIN, f64::max);
    let weights: Vec<f64> = at_ratios
        .iter()
        .map(|at| libm::exp(at.log_weight - largest))
        .collect();
    let total: f64 = weights.iter().sum();
    let half_normal = 0.5 * libm::log(2.0 / std::f64::consts::PI);
    let log_bayes_factor = largest + libm::log(total * step) + half_normal;
    let mean = |value: &dyn Fn(&AtRatio) -> f64| {
        let sum: f64 = at_ratios.iter().zip(&weights).map(|(at, w)| w * value(at)).sum();
        sum / total
    };
    let offsets = (0..repeats.vectors.nrows()).map(|group| {
        let moments = |at: &AtRatio| repeats.offset(group, at);
        repeats.is_linked(group).then(|| {
            let offset = mean(&|at| moments(at).0);
            let variance = mean(&|at| moments(at).1 + (moments(at).0 - offset).powi(2));
            GroupOffset {
                mean: offset,
                sd: variance.sqrt(),
            }
        })
    });
    Ok(GroupOffsets {
        log_bayes_factor,
        probability: 1.0 / (1.0 + libm::exp(-log_bayes_factor)),
        offset_sd: mean(&|at| at.ratio * repeats.scatter(at.squares)),
        repeat_sd: mean(&|at| repeats.scatter(at.squares)),
        repeat_sd_without: repeats.scatter(repeats.squares),
        offsets: offsets.collect(),
    })
}

/// Differences of repeats from the means of their conditions, along the combinations of offsets that change them.
struct Repeats {
    /// Sum of their squares.
    squares: f64,
    /// Number of values minus number of conditions.
    freedom: usize,
    /// For each combination, its eigenvalue of W and the projection of the differences on it.
    combinations: Vec<(f64, f64)>,
    /// The combinations as columns, a row for each group.
    vectors: DMatrix<f64>,
}

/// The integrand at one ratio of the offsets' sd to the scatter.
struct AtRatio {
    ratio: f64,
    /// Logarithm of the likelihood, relative to that without offsets, times the prior's exponential.
    log_weight: f64,
    /// Sum of squares that the offsets leave.
    squares: f64,
}

impl Repeats {
    fn new(values: &[f64], conditions: &[usize], groups: &[usize]) -> Result<Self, NoGroupOffsets> {
        let (count, group_count) = (values.len(), groups.iter().map(|g| g + 1).max().unwrap_or(0));
        let mut differences = DVector::from_column_slice(values);
        let mut columns = DMatrix::from_fn(count, group_count, |i, g| f64::from(u8::from(groups[i] == g)));
        let mut stated = 0;
        for condition in 0..conditions.iter().map(|c| c + 1).max().unwrap_or(0) {
            let members: Vec<usize> = (0..count).filter(|&i| conditions[i] == condition).collect();
            stated += usize::from(!members.is_empty());
            centre(&members, &mut differences);
            for mut column in columns.column_iter_mut() {
                centre(&members, &mut column);
            }
        }
        let freedom = count - stated;
        let squares = differences.dot(&differences);
        if freedom < MIN_FREEDOM {
            return Err(NoGroupOffsets::FewRepeats);
        }
        let size = values.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
        // Differences of this size are the rounding of the means.
        if squares.sqrt() <= 1e-12 * size {
            return Err(NoGroupOffsets::EqualRepeats);
        }
        let eigen = SymmetricEigen::new(columns.tr_mul(&columns));
        let (combinations, kept) = effective(&eigen, &columns.tr_mul(&differences));
        match combinations.len() {
            0 => Err(NoGroupOffsets::GroupsFollowConditions),
            count if count >= freedom => Err(NoGroupOffsets::NoRepeatWithinGroup),
            _ => Ok(Repeats {
                squares,
                freedom,
                combinations,
                vectors: eigen.eigenvectors.select_columns(&kept),
            }),
        }
    }

    fn at_ratio(&self, ratio: f64) -> AtRatio {
        let (mut squares, mut log_determinant) = (self.squares, 0.0);
        for &(eigenvalue, projection) in &self.combinations {
            squares -= projection * projection * shrunk(ratio, eigenvalue);
            log_determinant += libm::log1p(ratio * ratio * eigenvalue);
        }
        let log_likelihood =
            -0.5 * (log_determinant + self.freedom as f64 * libm::log(squares / self.squares));
        AtRatio {
            ratio,
            log_weight: log_likelihood - 0.5 * ratio * ratio,
            squares,
        }
    }

    /// Returns the posterior mean of the scatter where the offsets leave this sum of squares.
    fn scatter(&self, squares: f64) -> f64 {
        let half = 0.5 * self.freedom as f64;
        (0.5 * squares).sqrt() * libm::exp(libm::lgamma(half - 0.5) - libm::lgamma(half))
    }

    /// Returns mean and variance of a group's offset at a ratio.
    fn offset(&self, group: usize, at: &AtRatio) -> (f64, f64) {
        let (mut mean, mut variance) = (0.0, 0.0);
        for (k, &(eigenvalue, projection)) in self.combinations.iter().enumerate() {
            let (share, shrunk) = (self.vectors[(group, k)], shrunk(at.ratio, eigenvalue));
            mean += share * shrunk * projection;
            variance += share * share * shrunk;
        }
        (mean, variance * at.squares / (self.freedom as f64 - 2.0))
    }

    fn is_linked(&self, group: usize) -> bool {
        self.vectors.row(group).norm_squared() > NO_EFFECT
    }
}

/// Returns eigenvalue and projection of each combination of offsets that changes differences of repeats, and their positions.
fn effective(
    eigen: &SymmetricEigen<f64, nalgebra::Dyn>,
    products: &DVector<f64>,
) -> (Vec<(f64, f64)>, Vec<usize>) {
    let kept: Vec<usize> = (0..eigen.eigenvalues.len())
        .filter(|&k| eigen.eigenvalues[k] > NO_EFFECT)
        .collect();
    let combination = |&k: &usize| {
        let projection = eigen.eigenvectors.column(k).dot(products);
        (eigen.eigenvalues[k], projection)
    };
    (kept.iter().map(combination).collect(), kept)
}

/// Returns `r^2 / (1 + r^2 l)`.
fn shrunk(ratio: f64, eigenvalue: f64) -> f64 {
    let square = ratio * ratio;
    square / (1.0 + square * eigenvalue)
}

/// Subtracts from some entries their mean.
fn centre<S: nalgebra::StorageMut<f64, nalgebra::Dyn>>(
    members: &[usize],
    entries: &mut nalgebra::Vector<f64, nalgebra::Dyn, S>,
) {
    let mean = members.iter().map(|&i| entries[i]).sum::<f64>() / members.len() as f64;
    for &i in members {
        entries[i] -= mean;
    }
}

#[cfg(test)]
mod tests {
    use statistics::rng::Stream;

    use super::*;

    /// Number of conditions, each measured three times, and of groups.
    const CONDITIONS: usize = 20;
    const GROUPS: usize = 6;

    /// Returns conditions and groups of 60 measurements, the groups at random.
    fn plan(stream: &mut Stream) -> (Vec<usize>, Vec<usize>) {
        let conditions: Vec<usize> = (0..3 * CONDITIONS).map(|i| i / 3).collect();
        let groups = conditions.iter().map(|_| stream.below(GROUPS)).collect();
        (conditions, groups)
    }

    /// Returns measurements with a scatter of 0.4 about means of conditions, and with offsets of the groups.
    fn measured(conditions: &[usize], groups: &[usize], offsets: &[f64], stream: &mut Stream) -> Vec<f64> {
        let scatter = stream.normals(conditions.len());
        let value = |i: usize| 3.0 * conditions[i] as f64 + offsets[groups[i]] + 0.4 * scatter[i];
        (0..conditions.len()).map(value).collect()
    }

    #[test]
    fn planted_offsets_are_recovered() {
        let mut stream = Stream::new(1, 0, 0, 0);
        let (conditions, groups) = plan(&mut stream);
        let planted = [0.9, -0.8, 0.1, -0.6, 0.7, -0.3];
        let found = group_offsets(
            &measured(&conditions, &groups, &planted, &mut stream),
            &conditions,
            &groups,
        )
        .unwrap();
        assert!(found.probability > 0.999, "{found:?}");
        assert!((0.3..0.5).contains(&found.repeat_sd), "{found:?}");
        assert!(found.repeat_sd_without > 1.4 * found.repeat_sd, "{found:?}");
        assert!((0.4..1.2).contains(&found.offset_sd), "{found:?}");
        for (planted, found) in planted.iter().zip(&found.offsets) {
            let found = found.unwrap();
            assert!(
                (found.mean - planted).abs() < 3.0 * found.sd && found.sd < 0.3,
                "{planted}: {found:?}"
            );
        }
    }

    #[test]
    fn shuffled_groups_have_no_offsets() {
        let mut stream = Stream::new(2, 0, 0, 0);
        let (conditions, groups) = plan(&mut stream);
        let values = measured(
            &conditions,
            &groups,
            &[0.9, -0.8, 0.1, -0.6, 0.7, -0.3],
            &mut stream,
        );
        let mut probabilities: Vec<f64> = (0..100)
            .map(|number| {
                let (mut left, mut stream) = (groups.clone(), Stream::new(3, 0, number, 0));
                let mut shuffled = Vec::new();
                while !left.is_empty() {
                    shuffled.push(left.swap_remove(stream.below(left.len())));
                }
                group_offsets(&values, &conditions, &shuffled)
                    .unwrap()
                    .probability
            })
            .collect();
        probabilities.sort_by(f64::total_cmp);
        // Where nothing is there, a probability above 0.8 needs a Bayes factor above 4, which has a chance of at most 1 in 4.
        let claims = probabilities.iter().filter(|&&p| p > 0.8).count();
        assert!(
            claims <= 4 && probabilities[50] < 0.5,
            "{claims}: {probabilities:?}"
        );
    }

    #[test]
    fn scatter_alone_gives_no_offsets() {
        let mut stream = Stream::new(4, 0, 0, 0);
        let (conditions, groups) = plan(&mut stream);
        let found = group_offsets(
            &measured(&conditions, &groups, &[0.0; GROUPS], &mut stream),
            &conditions,
            &groups,
        )
        .unwrap();
        assert!(found.probability < 0.5, "{found:?}");
        assert!((0.3..0.5).contains(&found.repeat_sd_without), "{found:?}");
    }

    /// Compares with the density of the contrasts under a covariance matrix, integrated over the logarithm of the scatter.
    #[test]
    fn the_bayes_factor_is_that_of_the_multivariate_normal() {
        let (conditions, groups) = ([0, 0, 0, 1, 1, 1, 1], [0, 1, 1, 0, 0, 1, 2]);
        let values = [1.0, 1.9, 2.2, 5.1, 4.7, 6.0, 5.4];
        // Orthonormal contrasts within the conditions (Helmert).
        let mut contrasts = DMatrix::zeros(5, 7);
        for (row, (first, before)) in [(0, 1), (0, 2), (3, 1), (3, 2), (3, 3)].into_iter().enumerate() {
            let size = ((before * (before + 1)) as f64).sqrt();
            for i in first..first + before {
                contrasts[(row, i)] = 1.0 / size;
            }
            contrasts[(row, first + before)] = -(before as f64) / size;
        }
        let y = &contrasts * DVector::from_column_slice(&values);
        let z = &contrasts * DMatrix::from_fn(7, 3, |i, g| f64::from(u8::from(groups[i] == g)));
        let evidence = |ratio: f64| {
            let covariance = DMatrix::identity(5, 5) + ratio * ratio * &z * z.transpose();
            let factor = nalgebra::Cholesky::new(covariance).unwrap();
            let quadratic = y.dot(&factor.solve(&y));
            let density = |log_scatter: f64| {
                let variance = libm::exp(2.0 * log_scatter);
                libm::exp(-0.5 * quadratic / variance - 5.0 * log_scatter)
            };
            let integral: f64 = (0..4000).map(|k| density(-10.0 + 0.005 * f64::from(k))).sum();
            integral / factor.determinant().sqrt()
        };
        let (mut with, step) = (0.0, 0.01);
        for k in 0..600 {
            let ratio = step * (f64::from(k) + 0.5);
            let prior = (2.0 / std::f64::consts::PI).sqrt() * libm::exp(-0.5 * ratio * ratio);
            with += step * prior * evidence(ratio);
        }
        let expected = libm::log(with / evidence(0.0));
        let found = group_offsets(&values, &conditions, &groups).unwrap();
        assert!(
            (found.log_bayes_factor - expected).abs() < 1e-4,
            "{expected}: {found:?}"
        );
    }

    #[test]
    fn confounded_measurements_are_refused_with_their_reason() {
        let values = [1.0, 1.2, 0.9, 5.0, 5.1, 5.3];
        let with = |conditions: [usize; 6], groups: [usize; 6]| group_offsets(&values, &conditions, &groups);
        let in_two = [0, 0, 0, 1, 1, 1];
        assert_eq!(with(in_two, in_two), Err(NoGroupOffsets::GroupsFollowConditions));
        assert_eq!(
            with(in_two, [0, 1, 2, 3, 4, 5]),
            Err(NoGroupOffsets::NoRepeatWithinGroup)
        );
        assert_eq!(with([0, 1, 2, 3, 4, 4], in_two), Err(NoGroupOffsets::FewRepeats));
        let equal = group_offsets(&[0.1; 6], &in_two, &[0, 0, 1, 0, 0, 1]);
        assert_eq!(equal, Err(NoGroupOffsets::EqualRepeats));
        // The last group measures a condition that no other measures, so nothing is known about its offset.
        let linked = with([0, 0, 0, 0, 1, 1], [0, 0, 1, 1, 2, 2]).unwrap().offsets;
        let is_linked: Vec<bool> = linked.iter().map(Option::is_some).collect();
        assert_eq!(is_linked, [true, true, false]);
    }
}
