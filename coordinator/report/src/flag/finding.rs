//! Flags of the tests in the diagnostics. Each family of tests is corrected for its size (Bonferroni): if nothing is wrong, a family
//! raises a flag in one of a hundred calibrations.

use super::cause::trend_flags;
use result::diagnostics::calibration::Diagnostics;
use result::diagnostics::channels::ChiSquareTest;
use result::diagnostics::residuals::ResidualDiagnostics;
use result::flag::{Flag, FlagKind};
use result::words::data_channel::DataChannel;
use result::words::number;
use result::words::probability::{LEVEL, p_words};

/// Returns the flags of channels, misfit, trends, residuals and prior.
pub(crate) fn findings_that_alarm(diagnostics: &Diagnostics) -> Vec<Flag> {
    silent_channels(diagnostics)
        .chain(misfits(diagnostics))
        .chain(trend_flags(&diagnostics.trends))
        .chain(outliers(&diagnostics.residuals))
        .chain(conflicts(diagnostics))
        .collect()
}

fn flag(kind: FlagKind, channel: Option<DataChannel>, p: Option<f64>, text: String) -> Flag {
    Flag {
        kind,
        channel,
        against: None,
        p,
        text,
    }
}

/// Multiplies a probability by the number of tests; `None` if the result is not below the level.
fn alarming(p: Option<f64>, tests: usize) -> Option<f64> {
    p.map(|p| p * tests as f64).filter(|p| *p < LEVEL)
}

fn silent_channels(diagnostics: &Diagnostics) -> impl Iterator<Item = Flag> {
    diagnostics.channels.iter().filter_map(|channel| {
        let text = channel.silence.clone()?;
        Some(flag(FlagKind::NoInformation, Some(channel.channel), None, text))
    })
}

/// Returns flags of the misfit of all data together, and of each channel if there are several.
fn misfits(diagnostics: &Diagnostics) -> impl Iterator<Item = Flag> {
    let judged = diagnostics
        .channels
        .iter()
        .filter(|c| c.chi_square.is_some())
        .count();
    let tests = if judged > 1 { judged + 1 } else { 1 };
    let misfit = move |channel: Option<DataChannel>, test: &ChiSquareTest| {
        let p = alarming(test.p, tests)?;
        let what = channel.map_or("all fitted data: ".into(), |c| format!("{}: ", c.words()));
        Some(flag(FlagKind::Chi2, channel, Some(p), what + &test.words()))
    };
    let all = diagnostics
        .chi_square
        .as_ref()
        .and_then(|test| misfit(None, test));
    let channels = diagnostics.channels.iter().filter(move |_| tests > 1);
    let channels = channels.filter_map(move |c| misfit(Some(c.channel), c.chi_square.as_ref()?));
    all.into_iter().chain(channels)
}

/// Returns a flag for the worst residual of each channel if it is significant among all residuals.
fn outliers(residuals: &[ResidualDiagnostics]) -> Vec<Flag> {
    let tests = residuals.iter().filter(|r| r.p.is_some()).count();
    let mut worst: Vec<(&ResidualDiagnostics, f64, usize)> = Vec::new();
    for row in residuals {
        let Some(p) = alarming(row.p, tests) else { continue };
        match worst.iter_mut().find(|(first, ..)| first.channel == row.channel) {
            Some((first, least, count)) => {
                *count += 1;
                if p < *least {
                    (*first, *least) = (row, p);
                }
            }
            None => worst.push((row, p, 1)),
        }
    }
    let text = |(row, p, count): (&ResidualDiagnostics, f64, usize)| {
        let further = match count {
            1 => String::new(),
            2 => "; 1 more residual of this channel is beyond chance".to_owned(),
            n => format!("; {} more residuals of this channel are beyond chance", n - 1),
        };
        let text = format!(
            "{} of run {} lies {} {} the prediction, {} of its standard deviations ({} among {tests} residuals): a measurement error, or a condition outside the model's validity{further}",
            row.channel.words(),
            row.run,
            row.channel.shown().size(row.residual.abs()),
            if row.residual > 0.0 { "above" } else { "below" },
            number::or_none(row.studentised, |t| number::significant(t.abs(), 2)),
            p_words(p)
        );
        flag(FlagKind::Outlier, Some(row.channel), Some(p), text)
    };
    worst.into_iter().map(text).collect()
}

fn conflicts(diagnostics: &Diagnostics) -> Vec<Flag> {
    let judged = diagnostics
        .parameters
        .iter()
        .filter(|p| p.conflict_p.is_some())
        .count();
    let tests = judged + 1;
    let single = diagnostics.parameters.iter().filter_map(|parameter| {
        let p = alarming(parameter.conflict_p, tests)?;
        let text = format!(
            "the data pull {} into the tail of its prior ({} among {}): the prior is wrong, or an effect is missing",
            parameter.name,
            p_words(p),
            number::count(tests, "test")
        );
        Some(flag(FlagKind::Conflict, None, Some(p), text))
    });
    let all = diagnostics.conflict.and_then(|conflict| {
        let p = alarming(conflict.p, tests)?;
        let text = format!(
            "the data contradict the prior as a whole (squared distance {} where {} is expected, {} among {}): the prior is wrong, or an effect is missing",
            number::significant(conflict.statistic, 3),
            conflict.degrees_of_freedom,
            p_words(p),
            number::count(tests, "test")
        );
        Some(flag(FlagKind::Conflict, None, Some(p), text))
    });
    all.into_iter().chain(single).collect()
}

#[cfg(test)]
mod tests {
    use shared::channel::Channel;

    use super::*;
    use crate::diagnosis::diagnostics;
    use crate::fixture;

    fn quiet() -> Diagnostics {
        let calibration = fixture::calibration();
        let mut diagnostics = diagnostics(&calibration, calibration.comparison());
        for channel in &mut diagnostics.channels {
            (channel.silence, channel.chi_square) = (None, None);
        }
        for residual in &mut diagnostics.residuals {
            residual.p = Some(0.5);
        }
        for parameter in &mut diagnostics.parameters {
            parameter.conflict_p = Some(0.5);
        }
        (diagnostics.chi_square, diagnostics.conflict) = (None, None);
        for trend in &mut diagnostics.trends {
            trend.p = 0.5;
        }
        diagnostics
    }

    fn kinds(diagnostics: &Diagnostics) -> Vec<(FlagKind, Option<DataChannel>, Option<f64>)> {
        let flags = findings_that_alarm(diagnostics);
        flags.into_iter().map(|f| (f.kind, f.channel, f.p)).collect()
    }

    #[test]
    fn nothing_is_flagged_where_nothing_is_wrong() {
        assert_eq!(kinds(&quiet()), []);
    }

    #[test]
    fn a_probability_is_corrected_for_the_tests_beside_it() {
        let mut diagnostics = quiet();
        let tests = diagnostics.residuals.len() as f64;
        diagnostics.residuals[0].p = Some(1.01 * LEVEL / tests);
        assert_eq!(kinds(&diagnostics), [], "just above the level");
        diagnostics.residuals[0].p = Some(0.5 * LEVEL / tests);
        let expected = (
            FlagKind::Outlier,
            Some(DataChannel::Wheel(Channel::DrawbarPull)),
            Some(0.5 * LEVEL),
        );
        assert_eq!(kinds(&diagnostics), [expected]);
        let text = &findings_that_alarm(&diagnostics)[0].text;
        assert!(
            text.contains("drawbar pull of run <script>alert(1)</script> lies"),
            "{text}"
        );
    }

    #[test]
    fn the_worst_residual_speaks_for_its_channel() {
        let mut diagnostics = quiet();
        diagnostics.residuals[0].p = Some(1e-5);
        diagnostics.residuals[1].p = Some(1e-9);
        let flags = findings_that_alarm(&diagnostics);
        assert_eq!(flags.len(), 1);
        assert!(flags[0].text.contains("run b&c lies"), "{}", flags[0].text);
        assert!(
            flags[0]
                .text
                .ends_with("; 1 more residual of this channel is beyond chance"),
            "{}",
            flags[0].text
        );
    }

    #[test]
    fn misfit_and_conflict_have_kinds_of_their_own() {
        let mut diagnostics = quiet();
        diagnostics.chi_square = Some(ChiSquareTest {
            chi_square: 90.0,
            data: 24,
            degrees_of_freedom: 20.0,
            p: Some(1e-8),
        });
        diagnostics.parameters[1].conflict_p = Some(1e-6);
        let found: Vec<FlagKind> = kinds(&diagnostics).into_iter().map(|k| k.0).collect();
        assert_eq!(found, [FlagKind::Chi2, FlagKind::Conflict]);
        let text = &findings_that_alarm(&diagnostics)[1].text;
        assert!(
            text.starts_with("the data pull n into the tail of its prior"),
            "{text}"
        );
    }
}
