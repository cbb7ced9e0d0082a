//! Forms of the values of options on the command line. Each message contains the value and its permitted range.

use crate::analyses::pose_error::MAX_MASSES;
use crate::request::{Axis, BoundValue, ChangeValue, FitValue, Key, Kind, PointValue, PriorValue, ProgramForm, Range};
use crate::set_values;
use crate::signals::{Input, Output};
use crate::sweep::{self, Steps, ValueAxis};
use crate::values;
use serde_json::{Value, json};
use std::ops::RangeInclusive;

/// Reads the text of the program's option as the JSON value of its key. Of a list it reads one element.
///
/// # Errors
/// A message that says what is wrong with the text.
pub fn read(key: &Key, text: &str) -> Result<Value, String> {
    match &key.kind {
        Kind::Switch => Ok(Value::Bool(true)),
        Kind::Number(range) => Ok(range.check(number(text)?)?.into()),
        Kind::Count(range) => count(text, range),
        Kind::PerCable(range) | Kind::OneOrPerCable(range) => numbers(text, *range),
        Kind::Vector => vector(text),
        Kind::Pose => pose(text),
        Kind::Tensor => tensor(text),
        Kind::Name(..)
        | Kind::Text
        | Kind::Texts
        | Kind::Sizes
        | Kind::Poses
        | Kind::Columns
        | Kind::GappedColumns
        | Kind::ByCable(_)
        | Kind::Data(_) => Ok(text.into()),
        Kind::Written(form) | Kind::List(form) | Kind::OneOrMore(form) | Kind::Commas(form) => read_form(*form, text),
    }
}

fn read_form(form: ProgramForm, text: &str) -> Result<Value, String> {
    match form {
        ProgramForm::Input => input(text),
        ProgramForm::Output => output(text),
        ProgramForm::Positive => positive(text),
        ProgramForm::NotNegative => not_negative(text),
        ProgramForm::Quantity => quantity(text),
        ProgramForm::MassRange => mass_range(text),
        ProgramForm::GridAxis => grid_axis(text),
        ProgramForm::Side => side(text),
        ProgramForm::Variation => variation(text),
        ProgramForm::Fit => fit(text),
        ProgramForm::Change => change(text),
        ProgramForm::Prior => {
            prior(text).and_then(|prior| serde_json::to_value(prior).map_err(|error| error.to_string()))
        }
        ProgramForm::Band => band(text),
        ProgramForm::Bound => bound(text),
        ProgramForm::Point => named_point(text),
    }
}

/// Meaning of a key, with the names that its value can have if a table of the program knows them.
pub fn about(key: &Key) -> String {
    if !matches!(key.kind, Kind::Commas(ProgramForm::Quantity)) {
        return key.about.clone();
    }
    let names: Vec<&str> = sweep::Quantity::names().collect();
    format!(
        "{}: {}. first-platform-frequency jumps between neighbouring points where a mode of the cables is near; \
         platform-frequency is smooth",
        key.about,
        names.join(", ")
    )
}

/// Reads a finite number.
///
/// # Errors
/// A message that says what is wrong with the text.
pub fn number(text: &str) -> Result<f64, String> {
    values::number(text).map_err(|error| error.to_string())
}

/// Reads numbers separated by commas.
fn list(text: &str) -> Result<Vec<f64>, String> {
    text.split(',').map(number).collect()
}

/// Reads a whole number in a range.
fn count(text: &str, range: &RangeInclusive<u64>) -> Result<Value, String> {
    let number = text.trim().parse::<u64>().ok().filter(|count| range.contains(count));
    let (first, last) = (range.start(), range.end());
    let limit = if *last == u64::MAX { format!("from {first} on") } else { format!("from {first} to {last}") };
    number.map(Value::from).ok_or_else(|| format!("`{text}` is not possible: give a whole number {limit}"))
}

/// Reads `6.863,6.565,…`.
fn numbers(text: &str, range: Range) -> Result<Value, String> {
    let values: Result<Vec<f64>, String> = text.split(',').map(|part| range.check(number(part)?)).collect();
    Ok(values?.into())
}

/// Reads `x,y,z`.
///
/// # Errors
/// A text that is not three finite numbers.
pub fn point(text: &str) -> Result<[f64; 3], String> {
    match list(text)?[..] {
        [x, y, z] => Ok([x, y, z]),
        ref other => Err(format!("{} numbers where x,y,z are needed", other.len())),
    }
}

/// Reads `x,y,z` as JSON.
fn vector(text: &str) -> Result<Value, String> {
    Ok(json!(point(text)?))
}

/// Reads `x,y,z` or `x,y,z,roll,pitch,yaw`.
fn pose(text: &str) -> Result<Value, String> {
    match list(text)?[..] {
        [x, y, z] => Ok(json!([x, y, z, 0.0, 0.0, 0.0])),
        [x, y, z, roll, pitch, yaw] => Ok(json!([x, y, z, roll, pitch, yaw])),
        ref other => Err(format!("{} numbers where x,y,z or x,y,z,roll,pitch,yaw are needed", other.len())),
    }
}

/// Reads `xx,yy,zz` or `xx,yy,zz,xy,xz,yz`, the entries of the tensor.
fn tensor(text: &str) -> Result<Value, String> {
    match list(text)?[..] {
        [xx, yy, zz] => Ok(json!([xx, yy, zz, 0.0, 0.0, 0.0])),
        [xx, yy, zz, xy, xz, yz] => Ok(json!([xx, yy, zz, xy, xz, yz])),
        ref other => Err(format!("{} numbers where xx,yy,zz or xx,yy,zz,xy,xz,yz are needed", other.len())),
    }
}

/// Reads the name of an input signal.
fn input(text: &str) -> Result<Value, String> {
    Input::parse(text).map(|input| input.name.into()).map_err(|error| error.to_string())
}

/// Reads the name of an output signal.
fn output(text: &str) -> Result<Value, String> {
    Output::parse(text).map(|output| output.name.into()).map_err(|error| error.to_string())
}

/// Reads a number that is not negative.
fn not_negative(text: &str) -> Result<Value, String> {
    Ok(values::not_negative(number(text)?)?.into())
}

/// Reads a positive number.
fn positive(text: &str) -> Result<Value, String> {
    Ok(values::positive(number(text)?)?.into())
}

/// Reads the name of a quantity of a sweep.
fn quantity(text: &str) -> Result<Value, String> {
    let quantity: sweep::Quantity = text.parse().map_err(|error: sweep::UnknownQuantity| error.to_string())?;
    Ok(quantity.name().into())
}

/// Reads masses in equal steps, `from:to:count`.
fn mass_range(text: &str) -> Result<Value, String> {
    let parts: Vec<&str> = text.split(':').collect();
    let [from, to, count] = parts[..] else {
        return Err("not a range: write from:to:count, as in 10:90:81".to_owned());
    };
    let (from, to) = (values::positive(number(from)?)?, values::positive(number(to)?)?);
    if to <= from {
        return Err(format!("the range ends at {to}, it must end above its start {from}"));
    }
    match count.trim().parse::<usize>() {
        Ok(count @ 2..=MAX_MASSES) => Ok(json!([from, to, count])),
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
            let (from, to) = (number(from)?, number(to)?);
            let max = sweep::MAX_POINTS;
            match count.trim().parse::<usize>() {
                Ok(count) if count <= max => Steps::range(from, to, count),
                _ => Err(format!("`{count}` is not a number of values: give a whole number from 2 to {max}")),
            }
        }
        _ => Err("not a range: write from:to:count, as in -4:4:81, or values, as in 0.5,1,2".to_owned()),
    }
}

/// Axis of a grid or sweep as JSON.
fn axis(name: &str, steps: &Steps) -> Result<Value, String> {
    serde_json::to_value(Axis::new(name.to_owned(), steps)).map_err(|error| error.to_string())
}

/// Reads `x=-4:4:81`.
fn grid_axis(text: &str) -> Result<Value, String> {
    let (name, values) = text.split_once('=').ok_or("it has no `=`: write AXIS=from:to:count, as in x=-4:4:81")?;
    let name = name.trim();
    if !sweep::AXES.contains(&name) {
        return Err(sweep::SweepError::UnknownAxis { axis: name.to_owned() }.to_string());
    }
    axis(name, &steps(values)?)
}

/// Reads `x=-3:3`, or `z=1` for a coordinate that is fixed.
fn side(text: &str) -> Result<Value, String> {
    let (name, values) = text.split_once('=').ok_or("it has no `=`: write AXIS=from:to, as in x=-3:3")?;
    let name = name.trim();
    if !sweep::AXES.contains(&name) {
        return Err(sweep::SweepError::UnknownAxis { axis: name.to_owned() }.to_string());
    }
    let ends: Result<Vec<f64>, String> = values.split(':').map(number).collect();
    match ends?[..] {
        [at] => axis(name, &Steps::List(vec![at])),
        [from, to] => axis(name, &Steps::List(vec![from, to])),
        _ => Err("a side has two ends: write AXIS=from:to, as in x=-3:3".to_owned()),
    }
}

/// Reads `platform.mass_kg=10:90:81`.
fn variation(text: &str) -> Result<Value, String> {
    let form = "it has no `=`: write PATH=from:to:count, as in platform.mass_kg=10:90:81";
    let (path, values) = set_values::split(text).ok_or(form)?;
    let varied = ValueAxis::new(path, steps(values)?)?;
    axis(&varied.path.text, &varied.steps)
}

/// Reads `PATH` or `PATH=MIN:MAX`; each bound may be left out.
fn fit(text: &str) -> Result<Value, String> {
    let Some((path, bounds)) = set_values::split(text) else {
        return Ok(json!({ "path": text.trim() }));
    };
    let (low, high) = bounds.split_once(':').ok_or("the bounds are two numbers, as in platform.mass_kg=10:30")?;
    let bound = |text: &str| if text.trim().is_empty() { Ok(None) } else { number(text).map(Some) };
    let fit =
        FitValue { path: path.trim().to_owned(), minimum: bound(low)?, maximum: bound(high)?, ..FitValue::default() };
    serde_json::to_value(fit).map_err(|error| error.to_string())
}

/// Reads `PATH=±REACH` or `PATH=MIN:MAX`.
fn change(text: &str) -> Result<Value, String> {
    let wrong = "bounds are written as in cables.*.attachment_m=±0.05 or platform.mass_kg=80:120";
    let (path, bounds) = set_values::split(text).ok_or(wrong)?;
    let path = path.trim().to_owned();
    let bounds = bounds.trim();
    let change = if let Some(reach) = bounds.strip_prefix('±').or_else(|| bounds.strip_prefix("+-")) {
        ChangeValue { path, plus_minus: Some(values::positive(number(reach)?)?), ..ChangeValue::default() }
    } else {
        let (low, high) = bounds.split_once(':').ok_or(wrong)?;
        ChangeValue { path, minimum: Some(number(low)?), maximum: Some(number(high)?), ..ChangeValue::default() }
    };
    serde_json::to_value(change).map_err(|error| error.to_string())
}

/// Reads `PATH=VALUE±DEVIATION` or `PATH=±DEVIATION`, a value that is known beforehand.
///
/// # Errors
/// A text without a deviation, or one that is not positive.
pub fn prior(text: &str) -> Result<PriorValue, String> {
    let wrong = "a prior is a value and its deviation, as in platform.mass_kg=20±2";
    let (path, value) = set_values::split(text).ok_or(wrong)?;
    let (value, deviation) = value.split_once('±').or_else(|| value.split_once("+-")).ok_or(wrong)?;
    let prior = if value.trim().is_empty() { None } else { Some(number(value)?) };
    Ok(PriorValue { path: path.trim().to_owned(), prior, prior_std: values::positive(number(deviation)?)? })
}

/// Reads `FROM:TO`.
fn band(text: &str) -> Result<Value, String> {
    let (first, last) = text.split_once(':').ok_or("a band is written as in 2.5:3.2")?;
    Ok(json!([values::positive(number(first)?)?, values::positive(number(last)?)?]))
}

/// Reads `QUANTITY=VALUE`.
fn bound(text: &str) -> Result<Value, String> {
    let (quantity, value) = text.split_once('=').ok_or("a limit is written as in load-factor=1")?;
    let bound = BoundValue { quantity: quantity.trim().to_owned(), value: number(value)? };
    serde_json::to_value(bound).map_err(|error| error.to_string())
}

/// Reads `NAME=X,Y,Z`.
fn named_point(text: &str) -> Result<Value, String> {
    let (name, place) = text.split_once('=').ok_or("a point is written as in hook=0,0,-0.5")?;
    let point = PointValue { name: name.trim().to_owned(), point_m: point(place)? };
    serde_json::to_value(point).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_finite_and_in_range() {
        assert_eq!(number(" -0.5 "), Ok(-0.5));
        for bad in ["", "nan", "inf", "-inf", "1e13", "1,5", "5kg", "1e999"] {
            assert!(number(bad).is_err(), "{bad}");
        }
        assert!(positive("0").is_err() && positive("-1").is_err() && positive("1e-13").is_err());
        assert!(not_negative("0").is_ok() && not_negative("-1e-3").is_err());
    }

    #[test]
    fn poses_have_three_or_six_numbers() {
        assert_eq!(pose("-1,2,3").unwrap(), json!([-1.0, 2.0, 3.0, 0.0, 0.0, 0.0]));
        assert_eq!(pose("1,2,3,4,5,-6").unwrap(), json!([1.0, 2.0, 3.0, 4.0, 5.0, -6.0]));
        assert!(pose("1,2").is_err() && pose("1,2,3,4").is_err() && pose("1,,3").is_err());
    }

    #[test]
    fn a_mass_range_goes_up() {
        assert_eq!(mass_range("10:90:81").unwrap()[2], 81);
        for bad in ["10", "10:90", "90:10:5", "10:90:1", "10:90:x", "0:9:3", "1:2:3:4"] {
            assert!(mass_range(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn bounds_may_be_left_out() {
        assert_eq!(fit("a.b=1:").unwrap(), json!({ "path": "a.b", "minimum": 1.0 }));
        assert_eq!(change("a.*=+-0.5").unwrap(), json!({ "path": "a.*", "plus_minus": 0.5 }));
        assert_eq!(bound("load-factor = 1").unwrap(), json!({ "quantity": "load-factor", "value": 1.0 }));
        assert!(bound("load-factor").is_err() && bound("load-factor=x").is_err());
        assert_eq!(named_point("hook=0,0,-0.5").unwrap(), json!({ "name": "hook", "point_m": [0.0, 0.0, -0.5] }));
        assert!(named_point("0,0,1").is_err() && named_point("hook=0,0").is_err());
        assert_eq!(side("x = -3:3").unwrap(), json!({ "axis": "x", "values": [-3.0, 3.0] }));
        assert_eq!(side("z=1").unwrap(), json!({ "axis": "z", "values": [1.0] }));
        assert!(side("w=0:1").is_err() && side("x").is_err() && side("x=0:1:2").is_err() && side("x=0:nan").is_err());
        assert!(fit("a=3").is_err() && change("a=3").is_err() && band("3").is_err());
    }
}
