//! Monod's law in a fed-batch reactor, found from the substrate alone by experiments that are designed one after the other.
//!
//! Substrate Cs \[g/L\], biomass Cx \[g/L\] and volume V \[L\] follow
//!
//! ```text
//! dCs/dt = -(mu / y + m) Cx + Q / V (50 - Cs),   dCx/dt = mu Cx - Q / V Cx,   dV/dt = Q
//! ```
//!
//! with the growth rate mu = 0.421 Cs / (4.39 + Cs) \[1/h\], which is unknown, and the yield y and maintenance m, which are unknown, too.
//! The feed Q \[L/h\] is constant in each of 15 hours, 0 in the first experiment. Cs is measured each hour with an sd of 0.1 g/L.
//!
//! The prior of ln y is normal about ln 0.6 with an sd of 0.5, that of m normal about 0 with an sd of 0.05 /h. Measurements and fits are
//! integrated with the same steps of an eighth of an hour, at whose ends the feed jumps.
//!
//! # Source
//! Documentation of `SciML`, "Optimal data gathering for missing physics": equations, values, and the plan of the experiments.

use equation::{FormulaLibrary, Link};
use statistics::rng::Stream;

use super::design;
use super::dynamic_system::{DynamicSystem, Experiment, State};
use super::least_squares::{Coordinate, fit};
use super::located_law::{LocatedLaw, interpolated, located};
use super::truth::Truth;
use super::weighed::{WeighedFormula, class_probabilities, weighed};

const HOURS: usize = 15;
const MAX_FEED_L_H: f64 = 10.0;
const FEED_CONCENTRATION: f64 = 50.0;
const INITIAL: State = [1.0, 1.0, 7.0, 0.0];
const YIELD: f64 = 0.777;
const MAINTENANCE: f64 = 0.0;
const SD: f64 = 0.1;
/// A guess of the largest growth rate \[1/h\].
const GROWTH: f64 = 0.3;
const KNOTS: usize = 6;
/// Feeds that are compared for the next experiment.
const FEEDS: u64 = 200;
/// The most experiments that are designed.
pub const DESIGNED: usize = 3;
/// A class is named from this probability on.
pub const NAMED: f64 = 0.9;
/// The log Bayes factor from which a law is claimed.
const CLAIMED: f64 = 3.0;

/// The growth rate of the truth \[1/h\].
pub fn monod(substrate: f64) -> f64 {
    0.421 * substrate / (4.39 + substrate)
}

/// Returns the reactor. Its parameters are ln y and m; the growth rate is the law.
fn reactor() -> DynamicSystem {
    DynamicSystem {
        rates: |time, state, parameters, feed, growth| {
            let [substrate, biomass, volume, _] = *state;
            let feed = feed[(time as usize).min(HOURS - 1)];
            [
                -(growth / libm::exp(parameters[0]) + parameters[1]) * biomass
                    + feed / volume * (FEED_CONCENTRATION - substrate),
                growth * biomass - feed / volume * biomass,
                feed,
                0.0,
            ]
        },
        variable: 0,
        priors: vec![[libm::log(0.6), 0.5], [0.0, 0.05]],
        measured: 0,
        sd: SD,
        step: 0.125,
    }
}

impl Experiment {
    /// Returns an experiment with a feed, unmeasured.
    fn fed(feed: Vec<f64>) -> Self {
        Experiment {
            initial: INITIAL,
            inputs: feed,
            times: (0..=HOURS).map(|hour| hour as f64).collect(),
            values: Vec::new(),
        }
    }
}

/// Returns an experiment with a feed, and with noise by its number.
fn measured(system: &DynamicSystem, feed: Vec<f64>, seed: u64, number: u64) -> Option<Experiment> {
    let mut experiment = Experiment::fed(feed);
    let exact = system.predict(monod, &[libm::log(YIELD), MAINTENANCE], &experiment)?;
    let noise = Stream::new(seed, 0, number, 0).normals(exact.len());
    experiment.values = exact.iter().zip(noise).map(|(value, e)| value + SD * e).collect();
    Some(experiment)
}

/// Draws a feed: one to five levels, each for some hours, and a third of them with pauses.
fn drawn_feed(seed: u64, round: u64, number: u64) -> Vec<f64> {
    let mut stream = Stream::new(seed, 1, number, round);
    let levels = 1 + stream.below(5);
    let ends: Vec<usize> = (0..levels).map(|_| stream.below(HOURS)).collect();
    let heights: Vec<f64> = (0..=levels)
        .map(|_| {
            if stream.uniform() < 0.33 {
                0.0
            } else {
                MAX_FEED_L_H * stream.uniform() * stream.uniform()
            }
        })
        .collect();
    (0..HOURS)
        .map(|hour| heights[ends.iter().filter(|end| **end <= hour).count()])
        .collect()
}

/// What the experiments say of the growth rate.
pub struct Finding {
    pub law: LocatedLaw,
    pub formulas: Vec<WeighedFormula>,
    /// Probability of each class.
    pub classes: Vec<f64>,
    /// Whether each class has Monod's law in it.
    pub is_true: Vec<bool>,
}

fn find(system: &DynamicSystem, experiments: &[Experiment], library: &FormulaLibrary) -> Option<Finding> {
    let highest = experiments
        .iter()
        .flat_map(|e| &e.values)
        .fold(0.0_f64, |highest, value| highest.max(*value));
    let knots: Vec<f64> = (0..KNOTS)
        .map(|k| highest * libm::pow(k as f64 / (KNOTS - 1) as f64, 1.5))
        .collect();
    let law = located(system, experiments, &knots, GROWTH)?;
    let formulas = weighed(system, experiments, &law, library);
    let classes = class_probabilities(&formulas);
    let truth = Truth::new(monod, law.curve.range(), 1);
    let of_class = |class: usize| {
        formulas
            .iter()
            .any(|f| f.class == class && truth.is(&f.tree, Link::Proportional))
    };
    let is_true = (0..classes.len()).map(of_class).collect();
    Some(Finding {
        law,
        formulas,
        classes,
        is_true,
    })
}

/// Returns the feed of the experiment that separates the leading classes best.
fn designed(system: &DynamicSystem, finding: &Finding, seed: u64, round: u64) -> Vec<f64> {
    let feeds = (0..FEEDS).map(|number| drawn_feed(seed, round, number));
    let experiments: Vec<Experiment> = feeds.map(Experiment::fed).collect();
    let best = design::best(system, &finding.formulas, &experiments);
    experiments[best.unwrap_or(0)].inputs.clone()
}

/// The course of one campaign.
pub struct Campaign {
    /// The finding after each experiment, the first without feed, with the feed.
    pub steps: Vec<(Vec<f64>, Finding)>,
}

impl Campaign {
    /// Returns the number of designed experiments after which a class was named, and whether it has Monod's law; `None` without a name.
    /// The first experiment names nothing, because its substrate stays below 1 g/L, where nearly every law is straight.
    pub fn named(&self) -> Option<(usize, bool)> {
        let named = |finding: &Finding| finding.classes.first().is_some_and(|p| *p >= NAMED);
        let at = 1 + self
            .steps
            .iter()
            .skip(1)
            .position(|(_, finding)| named(finding))?;
        Some((at, self.steps[at].1.is_true[0]))
    }
}

/// Runs a campaign until a class is named or [`DESIGNED`] experiments were designed.
pub fn campaign(seed: u64, library: &FormulaLibrary) -> Option<Campaign> {
    let system = reactor();
    let mut experiments = vec![measured(&system, vec![0.0; HOURS], seed, 0)?];
    let mut campaign = Campaign { steps: Vec::new() };
    let mut feed = vec![0.0; HOURS];
    for round in 0..=DESIGNED {
        let finding = find(&system, &experiments, library)?;
        let next = designed(&system, &finding, seed, round as u64);
        campaign.steps.push((std::mem::replace(&mut feed, next), finding));
        if campaign.named().is_some() || round == DESIGNED {
            break;
        }
        experiments.push(measured(&system, feed.clone(), seed, round as u64 + 1)?);
    }
    Some(campaign)
}

/// Returns the log Bayes factor of a law beyond the growth rate, which is given, over none.
///
/// The law is a factor whose logarithm is a piecewise linear curve with a prior sd of 0.5 at each knot. The experiments are the first one
/// and two with drawn feeds.
pub fn claim_beyond_the_truth(seed: u64) -> Option<f64> {
    let system = reactor();
    let feeds = [vec![0.0; HOURS], drawn_feed(seed, 9, 0), drawn_feed(seed, 9, 1)];
    let measured = feeds
        .into_iter()
        .enumerate()
        .map(|(k, feed)| measured(&system, feed, seed, k as u64));
    let experiments: Vec<Experiment> = measured.collect::<Option<_>>()?;
    let highest = experiments
        .iter()
        .flat_map(|e| &e.values)
        .fold(0.0_f64, |highest, value| highest.max(*value));
    let knots: Vec<f64> = (0..KNOTS)
        .map(|k| highest * k as f64 / (KNOTS - 1) as f64)
        .collect();
    let log_evidence = |count: usize| -> Option<f64> {
        let changes = (0..count).map(|_| Coordinate {
            mean: 0.0,
            sd: 0.5,
            scale: 0.1,
        });
        let coordinates: Vec<Coordinate> = changes.chain(system.coordinates()).collect();
        let start: Vec<f64> = coordinates.iter().map(|c| c.mean).collect();
        let reached = fit(&coordinates, start, 30, |place| {
            let (changes, parameters) = place.split_at(count);
            let law = |x: f64| match count {
                0 => monod(x),
                _ => monod(x) * libm::exp(interpolated(&knots, changes, x)),
            };
            system.residuals(law, parameters, &experiments)
        })?;
        reached.log_evidence(&coordinates)
    };
    Some(log_evidence(KNOTS)? - log_evidence(0)?)
}

/// Returns whether a law beyond the truth is claimed at this log Bayes factor.
pub fn is_claimed(log_bayes_factor: f64) -> bool {
    log_bayes_factor > CLAIMED
}
