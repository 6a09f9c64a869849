//! `coordinator watch`: follows the runs of a file, or of the files of a folder, while a campaign lasts.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::ensure;
use prediction::follow::Followed;
use serde::Deserialize;
use shared::api::{CalibrationStatus, NewFollow};
use shared::experiment::Experiment;
use shared::file::FileSet;
use shared::text_file::read_text;

use super::incoming::Incoming;
use super::output::{remark, say};
use super::place::Place;
use super::predict::target;
use super::run_table::{new_rows, run_names};
use crate::config::WatchArguments;
use report::terminal;

/// Interval between two looks at the file.
const LOOK: Duration = Duration::from_millis(200);
/// Interval after a look that failed, because a service that is away or refuses a row is not asked five times a second.
const LOOK_AGAIN: Duration = Duration::from_secs(2);

/// An experiment as the service answers it.
#[derive(Deserialize)]
struct StoredExperiment {
    toml: String,
    files: BTreeMap<String, String>,
}

pub(super) async fn watch(config: &WatchArguments) -> anyhow::Result<()> {
    let place = Place::open(&config.source).await?;
    let id = target(&place, config.id).await?;
    let status: CalibrationStatus = place.get(&format!("/v1/calibrations/{id}")).await?;
    let stored: StoredExperiment = place
        .get(&format!("/v1/experiments/{}", status.experiment))
        .await?;
    let experiment = FileSet {
        toml: stored.toml,
        files: stored.files,
    };
    let file = Experiment::runs_file("experiment.toml", &experiment)?;
    let mut watch = Watch {
        known: run_names(experiment.named("experiment.toml", &file)?, Path::new(&file))?,
        rows: Rows::new(config, experiment)?,
        place,
        id,
        max_evaluations: config.max_evaluations,
        followed: String::new(),
    };
    let mut said = String::new();
    loop {
        let looked = watch.look(Instant::now()).await;
        if config.once && !matches!(looked, Ok(true)) {
            return looked.map(|_| ());
        }
        // An editor that saves the file takes it away for a moment, a row may be mistyped, and a service may be away.
        let problem = looked
            .err()
            .map_or_else(String::new, |error| format!("{error:#}"));
        if !problem.is_empty() && problem != said {
            remark("error:", &problem);
        }
        let interval = if problem.is_empty() { LOOK } else { LOOK_AGAIN };
        said = problem;
        tokio::time::sleep(interval).await;
    }
}

/// Where the rows of further runs come from.
enum Rows {
    /// A file to which rows are appended.
    File(PathBuf),
    /// A folder into which files are dropped.
    Folder(Incoming),
}

impl Rows {
    fn new(config: &WatchArguments, experiment: FileSet) -> anyhow::Result<Rows> {
        let map = config
            .map
            .as_ref()
            .map(|map| -> anyhow::Result<_> { Ok((map.display().to_string(), read_text(map)?)) });
        let map = map.transpose()?;
        if config.runs.is_dir() {
            return Ok(Rows::Folder(Incoming::new(&config.runs, map, experiment)?));
        }
        ensure!(
            map.is_none(),
            "--map is of a folder, but {} is none",
            config.runs.display()
        );
        Ok(Rows::File(config.runs.clone()))
    }
}

/// A campaign that is watched.
struct Watch {
    place: Place,
    id: i64,
    /// Names of the runs of the calibration's experiment.
    known: BTreeSet<String>,
    rows: Rows,
    max_evaluations: Option<usize>,
    /// The rows that were followed last.
    followed: String,
}

impl Watch {
    /// Follows the rows that there are now, unless they are those that were followed last. Returns whether a file may still be written.
    async fn look(&mut self, now: Instant) -> anyhow::Result<bool> {
        let (changed, is_waiting) = match &mut self.rows {
            Rows::File(path) => {
                let text = read_text(path)?;
                // A row that is being written has no line end yet.
                let whole = text.rfind('\n').map_or("", |end| &text[..=end]);
                (changed_rows(whole, &self.known, path, &self.followed)?, false)
            }
            Rows::Folder(incoming) => {
                let is_waiting = incoming.take(now)?;
                let path = Path::new("runs.csv");
                (
                    changed_rows(incoming.table()?, &self.known, path, &self.followed)?,
                    is_waiting,
                )
            }
        };
        if let Some(runs) = changed {
            let begin = Instant::now();
            let new = NewFollow {
                runs: runs.clone(),
                max_evaluations: self.max_evaluations,
            };
            let answer: Followed = self
                .place
                .post(&format!("/v1/calibrations/{}/follow", self.id), &new)
                .await?;
            say(&terminal::followed(&answer, begin.elapsed().as_secs_f64()))?;
            self.followed = runs;
        }
        Ok(is_waiting)
    }
}

/// Returns the rows of runs that are not known; `None` without any, or where they are those that were followed last.
fn changed_rows(
    text: &str,
    known: &BTreeSet<String>,
    path: &Path,
    followed: &str,
) -> anyhow::Result<Option<String>> {
    let (runs, count) = new_rows(text, known, path)?;
    Ok((count > 0 && runs != followed).then_some(runs))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_that_is_corrected_is_followed_again() {
        let known = BTreeSet::from(["a".to_owned()]);
        let changed =
            |text: &str, followed: &str| changed_rows(text, &known, Path::new("runs.csv"), followed).unwrap();
        let first = changed("run,slip\na,0.1\nb,0.2\n", "").expect("a row");
        assert_eq!(first, "run,slip\nb,0.2\n");
        assert_eq!(changed("run,slip\na,0.1\nb,0.2\n", &first), None);
        let corrected = changed("run,slip\na,0.1\nb,0.3\n", &first);
        assert_eq!(corrected.as_deref(), Some("run,slip\nb,0.3\n"));
        assert_eq!(changed("run,slip\na,0.1\n", &first), None);
    }
}
