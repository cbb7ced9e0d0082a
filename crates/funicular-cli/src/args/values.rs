//! Values on the command line, read from text and checked. Each error contains the value and its permitted range.

use funicular::math::Vec3;
use funicular_files::threads::{self, THREADS};
use funicular_study::analyses::pose_error::MAX_MASSES;
use funicular_study::request::MAX_STATIONS;
use funicular_study::sweep::{self, Steps, ValueAxis};
use funicular_study::{set_values, values};
use std::num::NonZeroUsize;

/// Reads a finite number.
pub(crate) fn finite(text: &str) -> Result<f64, String> {
    values::number(text).map_err(|error| error.to_string())
}

/// Reads a positive number.
pub(crate) fn positive(text: &str) -> Result<f64, String> {
    values::positive(finite(text)?)
}

/// Reads a number that is not negative.
pub(crate) fn not_negative(text: &str) -> Result<f64, String> {
    values::not_negative(finite(text)?)
}

/// Reads a fraction: above 0, at most 1.
pub(crate) fn fraction(text: &str) -> Result<f64, String> {
    values::fraction(finite(text)?)
}

/// Reads numbers separated by commas.
fn list(text: &str) -> Result<Vec<f64>, String> {
    text.split(',').map(finite).collect()
}

/// Unstrained lengths [m], one per cable.
#[derive(Debug, Clone)]
pub(crate) struct Lengths(pub(crate) Vec<f64>);

/// Reads `6.863,6.565,…`.
pub(crate) fn lengths(text: &str) -> Result<Lengths, String> {
    Ok(Lengths(text.split(',').map(positive).collect::<Result<_, _>>()?))
}

/// Tensions [N], one for all cables or one per cable.
#[derive(Debug, Clone)]
pub(crate) struct Tensions(pub(crate) Vec<f64>);

/// Reads `500` or `500,450,…`.
pub(crate) fn tensions(text: &str) -> Result<Tensions, String> {
    Ok(Tensions(text.split(',').map(not_negative).collect::<Result<_, _>>()?))
}

/// Position x, y, z [m] and roll, pitch, yaw [degrees].
#[derive(Debug, Clone, Copy)]
pub(crate) struct PoseNumbers(pub(crate) [f64; 6]);

/// Reads `x,y,z` or `x,y,z,roll,pitch,yaw`.
pub(crate) fn pose(text: &str) -> Result<PoseNumbers, String> {
    match list(text)?[..] {
        [x, y, z] => Ok(PoseNumbers([x, y, z, 0.0, 0.0, 0.0])),
        [x, y, z, roll, pitch, yaw] => Ok(PoseNumbers([x, y, z, roll, pitch, yaw])),
        ref other => Err(format!("{} numbers where x,y,z or x,y,z,roll,pitch,yaw are needed", other.len())),
    }
}

/// Entries xx, yy, zz, xy, xz, yz of an inertia tensor [kg m²].
#[derive(Debug, Clone, Copy)]
pub(crate) struct Inertia(pub(crate) [f64; 6]);

/// Reads `xx,yy,zz` or `xx,yy,zz,xy,xz,yz`, the entries of the tensor.
pub(crate) fn inertia(text: &str) -> Result<Inertia, String> {
    match list(text)?[..] {
        [xx, yy, zz] => Ok(Inertia([xx, yy, zz, 0.0, 0.0, 0.0])),
        [xx, yy, zz, xy, xz, yz] => Ok(Inertia([xx, yy, zz, xy, xz, yz])),
        ref other => Err(format!("{} numbers where xx,yy,zz or xx,yy,zz,xy,xz,yz are needed", other.len())),
    }
}

/// Reads `x,y,z`.
pub(crate) fn point(text: &str) -> Result<Vec3, String> {
    match list(text)?[..] {
        [x, y, z] => Ok(Vec3::new(x, y, z)),
        ref other => Err(format!("{} numbers where x,y,z are needed", other.len())),
    }
}

/// Reads a number of points along a cable, both ends included.
pub(crate) fn stations(text: &str) -> Result<usize, String> {
    match text.trim().parse::<usize>() {
        Ok(count @ 2..=MAX_STATIONS) => Ok(count),
        _ => Err(format!("`{text}` is not a number of points: give a whole number from 2 to {MAX_STATIONS}")),
    }
}

/// Axes of a slice: horizontal and vertical.
#[derive(Debug, Clone)]
pub(crate) struct Plane(pub(crate) [String; 2]);

/// Reads the two axes of a slice, as in `x,z`.
pub(crate) fn plane(text: &str) -> Result<Plane, String> {
    match text.split(',').map(str::trim).collect::<Vec<_>>()[..] {
        [h, v] if !h.is_empty() && !v.is_empty() => Ok(Plane([h.to_owned(), v.to_owned()])),
        _ => Err(format!("`{text}` is not a pair of axes: give two names, as in x,z")),
    }
}

/// Reads the value of an axis, as in `z=1.5`.
pub(crate) fn place(text: &str) -> Result<(String, f64), String> {
    let (name, value) = text.split_once('=').ok_or_else(|| format!("`{text}` has no value: give one, as in z=1.5"))?;
    Ok((name.trim().to_owned(), finite(value)?))
}

/// Range of masses in equal steps [kg].
#[derive(Debug, Clone, Copy)]
pub(crate) struct MassRange {
    pub(crate) from: f64,
    pub(crate) to: f64,
    pub(crate) count: usize,
}

/// Reads `from:to:count`.
pub(crate) fn mass_range(text: &str) -> Result<MassRange, String> {
    let parts: Vec<&str> = text.split(':').collect();
    let [from, to, count] = parts[..] else {
        return Err("not a range: write from:to:count, as in 10:90:81".to_owned());
    };
    let (from, to) = (positive(from)?, positive(to)?);
    if to <= from {
        return Err(format!("the range ends at {to}, it must end above its start {from}"));
    }
    match count.trim().parse::<usize>() {
        Ok(count @ 2..=MAX_MASSES) => Ok(MassRange { from, to, count }),
        _ => Err(format!("`{count}` is not a number of masses: give a whole number from 2 to {MAX_MASSES}")),
    }
}

/// Maximum number of values in a list. A range may have more.
const MAX_LISTED: usize = 10_000;

/// Reads `A:B:N`, or values separated by commas.
fn steps(text: &str) -> Result<Steps, String> {
    let parts: Vec<&str> = text.split(':').collect();
    match parts[..] {
        [_] => {
            let values = list(text)?;
            if values.len() > MAX_LISTED {
                return Err(format!(
                    "the list has {} values, at most {MAX_LISTED} are possible: give a range",
                    values.len()
                ));
            }
            Ok(Steps::List(values))
        }
        [from, to, count] => {
            let (from, to) = (finite(from)?, finite(to)?);
            let max = sweep::MAX_POINTS;
            match count.trim().parse::<usize>() {
                Ok(count) if count <= max => Steps::range(from, to, count),
                _ => Err(format!("`{count}` is not a number of values: give a whole number from 2 to {max}")),
            }
        }
        _ => Err("not a range: write from:to:count, as in -4:4:81, or values, as in 0.5,1,2".to_owned()),
    }
}

/// Reads `x=-4:4:81`.
pub(crate) fn grid_axis(text: &str) -> Result<(String, Steps), String> {
    let (axis, values) = text.split_once('=').ok_or("it has no `=`: write AXIS=from:to:count, as in x=-4:4:81")?;
    let axis = axis.trim();
    if !sweep::AXES.contains(&axis) {
        return Err(sweep::SweepError::UnknownAxis { axis: axis.to_owned() }.to_string());
    }
    Ok((axis.to_owned(), steps(values)?))
}

/// Reads `platform.mass_kg=10:90:81`.
pub(crate) fn variation(text: &str) -> Result<ValueAxis, String> {
    let form = "it has no `=`: write PATH=from:to:count, as in platform.mass_kg=10:90:81";
    let (path, values) = set_values::split(text).ok_or(form)?;
    ValueAxis::new(path, steps(values)?)
}

/// Reads the name of a quantity of a sweep.
pub(crate) fn quantity(text: &str) -> Result<sweep::Quantity, String> {
    text.parse().map_err(|error: sweep::UnknownQuantity| error.to_string())
}

/// Reads a number of threads.
pub(crate) fn threads(text: &str) -> Result<NonZeroUsize, String> {
    let (first, last) = (THREADS.start(), THREADS.end());
    (text.trim().parse().ok().and_then(threads::checked))
        .ok_or_else(|| format!("`{text}` is not a number of threads: give a whole number from {first} to {last}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_finite_and_in_range() {
        assert_eq!(finite(" -0.5 "), Ok(-0.5));
        for bad in ["", "nan", "inf", "-inf", "1e13", "1,5", "5kg", "1e999"] {
            assert!(finite(bad).is_err(), "{bad}");
        }
        assert!(positive("0").is_err() && positive("-1").is_err() && positive("1e-13").is_err());
        assert!(not_negative("0").is_ok() && not_negative("-1e-3").is_err());
    }

    #[test]
    fn poses_have_three_or_six_numbers() {
        let written = |text| format!("{:?}", pose(text).unwrap());
        assert!(written("-1,2,3").contains("[-1.0, 2.0, 3.0, 0.0, 0.0, 0.0]"));
        assert!(written("1,2,3,4,5,-6").contains("4.0, 5.0, -6.0]"));
        assert!(pose("1,2").is_err() && pose("1,2,3,4").is_err() && pose("1,,3").is_err());
    }

    #[test]
    fn a_mass_range_goes_up() {
        assert_eq!(mass_range("10:90:81").unwrap().count, 81);
        for bad in ["10", "10:90", "90:10:5", "10:90:1", "10:90:x", "0:9:3", "1:2:3:4"] {
            assert!(mass_range(bad).is_err(), "{bad}");
        }
    }
}
