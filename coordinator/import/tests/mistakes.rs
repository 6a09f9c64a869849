//! All mistakes at once, each with its place, the expectation and the nearest fix.

use super::complaints;

const TEXT: &str = "\
Versuch;Schlupf [%];Radlast [kN];Einsinkung;Zugkraft [N]
V1;10;0,1;5,5;12,5
V2;2O;0,1;6.5;25
V2;400;-0,1;;n.b.
;30;;7;35 N
";

#[test]
fn mistakes_of_the_map_do_not_hide_those_of_cells() {
    let map = r#"
[columns.run]
column = "Versuch"
[columns.wheel]
value = "?"
[columns.slip]
column = "Schlupf [%]"
unit = "%"
[columns.wheel_load_n]
column = "Radlast"
unit = "kN"
[columns.sinkage_m]
column = "Einsinkung"
unit = "?"
[columns.drawbar_pull_n]
column = "Zugkraft [N]"
units = "N"
[columns.torqe_n_m]
column = "Moment"
[columns.lateral_force_n]
column = "Zugkraft [N]"
"#;
    assert_eq!(
        complaints("Sand.csv", TEXT.as_bytes(), map),
        [
            "map.toml line 17: [columns.drawbar_pull_n]: unknown key \"units\"; the nearest known is \"unit\"",
            "map.toml line 18: [columns.torqe_n_m]: unknown column of runs.csv \"torqe_n_m\"; the nearest known is \"torque_n_m\"",
            "map.toml: the map has no soil, which every run needs: add `[columns.soil]` with column, value or formula",
            "map.toml: the map has no sled speed, which every run needs: add `[columns.sled_speed_m_s]` with column, value or formula",
            "map.toml line 4: wheel: value = \"?\" asks for an answer: the value that all rows have, as experiment.toml names it",
            "map.toml line 9: wheel_load_n: no column has the title \"Radlast\"; did you mean \"Radlast [kN]\"",
            "map.toml line 12: sinkage_m: unit = \"?\" asks for an answer, which the file does not state: one of m, mm, cm, um, km, in, ft",
            "Sand.csv line 3, column \"Schlupf [%]\": \"2O\" is no number: a number like 1,5 is expected; did you mean 20",
            "Sand.csv line 4, column \"Zugkraft [N]\": \"n.b.\" is no number: a number like 1,5 is expected; leave the cell blank where nothing was measured, or name the word under `missing` in the map",
            "Sand.csv line 4, column \"Schlupf [%]\": slip 4 must lie in [-1, 1): is this in %? State `unit = \"%\"` in the map",
            "Sand.csv line 5, column \"Zugkraft [N]\": \"35 N\" is no number: a number like 1,5 is expected; did you mean 35",
            "Sand.csv line 5, column \"Versuch\": run is blank: every run needs it; fill it in, or leave the row out with `skip = [5]`",
            "Sand.csv line 4: run \"V2\" is named in line 3 too: give each run a name of its own, or leave [columns.run] out to have them numbered",
        ]
    );
}

const RIGHT: &str = r#"
[columns]
wheel = { value = "w" }
soil = { value = "s" }
slip = { column = "slip", unit = "1" }
wheel_load_n = { column = "load", unit = "N" }
sled_speed_m_s = { value = 8, unit = "mm/s" }
drawbar_pull_n = { column = "pull", unit = "N" }
"#;

/// Returns the only complaint about a small table.
#[track_caller]
fn only(text: &str, map: &str) -> String {
    let messages = complaints("a.csv", text.as_bytes(), map);
    assert_eq!(messages.len(), 1, "{messages:#?}");
    messages[0].clone()
}

#[test]
fn units_are_stated_or_refused() {
    let text = "slip,load,pull\n0.1,100,12.5\n0.2,100,20.5\n";
    for (from, to, part) in [
        (
            "\"load\", unit = \"N\"",
            "\"load\"",
            "map.toml line 6: wheel_load_n: the title \"load\" states no unit: state `unit` in the map, one of N, kN",
        ),
        (
            "\"load\", unit = \"N\"",
            "\"load\", unit = \"kg\"",
            "unit \"kg\" cannot be used: kg is a mass; for the force that a scale shows in kilograms write kgf",
        ),
        (
            "\"load\", unit = \"N\"",
            "\"load\", unit = \"mm\"",
            "unit \"mm\" is one of length, and a force is expected: N, kN",
        ),
        (
            "\"load\", unit = \"N\"",
            "\"load\", unit = \"KN\"",
            "unknown unit \"KN\"; did you mean \"kN\"",
        ),
        (
            "value = 8, unit = \"mm/s\"",
            "value = 8",
            "sled_speed_m_s: a value needs its unit",
        ),
        (
            "column = \"pull\", unit = \"N\"",
            "formula = \"wheel_load_n * sled_speed_m_s\"",
            "gives W, and a force in N is expected",
        ),
        (
            "column = \"pull\", unit = \"N\"",
            "formula = \"wheel_load + 1\"",
            "formula \"wheel_load + 1\": character 1: ",
        ),
        (
            "column = \"pull\", unit = \"N\"",
            "formula = \"wheel_load_n\", unit = \"N\"",
            "a formula gives SI units, angles in rad: leave `unit` out",
        ),
        (
            "column = \"pull\", unit = \"N\"",
            "formula = \"drawbar_pull_n\"",
            "drawbar_pull_n has a formula itself: write it out",
        ),
        (
            "slip\", unit = \"1\"",
            "slip\", unit = \"1\", value = 3",
            "line 5: [columns.slip] must have one of column, value and formula",
        ),
        (
            "[columns]",
            "decimal = \"x\"\n[columns]",
            "map.toml line 2: decimal \"x\" must be \".\" or \",\"",
        ),
        (
            "[columns]",
            "skip = [9]\n[columns]",
            "skip has 9, and line 9 is no row of data",
        ),
        (
            "[columns]",
            "titel = 3\n[columns]",
            "map.toml line 2: unknown key \"titel\"; the nearest known is \"titles\"",
        ),
        ("wheel = {", "wheel {", "map.toml line 3: "),
    ] {
        assert!(RIGHT.contains(from), "{from}");
        let messages = complaints("a.csv", text.as_bytes(), &RIGHT.replacen(from, to, 1)).join("\n");
        assert!(messages.contains(part), "{part} in\n{messages}");
    }
    assert_eq!(complaints("a.csv", text.as_bytes(), RIGHT), [""; 0]);
    let weighed = text.replace("load", "load [kg]");
    let map = RIGHT.replace("\"load\", unit = \"N\"", "\"load [kg]\"");
    assert!(only(&weighed, &map).contains("the title says \"kg\"; unit \"kg\" cannot be used: kg is a mass"));
}

#[test]
fn files_that_are_no_table_say_what_to_do() {
    for (name, bytes, part) in [
        ("a.csv", b"".as_slice(), "a.csv: the file is empty"),
        ("a.csv", b"words\nmore\n", "a.csv: no line has two fields or more"),
        ("a.csv", b"a;b\nx;y\n", "a.csv: no row has a number"),
        ("a.mat", b"rubbish", "save it again with save('NAME.mat', '-v7')"),
        ("a.pdf", b"%PDF-1.7", "this is a PDF: export its table"),
        ("a.docx", b"PK\x03\x04rubbish", "the file is damaged"),
        (
            "a.bin",
            b"\x00\x01\x02\xff\xfe\x00\x00\x03",
            "this is neither text nor a spreadsheet",
        ),
        (
            "a.csv",
            b"slip;load;pull\n0;1,234;5\n",
            "all numbers are like \"1,234\"",
        ),
    ] {
        let messages = complaints(name, bytes, RIGHT).join("\n");
        assert!(messages.contains(part), "{part} in\n{messages}");
    }
}

#[test]
fn fields_that_do_not_fit_the_titles_are_named_by_line() {
    let text = "slip,load,pull\n0.1,100,12.5\n0.2,100,12,5\n0.3,100\n";
    let messages = complaints("a.csv", text.as_bytes(), RIGHT);
    assert!(
        messages[0].starts_with("a.csv line 3: 4 fields where the titles have 3: is a decimal comma"),
        "{messages:#?}"
    );
    assert!(
        messages[1].starts_with("a.csv line 4: 2 fields where the titles have 3"),
        "{messages:#?}"
    );
}

#[test]
fn many_mistakes_of_a_column_are_counted() {
    let rows: String = (0..50).map(|_| "0.1,100,x\n").collect();
    let messages = complaints("a.csv", format!("slip,load,pull\n{rows}").as_bytes(), RIGHT);
    assert_eq!(messages.len(), 11);
    assert_eq!(
        messages[10],
        "a.csv, column \"pull\": 40 more cells of this column have mistakes"
    );
}

#[test]
fn a_title_that_two_columns_have_is_named_by_letters() {
    let text = "slip,load,load,pull\n0.1,100,90,12.5\n0.2,100,90,13.5\n";
    assert!(only(text, RIGHT).ends_with(
        "several columns have the title \"load\": name the one that is meant by its letter, B or C"
    ));
    let map = RIGHT.replace("column = \"load\"", "column = \"C\"");
    assert!(super::runs("a.csv", text.as_bytes(), &map).contains(",90,"));
}
