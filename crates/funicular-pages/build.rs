//! Compresses plotly.js for the pages at build time. It then has a third of its size, and no work is left for run time.
//! Takes in the page of `live` from the file that the variable FUNICULAR_PAGE names.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD as BASE64;
use flate2::Compression;
use flate2::write::GzEncoder;
use plotly::Plot;
use std::io::Write as _;
use std::path::PathBuf;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    pack_plotly();
    take_page();
}

/// Writes the compressed script to the file that `pages` includes.
fn pack_plotly() {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(plotly_script().as_bytes()).expect("memory takes all that is written");
    let packed = BASE64.encode(encoder.finish().expect("memory takes all that is written"));
    let folder = PathBuf::from(std::env::var_os("OUT_DIR").expect("cargo says where"));
    std::fs::write(folder.join("plotly.js.gz.base64"), packed).expect("cargo's folder can be written to");
}

/// Copies the page of `live` into the folder of this build; without the variable the copy is empty.
fn take_page() {
    println!("cargo::rerun-if-env-changed=FUNICULAR_PAGE");
    let page = std::env::var_os("FUNICULAR_PAGE").filter(|path| !path.is_empty()).map_or_else(String::new, |path| {
        let path = PathBuf::from(path);
        println!("cargo::rerun-if-changed={}", path.display());
        std::fs::read_to_string(&path)
            .unwrap_or_else(|error| panic!("FUNICULAR_PAGE names {}: {error}", path.display()))
    });
    let folder = PathBuf::from(std::env::var_os("OUT_DIR").expect("cargo says where"));
    std::fs::write(folder.join("live.html"), page).expect("cargo's folder can be written to");
}

/// Text of plotly.js.
///
/// The crate provides plotly.js and `MathJax` together, each in a script element. Formulas here are plain text, so
/// the second element, of 2 MB, is left out.
fn plotly_script() -> String {
    let sources = Plot::offline_js_sources();
    let (_, from) = sources.split_once('>').expect("a script element begins");
    let (script, _) = from.split_once("</script>").expect("a script element ends");
    script.to_owned()
}
