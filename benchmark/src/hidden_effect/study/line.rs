//! A trial in one line: the truth, the conclusion, the cost.

use discovery::{Conclusion, RankedEffect, SearchTask};

use super::case::SyntheticCase;
use super::score::TrialScore;

/// Returns the line of a trial.
pub fn line(
    score: &TrialScore,
    case: &SyntheticCase,
    task: &SearchTask,
    conclusion: &Conclusion,
    number: u64,
) -> String {
    let candidates = task.candidates();
    let name = |k: Option<usize>| k.map_or("none", |k| candidates[k].name.as_str());
    let mut judged: Vec<_> = conclusion.ranking.effects.iter().collect();
    judged.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    let figures = |name: &str, j: &RankedEffect| {
        format!(
            "{name} {:.1} P {:.3} c{}",
            j.log_bayes_factor, j.probability, j.class
        )
    };
    let best = judged.iter().take(3).map(|j| figures(name(j.candidate), j));
    let best: Vec<String> = best.collect();
    let mut judged = judged.iter();
    let truth = judged.find(|j| j.candidate.is_some() && case.hidden == [name(j.candidate)]);
    let truth = truth.map_or(String::new(), |j| format!(" ({})", figures("truth", j)));
    let set: Vec<&str> = conclusion.combination.iter().map(|k| name(Some(*k))).collect();
    let outside = conclusion.outside.as_ref().map_or(String::new(), |o| {
        let [base, library] = o.left_out_nats;
        let (law, factor) = (name(Some(o.candidate)), o.log_bayes_factor);
        format!(" law {law} {factor:.1} left out {base:.1} {library:.1}")
    });
    let theta: Vec<String> = case.theta.iter().map(|x| format!("{x:.3e}")).collect();
    format!(
        "{} {number} {} [{}] separation {:.1} over base {:.1} | {:?}{} | {}{truth} | set {}{outside} | outside P {:.3} | chi2 p {:.1e}, best {:.1e} | held out {} | evaluations {} {} {}, {:.1} s | {} | leads {} P {:.4} {}",
        score.kind.name(),
        score.hidden,
        theta.join(" "),
        score.separation,
        score.over_base,
        conclusion.verdict,
        if score.is_good() { "" } else { " WRONG" },
        best.join(", "),
        set.join("+"),
        conclusion.not_in_library.map_or(0.0, |(_, p)| p),
        conclusion.chi_square.map_or(f64::NAN, |c| c.p()),
        conclusion.chi_square_best.map_or(f64::NAN, |c| c.p()),
        score.held_out,
        score.to_name,
        score.to_confirm,
        score.evaluations,
        score.seconds,
        score
            .truth_nats
            .map_or("truth not compared".to_owned(), |nats| format!(
                "truth {nats:.1} nats"
            )),
        score.leading.text,
        score.leading.probability,
        if score.leading.is_right { "right" } else { "wrong" }
    )
}
