//! No bytes and no map make the import panic, and every complaint has a message.

use import::{SourceFile, convert, guess};
use proptest::prelude::*;

const FILES: [&[u8]; 8] = [
    include_bytes!("files/runs.xlsx"),
    include_bytes!("files/awkward.xlsx"),
    include_bytes!("files/runs.ods"),
    include_bytes!("files/vectors-v7.mat"),
    include_bytes!("files/struct-v6.mat"),
    include_bytes!("files/elements-v7.mat"),
    include_bytes!("files/vectors-v73.mat"),
    include_bytes!("files/zero.bag"),
];

/// Returns a file with some bytes exchanged, perhaps cut off.
fn damaged() -> impl Strategy<Value = Vec<u8>> {
    let change = (
        any::<prop::sample::Index>(),
        prop_oneof![Just(0), Just(0xff), any::<u8>()],
    );
    (
        0..FILES.len(),
        prop::collection::vec(change, 1..6),
        any::<prop::sample::Index>(),
        any::<bool>(),
    )
        .prop_map(|(file, changes, end, is_cut)| {
            let mut bytes = FILES[file].to_vec();
            for (at, byte) in changes {
                let at = at.index(bytes.len());
                bytes[at] = byte;
            }
            if is_cut {
                bytes.truncate(end.index(bytes.len()));
            }
            bytes
        })
}

/// Returns a table, or something like one.
fn text() -> impl Strategy<Value = Vec<u8>> {
    prop_oneof![
        "([a-z\\[\\]%0-9,.;\t\"#−+eE' -]{0,12}[;,\t|\n]){0,60}".prop_map(String::into_bytes),
        prop::collection::vec(any::<u8>(), 0..200),
    ]
}

fn map() -> impl Strategy<Value = String> {
    let entry = "columns\\.(slip|run|wheel_load_n|pass) = \\{ (column|value|formula|unit) = \"[a-zA-Z%?*/() 0-9]{0,8}\"(, unit = \"(%|N|kN|\\?)\")? \\}\n";
    let head = "(titles = [0-9]\n)?(units = [0-9]\n)?(decimal = \"[.,?]\"\n)?(skip = \\[[0-9]\\]\n)?(columns\\.use = \\{ column = \"[a-zA-Z]\", words = \\{ [a-zA-Z]{1,3} = \"(fit|skip|\\?|x)\" \\} \\}\n)?(recording = \\{ time = \"[AB]\", time_unit = \"s\"(, histories = true)?(, step_s = [0-9.]{1,3})?(, while = \"[a-z<> 0-9]{0,8}\")? \\}\n)?(file = \"[a-z.{}]{0,8}\"\n)?";
    prop_oneof![
        (head, prop::collection::vec(entry, 0..4)).prop_map(|(head, entries)| head + &entries.concat()),
        any::<String>()
    ]
}

fn judge(bytes: &[u8], map: &str) {
    let source = SourceFile {
        name: "a.dat",
        bytes,
        is_own: false,
    };
    let result = convert(&source, ("map.toml", map), "runs");
    assert_eq!(result.runs.is_some(), result.complaints.is_empty());
    for complaint in &result.complaints {
        assert!(!complaint.message.is_empty() && !complaint.to_string().contains('\n'));
    }
    if let Ok(proposed) = guess(&source, None) {
        // A proposed map can be parsed: its only mistakes are open questions and the cells.
        let proposal = convert(&source, ("map.toml", &proposed.map), "runs");
        let is_syntax = |message: &str| message.contains("unknown key") || message.contains("must be a t");
        assert!(
            !proposal
                .complaints
                .iter()
                .any(|complaint| is_syntax(&complaint.message)),
            "{}\n{:?}",
            proposed.map,
            proposal.complaints
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    #[test]
    fn no_damaged_file_makes_it_panic(bytes in damaged()) {
        judge(&bytes, "columns.slip = { column = \"slip\", unit = \"%\" }");
    }

    #[test]
    fn no_text_and_no_map_make_it_panic(bytes in text(), map in map()) {
        judge(&bytes, &map);
    }
}
