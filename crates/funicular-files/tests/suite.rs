//! Tests of the files of sweeps: survival of interruptions, refusals, reading back.
#![allow(missing_docs)]

use funicular::robot::Robot;
use funicular_files::{Begin, FilesError, Job, Opened, Outcome, SweepFile, Table, merge, threads};
use funicular_study::columns::{Cell, ResultTable};
use funicular_study::request::Axis;
use funicular_study::sweep::{Options, Plan, Poses, Quantity, Steps};
use funicular_study::table::{Chunk, Column, ColumnKind, Part, Record, Values};
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use serde_json::{Map, json};
use std::convert::Infallible;
use std::fs::{self, File};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

const ROBOT: &str = funicular_robots::COGIRO;

/// Time that is never too short for the file of an interrupted run.
const LONG: Duration = Duration::from_secs(3600);

/// Sweep of 70×3 poses, some of them infeasible, with its rows.
fn sweep() -> (Record, Vec<Chunk>) {
    let robot = Robot::from_toml(ROBOT).unwrap();
    let axes = [
        ("x".to_owned(), Steps::range(-9.0, 9.0, 70).unwrap()),
        ("y".to_owned(), Steps::range(-1.0, 1.0, 3).unwrap()),
        ("z".to_owned(), Steps::List(vec![1.0])),
    ];
    let points = Poses::grid(robot.clone(), &axes, None).unwrap();
    // Kinds are text columns, without values where a pose is infeasible.
    let quantities = ["tension-max", "first-kind", "tensions"].map(|name| name.parse::<Quantity>().unwrap());
    let options = Options { highest_hz: 1e-3, ..Options::default() };
    let plan = Plan::new(&points, &robot, &quantities, &options).unwrap();
    let chunks = (0..plan.chunks()).map(|index| plan.evaluate(index, || false).unwrap()).collect();
    let record = Record {
        robot_file: ROBOT.to_owned(),
        plan: Map::from_iter([
            (
                "grid".to_owned(),
                json!(axes.iter().map(|(axis, steps)| Axis::new(axis.clone(), steps)).collect::<Vec<_>>()),
            ),
            ("mass_kg".to_owned(), json!(1.5)),
        ]),
        columns: plan.columns().to_vec(),
        rows: plan.rows(),
        chunk_rows: plan.chunk_rows(),
        part: None,
    };
    (record, chunks)
}

fn open(path: &Path, record: &Record, begin: Begin) -> Result<Box<Job>, FilesError> {
    match Job::open(path, record.clone(), begin)? {
        Opened::Work(job) => Ok(job),
        Opened::Done => panic!("{} is done", path.display()),
    }
}

fn complete(mut job: Box<Job>, chunks: &[Chunk], end: usize) {
    for chunk in &chunks[job.next()..end] {
        job.add(chunk).unwrap();
    }
    job.finish().unwrap();
}

/// Writes a complete file in one run and returns its bytes.
fn complete_file(path: &Path, record: &Record, chunks: &[Chunk]) -> Vec<u8> {
    complete(open(path, record, Begin::Anew).unwrap(), chunks, record.range().end);
    fs::read(path).unwrap()
}

fn partial(path: &Path) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(".partial");
    name.into()
}

fn message(result: Result<Box<Job>, FilesError>) -> String {
    result.err().expect("refused").to_string()
}

#[test]
fn a_journal_cut_off_or_damaged_anywhere_leads_to_the_same_file() {
    let (record, chunks) = sweep();
    let folder = tempfile::tempdir().unwrap();
    for ending in ["parquet", "csv", "vti"] {
        let expected = complete_file(&folder.path().join("whole").with_extension(ending), &record, &chunks);
        let path = folder.path().join("torn").with_extension(ending);
        let mut job = open(&path, &record, Begin::Anew).unwrap();
        chunks[..40].iter().for_each(|chunk| job.add(chunk).unwrap());
        drop(job);
        let journal = fs::read(partial(&path)).unwrap();
        let mut kept = Vec::new();
        for cut in (0..journal.len()).step_by(journal.len() / 23).chain([1, journal.len() - 1, journal.len()]) {
            for damaged in [false, true] {
                let mut bytes = journal.clone();
                if damaged {
                    // A byte that was never written: everything after it is lost, nothing before it.
                    let Some(byte) = bytes.get_mut(cut).filter(|_| cut > 20) else { continue };
                    *byte ^= 0x55;
                } else {
                    bytes.truncate(cut);
                }
                fs::write(partial(&path), bytes).unwrap();
                let job = open(&path, &record, Begin::Resume).unwrap();
                kept.push(job.next());
                complete(job, &chunks, chunks.len());
                assert!(fs::read(&path).unwrap() == expected, "{ending}: cut at {cut}, damaged: {damaged}");
                assert!(!partial(&path).exists());
                fs::remove_file(&path).unwrap();
            }
        }
        assert!(kept.contains(&0) && kept.contains(&40) && kept.iter().any(|next| (1..40).contains(next)), "{kept:?}");
    }
}

#[test]
fn work_is_neither_discarded_without_request_nor_mixed() {
    let (record, chunks) = sweep();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.parquet");
    let mut job = open(&path, &record, Begin::Anew).unwrap();
    assert!(message(open(&path, &record, Begin::Resume)).contains("another run is writing"));
    chunks[..5].iter().for_each(|chunk| job.add(chunk).unwrap());
    drop(job);
    assert!(message(open(&path, &record, Begin::Anew)).contains("holds 15 of 210 rows"));

    let other = |change: &dyn Fn(&mut Record)| {
        let mut other = record.clone();
        change(&mut other);
        message(open(&path, &other, Begin::Resume))
    };
    let said = other(&|record| record.robot_file = record.robot_file.replace("mass_kg = ", "mass_kg = 1"));
    assert!(said.contains("robot file, line ") && said.contains("`mass_kg = "), "{said}");
    let said = other(&|record| record.plan["grid"][1]["count"] = json!(4));
    assert!(said.contains("its grid, item 2, count: 3, here: 4; choose another file"), "{said}");
    let said = other(&|record| drop(record.plan.insert("mass_kg".to_owned(), json!(2.5))));
    assert!(said.contains("its mass_kg: 1.5, here: 2.5; choose another file"), "{said}");
    let said = other(&|record| record.part = Some(Part { number: 1, of: 2 }));
    assert!(said.contains("its part: missing, here: \"1/2\""), "{said}");

    fs::write(partial(&path), "my notes").unwrap();
    assert!(message(open(&path, &record, Begin::Resume)).contains("is no journal of funicular"));
    assert!(message(open(&path, &record, Begin::Anew)).contains("is no journal of funicular"));
    complete(open(&path, &record, Begin::Discard).unwrap(), &chunks, chunks.len());
    assert!(matches!(Job::open(&path, record.clone(), Begin::Resume), Ok(Opened::Done)));
    let mut other = record.clone();
    other.plan.insert("mass_kg".to_owned(), json!(3));
    assert!(
        message(open(&path, &other, Begin::Resume))
            .contains("its mass_kg: 1.5, here: 3; choose another file, or replace this one"),
        "a file of another sweep"
    );
}

#[test]
fn an_interrupted_run_keeps_its_rows_and_replaces_no_complete_file() {
    let (record, chunks) = sweep();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.parquet");
    for more in [7, 9] {
        let mut job = open(&path, &record, Begin::Resume).unwrap();
        for chunk in &chunks[job.next()..][..more] {
            job.add(chunk).unwrap();
        }
        assert!(job.interrupt(LONG).unwrap().ends_with("a.parquet, marked as incomplete"));
    }
    let reader = SerializedFileReader::new(File::open(&path).unwrap()).unwrap();
    assert_eq!(reader.metadata().file_metadata().num_rows(), 16 * 3);
    let expected = complete_file(&folder.path().join("whole.parquet"), &record, &chunks);
    complete(open(&path, &record, Begin::Resume).unwrap(), &chunks, chunks.len());
    assert!(fs::read(&path).unwrap() == expected);
    let mut job = open(&path, &record, Begin::Discard).unwrap();
    job.add(&chunks[0]).unwrap();
    assert!(job.interrupt(LONG).unwrap().ends_with("a.parquet.partial"));
    assert!(fs::read(&path).unwrap() == expected, "a complete file stays");
}

#[test]
fn an_interrupted_run_without_time_keeps_its_journal_and_leaves_nothing_else() {
    let (record, chunks) = sweep();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.parquet");
    let mut job = open(&path, &record, Begin::Anew).unwrap();
    for chunk in &chunks[..5] {
        job.add(chunk).unwrap();
    }
    assert!(job.interrupt(Duration::ZERO).unwrap().ends_with("a.parquet.partial"));
    let left: Vec<_> = fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left, ["a.parquet.partial"]);
    let expected = complete_file(&folder.path().join("whole.parquet"), &record, &chunks);
    complete(open(&path, &record, Begin::Resume).unwrap(), &chunks, chunks.len());
    assert!(fs::read(&path).unwrap() == expected, "the continued run is that of an undisturbed one");
}

#[test]
fn parts_become_the_file_of_one_run_and_nothing_else_does() {
    let (record, chunks) = sweep();
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let expected = complete_file(&at("whole.parquet"), &record, &chunks);
    for of in [1, 3, 100] {
        let part = |number| {
            let record = Record { part: Some(Part { number, of }), ..record.clone() };
            let path = at(&format!("{number}-{of}.parquet"));
            complete_part(open(&path, &record, Begin::Anew).unwrap(), &chunks, &record);
            path
        };
        let parts: Vec<PathBuf> = (1..=of).map(part).rev().collect();
        assert_eq!(merge(&parts, &at("merged.parquet")).unwrap(), 210);
        assert!(fs::read(at("merged.parquet")).unwrap() == expected, "{of} parts");
    }
    let refused = |parts: &[&str]| {
        let parts: Vec<PathBuf> = parts.iter().map(|part| at(&format!("{part}.parquet"))).collect();
        merge(&parts, &at("refused.parquet")).unwrap_err().to_string()
    };
    assert!(refused(&["1-3", "3-3"]).contains("part 2/3 is missing: give all 3 parts"));
    assert!(refused(&["1-3", "2-3", "1-3", "3-3"]).contains("part 1/3 is given twice"));
    assert!(refused(&["1-3", "2-100"]).contains("is part 2/100, but other files are parts of 3"));
    assert!(refused(&["1-3", "whole"]).contains("is no part"));
    let mut other = Record { part: Some(Part { number: 2, of: 3 }), ..record.clone() };
    other.plan.insert("mass_kg".to_owned(), json!(9));
    complete_part(open(&at("other.parquet"), &other, Begin::Anew).unwrap(), &chunks, &other);
    assert!(refused(&["1-3", "other", "3-3"]).contains("its mass_kg: 9"));
    let unfinished = Record { part: Some(Part { number: 2, of: 3 }), ..record.clone() };
    let mut job = open(&at("unfinished.parquet"), &unfinished, Begin::Anew).unwrap();
    job.add(&chunks[job.next()]).unwrap();
    job.interrupt(LONG).unwrap();
    assert!(refused(&["1-3", "unfinished", "3-3"]).contains("(part 2/3) is incomplete"));
    fs::write(at("text.parquet"), "no").unwrap();
    assert!(refused(&["text"]).contains("was not written by a sweep"));
    fs::write(at("text.csv"), "x_m\n1\n").unwrap();
    let said = merge(&[at("text.csv")], &at("refused.parquet")).unwrap_err().to_string();
    assert!(said.contains("write the sweep to a .parquet file"), "{said}");
    let mut permissions = fs::metadata(at("merged.parquet")).unwrap().permissions();
    permissions.set_readonly(true);
    fs::set_permissions(at("merged.parquet"), permissions).unwrap();
    let parts: Vec<PathBuf> = (1..=3).map(|k| at(&format!("{k}-3.parquet"))).collect();
    let said = merge(&parts, &at("merged.parquet")).unwrap_err().to_string();
    assert!(said.contains("it is read-only"), "{said}");
    assert!(!at("refused.parquet").exists());
}

fn complete_part(job: Box<Job>, chunks: &[Chunk], record: &Record) {
    assert_eq!(job.next(), record.range().start);
    complete(job, chunks, record.range().end);
}

/// Sweep of a few rows, small enough to damage each byte of its file.
fn small() -> (Record, Vec<Chunk>) {
    let (record, chunks) = sweep();
    let columns = record.columns[..4].to_vec();
    let chunk = Chunk { index: 0, columns: chunks[0].columns[..4].to_vec() };
    let rows = chunk.rows();
    (Record { robot_file: "name = \"a\"\n".to_owned(), columns, rows, chunk_rows: rows, ..record }, vec![chunk])
}

/// Refusals of a file by all readers of sweep files.
fn refusals(path: &Path, record: &Record) -> Vec<String> {
    let merged = path.with_extension("merged.parquet");
    let refusals = [
        SweepFile::open(path).err().map(|error| error.to_string()),
        Table::read(path).err().map(|error| error.to_string()),
        Job::open(path, record.clone(), Begin::Resume).err().map(|error| error.to_string()),
        merge(&[path.to_owned()], &merged).err().map(|error| error.to_string()),
    ];
    assert!(!merged.exists() && !partial(path).exists(), "nothing is left");
    refusals.into_iter().map(|refusal| refusal.expect("a damaged file is refused")).collect()
}

#[test]
fn a_file_with_one_wrong_bit_anywhere_is_refused_by_every_reader() {
    let (record, chunks) = small();
    let record = Record { part: Some(Part { number: 1, of: 1 }), ..record };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.parquet");
    let good = complete_file(&path, &record, &chunks);
    assert!(matches!(Job::open(&path, record.clone(), Begin::Resume), Ok(Opened::Done)));
    assert_eq!(Table::read(&path).unwrap().rows(), record.rows);
    for at in 0..good.len() {
        let mut bytes = good.clone();
        bytes[at] ^= 1 << (at % 8);
        fs::write(&path, &bytes).unwrap();
        for said in refusals(&path, &record) {
            let clear = ["is damaged, or another program", "it is no Parquet file, or only", "lack the checksum"];
            assert!(clear.iter().any(|words| said.contains(words)), "byte {at}: {said}");
        }
    }
}

#[test]
fn a_file_with_bytes_lost_added_or_blank_is_refused_by_every_reader() {
    let (record, chunks) = sweep();
    let record = Record { part: Some(Part { number: 1, of: 1 }), ..record };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.parquet");
    let good = complete_file(&path, &record, &chunks);
    for at in (0..good.len() - 64).step_by(good.len() / 60).chain([good.len() - 65, good.len() - 64]) {
        let (before, behind) = good.split_at(at);
        let mut swapped = good.clone();
        swapped[at..at + 64].rotate_left(1);
        let damaged = [
            [before, &behind[64..]].concat(),
            [before, &behind[..64], behind].concat(),
            [before, &[0; 64], &behind[64..]].concat(),
            before.to_vec(),
            swapped,
        ];
        for (how, bytes) in damaged.iter().enumerate().filter(|(_, bytes)| **bytes != good) {
            fs::write(&path, bytes).unwrap();
            assert_eq!(refusals(&path, &record).len(), 4, "way {how} at {at}");
        }
    }

    // An interrupted run does not replace a damaged file that was complete.
    let mut bytes = good.clone();
    bytes[100] ^= 1;
    fs::write(&path, &bytes).unwrap();
    let mut job = open(&path, &record, Begin::Anew).unwrap();
    job.add(&chunks[0]).unwrap();
    assert!(job.interrupt(LONG).unwrap().ends_with("a.parquet.partial"));
    assert!(fs::read(&path).unwrap() == bytes);
}

#[test]
fn files_without_a_checksum_and_of_other_programs_are_refused_and_any_reader_takes_ours() {
    use parquet::file::metadata::KeyValue;
    use parquet::file::properties::WriterProperties;
    use parquet::file::writer::SerializedFileWriter;
    let (record, chunks) = sweep();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.parquet");
    let good = complete_file(&path, &record, &chunks);
    let again = folder.path().join("again.parquet");
    assert!(complete_file(&again, &record, &chunks) == good, "the same bytes each time");

    // A file that another program has written with the same columns, and the same metadata or without them.
    let reader = SerializedFileReader::new(File::open(&path).unwrap()).unwrap();
    let pairs = reader.metadata().file_metadata().key_value_metadata().unwrap().clone();
    let schema = reader.metadata().file_metadata().schema_descr().root_schema_ptr();
    let rewritten = |keep: &dyn Fn(&KeyValue) -> bool| {
        let kept = pairs.iter().filter(|pair| keep(pair)).cloned().collect();
        let properties = WriterProperties::builder().set_key_value_metadata(Some(kept)).build();
        let out = File::create(&path).unwrap();
        SerializedFileWriter::new(out, schema.clone(), properties.into()).unwrap().close().unwrap();
        SweepFile::open(&path).err().expect("refused").to_string()
    };
    let said = rewritten(&|_| true);
    assert!(said.contains("is damaged, or another program has rewritten it: its checksum does not match"), "{said}");
    let said = rewritten(&|pair| pair.key != "funicular.checksum");
    assert!(said.contains("lack the checksum: another program or an older version wrote it"), "{said}");
    assert!(rewritten(&|_| false).contains("was not written by a sweep of funicular"));
}

#[test]
fn a_parquet_file_holds_the_rows_their_units_the_robot_and_the_plan() {
    let (record, chunks) = sweep();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.parquet");
    complete_file(&path, &record, &chunks);
    let reader = SerializedFileReader::new(File::open(&path).unwrap()).unwrap();
    let pairs = reader.metadata().file_metadata().key_value_metadata().unwrap();
    let get = |key: &str| pairs.iter().find(|pair| pair.key == key).and_then(|pair| pair.value.clone()).unwrap();
    assert_eq!(get("funicular.robot"), ROBOT);
    assert_eq!(get("funicular.complete"), "true");
    let plan: serde_json::Value = serde_json::from_str(&get("funicular.plan")).unwrap();
    assert_eq!(plan["plan"]["mass_kg"], 1.5);
    let place = record.columns.iter().position(|column| column.name == "tension_max_n").unwrap();
    let values = chunks.iter().map(|chunk| match &chunk.columns[place] {
        Values::Real(values) => values.clone(),
        other => panic!("{other:?}"),
    });
    let written: Vec<Option<f64>> = values.flatten().collect();
    let rows = reader.get_row_iter(None).unwrap().map(Result::unwrap);
    let read: Vec<Option<f64>> = rows
        .map(|row| match row.get_column_iter().nth(place).unwrap().1 {
            Field::Double(value) => Some(*value),
            Field::Null => None,
            other => panic!("{other:?}"),
        })
        .collect();
    assert_eq!(read, written);
    assert!(read.iter().any(Option::is_none) && read.iter().any(Option::is_some));
    let batch = funicular_files::arrow::batch(&record, &chunks[3]).unwrap();
    assert_eq!((batch.num_rows(), batch.num_columns()), (3, record.columns.len()));
}

#[test]
fn images_need_grids_of_equal_steps() {
    let (record, _) = sweep();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.vti");
    let refused = |change: &dyn Fn(&mut Record)| {
        let mut other = record.clone();
        change(&mut other);
        message(open(&path, &other, Begin::Anew))
    };
    let said = refused(&|record| drop(record.plan.remove("grid")));
    assert!(said.contains("an image needs a grid"), "{said}");
    let said = refused(&|record| record.plan["grid"][2]["values"] = json!([1.0, 1.5, 3.0]));
    assert!(said.contains("give the axis z as from:to:count"), "{said}");
    let said = refused(&|record| record.part = Some(Part { number: 1, of: 2 }));
    assert!(said.contains("a part has to be a .parquet file"), "{said}");
    assert!(message(open(&folder.path().join("a.txt"), &record, Begin::Anew)).contains("names no format"));
    assert!(message(open(&folder.path().join("no/a.csv"), &record, Begin::Anew)).contains("there is no directory"));
}

/// Map of 8,000 points whose rows are cheap to compute.
fn energies(robot: &Robot, evaluate: impl FnOnce(&Plan<'_>)) {
    let axis = |name: &str, from, to| (name.to_owned(), Steps::range(from, to, 20).unwrap());
    let axes = [axis("x", -4.0, 4.0), axis("y", -3.0, 3.0), axis("z", 0.5, 3.0)];
    let points = Poses::grid(robot.clone(), &axes, None).unwrap();
    let quantities = ["tensions", "energy"].map(|name| name.parse::<Quantity>().unwrap());
    let options = Options::default();
    evaluate(&Plan::new(&points, robot, &quantities, &options).unwrap());
}

#[test]
fn rows_are_bit_identical_for_any_number_of_threads() {
    energies(&Robot::from_toml(ROBOT).unwrap(), |plan| {
        assert!(plan.chunks() > 20, "{}", plan.chunks());
        let run = |threads| {
            let mut all = Vec::new();
            let threads = NonZeroUsize::new(threads).unwrap();
            let outcome = threads::run(plan, 0..plan.chunks(), threads, &AtomicBool::new(false), |chunk| {
                all.push(chunk);
                Ok::<(), Infallible>(())
            });
            assert_eq!(outcome, Ok(Outcome::Complete));
            all
        };
        // No value is NaN, so equal values are equal bits.
        let alone: Vec<Chunk> = (0..plan.chunks()).map(|index| plan.evaluate(index, || false).unwrap()).collect();
        assert!(run(1) == alone && run(2) == alone && run(7) == alone);
    });
}

#[test]
fn a_run_that_is_cancelled_or_refused_delivers_complete_chunks() {
    energies(&Robot::from_toml(ROBOT).unwrap(), |plan| {
        let (cancel, three) = (AtomicBool::new(false), NonZeroUsize::new(3).unwrap());
        let mut seen = Vec::new();
        let outcome = threads::run(plan, 2..plan.chunks(), three, &cancel, |chunk| {
            seen.push(chunk.index);
            if chunk.index == 5 {
                cancel.store(true, Ordering::Relaxed);
            }
            Ok::<(), Infallible>(())
        });
        let Ok(Outcome::Cancelled { next }) = outcome else { panic!("{outcome:?}") };
        assert!(next >= 6 && next < plan.chunks(), "{next}");
        assert_eq!(seen, (2..next).collect::<Vec<_>>());

        let refused = threads::run(plan, 0..plan.chunks(), three, &AtomicBool::new(false), |chunk| {
            if chunk.index == 4 { Err("the disk is full") } else { Ok(()) }
        });
        assert_eq!(refused, Err("the disk is full"));
    });
}

/// Rows of a result in a Parquet file are those of its table; what a row does not have is empty, and no file of a
/// sweep.
#[test]
fn results_are_parquet_files() {
    let column = |name: &str, kind| Column { name: name.to_owned(), unit: "m".into(), about: "test".to_owned(), kind };
    let columns =
        vec![column("x_m", ColumnKind::Real), column("is_near", ColumnKind::Flag), column("of", ColumnKind::Text)];
    let rows = [
        vec![Cell::Number(1.25), Cell::Flag(true), Cell::Text("a".to_owned())],
        vec![Cell::Missing(None), Cell::Flag(false), Cell::Missing(None)],
        vec![Cell::Count(3), Cell::Flag(true), Cell::Text("ü, ö".to_owned())],
    ];
    let table = ResultTable::of_cells(columns, rows.into_iter());
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("a result.parquet");
    fs::write(&path, funicular_files::parquet_of_result("trajectory", table).unwrap()).unwrap();

    let file = SerializedFileReader::new(File::open(&path).unwrap()).unwrap();
    let rows: Vec<Vec<Field>> = file
        .get_row_iter(None)
        .unwrap()
        .map(|row| row.unwrap().get_column_iter().map(|(_, field)| field.clone()).collect())
        .collect();
    let text = |text: &str| Field::Str(text.to_owned());
    assert_eq!(rows[0], [Field::Double(1.25), Field::Bool(true), text("a")]);
    assert_eq!(rows[1], [Field::Null, Field::Bool(false), Field::Null]);
    assert_eq!(rows[2], [Field::Double(3.0), Field::Bool(true), text("ü, ö")]);
    assert!(merge(&[path], &directory.path().join("b.parquet")).is_err());
}
