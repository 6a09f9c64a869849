//! False claims of the searches on rigs with a flaw.

use std::fmt;

use record::{Discovery, Verdict};

use super::super::study::rate::Rate;
use super::super::study::record::leader;
use super::flaw::Flaw;

/// The claim of one search.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Claim {
    Nothing,
    Undecided,
    /// A drift, which is the flaw of the rig.
    Drift,
    /// Missing physics, which does not exist.
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
        let leading = record.effects.iter().find(|effect| effect.name != "none");
        leading.is_some_and(|effect| effect.name.starts_with("drift_"))
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

/// Returns a search in one line.
pub fn line(flaw: Flaw, number: u64, is_stated: bool, record: &Discovery) -> String {
    let (statement, claim) = (statement(flaw, is_stated), claim(flaw, record));
    format!(
        "{}{statement} {number}: {claim:?}, {}",
        flaw.name(),
        leader(record)
    )
}

impl Tally {
    /// # Arguments
    /// - `statements`: whether each search of a campaign states the flaw. `records`: the searches of each campaign, one for each statement.
    pub fn new(flaw: Flaw, statements: &[bool], records: &[Vec<Discovery>]) -> Self {
        let claims = |(place, is_stated): (usize, &bool)| {
            let claims = records.iter().map(|searches| claim(flaw, &searches[place]));
            (*is_stated, claims.collect())
        };
        Self {
            flaw,
            claims: statements.iter().enumerate().map(claims).collect(),
        }
    }

    /// Returns the number of campaigns in which missing physics is claimed, with the flaw stated if the experiment can state it.
    pub fn false_claims(&self) -> usize {
        let (_, claims) = &self.claims[0];
        claims.iter().filter(|claim| **claim == Claim::False).count()
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (is_stated, claims) in &self.claims {
            let rate = |wanted: Claim| Rate::new(claims.iter().map(|claim| *claim == wanted));
            let has_goal = *is_stated || self.flaw.column().is_none();
            let goal = if has_goal { " (goal 0)" } else { "" };
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
