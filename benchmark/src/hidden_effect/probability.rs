//! Calibration of the probabilities that searches state: how often a statement is right, by its probability.

use std::fmt;
use std::sync::{Mutex, PoisonError};

use super::study::draw::draw;
use super::study::kind::HiddenKind;
use super::study::noise_free::MIN_SEPARATION;
use super::study::rate::{Rate, mean};
use super::study::score::TrialScore;
use super::study::statement::Statement;
use super::study::trial::search;
use crate::error::StudyError;
use crate::parallel::each;

/// The order of the kinds, which repeats. A third has a law outside the library.
const SCHEDULE: [HiddenKind; 21] = [
    HiddenKind::One,
    HiddenKind::Outlib,
    HiddenKind::Geometry,
    HiddenKind::None,
    HiddenKind::Twovar,
    HiddenKind::Sparse,
    HiddenKind::Two,
    HiddenKind::Outside,
    HiddenKind::Heavy,
    HiddenKind::Triple,
    HiddenKind::Outside,
    HiddenKind::One,
    HiddenKind::Geometry,
    HiddenKind::Outlib,
    HiddenKind::None,
    HiddenKind::Sparse,
    HiddenKind::Twovar,
    HiddenKind::Two,
    HiddenKind::Heavy,
    HiddenKind::Outside,
    HiddenKind::Triple,
];
/// Bounds of the bins of probabilities.
const BOUNDS: [f64; 7] = [0.5, 0.8, 0.9, 0.95, 0.99, 0.999, f64::INFINITY];
/// Statements with at least this probability should be right as often as [`MIN_SURE`] in each kind.
const SURE: f64 = 0.999;
const MIN_SURE: f64 = 0.97;
/// The table is printed each time that so many more experiments are done, so that a run that is cut off has a result.
const PRINTED: usize = 60;

/// Searches a number of experiments of all kinds, and prints a line for each and the calibration of the probabilities.
pub fn run(count: u64, seed: u64) -> Result<(), StudyError> {
    let done = Mutex::new(Vec::new());
    each(count, |place| {
        let (kind, number) = scheduled(place);
        let score = draw(kind, seed, number).and_then(|case| search(kind, &case, number));
        let mut done = done.lock().unwrap_or_else(PoisonError::into_inner);
        match score {
            Ok(score) => {
                println!("{score}");
                done.push(Stated::new(number, &score));
            }
            Err(message) => println!("failed: {} {number}: {message}", kind.name()),
        }
        if done.len() % PRINTED == 0 {
            println!("{}", Calibration(&done));
        }
        Ok::<_, StudyError>(())
    })?;
    let mut done = done.into_inner().unwrap_or_else(PoisonError::into_inner);
    done.sort_by_key(|stated| (stated.kind as u64, stated.number));
    println!("{}", Calibration(&done));
    Ok(())
}

/// Returns the kind of an experiment, and its number among the experiments of this kind.
fn scheduled(place: u64) -> (HiddenKind, u64) {
    let length = SCHEDULE.len() as u64;
    let (turn, place) = (place / length, (place % length) as usize);
    let kind = SCHEDULE[place];
    let count = |kinds: &[HiddenKind]| kinds.iter().filter(|other| **other == kind).count() as u64;
    (kind, turn * count(&SCHEDULE) + count(&SCHEDULE[..place]))
}

/// The statements of one search.
pub struct Stated {
    kind: HiddenKind,
    number: u64,
    hidden: String,
    separation: f64,
    truth_nats: Option<f64>,
    leading: Statement,
    claim: Option<Statement>,
}

impl Stated {
    fn new(number: u64, score: &TrialScore) -> Self {
        Self {
            kind: score.kind,
            number,
            hidden: score.hidden.clone(),
            separation: score.separation,
            truth_nats: score.truth_nats,
            leading: score.leading.clone(),
            claim: score.claim.clone(),
        }
    }
}

/// The calibration of the probabilities over searches.
pub struct Calibration<'a>(pub &'a [Stated]);

fn right<'a>(statements: impl IntoIterator<Item = &'a Statement>) -> Rate {
    Rate::new(statements.into_iter().map(|statement| statement.is_right))
}

/// A rate with its exact 90 % interval.
struct Shown(Rate);

impl fmt::Display for Shown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Rate { count, total } = self.0;
        let [low, high] = self.0.exact_interval();
        let cell = match total {
            0 => "0/0".to_owned(),
            _ => format!("{count}/{total} = {:.3} [{low:.3}, {high:.3}]", self.0.share()),
        };
        write!(f, "{cell:<30}")
    }
}

impl Calibration<'_> {
    /// Returns the most probable explanations that say that something is missing.
    fn leading(&self) -> impl Iterator<Item = &Statement> {
        let all = self.0.iter().map(|stated| &stated.leading);
        all.filter(|statement| statement.is_something)
    }

    fn claims(&self) -> impl Iterator<Item = &Statement> {
        self.0.iter().filter_map(|stated| stated.claim.as_ref())
    }

    fn bin(f: &mut fmt::Formatter<'_>, name: &str, statements: &[&Statement]) -> fmt::Result {
        let rate = right(statements.iter().copied());
        let probabilities: Vec<f64> = statements.iter().map(|statement| statement.probability).collect();
        write!(f, "  {name:<14} {}", Shown(rate))?;
        if rate.total > 0 {
            let ([mean, _], [low, high]) = (mean(&probabilities), rate.exact_interval());
            let place = match mean {
                mean if mean < low => "below the interval",
                mean if mean > high => "ABOVE the interval",
                _ => "inside",
            };
            write!(f, " mean P {mean:.4} {place}")?;
        }
        writeln!(f)
    }

    fn bins(f: &mut fmt::Formatter<'_>, what: &str, statements: &[&Statement]) -> fmt::Result {
        writeln!(f, "{what}")?;
        for bounds in BOUNDS.windows(2) {
            let is_in = |statement: &&&Statement| (bounds[0]..bounds[1]).contains(&statement.probability);
            let bin: Vec<&Statement> = statements.iter().filter(is_in).copied().collect();
            let name = match bounds[1].is_finite() {
                true => format!("{} to {}", bounds[0], bounds[1]),
                false => format!("{} and more", bounds[0]),
            };
            Self::bin(f, &name, &bin)?;
        }
        Ok(())
    }

    fn sure_by_kind(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "P of {SURE} and more, by kind (at least {MIN_SURE} should be right): leading; claimed"
        )?;
        let is_sure = |statement: &&Statement| statement.is_something && statement.probability >= SURE;
        for kind in HiddenKind::ALL {
            let of_kind = || self.0.iter().filter(|stated| stated.kind == kind);
            let leading = right(of_kind().map(|stated| &stated.leading).filter(is_sure));
            let claimed = right(
                of_kind()
                    .filter_map(|stated| stated.claim.as_ref())
                    .filter(is_sure),
            );
            let count = of_kind().count();
            if count > 0 {
                let short = if leading.total > 0 && leading.share() < MIN_SURE {
                    "SHORT"
                } else {
                    ""
                };
                writeln!(
                    f,
                    "  {:<9} of {count:>3}: {} {} {short}",
                    kind.name(),
                    Shown(leading),
                    Shown(claimed)
                )?;
            }
        }
        Ok(())
    }

    fn sure_and_wrong(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "wrong with P of {SURE} and more:")?;
        for stated in self.0 {
            let is_wrong = |s: &&Statement| s.is_something && !s.is_right && s.probability >= SURE;
            let claim = stated.claim.as_ref().filter(is_wrong);
            let Some(wrong) = claim.or(Some(&stated.leading).filter(is_wrong)) else {
                continue;
            };
            let (kind, text) = (stated.kind.name(), &wrong.text);
            write!(f, "  {kind} {} hidden {}: {text}", stated.number, stated.hidden)?;
            write!(f, " P {:.5}", wrong.probability)?;
            if claim.is_none() {
                write!(f, ", not claimed")?;
            }
            if wrong.is_alias {
                write!(f, ", in one class with a hidden effect")?;
            }
            if stated.separation < MIN_SEPARATION {
                let nats = stated.separation;
                write!(
                    f,
                    ", and {nats:.1} nats separate the truth from its rivals in noise-free data"
                )?;
            }
            match stated.truth_nats {
                Some(nats) => writeln!(f, "; the truth has {nats:.1} nats more than the best set")?,
                None => writeln!(f, "; the truth is not among the sets")?,
            }
        }
        Ok(())
    }
}

impl fmt::Display for Calibration<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{} experiments", self.0.len())?;
        let leading: Vec<&Statement> = self.leading().collect();
        Self::bins(f, "what leads, claimed or not:", &leading)?;
        let claims: Vec<&Statement> = self.claims().collect();
        Self::bins(f, "what is claimed:", &claims)?;
        let nothing = self.0.iter().map(|stated| &stated.leading);
        let nothing: Vec<&Statement> = nothing.filter(|statement| !statement.is_something).collect();
        Self::bin(f, "nothing leads", &nothing)?;
        let aliases = leading.iter().filter(|statement| statement.is_alias).count();
        writeln!(
            f,
            "  of the wrong that lead, {aliases} are in one class with a hidden effect"
        )?;
        self.sure_by_kind(f)?;
        self.sure_and_wrong(f)
    }
}
