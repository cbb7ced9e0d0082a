//! Files: results written as a whole or not at all, robots from odd places, readers that leave.

use super::{command, run, stderr, stdout, succeed, yuan};
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
    let path = directory.path().join("a.csv");
    succeed(&["statics", "ROBOT", "--format", "json", "-o", path.to_str().unwrap()]);
    assert!(fs::read_to_string(&path).unwrap().starts_with('{'), "--format wins, and a file is replaced");
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

#[test]
fn a_robot_path_may_hold_spaces_and_any_letters() {
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
    let path = std::path::Path::new("/dev/null");
    succeed(&["statics", "ROBOT", "-o", path.to_str().unwrap()]);
    assert!(!fs::metadata(path).unwrap().is_file());
}
