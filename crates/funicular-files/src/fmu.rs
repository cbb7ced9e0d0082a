//! Functional Mock-up Units: the archive, with the library that the C compiler of this machine makes.

use anyhow::{Context, Result, anyhow, bail};
use std::env;
use std::ffi::OsString;
use std::fs;
use std::io::{self, Cursor, Write};
use std::path::PathBuf;
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

    let library = library
        .zip(platform())
        .map(|(library, (folder, ending))| (format!("binaries/{folder}/{identifier}.{ending}"), library));
    Ok((archive(identifier, description, source, resources, library)?, sentence))
}

/// Archive of a unit, with a library and its place in it.
fn archive(
    identifier: &str,
    description: &str,
    source: &str,
    resources: &[(&str, &[u8])],
    library: Option<(String, Vec<u8>)>,
) -> io::Result<Vec<u8>> {
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
    if let Some((name, library)) = library {
        put(name, &library)?;
    }
    Ok(archive.finish().map_err(io::Error::other)?.into_inner())
}

/// Environment variable that names the static C library.
pub const LIBRARY_VARIABLE: &str = "FUNICULAR_C_LIBRARY";
/// File name of the static C library.
const LIBRARY: &str = "libfunicular_c.a";

/// Static C library: the one that the environment names, or the one beside the program.
///
/// # Errors
/// There is none; the message says where it is looked for.
pub fn c_library() -> Result<PathBuf> {
    if let Some(given) = env::var_os(LIBRARY_VARIABLE).filter(|name| !name.is_empty()) {
        let given = PathBuf::from(given);
        if !given.is_file() {
            bail!("there is no file {}, which the environment variable {LIBRARY_VARIABLE} names", given.display());
        }
        return Ok(given);
    }
    let folder = env::current_exe().ok().and_then(|program| Some(program.parent()?.to_owned())).unwrap_or_default();
    let found = [folder.join(LIBRARY), folder.join("deps").join(LIBRARY)].into_iter().find(|path| path.is_file());
    found.with_context(|| {
        format!(
            "a unit with the robot in motion needs the C library {LIBRARY}, which is not in {}: build it by \
             `cargo build -p funicular-c`, and name the file in the environment variable {LIBRARY_VARIABLE}",
            folder.display()
        )
    })
}

/// Packs a unit of FMI 2.0 or 3.0 whose source needs the C library, compiled for this machine.
///
/// # Errors
/// No C library, no C compiler, or an error of the system.
pub fn pack_with_c_library(
    identifier: &str,
    description: &str,
    source: &str,
    resources: &[(&str, &[u8])],
    is_fmi3: bool,
) -> Result<Vec<u8>> {
    let (c_library, last) = (c_library()?, linked());
    let Some((folder, ending)) =
        platform().map(|(folder, ending)| (if is_fmi3 { folder_of_fmi3() } else { folder }, ending))
    else {
        bail!("FMI has no libraries for {} on {}", env::consts::OS, env::consts::ARCH);
    };
    let more: Vec<OsString> = std::iter::once(c_library.into_os_string()).chain(last).collect();
    let library =
        compile_with(identifier, source, &more)?.map_err(|reason| anyhow!("the unit cannot be made: {reason}"))?;
    let name = format!("binaries/{folder}/{identifier}.{ending}");
    Ok(archive(identifier, description, source, resources, Some((name, library)))?)
}

/// Folder of the library in a unit of FMI 3.0 on this machine.
fn folder_of_fmi3() -> &'static str {
    match (env::consts::OS, env::consts::ARCH) {
        ("macos", "aarch64") => "aarch64-darwin",
        ("macos", _) => "x86_64-darwin",
        ("windows", _) => "x86_64-windows",
        _ => "x86_64-linux",
    }
}

/// Arguments of the compiler behind the C library: what it needs of the system, and nothing of it that is seen outside.
fn linked() -> impl Iterator<Item = OsString> {
    let given: &[&str] = match env::consts::OS {
        "linux" => &["-Wl,-exclude-libs,ALL", "-Wl,-gc-sections", "-s", "-lpthread", "-ldl", "-lm"],
        "macos" => &["-Wl,-dead_strip", "-lm"],
        _ => &[],
    };
    given.iter().map(OsString::from)
}

/// Compiles the source; the inner error is the reason why there is no library.
fn compile(identifier: &str, source: &str) -> io::Result<std::result::Result<Vec<u8>, String>> {
    compile_with(identifier, source, &[])
}

/// Compiles the source with more arguments behind it.
fn compile_with(identifier: &str, source: &str, more: &[OsString]) -> io::Result<std::result::Result<Vec<u8>, String>> {
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
        command
            .args(["-shared", "-fPIC", "-O2", "-std=c99", "-fvisibility=hidden", "-w", "-o"])
            .arg(&to)
            .arg(&from)
            .args(more);
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
