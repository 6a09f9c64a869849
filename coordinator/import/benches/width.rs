//! Prints the time of a proposal by the number of a table's columns. The time should be proportional to it, and a table that is too
//! wide should be refused at once.
//!
//! `cargo bench -p import --bench width`

use std::time::Instant;

use import::{SourceFile, guess};

/// Returns a table with this many columns, each with a different title, and two rows.
fn wide(columns: usize) -> String {
    let line = |cell: &dyn Fn(usize) -> String| (0..columns).map(cell).collect::<Vec<_>>().join(";") + "\n";
    line(&|k| format!("force {k} [N]")) + &line(&|k| k.to_string()) + &line(&|k| format!("{k},5"))
}

fn main() {
    println!("{:>9}  {:>7}", "columns", "ms");
    for columns in [2_500, 5_000, 10_000, 20_000, 1_000_000] {
        let text = wide(columns);
        let source = SourceFile {
            name: "wide.csv",
            bytes: text.as_bytes(),
            is_own: false,
        };
        let begin = Instant::now();
        let proposal = guess(&source, None);
        let ms = 1e3 * begin.elapsed().as_secs_f64();
        let words = proposal.map_or_else(
            |refusal| refusal.message,
            |proposal| format!("{} read", proposal.columns.len()),
        );
        println!("{columns:>9}  {ms:>7.1}  {words}");
    }
}
