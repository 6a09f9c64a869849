//! The end of `coordinator run`: a study in few lines.

use std::path::Path;

use super::column::labelled_within;
use super::ending::ending;
use super::story::{command_line, sentences};
use crate::story::Story;

/// Maximum number of lines.
const LINES: usize = 15;
/// Maximum number of them before the story.
const TABLES: usize = 8;
/// The beginning of a line that says why numbers may be wrong. Such lines follow each other.
const CAUTION: &str = "caution: ";

/// Returns the tables of a study, its story, and where its files are, in at most fifteen lines. Sentences that are longer lose their last
/// clauses.
///
/// # Arguments
/// - `tables`: the text of `brief`.
/// - `folder`: the folder of the study.
/// - `width`: number of characters in a line.
///
/// Checked by `tests::an_end_has_at_most_fifteen_lines`.
pub fn run_end(tables: &str, story: &Story, folder: &Path, width: usize) -> String {
    let steps = &story.next.steps;
    // The first step, and the command of the first one that has a command.
    let command = steps.iter().find_map(|step| {
        let line = command_line(step, folder);
        (!line.is_empty()).then_some(line)
    });
    let command = command.unwrap_or_default();
    let next = steps.first().map(|step| ("next:", step.text.as_str()));
    let sentences: Vec<_> = sentences(story).into_iter().chain(next).collect();
    let tables = first_lines(tables, width);
    let ending = ending(folder).replacen('\n', "; more with --verbose\n", 1);
    let others = [&tables, &command, &ending];
    // A command is not broken into lines: the terminal does that.
    let rows = |line: &str| line.chars().count().div_ceil(width).max(1);
    let taken: usize = others.iter().flat_map(|text| text.lines()).map(rows).sum();
    let left = LINES.saturating_sub(taken);
    let mut heights = vec![LINES; sentences.len()];
    let written = |heights: &[usize]| -> Vec<String> {
        let pairs = sentences.iter().zip(heights);
        pairs
            .map(|((label, text), &lines)| labelled_within(width, lines, label, text))
            .collect()
    };
    let mut texts = written(&heights);
    loop {
        let now: Vec<usize> = texts.iter().map(|text| text.lines().count()).collect();
        // The sentences about the missing effect and the next step are shortened last.
        let is_detail = |i: usize| now[i] > 1 && !["missing:", "next:"].contains(&sentences[i].0);
        let longest = (0..now.len()).max_by_key(|&i| (is_detail(i), now[i]));
        match longest.filter(|&i| now[i] > 1 && now.iter().sum::<usize>() > left) {
            Some(i) => heights[i] = now[i] - 1,
            None => break,
        }
        texts = written(&heights);
    }
    tables + &texts.concat() + &command + &ending
}

/// Returns the lines before the story, each within the width, because a terminal breaks longer ones between any two letters. Where there are
/// too many, the last cautions are counted instead of written, and if that does not suffice, `...` stands for the last rows.
fn first_lines(tables: &str, width: usize) -> String {
    let lines = tables.lines().filter(|line| !line.is_empty());
    let mut lines: Vec<String> = lines.map(str::to_owned).collect();
    let excess = lines.len().saturating_sub(TABLES);
    let is_caution = |line: &String| line.starts_with(CAUTION);
    // The line that counts the cautions takes the place of one.
    let counted = lines
        .iter()
        .filter(|line| is_caution(line))
        .count()
        .min(excess + 1);
    if excess > 0
        && counted > 1
        && let Some(last) = lines.iter().rposition(is_caution)
    {
        let note = format!("{CAUTION}{counted} more with --verbose");
        lines.splice(last + 1 - counted..=last, [note]);
    }
    if lines.len() > TABLES {
        lines.truncate(TABLES - 1);
        lines.push("...".into());
    }
    lines
        .iter()
        .map(|line| match line.chars().count() <= width {
            true => format!("{line}\n"),
            false => {
                let head: String = line.chars().take(width.saturating_sub(4)).collect();
                let whole = head.rsplit_once(' ').map_or(head.as_str(), |(before, _)| before);
                format!("{whole} ...\n")
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{fixture, terminal};
    use result::study::Study;

    fn printed(study: &Study, width: usize) -> String {
        let story = Story::current(study);
        run_end(&terminal::brief(study), &story, Path::new("out/sand"), width)
    }

    #[test]
    fn an_end_has_at_most_fifteen_lines() {
        let studies = [
            fixture::grown(),
            fixture::of_a_class(),
            fixture::study(),
            fixture::all_rejected().into(),
        ];
        for study in &studies {
            for width in [60, 80, 120] {
                let text = printed(study, width);
                let rows = text
                    .lines()
                    .map(|line| line.chars().count().div_ceil(width).max(1));
                assert!(rows.sum::<usize>() <= LINES, "{text}");
                let is_kept_whole = |line: &&str| line.contains("coordinator ") || line.starts_with("files:");
                let sentences = text.lines().filter(|line| !is_kept_whole(line));
                for line in sentences {
                    assert!(line.chars().count() <= width, "{width}: {line}");
                }
                for label in ["wrong:", "missing:", "next:", "files:", "page:"] {
                    assert!(text.contains(label), "{label} in\n{text}");
                }
            }
        }
    }

    #[test]
    fn cautions_are_counted_before_rows_are_left_out_with_a_mark() {
        let rows = |count: usize| (1..=count).map(|i| format!("row {i}\n")).collect::<String>();
        let cautions = "caution: a\ncaution: b\ncaution: c\n";
        let all = cautions.to_owned() + &rows(5);
        assert_eq!(first_lines(&all, 80), all);
        assert_eq!(
            first_lines(&(cautions.to_owned() + &rows(6)), 80),
            "caution: a\ncaution: 2 more with --verbose\n".to_owned() + &rows(6)
        );
        assert_eq!(
            first_lines(&(cautions.to_owned() + &rows(9)), 80),
            "caution: 3 more with --verbose\n".to_owned() + &rows(6) + "...\n"
        );
        assert_eq!(first_lines(&rows(9), 80), rows(7) + "...\n");
    }

    #[test]
    fn a_long_sentence_loses_lines_and_a_short_one_none() {
        let study = fixture::grown();
        let mut story = Story::current(&study);
        story.missing.text = "one clause of many; ".repeat(60);
        let text = run_end(&terminal::brief(&study), &story, Path::new("out"), 80);
        assert!(text.lines().count() <= LINES && text.contains(" ...\n"), "{text}");
        assert!(
            text.contains(&story.next.steps[0].text[..20]),
            "the step is there:\n{text}"
        );
    }
}
