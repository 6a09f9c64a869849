//! What came out, against what was aimed at [DISCOVERY 4].

use std::fmt;

use super::clear::CLEAR;
use super::fate::Fate;
use super::kind::Kind;
use super::rate::{Rate, mean, median};

/// Lower ends of the bins of stated probabilities.
const BINS: [f64; 5] = [0.0, 0.5, 0.8, 0.95, 0.99];

/// One line of the table.
#[derive(Debug, Clone)]
pub(crate) struct Target {
    pub(crate) what: &'static str,
    pub(crate) measured: f64,
    /// Its 95 % interval, or what it is a mean of.
    shown: String,
    floor: f64,
    aim: f64,
    /// Whether less is better.
    is_least: bool,
}

impl Target {
    fn rate(what: &'static str, rate: Rate, floor: f64, aim: f64) -> Option<Self> {
        let [low, high] = rate.interval();
        (rate.of > 0).then(|| Self {
            what,
            measured: rate.share(),
            shown: format!("{} of {}, {low:.3} to {high:.3}", rate.count, rate.of),
            floor,
            aim,
            is_least: false,
        })
    }

    fn least(self) -> Self {
        Self {
            is_least: true,
            ..self
        }
    }

    fn mean(what: &'static str, values: &[f64], floor: f64, aim: f64) -> Option<Self> {
        let [average, error] = mean(values);
        let most = values.iter().copied().fold(0.0, f64::max);
        (!values.is_empty()).then(|| Self {
            what,
            measured: average,
            shown: format!("± {error:.3}, median {:.3}, most {most:.2}", median(values)),
            floor,
            aim,
            is_least: true,
        })
    }

    /// Whether the floor is reached.
    pub(crate) fn holds(&self) -> bool {
        self.reaches(self.floor)
    }

    fn reaches(&self, goal: f64) -> bool {
        if self.is_least {
            self.measured <= goal
        } else {
            self.measured >= goal
        }
    }
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let said = match (self.reaches(self.aim), self.holds()) {
            (true, _) => "aim",
            (false, true) => "floor",
            (false, false) => "SHORT",
        };
        write!(
            f,
            "{:<58} {:>8.3}  {:<38} {:>7} {:>7}  {said}",
            self.what, self.measured, self.shown, self.floor, self.aim
        )
    }
}

/// Everything that came out.
pub(crate) struct Tally<'a>(pub(crate) &'a [Fate]);

impl Tally<'_> {
    fn of(&self, holds: impl Fn(&Fate) -> bool) -> Vec<&Fate> {
        self.0.iter().filter(|fate| holds(fate)).collect()
    }

    /// Every target that these experiments say something of.
    pub(crate) fn targets(&self) -> Vec<Target> {
        let one = self.of(|x| x.kind == Kind::One && x.separation >= CLEAR);
        let alone: Vec<&Fate> = one.iter().copied().filter(|x| x.is_alone).collect();
        let single = self.of(|x| matches!(x.kind, Kind::One | Kind::None));
        let none = self.of(|x| x.kind == Kind::None);
        let law = self.of(|x| x.kind == Kind::Outside && x.over_base >= CLEAR && x.separation >= CLEAR);
        let law_claimed: Vec<&Fate> = law.iter().copied().filter(|x| x.is_outside()).collect();
        let several = self.of(|x| matches!(x.kind, Kind::Two | Kind::Three));
        let (two, three) = (
            self.of(|x| x.kind == Kind::Two),
            self.of(|x| x.kind == Kind::Three),
        );
        let spatial = self.of(|x| x.kind == Kind::Spatial && x.separation >= CLEAR);
        let rate = |all: &[&Fate], holds: &dyn Fn(&Fate) -> bool| Rate::new(all.iter().map(|x| holds(x)));
        let claimed: Vec<&Fate> = one.iter().copied().filter(|x| x.is_claimed).collect();
        let numbers =
            |all: &[&Fate], of: &dyn Fn(&Fate) -> f64| -> Vec<f64> { all.iter().map(|x| of(x)).collect() };
        let shrunk = |what, all: &[&Fate], floor, aim| {
            let all: Vec<&&Fate> = all.iter().filter(|x| x.held_out.after.is_finite()).collect();
            let sum = |of: &dyn Fn(&Fate) -> f64| all.iter().map(|x| of(x)).sum::<f64>();
            let ratios: Vec<f64> = all.iter().map(|x| x.held_out.after / x.held_out.before).collect();
            (!all.is_empty()).then(|| Target {
                what,
                measured: sum(&|x| x.held_out.after) / sum(&|x| x.held_out.before),
                shown: format!("of means over {}; median ratio {:.3}", all.len(), median(&ratios)),
                floor,
                aim,
                is_least: true,
            })
        };
        let found: Vec<&Fate> = self.of(|x| x.is_claimed && x.kind != Kind::Spatial);
        let inside = found.iter().fold(Rate { count: 0, of: 0 }, |sum, x| Rate {
            count: sum.count + x.held_out.covered.count,
            of: sum.of + x.held_out.covered.of,
        });
        let one_wheel = self.of(|x| matches!(x.kind, Kind::One | Kind::None) && x.held_out.before >= 0.0);
        [
            Target::rate("one effect: right class", rate(&one, &|x| x.is_right), 0.90, 0.97),
            Target::rate(
                "  right name, alone in its class",
                rate(&alone, &|x| x.is_named),
                0.90,
                0.97,
            ),
            Target::rate("  in the top two", rate(&one, &|x| x.is_in_two), 0.97, 0.99),
            Target::rate(
                "  right when claimed",
                rate(&claimed, &|x| x.claim_is_right),
                0.95,
                0.99,
            ),
            Target::rate(
                "  95 % set holds the truth",
                rate(&one, &|x| x.is_covered),
                0.93,
                0.97,
            ),
            Target::mean(
                "  classes in that set",
                &numbers(&one, &|x| x.set_size as f64),
                1.5,
                1.2,
            ),
            shrunk("  held-out error after over before", &one, 0.25, 0.10),
            Target::mean(
                "  held-out error after, sigma",
                &numbers(&one, &|x| x.held_out.after),
                0.5,
                0.3,
            ),
            Target::rate(
                "nothing missing: false claim",
                rate(&none, &|x| x.is_claimed),
                0.03,
                0.01,
            )
            .map(Target::least),
            Target::rate(
                "false \"not in the library\"",
                rate(&single, &|x| x.is_outside()),
                0.05,
                0.01,
            )
            .map(Target::least),
            Target::rate(
                "several effects: false \"not in the library\"",
                rate(&several, &|x| x.is_outside()),
                0.05,
                0.01,
            )
            .map(Target::least),
            Target::rate("two effects exact", rate(&two, &|x| x.is_exact), 0.80, 0.94),
            Target::rate("three effects exact", rate(&three, &|x| x.is_exact), 0.50, 0.70),
            Target::rate(
                "outside, claimed: quantity",
                rate(&law_claimed, &|x| x.quantity),
                0.95,
                1.0,
            ),
            Target::rate("  and variable", rate(&law_claimed, &|x| x.pair), 0.85, 0.95),
            Target::rate(
                "outside, beyond the library by 10 nats: claimed",
                rate(&law, &|x| x.is_outside()),
                0.75,
                0.90,
            ),
            shrunk(
                "outside, claimed: held-out error after over before",
                &law_claimed,
                0.35,
                0.20,
            ),
            Target::rate("90 % intervals hold measurements, least", inside, 0.87, 0.88),
            Target::rate("90 % intervals hold measurements, most", inside, 0.95, 0.92).map(Target::least),
            Target::mean(
                "evaluations to name",
                &numbers(&one_wheel, &|x| x.to_name as f64),
                900.0,
                600.0,
            ),
            Target::mean(
                "evaluations to confirm",
                &numbers(&one_wheel, &|x| x.to_confirm as f64),
                3000.0,
                2000.0,
            ),
            Target::rate(
                "scm, one effect: right class",
                rate(&spatial, &|x| x.is_right),
                0.90,
                0.97,
            ),
            Target::rate("  in the top two", rate(&spatial, &|x| x.is_in_two), 0.97, 0.99),
        ]
        .into_iter()
        .flatten()
        .collect::<Vec<_>>()
        .into_iter()
        .chain(Target::mean(
            "seconds for one search",
            &numbers(&single, &|x| x.seconds),
            f64::INFINITY,
            f64::INFINITY,
        ))
        .collect()
    }
}

impl fmt::Display for Tally<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for kind in Kind::ALL {
            let all = self.of(|x| x.kind == kind);
            if all.is_empty() {
                continue;
            }
            let clear = all.iter().filter(|x| x.separation >= CLEAR).count();
            let shown = all.iter().filter(|x| x.over_base >= CLEAR).count();
            writeln!(
                f,
                "{}: {} experiments, {shown} beyond the base by {CLEAR} nats without noise, {clear} beyond every rival",
                kind.name(),
                all.len()
            )?;
        }
        writeln!(
            f,
            "{:<58} {:>8}  {:<38} {:>7} {:>7}",
            "target", "measured", "counts, 95 %", "floor", "aim"
        )?;
        for target in self.targets() {
            writeln!(f, "{target}")?;
        }
        let stated = self.of(|x| matches!(x.kind, Kind::One | Kind::None | Kind::Outside));
        for (k, low) in BINS.iter().enumerate() {
            let high = BINS.get(k + 1).copied().unwrap_or(f64::INFINITY);
            let own = stated.iter().filter(|x| (*low..high).contains(&x.stated));
            let own: Vec<_> = own.collect();
            if own.is_empty() {
                continue;
            }
            let [mean, _] = mean(&own.iter().map(|x| x.stated).collect::<Vec<_>>());
            writeln!(
                f,
                "stated P from {low:.2}, {mean:.3} in the mean: right {}",
                Rate::new(own.iter().map(|x| x.is_right))
            )?;
        }
        let all: Vec<f64> = self.0.iter().map(|x| x.evaluations as f64).collect();
        let most = all.iter().copied().fold(0.0, f64::max);
        write!(
            f,
            "all evaluations: {:.0} in the mean, {most:.0} at most",
            mean(&all)[0]
        )
    }
}
