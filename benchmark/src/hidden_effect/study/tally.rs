//! The scores of all trials against the targets of the project.

use std::fmt;

use super::kind::HiddenKind;
use super::noise_free::MIN_SEPARATION;
use super::rate::{Rate, mean};
use super::score::TrialScore;
use super::target::Target;

/// Lower ends of the bins of stated probabilities.
const BINS: [f64; 5] = [0.0, 0.5, 0.8, 0.95, 0.99];
/// The number of candidates of an experiment with one wheel; two wheels have more.
const ONE_WHEEL: usize = 49;

/// The scores of all trials.
pub struct Tally<'a>(pub &'a [TrialScore]);

/// Returns the share of trials with a property.
fn rate(all: &[&TrialScore], holds: impl Fn(&TrialScore) -> bool) -> Rate {
    Rate::new(all.iter().map(|x| holds(x)))
}

fn numbers(all: &[&TrialScore], value: impl Fn(&TrialScore) -> f64) -> Vec<f64> {
    all.iter().map(|x| value(x)).collect()
}

/// Returns a target for the share of trials with a property.
fn share(
    what: &'static str,
    all: &[&TrialScore],
    holds: impl Fn(&TrialScore) -> bool,
    goals: [f64; 2],
) -> Option<Target> {
    Target::rate(what, rate(all, holds), goals)
}

/// Returns the held-out errors of each trial with the best model, and with the base.
fn errors(all: &[&TrialScore]) -> Vec<[f64; 2]> {
    all.iter()
        .map(|x| [x.held_out.after, x.held_out.before])
        .collect()
}

/// Returns the share of holdout measurements within their intervals.
fn inside(all: &[&TrialScore]) -> Rate {
    all.iter().map(|x| x.held_out.covered).sum()
}

impl Tally<'_> {
    fn matching(&self, kinds: &[HiddenKind], holds: impl Fn(&TrialScore) -> bool) -> Vec<&TrialScore> {
        let scores = self.0.iter().filter(|score| kinds.contains(&score.kind));
        scores.filter(|score| holds(score)).collect()
    }

    fn kind(&self, kind: HiddenKind) -> Vec<&TrialScore> {
        self.matching(&[kind], |_| true)
    }

    /// Returns the trials in which noise-free data separate the truth from every rival.
    fn clear(&self, kind: HiddenKind) -> Vec<&TrialScore> {
        self.matching(&[kind], |x| x.separation >= MIN_SEPARATION)
    }

    /// Returns every target to which these trials contribute.
    pub fn targets(&self) -> Vec<Target> {
        let all = [self.one(), self.several(), self.laws(), self.mixed(), self.any()];
        all.into_iter().flatten().flatten().collect()
    }

    fn one(&self) -> Vec<Option<Target>> {
        let one = self.clear(HiddenKind::One);
        let alone: Vec<&TrialScore> = one.iter().copied().filter(|x| x.is_alone).collect();
        let claimed: Vec<&TrialScore> = one.iter().copied().filter(|x| x.is_claimed).collect();
        let sizes = numbers(&one, |x| x.set_size as f64);
        let after = numbers(&one, |x| x.held_out.after);
        let inside = inside(&claimed);
        vec![
            share("one effect: right class", &one, |x| x.is_right, [0.90, 0.97]),
            share(
                "  right name, alone in its class",
                &alone,
                |x| x.is_named,
                [0.90, 0.97],
            ),
            share("  in the top two", &one, |x| x.is_in_two, [0.97, 0.99]),
            share(
                "  right when claimed",
                &claimed,
                |x| x.claim_is_right,
                [0.95, 0.99],
            ),
            share("  95 % set holds the truth", &one, |x| x.is_covered, [0.93, 0.97]),
            Target::mean("  classes in that set", &sizes, [1.5, 1.2]),
            Target::ratio("  held-out error after over before", &errors(&one), [0.25, 0.10]),
            Target::mean("  held-out error after, sigma", &after, [0.5, 0.3]),
            Target::rate("  90 % intervals hold what is measured", inside, [0.87, 0.88]),
            Target::rate("  and do not hold too much", inside, [0.95, 0.92]).map(Target::least),
        ]
    }

    fn several(&self) -> Vec<Option<Target>> {
        let (two, triple) = (self.kind(HiddenKind::Two), self.kind(HiddenKind::Triple));
        let several = [two.as_slice(), &triple].concat();
        let ratios = errors(&several);
        vec![
            share("two effects exact", &two, |x| x.is_exact, [0.80, 0.94]),
            share("three effects exact", &triple, |x| x.is_exact, [0.50, 0.70]),
            share(
                "several: false \"not in the library\"",
                &several,
                TrialScore::is_outside,
                [0.05, 0.01],
            )
            .map(Target::least),
            Target::ratio("several: held-out error after over before", &ratios, [0.25, 0.10]),
        ]
    }

    fn laws(&self) -> Vec<Option<Target>> {
        let mut claimed = self.clear(HiddenKind::Outside);
        claimed.retain(|x| x.is_outside());
        let ratios = errors(&claimed);
        vec![
            share(
                "outside, claimed: quantity",
                &claimed,
                |x| x.quantity,
                [0.95, 1.0],
            ),
            share("  and variable", &claimed, |x| x.dependence, [0.85, 0.95]),
            share(
                "  or one of the places that are stated",
                &claimed,
                |x| x.is_in_places,
                [0.90, 0.98],
            ),
            Target::ratio("  held-out error after over before", &ratios, [0.35, 0.20]),
        ]
    }

    /// The kinds in which a claim may be wrong because more or less is hidden than one effect or one law.
    fn mixed(&self) -> Vec<Option<Target>> {
        let claimed = |kind| self.matching(&[kind], |x| x.is_claimed);
        let right = |what, kind| share(what, &claimed(kind), |x| x.claim_is_right, [0.95, 0.99]);
        vec![
            right("a law and an effect: right when claimed", HiddenKind::Outlib),
            right("law of two variables: right when claimed", HiddenKind::Twovar),
            share(
                "  and the law claimed",
                &self.kind(HiddenKind::Twovar),
                |x| x.quantity,
                [0.50, 0.80],
            ),
            right("wrong geometry: right when claimed", HiddenKind::Geometry),
            right("eight runs: right when claimed", HiddenKind::Sparse),
            right("heavy tails: right when claimed", HiddenKind::Heavy),
            right("sessions: right when claimed", HiddenKind::Session),
        ]
    }

    fn any(&self) -> Vec<Option<Target>> {
        let none = self.kind(HiddenKind::None);
        let single = self.matching(&[HiddenKind::One, HiddenKind::None], |_| true);
        let mut wheel = single.clone();
        wheel.retain(|x| x.candidates <= ONE_WHEEL);
        let spatial = self.clear(HiddenKind::Spatial);
        let to_name = numbers(&wheel, |x| x.to_name as f64);
        let to_confirm = numbers(&wheel, |x| x.to_confirm as f64);
        vec![
            share(
                "nothing missing: false claim",
                &none,
                |x| x.is_claimed,
                [0.03, 0.01],
            )
            .map(Target::least),
            share(
                "false \"not in the library\"",
                &single,
                TrialScore::is_outside,
                [0.05, 0.01],
            )
            .map(Target::least),
            Target::mean("evaluations to name, one wheel", &to_name, [900.0, 600.0]),
            Target::mean("evaluations to confirm, one wheel", &to_confirm, [3000.0, 2000.0]),
            share(
                "scm, one effect: right class",
                &spatial,
                |x| x.is_right,
                [0.90, 0.97],
            ),
            share("  in the top two", &spatial, |x| x.is_in_two, [0.97, 0.99]),
        ]
    }
}

impl fmt::Display for Tally<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for kind in HiddenKind::ALL {
            let all = self.kind(kind);
            if all.is_empty() {
                continue;
            }
            let shown = rate(&all, |x| x.over_base >= MIN_SEPARATION);
            let clear = self.clear(kind);
            let evaluations = numbers(&all, |x| x.evaluations as f64);
            writeln!(
                f,
                "{}: {} experiments; {} beyond the base by {MIN_SEPARATION} nats without noise, {} beyond every rival, a law claimed in {} \
                 of these; {:.0} evaluations and {:.1} s each in the mean",
                kind.name(),
                all.len(),
                shown.count,
                clear.len(),
                rate(&clear, TrialScore::is_outside).count,
                mean(&evaluations)[0],
                mean(&numbers(&all, |x| x.seconds))[0]
            )?;
        }
        writeln!(
            f,
            "{:<44} {:>8}  {:<40} {:>7} {:>7}",
            "target", "measured", "counts and 95 % interval", "floor", "aim"
        )?;
        for target in self.targets() {
            writeln!(f, "{target}")?;
        }
        let kinds = [HiddenKind::One, HiddenKind::None, HiddenKind::Outside];
        for (k, low) in BINS.iter().enumerate() {
            let high = BINS.get(k + 1).copied().unwrap_or(f64::INFINITY);
            let bin = self.matching(&kinds, |x| (*low..high).contains(&x.stated));
            if !bin.is_empty() {
                let [mean, _] = mean(&numbers(&bin, |x| x.stated));
                let right = rate(&bin, |x| x.is_right);
                writeln!(f, "stated P from {low:.2}, {mean:.3} in the mean: right {right}")?;
            }
        }
        Ok(())
    }
}
