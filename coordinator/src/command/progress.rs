//! The progress display of a study: one share of the whole, which never falls.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use shared::api::{CalibrationState, CalibrationStatus, Position, Progress};

use super::output::note;

/// The smallest finished share from which the remaining time is estimated.
const MIN_SHARE: f64 = 0.03;
/// The largest share that the display shows of a study, because the number of its members is a guess.
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
