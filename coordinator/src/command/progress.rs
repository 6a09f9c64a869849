//! The progress display of a study: one share of the whole, which never falls.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use shared::api::{CalibrationState, CalibrationStatus, Position, Progress};

use super::output::note;

/// Natural logarithm of the first tempering exponent of a usual calibration, about 1e-5. It rises to 0 over the stages.
const FIRST_LN_EXPONENT: f64 = -11.5;
/// The share of a calibration's work until the exponent is 1.
const CLIMB: f64 = 0.9;
/// The number of evaluations of a usual search.
const SEARCH: f64 = 2000.0;
/// The number of steps of a usual fit.
const FIT_STEPS: f64 = 8.0;
/// The number of generations of a usual evolution.
const GENERATIONS: f64 = 100.0;
/// The smallest finished share from which the remaining time is estimated.
const MIN_SHARE: f64 = 0.03;
/// The largest share that the display shows, because the end is not certain.
const MAX_SHARE: f64 = 0.99;

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
        let now = (over as f64 + share_of(present)) / parts;
        self.0 = now.min(MAX_SHARE).max(self.0);
        self.0
    }
}

/// Returns the finished share of a calibration or a search, from 0 to 1.
fn share_of(p: &Progress) -> f64 {
    let settling = |done: f64, usual: f64| 1.0 - libm::exp(-done / usual);
    match p.position {
        Position::Fit { steps } => settling(f64::from(steps), FIT_STEPS),
        Position::Evolution { generations } => settling(f64::from(generations), GENERATIONS),
        Position::Search { .. } => settling(p.evaluations as f64, SEARCH),
        Position::Sampler {
            tempering_exponent, ..
        } if tempering_exponent >= 1.0 => {
            CLIMB + (1.0 - CLIMB) * p.step_done as f64 / p.step_size.max(1) as f64
        }
        Position::Sampler {
            tempering_exponent, ..
        } => CLIMB * (1.0 - libm::log(tempering_exponent) / FIRST_LN_EXPONENT).clamp(0.0, 1.0),
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
/// - `first`: stage and exponent at which it was seen first; its stages to come climb as fast as those since then.
fn phase(position: Position, first: (u32, f64)) -> String {
    let (stage, exponent) = match position {
        Position::Fit { steps } => return format!("fit, step {steps}"),
        Position::Evolution { generations } => return format!("generation {generations}"),
        Position::Search { .. } => return "search for a missing effect".into(),
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

/// A bar on a terminal; a line for each phase of each calibration elsewhere.
pub(super) struct Display {
    bar: Option<ProgressBar>,
    began: Instant,
    share: StudyShare,
    /// The share when the display began.
    first_share: Option<f64>,
    /// The present calibration with its first stage and exponent.
    first: Option<(i64, (u32, f64))>,
    /// The phase that was shown last.
    phase: (i64, String),
    /// Least number of members in the end.
    expected: usize,
}

impl Display {
    /// - `expected`: the least number of calibrations and searches that the study will have.
    pub(super) fn new(expected: usize) -> Self {
        let bar = std::io::stderr().is_terminal().then(|| {
            let style = ProgressStyle::with_template("[{bar:20}] {wide_msg}")
                .unwrap_or_else(|_| ProgressStyle::default_bar());
            let bar = ProgressBar::new(1000).with_style(style.progress_chars("=> "));
            bar.enable_steady_tick(Duration::from_millis(200));
            bar
        });
        Display {
            bar,
            began: Instant::now(),
            share: StudyShare::default(),
            first_share: None,
            first: None,
            phase: (0, String::new()),
            expected,
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
        let first = match self.first {
            Some((id, first)) if id == status.id && first.1 > 0.0 => first,
            _ => position,
        };
        self.first = Some((status.id, first));
        let share = self.share.advance(over, self.expected, p);
        let first_share = *self.first_share.get_or_insert(share);
        let left = time_to_go(self.began.elapsed().as_secs_f64(), first_share, share);
        let left = left.map_or(String::new(), |left| format!(", {left}"));
        let name = status.name.trim_end_matches(" (discovery)");
        let phase = (status.id, phase(p.position, first));
        let message = format!("{:2.0} %{left}: {name}, {}", 100.0 * share, phase.1);
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

/// Returns a phase without the estimated number of stages.
fn stage_of(phase: &str) -> &str {
    phase.split([',', ' ']).nth(1).unwrap_or(phase)
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

    fn progress(position: Position, evaluations: u64) -> Progress {
        Progress {
            algorithm: String::new(),
            position,
            evaluations,
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
        // The study turns out to have more members than expected, and has stages whose progress starts again with each step.
        for over in 0..6 {
            for (stage, exponent) in [(0, 0.0), (1, 1e-6), (2, 1e-3), (3, 0.2), (4, 1.0)] {
                for step_done in [0, 500, 1000, 10] {
                    let p = Progress {
                        step_done,
                        ..progress(sampler(stage, exponent), 1000)
                    };
                    shown.push(share.advance(over, 4, &p));
                }
            }
            let search = progress(Position::Search { rounds: 1 }, 1000);
            shown.push(share.advance(over, 4, &search));
        }
        assert!(shown.windows(2).all(|pair| pair[0] <= pair[1]), "{shown:?}");
        assert!(shown.iter().all(|s| (0.0..=MAX_SHARE).contains(s)), "{shown:?}");
        assert!(shown[0] < 0.01 && *shown.last().unwrap() > 0.8, "{shown:?}");
    }

    #[test]
    fn every_algorithm_moves_its_share() {
        let pairs = [
            [sampler(1, 1e-4), sampler(9, 0.5)],
            [1, 9].map(|steps| Position::Fit { steps }),
            [1, 9].map(|generations| Position::Evolution { generations }),
            [1, 9].map(|rounds| Position::Search { rounds }),
        ];
        for [early, late] in pairs {
            let [early_share, late_share] =
                [(early, 1000), (late, 9000)].map(|(position, n)| share_of(&progress(position, n)));
            assert!(early_share < late_share && late_share < 1.0, "{late:?}");
        }
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
        let words = |stage, exponent| phase(sampler(stage, exponent), (1, 1e-4));
        assert_eq!(words(1, 1e-4), "stage 1");
        assert_eq!(words(3, 1e-2), "stage 3 of about 5");
        assert_eq!(words(5, 1.0), "stage 5, the last");
        assert_eq!(
            phase(Position::Search { rounds: 1 }, (0, 0.0)),
            "search for a missing effect"
        );
    }
}
