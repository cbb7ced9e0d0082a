//! Files: results written completely or not at all, robots from unusual places, readers that stop early.

use super::{command, project, run, stderr, stdout, succeed, yuan};
use std::fs;
use std::io::Read;
use std::process::{Command, Stdio};

fn names(directory: &tempfile::TempDir) -> Vec<String> {
    let entries = fs::read_dir(directory.path()).unwrap();
    let mut names: Vec<String> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn a_result_goes_to_a_file_in_the_format_of_its_ending() {
    let directory = tempfile::tempdir().unwrap();
    for (name, begin) in [("a.json", "{"), ("a.csv", "name,"), ("a.txt", "INSA"), ("a", "INSA")] {
        let path = directory.path().join(name);
        let output = run(&["statics", "ROBOT", "-o", path.to_str().unwrap()]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        assert_eq!(stdout(&output), "");
        assert!(fs::read_to_string(&path).unwrap().starts_with(begin), "{name}");
    }
    assert_eq!(names(&directory), ["a", "a.csv", "a.json", "a.txt"], "nothing else is left");
    let path = directory.path().join("a.txt");
    succeed(&["statics", "ROBOT", "--format", "json", "-o", path.to_str().unwrap()]);
    assert!(fs::read_to_string(&path).unwrap().starts_with('{'), "--format wins, and a file is replaced");
}

#[test]
fn an_ending_that_means_another_format_is_refused_by_every_command() {
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| directory.path().join(name).to_str().unwrap().to_owned();
    let source = project("docs/import/tripod.txt");
    let rows = at("rows.parquet");
    succeed(&["map", "ROBOT", "--grid", "x=0:0.1:2", "--grid", "y=0", "--grid", "z=0.5", "-o", &rows]);
    for (arguments, ending, says) in [
        (
            "modes ROBOT --below-hz 1",
            "xlsx",
            "and .xlsx means a spreadsheet; choose a name that ends in .json, .csv, .parquet, .svg, .pdf, .uff, .tex, \
             .md or .txt",
        ),
        ("modes ROBOT --below-hz 1 --format json", "parquet", "would hold JSON, and .parquet means a Parquet file"),
        ("stiffness ROBOT", "PDF", "would hold text, and .pdf means a figure in PDF"),
        ("frf ROBOT --from-hz 1 --to-hz 2 --points 9 --input fz --output z --format csv", "svg", "would hold CSV"),
        ("report", "svg", "would hold one figure, but the page has many: write one with `funicular statics`, `modes`"),
        ("statics ROBOT", "parquet.partial", "would hold text, and .partial means rows of an unfinished sweep"),
        (
            "statics ROBOT --format json",
            "csv",
            "would hold JSON, and .csv means CSV; choose a name that ends in .json or .txt",
        ),
        (
            "statics ROBOT --format csv",
            "json",
            "would hold CSV, and .json means JSON; choose a name that ends in .csv or .txt",
        ),
        (
            "statics ROBOT --format text",
            "json",
            "would hold text, and .json means JSON; choose a name that ends in .md or .txt",
        ),
        ("reduce ROBOT --below-hz 1", "npz", "would hold text, and .npz means arrays of NumPy"),
        ("report", "csv", "would hold a page, and .csv means CSV; choose a name that ends in .html"),
        ("live", "csv", "would hold a page, and .csv means CSV; choose a name that ends in .html"),
        ("paper", "pdf", "would hold one figure, but the page has many"),
        ("plot ROWS", "png", "would hold a page, and .png means a picture"),
        (
            "import SOURCE",
            "parquet",
            "would hold a robot file, and .parquet means a Parquet file; choose a name that ends in .toml",
        ),
        ("import SOURCE", "yaml", "would hold a robot file, and .yaml means another format of settings"),
        ("export ROBOT --to opensees", "tcl", "means a program in another language; choose a name that ends in .py"),
        ("export ROBOT --to moordyn", "py", "would hold an input file of MoorDyn, and .py means a Python script"),
        ("export ROBOT --to vtk", "vtk", "and .vtk means another format of VTK; choose a name that ends in .vtp"),
        ("validate", "xlsx", "means a spreadsheet"),
        ("map ROBOT --grid x=0:1:2", "xlsx", "names no format: choose .parquet, .csv or .vti"),
        ("merge ROWS", "xlsx", "names no format: choose .parquet, .csv or .vti"),
    ] {
        let path = at(&format!("out.{ending}"));
        let words = arguments.split(' ').map(|word| match word {
            "ROWS" => rows.as_str(),
            "SOURCE" => source.as_str(),
            word => word,
        });
        let output = run(&words.chain(["-o", &path]).collect::<Vec<_>>());
        assert_eq!(output.status.code(), Some(2), "{arguments} -o .{ending}: {}", stderr(&output));
        assert!(stderr(&output).contains(says), "{arguments} -o .{ending}: {}", stderr(&output));
        assert!(!std::path::Path::new(&path).exists());
    }
    // Any text, and what means nothing, is free.
    for name in ["robot", "robot.txt", "robot.out", "robot.v2", "robot.TOML"] {
        succeed(&["import", &source, "-o", &at(name)]);
        succeed(&["check", &at(name)]);
    }
    succeed(&["check", "ROBOT", "-o", &at("check.md")]);
    succeed(&["export", "ROBOT", "--to", "opensees", "--segments", "2", "-o", &at("script")]);
}

#[test]
fn a_command_that_fails_leaves_the_file_as_it_was() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("old.json");
    fs::write(&path, "old").unwrap();
    let output = run(&["statics", "ROBOT", "--pose", "30,0,1", "-o", path.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(fs::read_to_string(&path).unwrap(), "old");
    assert_eq!(names(&directory), ["old.json"]);
}

#[cfg(unix)]
#[test]
fn a_file_has_the_permissions_of_any_new_file_and_links_stay_links() {
    use std::os::unix::fs::PermissionsExt;
    let directory = tempfile::tempdir().unwrap();
    let (path, plain) = (directory.path().join("a.json"), directory.path().join("plain"));
    fs::write(&plain, "").unwrap();
    succeed(&["statics", "ROBOT", "-o", path.to_str().unwrap()]);
    let mode = |path: &std::path::Path| fs::metadata(path).unwrap().permissions().mode();
    assert_eq!(mode(&path), mode(&plain));
    let link = directory.path().join("link.json");
    std::os::unix::fs::symlink(&path, &link).unwrap();
    fs::write(&path, "old").unwrap();
    succeed(&["statics", "ROBOT", "-o", link.to_str().unwrap()]);
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert!(fs::read_to_string(&path).unwrap().starts_with('{'));
}

#[test]
fn the_robot_file_is_never_overwritten() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("robot.toml");
    fs::write(&path, yuan()).unwrap();
    let dotted = directory.path().join(".").join("robot.toml");
    let output = run(&["statics", path.to_str().unwrap(), "-o", dotted.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(fs::read_to_string(&path).unwrap(), yuan());
}

/// Every command that writes, with `OUT` for the file that it writes to.
const WRITERS: [&str; 26] = [
    "check ROBOT -o OUT",
    "parameters ROBOT -o OUT",
    "statics ROBOT -o OUT",
    "stiffness ROBOT -o OUT",
    "modes ROBOT --below-hz 1 -o OUT",
    "frf ROBOT --from-hz 1 --to-hz 2 --points 2 --input fz --output z -o OUT",
    "compare ROBOT --below-hz 1 -o OUT",
    "gradient ROBOT --of pose -o OUT",
    "uncertainty ROBOT --deviations platform.mass_kg=1% -o OUT",
    "uncertainty ROBOT --deviations platform.mass_kg=1% --page OUT",
    "pose-error ROBOT --mass-kg 10:20:2 -o OUT",
    "cable ROBOT --name 1 --from-hz 1 --to-hz 2 --points 2 -o OUT",
    "reduce ROBOT --below-hz 1 -o OUT",
    "reduce ROBOT --below-hz 1 --matrices OUT",
    "identify ROBOT --fit platform.mass_kg --measured-tensions-n 17,36,40,15,50,52 --starts 1 -o OUT",
    "design ROBOT --poses POSES --change platform.mass_kg=±1 --max-iterations 1 -o OUT",
    "map ROBOT --grid x=0 --grid y=0 --grid z=0.5 -o OUT",
    "map ROBOT --grid x=0 --grid y=0 --grid z=0.5 --discard -o OUT",
    "map ROBOT --poses POSES -o OUT",
    "sweep ROBOT --vary platform.mass_kg=10:20:2 --discard -o OUT",
    "report ROBOT -o OUT",
    "export ROBOT --to opensees -o OUT",
    "export ROBOT --to vtk -o OUT",
    "simulate ROBOT --duration-s 0.01 --once -o OUT",
    "simulate ROBOT --duration-s 0.01 --once --discard -o OUT",
    "simulate ROBOT --duration-s 0.01 --once --animation OUT",
];

/// A file that is read is never written over, by whatever name it is called, nor by what is beside the result until it
/// is complete.
#[cfg(unix)]
#[test]
fn no_file_that_is_read_is_written_over_by_any_command() {
    use std::os::unix::fs::symlink;
    let poses = "x_m,y_m,z_m\n0,0,0.5\n";
    for writer in WRITERS {
        // The name of the result, and the file that it or one beside it would be written over.
        let is_rows = writer.starts_with("map") || writer.starts_with("sweep");
        let is_history = writer.starts_with("simulate") && writer.contains(" -o ");
        let endings: &[&str] = if is_rows {
            &["", ".partial", ".writing"]
        } else if is_history {
            &["", ".partial", ".partial.state"]
        } else {
            &[""]
        };
        let name = if is_rows {
            "out.parquet"
        } else if writer.contains("--matrices") {
            "out.npz"
        } else if is_history {
            "out.csv"
        } else {
            "out"
        };
        for beside in endings {
            for how in ["itself", "dotted", "symbolic", "hard"] {
                for input in ["robot", "poses"] {
                    if input == "poses" && !writer.contains("POSES") {
                        continue;
                    }
                    let directory = tempfile::tempdir().unwrap();
                    let at = |name: &str| directory.path().join(name);
                    fs::write(at("robot.toml"), yuan()).unwrap();
                    fs::write(at("poses.csv"), poses).unwrap();
                    let read = if input == "robot" { at("robot.toml") } else { at("poses.csv") };
                    let hit = at(&format!("{name}{beside}"));
                    let mut out = at(name);
                    let mut given = read.clone();
                    match how {
                        "symbolic" => symlink(&read, &hit).unwrap(),
                        "hard" => fs::hard_link(&read, &hit).unwrap(),
                        _ => {
                            fs::rename(&read, &hit).unwrap();
                            given = hit.clone();
                            if how == "dotted" {
                                fs::create_dir(at("sub")).unwrap();
                                out = at("sub/..").join(name);
                            }
                        }
                    }
                    let before = fs::read(&given).unwrap();
                    let robot = if input == "robot" { given.clone() } else { at("robot.toml") };
                    let poses = if input == "poses" { given.clone() } else { at("poses.csv") };
                    let words: Vec<&str> = writer
                        .split(' ')
                        .map(|word| match word {
                            "ROBOT" => robot.to_str().unwrap(),
                            "POSES" => poses.to_str().unwrap(),
                            "OUT" => out.to_str().unwrap(),
                            word => word,
                        })
                        .collect();
                    let output = run(&words);
                    let what = format!("{writer}, {how} {beside}: {}", stderr(&output));
                    assert_eq!(output.status.code(), Some(2), "{what}");
                    assert!(stderr(&output).contains("refusing to write"), "{what}");
                    assert_eq!(fs::read(&given).unwrap(), before, "{what}");
                    assert!(hit.exists(), "{what}");
                }
            }
        }
    }
}

#[test]
fn two_results_do_not_share_a_file_and_sources_and_parts_stay() {
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| directory.path().join(name).to_str().unwrap().to_owned();
    let refused = |arguments: &[&str], says: &str| {
        let output = run(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(says), "{arguments:?}: {}", stderr(&output));
    };
    let reduce = ["reduce", "ROBOT", "--below-hz", "1", "--matrices"];
    let dotted = at("./m");
    refused(&[&reduce[..], &[&at("m.npz"), "-o", &at("m.npz")]].concat(), "means arrays of NumPy");
    refused(
        &[&reduce[..], &[&at("m"), "-o", &dotted]].concat(),
        "refusing to write the matrices and the result both to",
    );
    fs::create_dir(at("folder")).unwrap();
    refused(&[&reduce[..], &[&at("folder"), "-o", &at("folder/M.csv")]].concat(), "refusing to write the matrices and");
    assert_eq!(names(&directory), ["folder"], "nothing is written");

    // The extension of a robot file is free.
    fs::write(at("m.npz"), yuan()).unwrap();
    refused(&["reduce", &at("m.npz"), "--below-hz", "1", "--matrices", &at("m.npz")], "over the robot file");
    assert_eq!(fs::read_to_string(at("m.npz")).unwrap(), yuan());

    let source = fs::read_to_string(project("docs/import/tripod.txt")).unwrap();
    fs::write(at("tripod.txt"), &source).unwrap();
    refused(&["import", &at("tripod.txt"), "-o", &at("./tripod.txt")], "over the source file");
    assert_eq!(fs::read_to_string(at("tripod.txt")).unwrap(), source);

    let part = at("all.parquet.writing");
    let grid = ["--grid", "x=0:0.1:2", "--grid", "y=0", "--grid", "z=0.5", "--part", "1/1", "-o"];
    succeed(&[&["map", "ROBOT"], &grid[..], &[&at("part.parquet")]].concat());
    fs::rename(at("part.parquet"), &part).unwrap();
    let before = fs::read(&part).unwrap();
    refused(&["merge", &part, "-o", &at("all.parquet")], "over the part");
    fs::copy(&part, at("part.parquet")).unwrap();
    refused(&["merge", &at("part.parquet"), "-o", &at("./part.parquet")], "refusing to write the rows over the part");
    assert_eq!(fs::read(at("part.parquet")).unwrap(), before);
    refused(&["plot", &at("part.parquet"), "-o", &at("./part.parquet")], "refusing to write the page over the rows in");
    assert_eq!(fs::read(&part).unwrap(), before);
}

#[cfg(target_os = "linux")]
#[test]
fn a_robot_file_on_standard_input_is_not_written_over() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("robot.toml");
    fs::write(&path, yuan()).unwrap();
    let child = Command::new(env!("CARGO_BIN_EXE_funicular"))
        .args(["check", "-", "-o", path.to_str().unwrap()])
        .stdin(fs::File::open(&path).unwrap())
        .output()
        .unwrap();
    assert_eq!(child.status.code(), Some(2));
    assert!(stderr(&child).contains("refusing to write the result over the robot file"), "{}", stderr(&child));
    assert_eq!(fs::read_to_string(&path).unwrap(), yuan());
}

#[test]
fn a_project_may_hold_spaces_and_any_letters() {
    let directory = tempfile::tempdir().unwrap();
    let folder = directory.path().join("mes robots à câbles 索");
    fs::create_dir(&folder).unwrap();
    let path = folder.join("robot n° 1.toml");
    fs::write(&path, yuan()).unwrap();
    assert!(succeed(&["check", path.to_str().unwrap()]).contains("INSA"));
    fs::write(&path, "name = 3").unwrap();
    assert!(stderr(&run(&["check", path.to_str().unwrap()])).contains("robot n° 1.toml:1:8"));
}

#[test]
fn a_robot_comes_from_standard_input_with_a_mark_and_either_line_end() {
    let text = format!("\u{feff}{}", yuan().replace('\n', "\r\n"));
    for more in [&[][..], &["--set", "platform.mass_kg=20"]] {
        let output = command(&[&["statics", "-"], more].concat()).write_stdin(text.clone()).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    }
}

#[test]
fn a_reader_that_leaves_ends_the_program_in_silence() {
    let frf = "frf ROBOT --from-hz 0.1 --to-hz 20 --points 50000 --input fz --output z --format csv";
    let path = super::robot("yuan2014-4mm.toml");
    let arguments = frf.split(' ').map(|argument| if argument == "ROBOT" { path.as_str() } else { argument });
    let mut child = Command::new(env!("CARGO_BIN_EXE_funicular"))
        .args(arguments)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut head = [0; 13];
    child.stdout.take().unwrap().read_exact(&mut head).unwrap();
    assert_eq!(&head, b"frequency_hz,");
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(stderr(&output), "");
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_error_and_a_device_is_written_as_it_is() {
    let output = run(&["statics", "ROBOT", "-o", "/dev/full"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).starts_with("error: cannot write to /dev/full"), "{}", stderr(&output));
    // Help and the version are results, too.
    for arguments in ["--help", "-h", "--version", "map --help", "help modes", "modes -h", "statics --version"] {
        let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        let program = Command::new(env!("CARGO_BIN_EXE_funicular"))
            .args(arguments.split(' '))
            .stdout(full)
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let output = program.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments}: {}", stderr(&output));
        assert!(stderr(&output).starts_with("error: cannot write to standard output"), "{}", stderr(&output));
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let program = Command::new(env!("CARGO_BIN_EXE_funicular"))
            .args(arguments.split(' '))
            .stdout(writer)
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let output = program.wait_with_output().unwrap();
        assert_eq!((output.status.code(), stderr(&output)), (Some(0), ""), "{arguments}: nobody listens any more");
    }
    let path = std::path::Path::new("/dev/null");
    succeed(&["statics", "ROBOT", "-o", path.to_str().unwrap()]);
    assert!(!fs::metadata(path).unwrap().is_file());
}

/// The table of a result for LaTeX and Markdown has the rounded cells of the text.
#[test]
fn tables_for_papers_have_the_cells_of_the_text() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    let cogiro = super::robot("cogiro.toml");
    for line in
        [&["statics", &cogiro][..], &["modes", &cogiro, "--below-hz", "8"], &["compare", &cogiro, "--below-hz", "8"]]
    {
        for (name, format) in [("t.tex", "latex"), ("t.md", "markdown")] {
            succeed(&[line, &["-o", &at(name)]].concat());
            let written = std::fs::read_to_string(at(name)).unwrap();
            assert_eq!(written, succeed(&[line, &["--format", format]].concat()));
        }

        let latex = std::fs::read_to_string(at("t.tex")).unwrap();
        let lines: Vec<&str> = latex.lines().collect();
        assert_eq!(lines[2], "\\toprule");
        assert_eq!(lines[lines.len() - 2..], ["\\bottomrule", "\\end{tabular}"]);
        let rows: Vec<&str> = lines.iter().copied().filter(|line| line.ends_with(" \\\\")).collect();
        let columns = |row: &str| row.replace("\\&", "").matches(" & ").count() + 1;
        assert!(rows.len() > 4 && rows.iter().all(|row| columns(row) == columns(rows[0])), "{latex}");
        let braces = latex.replace("\\{", "").replace("\\}", "");
        assert_eq!(braces.matches('{').count(), braces.matches('}').count(), "{latex}");
        assert!(latex.is_ascii(), "{latex}");

        let markdown = std::fs::read_to_string(at("t.md")).unwrap();
        let widths: Vec<usize> = markdown.lines().map(|line| line.chars().count()).collect();
        assert!(widths.windows(2).all(|pair| pair[0] == pair[1]), "{markdown}");
        assert_eq!(markdown.lines().count(), rows.len() + 1);
    }
    let text = succeed(&["statics", &cogiro]);
    let markdown = succeed(&["statics", &cogiro, "--format", "markdown"]);
    for cell in markdown.lines().skip(2).flat_map(|line| line.split('|')).map(str::trim).filter(|cell| !cell.is_empty())
    {
        assert!(text.contains(cell), "{cell}: {text}");
    }
    let wrong = super::run(&["statics", &cogiro, "--format", "latex", "-o", &at("t.json")]);
    assert_eq!(wrong.status.code(), Some(2), "{}", super::stderr(&wrong));
}
