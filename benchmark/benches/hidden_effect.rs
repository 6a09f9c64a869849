//! How well the missing effect is found, on experiments whose truth is known.
//!
//! `cargo bench -p benchmark --bench hidden_effect [-- KIND [COUNT [SEED]]]` prints a line for each experiment, and then the measured values
//! beside the targets of the project. KIND is
//! - `one`: each effect of the catalogue in turn; `none`: no effect; `two`, `triple`: several effects, each worth 10 nats beside the others.
//! - `outside`: a law of `laws/`, none of which is in a library. `outlib`: such a law and an effect of the catalogue, each worth 10 nats
//!   beside the other. `twovar`: a law that is a product of factors of two variables, and worth 10 nats beyond every effect of the catalogue.
//! - `geometry`: no effect, but the experiment states the radius of the wheel or of the rig with an error of 5 %, or the width with one of
//!   10 %. A wrong radius of the wheel is fixed in the job, which otherwise infers it.
//! - `sparse`: one effect in 8 runs. `heavy`: one effect, with noise that has the density of Student's t with three degrees of freedom.
//! - `session`: four sessions, each with an offset of one channel or of the soil's stiffness, and the column `session`. Every second
//!   experiment has an effect, which is worth 10 nats.
//! - `calibration`: COUNT experiments of all kinds but `scm` and `session`, a third of which have a law outside the library, and how often statements
//!   are right, by their probability (below).
//! - `one+none`, or another list: COUNT of each. `all`: COUNT of each of these kinds.
//! - `scm`: one effect of the three-dimensional model on a coarse grid.
//! - `ambiguous`: one effect at one load and one speed, and the number of further runs that identify it: proposed runs made one at a time
//!   or two at once, random runs, and runs that fill the space of conditions.
//! - `factorial`: one effect, and the number of runs that identify it: campaigns that begin with six runs and are continued by proposals or at
//!   random, against the factorial of 24 runs of examples/hidden-effect.
//! - `drift`: no effect, but the soil stiffens and the zero of the force sensor moves over the series, with the runs sorted by slip or in
//!   random order, and `order` stated or not. `preparations`: no effect, but a soil preparation for each load and speed, with `prepared`
//!   stated or not. `understated`: no effect, with noise 1.5 times larger than declared.
//! - `untryable`: one effect that needs a property which the experiment does not state.
//! - `reference`: one effect after a reference campaign on the same soil without it, whose posterior is the prior; every fourth campaign
//!   has no effect. The same campaign is also searched without the reference.
//! - `steady`: as `scm`, with the experiments searched one after another as in a study, and the answer, reason and time of each search.
//! - `node`: as `steady`, with Janosi and Hanamoto's law hidden, whose displacement the nodes of the soil keep.
//! - `rolling`: as `steady`, with the default grid of the model and 24 runs.
//! - `changes`: the three-dimensional model as an unknown rig, whose soil has no cohesion and does not flow. A reference campaign is
//!   calibrated and searched. Its posterior is the prior of three more campaigns, in which the soil has a cohesion of 500 Pa, or flows to
//!   the border of the footprint, or both, while the job fixes both at zero. `changes-rolling`: with the default grid and 24 runs.
//! - `tmcmc`: each effect of the catalogue in turn, and its log Bayes factor by the search beside that of full evidences by the sampler.
//!
//! A truth is drawn from the priors of the job and of the effect's file, and run at the conditions of a plan. Noise of 3 % of each
//! channel's root mean square is added, and the search gets only the texts of job and experiment. Rates count the trials in which the best
//! rival outside the class of the truth falls short by 10 nats for noise-free data. The held-out error is that of 16 runs between the
//! fitted ones and slightly beyond, against the truth without noise.
//!
//! A claim is right if it names what is hidden and nothing else: a hidden effect, or a class with a hidden effect in it, or the quantity and
//! the variable of a hidden law. Of a law of two variables the quantity is enough. With a wrong dimension the hidden effect is
//! `wheel_radius_error`, `wheel_width_error` or `slip_radius_error`.
//!
//! `calibration` counts the most probable explanation of each search, whether the verdict claims it or not, and the claims alone. A class is
//! one explanation with the probability of its members together, unless one member has more than 0.9: then this effect is stated, and it is
//! wrong if only another member of its class is hidden. A law that leads without a claim is right if any law is hidden. Where "nothing is
//! missing" leads, the search is counted apart, and is right if nothing is hidden, or nothing that is worth 3 nats in noise-free data.

use std::process::ExitCode;

use benchmark::error::StudyError;
use benchmark::hidden_effect::rig::{self, Flaw};
use benchmark::hidden_effect::study::design::Plan;
use benchmark::hidden_effect::study::draw::draw;
use benchmark::hidden_effect::study::kind::HiddenKind;
use benchmark::hidden_effect::study::score::TrialScore;
use benchmark::hidden_effect::study::tally::Tally;
use benchmark::hidden_effect::study::trial::search;
use benchmark::hidden_effect::{ambiguous, changes, probability, reference, steady, tmcmc};
use benchmark::parallel::each;

/// Default number of trials of a kind.
const COUNT: u64 = 100;

fn main() -> ExitCode {
    let arguments = std::env::args().skip(1).filter(|a| !a.starts_with("--"));
    let arguments: Vec<String> = arguments.collect();
    let number = |k: usize, default: u64| arguments.get(k).map_or(Ok(default), |a| a.parse::<u64>());
    let (Ok(count), Ok(seed)) = (number(1, COUNT), number(2, 1)) else {
        eprintln!("error: COUNT and SEED are whole numbers");
        return ExitCode::FAILURE;
    };
    let done = match arguments.first().map_or("one", String::as_str) {
        "ambiguous" => ambiguous::run(count, seed),
        "factorial" => ambiguous::factorial::run(count, seed),
        "drift" => rig::run(&Flaw::DRIFTS, count, seed),
        "preparations" => rig::run(&[Flaw::Preparations], count, seed),
        "reference" => reference::run(count, seed),
        "steady" => steady::run(Plan::Spatial, None, count, seed),
        "node" => steady::run(Plan::Spatial, Some("janosi_hanamoto_node"), count, seed),
        "rolling" => steady::run(Plan::Rolling, None, count, seed),
        "changes" => changes::run(Plan::Spatial, count, seed),
        "changes-rolling" => changes::run(Plan::Rolling, count, seed),
        "tmcmc" => tmcmc::run(count, seed),
        "understated" => rig::run(&[Flaw::Understated], count, seed),
        "untryable" => rig::untryable::run(count, seed),
        "calibration" => probability::run(count, seed),
        "all" => tables("one+none+outside+two+triple", count, seed),
        kinds => tables(kinds, count, seed),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::FAILURE
        }
    }
}

/// Runs trials of each kind, and prints the targets.
fn tables(kinds: &str, count: u64, seed: u64) -> Result<(), StudyError> {
    let mut all = Vec::new();
    for name in kinds.split('+') {
        let kind = HiddenKind::ALL.into_iter().find(|kind| kind.name() == name);
        let kind = kind.ok_or(format!("unknown kind \"{name}\""))?;
        all.extend(scores(kind, count, seed)?);
    }
    println!("{}", Tally(&all));
    Ok(())
}

/// Runs trials of a kind, and prints each score.
fn scores(kind: HiddenKind, count: u64, seed: u64) -> Result<Vec<TrialScore>, StudyError> {
    let one = |number: u64| {
        let score = draw(kind, seed, number).and_then(|case| search(kind, &case, number));
        let score = score.map_err(|e| StudyError::from(format!("{} {number}: {e}", kind.name())));
        match &score {
            Ok(score) => println!("{score}"),
            Err(message) => println!("failed: {message}"),
        }
        score
    };
    each(count, one)
}
