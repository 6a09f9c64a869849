//! The bank of filters, and what it says of the parameters.

use nalgebra::{DMatrix, DVector};
use statistics::Prior;
use statistics::prior::normal::cdf;

use super::change::{Change, Changes};
use super::gaussian::Gaussian;
use super::hypothesis::{Hypothesis, Member};

/// Sizes of the walk: standard deviations of the prior in the square root of a second.
pub const WALK_SIZES: [f64; 5] = [0.0, 0.003, 0.01, 0.03, 0.1];
/// Probability that the parameters that vary are not those of the draws when the recording begins.
const CHANGED_BEFORE: f64 = 0.5;
/// Time over which weights of the sizes are forgotten `[s]`.
const MEMORY_S: f64 = 100.0;
/// Largest number of hypotheses that are kept.
const MAX_HYPOTHESES: usize = 9;
/// Number of blocks for which a hypothesis is kept whatever its weight.
const YOUNG: usize = 4;
/// Least weight of a hypothesis that is not young.
const LEAST_WEIGHT: f64 = 1e-6;
/// Bisections of a quantile.
const BISECTIONS: usize = 32;

/// Settings of a tracker.
#[derive(Debug, Clone)]
pub struct TrackerSettings {
    /// Positions of the parameters that may vary; the others stay what the draws say.
    pub varying: Vec<usize>,
    /// Mean interval of changes `[s]`.
    pub change_interval_s: f64,
    /// Probability above which a change is noted.
    pub bound: f64,
}

/// The mean of some samples.
#[derive(Debug, Clone)]
pub struct Block {
    /// Time since the block before `[s]`.
    pub elapsed_s: f64,
    /// Measured values.
    pub values: Vec<f64>,
    /// Their variances.
    pub variances: Vec<f64>,
}

/// Parameters that are followed through a recording.
///
/// Checked by `tests::intervals_hold_parameters_that_change`, `tests::a_change_is_found_and_none_is_invented` and
/// `tests::the_size_of_a_walk_is_inferred`.
#[derive(Debug, Clone)]
pub struct Tracker {
    prior: Prior,
    covariance: DMatrix<f64>,
    settings: TrackerSettings,
    hypotheses: Vec<Hypothesis>,
    changes: Changes,
    blocks: usize,
    /// Whether a hypothesis has explained a block.
    has_begun: bool,
}

impl Tracker {
    /// Begins with equally weighted draws of the parameters: with equal probabilities they hold in the recording, or the parameters that
    /// vary have been drawn anew.
    ///
    /// # Arguments
    /// - `draws`: at least two parameter vectors.
    #[must_use]
    pub fn new(prior: Prior, draws: &[Vec<f64>], settings: TrackerSettings) -> Self {
        let dimension = prior.dimension();
        let scores = |theta: &Vec<f64>| -> Vec<f64> {
            let marginals = prior.marginals().iter().zip(theta);
            marginals.map(|(marginal, &x)| marginal.normal_score(x)).collect()
        };
        let scores: Vec<Vec<f64>> = draws.iter().map(scores).collect();
        let state = Gaussian::of_draws(&scores, dimension);
        let mut colour = DMatrix::zeros(dimension, dimension);
        for i in 0..dimension {
            let mut unit = vec![0.0; dimension];
            unit[i] = 1.0;
            prior.make_dependent(&mut unit);
            colour.set_column(i, &DVector::from_vec(unit));
        }
        let member = |_: &f64| Member {
            state: state.clone(),
            weight: 1.0 / WALK_SIZES.len() as f64,
        };
        Tracker {
            covariance: &colour * colour.transpose(),
            hypotheses: vec![Hypothesis {
                born: 0,
                members: WALK_SIZES.iter().map(member).collect(),
            }],
            changes: Changes::default(),
            blocks: 0,
            has_begun: false,
            prior,
            settings,
        }
    }

    /// Takes a block. Returns whether a hypothesis explains it; where the model refuses all, the block changes nothing but the time.
    ///
    /// # Arguments
    /// - `model`: from parameters to the values of the block; `None` where it refuses them.
    pub fn take(&mut self, block: &Block, mut model: impl FnMut(&[f64]) -> Option<Vec<f64>>) -> bool {
        self.blocks += 1;
        self.walk(block.elapsed_s);
        let mut hypotheses = self.with_new_draw(block.elapsed_s);
        let values = DVector::from_column_slice(&block.values);
        let variances = DVector::from_column_slice(&block.variances);
        let marginals = self.prior.marginals().to_vec();
        let mut of_scores = |scores: &DVector<f64>| {
            let values = marginals.iter().zip(scores.iter());
            let theta: Vec<f64> = values
                .map(|(marginal, &z)| marginal.from_normal_score(z))
                .collect();
            model(&theta)
        };
        let mut logs = Vec::with_capacity(hypotheses.len());
        for hypothesis in &mut hypotheses {
            let densities = hypothesis.update(&values, &variances, &mut of_scores);
            logs.push(densities.unwrap_or_else(|| vec![f64::NEG_INFINITY; WALK_SIZES.len()]));
        }
        let members = hypotheses.iter().flat_map(|hypothesis| &hypothesis.members);
        let scaled = members.zip(logs.iter().flatten());
        let best = scaled
            .map(|(member, log)| libm::log(member.weight) + log)
            .fold(f64::NEG_INFINITY, f64::max);
        if best == f64::NEG_INFINITY {
            return false;
        }
        self.has_begun = true;
        for (hypothesis, logs) in hypotheses.iter_mut().zip(&logs) {
            for (member, log) in hypothesis.members.iter_mut().zip(logs) {
                member.weight = libm::exp(libm::log(member.weight) + log - best);
            }
        }
        self.hypotheses = kept(hypotheses, self.blocks);
        let born: Vec<(usize, f64)> = self.hypotheses.iter().map(|h| (h.born, h.weight())).collect();
        self.changes.note(self.blocks, &born, self.settings.bound);
        true
    }

    /// Lets the parameters that vary walk for a time.
    fn walk(&mut self, elapsed_s: f64) {
        for hypothesis in &mut self.hypotheses {
            hypothesis.forget(libm::exp(-elapsed_s / MEMORY_S));
            for (member, size) in hypothesis.members.iter_mut().zip(WALK_SIZES) {
                let variance = (size * size * elapsed_s).min(1.0);
                member
                    .state
                    .walk(&self.settings.varying, &self.covariance, variance);
            }
        }
    }

    /// Returns the hypotheses before a block; the last is the new draw.
    fn with_new_draw(&self, elapsed_s: f64) -> Vec<Hypothesis> {
        let hazard = match self.has_begun {
            true => 1.0 - libm::exp(-elapsed_s / self.settings.change_interval_s),
            false => CHANGED_BEFORE,
        };
        let mut all = self.hypotheses.clone();
        let first = &all[0];
        let leading = all
            .iter()
            .fold(first, |best, h| if h.weight() > best.weight() { h } else { best });
        let new = leading.members.iter().enumerate().map(|(k, member)| Member {
            state: member.state.renewed(&self.settings.varying, &self.covariance),
            weight: hazard
                * all
                    .iter()
                    .map(|hypothesis| hypothesis.members[k].weight)
                    .sum::<f64>(),
        });
        let new = Hypothesis {
            born: self.blocks,
            members: new.collect(),
        };
        for member in all.iter_mut().flat_map(|hypothesis| &mut hypothesis.members) {
            member.weight *= 1.0 - hazard;
        }
        all.push(new);
        all
    }

    fn members(&self) -> impl Iterator<Item = &Member> {
        self.hypotheses.iter().flat_map(|hypothesis| &hypothesis.members)
    }

    /// Returns the parameters at the mean of the filter with the largest weight.
    #[must_use]
    pub fn leading(&self) -> Vec<f64> {
        let first = self.hypotheses[0].leader();
        let leader = self.hypotheses.iter().map(Hypothesis::leader);
        let leader = leader.fold(
            first,
            |best, member| if member.weight > best.weight { member } else { best },
        );
        let values = self.prior.marginals().iter().zip(leader.state.mean.iter());
        values
            .map(|(marginal, &z)| marginal.from_normal_score(z))
            .collect()
    }

    /// Returns the quantile of a parameter.
    #[must_use]
    pub fn quantile(&self, parameter: usize, probability: f64) -> f64 {
        let below = |z: f64| {
            let shares = self.members().map(|member| {
                let sd = member.state.covariance[(parameter, parameter)].sqrt().max(1e-9);
                member.weight * cdf((z - member.state.mean[parameter]) / sd)
            });
            shares.sum::<f64>()
        };
        let [mut low, mut high] = [-12.0, 12.0];
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (low + high);
            *(if below(middle) < probability {
                &mut low
            } else {
                &mut high
            }) = middle;
        }
        self.prior.marginals()[parameter].from_normal_score(0.5 * (low + high))
    }

    /// Returns the probability of each of [`WALK_SIZES`].
    #[must_use]
    pub fn walk_probabilities(&self) -> [f64; WALK_SIZES.len()] {
        std::array::from_fn(|k| self.hypotheses.iter().map(|h| h.members[k].weight).sum())
    }

    /// Returns the probability that the parameters have changed since the last change that was noted.
    #[must_use]
    pub fn change_probability(&self) -> f64 {
        let later = self.hypotheses.iter().filter(|h| h.born > self.changes.since);
        later.map(Hypothesis::weight).sum()
    }

    /// Returns the changes so far. The first may be that of block 1: the recording does not begin with the parameters of the draws.
    #[must_use]
    pub fn changes(&self) -> &[Change] {
        &self.changes.found
    }
}

/// Drops the hypotheses of little weight, and makes the weights of the others sum to one.
fn kept(mut hypotheses: Vec<Hypothesis>, now: usize) -> Vec<Hypothesis> {
    let total: f64 = hypotheses.iter().map(Hypothesis::weight).sum();
    let members = hypotheses
        .iter_mut()
        .flat_map(|hypothesis| &mut hypothesis.members);
    members.for_each(|member| member.weight /= total);
    let is_young = |hypothesis: &Hypothesis| hypothesis.born + YOUNG > now;
    hypotheses.retain(|h| h.weight() > LEAST_WEIGHT || h.weight() > 0.0 && is_young(h));
    while hypotheses.len() > MAX_HYPOTHESES {
        let old = hypotheses.iter().enumerate().filter(|(_, h)| !is_young(h));
        let least = old.min_by(|a, b| a.1.weight().total_cmp(&b.1.weight()));
        let Some((least, _)) = least else { break };
        hypotheses.remove(least);
    }
    let total: f64 = hypotheses.iter().map(Hypothesis::weight).sum();
    let members = hypotheses
        .iter_mut()
        .flat_map(|hypothesis| &mut hypothesis.members);
    members.for_each(|member| member.weight /= total);
    hypotheses
}

#[cfg(test)]
mod tests {
    use statistics::rng::Stream;
    use statistics::{Distribution, Marginal};

    use super::*;

    const SDS: [f64; 2] = [0.1, 0.3];

    fn prior() -> Prior {
        let normal = Distribution::Normal { mean: 0.0, sd: 1.0 };
        Prior::new(vec![Marginal::new(normal, None).expect("a prior"); 3])
    }

    /// What two channels show of three parameters at a time; the third parameter does not vary.
    fn channels(theta: &[f64], time: f64) -> Vec<f64> {
        let slope = libm::sin(0.4 * time);
        vec![theta[0] + slope * theta[1], theta[1] - 0.5 * theta[2] + slope]
    }

    /// A recording of 200 blocks: the truth at each time, and the tracker's answer after each.
    struct Followed {
        tracker: Tracker,
        /// Whether the 90 % interval of each varying parameter holds the truth, by block.
        holds: Vec<[bool; 2]>,
    }

    /// Follows parameters that are drawn anew at some blocks and walk between them.
    fn follow(seed: u64, changes: &[usize], walk: f64) -> Followed {
        let mut stream = Stream::new(seed, 1, 0, 0);
        let mut truth = prior().sample(&mut stream);
        // The draws at the beginning know the third parameter, and the others as far as half of the prior's deviation.
        let known: Vec<f64> = (0..3)
            .map(|i| truth[i] + [0.5, 0.5, 0.1][i] * stream.normal_pair().0)
            .collect();
        let draws: Vec<Vec<f64>> = (0..400)
            .map(|i| {
                let z = Stream::new(seed, 2, i, 0).normals(3);
                (0..3).map(|k| known[k] + [0.5, 0.5, 0.1][k] * z[k]).collect()
            })
            .collect();
        let settings = TrackerSettings {
            varying: vec![0, 1],
            change_interval_s: 100.0,
            bound: 0.95,
        };
        let mut tracker = Tracker::new(prior(), &draws, settings);
        let mut holds = Vec::new();
        for block in 0..200 {
            let steps = stream.normals(2);
            for k in 0..2 {
                truth[k] = (1.0 - walk * walk).sqrt() * truth[k] + walk * steps[k];
            }
            if changes.contains(&block) {
                let new = stream.normals(2);
                truth[..2].copy_from_slice(&new);
            }
            let time = block as f64;
            let noise = stream.normals(2);
            let values = channels(&truth, time);
            let block = Block {
                elapsed_s: if block == 0 { 0.0 } else { 1.0 },
                values: (0..2).map(|c| values[c] + SDS[c] * noise[c]).collect(),
                variances: SDS.iter().map(|sd| sd * sd).collect(),
            };
            assert!(tracker.take(&block, |theta| Some(channels(theta, time))));
            holds.push([0, 1].map(|k| {
                let [low, high] = [0.05, 0.95].map(|p| tracker.quantile(k, p));
                (low..=high).contains(&truth[k])
            }));
        }
        Followed { tracker, holds }
    }

    #[test]
    fn intervals_hold_parameters_that_change() {
        for walk in [0.0, 0.03] {
            let [mut held, mut all] = [0, 0];
            for seed in 0..10 {
                let followed = follow(seed, &[70, 140], walk);
                let settled = followed.holds.iter().enumerate().filter(|(i, _)| i % 70 >= 5);
                let of_all: Vec<bool> = settled.flat_map(|(_, holds)| *holds).collect();
                held += of_all.iter().filter(|holds| **holds).count();
                all += of_all.len();
            }
            let coverage = held as f64 / all as f64;
            assert!((0.82..0.96).contains(&coverage), "walk {walk}: {coverage}");
        }
    }

    #[test]
    fn a_change_is_found_and_none_is_invented() {
        let [mut found, mut invented] = [0, 0];
        for seed in 100..110 {
            let with = follow(seed, &[70, 140], 0.0);
            for truth in [71, 141] {
                let changes = with.tracker.changes();
                found += usize::from(
                    changes
                        .iter()
                        .any(|c| c.block.abs_diff(truth) <= 3 && c.found <= truth + 20),
                );
            }
            invented += follow(seed, &[], 0.0).tracker.changes().len();
        }
        assert!(
            found >= 17 && invented == 0,
            "{found} of 20 found, {invented} invented"
        );
    }

    #[test]
    fn the_size_of_a_walk_is_inferred() {
        for (walk, likely) in [(0.0, 0..3), (0.03, 2..4), (0.1, 3..5)] {
            let probabilities = follow(5, &[], walk).tracker.walk_probabilities();
            let share: f64 = probabilities[likely].iter().sum();
            assert!(share > 0.8, "walk {walk}: {probabilities:?}");
        }
    }

    #[test]
    fn a_block_that_the_model_refuses_changes_the_time_alone() {
        let draws = vec![vec![0.0, 0.0, 0.0], vec![0.1, 0.2, 0.1], vec![-0.1, 0.2, 0.3]];
        let settings = TrackerSettings {
            varying: vec![0],
            change_interval_s: 100.0,
            bound: 0.95,
        };
        let mut tracker = Tracker::new(prior(), &draws, settings);
        let block = Block {
            elapsed_s: 1.0,
            values: vec![1.0],
            variances: vec![1.0],
        };
        let before = tracker.quantile(1, 0.5);
        assert!(!tracker.take(&block, |_| None));
        assert!((tracker.quantile(1, 0.5) - before).abs() < 1e-9);
        assert!(tracker.take(&block, |theta| Some(vec![theta[0]])));
    }
}
