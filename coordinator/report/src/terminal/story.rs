//! The story of a study as the last lines of its text: what is wrong, what is missing, what to do next.

use std::path::Path;

use super::column::{LABEL, labelled_to};
use super::ending::quoted;
use crate::story::{NextStep, Story};
use result::words::number;

/// Maximum number of steps that are written; more are counted.
const STEPS: usize = 3;

/// Returns the story, with its first three steps and their commands. The page has all steps, with the keys of the files by which results
/// are stated.
///
/// # Arguments
/// - `folder`: the folder of the study, which also contains effect files.
/// - `width`: number of characters in a line.
pub fn story(story: &Story, folder: &Path, width: usize) -> String {
    let sentences = sentences(story);
    let mut text: String = sentences
        .iter()
        .map(|(label, sentence)| labelled_to(width, label, sentence))
        .collect();
    for (place, step) in story.next.steps.iter().take(STEPS).enumerate() {
        let label = if place == 0 { "next:" } else { "  then:" };
        text += &labelled_to(width, label, &step.text);
        text += &command_line(step, folder);
    }
    let later = story.next.steps.len().saturating_sub(STEPS);
    if later > 0 {
        let counted = format!("{} on the page", number::count(later, "more step"));
        text += &labelled_to(width, "", &counted);
    }
    text
}

/// Returns the answers of a story with their labels: the model, what is wrong, what is missing.
pub(super) fn sentences(story: &Story) -> Vec<(&'static str, &str)> {
    let model = story.model.iter().map(|model| ("model:", model.as_str()));
    let answers = [
        ("wrong:", story.wrong.text.as_str()),
        ("missing:", story.missing.text.as_str()),
    ];
    model.chain(answers).collect()
}

/// Returns the line of a step's command, which stays whole so that it can be copied; empty without a command.
pub(super) fn command_line(step: &NextStep, folder: &Path) -> String {
    let place = quoted(&folder.display().to_string());
    command(step, folder).map_or_else(String::new, |command| {
        format!("{:LABEL$}  coordinator {command} --out {place}\n", "")
    })
}

/// Returns the command of a step, with the path of its effect file in the folder.
fn command(step: &NextStep, folder: &Path) -> Option<String> {
    let command = step.command.clone()?;
    Some(match &step.effect_file {
        Some(file) => {
            let path = folder.join(&file.name).display().to_string();
            command.replace(&file.name, &quoted(&path))
        }
        None => command,
    })
}

#[cfg(test)]
mod tests {
    use record::Extension;

    use super::*;
    use crate::fixture;
    use result::study::Study;

    /// Returns a searched study that was not extended.
    fn searched() -> Study {
        let mut study = fixture::grown();
        study.extensions.clear();
        study
    }

    fn printed(study: &Study, width: usize) -> String {
        story(&Story::current(study), Path::new("out/sand"), width)
    }

    #[test]
    fn the_three_lines_stand_in_order_and_fit_the_terminal() {
        let text = printed(&searched(), 80);
        let place = |words: &str| text.find(words).unwrap_or_else(|| panic!("{words} in\n{text}"));
        assert!(place("wrong:") < place("\nmissing:") && place("\nmissing:") < place("\nnext:"));
        assert!(text.contains("coordinator extend 1 --effect slip_sinkage --out out/sand"));
        let sentences = text.lines().filter(|line| !line.contains("coordinator "));
        for line in sentences {
            assert!(line.chars().count() <= 80, "{line}");
        }
        let wide = printed(&searched(), 120);
        assert!(wide.lines().any(|line| line.chars().count() > 80), "{wide}");
        assert!(text.contains("make a plate test"), "{text}");
    }

    #[test]
    fn three_steps_are_written_and_the_others_counted() {
        let mut study = searched();
        let tests = ["tare run", "free-spin run", "ring-shear test"].map(str::to_owned);
        study.rounds[0].record.other_tests = tests.into();
        let text = printed(&study, 80);
        assert_eq!(
            text.matches("next:").count() + text.matches("then:").count(),
            STEPS
        );
        assert!(text.ends_with("         2 more steps on the page\n"), "{text}");
    }

    #[test]
    fn an_effect_file_is_named_by_its_path() {
        let mut study = searched();
        study.rounds[0].record.extension = Some(Extension::File {
            name: "anything.toml".into(),
            text: "name = \"shear_slip_step\"\n".into(),
        });
        let text = printed(&study, 80);
        let command = "extend 1 --effect-file out/sand/shear_slip_step.toml --out out/sand";
        assert!(text.contains(command), "{text}");
    }
}
