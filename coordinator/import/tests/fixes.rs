//! Rows that are no runs, blank cells and words of a column: the proposed fixes and their effect.

use import::{Complaint, Fix};

use super::{complaints, converted, runs};

const MAP: &str = r#"
[columns]
run = { column = "Versuch" }
wheel = { value = "w" }
soil = { value = "s" }
slip = { column = "Schlupf [%]" }
wheel_load_n = { column = "Last [N]" }
sled_speed_m_s = { column = "v [mm/s]" }
drawbar_pull_n = { column = "Zugkraft [N]" }
"#;
const TITLES: &str = "Versuch;Schlupf [%];Last [N];v [mm/s];Zugkraft [N];Bemerkung\n";

/// Returns the only complaint about a table.
#[track_caller]
fn only(rows: &str, map: &str) -> Complaint {
    let result = converted("Sand.csv", format!("{TITLES}{rows}").as_bytes(), map);
    assert_eq!(result.complaints.len(), 1, "{:#?}", result.complaints);
    result.complaints[0].clone()
}

#[test]
fn a_row_of_means_is_skipped_and_never_filled_down() {
    let rows = "V1;10;100;8;12,5;\nV2;20;100;8;20,5;\nMittelwert;;;;16,5;\n";
    let complaint = only(rows, MAP);
    assert_eq!(
        complaint.to_string(),
        "Sand.csv line 4: the row \"Mittelwert\" is no run: skip it with `skip = [4]` in the map"
    );
    assert_eq!(
        complaint.plain.as_deref(),
        Some("the row \"Mittelwert\" is no run")
    );
    assert_eq!((complaint.fix, complaint.line), (Some(Fix::Skip), Some(4)));
    assert_eq!(complaint.row, ["Mittelwert", "", "", "", "16,5", ""]);
    // If filled down, it would be a run of means.
    let filled = MAP.replace("]\" }", "]\", fill_down = true }");
    assert_eq!(only(rows, &filled).fix, Some(Fix::Skip));
    let text = format!("{TITLES}{rows}");
    let skipped = runs("Sand.csv", text.as_bytes(), &format!("skip = [4]{MAP}"));
    assert_eq!(
        skipped,
        "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n\nV1,w,s,0.1,100,0.008,12.5\nV2,w,s,0.2,100,0.008,20.5\n"
    );
    // A row of means that is shorter than the titles has one complaint too.
    let complaint = only("V1;10;100;8;12,5;\nMittelwert;;;\n", MAP);
    assert_eq!(complaint.fix, Some(Fix::Skip));
}

#[test]
fn a_row_of_means_that_lacks_nothing_is_a_run_with_a_remark() {
    let text = format!("{TITLES}V1;10;100;8;12,5;\nMittelwert;10;100;8;12,5;\n");
    let result = converted("Sand.csv", text.as_bytes(), MAP);
    assert_eq!((result.run_count, result.complaints.len()), (2, 0));
    assert!(
        result.remarks.iter().any(
            |remark| remark.starts_with("line 3 (\"Mittelwert\") is taken as a run")
                && remark.contains("skip = [3]")
        ),
        "{:?}",
        result.remarks
    );
}

#[test]
fn blank_cells_are_filled_down_where_a_column_states_blocks() {
    let blocks = "V1;10;100;8;12,5;\nV2;20;;8;20,5;\nV3;30;;8;25,5;\nV4;10;200;8;12,5;\nV5;20;;8;20,5;\n";
    let text = format!("{TITLES}{blocks}");
    let result = converted("Sand.csv", text.as_bytes(), MAP);
    assert_eq!(result.complaints.len(), 3);
    assert!(result.complaints.iter().all(|complaint| {
        complaint.fix == Some(Fix::FillDown)
            && complaint.field.as_deref() == Some("wheel_load_n")
            && complaint
                .message
                .contains("`fill_down = true` takes it from the row above")
    }));
    let filled = MAP.replace("\"Last [N]\"", "\"Last [N]\", fill_down = true");
    assert!(runs("Sand.csv", text.as_bytes(), &filled).contains("\nV5,w,s,0.2,200,"));
    // A single blank cell among many is a gap.
    let complaint = only(
        "V1;10;100;8;12,5;\nV2;;100;8;20,5;\nV3;30;100;8;25,5;\nV4;40;100;8;26;\n",
        MAP,
    );
    assert_eq!(
        complaint.message,
        "slip is blank: every run needs it; fill it in, or leave the row out with `skip = [3]`"
    );
    assert_eq!(
        (complaint.fix, complaint.plain.as_deref()),
        (Some(Fix::Skip), Some("slip is blank: every run needs it"))
    );
    // The first cell of a block has no cell above.
    let complaint = only("V1;10;;8;12,5;\nV2;20;100;8;20,5;\n", MAP);
    assert_eq!(complaint.fix, Some(Fix::Skip));
}

#[test]
fn a_formula_names_the_blank_cell_that_it_needs() {
    let map = MAP.replace("column = \"Last [N]\"", "formula = \"2 * half\"")
        + "[quantities.half]\ncolumn = \"Last [N]\"\n";
    let complaint = only(
        "V1;10;50;8;12,5;\nV2;20;;8;20,5;\nV3;30;50;8;20,5;\nV4;40;50;8;20,5;\n",
        &map,
    );
    assert_eq!(complaint.field.as_deref(), Some("half"));
    assert_eq!(
        complaint.plain.as_deref(),
        Some("wheel load is blank, because half is: every run needs it")
    );
    let complaint = only("V1;10;x;8;12,5;\n", &map);
    assert!(complaint.message.starts_with("\"x\" is no number"), "{complaint}");
}

const REMARKS: &str = "V1;10;100;8;12,5;\nV2;20;100;8;20,5;Kontrolle\nV3;30;100;8;25,5;Vorversuch\nV4;40;100;8;26;neu  aufbereitet\n";

#[test]
fn words_of_a_column_say_which_runs_are_held_out_and_which_rows_are_none() {
    let text = format!("{TITLES}{REMARKS}");
    let map = format!(
        "{MAP}use = {{ column = \"Bemerkung\", words = {{ Kontrolle = \"holdout\", Vorversuch = \"skip\", \"neu aufbereitet\" = \"fit\" }} }}\n"
    );
    let result = converted("Sand.csv", text.as_bytes(), &map);
    assert_eq!(
        result.runs.as_deref(),
        Some(
            "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n,use\nV1,w,s,0.1,100,0.008,12.5,\nV2,w,s,0.2,100,0.008,20.5,holdout\nV4,w,s,0.4,100,0.008,26,fit\n"
        )
    );
    assert!(
        result
            .remarks
            .contains(&"left out, because a word of theirs means skip: 4".to_owned()),
        "{:?}",
        result.remarks
    );
    // A blank cell has a word too.
    let blank = map.replace(
        "Kontrolle = \"holdout\"",
        "\"\" = \"holdout\", Kontrolle = \"fit\"",
    );
    assert!(
        runs("Sand.csv", text.as_bytes(), &blank)
            .contains("\nV1,w,s,0.1,100,0.008,12.5,holdout\nV2,w,s,0.2,100,0.008,20.5,fit\n")
    );
}

#[test]
fn a_word_without_a_meaning_is_refused() {
    let text = format!("{TITLES}{REMARKS}");
    let with = |entry: &str| complaints("Sand.csv", text.as_bytes(), &format!("{MAP}{entry}\n"));
    for (entry, complaint) in [
        (
            "use = { column = \"Bemerkung\", words = { Kontrolle = \"holdout\", Vorversuch = \"skip\" } }",
            "Sand.csv line 5, column \"Bemerkung\": use \"neu  aufbereitet\" must be fit or holdout; where it is another word, `words = { \"neu  aufbereitet\" = \"holdout\" }` in the map says what it means",
        ),
        (
            "use = { column = \"Bemerkung\", words = { Kontrolle = \"?\" } }",
            "map.toml line 10: [columns.use]: words: \"Kontrolle\" = \"?\" asks for an answer: \"fit\", \"holdout\" (never fitted) or \"skip\" (no run)",
        ),
        (
            "use = { column = \"Bemerkung\", words = { Kontrolle = 1 } }",
            "map.toml line 10: [columns.use]: words: \"Kontrolle\" must be \"fit\", \"holdout\" (never fitted) or \"skip\" (no run)",
        ),
        (
            "use = { value = \"fit\", words = { Kontrolle = \"fit\" } }",
            "map.toml line 10: use: words are those of a column: state `column`, or leave `words` out",
        ),
        (
            "prepared = { column = \"Bemerkung\", words = { Kontrolle = \"fit\" } }",
            "map.toml line 10: [columns.prepared]: unknown key \"words\"; known are column, value, formula, unit, decimal, fill_down, from, zero_line, zero_file",
        ),
    ] {
        assert_eq!(with(entry), [complaint], "{entry}");
    }
}

#[test]
fn what_is_open_is_asked_in_words_for_people_who_see_no_map() {
    let map = MAP
        .replace("value = \"w\"", "value = \"?\"")
        .replace("column = \"Last [N]\"", "column = \"Last [N]\", unit = \"?\"")
        .replace("column = \"v [mm/s]\"", "value = \"?\", unit = \"mm/s\"");
    let text = format!("{TITLES}{REMARKS}");
    let result = converted("Sand.csv", text.as_bytes(), &map);
    let asked: Vec<&str> = result
        .complaints
        .iter()
        .filter_map(|complaint| complaint.plain.as_deref())
        .collect();
    assert_eq!(
        asked,
        [
            "Which wheel? Choose its column, or give one name for all rows.",
            "In which unit is \"Last [N]\"? The file does not state it.",
            "What is the sled speed? Choose its column, or give the value that all rows have, with its unit.",
        ]
    );
    assert_eq!(result.complaints.len(), 3);
}
