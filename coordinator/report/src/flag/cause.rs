//! Causes: trends of the residuals in words, and the effects that may cause them.

use shared::channel::Channel;

use result::diagnostics::trends::{TrendDiagnostics, TrendVariable};
use result::flag::{Flag, FlagKind};
use result::words::data_channel::{DataChannel, ShownUnit};
use result::words::number;
use result::words::probability::{LEVEL, p_words};

const PULL: Channel = Channel::DrawbarPull;
const TORQUE: Channel = Channel::Torque;
const SINKAGE: Channel = Channel::Sinkage;

/// A possible cause of trends in one or more channels.
struct Cause {
    channels: Vec<Channel>,
    words: &'static str,
}

/// Returns the trends that are significant among all tests, with their corrected probability.
fn alarming(trends: &[TrendDiagnostics]) -> Vec<(&TrendDiagnostics, f64)> {
    let corrected = trends.iter().map(|trend| (trend, trend.p * trends.len() as f64));
    corrected.filter(|(_, p)| *p < LEVEL).collect()
}

/// Returns the strongest trend of each channel, in the order of the trends.
fn strongest<'a>(alarming: &[(&'a TrendDiagnostics, f64)]) -> Vec<(&'a TrendDiagnostics, f64)> {
    let mut found: Vec<(&TrendDiagnostics, f64)> = Vec::new();
    for &(trend, p) in alarming {
        match found.iter_mut().find(|(first, _)| first.channel == trend.channel) {
            Some(first) if steepness(trend) > steepness(first.0) => *first = (trend, p),
            Some(_) => {}
            None => found.push((trend, p)),
        }
    }
    found
}

/// Distinguishes trends whose probabilities are both 0.
fn steepness(trend: &TrendDiagnostics) -> f64 {
    (trend.change / trend.change_sd).abs()
}

/// Returns a flag for each channel whose residuals follow a condition; it names the strongest trend.
pub(crate) fn trend_flags(trends: &[TrendDiagnostics]) -> Vec<Flag> {
    let alarming = alarming(trends);
    let causes = causes(&alarming);
    let flag = |(trend, p): (&TrendDiagnostics, f64)| {
        let mut text = format!(
            "{} ({} among {})",
            sentence(trend),
            p_words(p),
            number::count(trends.len(), "test")
        );
        for cause in causes.iter().filter(|c| c.channels.contains(&trend.channel)) {
            text.push_str(": ");
            text.push_str(cause.words);
        }
        Flag {
            kind: FlagKind::Trend,
            channel: Some(DataChannel::Wheel(trend.channel)),
            against: Some(trend.against),
            p: Some(p),
            text,
        }
    };
    strongest(&alarming).into_iter().map(flag).collect()
}

/// Returns a sentence for each cause that several channels share.
pub(crate) fn shared_causes(trends: &[TrendDiagnostics]) -> Vec<String> {
    let causes = causes(&alarming(trends));
    let shared = causes.iter().filter(|cause| cause.channels.len() > 1);
    let sentence = |cause: &Cause| {
        let names: Vec<String> = cause.channels.iter().map(|c| c.words().to_owned()).collect();
        format!("{} show the same trend: {}", number::list(&names), cause.words)
    };
    shared.map(sentence).collect()
}

/// Describes a trend: `drawbar pull is over-predicted at low slip and under-predicted at high slip, by about 4.1 N from one end to the
/// other`.
fn sentence(trend: &TrendDiagnostics) -> String {
    let by = ShownUnit::new(trend.channel).size(trend.change.abs());
    let (channel, pattern) = (trend.channel.words(), pattern(trend));
    match trend.against {
        TrendVariable::Constant => {
            let how = if trend.change > 0.0 { "under" } else { "over" };
            format!("{channel} is {how}-predicted by about {by} in all runs, before the fit compensates")
        }
        _ => format!(
            "{channel} is {pattern}, by about {by} from one end to the other, before the fit compensates"
        ),
    }
}

/// Describes the strongest significant trend of a channel: `over-predicted at low slip and under-predicted at high slip`.
pub(crate) fn pattern_of(trends: &[TrendDiagnostics], channel: Channel) -> Option<String> {
    let strongest = strongest(&alarming(trends));
    let found = strongest.iter().find(|(trend, _)| trend.channel == channel)?;
    Some(pattern(found.0))
}

fn pattern(trend: &TrendDiagnostics) -> String {
    let [low, high] = match trend.against {
        TrendVariable::Constant => {
            let how = if trend.change > 0.0 { "under" } else { "over" };
            return format!("{how}-predicted in all runs");
        }
        TrendVariable::Slip => ["at low slip", "at high slip"],
        TrendVariable::WheelLoad => ["under low loads", "under high loads"],
        TrendVariable::SledSpeed => ["at low speed", "at high speed"],
        TrendVariable::SlipXSledSpeed => ["where slip times speed is low", "where it is high"],
        TrendVariable::Order => ["early in the series", "late in the series"],
    };
    let [first, then] = if trend.change > 0.0 {
        ["over", "under"]
    } else {
        ["under", "over"]
    };
    format!("{first}-predicted {low} and {then}-predicted {high}")
}

/// Returns known causes of the strongest trends. They are hints, because other effects can leave the same trends.
fn causes(alarming: &[(&TrendDiagnostics, f64)]) -> Vec<Cause> {
    let strongest = strongest(alarming);
    let change = |channel: Channel, against: TrendVariable| {
        let mut trends = strongest.iter().map(|(trend, _)| trend);
        trends
            .find(|t| t.channel == channel && t.against == against)
            .map(|t| t.change)
    };
    // Either pull or torque may follow another condition more strongly than slip.
    let weaker = |channel: Channel| {
        let mut trends = alarming.iter().map(|(trend, _)| trend);
        trends
            .find(|t| t.channel == channel && t.against == TrendVariable::Slip)
            .map(|t| t.change)
    };
    let mut causes = Vec::new();
    let mut cause = |channels: &[Channel], words| {
        causes.push(Cause {
            channels: channels.to_vec(),
            words,
        });
    };
    let (pull, torque) = (
        change(PULL, TrendVariable::Slip),
        change(TORQUE, TrendVariable::Slip),
    );
    if let Some(leading) = pull.or(torque) {
        let agrees = |other: Option<f64>| other.is_some_and(|c| c * leading > 0.0);
        let words = if leading > 0.0 {
            "shear may be mobilised later than in the model"
        } else {
            "shear may be mobilised earlier than in the model"
        };
        match (agrees(weaker(PULL)), agrees(weaker(TORQUE))) {
            (true, true) => cause(&[PULL, TORQUE], words),
            (true, false) if weaker(TORQUE).is_none() => cause(&[PULL], words),
            _ => {}
        }
    }
    if let Some(change) = change(SINKAGE, TrendVariable::SledSpeed) {
        let words = if change < 0.0 {
            "the soil's pressure may depend on the rate and be higher at higher speed"
        } else {
            "the soil's pressure may depend on the rate and be lower at higher speed"
        };
        cause(&[SINKAGE], words);
    }
    if let Some(change) = change(SINKAGE, TrendVariable::Slip) {
        let words = if change > 0.0 {
            "the wheel may sink deeper as it slips (slip-sinkage)"
        } else {
            "slip-sinkage may be weaker than in the model"
        };
        cause(&[SINKAGE], words);
    }
    let drifting: Vec<Channel> = Channel::ALL
        .into_iter()
        .filter(|&channel| change(channel, TrendVariable::Order).is_some())
        .collect();
    if !drifting.is_empty() {
        cause(
            &drifting,
            "the soil or the zeros of the sensors may drift in the course of the campaign",
        );
    }
    if change(PULL, TrendVariable::Constant).is_some() {
        cause(&[PULL], "the rig's zero of the pull (its tare) may be wrong");
    }
    causes
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a trend whose change is `z` standard deviations.
    fn trend(channel: Channel, against: TrendVariable, z: f64) -> TrendDiagnostics {
        TrendDiagnostics {
            channel,
            against,
            unit: "SI".into(),
            change: 0.001 * z,
            change_sd: 0.001,
            share_left: 0.5,
            p: libm::erfc(z.abs() / std::f64::consts::SQRT_2),
        }
    }

    fn texts(trends: &[TrendDiagnostics]) -> Vec<String> {
        trend_flags(trends).into_iter().map(|flag| flag.text).collect()
    }

    #[test]
    fn chance_raises_no_flag_and_more_tests_raise_the_bar() {
        let one = trend(PULL, TrendVariable::Slip, 3.0);
        assert_eq!(trend_flags(std::slice::from_ref(&one)).len(), 1);
        let mut many = vec![one];
        many.resize(4, trend(TORQUE, TrendVariable::Slip, 0.1));
        assert_eq!(trend_flags(&many), []);
    }

    #[test]
    fn the_strongest_trend_speaks_for_its_channel() {
        let flags = trend_flags(&[
            trend(SINKAGE, TrendVariable::Constant, 5.0),
            trend(SINKAGE, TrendVariable::WheelLoad, -50.0),
            trend(SINKAGE, TrendVariable::Slip, 45.0),
        ]);
        let [flag] = flags.as_slice() else {
            panic!("{flags:?}")
        };
        assert_eq!((flag.kind, flag.p), (FlagKind::Trend, Some(0.0)));
        assert_eq!(flag.channel, Some(DataChannel::Wheel(SINKAGE)));
        assert_eq!(flag.against, Some(TrendVariable::WheelLoad));
        assert_eq!(
            flag.text,
            "sinkage is under-predicted under low loads and over-predicted under high loads, by about 50 mm from one end to the other, before the fit compensates (p < 1e-12 among 3 tests)"
        );
    }

    #[test]
    fn pull_and_torque_together_point_at_shear() {
        let later = [
            trend(PULL, TrendVariable::Slip, 8.0),
            trend(TORQUE, TrendVariable::Slip, 6.0),
            trend(TORQUE, TrendVariable::SledSpeed, -7.0),
        ];
        assert_eq!(
            shared_causes(&later),
            ["drawbar pull and torque show the same trend: shear may be mobilised later than in the model"]
        );
        let found = texts(&later);
        assert!(
            found[0].starts_with(
                "drawbar pull is over-predicted at low slip and under-predicted at high slip, by about 0.0080 N"
            ),
            "{found:?}"
        );
        assert!(
            found[1].starts_with("torque is under-predicted at low speed"),
            "{found:?}"
        );
        assert!(
            found
                .iter()
                .all(|t| t.ends_with("shear may be mobilised later than in the model"))
        );
        let earlier = [trend(PULL, TrendVariable::Slip, -8.0)];
        assert!(texts(&earlier)[0].ends_with("shear may be mobilised earlier than in the model"));
        assert_eq!(shared_causes(&earlier), [""; 0], "one channel says it itself");
        // A change of shear gives both trends the same sign.
        let opposed = [
            trend(PULL, TrendVariable::Slip, 8.0),
            trend(TORQUE, TrendVariable::Slip, -6.0),
        ];
        assert!(
            texts(&opposed).iter().all(|t| t.ends_with("tests)")),
            "{:?}",
            texts(&opposed)
        );
    }

    #[test]
    fn each_known_pattern_has_its_cause() {
        for (channel, against, z, ending) in [
            (
                SINKAGE,
                TrendVariable::SledSpeed,
                -6.0,
                "be higher at higher speed",
            ),
            (SINKAGE, TrendVariable::SledSpeed, 6.0, "be lower at higher speed"),
            (SINKAGE, TrendVariable::Slip, 6.0, "as it slips (slip-sinkage)"),
            (SINKAGE, TrendVariable::Slip, -6.0, "weaker than in the model"),
            (PULL, TrendVariable::Constant, 6.0, "(its tare) may be wrong"),
            (
                TORQUE,
                TrendVariable::Constant,
                6.0,
                "in all runs, before the fit compensates (p = 2e-9 among 1 test)",
            ),
            (
                PULL,
                TrendVariable::SlipXSledSpeed,
                6.0,
                "(p = 2e-9 among 1 test)",
            ),
        ] {
            let found = texts(&[trend(channel, against, z)]);
            assert!(found[0].ends_with(ending), "{found:?}");
        }
    }
}
