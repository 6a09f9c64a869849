//! False claims of the searches on rigs with a flaw.

use std::fmt;

use record::{Discovery, Verdict};

use super::super::study::rate::Rate;
use super::flaw::Flaw;

/// What one search claims.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Claim {
    Nothing,
    Undecided,
    /// A drift, which is there.
    Drift,
    /// Physics, which is not.
    False,
}

/// The claims on campaigns with one flaw, for each way of stating it.
pub struct Tally {
    flaw: Flaw,
    claims: Vec<(bool, Vec<Claim>)>,
}

fn claim(flaw: Flaw, record: &Discovery) -> Claim {
    let drifts = matches!(flaw, Flaw::SortedDrift | Flaw::RandomDrift);
    let is_drift = || {
        record
            .effects
            .iter()
            .find(|e| e.name != "none")
            .is_some_and(|e| e.name.starts_with("drift_"))
    };
    match record.verdict {
        Verdict::NothingDetectable => Claim::Nothing,
        Verdict::Undecided => Claim::Undecided,
        Verdict::Named | Verdict::Class if drifts && is_drift() => Claim::Drift,
        Verdict::Named | Verdict::Class | Verdict::NotInLibrary => Claim::False,
    }
}

fn statement(flaw: Flaw, is_stated: bool) -> String {
    match flaw.column() {
        Some(column) if is_stated => format!(", {column} stated"),
        Some(column) => format!(", {column} not stated"),
        None => String::new(),
    }
}

/// A search in one line.
pub fn line(flaw: Flaw, number: u64, is_stated: bool, record: &Discovery) -> String {
    let first = record.effects.first();
    format!(
        "{}{} {number}: {:?}, {} P {:.3}",
        flaw.name(),
        statement(flaw, is_stated),
        claim(flaw, record),
        first.map_or("", |effect| effect.name.as_str()),
        first.map_or(0.0, |effect| effect.probability),
    )
}

impl Tally {
    /// # Arguments
    /// - `statements`: whether the flaw is stated, for each search of a campaign. `records`: of each campaign, one for each statement.
    pub fn new(flaw: Flaw, statements: &[bool], records: &[Vec<Discovery>]) -> Self {
        let of = |(place, is_stated): (usize, &bool)| {
            let claims = records.iter().map(|own| claim(flaw, &own[place]));
            (*is_stated, claims.collect())
        };
        Self {
            flaw,
            claims: statements.iter().enumerate().map(of).collect(),
        }
    }

    /// Campaigns in which physics is claimed although the flaw is stated, or cannot be.
    pub fn false_claims(&self) -> usize {
        let (_, claims) = &self.claims[0];
        claims.iter().filter(|claim| **claim == Claim::False).count()
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (is_stated, claims) in &self.claims {
            let rate = |wanted: Claim| Rate::new(claims.iter().map(|claim| *claim == wanted));
            let goal = if *is_stated || self.flaw.column().is_none() {
                " (goal 0)"
            } else {
                ""
            };
            writeln!(f, "{}{}", self.flaw.name(), statement(self.flaw, *is_stated))?;
            writeln!(f, "  false claims: {}{goal}", rate(Claim::False))?;
            for (what, wanted) in [
                ("nothing detectable", Claim::Nothing),
                ("undecided", Claim::Undecided),
                ("a drift named", Claim::Drift),
            ] {
                let rate = rate(wanted);
                if rate.count > 0 {
                    writeln!(f, "  {what}: {rate}")?;
                }
            }
        }
        Ok(())
    }
}
