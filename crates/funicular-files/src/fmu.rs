//! Functional Mock-up Units: the archive, with the library that the C compiler of this machine makes.

use std::env;
use std::fs;
use std::io::{self, Cursor, Write};
use std::process::{Command, Stdio};
use zip::write::SimpleFileOptions;

/// Compilers that are tried in this order, after the one of the environment variable `CC`.
const COMPILERS: [&str; 3] = ["cc", "gcc", "clang"];

/// Folder of the library in a unit of FMI 2.0, and its ending, on this machine; `None` where the standard has none.
fn platform() -> Option<(&'static str, &'static str)> {
    match (env::consts::OS, env::consts::ARCH) {
        ("linux", "x86_64") => Some(("linux64", "so")),
        ("macos", _) => Some(("darwin64", "dylib")),
        ("windows", "x86_64") => Some(("win64", "dll")),
        _ => None,
    }
}

/// Packs a unit: description, source, resources, and the library compiled for this machine. If it cannot be compiled,
/// the unit has its source alone, and the sentence says why.
///
/// # Errors
/// An error of the system while the archive or temporary files are written.
pub fn pack(
    identifier: &str,
    description: &str,
    source: &str,
    resources: &[(&str, &[u8])],
) -> io::Result<(Vec<u8>, Option<String>)> {
    let (library, sentence) = match compile(identifier, source)? {
        Ok(library) => (Some(library), None),
        Err(reason) => {
            let advice = "the unit holds its C source alone, which other programs compile, such as `fmpy compile`";
            (None, Some(format!("{reason}: {advice}")))
        }
    };

    let mut archive = zip::ZipWriter::new(Cursor::new(Vec::new()));
    // The earliest time stamp of the format, so that equal models give equal files.
    let options = SimpleFileOptions::default().last_modified_time(zip::DateTime::default());
    let mut put = |name: String, bytes: &[u8]| {
        archive.start_file(name, options).map_err(io::Error::other)?;
        archive.write_all(bytes)
    };
    put("modelDescription.xml".to_owned(), description.as_bytes())?;
    put(format!("sources/{identifier}.c"), source.as_bytes())?;
    for (name, bytes) in resources {
        put(format!("resources/{name}"), bytes)?;
    }
    if let (Some(library), Some((folder, ending))) = (library, platform()) {
        put(format!("binaries/{folder}/{identifier}.{ending}"), &library)?;
    }
    Ok((archive.finish().map_err(io::Error::other)?.into_inner(), sentence))
}

/// Compiles the source; the inner error is the reason why there is no library.
fn compile(identifier: &str, source: &str) -> io::Result<Result<Vec<u8>, String>> {
    let Some((_, ending)) = platform() else {
        return Ok(Err(format!("FMI 2.0 has no libraries for {} on {}", env::consts::OS, env::consts::ARCH)));
    };
    let folder = tempfile::tempdir()?;
    let from = folder.path().join(format!("{identifier}.c"));
    let to = folder.path().join(format!("{identifier}.{ending}"));
    fs::write(&from, source)?;

    let given = env::var("CC").ok().filter(|name| !name.is_empty());
    for compiler in given.as_deref().into_iter().chain(COMPILERS) {
        let mut command = Command::new(compiler);
        command.args(["-shared", "-fPIC", "-O2", "-std=c99", "-fvisibility=hidden", "-w", "-o"]).arg(&to).arg(&from);
        match command.stdin(Stdio::null()).stdout(Stdio::null()).output() {
            Err(error) if error.kind() == io::ErrorKind::NotFound => {}
            Err(error) => return Ok(Err(format!("the C compiler `{compiler}` cannot be run ({error})"))),
            Ok(done) if done.status.success() => return Ok(Ok(fs::read(&to)?)),
            Ok(done) => {
                let said = String::from_utf8_lossy(&done.stderr);
                let line = said.lines().find(|line| line.contains("error")).or(said.lines().next()).unwrap_or_default();
                return Ok(Err(format!("the C compiler `{compiler}` fails ({line})")));
            }
        }
    }
    Ok(Err("no C compiler was found (cc, gcc, clang, or the one of the environment variable CC)".to_owned()))
}
