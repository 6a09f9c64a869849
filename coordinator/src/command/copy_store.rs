//! `coordinator copy-store`: copies a store from a file to a server, or from a server to a file.

use super::output::say;
use crate::config::CopyStoreArguments;
use store::{copy_store, name_of};

pub(super) async fn copy(config: &CopyStoreArguments) -> anyhow::Result<()> {
    let tables = copy_store(&config.from, &config.to).await?;
    let rows: u64 = tables.iter().map(|(_, rows)| rows).sum();
    let lines = tables
        .iter()
        .map(|(table, rows)| format!("{table:<14} {rows:>12}\n"));
    let total = format!(
        "{}: rows: {rows}, tables: {}\n",
        name_of(&config.to),
        tables.len()
    );
    Ok(say(&(lines.collect::<String>() + &total))?)
}
