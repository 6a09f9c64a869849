//! `coordinator watch`: follows the runs of a file while a campaign lasts.

use std::collections::BTreeSet;
use std::path::Path;
use std::time::{Duration, Instant};

use anyhow::{Context, bail};
use prediction::follow::Followed;
use shared::api::NewRuns;
use shared::text_file::read_text;

use super::output::say;
use super::place::Place;
use super::predict::target;
use crate::config::WatchArguments;
use report::terminal;
use result::Comparison;

/// Interval between two looks at the file.
const LOOK: Duration = Duration::from_millis(200);

pub(super) async fn watch(config: &WatchArguments) -> anyhow::Result<()> {
    let place = Place::open(&config.source).await?;
    let id = target(&place, config.id).await?;
    let comparison: Comparison = place.get(&format!("/v1/calibrations/{id}/comparison")).await?;
    let known: BTreeSet<String> = comparison.rows.into_iter().map(|row| row.run).collect();
    let mut seen = 0;
    loop {
        // A row that is being written has no line end yet.
        let text = read_text(&config.runs)?;
        let whole = text.rfind('\n').map_or("", |end| &text[..=end]);
        let (runs, count) = new_rows(whole, &known, &config.runs)?;
        if count > seen {
            seen = count;
            let begin = Instant::now();
            let new = NewRuns {
                runs,
                calibration: None,
            };
            let path = format!("/v1/calibrations/{id}/follow");
            let followed: Followed = place.post(&path, &new).await?;
            say(&terminal::followed(&followed, begin.elapsed().as_secs_f64()))?;
        }
        if config.once {
            return Ok(());
        }
        tokio::time::sleep(LOOK).await;
    }
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
