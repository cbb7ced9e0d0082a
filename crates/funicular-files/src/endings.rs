//! Endings of file names and their meanings, in one table for all outputs.

use crate::FilesError;
use std::path::Path;

/// Kind of a file, given by the ending of its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Plain text; it may hold any output that is text.
    Text,
    /// Markdown text.
    Markdown,
    /// Table of LaTeX.
    Latex,
    /// JSON.
    Json,
    /// Lines of JSON.
    JsonLines,
    /// Table of comma-separated values.
    Csv,
    /// Rows of a sweep with units, robot and plan.
    Parquet,
    /// Image for ParaView.
    Vti,
    /// Curves and polygons for ParaView.
    Vtp,
    /// Triangles of a surface, for printers and drawing programs.
    Stl,
    /// Polygons of a surface, for programs of meshes.
    Ply,
    /// Page for a browser.
    Html,
    /// Figure of lines and texts for drawing programs and browsers.
    Svg,
    /// Figure of lines and texts for papers.
    Pdf,
    /// Robot file.
    Toml,
    /// Python script.
    Python,
    /// Arrays of NumPy.
    Npz,
    /// Variables of MATLAB.
    Mat,
    /// Universal File of measurements.
    Uff,
    /// Model of MuJoCo.
    Xml,
    /// World or model of Gazebo.
    Sdf,
    /// Links and joints for viewers of robots.
    Urdf,
    /// Unit of a simulation after the Functional Mock-up Interface.
    Fmu,
    /// C source.
    C,
    /// Kind that is never written, in words.
    Other(&'static str),
}

/// All endings with a meaning. A file with any other ending may hold any text.
const ENDINGS: [(&[&str], Kind); 42] = [
    (&["txt", "out", "log", "dat"], Kind::Text),
    (&["md"], Kind::Markdown),
    (&["tex"], Kind::Latex),
    (&["json"], Kind::Json),
    (&["csv"], Kind::Csv),
    (&["parquet"], Kind::Parquet),
    (&["vti"], Kind::Vti),
    (&["vtp"], Kind::Vtp),
    (&["stl"], Kind::Stl),
    (&["ply"], Kind::Ply),
    (&["html", "htm"], Kind::Html),
    (&["svg"], Kind::Svg),
    (&["pdf"], Kind::Pdf),
    (&["toml"], Kind::Toml),
    (&["py"], Kind::Python),
    (&["npz"], Kind::Npz),
    (&["mat"], Kind::Mat),
    (&["uff", "unv"], Kind::Uff),
    (&["xml", "mjcf"], Kind::Xml),
    (&["sdf"], Kind::Sdf),
    (&["urdf"], Kind::Urdf),
    (&["fmu"], Kind::Fmu),
    (&["c", "h"], Kind::C),
    (&["partial", "writing"], Kind::Other("rows of an unfinished sweep")),
    (&["jsonl", "ndjson"], Kind::JsonLines),
    (&["tsv", "tab"], Kind::Other("a table of tab-separated values")),
    (&["xls", "xlsx", "xlsm", "xlsb", "ods"], Kind::Other("a spreadsheet")),
    (&["arrow", "arrows", "feather", "ipc"], Kind::Other("an Arrow file")),
    (&["h5", "hdf", "hdf5", "nc"], Kind::Other("an HDF5 file")),
    (&["m"], Kind::Other("a script of MATLAB")),
    (&["npy"], Kind::Other("one array of NumPy")),
    (&["pkl", "pickle"], Kind::Other("Python's pickled objects")),
    (&["ipynb"], Kind::Other("a notebook")),
    (&["vtk", "vtu", "vtr", "vts", "vtm", "pvd"], Kind::Other("another format of VTK")),
    (&["ps", "eps"], Kind::Other("printed pages")),
    (&["png", "jpg", "jpeg", "gif", "webp", "tif", "tiff", "bmp"], Kind::Other("a picture")),
    (&["doc", "docx", "odt", "rtf", "ppt", "pptx"], Kind::Other("a document")),
    (&["yaml", "yml", "ini"], Kind::Other("another format of settings")),
    (&["wcrfx"], Kind::Other("another format of XML")),
    (&["tcl", "js", "cpp", "rs", "jl", "sh", "bat"], Kind::Other("a program in another language")),
    (&["db", "sqlite", "duckdb"], Kind::Other("a database")),
    (&["zip", "gz", "tgz", "bz2", "xz", "zst", "7z", "tar"], Kind::Other("an archive")),
];

impl Kind {
    /// Kind given by the ending of a file, upper or lower case; `None` for no ending or an ending without a meaning.
    pub fn of(path: &Path) -> Option<Self> {
        let ending = ending(path)?;
        ENDINGS.iter().find(|(endings, _)| endings.contains(&ending.as_str())).map(|(_, kind)| *kind)
    }

    /// First ending of such files, without the dot.
    pub fn ending(self) -> Option<&'static str> {
        ENDINGS.iter().find(|(_, kind)| *kind == self).map(|(endings, _)| endings[0])
    }

    /// Name of the kind in messages.
    fn in_words(self) -> &'static str {
        match self {
            Self::Text => "text",
            Self::Markdown => "Markdown",
            Self::Latex => "LaTeX",
            Self::Json => "JSON",
            Self::JsonLines => "lines of JSON",
            Self::Csv => "CSV",
            Self::Parquet => "a Parquet file",
            Self::Vti => "an image of VTK",
            Self::Vtp => "curves and polygons of VTK",
            Self::Stl => "triangles in STL",
            Self::Ply => "polygons in PLY",
            Self::Html => "an HTML page",
            Self::Svg => "a figure in SVG",
            Self::Pdf => "a figure in PDF",
            Self::Toml => "TOML",
            Self::Python => "a Python script",
            Self::Npz => "arrays of NumPy",
            Self::Mat => "variables of MATLAB",
            Self::Uff => "a Universal File",
            Self::Xml => "a model in XML",
            Self::Sdf => "a model of Gazebo",
            Self::Urdf => "a robot in URDF",
            Self::Fmu => "a Functional Mock-up Unit",
            Self::C => "C source",
            Self::Other(words) => words,
        }
    }
}

/// Refuses a file whose ending contradicts the content to be written.
///
/// `written` names the content in words. `fitting` lists the kinds whose endings are allowed, besides endings of plain
/// text and endings without a meaning.
///
/// # Errors
/// [`FilesError::OtherEnding`], with the endings that fit.
pub fn check(path: &Path, written: &str, fitting: &[Kind]) -> Result<(), FilesError> {
    match Kind::of(path) {
        None | Some(Kind::Text) => Ok(()),
        Some(kind) if fitting.contains(&kind) => Ok(()),
        Some(kind) => Err(FilesError::OtherEnding {
            path: path.to_owned(),
            written: written.to_owned(),
            ending: ending(path).unwrap_or_default(),
            means: kind.in_words(),
            fitting: listed(fitting),
        }),
    }
}

/// Ending of a file name in lower case, without the dot.
fn ending(path: &Path) -> Option<String> {
    path.extension().and_then(|ending| ending.to_str()).map(str::to_ascii_lowercase)
}

/// First ending of each kind, such as ".json, .csv or .txt".
pub fn listed(kinds: &[Kind]) -> String {
    let mut endings: Vec<String> = kinds.iter().filter_map(|kind| Some(format!(".{}", kind.ending()?))).collect();
    match endings.pop() {
        None => ".txt".to_owned(),
        Some(last) if endings.is_empty() => last,
        Some(last) => format!("{} or {last}", endings.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn an_ending_has_one_meaning_in_small_letters() {
        let all: Vec<&str> = ENDINGS.iter().flat_map(|(endings, _)| endings.iter().copied()).collect();
        assert_eq!(all.iter().collect::<HashSet<_>>().len(), all.len());
        assert!(all.iter().all(|ending| ending.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit())));
        let kinds: Vec<Kind> = ENDINGS.iter().map(|(_, kind)| *kind).collect();
        assert!(kinds.iter().enumerate().all(|(i, kind)| !kinds[..i].contains(kind)), "one row for each");
        assert_eq!(Kind::of(Path::new("a/b.JSON")), Some(Kind::Json));
        for free in ["a", "a/b.c/d", ".json", "a.v2", "a.", "-", "a.b-c"] {
            assert_eq!(Kind::of(Path::new(free)), None, "{free}");
        }
    }

    #[test]
    fn a_text_may_have_a_fitting_ending_or_one_without_meaning() {
        let fitting = [Kind::Json, Kind::Csv, Kind::Text];
        for fits in ["a.json", "a.csv", "a.txt", "a.out", "a", "a.v2"] {
            check(Path::new(fits), "the result", &fitting).unwrap();
        }
        let said = check(Path::new("a.xlsx"), "the result", &fitting).unwrap_err().to_string();
        assert_eq!(
            said,
            "a.xlsx would hold the result, and .xlsx means a spreadsheet; choose a name that ends in .json, .csv or \
             .txt"
        );
        assert!(check(Path::new("a.html"), "a page", &[Kind::Html]).is_ok());
        let said = check(Path::new("a.csv"), "a page", &[Kind::Html]).unwrap_err().to_string();
        assert!(said.ends_with("and .csv means CSV; choose a name that ends in .html"), "{said}");
    }
}
