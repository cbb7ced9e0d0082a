//! Units, which the ends of names tell: `mass_kg`, `speed_m_s`. One table for help texts, columns, figures and Python.
//! A second one has the units that tables may have instead.

use serde_json::{Map, Value};

/// Unit of the numbers whose names end with it.
#[derive(Debug, PartialEq, Eq)]
pub struct Unit {
    /// End of the names, without the `_` before it.
    pub ending: &'static str,
    /// Text in tables and files.
    pub text: &'static str,
    /// Form of a number in help texts.
    pub form: &'static str,
}

const fn unit(ending: &'static str, text: &'static str, form: &'static str) -> Unit {
    Unit { ending, text, form }
}

/// All units of names.
static UNITS: [Unit; 38] = [
    unit("m", "m", "M"),
    unit("mm", "mm", "MM"),
    unit("m2", "m²", "M²"),
    unit("m3", "m³", "M³"),
    unit("s", "s", "S"),
    unit("m_s", "m/s", "M/S"),
    unit("m_s2", "m/s²", "M/S²"),
    unit("m_s3", "m/s³", "M/S³"),
    unit("rad", "rad", "RAD"),
    unit("rad_s", "rad/s", "RAD/S"),
    unit("rad_s2", "rad/s²", "RAD/S²"),
    unit("rad_s3", "rad/s³", "RAD/S³"),
    unit("m_per_rad", "m/rad", "M/RAD"),
    unit("deg", "deg", "DEG"),
    unit("hz", "Hz", "HZ"),
    unit("per_s", "1/s", "1/S"),
    unit("per_m", "1/m", "1/M"),
    unit("per_rad", "1/rad", "1/RAD"),
    unit("kg", "kg", "KG"),
    unit("per_kg", "1/kg", "1/KG"),
    unit("kg_m", "kg m", "KG·M"),
    unit("kg_per_m", "kg/m", "KG/M"),
    unit("kg_m2", "kg m²", "KG·M²"),
    unit("kg_m3", "kg/m³", "KG/M³"),
    unit("n", "N", "N"),
    unit("n_m", "N m", "N·M"),
    unit("n_per_m", "N/m", "N/M"),
    unit("n_per_rad", "N/rad", "N/RAD"),
    unit("n_m_per_rad", "N m/rad", "N·M/RAD"),
    unit("n_s_m", "N s/m", "N·S/M"),
    unit("n_s_m2", "N s/m²", "N·S/M²"),
    unit("n_m_s", "N m s", "N·M·S"),
    unit("n_m_s_per_rad", "N m s/rad", "N·M·S/RAD"),
    unit("pa", "Pa", "PA"),
    unit("w", "W", "W"),
    unit("j", "J", "J"),
    unit("db", "dB", "DB"),
    unit("percent", "%", "PERCENT"),
];

/// Unit of the columns of a table that is read, which becomes one of [`UNITS`].
struct OtherUnit {
    /// End of the names, without the `_` before it.
    ending: &'static str,
    /// Ending of the unit that the column gets.
    becomes: &'static str,
    /// Size in that unit.
    size: f64,
}

const fn other(ending: &'static str, becomes: &'static str, size: f64) -> OtherUnit {
    OtherUnit { ending, becomes, size }
}

/// Inch [m], foot [m], pound [kg] and pound-force [N]: exact by definition (NIST SP 811, appendix B).
const INCH: f64 = 0.0254;
const FOOT: f64 = 0.3048;
const POUND: f64 = 0.453_592_37;
const POUND_FORCE: f64 = POUND * 9.806_65;

/// Units that the columns of tables may have beside those of the program.
static OTHER_UNITS: [OtherUnit; 22] = [
    other("mm", "m", 1e-3),
    other("cm", "m", 1e-2),
    other("in", "m", INCH),
    other("ft", "m", FOOT),
    other("mm_s", "m_s", 1e-3),
    other("mm_min", "m_s", 1e-3 / 60.0),
    other("m_min", "m_s", 1.0 / 60.0),
    other("in_s", "m_s", INCH),
    other("in_min", "m_s", INCH / 60.0),
    other("ft_s", "m_s", FOOT),
    other("ft_min", "m_s", FOOT / 60.0),
    other("in_s2", "m_s2", INCH),
    other("ft_s2", "m_s2", FOOT),
    other("ms", "s", 1e-3),
    other("ns", "s", 1e-9),
    other("lb", "kg", POUND),
    other("lbf", "n", POUND_FORCE),
    other("kn", "n", 1e3),
    other("lbf_ft", "n_m", POUND_FORCE * FOOT),
    other("lbf_in", "n_m", POUND_FORCE * INCH),
    other("kw", "w", 1e3),
    // Mechanical horsepower: 550 ft·lbf/s.
    other("hp", "w", 550.0 * FOOT * POUND_FORCE),
];

/// Size [m] of a unit of lengths by the end of names: `in`, `ft`, `mm`; 1 for metres.
pub fn metres(ending: &str) -> Option<f64> {
    let of = OTHER_UNITS.iter().find(|unit| unit.ending == ending && unit.becomes == "m");
    if ending == "m" { Some(1.0) } else { of.map(|unit| unit.size) }
}

/// Name of a column as the program knows it, and the factor that its numbers get: `length_a_in`, or `length_a [in]`, is
/// `length_a_m` with 0.0254. A column that has a unit of the program, or none, stays as it is.
///
/// # Example
/// ```
/// let (name, factor) = funicular_study::units::column("length_bl_in");
/// assert_eq!((name.as_str(), factor), ("length_bl_m", 0.0254));
/// ```
pub fn column(written: &str) -> (String, f64) {
    let name = with_ending(written);
    let ends = |ending: &str| name.strip_suffix(ending)?.strip_suffix('_').filter(|stem| !stem.ends_with("_per"));
    let longest = of_name(&name).map_or(0, |unit| unit.ending.len());
    // Millimetres are a unit of results too, hence equal lengths.
    let found = OTHER_UNITS.iter().filter(|unit| unit.ending.len() >= longest);
    let found = found.filter_map(|unit| Some((ends(unit.ending)?, unit))).max_by_key(|(_, unit)| unit.ending.len());
    match found {
        Some((stem, unit)) => (format!("{stem}_{}", unit.becomes), unit.size),
        None => (name, 1.0),
    }
}

/// Name with the unit that stands in brackets behind it as its end: `speed [ft/s]` is `speed_ft_s`.
fn with_ending(written: &str) -> String {
    let bracketed = |[open, close]: [char; 2]| {
        let (stem, unit) = written.trim_end().strip_suffix(close)?.rsplit_once(open)?;
        let unit = unit.trim().to_lowercase().replace('/', "_").replace('²', "2").replace([' ', '·'], "_");
        let is_known =
            UNITS.iter().any(|known| known.ending == unit) || OTHER_UNITS.iter().any(|known| known.ending == unit);
        is_known.then(|| format!("{}_{unit}", stem.trim_end()))
    };
    bracketed(['[', ']']).or_else(|| bracketed(['(', ')'])).unwrap_or_else(|| written.to_owned())
}

/// Columns with units of the program, by [`column`].
///
/// # Errors
/// Two columns that are the same number in two units.
pub(crate) fn convert_columns(columns: &mut Map<String, Value>) -> Result<(), String> {
    let others: Vec<String> = columns.keys().filter(|name| column(name).0 != **name).cloned().collect();
    for written in others {
        let (name, factor) = column(&written);
        if columns.contains_key(&name) {
            return Err(format!("there are columns `{name}` and `{written}`: keep one of them"));
        }
        let Some(mut values) = columns.remove(&written) else { continue };
        let convert = |value: &mut Value| {
            if let Some(number) = value.as_f64() {
                *value = (number * factor).into();
            }
        };
        match &mut values {
            Value::Array(values) => values.iter_mut().for_each(convert),
            value => convert(value),
        }
        columns.insert(name, values);
    }
    Ok(())
}

/// Unit that the end of a name tells; `None` for a name without one.
pub fn of_name(name: &str) -> Option<&'static Unit> {
    let ends = |unit: &&Unit| name.strip_suffix(unit.ending).is_some_and(|stem| stem.ends_with('_'));
    UNITS.iter().filter(ends).max_by_key(|unit| unit.ending.len())
}

/// Name without the unit at its end.
pub fn without_unit(name: &str) -> &str {
    let stem = of_name(name).and_then(|unit| name.strip_suffix(unit.ending)?.strip_suffix('_'));
    stem.unwrap_or(name)
}

/// Unit of a column as a table for reading shows it: nothing for a pure number, ° for degrees.
pub(crate) fn shown(text: &str) -> &str {
    match text {
        "1" => "",
        "deg" => "°",
        text => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use funicular::robot::spec::TABLES;

    #[test]
    fn the_longest_ending_is_the_unit() {
        for (name, text) in [
            ("duration_s", "s"),
            ("speed_m_s", "m/s"),
            ("mass_kg_per_m", "kg/m"),
            ("stiffness_n_m_per_rad", "N m/rad"),
            ("tension_n", "N"),
        ] {
            assert_eq!(of_name(name).map(|unit| unit.text), Some(text), "{name}");
        }
        assert_eq!((of_name("columns"), of_name("n")), (None, None));
        assert_eq!(without_unit("speed_max_in_m_s"), "speed_max_in");
        assert_eq!(without_unit("damping_ratio"), "damping_ratio");
    }

    #[test]
    fn columns_in_other_units_get_those_of_the_program() {
        for (written, name, factor) in [
            ("length_bl_in", "length_bl_m", 0.0254),
            ("x_ft", "x_m", 0.3048),
            ("x [in]", "x_m", 0.0254),
            ("speed (ft/min)", "speed_m_s", 0.3048 / 60.0),
            ("t [s]", "t_s", 1.0),
            ("torque_lbf_ft", "torque_n_m", 1.355_817_948_331_400_4),
            ("power_hp", "power_w", 745.699_871_582_270_2),
        ] {
            let (found, by) = column(written);
            assert_eq!(found, name);
            assert!((by / factor - 1.0).abs() < 1e-15, "{written}: {by}");
        }
        // Neither a unit of the program nor a reciprocal nor a word is another unit.
        for stays in ["speed_m_s", "stiffness_n_per_mm", "in", "plan", "x_inch", "length_in_m", "note (left)"] {
            assert_eq!(column(stays), (stays.to_owned(), 1.0));
        }
        assert!(UNITS.iter().all(|unit| unit.ending == "mm" || OTHER_UNITS.iter().all(|o| o.ending != unit.ending)));
        assert!(OTHER_UNITS.iter().all(|other| UNITS.iter().any(|unit| unit.ending == other.becomes)));
    }

    #[test]
    fn a_number_in_two_units_is_refused() {
        let of = |value: Value| {
            let Value::Object(mut columns) = value else { unreachable!() };
            convert_columns(&mut columns).map(|()| Value::Object(columns))
        };
        let found = of(serde_json::json!({ "length_a_in": [100.0, null], "t_s": [1.0, 2.0] })).unwrap();
        assert_eq!(found, serde_json::json!({ "length_a_m": [2.54, null], "t_s": [1.0, 2.0] }));
        let refused = of(serde_json::json!({ "length_a_in": [1.0], "length_a_m": [1.0] })).unwrap_err();
        assert!(refused.contains("`length_a_m` and `length_a_in`"), "{refused}");
    }

    /// The table of keys of the robot file has its own units: they are those of the names.
    #[test]
    fn keys_of_the_robot_file_have_the_units_of_their_names() {
        let keys = TABLES.iter().flat_map(|table| table.keys);
        let numbers = keys.filter_map(|key| Some((key.name, key.each_number()?.unit)));
        // The table writes degrees out.
        let same = |own: &str, text: &str| own == text || (own, text) == ("deg", "degrees");
        let differ = |(name, text): &(&str, &str)| of_name(name).is_some_and(|unit| !same(unit.text, text));
        assert_eq!(numbers.filter(differ).collect::<Vec<_>>(), []);
    }
}
