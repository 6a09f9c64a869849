//! What a table costs: as much as it is wide, up to a bound.

use std::time::{Duration, Instant};

use import::{SourceFile, guess};

use super::complaints;

/// A table with so many columns, each with a title and a unit of its own.
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

/// The least of several times.
fn cost(text: &str) -> Duration {
    let time = || {
        let begin = Instant::now();
        let found = guess(&source(text), None).expect("a table");
        assert!(!found.columns.is_empty());
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
    let said = guess(&source(&wide(20_001)), None).expect_err("too wide");
    assert_eq!(said.to_string(), refusal);
    assert!(complaints("wide.csv", wide(20_001).as_bytes(), "").contains(&refusal.to_owned()));
    let found = guess(&source(&wide(20_000)), None).expect("a table");
    assert_eq!(found.columns.len(), 20_000);
    // Nothing but separators is as wide.
    let said = guess(&source(&format!("{}\n1;2\n", ";".repeat(1_000_000))), None).expect_err("too wide");
    assert!(
        said.message.starts_with("1000001 columns must be at most 20000"),
        "{said}"
    );
}

#[test]
fn a_title_that_is_not_there_lists_some_of_many() {
    let map = "[columns.slip]\ncolumn = \"nowhere\"\nunit = \"1\"\n";
    let said = complaints("wide.csv", wide(1_000).as_bytes(), map).join("\n");
    assert!(
        said.contains("the titles are force 0 [N], force 1 [N], "),
        "{said}"
    );
    assert!(said.contains(" and 960 more"), "{said}");
}
