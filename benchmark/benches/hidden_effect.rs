//! How well the missing effect is found, on experiments whose truth is known.
//!
//! `cargo bench -p benchmark --bench hidden_effect [-- KIND [COUNT [SEED]]]`, a line for each experiment and then the targets of
//! the project beside what came out. KIND is
//! - `one`: one effect of the catalogue, each in turn; `none`: nothing; `two`, `three`: several, each worth 10 nats beside the others.
//! - `outside`: one of the laws of `laws/`, which are in nobody's library.
//! - `one+none`, or another list: COUNT of each. `all`: of each of these.
//! - `scm`: one effect, of the three-dimensional model on a coarse grid.
//! - `ambiguous`: one effect, at one load and one speed: how many further runs tell what it is, proposed ones made one at a time or
//!   two at once, random ones, and ones that fill the space of conditions.
//! - `drift`: nothing, but the soil stiffens and the force sensor's zero moves over the series, with the runs sorted by slip or in random
//!   order, and `order` stated or not. `preparations`: nothing, but each load and speed has a soil preparation of its own, with
//!   `prepared` stated or not. `understated`: nothing, with noise 1.5 times larger than declared.
//! - `untryable`: one effect that needs what the experiment does not state.
//! - `reference`: one effect, after a reference campaign on the same soil without it, whose posterior is the prior; of every fourth
//!   nothing. Beside it the search without the reference.
//! - `steady`: as `scm`, one experiment after the other as a study searches them: the answer, its reason and its time.
//! - `node`: as `steady`, with Janosi and Hanamoto's law hidden whose displacement the nodes of the soil keep.
//! - `rolling`: as `steady`, with the model's own grid and 24 runs.
//! - `changes`: the three-dimensional model as an unknown rig, whose soil has no cohesion and does not flow. A reference campaign is
//!   calibrated and searched; its posterior is the prior of three more, in which the soil has a cohesion of 500 Pa, flows to the border of
//!   the footprint, or both, and the job holds both at zero. `changes-rolling`: with the model's own grid and 24 runs in place of 16.
//! - `tmcmc`: one effect of the catalogue, each in turn; the search's log Bayes factor of it beside that of full evidences by the
//!   sampler.
//! - `data`: the experiments of `tests/data`.
//!
//! A truth is drawn from the priors of the job and of the effect's file, and run at the conditions of a plan; noise of 3 % of each
//! channel's root mean square is added, and the search is given the texts of job and experiment, nothing else. Rates count where,
//! without noise, the best rival outside the truth's class falls short by 10 nats. The held-out error is that of 16 runs in between
//! and a little beyond, against the truth without noise.

use std::process::ExitCode;

use benchmark::hidden_effect::rig::{self, Flaw};
use benchmark::hidden_effect::study::design::Plan;
use benchmark::hidden_effect::study::error::StudyError;
use benchmark::hidden_effect::study::kind::HiddenKind;
use benchmark::hidden_effect::study::parallel::each;
use benchmark::hidden_effect::study::score::TrialScore;
use benchmark::hidden_effect::study::tally::Tally;
use benchmark::hidden_effect::study::trial::{draw, search};
use benchmark::hidden_effect::{ambiguous, changes, data, reference, steady, tmcmc};

/// Default number of trials of a kind.
const USUAL: u64 = 100;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args()
        .skip(1)
        .filter(|a| !a.starts_with("--"))
        .collect();
    let number = |k: usize, usual: u64| arguments.get(k).map_or(Ok(usual), |a| a.parse::<u64>());
    let (Ok(count), Ok(seed)) = (number(1, USUAL), number(2, 1)) else {
        eprintln!("error: COUNT and SEED are whole numbers");
        return ExitCode::FAILURE;
    };
    let done = match arguments.first().map_or("one", String::as_str) {
        "ambiguous" => ambiguous::run(count, seed),
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
        "data" => data::run(),
        "all" => tables("one+none+outside+two+three", count, seed),
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
        all.extend(scores(
            kind.ok_or(format!("unknown kind \"{name}\""))?,
            count,
            seed,
        )?);
    }
    println!("{}", Tally(&all));
    Ok(())
}

/// The scores of trials of a kind, each printed when it ends.
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
    each(count, one)?.into_iter().collect()
}
