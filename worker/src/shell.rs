//! Completions for shells, and man pages.

use std::io::Write;
use std::path::Path;

use clap::CommandFactory;
use clap_complete::Shell;

use crate::config::WorkerConfig;

/// Writes completions of the command line; an error if they cannot be written.
pub fn completions(shell: Shell, output: &mut impl Write) -> std::io::Result<()> {
    // The text is written as a whole, because clap panics if a pipe is closed.
    let mut text = Vec::new();
    clap_complete::generate(shell, &mut WorkerConfig::command(), "worker", &mut text);
    output.write_all(&text)
}

/// Writes a man page for the program and for each of its commands into a folder; an error if they cannot be written.
pub fn man(folder: &Path) -> std::io::Result<()> {
    std::fs::create_dir_all(folder)?;
    clap_mangen::generate_to(WorkerConfig::command().name("worker"), folder)
}
