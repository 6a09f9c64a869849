//! The cost of a table: proportional to its width, with a bound.

use std::time::{Duration, Instant};

use import::{SourceFile, guess};

use super::complaints;

/// Returns a table with this many columns, each with a different title and a unit.
fn wide(columns: usize) -> String {
    let line = |cell: &dyn Fn(usize) -> String| (0..columns).map(cell).collect::<Vec<_>>().join(";") + "\n";
    line(&|k| format!("force {k} [N]")) + &line(&|k| k.to_string()) + &line(&|k| format!("{k},5"))
}

fn source(text: &str) -> SourceFile<'_> {
    SourceFile {
        name: "wide.csv",
        bytes: text.as_bytes(),
        is_own: false,
    }
}

/// Returns the shortest of several times.
fn cost(text: &str) -> Duration {
    let time = || {
        let begin = Instant::now();
        let proposal = guess(&source(text), None).expect("a table");
        assert!(!proposal.columns.is_empty());
        begin.elapsed()
    };
    (0..5).map(|_| time()).min().unwrap_or_default()
}

#[test]
fn four_times_the_columns_cost_less_than_eight_times_as_much() {
    let (narrow, broad) = (wide(2_500), wide(10_000));
    let ratio = cost(&broad).as_secs_f64() / cost(&narrow).as_secs_f64();
    assert!(
        ratio < 8.0,
        "10,000 columns cost {ratio:.1} times as much as 2,500"
    );
}

#[test]
fn more_columns_than_a_table_has_are_refused_with_their_number() {
    let refusal = "wide.csv line 1: 20001 columns must be at most 20000: a table has a column for each quantity, and a row for each run";
    let refused = guess(&source(&wide(20_001)), None).expect_err("too wide");
    assert_eq!(refused.to_string(), refusal);
    assert!(complaints("wide.csv", wide(20_001).as_bytes(), "").contains(&refusal.to_owned()));
    let proposal = guess(&source(&wide(20_000)), None).expect("a table");
    assert_eq!(proposal.columns.len(), 20_000);
    // A line of separators only is as wide.
    let refused = guess(&source(&format!("{}\n1;2\n", ";".repeat(1_000_000))), None).expect_err("too wide");
    assert!(
        refused
            .message
            .starts_with("1000001 columns must be at most 20000"),
        "{refused}"
    );
}

#[test]
fn a_title_that_is_not_there_lists_some_of_many() {
    let map = "[columns.slip]\ncolumn = \"nowhere\"\nunit = \"1\"\n";
    let messages = complaints("wide.csv", wide(1_000).as_bytes(), map).join("\n");
    assert!(
        messages.contains("the titles are force 0 [N], force 1 [N], "),
        "{messages}"
    );
    assert!(messages.contains(" and 960 more"), "{messages}");
}
