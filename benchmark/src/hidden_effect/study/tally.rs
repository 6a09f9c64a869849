//! The scores of all trials against the targets of the project.

use std::fmt;

use super::kind::HiddenKind;
use super::noise_free::MIN_SEPARATION;
use super::rate::{Rate, mean};
use super::score::TrialScore;
use super::target::Target;

/// Lower ends of the bins of stated probabilities.
const BINS: [f64; 5] = [0.0, 0.5, 0.8, 0.95, 0.99];
/// Candidates of an experiment with one wheel; with two wheels there are more.
const ONE_WHEEL: usize = 49;

/// The scores of all trials.
pub struct Tally<'a>(pub &'a [TrialScore]);

/// The share of trials with a property.
fn rate(all: &[&TrialScore], holds: impl Fn(&TrialScore) -> bool) -> Rate {
    Rate::new(all.iter().map(|x| holds(x)))
}

fn numbers(all: &[&TrialScore], of: impl Fn(&TrialScore) -> f64) -> Vec<f64> {
    all.iter().map(|x| of(x)).collect()
}

/// Held-out errors after and before.
fn errors(all: &[&TrialScore]) -> Vec<[f64; 2]> {
    let pairs = all.iter().map(|x| [x.held_out.after, x.held_out.before]);
    pairs.collect()
}

/// The share of holdout measurements within their intervals.
fn inside(all: &[&TrialScore]) -> Rate {
    let rates = all.iter().map(|x| x.held_out.covered);
    rates.fold(Rate { count: 0, of: 0 }, |sum, rate| Rate {
        count: sum.count + rate.count,
        of: sum.of + rate.of,
    })
}

impl Tally<'_> {
    fn matching(&self, kinds: &[HiddenKind], holds: impl Fn(&TrialScore) -> bool) -> Vec<&TrialScore> {
        let own = self.0.iter().filter(|score| kinds.contains(&score.kind));
        own.filter(|score| holds(score)).collect()
    }

    /// Every target to which these trials contribute.
    pub fn targets(&self) -> Vec<Target> {
        let all = [self.of_one(), self.of_sets(), self.of_laws(), self.of_all()];
        all.into_iter().flatten().flatten().collect()
    }

    fn of_one(&self) -> Vec<Option<Target>> {
        let one = self.matching(&[HiddenKind::One], |x| x.separation >= MIN_SEPARATION);
        let alone: Vec<&TrialScore> = one.iter().copied().filter(|x| x.is_alone).collect();
        let claimed: Vec<&TrialScore> = one.iter().copied().filter(|x| x.is_claimed).collect();
        let sizes = numbers(&one, |x| x.set_size as f64);
        let after = numbers(&one, |x| x.held_out.after);
        let inside = inside(&claimed);
        vec![
            Target::rate(
                "one effect: right class",
                rate(&one, |x| x.is_right),
                [0.90, 0.97],
            ),
            Target::rate(
                "  right name, alone in its class",
                rate(&alone, |x| x.is_named),
                [0.90, 0.97],
            ),
            Target::rate("  in the top two", rate(&one, |x| x.is_in_two), [0.97, 0.99]),
            Target::rate(
                "  right when claimed",
                rate(&claimed, |x| x.claim_is_right),
                [0.95, 0.99],
            ),
            Target::rate(
                "  95 % set holds the truth",
                rate(&one, |x| x.is_covered),
                [0.93, 0.97],
            ),
            Target::mean("  classes in that set", &sizes, [1.5, 1.2]),
            Target::ratio("  held-out error after over before", &errors(&one), [0.25, 0.10]),
            Target::mean("  held-out error after, sigma", &after, [0.5, 0.3]),
            Target::rate("  90 % intervals hold what is measured", inside, [0.87, 0.88]),
            Target::rate("  and do not hold too much", inside, [0.95, 0.92]).map(Target::least),
        ]
    }

    fn of_sets(&self) -> Vec<Option<Target>> {
        let (two, three) = (
            self.matching(&[HiddenKind::Two], |_| true),
            self.matching(&[HiddenKind::Three], |_| true),
        );
        let several = self.matching(&[HiddenKind::Two, HiddenKind::Three], |_| true);
        let false_law = rate(&several, TrialScore::is_outside);
        vec![
            Target::rate("two effects exact", rate(&two, |x| x.is_exact), [0.80, 0.94]),
            Target::rate("three effects exact", rate(&three, |x| x.is_exact), [0.50, 0.70]),
            Target::rate("several: false \"not in the library\"", false_law, [0.05, 0.01]).map(Target::least),
            Target::ratio(
                "several: held-out error after over before",
                &errors(&several),
                [0.25, 0.10],
            ),
        ]
    }

    fn of_laws(&self) -> Vec<Option<Target>> {
        let claimed = self.matching(&[HiddenKind::Outside], |x| {
            x.separation >= MIN_SEPARATION && x.is_outside()
        });
        vec![
            Target::rate(
                "outside, claimed: quantity",
                rate(&claimed, |x| x.quantity),
                [0.95, 1.0],
            ),
            Target::rate("  and variable", rate(&claimed, |x| x.dependence), [0.85, 0.95]),
            Target::ratio(
                "  held-out error after over before",
                &errors(&claimed),
                [0.35, 0.20],
            ),
        ]
    }

    fn of_all(&self) -> Vec<Option<Target>> {
        let none = self.matching(&[HiddenKind::None], |_| true);
        let single = self.matching(&[HiddenKind::One, HiddenKind::None], |_| true);
        let wheel = self.matching(&[HiddenKind::One, HiddenKind::None], |x| {
            x.candidates <= ONE_WHEEL
        });
        let spatial = self.matching(&[HiddenKind::Spatial], |x| x.separation >= MIN_SEPARATION);
        let to_name = numbers(&wheel, |x| x.to_name as f64);
        let to_confirm = numbers(&wheel, |x| x.to_confirm as f64);
        vec![
            Target::rate(
                "nothing missing: false claim",
                rate(&none, |x| x.is_claimed),
                [0.03, 0.01],
            )
            .map(Target::least),
            Target::rate(
                "false \"not in the library\"",
                rate(&single, TrialScore::is_outside),
                [0.05, 0.01],
            )
            .map(Target::least),
            Target::mean("evaluations to name, one wheel", &to_name, [900.0, 600.0]),
            Target::mean("evaluations to confirm, one wheel", &to_confirm, [3000.0, 2000.0]),
            Target::rate(
                "scm, one effect: right class",
                rate(&spatial, |x| x.is_right),
                [0.90, 0.97],
            ),
            Target::rate("  in the top two", rate(&spatial, |x| x.is_in_two), [0.97, 0.99]),
        ]
    }
}

impl fmt::Display for Tally<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for kind in HiddenKind::ALL {
            let all = self.matching(&[kind], |_| true);
            if all.is_empty() {
                continue;
            }
            let shown = rate(&all, |x| x.over_base >= MIN_SEPARATION);
            let clear = self.matching(&[kind], |x| x.separation >= MIN_SEPARATION);
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
        let stated = self.matching(&[HiddenKind::One, HiddenKind::None, HiddenKind::Outside], |_| {
            true
        });
        for (k, low) in BINS.iter().enumerate() {
            let high = BINS.get(k + 1).copied().unwrap_or(f64::INFINITY);
            let own = stated
                .iter()
                .copied()
                .filter(|x| (*low..high).contains(&x.stated));
            let own: Vec<&TrialScore> = own.collect();
            if !own.is_empty() {
                let [mean, _] = mean(&numbers(&own, |x| x.stated));
                let right = rate(&own, |x| x.is_right);
                writeln!(f, "stated P from {low:.2}, {mean:.3} in the mean: right {right}")?;
            }
        }
        Ok(())
    }
}
