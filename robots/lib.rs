//! Library of cable-driven parallel robots: texts of robot files, each with its source and its assumptions.
//!
//! ```
//! for (name, text) in funicular_robots::ALL {
//!     assert!(text.contains("source = "), "{name}");
//! }
//! ```

/// CAROCA, large platform: suspended, eight cables.
pub const CAROCA: &str = include_str!("caroca.toml");

/// CoGiRo: suspended, eight cables, 15 m x 11 m x 6 m.
pub const COGIRO: &str = include_str!("cogiro.toml");

/// CoGiRo with its pulleys and winches.
pub const COGIRO_WINCHES: &str = include_str!("cogiro-winches.toml");

/// Lucia of Expo 2015: suspended, eight cables.
pub const EXPO2015_LUCIA: &str = include_str!("expo2015-lucia.toml");

/// Feed cabin of the radio telescope FAST: six cables, 600 m.
pub const FAST: &str = include_str!("fast.toml");

/// GRAB prototype, University of Bologna: two cables over pulleys, measured frequencies.
pub const GRAB_2_CABLES: &str = include_str!("grab-2-cables.toml");

/// GRAB prototype, University of Bologna: three cables over pulleys, measured frequencies.
pub const GRAB_3_CABLES: &str = include_str!("grab-3-cables.toml");

/// GRAB prototype, University of Bologna: four cables over pulleys, measured frequencies.
pub const GRAB_4_CABLES: &str = include_str!("grab-4-cables.toml");

/// `IPAnema` 2: fully constrained, eight cables.
pub const IPANEMA2: &str = include_str!("ipanema2.toml");

/// Planar robot of K. N. Toosi University: horizontal, four cables.
pub const KNTU_PLANAR: &str = include_str!("kntu-planar.toml");

/// NIST `RoboCrane`: inverted Stewart platform, six cables.
pub const NIST_ROBOCRANE: &str = include_str!("nist-robocrane.toml");

/// Point mass in a cube on eight cables, a published SAP2000 model.
pub const SAP2000_8_CABLE_POINT_MASS: &str = include_str!("sap2000-8-cable-point-mass.toml");

/// Camera over a stadium: point mass on four cables; assumed, not published.
pub const STADIUM_CAMERA: &str = include_str!("stadium-camera.toml");

/// Milling machine on a wall: planar, four belts, gravity in the plane; belts and weight of a Maslow 4.
pub const WALL_MACHINE: &str = include_str!("wall-machine.toml");

/// Six cables of 4 mm, the robot of Yuan, Courteille and Deblaise (ICRA 2014).
pub const YUAN2014_4MM: &str = include_str!("yuan2014-4mm.toml");

/// Six cables of 8 mm, the robot of Yuan, Courteille and Deblaise (ICRA 2014).
pub const YUAN2014_8MM: &str = include_str!("yuan2014-8mm.toml");

/// Robot of the dynamic test of Yuan, Courteille and Deblaise (ICRA 2014): cables of 4 mm, identified platform.
pub const YUAN2014_DYNAMIC_TEST: &str = include_str!("yuan2014-dynamic-test.toml");

/// All robots: name of the file without `.toml`, and text of the file.
pub const ALL: [(&str, &str); 17] = [
    ("caroca", CAROCA),
    ("cogiro", COGIRO),
    ("cogiro-winches", COGIRO_WINCHES),
    ("expo2015-lucia", EXPO2015_LUCIA),
    ("fast", FAST),
    ("grab-2-cables", GRAB_2_CABLES),
    ("grab-3-cables", GRAB_3_CABLES),
    ("grab-4-cables", GRAB_4_CABLES),
    ("ipanema2", IPANEMA2),
    ("kntu-planar", KNTU_PLANAR),
    ("nist-robocrane", NIST_ROBOCRANE),
    ("sap2000-8-cable-point-mass", SAP2000_8_CABLE_POINT_MASS),
    ("stadium-camera", STADIUM_CAMERA),
    ("wall-machine", WALL_MACHINE),
    ("yuan2014-4mm", YUAN2014_4MM),
    ("yuan2014-8mm", YUAN2014_8MM),
    ("yuan2014-dynamic-test", YUAN2014_DYNAMIC_TEST),
];

#[cfg(test)]
mod tests {
    use std::path::Path;

    #[test]
    fn the_list_has_every_robot_file_of_the_folder() {
        let mut files: Vec<String> = std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")))
            .unwrap()
            .filter_map(|entry| {
                entry.unwrap().file_name().into_string().unwrap().strip_suffix(".toml").map(str::to_owned)
            })
            .filter(|name| name != "Cargo")
            .collect();
        files.sort();
        let listed: Vec<&str> = super::ALL.iter().map(|(name, _)| *name).collect();
        assert_eq!(files, listed);
    }
}

/// Example of README.md, which is tested like those of the documentation.
#[cfg(doctest)]
#[doc = include_str!("README.md")]
struct Readme;
