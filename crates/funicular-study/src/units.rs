//! Units, which the ends of names tell: `mass_kg`, `speed_m_s`. One table for help texts, columns, figures and Python.

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
static UNITS: [Unit; 37] = [
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
