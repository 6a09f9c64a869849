//! What changed since a reference campaign: its posterior as the prior of the next one, in which an effect acts.

use record::Discovery;
use shared::file::FileSet;
use statistics::rng::Stream;

use super::study::case::SyntheticCase;
use super::study::error::StudyError;
use super::study::kind::HiddenKind;
use super::study::parallel::each;
use super::study::posterior::sample;
use super::study::rate::Rate;
use super::study::record::{is_right, record};
use super::study::trial::draw;

/// The truths are others than those of the other kinds.
const FIRST: u64 = 4_000_000;
/// Random streams of the noise of reference campaigns.
const STAGE: u64 = 1 << 48;
/// Every so many campaigns nothing has changed.
const UNCHANGED: u64 = 4;
/// Draws of the prior until the model takes it with the effect and without.
const MAX_DRAWN: u64 = 20;
/// Most effects in a combination of the search.
const MAX_EFFECTS: usize = 3;
const SAMPLER: &str = "[sampler]\nparticles = 500\n";
const FILE: &str = "reference.csv";

/// Two searches of one campaign, and its truth.
pub struct Compared {
    truth: Option<String>,
    /// With the reference's posterior as the prior, and with the priors of the job.
    with: Discovery,
    without: Discovery,
}

/// What came out of so many campaigns.
pub struct Tally {
    what: &'static str,
    /// Of campaigns in which something changed: whether the claim is right; `None` without one.
    changed: Vec<Option<bool>>,
    /// Of the others: whether something is claimed.
    claimed: Vec<bool>,
}

/// Searches so many campaigns with and without their reference, and prints how often the change is named.
pub fn run(count: u64, seed: u64) -> Result<(), StudyError> {
    let compared = each(count, |number| {
        let compared = one(seed, number)?;
        println!("{}", compared.line(number));
        Ok::<_, StudyError>(compared)
    })?;
    let compared: Vec<Compared> = compared.into_iter().collect::<Result<_, StudyError>>()?;
    for tally in [
        Tally::new("with the reference", &compared, |c| &c.with),
        Tally::new("without", &compared, |c| &c.without),
    ] {
        print!("{tally}");
    }
    match compared.iter().filter(|c| c.is_right() == Some(false)).count() {
        0 => Ok(()),
        wrong => Err(format!("{wrong} searches with the reference name what did not change").into()),
    }
}

/// Draws the two campaigns of a number, and searches the second.
pub fn one(seed: u64, number: u64) -> Result<Compared, StudyError> {
    let (case, reference) = campaigns(seed, number)?;
    let job = case.plan.job();
    let posterior = sample(&job, &reference, SAMPLER, seed)?;
    let (model, _) = job.toml.split_once("[priors]").ok_or("the job has no priors")?;
    let next = FileSet {
        toml: format!("{model}[priors]\nposterior = \"{FILE}\"\n"),
        files: [(FILE.to_owned(), posterior.csv())].into(),
    };
    let search = |job: &FileSet| record(job, &case.experiment(), MAX_EFFECTS, 1);
    Ok(Compared {
        with: search(&next)?,
        without: search(&job)?,
        truth: case.hidden.first().cloned(),
    })
}

/// A campaign, and one on the same soil before.
fn campaigns(seed: u64, number: u64) -> Result<(SyntheticCase, FileSet), StudyError> {
    let kind = if number % UNCHANGED == UNCHANGED - 1 {
        HiddenKind::None
    } else {
        HiddenKind::One
    };
    for attempt in 0..MAX_DRAWN {
        // An attempt keeps the effect whose turn it is.
        let case = draw(kind, seed + attempt, FIRST + number)?;
        if let Some(reference) = case.reference(Stream::new(seed, STAGE, number, attempt))? {
            return Ok((case, reference));
        }
    }
    Err(format!("the model rejected {MAX_DRAWN} reference campaigns in a row").into())
}

impl Compared {
    /// Whether the claim of the search with the reference is right; `None` without one.
    pub fn is_right(&self) -> Option<bool> {
        is_right(&self.with, self.truth.as_deref())
    }

    pub fn line(&self, number: u64) -> String {
        let said = |record: &Discovery| {
            let said = match is_right(record, self.truth.as_deref()) {
                Some(true) => "right",
                Some(false) => "WRONG",
                None => "open",
            };
            let first = record.effects.first();
            format!(
                "{said} ({:?}, {} P {:.3}, {} evaluations)",
                record.verdict,
                first.map_or("", |effect| effect.name.as_str()),
                first.map_or(0.0, |effect| effect.probability),
                record.evaluations
            )
        };
        format!(
            "reference {number} {}: with {}; without {}",
            self.truth.as_deref().unwrap_or("none"),
            said(&self.with),
            said(&self.without)
        )
    }
}

impl Tally {
    fn new(what: &'static str, compared: &[Compared], of: fn(&Compared) -> &Discovery) -> Self {
        let changed = compared.iter().filter(|c| c.truth.is_some());
        let unchanged = compared.iter().filter(|c| c.truth.is_none());
        Self {
            what,
            changed: changed.map(|c| is_right(of(c), c.truth.as_deref())).collect(),
            claimed: unchanged.map(|c| is_right(of(c), None).is_some()).collect(),
        }
    }
}

impl std::fmt::Display for Tally {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let rate = |wanted| Rate::new(self.changed.iter().map(|claim| *claim == wanted));
        writeln!(f, "{}", self.what)?;
        writeln!(f, "  the change named or classed: {}", rate(Some(true)))?;
        writeln!(f, "  another named: {} (goal 0)", rate(Some(false)))?;
        let claimed = Rate::new(self.claimed.iter().copied());
        writeln!(f, "  claimed where nothing changed: {claimed} (goal 0)")
    }
}
