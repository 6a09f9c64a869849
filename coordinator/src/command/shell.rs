//! Shell completions and man pages.

use std::path::Path;

use anyhow::Context;
use clap::CommandFactory;
use clap_complete::Shell;

use super::output::say;
use crate::config::CoordinatorConfig;

/// Prints the completions of the command line for a shell.
pub(super) fn completions(shell: Shell) -> anyhow::Result<()> {
    let mut text = Vec::new();
    clap_complete::generate(shell, &mut CoordinatorConfig::command(), "coordinator", &mut text);
    Ok(say(&String::from_utf8(text)?)?)
}

/// Writes a man page for the program and for each of its commands.
pub(super) fn man(folder: &Path) -> anyhow::Result<()> {
    let name = || folder.display().to_string();
    std::fs::create_dir_all(folder).with_context(name)?;
    clap_mangen::generate_to(CoordinatorConfig::command(), folder).with_context(name)
}
