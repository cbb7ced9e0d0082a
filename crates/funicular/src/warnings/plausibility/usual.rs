//! Usual ranges of values, each with the values that bracket it: physical numbers, the robots of the library
//! (`robots/`), and the slips that have to lie outside.

/// Young's modulus of a rope [Pa], over the metal, the fibre or the full circle.
///
/// Inside: polyamide rope from 4e8, Expo 2015 1.77e9, polyamide fibre 3e9, polyester 1.2e10, wire rope over its metal
/// 0.6e11 to 1.3e11, Dyneema fibre 1e11, steel 1.96e11, Zylon 2.7e11. Outside: GPa (100), MPa (1e5), and kPa (1e8)
/// given as Pa.
pub(super) const YOUNGS_MODULUS: [f64; 2] = [3e8, 3e11];

/// Diameter of a rope, or of a circle with its area [m]. Library: 0.8 mm (KNTU, metal) to 35 mm (FAST, metal).
/// Outside: millimetres and centimetres given as m, and ropes thinner than a fishing line.
pub(super) const DIAMETER: [f64; 2] = [1e-4, 0.2];

/// Density that mass and cross-section of a rope imply [kg/m³].
///
/// Library: 813 (fibre rope over its full circle, IPAnema 2) to 9929 (mass of a wire rope over its metal alone, NIST
/// `RoboCrane`). Open braids have 500. Outside: kg per 100 m and g/m given as kg/m, the radius of a wire rope given as
/// its diameter (18 000).
pub(super) const DENSITY: [f64; 2] = [500.0, 12e3];

/// Axial stiffness over mass per length, EA/m [m²/s²]: the square of the speed of axial waves.
///
/// Library: 1.4e6 (Expo 2015) to 3.9e7; polyamide rope 1e6, steel 2.5e7, Dyneema fibre 1.2e8, carbon fibre 2e8.
/// Outside: a wire rope (1.2e7) with kg per 100 m (1.2e5), or with kN (1.2e4).
pub(super) const SPECIFIC_STIFFNESS: [f64; 2] = [3e5, 3e8];

/// Share of the full circle between which a rope counts as stranded steel: six- and eight-strand wire ropes fill 0.4 to
/// 0.65 of it with metal, single strands 0.75. Fibre ropes are lighter than 0.2.
pub(super) const STRANDED: [f64; 2] = [0.35, 0.68];

/// Density of steel [kg/m³].
pub(super) const STEEL_DENSITY: f64 = 7850.0;

/// Young's modulus of a stranded wire rope over its metal [Pa].
///
/// Catalogues have 0.5e11 to 1.3e11; single strands, which fill more of the circle, 1.6e11. With `diameter_m` a modulus
/// over the metal (1e11) is taken over the full circle and stands for 1.7e11. Library: up to 4.3e10 (Yuan 2014).
pub(super) const STRANDED_MODULUS: [f64; 2] = [0.0, 1.4e11];

/// Modulus over the metal [Pa] from which on `check` has a remark on the full circle.
pub(super) const STRANDED_MODULUS_OF_NOTE: f64 = 1.1e11;

/// Damping ratio of a rope. Library: 0.003 to 0.01. Outside: per cent given as a fraction (0.3).
pub const DAMPING_RATIO: [f64; 2] = [5e-4, 0.05];

/// Viscous damping over mass per length [1/s]: 6.3 is a damping ratio of one half at 1 Hz. Reference robots: up to
/// 0.33.
pub(super) const VISCOUS_DAMPING: [f64; 2] = [0.0, 6.3];

/// Axial stiffness in vibration over that under a slow load. Of polyester mooring ropes it is much higher (J. Offshore
/// Mech. Arct. Eng. 137(6), 2015, 061401); four times is the most that was met. Outside: the two exchanged, or kN given
/// as N.
pub(super) const STIFFNESS_RATIO: [f64; 2] = [1.0, 6.0];

/// Loss factor of the stretch of a rope. Dampers of high-damping rubber reach 0.3, braided fibre ropes are below.
/// Outside: per cent given as a fraction (0.5), and per cent divided by 100 twice (0.0002).
pub(super) const LOSS_FACTOR: [f64; 2] = [1e-3, 0.3];

/// Damping time of the stretch of a rope [s]: 0.02 is a loss factor of 0.13 at 1 Hz. Braided Dyneema in simulations of
/// kites: 7.7e-4. Outside: milliseconds given as s (0.77), and N s of a complete coefficient EAτ (473).
pub(super) const DAMPING_TIME: [f64; 2] = [0.0, 0.02];

/// Relative difference up to which two dampings of a rope count as one measured decay: two written digits.
pub(super) const SAME_DECAY: f64 = 0.005;

/// Breaking load over axial stiffness, the strain at break of a linear rope. Library: 0.012 (steel, CoGiRo) to 0.14
/// (IPAnema 2). Outside: kN given as N, and kgf of wire rope (0.0012).
pub(super) const STRAIN_AT_BREAK: [f64; 2] = [2e-3, 0.5];

/// Maximum tension over axial stiffness. Library: up to 0.012. Outside: mN given as N, kN for the stiffness.
pub(super) const STRAIN_AT_MAXIMUM: [f64; 2] = [0.0, 0.1];

/// Minimum tension over axial stiffness. Library: up to 0.0012 (FAST). Outside: mN given as N.
pub(super) const STRAIN_AT_MINIMUM: [f64; 2] = [0.0, 0.02];

/// Strain of a cable at equilibrium. Library: up to 0.0024. Steel wire breaks at 0.015 to 0.02, Dyneema at 0.035, and
/// both work well below.
pub(super) const STRAIN: [f64; 2] = [0.0, 0.02];

/// Drag coefficient of a rope: 1.0 to 1.2 for a smooth one, up to 2.5 for a chain.
pub(super) const DRAG_COEFFICIENT: [f64; 2] = [0.2, 3.0];

/// Diameter for the drag of the wind [m]; ice makes it larger than the diameter of the rope.
pub(super) const DRAG_DIAMETER: [f64; 2] = [2e-4, 0.3];

/// Relative difference from a weight up to which a load counts as that weight: g is 9.80665, 9.81 (3.4e-4) or 9.8 m/s²
/// (1.0e-3 from 9.81), and a weight with three digits, as 588 N, is rounded by 8e-4 in the middle of its decade.
pub(super) const WEIGHT_DIGITS: f64 = 2e-3;

/// Upward load per length over the buoyancy of the rope's volume in sea water. Sheaths and hollow ropes displace up to
/// twice the volume. Outside: ice and other weights with a wrong sign, on ropes that do not float.
pub(super) const BUOYANCY: [f64; 2] = [0.0, 2.0];

/// Load per length besides the weight, over the weight of the rope: ice and supply lines weigh up to some ten ropes.
pub(super) const CABLE_LOAD: [f64; 2] = [0.0, 100.0];

/// Maximum distance of an anchor from the mean of all [m]. Library: up to 300 (FAST). Outside: millimetres, for robots
/// of more than 1 m.
pub(super) const ANCHORS: [f64; 2] = [0.0, 1000.0];

/// Size of the attachments over that of the anchors, each the maximum distance from the mean. Library: 0.020 (Yuan
/// 2014) to 0.25 (NIST `RoboCrane`). Outside: swapped ends, attachments in mm or cm, anchors in mm or cm.
pub(super) const ATTACHMENTS_OVER_ANCHORS: [f64; 2] = [2e-3, 1.5];

/// Size of the attachments over that of the anchors from which on the anchors may be one hook, from which slings lead
/// to a platform. Then the attachments are compared with the distance of the anchors instead.
pub(super) const SLINGS: f64 = 50.0;

/// Distance of the platform from the mean of the anchors, and length of a cable, over the size of anchors and
/// attachments. Library: up to 1.3; hoists with ropes side by side have 20. Outside: millimetres given as m.
pub(super) const DISTANCE: [f64; 2] = [0.0, 30.0];

/// Distance of one attachment from the mean of the others, over the size of the others. Library: 1.00 to 1.18
/// (CoGiRo). A long arm has 20. Outside: one attachment in mm or cm.
pub(super) const ATTACHMENT_OVER_OTHERS: [f64; 2] = [0.0, 50.0];

/// Distance of one anchor from the mean of the others, over the size of the others. Library: 1.00 to 1.24
/// (KNTU). A tag line beside a crane has 100. Outside: one anchor in mm.
pub(super) const ANCHOR_OVER_OTHERS: [f64; 2] = [0.0, 300.0];

/// Distance of one attachment from the mean of the others over their size, from which on its ends may be swapped.
pub(super) const SWAPPED_ATTACHMENT: f64 = 4.0;

/// Twice the longest cable and the size of the attachments, over the size of the anchors. Shorter cables cannot reach a
/// platform from anchors on both sides. Library: from 1.9.
pub(super) const MIN_LENGTH: [f64; 2] = [0.5, f64::INFINITY];

/// Density of the platform in the ball around its attachments [kg/m³]. Library: 12 (IPAnema 2) to 1850 (CAROCA); Yuan
/// 2014 has 6800 with its heaviest load. Outside: mass in t or g.
pub(super) const PLATFORM_DENSITY: [f64; 2] = [0.1, 2e4];

/// Largest radius of gyration of the platform over the size of its attachments. Library: 0.41 to 1.44 (CAROCA); loads
/// on a hook have 2. Outside: an inertia wrong by a thousand (a factor of 32), in kg mm² or kg cm², a mass in g or t.
pub(super) const GYRATION: [f64; 2] = [0.1, 3.0];

/// Distance of the centre of mass, or of the point of a force, from the mean of the attachments over their size.
/// Library: up to 0.27; loads far below their hook have some. Outside: mm and cm.
pub(super) const OFFSET: [f64; 2] = [0.0, 10.0];

/// Viscous damping of the platform over its mass or inertia [1/s]: 100 is a damping ratio of one half at 16 Hz. Below
/// the minimum the damping ratio is less than 1e-5 at 1 Hz. Outside: damping ratios given as N s/m.
pub(super) const PLATFORM_DAMPING: [f64; 2] = [1e-4, 100.0];

/// Magnitude of gravity [m/s²], if there is any: Moon 1.62, Earth 9.81. Outside: 1 (in units of g), 32.2 (ft/s²), 981
/// and 9810.
pub(super) const GRAVITY: [f64; 2] = [1.5, 12.0];

/// Weight over the sum of the axial stiffnesses: strain of cables that all pull straight up. Library: 1.7e-5 to 5.9e-4.
/// Outside: mass in g, axial stiffness in kN.
pub(super) const WEIGHT_OVER_STIFFNESS: [f64; 2] = [0.0, 0.01];

/// Mass of all cables over that of the platform. Library: 0.005 to 0.9. Outside: kg per 100 m, g/m, platform in t.
pub(super) const CABLES_OVER_PLATFORM: [f64; 2] = [0.0, 5.0];

/// Sum of all maximum tensions over the load: less cannot carry it. Library: from 4.5.
pub(super) const MAXIMA_OVER_LOAD: [f64; 2] = [1.0, f64::INFINITY];

/// Minimum tension over the load. Library: from 0.1; the default is at least 1e-3. Outside: kN given as N.
pub(super) const MINIMUM_OVER_LOAD: [f64; 2] = [2.5e-4, f64::INFINITY];

/// Minimum tension up to which it only means that no cable is slack [N]: CASPR's models have 0.001.
pub(super) const NOT_SLACK: f64 = 0.01;

/// Force on the platform over its weight.
pub(super) const LOAD_OVER_WEIGHT: [f64; 2] = [0.0, 100.0];

/// Moment on the platform over its weight and the size of its attachments: 10 is ten times the weight at the outermost
/// attachment. Outside: N mm, for moments that matter (a hundredth of this product).
pub(super) const MOMENT_OVER_WEIGHT: [f64; 2] = [0.0, 10.0];

/// Drag coefficient times area of the platform, over the disc of its attachments.
pub(super) const DRAG_AREA: [f64; 2] = [0.0, 50.0];

/// Wind [m/s]: a hurricane of category 4 has 60. Outside: km/h of a storm.
pub(super) const WIND: [f64; 2] = [0.0, 60.0];

/// Density of air [kg/m³], from 6000 m above the sea to deep frost. Outside: g/cm³ (0.0012).
pub(super) const AIR_DENSITY: [f64; 2] = [0.5, 2.0];

/// Density of water [kg/m³], for robots in water.
pub(super) const WATER_DENSITY: [f64; 2] = [900.0, 1100.0];

/// Roll, pitch or yaw of a pose [degrees]. A full turn in either direction holds every orientation however it is
/// counted. Inside: headings from 0° to 360°, angles from -180° to 180°; the library has no angles. Outside: degrees
/// multiplied by 57.3 as if they were radians, from 6.3° on.
pub(super) const ANGLE: [f64; 2] = [-360.0, 360.0];

/// Unstrained length of a cable over the distance of its ends. Library: up to 1.011 (Yuan 2014, 8 mm). A cable that
/// hangs down by half the distance of its ends has 1.5. Outside: poses at which a straight cable would have to push,
/// and one length in other units.
pub(super) const LENGTH_OVER_CHORD: [f64; 2] = [0.0, 2.0];

/// Weight of all cables over the sum of their tensions. Library: up to 0.34. Outside: kg per 100 m, g/m.
pub(super) const WEIGHT_OVER_TENSION: [f64; 2] = [0.0, 1.0];

/// Radius of a pulley [m]. Library: 0.02 (GRAB) to 0.06; shaft sheaves of mines have 3 m. Outside: millimetres given as
/// m.
pub(super) const PULLEY_RADIUS: [f64; 2] = [2e-3, 4.0];

/// Radius of a pulley or drum over the diameter of the rope. Wire ropes run over 8 to 30, a mine's over 60; a fishing
/// line of 0.3 mm over a wheel of 20 mm has 67. Library: 15 (`CoGiRo`). Outside: centimetres given as m.
pub(super) const RADIUS_OVER_ROPE: [f64; 2] = [0.0, 300.0];

/// Radius of a pulley or drum over the longest cable. Library: 0.003 (`CoGiRo`) to 0.02 (GRAB); a mine has 0.01, a
/// robot on a desk 0.08. Outside: 20 mm given in cm on a robot of 10 m.
pub(super) const RADIUS_OVER_CABLE: [f64; 2] = [0.0, 0.15];

/// Inertia of a pulley's wheel over that of a steel disc of its radius that is as thick as the radius. A plastic wheel
/// has 0.005, one of steel 0.05 to 0.3. Outside: g m² given as kg m² (5 and more).
pub(super) const WHEEL_OVER_DISC: [f64; 2] = [1e-5, 5.0];

/// Inertia of a drum with all that turns with it, or of a swivel with its bracket, over that of the same disc. The
/// motors of `CoGiRo`, seen at the drum, have 16. Outside: kg cm² given as kg m².
pub(super) const DRUM_OVER_DISC: [f64; 2] = [1e-5, 200.0];

/// Efficiency of a wheel that turns. Plain bearings have 0.9. Outside: the loss of 0.04 given as efficiency.
pub(super) const EFFICIENCY: [f64; 2] = [0.5, 1.0];

/// Moment of inertia of a wheel or of a swivel over the square of the radius [kg]: for a disc half its mass. Outside:
/// kg cm² given as kg m² (a wheel of 5 kg has 2.5e4), and centimetres for the radius of a wheel of 1 kg.
pub(super) const WHEEL_MASS: [f64; 2] = [1e-4, 1e3];

/// Mass of a guide wheel at the cable over that of the platform. docs/pulleys: 0.008. Outside: kg cm² given as kg m²
/// (75).
pub(super) const WHEEL_OVER_PLATFORM: [f64; 2] = [0.0, 2.0];

/// Length of the cable from the drum to its anchor [m]. Outside: millimetres given as m.
pub(super) const DRUM_SIDE: [f64; 2] = [0.0, 300.0];

/// Length of the cable from the drum to its anchor over the longest cable. Library: 0.4 (`CoGiRo`); winches at the wall
/// of a hall, for a robot on a table, have 10. Outside: centimetres given as m.
pub(super) const DRUM_SIDE_OVER_CABLE: [f64; 2] = [0.0, 20.0];

/// Turns of the motor per turn of the drum. Harmonic gears have 160, two stages of worms more. Outside: the inverse of
/// ratios from 2 on.
pub(super) const GEAR_RATIO: [f64; 2] = [0.5, 2e3];

/// Moment of inertia of a motor about its own axis [kg m²]. Hobby motors have 1e-7, servo motors of 100 kW 0.5.
/// Outside: kg cm² given as kg m², from motors of 1 kW on.
pub(super) const MOTOR_INERTIA: [f64; 2] = [0.0, 1.0];

/// Inertia of drum and motor over the square of the radius of the drum [kg]. Library: 59 (`CoGiRo`). Outside: kg cm²
/// given as kg m² (5.9e5), and millimetres for the radius (5.9e-5).
pub(super) const WINCH_MASS: [f64; 2] = [1e-3, 1e5];

/// Mass of drum and motor at the cable over that of the platform. Library: 0.65 (`CoGiRo`); small motors behind gears
/// of 1:200 have 20. Outside: g m² (650) and kg cm² (6500) given as kg m².
pub(super) const WINCH_OVER_PLATFORM: [f64; 2] = [0.0, 100.0];

/// Viscous damping of a winch over the mass of drum and motor at the cable [1/s]. A motor stops within some
/// milliseconds at the fastest. Outside: N mm s given as N m s.
pub(super) const WINCH_DAMPING: [f64; 2] = [0.0, 1e3];

/// Stiffness of a winch at the cable [N/m]: a millimetre of steel rope of 25 mm has 4e10. Outside: N mm/rad given as
/// N m/rad, for stiff shafts.
pub(super) const WINCH_STIFFNESS: [f64; 2] = [0.0, 1e9];

/// Length of cable with the stiffness of the winch [m], EA over its stiffness. Shafts and gears stretch as much as some
/// metres of cable. Outside: kN/m given as N/m.
pub(super) const LENGTH_OF_WINCH: [f64; 2] = [0.0, 1e3];

/// Stretch of a winch over that of the longest cable. docs/pulleys: 0.5. Outside: kN/m given as N/m, for winches that
/// stretch more than a fiftieth of the cable.
pub(super) const WINCH_OVER_CABLE: [f64; 2] = [0.0, 20.0];

/// Stretch of a winch under the weight of the platform over the longest cable. docs/pulleys: 2e-4. Outside: kN/m given
/// as N/m, from 3e-5 on.
pub(super) const WINCH_YIELD: [f64; 2] = [0.0, 0.03];

/// Bandwidth of a position control [Hz]. Outside: gains in N mm given as N m (31 times).
pub(super) const BANDWIDTH: [f64; 2] = [0.05, 300.0];

/// Damping ratio of a position control. Outside: per cent given as a fraction (70).
pub(super) const CONTROL_DAMPING: [f64; 2] = [0.0, 10.0];

/// Delay of a position control [s]. Outside: milliseconds given as seconds.
pub(super) const DELAY: [f64; 2] = [0.0, 0.2];

/// Efficiency of a gear. Worms of high ratio have 0.4, planets 0.9. Outside: the loss of 0.1 given as efficiency.
pub const GEAR_EFFICIENCY: [f64; 2] = [0.25, 1.0];

/// Largest speed of a cable [m/s]. The panels of a telescope move at 0.01, camera robots at 13. Outside: mm/s given as
/// m/s, from 50 mm/s on.
pub const CABLE_SPEED: [f64; 2] = [1e-4, 50.0];

/// Largest acceleration of a cable [m/s²]. FALCON has 430. Outside: mm/s² given as m/s², from 2 m/s² on.
pub const CABLE_ACCELERATION: [f64; 2] = [1e-4, 2e3];

/// Force at the cable of the largest torque of a motor, without losses, over the weight of the platform. Motors of 112
/// N m would have 5.6 at `CoGiRo`. Outside: N mm given as N m (5600), kN m (0.006).
pub const MOTOR_OVER_WEIGHT: [f64; 2] = [0.02, 1e3];

/// Speed at which the largest power of a motor lifts the weight of the platform [m/s]. Motors of 5 kW would have 5.6 at
/// `CoGiRo`, those of the telescope FAST 0.8. Outside: kW given as W (0.006 for `CoGiRo`).
pub const POWER_OVER_WEIGHT: [f64; 2] = [0.01, 1e3];

/// Highest speed of a motor [rad/s]: servo motors have 300 to 600, small ones 2000. Outside: turns per minute given as
/// rad/s, from 3000 on.
pub const MOTOR_SPEED: [f64; 2] = [0.1, 2900.0];

/// Displacement of a flexible support under the weight of the platform, over the size of the anchors. A post of 1e5 N/m
/// under 30 kg, 5 m from the middle, has 6e-4; masts of 1e4 N/m under 100 kg 0.02. Outside: N/mm given as N/m (0.6 for
/// that post).
pub(super) const SUPPORT_YIELD: [f64; 2] = [0.0, 0.05];

/// Smallest principal stiffness of a flexible support over the axial stiffness of its stiffest cable, EA over the
/// length. docs/pulleys: 6; masts of 1e4 N/m with ropes of 6 mm 0.07. Outside: N/mm given as N/m (0.006).
pub(super) const SUPPORT_OVER_CABLE: [f64; 2] = [0.02, f64::INFINITY];

/// Damping ratio of a support: structures have 0.005 to 0.05. Outside: per cent given as a fraction (0.5).
pub(super) const SUPPORT_DAMPING: [f64; 2] = [0.0, 0.2];

/// Largest horizontal distance between two anchors of one support, over that of all anchors or the longest cable.
/// Pulleys on one post have some hundredths, those on a beam at one side of a hall 0.5. Outside: all posts of a robot
/// in one table (1).
pub(super) const SUPPORT_EXTENT: [f64; 2] = [0.0, 0.6];

/// Smallest principal stiffness of a flexible support [N/m]. The axial stiffness of a steel post of 100 cm² and 1 m is
/// 2e9.
pub(super) const SUPPORT_STIFFNESS: [f64; 2] = [0.0, 1e10];

/// Mass of a flexible support over that of the platform. Towers of a telescope weigh some ten cabins. Outside: g given
/// as kg.
pub(super) const SUPPORT_MASS: [f64; 2] = [0.0, 300.0];

/// Displacement of a flexible support at an equilibrium over the longest cable: a tenth is no small displacement, for
/// which a stiffness could be given. Outside: N/mm given as N/m, for supports that yield by more than a ten-thousandth.
pub(super) const SUPPORT_DISPLACEMENT: [f64; 2] = [0.0, 0.1];
