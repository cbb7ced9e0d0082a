//! Pages and files for other programs.

use super::PyAnalyses;
use crate::arrays::{Count, Number, Numbers};
use crate::texts::Texts;
use crate::vibration::{ModesKeywords, PairKeywords};
use crate::written::{self, PageKeywords};
use pyo3::prelude::*;
use std::path::PathBuf;

#[pymethods]
impl PyAnalyses {
    /// Writes the equilibrium as a file of another program; returns the caveats of the file.
    ///
    /// Parameters
    /// ----------
    /// to
    ///     Program that the file is for: `opensees`, `moordyn` or `vtk`.
    /// path
    ///     Path of the file, which is complete or absent.
    /// segments
    ///     Number of elements per cable; 20 if not given.
    /// modes_below_hz
    ///     Limit of the modes in the file [Hz].
    ///
    /// Raises
    /// ------
    /// FileError
    ///     The file cannot be written.
    #[pyo3(signature = (to, path, *, segments=None, modes_below_hz=None))]
    fn export(
        slf: &Bound<'_, Self>,
        py: Python<'_>,
        to: &str,
        path: PathBuf,
        segments: Option<Count>,
        modes_below_hz: Option<Number>,
    ) -> PyResult<Vec<String>> {
        Self::at(slf, |rest| written::export(py, rest, to, path, segments, modes_below_hz))
    }

    /// Writes frequency responses as a Universal File, as the program's `frf -o FILE.uff`; returns the caveats.
    ///
    /// Each response is a function of dataset 58, with its points in dataset 15.
    ///
    /// Parameters
    /// ----------
    /// path
    ///     Path of the file, which is complete or absent.
    /// hz, input, output, adaptive, input_point_m, output_point_m, cable_model, assembly, in_plane_only, winches
    ///     Frequencies, signals and models, as in `frf`. Signals are motions of the platform and forces on it, along
    ///     axes.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     A Universal File cannot hold one of the signals.
    /// FileError
    ///     The file cannot be written.
    #[pyo3(signature = (
        path, hz, input, output, *, adaptive=false, input_point_m=None, output_point_m=None, cable_model=None,
        assembly="consistent", in_plane_only=false, winches="as-given"
    ))]
    #[expect(clippy::too_many_arguments, reason = "Python's keywords")]
    fn write_frf(
        slf: &Bound<'_, Self>,
        py: Python<'_>,
        path: PathBuf,
        hz: Numbers,
        input: Texts,
        output: Texts,
        adaptive: bool,
        input_point_m: Option<Numbers>,
        output_point_m: Option<Numbers>,
        cable_model: Option<&str>,
        assembly: &str,
        in_plane_only: bool,
        winches: &str,
    ) -> PyResult<Vec<String>> {
        let keywords = PairKeywords {
            input: Some(input),
            output: Some(output),
            adaptive,
            input_point_m,
            output_point_m,
            cable_model,
            assembly,
            in_plane_only,
            winches,
        };
        Self::at(slf, |rest| written::write_frf(py, rest, path, hz, keywords))
    }

    /// Writes all mode shapes below a limit as a Universal File, as the program's `modes -o FILE.uff`; returns the
    /// caveats.
    ///
    /// Each mode is a dataset 55 over the origin of the platform and the attachments, in platform axes.
    ///
    /// Parameters
    /// ----------
    /// path
    ///     Path of the file, which is complete or absent.
    /// below_hz, cable_model, assembly, in_plane_only, winches, rigid_cables
    ///     Limit of the frequencies [Hz] and models, as in `modes`.
    ///
    /// Raises
    /// ------
    /// FileError
    ///     The file cannot be written.
    #[pyo3(signature = (
        path, below_hz, *, cable_model=None, assembly="consistent", in_plane_only=false, winches="as-given",
        rigid_cables=false
    ))]
    #[expect(clippy::too_many_arguments, reason = "Python's keywords")]
    fn write_modes(
        slf: &Bound<'_, Self>,
        py: Python<'_>,
        path: PathBuf,
        below_hz: Number,
        cable_model: Option<&str>,
        assembly: &str,
        in_plane_only: bool,
        winches: &str,
        rigid_cables: bool,
    ) -> PyResult<Vec<String>> {
        let keywords = ModesKeywords {
            below_hz: Some(below_hz),
            input: None,
            output: None,
            input_point_m: None,
            output_point_m: None,
            stations: None,
            cable_model,
            assembly,
            in_plane_only,
            winches,
            platform_share: None,
            damped: true,
            rigid_cables,
        };
        Self::at(slf, |rest| written::write_modes(py, rest, path, keywords))
    }

    /// Makes a page in HTML on which the platform can be dragged, which notebooks show.
    ///
    /// The page contains the program itself, as WebAssembly, and needs no network. In a notebook, with the package
    /// `anywidget`, the pose and the values that a person changes come back: `state`, `pose`, `values` and
    /// `equilibrium()` of the result follow the page.
    ///
    /// Parameters
    /// ----------
    /// path
    ///     File to which the page is also written.
    /// cable_model, assembly, in_plane_only, winches
    ///     Models, as in `modes`.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     The package was built without the page.
    #[pyo3(signature = (path=None, *, cable_model=None, assembly="consistent", in_plane_only=false, winches="as-given"))]
    fn live(
        slf: &Bound<'_, Self>,
        py: Python<'_>,
        path: Option<PathBuf>,
        cable_model: Option<&str>,
        assembly: &str,
        in_plane_only: bool,
        winches: &str,
    ) -> PyResult<written::LiveObject> {
        let model = crate::request::model(cable_model, assembly, in_plane_only, winches)?;
        Self::at(slf, |rest| written::live(py, rest, path, model))
    }

    /// Makes a page in HTML about the equilibrium and its vibration, which notebooks show.
    ///
    /// Parameters
    /// ----------
    /// path
    ///     File to which the page is also written.
    /// below_hz
    ///     Limit of the frequencies [Hz]; 20 if not given.
    /// input, output
    ///     Signals of the response on the page, as in `frf`; `fz` and `az` if not given, or `fx` and `ax` for a
    ///     platform that cannot move along z.
    /// input_point_m, output_point_m, cable_model, assembly, in_plane_only, winches
    ///     Points and models, as in `frf`.
    /// platform_share
    ///     Minimum fraction of the kinetic energy in the platform for the first mode of the platform; 0.5 if not given.
    #[pyo3(signature = (
        path=None, *, below_hz=None, input=None, output=None, input_point_m=None, output_point_m=None,
        cable_model=None, assembly="consistent", in_plane_only=false, winches="as-given", platform_share=None
    ))]
    #[expect(clippy::too_many_arguments, reason = "Python's keywords")]
    fn report(
        slf: &Bound<'_, Self>,
        py: Python<'_>,
        path: Option<PathBuf>,
        below_hz: Option<Number>,
        input: Option<String>,
        output: Option<String>,
        input_point_m: Option<Numbers>,
        output_point_m: Option<Numbers>,
        cable_model: Option<&str>,
        assembly: &str,
        in_plane_only: bool,
        winches: &str,
        platform_share: Option<Number>,
    ) -> PyResult<written::PageObject> {
        let keywords = PageKeywords {
            below_hz,
            input,
            output,
            input_point_m,
            output_point_m,
            cable_model,
            assembly,
            in_plane_only,
            winches,
            platform_share,
        };
        Self::at(slf, |rest| written::report(py, rest, path, keywords))
    }
}
