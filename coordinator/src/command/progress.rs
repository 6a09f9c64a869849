//! The progress display of a running calibration.

use std::io::IsTerminal;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use shared::api::{CalibrationState, CalibrationStatus};

use super::output::note;

/// A bar on a terminal; a line for each stage elsewhere.
pub(super) struct Display {
    bar: Option<ProgressBar>,
    stage: Option<u32>,
}

impl Display {
    pub(super) fn new() -> Self {
        let bar = std::io::stderr().is_terminal().then(|| {
            let style = ProgressStyle::with_template("{elapsed_precise} [{bar:30}] {msg}")
                .unwrap_or_else(|_| ProgressStyle::default_bar());
            let bar = ProgressBar::new(1).with_style(style.progress_chars("=> "));
            bar.enable_steady_tick(Duration::from_millis(200));
            bar
        });
        Display { bar, stage: None }
    }

    /// Shows where a calibration stands.
    pub(super) fn show(&mut self, status: &CalibrationStatus) {
        let Some(p) = &status.progress else { return };
        let time = match p.remaining_s {
            Some(s) if s >= 90.0 => format!("about {:.0} min remaining", s / 60.0),
            Some(s) => format!("about {s:.0} s remaining"),
            None => "remaining time unknown".into(),
        };
        let pace = format!("{} evaluations, {:.0}/s", p.evaluations, p.evaluations_per_s);
        let message = match p.algorithm.as_str() {
            "lm" => format!("{} steps taken | {pace}", p.stage),
            "ga" | "cma-es" => format!("{} generations | {pace}", p.stage),
            "discovery" => format!("search, round {} | {pace}", p.stage),
            _ => format!(
                "stage {} exponent {:.3e} step {} acceptance {:.2} | {pace} | {time}",
                p.stage, p.tempering_exponent, p.step, p.acceptance
            ),
        };
        match &self.bar {
            Some(bar) => {
                bar.set_length(p.step_size.max(1));
                bar.set_position(p.step_done);
                bar.set_message(message);
            }
            None if self.stage != Some(p.stage) => note(&message),
            None => {}
        }
        self.stage = Some(p.stage);
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
