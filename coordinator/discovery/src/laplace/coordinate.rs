//! The coordinates of a fit: parameters transformed so that every prior is standard normal or half-normal.

use statistics::prior::{Marginal, Prior, normal};

use crate::candidate::Candidate;
use crate::settings::Smoothness;

/// Limit of the search, in standard deviations of the prior.
const FARTHEST: f64 = 7.5;
/// A parameter of the best fit within this distance from the limit \[standard deviations\] contradicts its prior: a better fit may
/// lie beyond.
const NEAR_LIMIT: f64 = 1.0;
/// A strength of an effect farther out in its prior contradicts what is known of the effect \[standard deviations\].
const MAX_STRENGTH: f64 = 5.0;
/// A support ends at a place if its end, in the sampling coordinate, lies no farther away than this share of the distance from -1 to 1 sd.
const BEYOND: f64 = 0.01;

/// The map from a parameter to its coordinate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    /// Standard normal, with `Phi(t) = P(X < x)`.
    Both,
    /// Half-normal and 0 at the lower end of the support, with `2 Phi(t) - 1 = P(X < x)`.
    Above,
    /// Half-normal and 0 at the upper end of the support.
    Below,
}

/// One parameter and its coordinate.
#[derive(Debug, Clone)]
pub(crate) struct NormalCoordinate {
    pub(crate) marginal: Marginal,
    side: Side,
}

/// The parameters of the base model followed by those of the candidates added to it.
#[derive(Debug, Clone)]
pub(crate) struct NormalFrame {
    pub(crate) coordinates: Vec<NormalCoordinate>,
    /// Prior of the base model; its correlations relate the coordinates to the normal scores of the parameters.
    base: Prior,
    /// Whether the predictions are a smooth function of the parameters.
    pub(crate) smoothness: Smoothness,
    /// Whether the low-fidelity model has the base and every added candidate.
    pub(crate) has_low_fidelity: bool,
    /// Index of each strength of the last candidate, and its coordinate at which the candidate is absent.
    pub(crate) strengths: Vec<(usize, f64)>,
    /// Indices of the single strengths of all candidates, whose priors are widened.
    pub(crate) widened: Vec<usize>,
}

impl NormalCoordinate {
    fn whole(marginal: &Marginal) -> Self {
        Self {
            marginal: marginal.clone(),
            side: Side::Both,
        }
    }

    /// Returns the normal score of x, without limits.
    fn score(&self, x: f64) -> f64 {
        let [below, above] = self.marginal.tails(x);
        match self.side {
            Side::Both => self.marginal.normal_score(x),
            Side::Above => -normal::lower_quantile((0.5 * above).max(f64::MIN_POSITIVE)),
            Side::Below => -normal::lower_quantile((0.5 * below).max(f64::MIN_POSITIVE)),
        }
    }

    /// Returns the coordinate of a normal score, within the limits of the search.
    fn limited(&self, t: f64) -> f64 {
        t.max(self.lower()).min(FARTHEST)
    }

    /// Returns the coordinate of x.
    pub(crate) fn position(&self, x: f64) -> f64 {
        self.limited(self.score(x))
    }

    /// Returns the value of a parameter at a coordinate.
    pub(crate) fn value(&self, t: f64) -> f64 {
        match self.side {
            Side::Both => self.marginal.from_normal_score(t),
            Side::Above => self.marginal.quantile(1.0 - 2.0 * normal::cdf(-t)),
            Side::Below => self.marginal.quantile(2.0 * normal::cdf(-t)),
        }
    }

    /// Returns whether a coordinate lies practically at a bound of the support, as a far coordinate of a uniform prior does.
    fn ends_at(&self, t: f64) -> bool {
        let (lower, upper) = self.marginal.support();
        let end = self.marginal.coordinate(if t < 0.0 { lower } else { upper });
        let [place, low, high] = [t, -1.0, 1.0].map(|t| self.marginal.coordinate(self.value(t)));
        (end - place).abs() <= BEYOND * (high - low)
    }

    fn lower(&self) -> f64 {
        match self.side {
            Side::Both => -FARTHEST,
            Side::Above | Side::Below => 0.0,
        }
    }

    fn is_half(&self) -> bool {
        self.side != Side::Both
    }
}

impl NormalFrame {
    pub(crate) fn base(prior: &Prior, smoothness: Smoothness) -> Self {
        Self {
            coordinates: prior.marginals().iter().map(NormalCoordinate::whole).collect(),
            base: prior.clone(),
            smoothness,
            has_low_fidelity: false,
            strengths: Vec::new(),
            widened: Vec::new(),
        }
    }

    /// Returns this frame, with or without a low-fidelity model.
    pub(crate) fn with_low_fidelity(self, has_low_fidelity: bool) -> Self {
        Self {
            has_low_fidelity,
            ..self
        }
    }

    /// Returns this frame with the coordinates of a candidate appended.
    pub(crate) fn with(&self, candidate: &Candidate) -> Self {
        let mut coordinates = self.coordinates.clone();
        let first = coordinates.len();
        coordinates.extend(candidate.parameters.iter().map(NormalCoordinate::whole));
        let mut neutral = |strength: &usize| {
            let coordinate = &mut coordinates[first + strength];
            let (lower, upper) = coordinate.marginal.support();
            let absent = if candidate.neutral <= lower {
                coordinate.side = Side::Above;
                0.0
            } else if candidate.neutral >= upper {
                coordinate.side = Side::Below;
                0.0
            } else {
                coordinate.position(candidate.neutral)
            };
            (first + strength, absent)
        };
        let strengths: Vec<(usize, f64)> = candidate.strengths.iter().map(&mut neutral).collect();
        let mut widened = self.widened.clone();
        // The prior of a curve's knots is not widened: it was chosen for this purpose.
        if let [(only, _)] = strengths.as_slice() {
            widened.push(*only);
        }
        Self {
            coordinates,
            base: self.base.clone(),
            smoothness: self.smoothness,
            // A switch has no step along which the low-fidelity model could be a control variate.
            has_low_fidelity: self.has_low_fidelity && candidate.has_low_fidelity && !candidate.is_switch(),
            strengths,
            widened,
        }
    }

    /// Returns the strength, if the candidate has a single one.
    pub(crate) fn strength(&self) -> Option<(usize, f64)> {
        match self.strengths.as_slice() {
            [only] => Some(*only),
            _ => None,
        }
    }

    /// Returns whether the last candidate is a switch, without parameters.
    pub(crate) fn is_switch(&self) -> bool {
        self.strengths.is_empty()
    }

    /// Returns whether a coordinate is a strength of the last candidate.
    pub(crate) fn is_strength(&self, k: usize) -> bool {
        self.strengths.iter().any(|(strength, _)| *strength == k)
    }

    /// Returns the half-normal coordinates.
    pub(crate) fn halves(&self) -> Vec<usize> {
        let all = self.coordinates.iter().enumerate();
        all.filter(|(_, coordinate)| coordinate.is_half())
            .map(|(k, _)| k)
            .collect()
    }

    /// Returns a position with the last candidate absent.
    pub(crate) fn without(&self, position: &[f64]) -> Vec<f64> {
        let mut absent = position.to_vec();
        for &(k, neutral) in &self.strengths {
            absent[k] = neutral;
        }
        absent
    }

    pub(crate) fn dimension(&self) -> usize {
        self.coordinates.len()
    }

    /// Returns the largest distance of a strength of the last candidate from the middle of its prior, in standard deviations.
    pub(crate) fn strength_distance(&self, position: &[f64]) -> f64 {
        let distances = self.strengths.iter().map(|&(k, _)| position[k].abs());
        distances.fold(0.0, f64::max)
    }

    /// Returns whether the single strength is half-normal.
    pub(crate) fn is_one_sided(&self) -> bool {
        self.strength()
            .is_some_and(|(k, _)| self.coordinates[k].is_half())
    }

    /// Returns the parameters at a position.
    pub(crate) fn theta(&self, position: &[f64]) -> Vec<f64> {
        let mut scores = position.to_vec();
        self.base.make_dependent(&mut scores);
        let pairs = self.coordinates.iter().zip(scores);
        pairs.map(|(coordinate, t)| coordinate.value(t)).collect()
    }

    /// Returns the position of parameters, within the limits of the search.
    pub(crate) fn position(&self, theta: &[f64]) -> Vec<f64> {
        let pairs = self.coordinates.iter().zip(theta);
        let mut position: Vec<f64> = pairs.map(|(coordinate, &x)| coordinate.score(x)).collect();
        self.base.make_independent(&mut position);
        let limited = self.coordinates.iter().zip(position);
        limited.map(|(coordinate, t)| coordinate.limited(t)).collect()
    }

    /// Returns the distance of each coordinate from its lower and upper limit.
    pub(crate) fn room(&self, position: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let pairs = || self.coordinates.iter().zip(position);
        (
            pairs().map(|(coordinate, t)| coordinate.lower() - t).collect(),
            pairs().map(|(_, t)| FARTHEST - t).collect(),
        )
    }

    /// Returns whether a position is within the limits.
    pub(crate) fn holds(&self, position: &[f64]) -> bool {
        let (lower, upper) = self.room(position);
        lower.iter().all(|l| *l <= 0.0) && upper.iter().all(|u| *u >= 0.0)
    }

    /// Returns the parameter of the base whose value is least plausible under its prior, and its coordinate. `None` if there is
    /// none; a bound that the user declared is no contradiction.
    pub(crate) fn implausible(&self, position: &[f64]) -> Option<(usize, f64)> {
        let base = self.coordinates.iter().zip(position).take(self.base.dimension());
        let far = base
            .enumerate()
            .filter(|(_, (coordinate, t))| t.abs() > FARTHEST - NEAR_LIMIT && !coordinate.ends_at(**t));
        far.map(|(k, (_, t))| (k, *t))
            .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
    }

    /// Returns the strength of an added effect that lies farthest out in its prior, and its coordinate. `None` if none is more than 5
    /// standard deviations out; a declared bound is no contradiction.
    ///
    /// # Arguments
    /// - `counts`: whether each added candidate with a single strength counts, in their order.
    pub(crate) fn implausible_strength(&self, position: &[f64], counts: &[bool]) -> Option<(usize, f64)> {
        let strengths = self.widened.iter().zip(counts).filter(|(_, counts)| **counts);
        let strengths = strengths.map(|(&k, _)| (k, position[k]));
        let far = strengths.filter(|(k, t)| t.abs() > MAX_STRENGTH && !self.coordinates[*k].ends_at(*t));
        far.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
    }

    /// The largest distance of a strength of the added effects from the middle of its prior, in standard deviations.
    pub(crate) fn largest_strength(&self, position: &[f64]) -> f64 {
        self.widened
            .iter()
            .map(|&k| position[k].abs())
            .fold(0.0, f64::max)
    }

    /// Whether each parameter lies within 2 % of a bound of its range, or at the value at which a half-normal strength is absent.
    pub(crate) fn at_bound(&self, position: &[f64]) -> Vec<bool> {
        let near = |((coordinate, x), &t): ((&NormalCoordinate, f64), &f64)| {
            coordinate.marginal.at_bound(x, x) || (coordinate.is_half() && t <= 0.0)
        };
        let values = self.coordinates.iter().zip(self.theta(position));
        values.zip(position).map(near).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use statistics::prior::Distribution;

    #[test]
    fn a_half_normal_strength_is_its_own_coordinate_in_units_of_its_scale() {
        let half = Marginal::new(Distribution::HalfNormal { scale: 3.0 }, None).unwrap();
        let effect = Candidate::new("e", vec![half], vec![0]);
        let frame = NormalFrame::base(&Prior::new(Vec::new()), Smoothness::Smooth).with(&effect);
        for t in [0.0, 0.1, 1.0, 2.5, 5.0] {
            let x = frame.theta(&[t])[0];
            assert!((x - 3.0 * t).abs() < 1e-6, "{x} at {t}");
            assert!((frame.position(&[x])[0] - t).abs() < 1e-6);
        }
        assert!(frame.is_one_sided() && frame.halves() == [0]);
    }

    #[test]
    fn a_prior_is_contradicted_near_the_limit_of_the_search_unless_its_support_ends_there() {
        let far = |distribution, bounds, t: f64| {
            let marginal = Marginal::new(distribution, bounds).unwrap();
            let frame = NormalFrame::base(&Prior::new(vec![marginal]), Smoothness::Smooth);
            frame.implausible(&[t])
        };
        let normal = Distribution::Normal { mean: 1.0, sd: 0.1 };
        assert_eq!(far(normal, None, 6.4), None);
        assert_eq!(far(normal, None, -7.0), Some((0, -7.0)));
        assert_eq!(far(normal, Some([0.9, 2.0]), -7.0), None);
        let factor = Distribution::Lognormal {
            median: 2.0,
            factor: 3.0,
        };
        assert_eq!(far(factor, None, -7.0), Some((0, -7.0)));
        let range = Distribution::Uniform {
            lower: -1.0,
            upper: 2.0,
        };
        assert_eq!(far(range, None, 7.5), None);
    }

    #[test]
    fn correlated_parameters_have_independent_coordinates() {
        let normal = |mean, sd| Marginal::new(Distribution::Normal { mean, sd }, None).unwrap();
        let prior = Prior::new(vec![normal(1.0, 2.0), normal(0.0, 1.0)]);
        let prior = prior
            .correlated(vec![0, 1], &[vec![1.0, 0.6], vec![0.6, 1.0]])
            .unwrap();
        let frame = NormalFrame::base(&prior, Smoothness::Smooth);
        // Given the first, the second has the mean 0.6 t and the sd 0.8.
        let theta = frame.theta(&[1.0, -0.5]);
        assert!(
            (theta[0] - 3.0).abs() < 1e-9 && (theta[1] - 0.2).abs() < 1e-9,
            "{theta:?}"
        );
        let back = frame.position(&theta);
        assert!(
            (back[0] - 1.0).abs() < 1e-9 && (back[1] + 0.5).abs() < 1e-9,
            "{back:?}"
        );
    }

    #[test]
    fn a_strength_of_either_sign_is_absent_at_the_score_of_its_neutral_value() {
        let normal = Marginal::new(Distribution::Normal { mean: 1.0, sd: 2.0 }, None).unwrap();
        let effect = Candidate::new("e", vec![normal], vec![0]);
        let frame = NormalFrame::base(&Prior::new(Vec::new()), Smoothness::Smooth).with(&effect);
        let (_, neutral) = frame.strength().unwrap();
        assert!((neutral + 0.5).abs() < 1e-12 && !frame.is_one_sided());
    }
}
