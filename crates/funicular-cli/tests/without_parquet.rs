//! The program built without Parquet files: `cargo test -p funicular-cli --no-default-features`.

#![cfg(not(feature = "parquet"))]

use assert_cmd::Command;

const GRID: [&str; 6] = ["map", "-", "--grid", "z=1:2:2", "--quantity", "tension-max"];
const WITHOUT: &str = "this program was built without Parquet files; write .csv or .vti, or build it with the feature \
                       parquet, which is on by default";

/// The program in a folder of its own, with a robot on standard input.
fn run(folder: &tempfile::TempDir, arguments: &[&str]) -> (Option<i32>, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_funicular"));
    let output =
        command.current_dir(folder).args(arguments).write_stdin(funicular_robots::COGIRO).output().expect("it starts");
    (output.status.code(), String::from_utf8(output.stderr).expect("stderr is UTF-8"))
}

#[test]
fn a_report_and_rows_as_text_need_no_parquet() {
    let folder = tempfile::tempdir().unwrap();
    for arguments in [&["report", "-", "-o", "page.html"][..], &[&GRID[..], &["-o", "map.csv"]].concat()] {
        let (code, message) = run(&folder, arguments);
        assert_eq!(code, Some(0), "{message}");
    }
    assert!(std::fs::read_to_string(folder.path().join("page.html")).unwrap().contains("CoGiRo"));
    assert_eq!(std::fs::read_to_string(folder.path().join("map.csv")).unwrap().lines().count(), 3);
}

#[test]
fn parquet_files_are_refused_in_one_message_before_anything_is_computed() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("old.parquet"), "PAR1").unwrap();
    for (arguments, file) in [
        (&[&GRID[..], &["-o", "map.parquet"]].concat()[..], "map.parquet"),
        (&["plot", "old.parquet", "-o", "page.html"], "old.parquet"),
        (&["merge", "old.parquet", "-o", "all.csv"], "old.parquet"),
    ] {
        let (code, message) = run(&folder, arguments);
        assert_eq!(code, Some(2), "{message}");
        assert!(message.contains(&format!("cannot read or write {file}: {WITHOUT}")), "{message}");
    }
    let files = std::fs::read_dir(folder.path()).unwrap().count();
    assert_eq!(files, 1, "nothing else is left");
}
