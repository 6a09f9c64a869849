//! Tables of runs as users write them: the names of their runs, and the rows of some of them.

use std::collections::BTreeSet;
use std::path::Path;

use anyhow::Context;

/// Returns the names of the runs of a table.
pub(super) fn run_names(text: &str, path: &Path) -> anyhow::Result<BTreeSet<String>> {
    let (mut reader, run) = reader(text, path)?;
    let mut names = BTreeSet::new();
    for record in reader.records() {
        let record = record.with_context(|| path.display().to_string())?;
        names.extend(record.get(run).map(str::to_owned));
    }
    Ok(names)
}

/// Returns the rows of runs that are not known, with the header, and their number.
pub(super) fn new_rows(text: &str, known: &BTreeSet<String>, path: &Path) -> anyhow::Result<(String, usize)> {
    let (mut reader, run) = reader(text, path)?;
    let header = reader.headers()?.clone();
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(&header)?;
    let mut count = 0;
    for record in reader.records() {
        let record = record.with_context(|| path.display().to_string())?;
        if record.get(run).is_some_and(|run| !known.contains(run)) {
            writer.write_record(&record)?;
            count += 1;
        }
    }
    let bytes = writer.into_inner().map_err(csv::IntoInnerError::into_error)?;
    Ok((String::from_utf8(bytes)?, count))
}

/// Returns a reader of a table, and the position of the column `run`.
fn reader<'a>(text: &'a str, path: &Path) -> anyhow::Result<(csv::Reader<&'a [u8]>, usize)> {
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let header = reader.headers().with_context(|| path.display().to_string())?;
    let run = header.iter().position(|column| column == "run");
    let run = run.with_context(|| format!("{}: the column run is missing", path.display()))?;
    Ok((reader, run))
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
