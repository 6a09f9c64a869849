//! `coordinator schema`: prints JSON schemas of files, for editors.

use std::path::Path;

use anyhow::Context;

use super::output::say;
use crate::config::SchemaArguments;
use crate::schema::FileKind;

/// Prints one schema, or writes all with the settings of Taplo.
pub(super) fn schema(arguments: &SchemaArguments) -> anyhow::Result<()> {
    match (arguments.kind, &arguments.output) {
        (Some(kind), _) => Ok(say(&kind.text()?)?),
        (None, Some(folder)) => write(folder),
        (None, None) => anyhow::bail!("expected a kind of file, or --output FOLDER"),
    }
}

fn write(folder: &Path) -> anyhow::Result<()> {
    let name = || folder.display().to_string();
    std::fs::create_dir_all(folder).with_context(name)?;
    let mut rules = String::from(
        "# Which schema a file has, for Taplo and the editors that use it. Another file names its own in its first line:\n# #:schema job.schema.json\n",
    );
    for kind in FileKind::all() {
        let file = folder.join(kind.file_name());
        std::fs::write(&file, kind.text()?).with_context(|| file.display().to_string())?;
        let include: Vec<String> = kind
            .usual_files()
            .iter()
            .map(|files| format!("\"{files}\""))
            .collect();
        rules += &format!(
            "\n[[rule]]\ninclude = [{}]\n[rule.schema]\npath = \"{}\"\n",
            include.join(", "),
            kind.file_name()
        );
    }
    let settings = folder.join(".taplo.toml");
    std::fs::write(&settings, rules).with_context(|| settings.display().to_string())?;
    Ok(say(&format!(
        "{}: {} schemas, and .taplo.toml with the files that have them\n",
        name(),
        FileKind::all().len()
    ))?)
}
