//! What trends look like in words, and which effect they may come from.

use super::kind::Flag;
use crate::diagnostics::data_channel::size;
use crate::diagnostics::trends::{Against, TrendDiagnostics};
use crate::words::number;
use crate::words::probability::{LEVEL, p_words};

const PULL: &str = "drawbar_pull";
const TORQUE: &str = "torque";
const SINKAGE: &str = "sinkage";

/// What may lie behind the trends of some channels.
struct Cause {
    channels: Vec<&'static str>,
    words: &'static str,
}

/// Trends that are beyond chance among all tests, with their corrected probability.
fn alarming(trends: &[TrendDiagnostics]) -> Vec<(&TrendDiagnostics, f64)> {
    let corrected = trends.iter().map(|trend| (trend, trend.p * trends.len() as f64));
    corrected.filter(|(_, p)| *p < LEVEL).collect()
}

/// The strongest trend of each channel that has one, in the order of the trends.
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

/// A flag for each channel whose residuals follow a condition, about the one that they follow most.
pub(crate) fn trend_flags(trends: &[TrendDiagnostics]) -> Vec<Flag> {
    let alarming = alarming(trends);
    let causes = causes(&alarming);
    let flag = |(trend, p): (&TrendDiagnostics, f64)| {
        let mut text = format!(
            "{} ({} among {} tests)",
            sentence(trend),
            p_words(p),
            trends.len()
        );
        for cause in causes.iter().filter(|c| c.channels.contains(&&*trend.channel)) {
            text.push_str(": ");
            text.push_str(cause.words);
        }
        Flag {
            kind: "trend".into(),
            channel: Some(trend.channel.clone()),
            against: Some(trend.against.name().into()),
            p: Some(p),
            text,
        }
    };
    strongest(&alarming).into_iter().map(flag).collect()
}

/// A sentence for each cause that several channels point at.
pub(crate) fn shared_causes(trends: &[TrendDiagnostics]) -> Vec<String> {
    let causes = causes(&alarming(trends));
    let shared = causes.iter().filter(|cause| cause.channels.len() > 1);
    let sentence = |cause: &Cause| {
        let names: Vec<String> = cause.channels.iter().map(|c| c.replace('_', " ")).collect();
        format!(
            "{} miss the measurements alike: {}",
            number::list(&names),
            cause.words
        )
    };
    shared.map(sentence).collect()
}

/// `drawbar pull is over-predicted at low slip and under-predicted at high slip, by 4.1 N in all`.
fn sentence(trend: &TrendDiagnostics) -> String {
    let channel = trend.channel.replace('_', " ");
    let by = size(&trend.channel, trend.change.abs());
    let [low, high] = match trend.against {
        Against::Constant => {
            let how = if trend.change > 0.0 { "under" } else { "over" };
            return format!("{channel} is {how}-predicted by about {by} in all runs");
        }
        Against::Slip => ["at low slip", "at high slip"],
        Against::WheelLoad => ["under low loads", "under high loads"],
        Against::SledSpeed => ["at low speed", "at high speed"],
        Against::SlipXSledSpeed => ["where slip times speed is low", "where it is high"],
    };
    let [first, then] = if trend.change > 0.0 {
        ["over", "under"]
    } else {
        ["under", "over"]
    };
    format!(
        "{channel} is {first}-predicted {low} and {then}-predicted {high}, by about {by} from one end to the other"
    )
}

/// What the strongest trends are known to come from; hints, since other effects can leave the same trends.
fn causes(alarming: &[(&TrendDiagnostics, f64)]) -> Vec<Cause> {
    let strongest = strongest(alarming);
    let change = |channel: &str, against: Against| {
        let mut own = strongest.iter().map(|(trend, _)| trend);
        own.find(|t| t.channel == channel && t.against == against)
            .map(|t| t.change)
    };
    // Of pull and torque one may follow something else still more.
    let weaker = |channel: &str| {
        let mut own = alarming.iter().map(|(trend, _)| trend);
        own.find(|t| t.channel == channel && t.against == Against::Slip)
            .map(|t| t.change)
    };
    let mut causes = Vec::new();
    let mut cause = |channels: &[&'static str], words| {
        causes.push(Cause {
            channels: channels.to_vec(),
            words,
        });
    };
    let (pull, torque) = (change(PULL, Against::Slip), change(TORQUE, Against::Slip));
    if let Some(leading) = pull.or(torque) {
        let agrees = |other: Option<f64>| other.is_some_and(|c| c * leading > 0.0);
        let words = if leading > 0.0 {
            "shear may be mobilised later than the model has it"
        } else {
            "shear may be mobilised earlier than the model has it"
        };
        match (agrees(weaker(PULL)), agrees(weaker(TORQUE))) {
            (true, true) => cause(&[PULL, TORQUE], words),
            (true, false) if weaker(TORQUE).is_none() => cause(&[PULL], words),
            _ => {}
        }
    }
    if let Some(change) = change(SINKAGE, Against::SledSpeed) {
        let words = if change < 0.0 {
            "the soil's pressure may depend on the rate, and carry more where the wheel is faster"
        } else {
            "the soil's pressure may depend on the rate, and carry less where the wheel is faster"
        };
        cause(&[SINKAGE], words);
    }
    if let Some(change) = change(SINKAGE, Against::Slip) {
        let words = if change > 0.0 {
            "the wheel may dig itself in as it slips (slip-sinkage)"
        } else {
            "slip-sinkage may be weaker than the model has it"
        };
        cause(&[SINKAGE], words);
    }
    if change(PULL, Against::Constant).is_some() {
        cause(&[PULL], "the rig's zero of the pull (its tare) may be off");
    }
    causes
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A change of so many standard deviations.
    fn trend(channel: &str, against: Against, z: f64) -> TrendDiagnostics {
        TrendDiagnostics {
            channel: channel.into(),
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
        let one = trend(PULL, Against::Slip, 3.0);
        assert_eq!(trend_flags(std::slice::from_ref(&one)).len(), 1);
        let mut many = vec![one];
        many.resize(4, trend(TORQUE, Against::Slip, 0.1));
        assert_eq!(trend_flags(&many), []);
    }

    #[test]
    fn the_strongest_trend_speaks_for_its_channel() {
        let flags = trend_flags(&[
            trend(SINKAGE, Against::Constant, 5.0),
            trend(SINKAGE, Against::WheelLoad, -50.0),
            trend(SINKAGE, Against::Slip, 45.0),
        ]);
        let [flag] = flags.as_slice() else {
            panic!("{flags:?}")
        };
        assert_eq!((flag.kind.as_str(), flag.p), ("trend", Some(0.0)));
        assert_eq!(flag.channel.as_deref(), Some(SINKAGE));
        assert_eq!(flag.against.as_deref(), Some("wheel_load"));
        assert_eq!(
            flag.text,
            "sinkage is under-predicted under low loads and over-predicted under high loads, by about 50 mm from one end to the other (p < 1e-12 among 3 tests)"
        );
    }

    #[test]
    fn pull_and_torque_together_point_at_shear() {
        let later = [
            trend(PULL, Against::Slip, 8.0),
            trend(TORQUE, Against::Slip, 6.0),
            trend(TORQUE, Against::SledSpeed, -7.0),
        ];
        assert_eq!(
            shared_causes(&later),
            [
                "drawbar pull and torque miss the measurements alike: shear may be mobilised later than the model has it"
            ]
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
                .all(|t| t.ends_with("shear may be mobilised later than the model has it"))
        );
        let earlier = [trend(PULL, Against::Slip, -8.0)];
        assert!(texts(&earlier)[0].ends_with("shear may be mobilised earlier than the model has it"));
        assert_eq!(shared_causes(&earlier), [""; 0], "one channel says it itself");
        // Opposite signs are not what shear does.
        let opposed = [
            trend(PULL, Against::Slip, 8.0),
            trend(TORQUE, Against::Slip, -6.0),
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
                Against::SledSpeed,
                -6.0,
                "carry more where the wheel is faster",
            ),
            (
                SINKAGE,
                Against::SledSpeed,
                6.0,
                "carry less where the wheel is faster",
            ),
            (SINKAGE, Against::Slip, 6.0, "as it slips (slip-sinkage)"),
            (SINKAGE, Against::Slip, -6.0, "weaker than the model has it"),
            (PULL, Against::Constant, 6.0, "(its tare) may be off"),
            (
                TORQUE,
                Against::Constant,
                6.0,
                "in all runs (p = 2e-9 among 1 tests)",
            ),
            (PULL, Against::SlipXSledSpeed, 6.0, "(p = 2e-9 among 1 tests)"),
        ] {
            let found = texts(&[trend(channel, against, z)]);
            assert!(found[0].ends_with(ending), "{found:?}");
        }
    }
}
