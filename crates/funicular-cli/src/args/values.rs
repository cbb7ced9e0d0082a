//! Values on the command line: text in, checked numbers out, each error with the value and what it must be.

use funicular::math::{Mat3, Vec3};
use funicular::response::Quantity;
use funicular::sweep::{self, Steps};
use funicular_files::{Variation, edit};
use std::num::NonZeroUsize;

/// Largest magnitude of a number, as in robot files: no product of the analyses overflows within it.
const LARGEST: f64 = 1e12;
/// Smallest quantity that has to be positive, as in robot files.
const SMALLEST: f64 = 1e-12;

/// A finite number.
pub(crate) fn finite(text: &str) -> Result<f64, String> {
    let text = text.trim();
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && value.abs() <= LARGEST => Ok(value),
        Ok(value) if value.is_finite() => Err(format!("{text} is beyond {LARGEST:e} in magnitude")),
        Ok(_) => Err(format!("{text} is not a finite number")),
        Err(_) if text.is_empty() => Err("a number is missing".to_owned()),
        Err(_) => Err(format!("`{text}` is not a number (write it without its unit, with a point for decimals)")),
    }
}

/// A positive number.
pub(crate) fn positive(text: &str) -> Result<f64, String> {
    match finite(text)? {
        value if value >= SMALLEST => Ok(value),
        value if value > 0.0 => Err(format!("{value:e} is too small, it must be at least {SMALLEST:e}")),
        value => Err(format!("{value} is not positive")),
    }
}

/// A number that is not negative.
pub(crate) fn not_negative(text: &str) -> Result<f64, String> {
    match finite(text)? {
        value if value >= 0.0 => Ok(value),
        value => Err(format!("{value} is negative")),
    }
}

/// Numbers separated by commas.
fn list(text: &str) -> Result<Vec<f64>, String> {
    text.split(',').map(finite).collect()
}

/// Unstrained lengths [m], one a cable.
#[derive(Debug, Clone)]
pub(crate) struct Lengths(pub(crate) Vec<f64>);

/// `6.863,6.565,…`
pub(crate) fn lengths(text: &str) -> Result<Lengths, String> {
    Ok(Lengths(text.split(',').map(positive).collect::<Result<_, _>>()?))
}

/// Tensions [N], one or one a cable.
#[derive(Debug, Clone)]
pub(crate) struct Tensions(pub(crate) Vec<f64>);

/// `500` or `500,450,…`
pub(crate) fn tensions(text: &str) -> Result<Tensions, String> {
    Ok(Tensions(text.split(',').map(not_negative).collect::<Result<_, _>>()?))
}

/// Position [m] and roll, pitch, yaw [degrees].
#[derive(Debug, Clone, Copy)]
pub(crate) struct PoseNumbers {
    pub(crate) position: [f64; 3],
    pub(crate) roll_pitch_yaw_deg: [f64; 3],
}

/// `x,y,z` or `x,y,z,roll,pitch,yaw`
pub(crate) fn pose(text: &str) -> Result<PoseNumbers, String> {
    match list(text)?[..] {
        [x, y, z] => Ok(PoseNumbers { position: [x, y, z], roll_pitch_yaw_deg: [0.0; 3] }),
        [x, y, z, roll, pitch, yaw] => Ok(PoseNumbers { position: [x, y, z], roll_pitch_yaw_deg: [roll, pitch, yaw] }),
        ref other => Err(format!("{} numbers where x,y,z or x,y,z,roll,pitch,yaw are needed", other.len())),
    }
}

/// An inertia tensor [kg m²].
#[derive(Debug, Clone, Copy)]
pub(crate) struct Inertia(pub(crate) Mat3);

/// `xx,yy,zz` or `xx,yy,zz,xy,xz,yz`, the entries of the tensor
pub(crate) fn inertia(text: &str) -> Result<Inertia, String> {
    let [xx, yy, zz, xy, xz, yz] = match list(text)?[..] {
        [xx, yy, zz] => [xx, yy, zz, 0.0, 0.0, 0.0],
        [xx, yy, zz, xy, xz, yz] => [xx, yy, zz, xy, xz, yz],
        ref other => return Err(format!("{} numbers where xx,yy,zz or xx,yy,zz,xy,xz,yz are needed", other.len())),
    };
    Ok(Inertia(Mat3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)))
}

/// `x,y,z`
pub(crate) fn point(text: &str) -> Result<Vec3, String> {
    match list(text)?[..] {
        [x, y, z] => Ok(Vec3::new(x, y, z)),
        ref other => Err(format!("{} numbers where x,y,z are needed", other.len())),
    }
}

/// `x,y,z`, of any length but zero.
fn direction(text: &str) -> Result<Vec3, String> {
    let vector = point(text)?;
    if vector.norm() >= SMALLEST { Ok(vector) } else { Err("a direction cannot be zero".to_owned()) }
}

/// The unit vector of a world axis.
fn axis(name: &str) -> Option<Vec3> {
    match name {
        "x" => Some(Vec3::x()),
        "y" => Some(Vec3::y()),
        "z" => Some(Vec3::z()),
        _ => None,
    }
}

/// A point on a cable.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct OnCable {
    /// Name of the cable.
    pub(crate) name: String,
    /// Part of the unstrained length from the platform.
    pub(crate) fraction: f64,
}

/// `cable:NAME@FRACTION:WHAT`: the point, and WHAT. `None` if it does not begin so. The name may hold any character; the
/// last `@` ends it.
fn on_cable(text: &str) -> Result<Option<(OnCable, &str)>, String> {
    let Some(rest) = text.strip_prefix("cable:") else { return Ok(None) };
    let form = "a point on a cable is cable:NAME@FRACTION:DIRECTION, as in cable:3@0.5:z";
    let (name, rest) = rest.rsplit_once('@').ok_or(format!("`@` is missing: {form}"))?;
    let (fraction, what) = rest.split_once(':').ok_or(format!("the direction is missing: {form}"))?;
    let fraction = finite(fraction)?;
    if !(0.0..=1.0).contains(&fraction) {
        return Err(format!("{fraction} is not a part of the cable's length: 0 is the platform, 1 the anchor"));
    }
    Ok(Some((OnCable { name: name.to_owned(), fraction }, what)))
}

/// What drives the platform or a cable.
#[derive(Debug, Clone)]
pub(crate) struct Input {
    /// As the user wrote it.
    pub(crate) name: String,
    /// Where, if not on the platform.
    pub(crate) on_cable: Option<OnCable>,
    /// A moment, not a force.
    pub(crate) is_moment: bool,
    /// Direction in world axes.
    pub(crate) direction_w: Vec3,
}

/// `fx` … `mz`, `f:ux,uy,uz`, `m:ux,uy,uz`; forces also after `cable:NAME@FRACTION:`
pub(crate) fn input(text: &str) -> Result<Input, String> {
    let name = text.trim().to_owned();
    if let Some((place, what)) = on_cable(&name)? {
        let force = input(what)?;
        if force.is_moment || force.on_cable.is_some() {
            return Err(format!("{what} is not a force, and only forces act on a cable"));
        }
        return Ok(Input { name, on_cable: Some(place), ..force });
    }
    let of = |is_moment, direction_w| Ok(Input { name: name.clone(), on_cable: None, is_moment, direction_w });
    if let Some(rest) = name.strip_prefix("f:") {
        return of(false, direction(rest)?);
    }
    if let Some(rest) = name.strip_prefix("m:") {
        return of(true, direction(rest)?);
    }
    if let Some(along) = name.strip_prefix('f').and_then(axis) {
        return of(false, along);
    }
    if let Some(about) = name.strip_prefix('m').and_then(axis) {
        return of(true, about);
    }
    Err("not an input: fx, fy, fz (force), mx, my, mz (moment), f:ux,uy,uz or m:ux,uy,uz (along a direction in world \
         axes), or a force on a cable as in cable:3@0.5:fz"
        .to_owned())
}

/// What is measured of the platform or a cable.
#[derive(Debug, Clone)]
pub(crate) struct Output {
    /// As the user wrote it.
    pub(crate) name: String,
    /// Where, if not on the platform.
    pub(crate) on_cable: Option<OnCable>,
    /// A rotation, not a translation.
    pub(crate) is_rotation: bool,
    /// Displacement, velocity or acceleration.
    pub(crate) quantity: Quantity,
    /// Direction in world axes.
    pub(crate) direction_w: Vec3,
}

/// `x` … `rz`, with `v` or `a` before it, or `x:ux,uy,uz`, `v:…`, `a:…`; translations also after `cable:NAME@FRACTION:`
pub(crate) fn output(text: &str) -> Result<Output, String> {
    let name = text.trim().to_owned();
    if let Some((place, what)) = on_cable(&name)? {
        let motion = output(what)?;
        if motion.is_rotation || motion.on_cable.is_some() {
            return Err(format!("{what} is not a translation, and the points of a cable do not turn"));
        }
        return Ok(Output { name, on_cable: Some(place), ..motion });
    }
    let of = |quantity, is_rotation, direction_w| {
        Ok(Output { name: name.clone(), on_cable: None, is_rotation, quantity, direction_w })
    };
    for (prefix, quantity) in
        [("x:", Quantity::Displacement), ("v:", Quantity::Velocity), ("a:", Quantity::Acceleration)]
    {
        if let Some(rest) = name.strip_prefix(prefix) {
            return of(quantity, false, direction(rest)?);
        }
    }
    let (quantity, rest) = match name.as_bytes().first() {
        Some(b'v') => (Quantity::Velocity, &name[1..]),
        Some(b'a') => (Quantity::Acceleration, &name[1..]),
        _ => (Quantity::Displacement, name.as_str()),
    };
    if let Some(along) = axis(rest) {
        return of(quantity, false, along);
    }
    if let Some(about) = rest.strip_prefix('r').and_then(axis) {
        return of(quantity, true, about);
    }
    Err("not an output: x, y, z, rx, ry, rz (displacement, rotation), with v (velocity) or a (acceleration) before it \
         as in ay, or x:ux,uy,uz, v:ux,uy,uz, a:ux,uy,uz (along a direction in world axes), or a point \
         of a cable as in cable:3@0.5:az"
        .to_owned())
}

/// Points along a cable, both ends included.
pub(crate) fn stations(text: &str) -> Result<usize, String> {
    const MOST: usize = 1000;
    match text.trim().parse::<usize>() {
        Ok(count @ 2..=MOST) => Ok(count),
        _ => Err(format!("`{text}` is not a number of points: a whole number from 2 to {MOST}")),
    }
}

/// Masses from one to another in equal steps [kg].
#[derive(Debug, Clone, Copy)]
pub(crate) struct MassRange {
    pub(crate) from: f64,
    pub(crate) to: f64,
    pub(crate) count: usize,
}

/// Most masses of a range.
const MOST_MASSES: usize = 100_000;

/// `from:to:count`
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
        Ok(count @ 2..=MOST_MASSES) => Ok(MassRange { from, to, count }),
        _ => Err(format!("`{count}` is not a count of masses: a whole number from 2 to {MOST_MASSES}")),
    }
}

/// Most values that a list of them may have; a range may have more.
const MOST_LISTED: usize = 10_000;

/// `A:B:N`, or values separated by commas.
fn steps(text: &str) -> Result<Steps, String> {
    let parts: Vec<&str> = text.split(':').collect();
    match parts[..] {
        [_] => {
            let values = list(text)?;
            if values.len() > MOST_LISTED {
                return Err(format!("{} values are more than the {MOST_LISTED} of a list", values.len()));
            }
            Ok(Steps::List(values))
        }
        [from, to, count] => {
            let (from, to) = (finite(from)?, finite(to)?);
            let most = sweep::MOST_POINTS;
            match count.trim().parse::<usize>() {
                Ok(count) if count <= most => Steps::range(from, to, count),
                _ => Err(format!("`{count}` is not a number of values: a whole number from 2 to {most}")),
            }
        }
        _ => Err("not a range: write from:to:count, as in -4:4:81, or values, as in 0.5,1,2".to_owned()),
    }
}

/// `x=-4:4:81`
pub(crate) fn grid_axis(text: &str) -> Result<(String, Steps), String> {
    let (axis, values) = text.split_once('=').ok_or("it has no `=`: write AXIS=from:to:count, as in x=-4:4:81")?;
    let axis = axis.trim();
    if !sweep::AXES.contains(&axis) {
        return Err(sweep::SweepError::UnknownAxis { axis: axis.to_owned() }.to_string());
    }
    Ok((axis.to_owned(), steps(values)?))
}

/// `platform.mass_kg=10:90:81`
pub(crate) fn variation(text: &str) -> Result<Variation, String> {
    let form = "it has no `=`: write PATH=from:to:count, as in platform.mass_kg=10:90:81";
    let (path, values) = edit::split(text).ok_or(form)?;
    Ok(Variation { path: edit::path(path)?, steps: steps(values)? })
}

/// The name of a quantity of a sweep.
pub(crate) fn quantity(text: &str) -> Result<sweep::Quantity, String> {
    text.parse().map_err(|error: sweep::UnknownQuantity| error.to_string())
}

/// A number of threads.
pub(crate) fn threads(text: &str) -> Result<NonZeroUsize, String> {
    const MOST: usize = 1024;
    match text.trim().parse::<NonZeroUsize>() {
        Ok(count) if count.get() <= MOST => Ok(count),
        _ => Err(format!("`{text}` is not a number of threads: a whole number from 1 to {MOST}")),
    }
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
        assert!(written("-1,2,3").contains("[-1.0, 2.0, 3.0]"));
        assert!(written("1,2,3,4,5,-6").contains("[4.0, 5.0, -6.0]"));
        assert!(pose("1,2").is_err() && pose("1,2,3,4").is_err() && pose("1,,3").is_err());
    }

    #[test]
    fn inputs_and_outputs_have_the_names_of_the_field() {
        for (text, is_moment) in [("fx", false), ("mz", true), ("f:0,-1,1", false), ("m:1,0,0", true)] {
            assert_eq!(input(text).unwrap().is_moment, is_moment, "{text}");
        }
        for bad in ["", "f", "fw", "fxy", "f:0,0,0", "f:1,2", "x", "Fx"] {
            assert!(input(bad).is_err(), "{bad}");
        }
        for (text, quantity, is_rotation) in [
            ("x", Quantity::Displacement, false),
            ("rz", Quantity::Displacement, true),
            ("vy", Quantity::Velocity, false),
            ("ary", Quantity::Acceleration, true),
            ("a:0,1,1", Quantity::Acceleration, false),
            ("x:0,1,1", Quantity::Displacement, false),
        ] {
            let found = output(text).unwrap();
            assert!(found.quantity == quantity && found.is_rotation == is_rotation, "{text}");
        }
        for bad in ["", "a", "v", "r", "rw", "fz", "a:0,0,0", "é"] {
            assert!(output(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn a_point_on_a_cable_is_its_name_and_a_part_of_its_length() {
        let found = output("cable:left @ rope:2@0.25:a:0,1,1").unwrap();
        assert_eq!(found.on_cable, Some(OnCable { name: "left @ rope:2".to_owned(), fraction: 0.25 }));
        assert!(found.quantity == Quantity::Acceleration && found.direction_w == Vec3::new(0.0, 1.0, 1.0));
        assert_eq!(input("cable:3@1:fz").unwrap().on_cable.unwrap().fraction.to_bits(), 1.0_f64.to_bits());
        for bad in ["cable:3", "cable:3@0.5", "cable:3@1.5:z", "cable:3@-0.1:z", "cable:3@x:z", "cable:3@0.5:rz"] {
            assert!(output(bad).is_err(), "{bad}");
        }
        assert!(input("cable:3@0.5:mz").is_err());
    }

    #[test]
    fn a_mass_range_goes_up() {
        assert_eq!(mass_range("10:90:81").unwrap().count, 81);
        for bad in ["10", "10:90", "90:10:5", "10:90:1", "10:90:x", "0:9:3", "1:2:3:4"] {
            assert!(mass_range(bad).is_err(), "{bad}");
        }
    }
}
