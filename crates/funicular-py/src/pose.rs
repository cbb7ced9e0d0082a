//! `funicular.Pose`: position and orientation of the platform.

use crate::arrays::{ARRAY_LIKE, Matrix, Numbers, PickleParts, Vector};
use crate::errors;
use crate::labels::Names;
use funicular::math::{Rotation, rotation};
use funicular::robot::Pose;
use funicular_study::request;
use pyo3::inspect::{PyStaticExpr, PyStaticOperator};
use pyo3::prelude::*;
use pyo3::type_object::PyTypeCheck;

/// Position and orientation of the platform; immutable.
///
/// Parameters
/// ----------
/// position_m
///     Origin of the platform frame in world axes, x, y, z [m].
/// roll_pitch_yaw_deg
///     Roll, pitch, yaw [degrees], R = Rz(yaw) Ry(pitch) Rx(roll); zero if not given.
/// quaternion_wxyz
///     Unit quaternion w, x, y, z instead of angles.
#[pyclass(frozen, weakref, name = "Pose", module = "funicular")]
pub(crate) struct PyPose(pub(crate) Pose);

#[pymethods]
impl PyPose {
    #[new]
    #[pyo3(signature = (position_m, roll_pitch_yaw_deg=None, *, quaternion_wxyz=None))]
    fn new(
        position_m: Numbers,
        roll_pitch_yaw_deg: Option<Numbers>,
        quaternion_wxyz: Option<Numbers>,
    ) -> PyResult<Self> {
        let mut row = position_m.three("position_m")?.to_vec();
        match (roll_pitch_yaw_deg, quaternion_wxyz) {
            (Some(_), Some(_)) => {
                return Err(errors::input("give angles or a quaternion, not both".to_owned()));
            }
            (Some(angles), None) => row.extend(angles_of(angles)?),
            (None, Some(quaternion)) => {
                let quaternion = quaternion.named_row("quaternion_wxyz", &Names::of_quaternion())?;
                if quaternion.len() != 4 {
                    return Err(errors::input(format!("a quaternion has 4 numbers, not {}", quaternion.len())));
                }
                row.extend(quaternion);
            }
            (None, None) => {}
        }

        let pose = of_row("pose", &row).map_err(errors::input)?.to_robot().map_err(|error| errors::study(&error))?;
        Ok(Self(Pose { rot_wp: signed(pose.rot_wp), ..pose }))
    }

    /// Origin of the platform frame in world axes, x, y, z [m].
    #[getter]
    fn position_m(&self) -> Vector {
        self.0.position_w.iter().copied().collect()
    }

    /// Orientation as w, x, y, z with w ≥ 0.
    #[getter]
    fn quaternion_wxyz(&self) -> Vector {
        rotation::quaternion_wxyz(&self.0.rot_wp).into_iter().collect()
    }

    /// Roll, pitch, yaw [degrees], R = Rz(yaw) Ry(pitch) Rx(roll).
    #[getter]
    fn roll_pitch_yaw_deg(&self) -> Vector {
        rotation::to_roll_pitch_yaw_deg(&self.0.rot_wp).into_iter().collect()
    }

    /// Rotation matrix from platform to world axes, 3×3.
    #[getter]
    fn rotation(&self) -> Matrix {
        let rotation = self.0.rot_wp.to_rotation_matrix();
        Matrix::of_rows(rotation.matrix().transpose().iter().copied().collect(), 3)
    }

    /// Homogeneous transformation from platform to world, 4×4.
    #[getter]
    fn matrix(&self) -> Matrix {
        let homogeneous = self.0.rot_wp.to_homogeneous();
        let mut rows: Vec<f64> = homogeneous.transpose().iter().copied().collect();
        for i in 0..3 {
            rows[4 * i + 3] = self.0.position_w[i];
        }
        Matrix::of_rows(rows, 4)
    }

    /// Returns x, y, z, roll, pitch, yaw [m, degrees]: a row of `poses`.
    fn to_array(&self) -> Vector {
        self.0.position_w.iter().copied().chain(rotation::to_roll_pitch_yaw_deg(&self.0.rot_wp)).collect()
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.0 == other.0
    }

    fn __hash__(&self) -> u64 {
        // `+ 0.0` gives both zeros the same hash.
        self.0.position_w.iter().fold(0, |hash, x| hash.rotate_left(21) ^ (x + 0.0).to_bits())
    }

    fn __repr__(&self) -> String {
        let [roll, pitch, yaw] = rotation::to_roll_pitch_yaw_deg(&self.0.rot_wp);
        let p = &self.0.position_w;
        format!("Pose([{:.6}, {:.6}, {:.6}], [{roll:.4}, {pitch:.4}, {yaw:.4}])", p.x, p.y, p.z)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<PickleParts<'py, (Vector, Vector)>> {
        let py = slf.py();
        let rebuild = py.import("funicular._rebuild")?.getattr("pose")?;
        let pose = slf.get();
        Ok((rebuild, (pose.position_m(), pose.quaternion_wxyz())))
    }

    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, memo: &Bound<'_, PyAny>) -> Py<Self> {
        let _ = memo;
        slf
    }
}

impl PyPose {
    /// Makes a pose whose quaternion has w ≥ 0, as it is printed, so that equal texts are equal poses.
    pub(crate) fn of(pose: &Pose) -> Self {
        Self(Pose { rot_wp: signed(pose.rot_wp), ..*pose })
    }
}

/// Roll, pitch, yaw [degrees].
fn angles_of(angles: Numbers) -> PyResult<Vec<f64>> {
    let row = angles.named_row("roll_pitch_yaw_deg", &Names::of_angles())?;
    if row.len() != 3 {
        return Err(errors::input(format!(
            "`roll_pitch_yaw_deg` has {} numbers where roll, pitch, yaw are needed",
            row.len()
        )));
    }
    Ok(row)
}

fn signed(rotation: Rotation) -> Rotation {
    if rotation.quaternion().w < 0.0 { Rotation::new_unchecked(-rotation.into_inner()) } else { rotation }
}

/// Pose from x, y, z, from x, y, z, roll, pitch, yaw [degrees], or from x, y, z and a quaternion w, x, y, z.
pub(crate) fn of_row(what: &str, row: &[f64]) -> Result<request::Pose, String> {
    match *row {
        [x, y, z] => Ok(request::Pose::Angles([x, y, z, 0.0, 0.0, 0.0])),
        [x, y, z, roll, pitch, yaw] => Ok(request::Pose::Angles([x, y, z, roll, pitch, yaw])),
        [x, y, z, w, i, j, k] => Ok(request::Pose::Quaternion([x, y, z], [w, i, j, k])),
        _ => Err(format!(
            "`{what}` has {} numbers: give x, y, z, these and roll, pitch, yaw in degrees, or these and a quaternion \
             w, x, y, z",
            row.len()
        )),
    }
}

/// Argument for a pose: a `Pose` or a row of its numbers.
pub(crate) struct PoseLike(pub(crate) request::Pose);

impl<'a, 'py> FromPyObject<'a, 'py> for PoseLike {
    type Error = PyErr;

    const INPUT_TYPE: PyStaticExpr = PyStaticExpr::BinOp {
        left: &<PyPose as PyTypeCheck>::TYPE_HINT,
        op: PyStaticOperator::BitOr,
        right: &ARRAY_LIKE,
    };

    fn extract(object: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        Self::read("pose", &object)
    }
}

impl PoseLike {
    /// Pose of an argument with this name.
    pub(crate) fn read(what: &str, object: &Bound<'_, PyAny>) -> PyResult<Self> {
        if let Ok(pose) = object.cast::<PyPose>() {
            return Ok(Self((&pose.get().0).into()));
        }
        let row = object.extract::<Numbers>()?.pose(what)?;
        of_row(what, &row).map(Self).map_err(errors::input)
    }
}
