//! The progress display of a study: one share of the whole where its parts are known, else that of the present part.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use shared::api::{CalibrationState, CalibrationStatus, Position, Progress};

use super::output::note;

/// The smallest finished share from which the remaining time is estimated.
const MIN_SHARE: f64 = 0.03;
/// The largest share that the display shows of a study, because the number of its members is a guess.
const MAX_SHARE: f64 = 0.99;

/// The parts of a study, as far as they are known when its display begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Parts {
    /// The number of calibrations.
    Calibrations(usize),
    /// A calibration and a search, which takes the longer time by a factor that nobody knows.
    WithSearch,
    /// Calibrations and searches in a number that depends on what they find.
    Rounds,
}

impl Parts {
    /// Says what may follow the present part of the study; `None` if nothing does, or if the share tells.
    fn to_come(self, present: Position) -> Option<&'static str> {
        match (self, present) {
            (Parts::Rounds, _) => Some("further rounds may follow"),
            (Parts::WithSearch, Position::Search { .. }) | (Parts::Calibrations(_), _) => None,
            (Parts::WithSearch, _) => Some("a search follows"),
        }
    }
}

/// The finished share of a study, from 0 to 1. Its members are equal parts, and the present one counts by its finished share. The share never
/// falls, although the number of members is a guess.
#[derive(Debug, Default, PartialEq)]
struct StudyShare(f64);

impl StudyShare {
    /// Updates the share, and returns it.
    ///
    /// # Arguments
    /// - `over`: the number of finished members. `expected`: the least number of members in the end.
    fn advance(&mut self, over: usize, expected: usize, present: &Progress) -> f64 {
        let parts = expected.max(over + 1) as f64;
        let now = (over as f64 + present.share) / parts;
        self.0 = now.min(MAX_SHARE).max(self.0);
        self.0
    }
}

/// Returns the remaining time in words; `None` while too little is finished for an estimate.
fn time_to_go(elapsed_s: f64, first: f64, share: f64) -> Option<String> {
    let done = share - first;
    let seconds = elapsed_s * (1.0 - share) / done;
    (done >= MIN_SHARE).then(|| match seconds {
        s if s >= 5400.0 => format!("about {:.1} h left", s / 3600.0),
        s if s >= 90.0 => format!("about {:.0} min left", s / 60.0),
        s => format!("about {:.0} s left", s.max(1.0)),
    })
}

/// Returns the phase of a calibration in words: `stage 7 of about 12`.
///
/// # Arguments
/// - `doing`: what a search does.
/// - `first`: stage and exponent at which it was seen first; its stages to come climb as fast as those since then.
fn phase(position: Position, doing: Option<&str>, first: (u32, f64)) -> String {
    let (stage, exponent) = match position {
        Position::Fit { steps } => return format!("fit, step {steps}"),
        Position::Evolution { generations } => return format!("generation {generations}"),
        Position::Search { .. } => {
            let doing = doing.map(|doing| format!(" ({doing})"));
            return format!("search for a missing effect{}", doing.unwrap_or_default());
        }
        Position::Sampler { stage: 0, .. } => return "draws from the prior".into(),
        Position::Sampler {
            stage,
            tempering_exponent,
            ..
        } => (stage, tempering_exponent),
    };
    if exponent >= 1.0 {
        return format!("stage {stage}, the last");
    }
    let stages = f64::from(stage.saturating_sub(first.0));
    let climbed = libm::log(exponent / first.1);
    let left = -libm::log(exponent) * stages / climbed;
    match left.is_finite() && stages > 0.0 && climbed > 0.0 {
        true => format!("stage {stage} of about {}", stage + left.round().max(1.0) as u32),
        false => format!("stage {stage}"),
    }
}

/// Returns how far a study, or its present part, has come, and how long it takes: `31 %, about 6 s left`,
/// `31 % of this search, further rounds may follow`.
///
/// # Arguments
/// - `left`: the remaining time of the study or of the part, if it can be estimated.
fn share_words(parts: Parts, position: Position, share: f64, left: Option<String>) -> String {
    let part = match (parts, position) {
        (Parts::Calibrations(_), _) => "",
        (_, Position::Search { .. }) => " of this search",
        _ => " of this calibration",
    };
    let clauses = left.as_deref().into_iter().chain(parts.to_come(position));
    let clauses: String = clauses.map(|clause| format!(", {clause}")).collect();
    format!("{:2.0} %{part}{clauses}", 100.0 * share)
}

/// A bar on a terminal; a line for each phase of each calibration elsewhere.
pub(super) struct Display {
    bar: Option<ProgressBar>,
    parts: Parts,
    share: StudyShare,
    /// Time and share when the display of the study began, or that of its present part where the parts are not known.
    first_share: Option<(Instant, f64)>,
    /// The present calibration with its first stage and exponent.
    first: Option<(i64, (u32, f64))>,
    /// The phase that was shown last.
    phase: (i64, String),
}

impl Display {
    pub(super) fn new(parts: Parts) -> Self {
        let bar = std::io::stderr().is_terminal().then(|| {
            let style = ProgressStyle::with_template("[{bar:20}] {wide_msg}")
                .unwrap_or_else(|_| ProgressStyle::default_bar());
            let bar = ProgressBar::new(1000).with_style(style.progress_chars("=> "));
            bar.enable_steady_tick(Duration::from_millis(200));
            bar
        });
        Display {
            bar,
            parts,
            share: StudyShare::default(),
            first_share: None,
            first: None,
            phase: (0, String::new()),
        }
    }

    /// Shows the progress of a study by its present calibration and the number of members that are over.
    pub(super) fn show(&mut self, status: &CalibrationStatus, over: usize) {
        let Some(p) = &status.progress else { return };
        let position = match p.position {
            Position::Sampler {
                stage,
                tempering_exponent,
                ..
            } => (stage, tempering_exponent),
            Position::Fit { .. } | Position::Evolution { .. } | Position::Search { .. } => (0, 0.0),
        };
        let is_next = self.first.is_none_or(|(id, _)| id != status.id);
        let first = match self.first {
            Some((_, first)) if !is_next && first.1 > 0.0 => first,
            _ => position,
        };
        self.first = Some((status.id, first));
        let share = match self.parts {
            Parts::Calibrations(expected) => self.share.advance(over, expected, p),
            Parts::WithSearch | Parts::Rounds => p.share,
        };
        if is_next && !matches!(self.parts, Parts::Calibrations(_)) {
            self.first_share = None;
        }
        let (began, first_share) = *self.first_share.get_or_insert((Instant::now(), share));
        let left = time_to_go(began.elapsed().as_secs_f64(), first_share, share);
        // The share of a search tells how much was computed, and nothing of its end.
        let left = left.filter(|_| !matches!(p.position, Position::Search { .. }));
        let name = status.name.trim_end_matches(" (discovery)");
        let doing = p.search.as_ref().map(|search| search.doing.as_str());
        let phase = (status.id, phase(p.position, doing, first));
        let share_words = share_words(self.parts, p.position, share, left);
        let message = format!("{share_words}: {name}, {}", phase.1);
        match &self.bar {
            Some(bar) => {
                bar.set_position((1000.0 * share) as u64);
                bar.set_message(message);
            }
            // Phases with the same stage count as one, whatever the estimated number of stages.
            None if self.phase.0 != status.id || stage_of(&self.phase.1) != stage_of(&phase.1) => {
                note(message.trim_start());
            }
            None => {}
        }
        self.phase = phase;
        if status.state == CalibrationState::Paused && self.bar.is_none() {
            note(&format!(
                "paused: {}",
                status.message.as_deref().unwrap_or_default()
            ));
        }
    }

    pub(super) fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// Returns a phase without the estimated number of stages and without the step of a fit.
fn stage_of(phase: &str) -> &str {
    let of_stage = phase
        .split([',', ' '])
        .nth(1)
        .filter(|_| !phase.starts_with("search"));
    of_stage.unwrap_or(phase)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sampler(stage: u32, tempering_exponent: f64) -> Position {
        Position::Sampler {
            stage,
            tempering_exponent,
            step: 0,
            acceptance: None,
        }
    }

    fn progress(position: Position, share: f64) -> Progress {
        Progress {
            algorithm: String::new(),
            position,
            share,
            evaluations: 1000,
            rejected: 0,
            step_done: 0,
            step_size: 1000,
            search: None,
            evaluations_per_s: 1.0,
            remaining_s: None,
        }
    }

    #[test]
    fn the_share_of_a_study_never_falls_and_never_reaches_the_whole() {
        let mut share = StudyShare::default();
        let mut shown = Vec::new();
        // The study turns out to have more members than expected, and the share of a member begins again with each.
        for over in 0..6 {
            for (stage, part) in [(0, 0.0), (1, 0.1), (2, 0.4), (3, 0.3), (4, 0.99)] {
                shown.push(share.advance(over, 4, &progress(sampler(stage, 0.5), part)));
            }
            let search = progress(Position::Search { rounds: 1 }, 0.4);
            shown.push(share.advance(over, 4, &search));
        }
        assert!(shown.windows(2).all(|pair| pair[0] <= pair[1]), "{shown:?}");
        assert!(shown.iter().all(|s| (0.0..=MAX_SHARE).contains(s)), "{shown:?}");
        assert!(shown[0] < 0.01 && *shown.last().unwrap() > 0.8, "{shown:?}");
    }

    #[test]
    fn where_rounds_may_follow_a_share_is_that_of_the_present_part_and_a_search_has_no_time_left() {
        let words = |parts, position, left: Option<&str>| {
            share_words(parts, position, 0.308, left.map(str::to_owned))
        };
        let (fit, search) = (Position::Fit { steps: 5 }, Position::Search { rounds: 9 });
        let left = Some("about 6 s left");
        assert_eq!(words(Parts::Calibrations(1), fit, left), "31 %, about 6 s left");
        assert_eq!(
            words(Parts::WithSearch, fit, left),
            "31 % of this calibration, about 6 s left, a search follows"
        );
        assert_eq!(words(Parts::WithSearch, search, None), "31 % of this search");
        assert_eq!(
            words(Parts::Rounds, fit, None),
            "31 % of this calibration, further rounds may follow"
        );
        assert_eq!(
            words(Parts::Rounds, search, None),
            "31 % of this search, further rounds may follow"
        );
    }

    #[test]
    fn what_a_search_does_is_a_phase_and_a_step_of_a_fit_is_none() {
        let phase = |position, doing| phase(position, doing, (0, 0.0));
        let search = |doing| phase(Position::Search { rounds: 1 }, Some(doing));
        let [alone, together] = ["tries each effect alone", "combines effects"].map(search);
        assert_eq!(alone, "search for a missing effect (tries each effect alone)");
        assert!(stage_of(&alone) != stage_of(&together));
        let [fit, further] = [1, 2].map(|steps| phase(Position::Fit { steps }, None));
        assert!(fit != further && stage_of(&fit) == stage_of(&further));
    }

    #[test]
    fn the_time_to_go_follows_from_the_share_and_waits_for_some_of_it() {
        assert_eq!(time_to_go(10.0, 0.0, 0.01), None);
        assert_eq!(time_to_go(10.0, 0.0, 0.5).as_deref(), Some("about 10 s left"));
        assert_eq!(time_to_go(600.0, 0.5, 0.75).as_deref(), Some("about 10 min left"));
        assert_eq!(
            time_to_go(36_000.0, 0.0, 0.5).as_deref(),
            Some("about 10.0 h left")
        );
    }

    #[test]
    fn the_number_of_stages_follows_from_the_climb_so_far() {
        let words = |stage, exponent| phase(sampler(stage, exponent), None, (1, 1e-4));
        assert_eq!(words(1, 1e-4), "stage 1");
        assert_eq!(words(3, 1e-2), "stage 3 of about 5");
        assert_eq!(words(5, 1.0), "stage 5, the last");
        assert_eq!(
            phase(Position::Search { rounds: 1 }, None, (0, 0.0)),
            "search for a missing effect"
        );
    }
}
