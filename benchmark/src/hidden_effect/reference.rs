//! Changes since a reference campaign, whose posterior is the prior of the next campaign, in which an effect acts.

use record::Discovery;
use shared::file::FileSet;
use statistics::rng::Stream;

use super::study::case::SyntheticCase;
use super::study::draw::{draw, draw_named};
use super::study::kind::HiddenKind;
use super::study::posterior::sample;
use super::study::rate::Rate;
use super::study::record::{is_right, leader, record, word};
use crate::error::StudyError;
use crate::parallel::each;

/// The number of the first truth, which no other kind uses.
const FIRST: u64 = 4_000_000;
/// The random stream of the noise of reference campaigns.
const STAGE: u64 = 1 << 48;
/// One campaign in this number is unchanged.
const UNCHANGED: u64 = 4;
/// The largest number of draws of the prior until the model accepts both campaigns.
const MAX_DRAWN: u64 = 20;
/// The largest number of effects in a combination of the search.
const MAX_EFFECTS: usize = 3;
const SAMPLER: &str = "[sampler]\nparticles = 500\n";
const FILE: &str = "reference.csv";

/// Two searches of one campaign, with its truth.
pub struct Compared {
    truth: Option<String>,
    /// The search with the posterior of the reference as the prior.
    with: Discovery,
    /// The search with the priors of the job.
    without: Discovery,
}

/// The claims of one kind of search on all campaigns.
pub struct Tally {
    what: &'static str,
    /// For each changed campaign, whether the claim is right; `None` without a claim.
    changed: Vec<Option<bool>>,
    /// For each unchanged campaign, whether something is claimed.
    claimed: Vec<bool>,
}

/// Searches a number of campaigns with and without their reference, and prints how often the change is named.
pub fn run(count: u64, seed: u64) -> Result<(), StudyError> {
    let compared = each(count, |number| {
        let compared = one(seed, number)?;
        println!("{}", compared.line(number));
        Ok::<_, StudyError>(compared)
    })?;
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
    let kind = if number % UNCHANGED == UNCHANGED - 1 {
        HiddenKind::None
    } else {
        HiddenKind::One
    };
    // The effect depends on the number alone, so that every attempt has the same one.
    compare(seed, number, |seed| draw(kind, seed, FIRST + number))
}

/// Draws a campaign in which an effect acts, and its reference, and searches the campaign.
pub fn named(effect: &str, seed: u64) -> Result<Compared, StudyError> {
    compare(seed, FIRST, |seed| draw_named(effect, seed))
}

/// Searches a campaign with and without its reference.
///
/// # Arguments
/// - `number`: of the stream of the reference. `draw`: draws the campaign by a seed.
fn compare(
    seed: u64,
    number: u64,
    draw: impl Fn(u64) -> Result<SyntheticCase, StudyError>,
) -> Result<Compared, StudyError> {
    let (case, reference) = campaigns(seed, number, draw)?;
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

/// Returns a campaign, with an earlier campaign on the same soil.
fn campaigns(
    seed: u64,
    number: u64,
    draw: impl Fn(u64) -> Result<SyntheticCase, StudyError>,
) -> Result<(SyntheticCase, FileSet), StudyError> {
    for attempt in 0..MAX_DRAWN {
        let case = draw(seed + attempt)?;
        if let Some(reference) = case.reference(Stream::new(seed, STAGE, number, attempt))? {
            return Ok((case, reference));
        }
    }
    Err(format!("the model rejected {MAX_DRAWN} reference campaigns in a row").into())
}

impl Compared {
    /// Returns whether the claim of the search with the reference is right; `None` without a claim.
    pub fn is_right(&self) -> Option<bool> {
        is_right(&self.with, self.truth.as_deref())
    }

    pub fn line(&self, number: u64) -> String {
        let answer = |record: &Discovery| {
            let (answer, leader) = (word(is_right(record, self.truth.as_deref())), leader(record));
            format!(
                "{answer} ({:?}, {leader}, {} evaluations)",
                record.verdict, record.evaluations
            )
        };
        let truth = self.truth.as_deref().unwrap_or("none");
        let (with, without) = (answer(&self.with), answer(&self.without));
        format!("reference {number} {truth}: with {with}; without {without}")
    }
}

impl Tally {
    fn new(what: &'static str, compared: &[Compared], search: fn(&Compared) -> &Discovery) -> Self {
        let changed = compared.iter().filter(|c| c.truth.is_some());
        let unchanged = compared.iter().filter(|c| c.truth.is_none());
        Self {
            what,
            changed: changed.map(|c| is_right(search(c), c.truth.as_deref())).collect(),
            claimed: unchanged.map(|c| is_right(search(c), None).is_some()).collect(),
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
