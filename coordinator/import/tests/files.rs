//! Every file format gives the same runs.

use super::{complaints, converted, runs};

const EXPECTED: &str = "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n,torque_n_m,sinkage_m
a1,w,s,0.1,100,0.008,12.5,3.1,0.00525
a2,w,s,0.2,100,0.008,25,4.2,0.0065
a3,w,s,0.4,100,0.008,35.75,5.9,0.008
a4,w,s,-0.2,100,0.008,-20.5,0.15,0.004
a5,w,s,0,150,0.008,1.5,2.05,0.006
a6,w,s,0.3,150,0.008,,6.8,0.009125
";

const SHEET: &str = r#"
columns.run = { column = "run" }
columns.wheel = { value = "w" }
columns.soil = { value = "s" }
columns.slip = { column = "slip [%]", unit = "%" }
columns.wheel_load_n = { column = "load [kN]", unit = "kN" }
columns.sled_speed_m_s = { column = "speed [mm/s]", unit = "mm/s" }
columns.drawbar_pull_n = { column = "pull [N]", unit = "N" }
columns.torque_n_m = { column = "torque [N cm]", unit = "N cm" }
columns.sinkage_m = { column = "G", unit = "mm" }
"#;

const VARIABLES: &str = r#"
columns.run = { column = "run" }
columns.wheel = { value = "w" }
columns.soil = { value = "s" }
columns.slip = { column = "slip", unit = "%" }
columns.wheel_load_n = { column = "load_kN", unit = "kN" }
columns.sled_speed_m_s = { column = "speed_mm_s", unit = "mm/s" }
columns.drawbar_pull_n = { column = "pull", unit = "N" }
columns.torque_n_m = { column = "torque", unit = "N cm" }
columns.sinkage_m = { column = "sinkage", unit = "mm" }
"#;

const NOTES: &str = "run,operator\na1,Ada\na2,Ada\na3,Grace\na4,Grace\na5,\na6,\n";

#[test]
fn every_spreadsheet_gives_the_same_runs() {
    for (name, bytes) in [
        ("runs.xlsx", include_bytes!("files/runs.xlsx").as_slice()),
        ("runs.ods", include_bytes!("files/runs.ods")),
        ("runs.xls", include_bytes!("files/runs.xls")),
    ] {
        let import = converted(name, bytes, SHEET);
        assert_eq!(import.complaints, [], "{name}");
        assert_eq!(
            (import.runs.as_deref(), import.notes.as_deref()),
            (Some(EXPECTED), Some(NOTES)),
            "{name}"
        );
        assert_eq!(
            import.remarks,
            ["kept as notes, no columns of runs.csv: operator"],
            "{name}"
        );
    }
}

#[test]
fn every_matlab_file_gives_the_same_runs() {
    for (name, bytes, sheet) in [
        (
            "vectors-v7.mat",
            include_bytes!("files/vectors-v7.mat").as_slice(),
            "",
        ),
        (
            "struct-v6.mat",
            include_bytes!("files/struct-v6.mat"),
            "sheet = \"data\"",
        ),
        ("elements-v7.mat", include_bytes!("files/elements-v7.mat"), ""),
        ("vectors-v73.mat", include_bytes!("files/vectors-v73.mat"), ""),
    ] {
        assert_eq!(
            runs(name, bytes, &format!("{sheet}{VARIABLES}")),
            EXPECTED,
            "{name}"
        );
    }
    let import = converted("a.mat", include_bytes!("files/vectors-v7.mat"), VARIABLES);
    assert_eq!(
        import.remarks[0],
        "left out, no columns of this table: cube (an array of more than two dimensions)"
    );
}

#[test]
fn the_sheet_is_chosen_and_its_cells_are_named() {
    let bytes = include_bytes!("files/awkward.xlsx");
    assert_eq!(
        complaints("awkward.xlsx", bytes, SHEET),
        ["awkward.xlsx: several sheets have cells: state `sheet = ` in the map, one of \"Runs\", \"Notes\""]
    );
    assert_eq!(
        complaints("awkward.xlsx", bytes, &format!("sheet = \"Run\"{SHEET}")),
        ["awkward.xlsx: unknown sheet \"Run\"; the nearest known is \"Runs\""]
    );
    let chosen = format!("sheet = \"Runs\"{SHEET}");
    assert_eq!(
        complaints("awkward.xlsx", bytes, &chosen),
        [
            "awkward.xlsx, sheet \"Runs\", cell G9, column \"sinkage [mm]\": the formula of this cell has no stored result: open the file in its program, let it compute, and save it again"
        ]
    );
    // The text 12,5 is read with its decimal comma, and the merged load counts for all its rows.
    let without = chosen.replace("columns.sinkage_m = { column = \"G\", unit = \"mm\" }", "");
    let text = runs("awkward.xlsx", bytes, &without);
    assert!(
        text.contains("\na1,w,s,0.1,100,0.008,12.5,3.1\na2,w,s,0.2,100,0.008,25,4.2\na3,w,s,0.4,100,"),
        "{text}"
    );
}

#[test]
fn a_service_reads_no_old_excel_file() {
    let bytes = include_bytes!("files/runs.xls");
    let source = import::SourceFile {
        name: "runs.xls",
        bytes,
        is_own: false,
    };
    let result = import::convert(&source, ("map.toml", SHEET), "runs");
    assert!(
        result.complaints[0].message.contains("save it as .xlsx"),
        "{:?}",
        result.complaints
    );
}
