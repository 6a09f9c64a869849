//! The problems that are sums of squares, for the Levenberg-Marquardt fit.

use inference::lm::{LmFit, LmSettings};
use inference::point_estimate::ModeEstimate;

use crate::output_problems::{self, OutputProblem};

fn fitted(problem: &OutputProblem, seeds: u64) -> Vec<ModeEstimate> {
    let fit = |seed| {
        let settings = LmSettings {
            seed,
            ..LmSettings::default()
        };
        let mut fit = LmFit::new(problem.prior.clone(), problem.likelihood.clone(), settings).unwrap();
        while !fit.round().pending().is_empty() {
            for proposal in fit.round().pending().to_vec() {
                let outputs = (problem.outputs)(&proposal.theta);
                fit.tell(proposal.particle, outputs.as_deref()).unwrap();
            }
        }
        fit.estimate().unwrap().clone()
    };
    (1..=seeds).map(fit).collect()
}

/// Prints a line for each; the optimum is the best that any seed found, which for a and b is the problem's own.
pub(crate) fn print(seeds: u64) {
    for problem in [
        output_problems::correlated_gaussian(),
        output_problems::shear_building(),
        output_problems::bekker_reparametrised(),
    ] {
        let runs = fitted(&problem, seeds);
        let best = runs
            .iter()
            .fold(f64::NEG_INFINITY, |best, run| best.max(run.log_posterior()));
        super::row(problem.name, "lm", best, &runs);
    }
}
