//! `coordinator watch`: follows the runs of a file while a campaign lasts.

use std::collections::BTreeSet;
use std::path::Path;
use std::time::{Duration, Instant};

use anyhow::{Context, bail};
use prediction::follow::Followed;
use shared::api::NewRuns;
use shared::text_file::read_text;

use super::output::{remark, say};
use super::place::Place;
use super::predict::target;
use crate::config::WatchArguments;
use report::terminal;
use result::Comparison;

/// Interval between two looks at the file.
const LOOK: Duration = Duration::from_millis(200);
/// Interval after a look that failed, because a service that is away or refuses a row is not asked five times a second.
const LOOK_AGAIN: Duration = Duration::from_secs(2);

pub(super) async fn watch(config: &WatchArguments) -> anyhow::Result<()> {
    let place = Place::open(&config.source).await?;
    let id = target(&place, config.id).await?;
    let comparison: Comparison = place.get(&format!("/v1/calibrations/{id}/comparison")).await?;
    let known: BTreeSet<String> = comparison.rows.into_iter().map(|row| row.run).collect();
    let mut followed = String::new();
    let mut said = String::new();
    loop {
        let looked = look(&place, id, &known, &config.runs, &mut followed).await;
        if config.once {
            return looked;
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

/// Follows the rows that the file has now, unless they are those that were followed last.
async fn look(
    place: &Place,
    id: i64,
    known: &BTreeSet<String>,
    path: &Path,
    followed: &mut String,
) -> anyhow::Result<()> {
    let text = read_text(path)?;
    let Some(runs) = changed_rows(&text, known, path, followed)? else {
        return Ok(());
    };
    let begin = Instant::now();
    let new = NewRuns {
        runs: runs.clone(),
        calibration: None,
    };
    let answer: Followed = place.post(&format!("/v1/calibrations/{id}/follow"), &new).await?;
    say(&terminal::followed(&answer, begin.elapsed().as_secs_f64()))?;
    *followed = runs;
    Ok(())
}

/// Returns the rows of runs that are not known; `None` without any, or where they are those that were followed last.
fn changed_rows(
    text: &str,
    known: &BTreeSet<String>,
    path: &Path,
    followed: &str,
) -> anyhow::Result<Option<String>> {
    // A row that is being written has no line end yet.
    let whole = text.rfind('\n').map_or("", |end| &text[..=end]);
    let (runs, count) = new_rows(whole, known, path)?;
    Ok((count > 0 && runs != followed).then_some(runs))
}

/// Returns the rows of runs that are not known, with the header, and their number.
fn new_rows(text: &str, known: &BTreeSet<String>, path: &Path) -> anyhow::Result<(String, usize)> {
    let name = || path.display().to_string();
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let header = reader.headers().with_context(name)?.clone();
    let Some(run) = header.iter().position(|column| column == "run") else {
        bail!("{}: the column run is missing", path.display());
    };
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(&header)?;
    let mut count = 0;
    for record in reader.records() {
        let record = record.with_context(name)?;
        if record.get(run).is_some_and(|run| !known.contains(run)) {
            writer.write_record(&record)?;
            count += 1;
        }
    }
    let bytes = writer.into_inner().map_err(csv::IntoInnerError::into_error)?;
    Ok((String::from_utf8(bytes)?, count))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_that_is_corrected_is_followed_again() {
        let known = BTreeSet::from(["a".to_owned()]);
        let changed =
            |text: &str, followed: &str| changed_rows(text, &known, Path::new("runs.csv"), followed).unwrap();
        let first = changed("run,slip\na,0.1\nb,0.2\nc,0", "").expect("a row");
        assert_eq!(first, "run,slip\nb,0.2\n");
        assert_eq!(changed("run,slip\na,0.1\nb,0.2\n", &first), None);
        let corrected = changed("run,slip\na,0.1\nb,0.3\n", &first);
        assert_eq!(corrected.as_deref(), Some("run,slip\nb,0.3\n"));
        assert_eq!(changed("run,slip\na,0.1\n", &first), None);
    }

    #[test]
    fn rows_of_known_runs_are_left_out() {
        let known = BTreeSet::from(["a".to_owned()]);
        let rows = |text: &str| new_rows(text, &known, Path::new("runs.csv"));
        let (text, count) = rows("# note\nrun,slip\na,0.1\nb, 0.2\n").unwrap();
        assert_eq!((text.as_str(), count), ("run,slip\nb,0.2\n", 1));
        assert_eq!(rows("run,slip\na,0.1\n").unwrap().1, 0);
        assert!(
            rows("slip\n0.1\n")
                .unwrap_err()
                .to_string()
                .contains("column run")
        );
    }
}
