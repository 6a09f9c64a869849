//! One experiment in one line: what was hidden, what was said, what it cost.

use discovery::inquiry::{Answer, Task};

use super::case::Case;
use super::fate::Fate;

impl Fate {
    pub(super) fn described(&self, case: &Case, task: &Task, answer: &Answer, number: u64) -> String {
        let candidates = task.candidates();
        let name = |k: Option<usize>| k.map_or("none", |k| candidates[k].name.as_str());
        let mut judged: Vec<_> = answer.judged.iter().collect();
        judged.sort_by(|a, b| b.probability.total_cmp(&a.probability));
        let best: Vec<String> = judged
            .iter()
            .take(3)
            .map(|j| {
                let (name, factor) = (name(j.candidate), j.log_bayes_factor);
                format!("{name} {factor:.1} P {:.3} c{}", j.probability, j.class)
            })
            .collect();
        let truth = judged
            .iter()
            .find(|j| j.candidate.is_some() && case.hidden == [name(j.candidate)]);
        let own = truth.map_or(String::new(), |j| {
            format!(
                " (truth {:.1} P {:.3} c{})",
                j.log_bayes_factor, j.probability, j.class
            )
        });
        let set: Vec<&str> = answer.best_set.iter().map(|k| name(Some(*k))).collect();
        let outside = answer.outside.as_ref().map_or(String::new(), |o| {
            let [base, library] = o.left_out_nats;
            format!(
                " law {} {:.1} left out {base:.1} {library:.1}",
                name(Some(o.candidate)),
                o.log_bayes_factor
            )
        });
        let theta: Vec<String> = case.theta.iter().map(|x| format!("{x:.3e}")).collect();
        format!(
            "{} {number} {} [{}] separation {:.1} over base {:.1} | {:?}{} | {}{own} | set {}{outside} | outside P {:.3} | chi2 p {:.1e}, best {:.1e} | held out {} | evaluations {} {} {}, {:.1} s",
            self.kind.name(),
            case.hidden.join("+"),
            theta.join(" "),
            self.separation,
            self.over_base,
            answer.verdict,
            if self.is_good() { "" } else { " WRONG" },
            best.join(", "),
            set.join("+"),
            answer.not_in_library.map_or(0.0, |(_, p)| p),
            answer.chi_square.map_or(f64::NAN, |c| c.p()),
            answer.chi_square_best.map_or(f64::NAN, |c| c.p()),
            self.held_out,
            self.to_name,
            self.to_confirm,
            self.evaluations,
            self.seconds
        )
    }
}
