//! The story of a study as the last lines of its text: what is wrong, what is missing, what to do next.

use std::fmt::Write;
use std::path::Path;

use super::column::{LABEL, labelled};
use super::ending::quoted;
use crate::story::{NextStep, Story};

/// Maximum number of steps in a brief story.
const MAX_STEPS: usize = 2;

/// Returns the story, with the commands of its steps.
///
/// # Arguments
/// - `folder`: the folder of the study, which also contains effect files.
/// - `is_brief`: whether to show only the first step and the next one that has a command.
pub fn story(story: &Story, folder: &Path, is_brief: bool) -> String {
    let place = format!("--out {}", quoted(&folder.display().to_string()));
    let model = story.model.as_ref();
    let mut text = model.map_or_else(String::new, |model| labelled("model:", model));
    text += &(labelled("wrong:", &story.wrong.text) + &labelled("missing:", &story.missing.text));
    let steps = story.next.steps.iter().enumerate();
    let shown = steps.filter(|(number, step)| !is_brief || *number == 0 || step.command.is_some());
    let max_steps = if is_brief { MAX_STEPS } else { usize::MAX };
    for (number, step) in shown.take(max_steps) {
        let label = if number == 0 { "next:" } else { "  then:" };
        text += &labelled(label, &step.text);
        if let Some(command) = command(step, folder) {
            let _ = writeln!(text, "{:LABEL$}  coordinator {command} {place}", "");
        }
    }
    text
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

    fn printed(study: &Study) -> String {
        story(&Story::current(study), Path::new("out/sand"), true)
    }

    #[test]
    fn a_brief_story_has_the_first_step_and_one_more_with_a_command_and_the_whole_has_all() {
        let study = searched();
        assert!(!printed(&study).contains("make a plate test"));
        let whole = story(&Story::current(&study), Path::new("out/sand"), false);
        assert!(whole.contains("make a plate test"), "{whole}");
    }

    #[test]
    fn the_three_lines_stand_in_order_and_fit_the_terminal() {
        let text = printed(&searched());
        let place = |words: &str| text.find(words).unwrap_or_else(|| panic!("{words} in\n{text}"));
        assert!(place("wrong:") < place("\nmissing:") && place("\nmissing:") < place("\nnext:"));
        assert!(text.contains("coordinator extend 1 --effect slip_sinkage --out out/sand"));
        let sentences = text.lines().filter(|line| !line.contains("coordinator "));
        for line in sentences {
            assert!(line.chars().count() <= 80, "{line}");
        }
    }

    #[test]
    fn an_effect_file_is_named_by_its_path() {
        let mut study = searched();
        study.rounds[0].record.extension = Some(Extension::File {
            name: "anything.toml".into(),
            text: "name = \"shear_slip_step\"\n".into(),
        });
        let text = printed(&study);
        let command = "extend 1 --effect-file out/sand/shear_slip_step.toml --out out/sand";
        assert!(text.contains(command), "{text}");
    }
}
