//! `coordinator library`: adds, lists and removes laws that every later search tries.

use std::fmt::Write;

use anyhow::bail;
use shared::api::{LibraryLawRemoved, NewLibraryLaw};
use shared::text_file::read_text;

use super::output::say;
use super::place::Place;
use crate::config::{AddLawArguments, LibraryCommand, SourceArguments};
use crate::effect::library::{LawInStudy, LibraryLaw};
use result::number;

pub(super) async fn library(command: &LibraryCommand) -> anyhow::Result<()> {
    match command {
        LibraryCommand::Add(arguments) => add(arguments).await,
        LibraryCommand::List(source) => list(source).await,
        LibraryCommand::Remove { name, source } => {
            let place = writable(source).await?;
            let removed: LibraryLawRemoved = place.delete(&format!("/v1/library/{name}")).await?;
            Ok(say(&format!("later searches do not try {}\n", removed.name))?)
        }
    }
}

async fn add(arguments: &AddLawArguments) -> anyhow::Result<()> {
    let new = NewLibraryLaw {
        text: arguments.file.as_deref().map(read_text).transpose()?,
        calibration: arguments.from,
        law: arguments.law.clone(),
        name: arguments.name.clone(),
    };
    let place = writable(&arguments.source).await?;
    let law: LibraryLaw = place.post("/v1/library", &new).await?;
    let text = format!(
        "{} (version {}) is tried by every search that begins from now on\n{}",
        law.name,
        law.version,
        about(&law)
    );
    Ok(say(&text)?)
}

/// Opens a service: the folder of a run has one study, in which no later search begins.
async fn writable(source: &SourceArguments) -> anyhow::Result<Place> {
    if let Some(out) = &source.out {
        bail!(
            "{} is the folder of one study: the library belongs to a service (--url); a job tries a law by [discovery] candidate_files",
            out.display()
        );
    }
    Place::open(source).await
}

async fn list(source: &SourceArguments) -> anyhow::Result<()> {
    let place = Place::open(source).await?;
    let laws: Vec<LibraryLaw> = place.get("/v1/library").await?;
    if laws.is_empty() {
        return Ok(say(
            "no law has joined the library: coordinator library add FILE, or library add --from ID with what a search found\n",
        )?);
    }
    let texts = laws
        .iter()
        .map(|law| format!("{} (version {})\n{}", law.name, law.version, about(law)));
    Ok(say(&texts.collect::<Vec<_>>().join("\n"))?)
}

/// Returns a law in lines: what it is, where it comes from, and what each study says of it.
fn about(law: &LibraryLaw) -> String {
    let mut text = format!(
        "  {}\n  {}\n  {}\n",
        law.summary,
        law.source,
        law.evidence_words()
    );
    for study in &law.studies {
        // Writing to a text cannot fail.
        let _ = writeln!(text, "  {}", study_line(study));
    }
    text
}

/// Returns a line about a study: `study 4 rig-b: held, 41.2 nats, P 0.98; shear_j.strength 0.31 (not counted)`.
fn study_line(study: &LawInStudy) -> String {
    let parameters: Vec<String> = study
        .parameters
        .iter()
        .map(|(name, value)| {
            let unit = study
                .units
                .get(name)
                .map(String::as_str)
                .filter(|unit| *unit != "1");
            let unit = unit.map_or(String::new(), |unit| format!(" {unit}"));
            format!("{name} {}{unit}", number::significant(*value, 3))
        })
        .collect();
    let given = match study.given.as_slice() {
        [] => String::new(),
        given => format!(" beside {}", given.join(", ")),
    };
    format!(
        "study {} {}: {}{given}, {:.1} nats, P {:.3}; {}{}",
        study.study,
        study.name,
        study.standing.words(),
        study.log_bayes_factor,
        study.probability,
        parameters.join(", "),
        if study.counts {
            ""
        } else {
            " (not counted: the measurements count elsewhere)"
        }
    )
}
