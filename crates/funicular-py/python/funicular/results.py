"""Results of every command: dictionaries with the keys of the program's JSON, which are attributes as well.

`found["rows"]` and `found.rows` are the same. An attribute is None if the results do not have the key. Lists of numbers are
arrays; lists of different lengths, and empty ones, stay lists. The keys `values` and `from` are read as
`found["values"]`: a dictionary has a method of this name, and Python a word.

Made by scripts/python_results.py from the declarations of the commands.
"""

from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from funicular._results import OF_COMMANDS, Results, Row


class Axes(Row):
    """Unit vectors of a cable, world axes: along the chord, normal to it in plane, out of plane."""

    b: NDArray[np.float64]
    """Out of plane."""
    e: NDArray[np.float64]
    """Along the chord."""
    n: NDArray[np.float64]
    """Normal to the chord, in plane and up."""


class Local(Row):
    """Stiffness along the chord, coupling, normal in plane and out of plane [N/m]."""

    k_a: NDArray[np.complex128]
    """Complex numbers over frequency."""
    k_b: NDArray[np.complex128]
    """Complex numbers over frequency."""
    k_c: NDArray[np.complex128]
    """Complex numbers over frequency."""
    k_o: NDArray[np.complex128]
    """Complex numbers over frequency."""


class HalvingRow(Row):
    """Further readings that halve the largest standard deviation."""

    poses: int
    """Number of further poses with readings of all cables."""
    positions_m: NDArray[np.float64]
    """Their positions, in the order in which they help most [m]."""
    worst_m: float
    """Largest standard deviation of the position then [m]."""


class LeftOut(Row):
    """Candidates that were left out."""

    by_clearance: int
    """Candidates with cables, platform or obstacles too near to each other."""
    by_tensions: int
    """Candidates without equilibrium or without tensions within the limits."""
    candidates: int
    """Candidates that were given."""


class ToolRow(Row):
    """Standard deviations of the platform at a pose."""

    covariance_m2: NDArray[np.float64]
    """Covariance of the position [m²]."""
    deviation_m: float
    """Standard deviation of the position along the direction in which it is largest [m]."""
    deviations_deg: NDArray[np.float64] | None
    """Standard deviations of roll, pitch and yaw; absent for cables that end in one point [deg]."""
    direction: NDArray[np.float64]
    """Direction of the largest deviation."""
    position_m: NDArray[np.float64]
    """Position of the platform origin [m]."""
    roll_pitch_yaw_deg: NDArray[np.float64]
    """Roll, pitch, yaw of the platform [deg]."""
    within_95_m: float
    """Half width of the interval that holds the position along this direction with 95 % [m]."""


class ToolAccuracy(Row):
    """Accuracy of the tool: standard deviations of the platform when the readings of the calibrated values are
    commanded."""

    best_m: float
    """Least standard deviation of the position [m]."""
    halving: HalvingRow | None
    """Further readings that halve the largest standard deviation; absent if no number of poses up to 60 does."""
    left_out: LeftOut | None
    """Poses that the robot cannot have."""
    poses: list[ToolRow]
    """Poses."""
    worst_m: float
    """Largest standard deviation of the position [m]."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "halving": HalvingRow,
        "left_out": LeftOut,
        "poses": ToolRow,
    }


class AnchorRow(Row):
    """Anchor after a calibration."""

    cable: str
    """Cable."""
    covariance_m2: NDArray[np.float64] | None
    """Covariance of the coordinates with inner conditions; zero along a known coordinate, absent without deviations [m²]."""
    position_m: NDArray[np.float64]
    """Position [m]."""
    start_m: NDArray[np.float64]
    """Point of the robot file [m]."""
    weakest_m: NDArray[np.float64] | None
    """One deviation along the weakest combination [m]."""


class CovarianceRow(Row):
    """Entry of the covariance of calibrated numbers."""

    covariance: float
    """covariance, in the product of their units."""
    first: str
    """path of the first number in the robot file."""
    second: str
    """path of the second number; that of the first for its variance."""


class DistanceRow(Row):
    """Distance between two anchors, which no frame changes."""

    deviation_m: float | None
    """Standard deviation of the distance [m]."""
    distance_m: float
    """Distance [m]."""
    first: str
    """Cable of one anchor."""
    second: str
    """Cable of the other anchor."""


class MinimumRow(Row):
    """Further minimum that fits."""

    chi2: float
    """Chi2."""
    farthest_m: float
    """Largest difference of an anchor, attachment or offset from the best minimum [m]."""
    mirrored: list[str] | None
    """Cables whose anchors stand on the other side of the plane or line of their rows; empty for another kind of minimum."""
    row: int
    """Rows whose poses differ most, from 1."""


class ProposalRow(Row):
    """Pose to measure next."""

    deviations: NDArray[np.float64]
    """Deviations of all values then, in their order."""
    largest_m: float | None
    """Largest deviation of a value then [m].

    Largest deviation of a length then; absent if factors alone are chosen."""
    largest_of: str
    """Value with the largest deviation.

    Value that has it, or the factor with the largest deviation."""
    number: int
    """Number of proposed poses up to this one."""
    position_m: NDArray[np.float64]
    """Position of the platform origin [m]."""
    readings_m: NDArray[np.float64]
    """Readings at the pose with the calibrated values, one per cable [m]."""
    roll_pitch_yaw_deg: NDArray[np.float64]
    """Roll, pitch, yaw of the platform [deg]."""
    tension_rule: str | None
    """Rule of the tensions at the pose, if they are a matter of choice."""
    tool_m: float | None
    """Largest deviation of the position of the platform then, over the poses of its accuracy [m]."""
    total_m: float | None
    """Root of the sum of the variances of the chosen values then [m].

    Root of the sum of the variances of the chosen lengths after this pose and those before it; absent if factors alone
    are chosen."""


class CableResidual(Row):
    """Residual of a reading, computed less measured."""

    cable: str
    """Cable."""
    residual_m: float
    """Residual [m]."""


class ReadingRow(Row):
    """One row of readings after the fit."""

    chi2_drop: float | None
    """Decrease of χ² if the row is left out.

    In the variance of the residuals; absent for a row that no other row checks."""
    chi2_limit: float
    """Largest decrease that noise gives with 95 %.

    Largest decrease that noise gives in one of as many rows with 95 %."""
    outlier: bool
    """True if the decrease is beyond its limit."""
    position_m: NDArray[np.float64]
    """Position of the platform origin [m]."""
    residuals: list[CableResidual]
    """Residuals of the cables that were read."""
    roll_pitch_yaw_deg: NDArray[np.float64]
    """Roll, pitch, yaw of the platform [deg]."""
    row: int
    """Number of the row, from 1."""
    shift_m: float | None
    """Largest change of a value if the row is left out [m]."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "residuals": CableResidual,
    }


class ProfilePoint(Row):
    """Point of a profile."""

    chi2_rise: float
    """Rise of χ² over its minimum, divided by the square of the factor of the deviations."""
    value: float
    """Value that is held."""


class Profile(Row):
    """Profile of one value."""

    falls: bool
    """True if a fit has a smaller χ² than the minimum: the search has missed it."""
    fits: int
    """Fits that were made."""
    open_above: str | None
    """Reason why there is no upper end."""
    open_below: str | None
    """Reason why there is no lower end."""
    points: list[ProfilePoint]
    """Points, ascending, with the minimum."""
    to: float | None
    """Upper end."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "points": ProfilePoint,
    }


class CalibratedValue(Row):
    """Calibrated value."""

    deviation: float | None
    """Standard deviation in the frame.

    Absent for a value that the readings do not determine or the frame holds."""
    held: bool
    """True if the frame holds the value."""
    inner_deviation: float | None
    """Standard deviation with inner conditions.

    No choice of the frame enlarges it."""
    interval_95: NDArray[np.float64] | None
    """Interval that holds the value with 95 %; absent as well where χ² is no parabola."""
    path: str
    """Path of the number in the robot file, or its name.

    Path in the robot file, or the name of an offset or of the scale."""
    prior: float | None
    """Value that was known beforehand."""
    prior_deviation: float | None
    """Standard deviation of the value known beforehand."""
    profile: Profile | None
    """Profile of χ², if it was asked for: ends of the interval that holds the value with 95 %, and points."""
    start: float
    """Value of the file."""
    unit: str
    """Unit of the number."""
    value: float
    """Calibrated value."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "profile": Profile,
    }


class Walk(Row):
    """Walk along the weakest combination, with everything else fitted again."""

    chi2_rises: NDArray[np.float64]
    """Rises of χ² there, in the variance of the residuals: 1 and 4 for a parabola."""
    deviations: NDArray[np.float64]
    """Held distances, in deviations, at which something fits."""
    is_parabola: bool
    """Is parabola."""


class WeakRow(Row):
    """Combination of values that the readings determine worst."""

    deviation_m: float | None
    """Standard deviation of the lengths of the combination together; absent if the readings do not see it [m]."""
    direction: NDArray[np.float64]
    """Unit vector over the values that are lengths, with inner conditions; factors stand with the metres for which they
    count."""
    share: float
    """Share of the words in the combination."""
    words: str
    """Words."""


class LengthParts(Row):
    """Unstrained length of a cable at rest, as it is counted with a pulley or a winch and without them."""

    beyond_anchor_m: float
    """Length that pulley and drum side add: the unstrained length of the file less `to_anchor_m` [m]."""
    to_anchor_m: float
    """Unstrained length from the attachment to the anchor point, if the cable ended there with the same tension [m]."""


class CheckedPulley(Row):
    """Pulley of a cable."""

    bearing_friction_coefficient: float | None
    """Bearing friction coefficient."""
    bearing_radius_m: float | None
    """Bearing radius [m]."""
    efficiency: float | None
    """Efficiency."""
    entry_direction: NDArray[np.float64]
    """Direction of travel at the anchor towards the platform, unit vector."""
    friction_coefficient: float | None
    """Friction coefficient."""
    name: str
    """Name."""
    radius_m: float
    """Radius [m]."""


class CheckedGuideWheel(Row):
    """Guide wheel of a winch."""

    distance_m: float
    """Length of the cable from its anchor to the wheel [m]."""
    mass_kg: float
    """Mass that the wheel adds at the cable [kg]."""
    name: str
    """Name."""


class CheckedWinch(Row):
    """Winch of a cable."""

    control: str | None
    """Control of the motor; absent if it holds its angle."""
    drum_mass_kg: float | None
    """Masses that drum and motor add at the cable; absent without inertia [kg]."""
    drum_side_length_m: float
    """Drum side length [m]."""
    gear_efficiency: float | None
    """Efficiency of the gear; absent if it is 1."""
    guide_wheels: list[CheckedGuideWheel] | None
    """Guide wheels, the nearest to the anchor first; absent without any."""
    max_acceleration_m_s2: float | None
    """Max acceleration [m/s²]."""
    max_brake_power_w: float | None
    """Max brake power [W]."""
    max_power_w: float | None
    """Max power [W]."""
    max_speed_m_s: float | None
    """Max speed [m/s]."""
    max_torque_n_m: float | None
    """Torque of the motor at its own shaft [N m]."""
    motor_mass_kg: float | None
    """Motor mass [kg]."""
    name: str
    """Name."""
    position_gain_n_per_m: float | None
    """Gains of a position control at the cable [N/m]."""
    speed_gain_n_s_per_m: float | None
    """Speed gain [1/m]."""
    stiffness_n_per_m: float | None
    """Stiffness at the cable; absent for a rigid winch [N/m]."""
    torque_speed_n_m: NDArray[np.float64] | None
    """Torque speed [N m]."""
    torque_speed_rad_s: NDArray[np.float64] | None
    """Corners of the torque–speed curve: speeds and torques [rad/s]."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "guide_wheels": CheckedGuideWheel,
    }


class CheckedCable(Row):
    """Cable of a robot file."""

    anchor_m: NDArray[np.float64]
    """Anchor, world axes [m]."""
    attachment_m: NDArray[np.float64]
    """Attachment, platform axes [m]."""
    length_parts: LengthParts | None
    """Parts of the unstrained length of a cable over a pulley or to a winch; absent for other cables, and if the lengths
    are unknown or have no equilibrium."""
    load_n_per_m: NDArray[np.float64] | None
    """Load per length besides weight and wind; absent if there is none [N/m]."""
    material: str
    """Name of its rope."""
    maximum_tension_n: float | None
    """Maximum tension that is allowed [N]."""
    minimum_tension_n: float | None
    """Minimum tension that is allowed [N]."""
    name: str
    """Name of the cable."""
    pulley: CheckedPulley | None
    """Pulley at the anchor; absent if there is none."""
    shares_rope_with: str | None
    """Cable whose rope continues in this one over a sheave; absent for a cable of its own."""
    sheave_efficiency: float | None
    """Efficiency of that sheave; absent without one."""
    support: str | None
    """Name of the flexible support of its anchor; absent for a rigid anchor."""
    unstrained_length_m: float | None
    """Unstrained length of the file [m]."""
    winch: CheckedWinch | None
    """Winch behind the anchor; absent if there is none."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "length_parts": LengthParts,
        "pulley": CheckedPulley,
        "winch": CheckedWinch,
    }


class CheckedClearance(Row):
    """Distances that have to be kept free."""

    cables_m: float
    """Cables [m]."""
    from_end_m: float | None
    """Length at the ends of cables that is not compared; absent if the file gives none [m]."""
    obstacles_m: float
    """Obstacles [m]."""
    platform_m: float
    """Platform [m]."""


class LoadRow(Row):
    """Load on the platform."""

    force_n: NDArray[np.float64]
    """Force [N]."""
    moment_n_m: NDArray[np.float64]
    """Moment [N m]."""
    point_m: NDArray[np.float64]
    """Point [m]."""


class CheckedRope(Row):
    """Rope of a robot file."""

    axial_damping_time_s: float | None
    """Damping time of the stretch [s].

    Absent if zero."""
    axial_loss_factor: float | None
    """Loss factor of the stretch.

    Absent if zero."""
    axial_stiffness_n: float
    """Axial stiffness EA [N]."""
    breaking_load_n: float | None
    """Breaking load [N]."""
    damping_ratio: float | None
    """Damping ratio."""
    drag_width_m: float | None
    """Drag coefficient times diameter [m]."""
    dynamic_axial_stiffness_n: float | None
    """Axial stiffness in vibration [N]."""
    mass_kg_per_m: float
    """Mass per length [kg/m]."""
    maximum_tension_n: float | None
    """Maximum tension that is allowed [N]."""
    minimum_tension_n: float | None
    """Minimum tension that is allowed [N]."""
    name: str
    """Name of the rope."""
    viscous_damping_n_s_m2: float | None
    """Viscous damping per length [N s/m²]."""


class CheckedBody(Row):
    """Body of a robot file, in the world or in the frame of the platform."""

    diameter_m: float | None
    """Diameter [m]."""
    from_m: NDArray[np.float64] | None
    """Ends of the axis of a cylinder; absent for other shapes [m]."""
    length_m: float | None
    """Length [m]."""
    name: str
    """Name."""
    outward: NDArray[np.float64] | None
    """Direction out of a half space; absent for other shapes."""
    position_m: NDArray[np.float64]
    """Origin of the body's own frame: the centre of a box or a cylinder, a point in the plane of a half space [m]."""
    roll_pitch_yaw_deg: NDArray[np.float64]
    """Roll pitch yaw [deg]."""
    shape: str
    """`box`, `cylinder`, `half-space` or `mesh`."""
    size_m: NDArray[np.float64] | None
    """Edges of a box; absent for other shapes [m]."""
    to_m: NDArray[np.float64] | None
    """To [m]."""
    triangles: int | None
    """Number of triangles of a mesh; absent for other shapes."""


class CheckedPlatform(Row):
    """Platform of a robot file."""

    center_of_mass_m: NDArray[np.float64]
    """Center of mass [m]."""
    drag_area_m2: float | None
    """Drag area [m²]."""
    inertia_kg_m2: NDArray[np.float64]
    """Inertia [kg m²]."""
    mass_kg: float
    """Mass [kg]."""
    motion: str
    """Motion."""
    plane_normal: NDArray[np.float64] | None
    """Plane of a planar platform; absent for other platforms."""
    plane_offset_m: float | None
    """Plane offset [m]."""


class CheckedPose(Row):
    """Pose of a robot file."""

    position_m: NDArray[np.float64]
    """Position [m]."""
    roll_pitch_yaw_deg: NDArray[np.float64]
    """Roll pitch yaw [deg]."""


class CheckedRequired(Row):
    """Loads that the robot has to bear in addition to the dead load, and velocities that its winches have to give. A
    load that is not required is absent."""

    acceleration_m_s2: NDArray[np.float64] | None
    """Acceleration [m/s²]."""
    angular_acceleration_rad_s2: NDArray[np.float64] | None
    """Angular acceleration [rad/s²]."""
    angular_velocity_rad_s: NDArray[np.float64] | None
    """Angular velocity [rad/s]."""
    force_n: NDArray[np.float64] | None
    """Force [N]."""
    moment_n_m: NDArray[np.float64] | None
    """Moment [N m]."""
    payload_center_m: NDArray[np.float64] | None
    """Payload center [m]."""
    payload_center_reach_m: NDArray[np.float64] | None
    """Payload center reach [m]."""
    payload_max_kg: float | None
    """Payload max [kg]."""
    payload_min_kg: float | None
    """Payload min [kg]."""
    shape: str
    """`box` or `ellipsoid`: the shape of the set of forces, moments and so on."""
    velocity_m_s: NDArray[np.float64] | None
    """Velocity [m/s]."""
    wind_speed_m_s: float | None
    """Wind speed [m/s]."""


class CheckedSupport(Row):
    """Flexible support of anchors."""

    damping_ratio: float
    """Damping ratio."""
    drums: str
    """`on-support` or `on-ground`."""
    first_frequency_hz: float | None
    """Lowest frequency of the support alone; absent without mass [Hz]."""
    mass_kg: float
    """Mass [kg]."""
    name: str
    """Name."""
    stiffness_n_per_m: NDArray[np.float64]
    """Stiffness [N/m]."""


class WindRow(Row):
    """Wind."""

    air_density_kg_m3: float
    """Air density [kg/m³]."""
    velocity_m_s: NDArray[np.float64]
    """Velocity [m/s]."""


class PoseRow(Row):
    """Pose of the platform."""

    position_m: NDArray[np.float64]
    """Position of the platform origin [m]."""
    quaternion_wxyz: NDArray[np.float64]
    """Orientation as a quaternion w, x, y, z."""
    roll_pitch_yaw_deg: NDArray[np.float64]
    """Roll, pitch, yaw of the platform [deg]."""


class ClearanceRow(Row):
    """Pair of things with its distance, on a move the least one."""

    crossing_fractions: NDArray[np.float64] | None
    """Fractions of the move at which the two cables cross each other."""
    distance_m: float
    """Distance between the surfaces, negative in an overlap [m]."""
    first: str
    """Name of the first cable, or of a body of the platform."""
    fraction: float | None
    """Fraction of the move where the margin is least."""
    kind: str
    """Kind of the pair: cables, platform or obstacles."""
    margin_m: float
    """Distance beyond the required one; negative where the pair touches [m]."""
    points_m: NDArray[np.float64]
    """Nearest points, on the centre lines of cables [m]."""
    required_m: float
    """Required distance, vibration included [m]."""
    second: str
    """Name of the other cable, body or obstacle."""
    vibration_m: float | None
    """Part of the required distance for the motions of both in gusts; absent without them [m]."""


class WayAround(Row):
    """Way from the pose of the state to the end of a move."""

    moves_examined: int
    """Number of straight moves that were examined."""
    through: list[PoseRow] | None
    """Poses between both, in their order; absent if no way was found, which does not mean that there is none."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "through": PoseRow,
    }


class AdviceRow(Row):
    """Recommendation: the simplest model that is good enough."""

    cable_model: str
    """Cable model."""
    text: str
    """Text."""


class FrozenSagRow(Row):
    """Modes for which a static sag model is worse than a spring."""

    cable_model: str
    """Cable model."""
    first_cable_resonance_hz: float
    """First cable resonance [Hz]."""
    frequency_hz: float
    """Frequency [Hz]."""
    modes: int
    """Modes."""
    relative_difference: float
    """Relative difference."""
    spring_relative_difference: float
    """Spring relative difference."""
    text: str
    """Text."""


class MatchRow(Row):
    """Mode and the mode of the reference that it matches."""

    correlation: float
    """Correlation."""
    frequency_hz: float
    """Frequency [Hz]."""
    reference_hz: float
    """Reference [Hz]."""
    reference_index: int
    """Reference index."""
    relative_difference: float
    """Relative difference."""


class ModeRow(Row):
    """Mode of vibration."""

    cable_energy_fractions: NDArray[np.float64]
    """Cable energy fractions."""
    cable_shapes: NDArray[np.float64] | None
    """Displacements (e, n, b) of the stations of every cable, in the scale of `shape`."""
    damping_ratio: float
    """Damping ratio."""
    decay_time_s: float | None
    """Time in which its amplitude falls to the requested percentage; absent for a mode that does not decay [s]."""
    drive_energy_fractions: NDArray[np.float64] | None
    """Kinetic energy of the drive of each cable; absent if no drive has inertia."""
    eigenvalue_per_s: NDArray[np.float64] | None
    """Eigenvalue λ = −ζω + iω√(1 − ζ²): real and imaginary part [1/s]."""
    frequency_hz: float
    """Frequency [Hz]."""
    kind: str
    """Kind."""
    modal_mass_kg: float
    """Modal mass [kg]."""
    multiplicity: int
    """Multiplicity."""
    peak: float | None
    """Height of the peak of this mode alone."""
    platform_energy_fraction: float
    """Platform energy fraction."""
    residual: float
    """Residual."""
    residue_per_kg: float | None
    """Residue [1/kg]."""
    shape: NDArray[np.float64]
    """Shape."""
    stretching_share: NDArray[np.float64] | None
    """Share of the stretch of each cable in the energy of deformation; absent in the closed form of shallow-dynamic cables
    and for rigid ones."""
    support_energy_fractions: NDArray[np.float64] | None
    """Kinetic energy of each flexible support; absent on a rigid frame."""


class ModelRow(Row):
    """Modes of one cable model, and their matches in the reference."""

    cable_model: str
    """Cable model."""
    certified: bool
    """Certified."""
    count_below: int
    """Count below."""
    error: str | None
    """Reason why the model has no modes here."""
    first_wrong_hz: float | None
    """First wrong [Hz]."""
    largest_difference: float | None
    """Largest relative difference of the compared modes that have a counterpart."""
    matches: list[MatchRow]
    """Matches."""
    missed: int
    """Missed."""
    modes: list[ModeRow]
    """Modes."""
    within: int
    """Number of compared modes within the tolerance."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "matches": MatchRow,
        "modes": ModeRow,
    }


class SidesTried(Row):
    """Choice of the sides of a band, with its result."""

    after: float | None
    """Value of the goal; `None` if a demand was not met."""
    below: NDArray[np.int64]
    """Number of natural frequencies that had to go below the band, one per pose."""
    is_chosen: bool
    """True for the choice of the result."""


class DemandRow(Row):
    """Demand at the pose where it is met least."""

    after: float
    """Value with the chosen numbers."""
    before: float
    """Value with the numbers of the file."""
    gain_per_unit: float
    """Improvement of the goal per unit by which the demand is lowered, summed over the poses."""
    limit: float
    """Limit."""
    name: str
    """Demand."""
    pose: int
    """Number of the pose, from 1."""
    unit: str
    """Unit."""


class ExchangeRow(Row):
    """Exchange of the attachments of two cables."""

    after: float
    """Value of the goal after the exchange, with the values of the file."""
    cables: list[str]
    """Names of the cables."""


class ChangeGain(Row):
    """Part of the gain of an entry of the changes."""

    change: str
    """Path of the values, as it was given."""
    gain: float | None
    """Gain of the goal that is lost if these values alone go back to those of the file.

    Absent if a pose is not held then."""


class DesignPose(Row):
    """Results at one pose."""

    after: float
    """Value of the goal with the chosen values."""
    before: float
    """Value of the goal with the values of the file."""
    beside_band_after_hz: float | None
    """Beside band after [Hz]."""
    beside_band_before_hz: float | None
    """Natural frequency that is deepest in the band to avoid or nearest to it [Hz]."""
    frequency_after_hz: float | None
    """Frequency after [Hz]."""
    frequency_before_hz: float | None
    """Frequency before [Hz]."""
    position_m: NDArray[np.float64]
    """Position of the platform [m]."""
    roll_pitch_yaw_deg: NDArray[np.float64]
    """Roll, pitch, yaw [degrees]."""
    share: float
    """Gain of the goal if this pose alone gains one. The shares of all poses sum to 1, except for a weighted mean."""
    stiffness_after_n_per_m: float | None
    """Stiffness after [N/m]."""
    stiffness_before_n_per_m: float | None
    """Stiffness before [N/m]."""


class RopeTried(Row):
    """Rope that was tried."""

    after: float | None
    """Value of the goal with the chosen values; absent for a rope that was not searched or that meets no demands."""
    before: float | None
    """Value of the goal with the values of the file.

    Absent where a pose is not held."""
    chosen: bool
    """True for the chosen rope."""
    name: str
    """Name of the rope."""
    reason: str | None
    """Reason for which there is no value."""


class ChosenValue(Row):
    """Chosen value of the robot file."""

    at_bound: str | None
    """Bound at which the value is.

    `minimum` or `maximum` if the value is at this bound."""
    gain_per_unit: float
    """Gain of the goal per unit by which the bound moves outwards.

    Improvement of the goal per unit of the value by which its bound is moved outwards; zero between the bounds."""
    maximum: float
    """Upper bound."""
    minimum: float
    """Lower bound."""
    path: str
    """Path of the number."""
    start: float
    """Value of the file."""
    unit: str
    """Unit of the number."""
    value: float
    """Chosen value."""


class EstimateAlarm(Row):
    """Alarm of a test."""

    cable: str | None
    """Cable with the fault."""
    fault: str
    """Fault: `slip`, `load-cell`, `payload`, `force`, `cut`, `stuck`, `undecided`, or `restart`."""
    size: float | None
    """Size of the fault: slip [m], step of a load cell [N], payload [kg], force along z [N]."""
    size_std: float | None
    """Standard deviation of the size."""
    t_s: float
    """Time of the log [s]."""
    text: str
    """Sentence about the alarm."""


class CableErrors(Row):
    """Constant errors of the sensors of one cable at the end of the log."""

    cable: str
    """Cable."""
    offset_m: float
    """Length less its reading [m]."""
    offset_std_m: float
    """Standard deviation of the offset [m]."""
    residual_ratio: float | None
    """Root mean square of the residuals of its load cell, in their standard deviations."""
    tension_bias_n: float | None
    """Constant error of the load cell [N].

    Absent without readings."""
    tension_bias_std_n: float | None
    """Standard deviation of this error [N]."""


class EstimateRow(Row):
    """Estimated state at one time. Lists have a number per cable. Deviations are absent where the readings do not fit
    their stated noise."""

    angular_velocity_rad_s: NDArray[np.float64]
    """Angular velocity of the platform [rad/s]."""
    angular_velocity_std_rad_s: NDArray[np.float64] | None
    """Standard deviation of the angular velocity [rad/s]."""
    force_n: NDArray[np.float64]
    """External force besides the loads of the file [N]."""
    force_std_n: NDArray[np.float64] | None
    """Standard deviation of the external force [N]."""
    is_trusted: bool
    """True if the readings of the last half second fit their stated noise."""
    payload_center_m: NDArray[np.float64] | None
    """Centre of mass of the payload, platform frame [m].

    Absent while payload or first moment are too uncertain."""
    payload_kg: float
    """Payload beyond the platform of the file [kg]."""
    payload_std_kg: float | None
    """Standard deviation of the payload [kg]."""
    position_m: NDArray[np.float64]
    """Position of the platform origin [m]."""
    position_std_m: NDArray[np.float64] | None
    """Standard deviation of the position [m]."""
    quaternion_wxyz: NDArray[np.float64]
    """Orientation as a quaternion w, x, y, z."""
    residuals: NDArray[np.float64] | None
    """Reading of the load cell of each cable less the expected one, in its standard deviations.

    Absent at a time without a reading of every load cell."""
    rings: bool
    """True while the platform vibrates: payload and its centre are then read from means of tensions alone."""
    roll_pitch_yaw_deg: NDArray[np.float64]
    """Roll, pitch, yaw of the platform [deg]."""
    rotation_std_deg: NDArray[np.float64] | None
    """Standard deviation of small turns about the world's axes [deg]."""
    slack: list[str]
    """State of each cable: `slack`, `taut`, or `unknown`."""
    t_s: float
    """Time of the log [s]."""
    tensions_n: NDArray[np.float64]
    """Tension of each cable at the anchor or drum [N]."""
    tensions_std_n: NDArray[np.float64] | None
    """Standard deviation of the tension of each cable [N]."""
    velocity_m_s: NDArray[np.float64]
    """Velocity of the platform origin [m/s]."""
    velocity_std_m_s: NDArray[np.float64] | None
    """Standard deviation of the velocity [m/s]."""


class SensorFit(Row):
    """Readings of one kind of sensor beside their stated noise."""

    band: NDArray[np.float64]
    """Band that holds the mean square with 95 % if noise and model are true."""
    outliers: int
    """Readings left out as outliers."""
    readings: int
    """Number of readings."""
    sensor: str
    """Sensor."""
    squares: float
    """Squared residuals by their covariance, per reading.

    One if noise and model are true."""
    text: str
    """Sentence about the residuals."""


class GradientParameter(Row):
    """Number of the robot file."""

    path: str
    """Path."""
    tolerance: float
    """Step `tolerance`, in the unit of the number."""
    unit: str
    """Unit."""
    value: float
    """Value with which the results are computed."""


class RefusedResult(Row):
    """Result without a gradient."""

    measure: Any
    """Identity as data, as in [`GradientResult`]."""
    name: str
    """Name."""
    reason: str
    """Reason."""


class GradientResult(Row):
    """Result with its derivatives."""

    block_entry: NDArray[np.int64] | None
    """Entry of the block of modes that share a frequency: numbers of the two modes in the list, from 1. Along a change,
    the derivatives of the frequencies are the eigenvalues of the block."""
    derivatives: NDArray[np.float64]
    """Derivatives, one per number of the robot file."""
    measure: Any
    """Identity as data: `kind`, and the cable, mode or frequency to which the result belongs."""
    name: str
    """Name, such as `frequency 3` or `tension of cable "2" at the anchor`."""
    unit: str
    """Unit."""
    value: float
    """Value."""


class AirDamping(Row):
    """Damping of a mode, of first order."""

    aerodynamic_damping_ratio: float
    """Damping ratio by the mean wind.

    Added to the other."""
    damping_ratio: float
    """Damping ratio in still air."""
    frequency_hz: float
    """Natural frequency [Hz]."""


class GustRow(Row):
    """One output in gusts."""

    density: NDArray[np.float64]
    """Spectral density, unit squared per Hz."""
    mean: float
    """Mean.

    Mean tension; zero for a motion, which is about the equilibrium in the mean wind."""
    output: str
    """Output."""
    peak: float | None
    """Expected largest excursion to one side within the duration; absent for fewer than ten expected crossings."""
    peak_deviation: float | None
    """Standard deviation of that excursion."""
    quasi_static_rms: float | None
    """R.m.s. value without the dynamics of the robot; absent without stiffness."""
    rate_hz: float
    """Rate of crossings [Hz]."""
    rms: float
    """Rms."""
    share_by_mode: NDArray[np.float64]
    """Part of the variance nearest to each mode of `modes`, in their order."""
    slack_probability: float | None
    """Probability of a slack cable.

    Probability that the tension falls to zero within the duration, 0 below 1e-12; tensions alone."""
    slow_density: NDArray[np.float64]
    """Spectral density without the dynamics of the robot; empty without stiffness."""
    unit: str
    """Unit."""


class TurbulenceRow(Row):
    """Turbulence of the results."""

    coherence_decay: NDArray[np.float64]
    """Coherence decay."""
    frozen: bool
    """Frozen."""
    intensity: NDArray[np.float64]
    """Intensity."""
    length_scale_m: NDArray[np.float64] | None
    """Absent for measured spectra [m]."""
    spectrum: str
    """Spectrum."""


class SecondBest(Row):
    """Best fit with other modes and other values."""

    chi2: float
    """Chi2."""
    chi2_per_degree: float
    """Chi2 per degree."""
    frequency_hz: NDArray[np.float64]
    """Natural frequencies of these modes [Hz]."""
    numbers: NDArray[np.int64]
    """Numbers of the modes in the ascending list, in the order of `frequencies` of the results."""


class ModeAssignment(Row):
    """Assignment of measured frequencies without a number to modes; the numbers are in `frequencies`."""

    crowded: int
    """Number of these with several modes within two deviations."""
    determined: bool
    """False if other assignments are possible; deviations and intervals are then absent."""
    doubts: list[str]
    """Reasons why it is not determined."""
    frequencies: int
    """Number of frequencies without a number."""
    random_as_good: int
    """Number of these lists that fit at least as well."""
    random_chi2_per_degree: float | None
    """Median of χ² per degree of freedom of these lists."""
    random_lists: int
    """Number of lists of random frequencies that were fitted in their place."""
    second_best: SecondBest | None
    """Best fit with other modes."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "second_best": SecondBest,
    }


class FrequencyRow(Row):
    """Measured and fitted natural frequency."""

    before_hz: float | None
    """Absent if the robot has no equilibrium before the fit, or not this mode [Hz]."""
    experiment: str
    """Experiment."""
    fitted_damping_ratio: float | None
    """Fitted damping ratio."""
    fitted_hz: float
    """Fitted [Hz]."""
    label: str | None
    """Label."""
    measured_damping_ratio: float | None
    """Measured damping ratio."""
    measured_hz: float
    """Measured [Hz]."""
    number: int
    """Number of the mode in the ascending list, from 1."""


class DiagramRow(Row):
    """Pole of the stabilisation diagram of an ambient record."""

    damping_ratio: float
    """Damping ratio."""
    frequency_hz: float
    """Frequency [Hz]."""
    is_stable: bool
    """True if it has been found in five orders in a row."""
    order: int
    """Order of the system."""


class PoleRow(Row):
    """Natural frequency that was found in a time history."""

    damping_interval_95: NDArray[np.float64] | None
    """Interval that holds the damping ratio with 95 %."""
    damping_ratio: float | None
    """Damping ratio; absent if the record is too short for it."""
    damping_std: float | None
    """Damping std."""
    difference_of_halves: float | None
    """Largest difference of both halves, in deviations."""
    frequency_hz: float
    """Frequency [Hz]."""
    halves_damping_ratio: NDArray[np.float64] | None
    """Damping ratios in both halves."""
    halves_hz: NDArray[np.float64] | None
    """Frequencies in the first and the second half of a decay [Hz]."""
    interval_95_hz: NDArray[np.float64] | None
    """Interval that holds the frequency with 95 % [Hz]."""
    is_vibration: bool
    """True if the pole is fitted like a measured natural frequency."""
    shape_imag: NDArray[np.float64]
    """Imaginary parts of the shape."""
    shape_real: NDArray[np.float64]
    """Real parts of the shape at the sensors; 1 at the one that sees it best."""
    shape_std: NDArray[np.float64]
    """Standard deviations √E|δ|² of the shape."""
    std_hz: float
    """Std [Hz]."""


class HistoryOfPoles(Row):
    """Time history with what was found in it."""

    channels: list[str]
    """Sensors, in the order of the shapes."""
    checks: list[str]
    """Findings about the readings."""
    chi2_per_degree: float | None
    """χ² per degree of freedom of a decay; 1 by itself where no noise was given."""
    covariance: NDArray[np.float64]
    """Covariance of frequency [Hz] and damping ratio of each pole, in this order."""
    diagram: list[DiagramRow] | None
    """Stabilisation diagram of an ambient record."""
    duration_s: float
    """Duration [s]."""
    experiment: str
    """Experiment."""
    is_noise: bool | None
    """False if the residuals of a decay are more than noise."""
    kind: str
    """`decay` or `ambient`."""
    name: str
    """Name."""
    noise: NDArray[np.float64] | None
    """Standard deviations of the noise of the sensors of a decay, in the SI unit of each."""
    order: int | None
    """Order of the system of an ambient record."""
    poles: list[PoleRow]
    """Natural frequencies, ascending."""
    residual_correlation: float | None
    """Mean square of the correlations of the residuals of a decay, times the number of samples: 1 for noise."""
    sample_rate_hz: float
    """Sample rate [Hz]."""
    samples: int
    """Samples."""
    warnings: list[str] | None
    """Sentences on what limits the result."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "diagram": DiagramRow,
        "poles": PoleRow,
    }


class ProposedMeasurement(Row):
    """Measurement to make next."""

    deviations: NDArray[np.float64]
    """Standard deviations of all values after this measurement and those before it, in their order."""
    frequency_hz: NDArray[np.float64] | None
    """Natural frequencies of the identified robot there, if they are measured [Hz]."""
    largest_of: str | None
    """Value with the largest relative deviation."""
    largest_percent: float | None
    """Largest relative deviation of a chosen value then [%].

    Largest of these relative to its value, of the chosen positive values."""
    measured: str
    """Measured quantity: `frequencies`, `tensions`, `lengths` or `pose`."""
    number: int
    """Number of proposed measurements up to this one."""
    payload_kg: float | None
    """Payload that the platform carries there [kg].

    Absent unless payloads are candidates."""
    position_m: NDArray[np.float64]
    """Position of the platform origin [m]."""
    roll_pitch_yaw_deg: NDArray[np.float64]
    """Roll, pitch, yaw of the platform [deg]."""


class FittedResponse(Row):
    """Measured and fitted response."""

    before_imag: NDArray[np.float64] | None
    """Before imag."""
    before_real: NDArray[np.float64] | None
    """Empty if the robot has no equilibrium before the fit."""
    experiment: str
    """Experiment."""
    fitted_imag: NDArray[np.float64]
    """Fitted imag."""
    fitted_real: NDArray[np.float64]
    """Fitted real."""
    frequency_hz: NDArray[np.float64]
    """Frequency [Hz]."""
    input: str
    """Input."""
    left_out_hz: NDArray[np.float64] | None
    """Ranges that are left out because the model misses them: first and last frequency of each [Hz]."""
    measured_imag: NDArray[np.float64]
    """Measured imag."""
    measured_real: NDArray[np.float64]
    """Measured real."""
    name: str
    """Name."""
    output: str
    """Output."""
    residual_rms: float
    """Root mean square of the residuals in deviations of the noise, of the values that are not left out; 1 if the fit is
    perfect."""
    unit: str
    """Unit."""


class StartRow(Row):
    """Result of one start."""

    chi2_per_degree: float | None
    """χ² per degree of freedom at its end; absent if the robot has no equilibrium there."""
    converged: bool
    """True if the search ended at a minimum."""
    iterations: int
    """Iterations."""


class StaticRow(Row):
    """Measured and fitted number of a state."""

    deviation: float
    """Deviation."""
    experiment: str
    """Experiment."""
    fitted: float
    """Value of the fit."""
    measured: float
    """Measured value."""
    quantity: str
    """Quantity with its unit.

    `x_m` … `rz_rad` (differences from the measured pose), `tension_n:NAME`, `length_m:NAME`."""


class ValueRow(Row):
    """Identified value."""

    at_bound: str | None
    """`minimum` or `maximum` if the value is at this bound."""
    deviation: float | None
    """Standard deviation; absent for a value that the measurements do not determine, or that moves with such a value."""
    interval_95: NDArray[np.float64] | None
    """Interval that holds the value with 95 %: that of the deviation, or that of the profile where χ² is no parabola."""
    moves_with: list[str] | None
    """Values that the measurements determine poorly, with which this one moves farther than its deviation."""
    path: str
    """Path."""
    prior: float | None
    """Prior."""
    prior_deviation: float | None
    """Prior deviation."""
    profile: Profile | None
    """Profile of χ², if it was asked for or if χ² is no parabola."""
    start: float
    """Start."""
    unit: str
    """Unit."""
    value: float
    """Value."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "profile": Profile,
    }


class LoadedRow(Row):
    """Cable with the payload."""

    limit_place: str | None
    """Place where the limit is reached: `platform`, `anchor`, `lowest point` or `anywhere`."""
    limit_reached: str | None
    """Limit reached."""
    maximum_tension_n: float | None
    """Maximum tension [N]."""
    minimum_tension_n: float
    """Minimum tension [N]."""
    name: str
    """Name."""
    tension_anchor_n: float
    """Tension anchor [N]."""
    tension_margin: float | None
    """Distance from the nearer limit, divided by the distance between the limits."""
    tension_margin_n: float
    """Distance from the nearer limit [N]."""
    tension_platform_n: float
    """Tension platform [N]."""


class RequiredHeld(Row):
    """Load factor with what binds."""

    cables: list[LoadedRow]
    """Cables with the dead load and the largest multiple of this load; empty without a largest multiple."""
    force_n: NDArray[np.float64]
    """Required load that binds, in addition to the dead load [N]."""
    held: bool
    """True if all required loads are held."""
    load_factor: float | None
    """Largest multiple of the required loads; absent if no maximum tension limits it."""
    load_factor_by_position_per_m: NDArray[np.float64] | None
    """Derivatives of the load factor by a motion of the platform along the axes of the world, and by a turn about them;
    absent where it has none [1/m]."""
    load_factor_by_rotation_per_rad: NDArray[np.float64] | None
    """Load factor by rotation [1/rad]."""
    load_factor_lower_bound: float | None
    """Multiple up to which all loads inside the set are held, not only its vertices."""
    load_factor_upper_bound: float | None
    """Multiple that is proved to be too much."""
    moment_n_m: NDArray[np.float64]
    """Moment [N m]."""
    wind_m_s: NDArray[np.float64] | None
    """Required wind that binds, at the multiple 1; absent if it does not act on the ropes [m/s]."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "cables": LoadedRow,
    }


class FirstPlatformMode(Row):
    """Mode that moves the platform, with its share: the first one with enough of it, or one below."""

    frequency_hz: float
    """Frequency [Hz]."""
    index: int
    """Index in the list of modes, from 0."""
    platform_energy_fraction: float
    """Platform energy fraction."""


class StationsRow(Row):
    """Stations of a cable, where the displacements of `cable_shapes` are given."""

    arc_length_m: NDArray[np.float64]
    """Arc length [m]."""
    axes: Axes
    """Unit vectors of a cable, world axes: along the chord, normal to it in plane, out of plane."""
    cable: str
    """Cable."""
    position_m: NDArray[np.float64]
    """Position [m]."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "axes": Axes,
    }


class ObservedCase(Row):
    """Standard deviations with some sensors, the worst of all poses and cables."""

    first_moment_std_kg_m: NDArray[np.float64]
    """Standard deviation of the payload's first moment, platform axes [kg m]."""
    force_std_n: NDArray[np.float64]
    """Standard deviation of the external force [N]."""
    moment_std_n_m: NDArray[np.float64]
    """Standard deviation of the external moment [N m]."""
    offset_std_m: float
    """Standard deviation of the constant error of a length [m]."""
    payload_std_kg: float
    """Standard deviation of the payload [kg]."""
    position_std_m: NDArray[np.float64]
    """Standard deviation of the position [m]."""
    rotation_std_deg: NDArray[np.float64]
    """Standard deviation of small turns about the world's axes [deg]."""
    tension_bias_std_n: float | None
    """Standard deviation of the constant error of a load cell [N].

    Absent without load cells."""
    tension_std_n: float
    """Standard deviation of the tension of a cable [N]."""


class ObservedNumber(Row):
    """Number of the state with its standard deviation, the worst of all poses and cables."""

    best_addition: str | None
    """Addition that reduces this deviation most; absent if none reduces it by a tenth."""
    determined: str
    """`sensors` if their readings give most of what is known, `partly`; otherwise `encoders` for pose and tensions,
    `prior` for what was known beforehand, or `given` if it was known exactly."""
    number: str
    """Number."""
    std: float
    """Standard deviation with these sensors."""
    std_of_lengths: float
    """Standard deviation with the encoders alone."""
    std_with_addition: float | None
    """Standard deviation with this addition."""
    unit: str
    """Unit of the deviations."""


class ParameterRow(Row):
    """Number of a robot."""

    given: bool
    """The file gives the number; otherwise the value is the default.

    True if the file gives the number; otherwise the value is the default."""
    label: str
    """Name in words with the unit."""
    maximum: float
    """Upper end of the range.

    Maximum of the range, or the limit below which values are permitted."""
    meaning: str
    """Meaning of the number."""
    minimum: float
    """Lower end of the range."""
    path: str
    """Path of the number for `set`, `vary` and `fit`."""
    range: str
    """Range that is allowed, in words."""
    unit: str
    """Unit; `1` for a ratio."""
    value: float
    """Value, in the unit of the row."""


class BoundRow(Row):
    """Minimum or maximum payload."""

    cables: list[LoadedRow]
    """Tensions with this payload; empty without a payload."""
    excluded_from_kg: float | None
    """Proved limit: no payload of at least this mass is possible; absent without a proof [kg]."""
    payload_kg: float
    """Payload [kg]."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "cables": LoadedRow,
    }


class HeldPoseRow(Row):
    """Pose whose unstrained lengths are held, with the mass and the rule for which they hold it."""

    mass_kg: float
    """Mass [kg]."""
    pose: PoseRow
    """Pose of the platform."""
    tension_rule: str | None
    """Tension rule."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "pose": PoseRow,
    }


class PoseDifferenceRow(Row):
    """Translation and rotation between two poses."""

    angle_deg: float
    """Angle [deg]."""
    distance_m: float
    """Distance [m]."""
    translation_m: NDArray[np.float64]
    """Translation [m]."""


class PoseErrorRow(Row):
    """Pose differences at one mass. A difference is absent if one of the two models has no equilibrium."""

    catenary_from_ideal: PoseDifferenceRow | None
    """Translation and rotation between two poses."""
    mass_kg: float
    """Mass [kg]."""
    spring_from_catenary: PoseDifferenceRow | None
    """Translation and rotation between two poses."""
    spring_from_ideal: PoseDifferenceRow | None
    """Translation and rotation between two poses."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "catenary_from_ideal": PoseDifferenceRow,
        "spring_from_catenary": PoseDifferenceRow,
        "spring_from_ideal": PoseDifferenceRow,
    }


class ThresholdRow(Row):
    """Minimum mass at which springs are good enough."""

    from_mass_kg: float | None
    """From mass [kg]."""
    tolerance_mm: float
    """Tolerance [mm]."""
    within: str
    """`everywhere`, `from` or `nowhere`."""


class BoxRow(Row):
    """Box of a division."""

    lower_m: NDArray[np.float64]
    """Least coordinate of the positions [m]."""
    margin_n: float | None
    """Least distance of a tension from its limits inside, or the least missing wrench outside [N]."""
    reason: str | None
    """Reason why it is undecided."""
    upper_m: NDArray[np.float64]
    """Greatest coordinate of the positions [m]."""
    verdict: str
    """Verdict: inside, outside or undecided."""


class HistoryRow(Row):
    """Displacement of the point at one time from where the lengths of this time hold it at rest, and the bound of its
    distance."""

    envelope_m: float | None
    """Bound of its distance from its rest, from the end of a command on [m].

    Absent while a command runs."""
    t_s: float
    """Time since the release or the end of the command [s]."""
    x_m: float
    """X [m]."""
    y_m: float
    """Y [m]."""
    z_m: float
    """Z [m]."""


class LengthsRow(Row):
    """Commanded unstrained lengths at one time."""

    t_s: float
    """Time since the start of the command [s]."""
    unstrained_lengths_m: NDArray[np.float64]
    """Unstrained lengths [m]."""


class LowestTension(Row):
    """Lowest tension of a cable during a command and after it, or after a release."""

    cable: str
    """Cable."""
    t_s: float
    """Time since the start of the command, or the release [s]."""
    tension_n: float
    """Tension [N]."""


class SettlingMode(Row):
    """Part of a mode in the motion."""

    amplitude_m: float
    """Amplitude at the release or the end of the command [m].

    Amplitude at the release or the end of the command: half of the long axis of the ellipse on which the point moves."""
    amplitude_without_m: float | None
    """Amplitude without the shaper [m].

    Absent without one."""
    damping_ratio: float
    """Damping ratio."""
    frequency_hz: float
    """Frequency of the damped mode [Hz]."""
    settled_s: float | None
    """Time in which this amplitude alone falls to the tolerance [s].

    Zero if it is smaller, absent if it never does."""


class NeverSettles(Row):
    """Undamped motion that is larger than the tolerance."""

    amplitude_m: float
    """Sum of the amplitudes of all undamped modes: the point keeps swinging by up to this distance [m]."""
    frequency_hz: float
    """Frequency of the undamped mode with the largest amplitude [Hz]."""


class WithPayload(Row):
    """Vibration with a payload."""

    amplitude_m: float
    """Sum of all amplitudes at the end of the command [m]."""
    frequency_hz: float
    """Frequency of the mode with the largest amplitude [Hz]."""
    payload_kg: float
    """Payload [kg]."""
    settled_s: float | None
    """Last time at which the point is at the tolerance, since the end of the command; absent if it never settles [s]."""
    without_m: float | None
    """Sum of all amplitudes at the end of the command without its shaper; absent without one [m]."""


class ImpulseRow(Row):
    """Part of the command and its delay."""

    part: float
    """Part."""
    t_s: float
    """T [s]."""


class Robustness(Row):
    """Vibration that is left if all frequencies are multiplied by a factor, with the shaper unchanged."""

    amplitude_m: float
    """Sum of all amplitudes at the end of the shaped command [m]."""
    frequency_factor: float
    """Frequency factor."""
    without_m: float
    """Sum of all amplitudes at the end of the command without the shaper [m]."""


class Shaping(Row):
    """Shaper and what it does."""

    history_without: list[HistoryRow]
    """Motion from the end of the command without it."""
    impulses: list[ImpulseRow]
    """Impulses."""
    longer_s: float
    """Time by which the command is longer [s]."""
    modes_hz: NDArray[np.float64]
    """Frequencies of the vibrations that it cancels [Hz]."""
    robustness: list[Robustness]
    """Sum of all amplitudes at the end, with frequencies as they are and with others."""
    settled_without_s: float | None
    """Last time at which the point is at the tolerance without the shaper, since the end of the command without it; absent
    if it never settles [s]."""
    shaper: str
    """Name, as `zvd` or `ei:0.05`."""
    surely_settled_without_s: float | None
    """Time from which on the sum of all amplitudes without the shaper is within the tolerance; absent if it never is [s]."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "history_without": HistoryRow,
        "impulses": ImpulseRow,
        "robustness": Robustness,
    }


class BelowRow(Row):
    """Part of the robot behind the surface of a half space."""

    deepest_m: float
    """Largest depth of all rows [m]."""
    deepest_s: float
    """Time of this row [s]."""
    first_s: float
    """Time of the first row in which it is there [s]."""
    is_floor: bool
    """True if the surface is a floor: it faces up within 60°."""
    obstacle: str
    """Name of the half space."""
    part: str
    """Part of the robot in words: a cable, a half of one, or the platform."""


class CutRow(Row):
    """Cable that failed."""

    cable: str
    """Cable."""
    t_s: float
    """T [s]."""


class ColumnError(Row):
    """Bound of the error of one column: its difference from a finer run times a factor of the mesh (97k2)."""

    column: str
    """Column of the result.

    `position_m`, `velocity_m_s`, `clearance_margin_m`, or `tension_platform_NAME_n` and `tension_anchor_NAME_n`."""
    largest: float
    """Bound of the largest error."""
    relative: float | None
    """Root mean square over that of the column.

    Absent for positions and distances."""
    root_mean_square: float
    """Root mean square."""


class NearestRow(Row):
    """Least margin of all rows."""

    margin_m: float
    """Distance beyond the required one [m]."""
    pair: str | None
    """Things that are nearest, in words; absent for a row of a run that was continued."""
    t_s: float
    """T [s]."""


class Peak(Row):
    """Largest tension of a cable at either end, and root mean square of that at the platform."""

    cable: str
    """Name of the cable."""
    finer_peak_n: float | None
    """Largest tension of the finer run [N].

    Value of the finer run."""
    finer_root_mean_square_n: float | None
    """Root mean square of the finer run [N]."""
    peak_n: float
    """Largest tension [N]."""
    root_mean_square_n: float
    """Root mean square [N]."""


class SimulatedRow(Row):
    """Robot at one time. Lists have a number per cable."""

    acceleration_m_s2: NDArray[np.float64]
    """Acceleration of the platform origin [m/s²]."""
    angular_acceleration_rad_s2: NDArray[np.float64]
    """Angular acceleration of the platform [rad/s²]."""
    angular_velocity_rad_s: NDArray[np.float64]
    """Angular velocity of the platform [rad/s]."""
    clearance_margin_m: float | None
    """Distance of the nearest pair beyond the required one [m].

    Absent if the robot file says nothing about distances."""
    dissipated_j: float
    """Energy lost in damping since the start [J]."""
    energy_defect_j: float
    """Defect of the energy balance [J]."""
    energy_of_payloads_j: float
    """Energy that payloads brought, less what they took away [J]."""
    kinetic_energy_j: float
    """Kinetic energy [J]."""
    length_rates_m_s: NDArray[np.float64]
    """Rate of the unstrained length of each cable [m/s].

    Positive while it is paid out."""
    point_velocities_m_s: NDArray[np.float64] | None
    """Velocity of a chosen point [m/s].

    World axes."""
    points_m: NDArray[np.float64] | None
    """Position of a chosen point [m].

    World frame."""
    position_m: NDArray[np.float64]
    """Position of the platform origin [m]."""
    potential_energy_j: float
    """Energy of height [J]."""
    quaternion_wxyz: NDArray[np.float64]
    """Orientation as a quaternion w, x, y, z."""
    roll_pitch_yaw_deg: NDArray[np.float64]
    """Roll, pitch, yaw of the platform [deg]."""
    strain_energy_j: float
    """Energy of the stretch of the ropes [J]."""
    t_s: float
    """Time [s]."""
    tensions_anchor_n: NDArray[np.float64]
    """Tension of each cable at the anchor [N]."""
    tensions_platform_n: NDArray[np.float64]
    """Tension of each cable at the platform [N]."""
    unstrained_lengths_m: NDArray[np.float64]
    """Unstrained length of each cable [m]."""
    velocity_m_s: NDArray[np.float64]
    """Velocity of the platform origin [m/s]."""
    work_of_anchors_j: float
    """Work at moving anchors since the start [J]."""
    work_of_loads_j: float
    """Work of loads, pushes and wind since the start [J]."""
    work_of_winches_j: float
    """Work of the winches since the start [J]."""


class SlackRow(Row):
    """Slack of one cable."""

    cable: str
    """Cable."""
    first_s: float
    """First [s]."""
    share: float
    """Time for which it was slack, over that of the simulation."""


class StepNumbers(Row):
    """StepNumbers of a run."""

    accepted: int
    """Accepted."""
    evaluations: int
    """Evaluations."""
    factored: int
    """Factored."""
    rejected: int
    """Rejected."""


class StretchLossRow(Row):
    """Loss of the stretch of ropes in one mode of the platform. In time it is a damping time, which has the loss factor
    at one frequency only."""

    damping_ratio: float
    """Damping ratio by the losses of the robot file."""
    damping_ratio_in_time: float
    """Damping ratio in this run."""
    frequency_hz: float
    """Natural frequency of the platform on massless ropes [Hz]."""
    stretch_share: float
    """Share of the stretch in the energy of deformation."""


class CableSpeeds(Row):
    """One cable with its winch."""

    braking_power_w: float | None
    """Braking power [W]."""
    driving_power_w: float | None
    """Driving power [W]."""
    limit: str | None
    """Limit that is reached first."""
    motor_torque_at_rest_n_m: float | None
    """Torque of the motor at rest [N m].

    Absent without a radius of the drum."""
    name: str
    """Name."""
    platform_speed_max_m_s: float | None
    """Largest speed of the platform in every direction, as far as this winch allows [m/s].

    Largest speed of the platform in every direction without turning, as far as this winch allows."""
    rate_per_angular_velocity_m_per_rad: NDArray[np.float64]
    """Speed of the cable at the drum per angular velocity about {}, paying out [m/rad]."""
    rate_per_velocity: NDArray[np.float64]
    """Speed of the cable at the drum per speed along {}, paying out.

    Speed of the cable at the drum per speed of the platform along the axes of the world, positive while it pays out."""
    speed_m_s: float | None
    """Speed [m/s]."""
    speed_max_in_m_s: float | None
    """Largest speed of the cable while it winds in [m/s].

    Largest speed of the cable at the drum while it winds in; absent without a limit."""
    speed_max_out_m_s: float | None
    """Largest speed of the cable while it pays out [m/s]."""
    tension_drum_n: float
    """Tension at the drum [N]."""
    used_brake_power: float | None
    """Used brake power."""
    used_power: float | None
    """Used power."""
    used_speed: float | None
    """Used parts of the limits: above 1 beyond the limit. Absent without a limit, and a part of the torque also beyond the
    end of the torque–speed curve, where the part has no value."""
    used_torque: float | None
    """Used torque."""


class LargestSpeed(Row):
    """Largest speed or multiple of it, with what limits it. All are absent if nothing does."""

    cable: str | None
    """Cable whose winch limits it."""
    limit: str | None
    """Limit of this winch: `speed`, `torque`, `power` or `brake-power`."""
    value: float | None
    """Value."""


class DirectionRow(Row):
    """Largest speeds along or about one axis."""

    backward: LargestSpeed
    """In the negative direction."""
    coordinate: str
    """Coordinate."""
    forward: LargestSpeed
    """In the positive direction."""
    unit: str
    """`m/s` or `rad/s`."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "backward": LargestSpeed,
        "forward": LargestSpeed,
    }


class RequiredSpeeds(Row):
    """Required velocities, and the winches meanwhile."""

    angular_velocity_rad_s: NDArray[np.float64]
    """Angular velocity [rad/s]."""
    braking_power_w: float
    """Braking power [W]."""
    driving_power_w: float
    """Largest sums of the powers of all motors that drive and of all that brake [W]."""
    reached: bool
    """True if every winch stays within its limits."""
    speed_factor: LargestSpeed
    """Largest multiple of the required velocities."""
    velocity_m_s: NDArray[np.float64]
    """Velocity [m/s]."""
    velocity_shape: str
    """`box`, or `ellipsoid` with these half axes, for velocities and angular velocities each."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "speed_factor": LargestSpeed,
    }


class OtherStable(Row):
    """Another stable equilibrium, if a short search found one."""

    distance_m: float
    """Distance [m]."""
    energy_above_j: float | None
    """Energy above this equilibrium; absent if the loads have no potential [J]."""
    position_m: NDArray[np.float64]
    """Position [m]."""


class DriveRow(Row):
    """Pulley and winch of a cable at the equilibrium."""

    arc_length_m: float
    """Arc length [m]."""
    drum_side_length_m: float
    """Drum side length [m]."""
    exit_m: NDArray[np.float64]
    """Point at which the cable leaves its pulley [m]."""
    free_length_m: float
    """Unstrained lengths of the free span, on the wheel, and from the entry point to the drum, which add up to that of the
    cable [m]."""
    swivel_direction: NDArray[np.float64] | None
    """Direction from the entry point to the axle, unit vector; absent without a pulley."""
    tension_drum_n: float
    """Tension from the entry point to the drum [N]."""
    winch_yield_m: float
    """Length that the winch pays out because it yields [m]."""
    wrap_deg: float | None
    """Wrap angle on the pulley; absent without a pulley [deg]."""


class CableRow(Row):
    """Cable at the equilibrium."""

    chord_m: float
    """Chord [m]."""
    drive: DriveRow | None
    """State of pulley and winch; absent for a cable that ends at a fixed point."""
    force_on_platform_n: NDArray[np.float64]
    """Force on platform [N]."""
    lambda2: float | None
    """Lambda2."""
    limit_reached: str | None
    """Limit reached."""
    maximum_tension_n: float | None
    """Maximum tension [N]."""
    minimum_tension_n: float | None
    """Minimum tension [N]."""
    name: str
    """Name."""
    sag_ratio: float | None
    """Sag ratio."""
    string_frequency_hz: float | None
    """String frequency [Hz]."""
    tension_anchor_n: float
    """Tension anchor [N]."""
    tension_margin: float | None
    """Distance from the nearer limit, divided by the distance between the limits."""
    tension_margin_n: float | None
    """Distance from the nearer limit [N]."""
    tension_platform_n: float
    """Tension platform [N]."""
    unstrained_length_m: float
    """Unstrained length [m]."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "drive": DriveRow,
    }


class CentreRow(Row):
    """Proof that the tensions of the rule `centre` are the only ones."""

    convexity_min: float | None
    """Least convexity at sixteen tensions of each cable for which the bound is no proof, positive where it is convex;
    absent if the bound is a proof."""
    curvature: float
    """Bound of the curvature of the balance over that of the logarithms, and the value below which it is a proof."""
    curvature_cable: str
    """Name of the cable with this value."""
    max_curvature: float
    """Max curvature."""
    unique: bool
    """True if no other tensions are a centre."""


class EquilibriumRow(Row):
    """Another equilibrium of the same lengths."""

    distance_m: float
    """Distance from the first equilibrium [m]."""
    energy_j: float | None
    """Energy above the lowest equilibrium; absent if the loads have no potential [J]."""
    falling_directions: int
    """Number of directions in which the energy falls."""
    indifferent_directions: int
    """Number of directions in which the energy does not change."""
    pose: PoseRow
    """Pose of the platform."""
    stable: bool
    """Stable."""
    tensions_platform_n: NDArray[np.float64]
    """Tensions platform [N]."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "pose": PoseRow,
    }


class FreeMotionRow(Row):
    """Motion of the platform that no cable opposes by its tension: a rotation about an axis, or a translation."""

    held: bool | None
    """False if nothing holds the platform; absent for ideal cables."""
    point_m: NDArray[np.float64]
    """Point on the axis [m]."""
    rotation: NDArray[np.float64]
    """Axis of the rotation, unit vector; zero for a translation."""
    text: str
    """The motion in words."""
    translation_m: NDArray[np.float64]
    """Velocity of the platform origin, per radian with a rotation [m]."""


class FrictionCableRow(Row):
    """Tensions of a cable that friction permits."""

    excess_length_m: NDArray[np.float64]
    """Change of the unstrained length beyond the exit point [m]."""
    friction_exponent: float
    """Friction exponent of the cable's pulley; zero without friction."""
    name: str
    """Name."""
    tension_anchor_n: NDArray[np.float64]
    """Tension anchor [N]."""
    tension_drum_n: NDArray[np.float64]
    """Tension drum [N]."""
    tension_platform_n: NDArray[np.float64]
    """Tension platform [N]."""


class FrictionRow(Row):
    """Interval in which friction of pulleys leaves the robot. Every pair is minimum and maximum."""

    cables: list[FrictionCableRow]
    """Cables."""
    held: str
    """Quantity that is held: `lengths` or `pose`."""
    rotation_deg: NDArray[np.float64] | None
    """Components of the rotation vector [deg]."""
    translation_m: NDArray[np.float64] | None
    """Translation [m]."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "cables": FrictionCableRow,
    }


class HeldRow(Row):
    """Pose whose unstrained lengths are held, and the motion from there to the equilibrium."""

    angle_deg: float
    """Angle [deg]."""
    distance_m: float
    """Distance [m]."""
    pose: PoseRow
    """Pose of the platform."""
    translation_m: NDArray[np.float64]
    """Translation [m]."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "pose": PoseRow,
    }


class Search(Row):
    """Statistics of a search for all equilibria."""

    expected_index_sum: int | None
    """Expected index sum."""
    index_sum: int
    """Sum of (−1)^falling_directions over the equilibria that were found."""
    starts: int
    """Starts."""


class SupportRow(Row):
    """Flexible support at the equilibrium."""

    displacement_m: NDArray[np.float64]
    """Displacement of its anchors, world axes [m]."""
    force_n: NDArray[np.float64]
    """Force of its cables on it, world axes [N]."""
    name: str
    """Name."""


class Extreme(Row):
    """Largest or lowest number on a path."""

    cable: str
    """Cable."""
    no_bound: str | None
    """Reason why the number has no bound, with the place of the largest jump."""
    t_s: float
    """T [s]."""
    unit: str
    """Unit."""
    value: float | None
    """Largest beside the jumps where the number has no bound; absent where rates jump because tensions reach limits, or
    other conditions hold them, near which they change too fast for a number that does not depend on the rows."""
    what: str
    """Name of the number."""


class SlackCable(Row):
    """Cable that goes slack."""

    cable: str
    """Cable."""
    t_s: float
    """First time [s]."""


class LengthCommand(Row):
    """Tensions under a controller that commands lengths alone."""

    displacement_m: float
    """Largest distance of the platform from its path [m]."""
    lengths: str
    """`computed` with stretch and sag, or `geometric`: the straight distances at the pose."""
    lost_t_s: float | None
    """First time from which on the lengths hold the platform nowhere near; absent if they always do [s]."""
    lowest_cable: str
    """Lowest cable."""
    lowest_t_s: float
    """Lowest t [s]."""
    lowest_tension_n: float
    """Lowest tension [N]."""
    slack: list[SlackCable]
    """Cables that go slack, in the order of time."""
    told: str
    """Sentence with these numbers."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "slack": SlackCable,
    }


class LimitChange(Row):
    """Limit that a tension reaches or leaves."""

    cable: str
    """Cable."""
    limit: str
    """`minimum` or `maximum`."""
    reached: bool
    """True if the tension is at the limit afterwards."""
    t_s: float
    """T [s]."""


class MostUsed(Row):
    """Limit of which a motion uses the largest part."""

    cable: str | None
    """Cable."""
    limit: str
    """`maximum-tension`, `minimum-tension`, `speed`, `acceleration`, `torque`, `power`, `brake-power` or `clearance`."""
    part: float | None
    """Used over allowed; absent where nothing is allowed, and where a speed or an acceleration has no bound."""
    t_s: float
    """T [s]."""


class Nearest(Row):
    """Nearest pair on a path."""

    distance_m: float
    """Distance [m]."""
    pair: str
    """Pair."""
    required_m: float
    """Required [m]."""
    t_s: float
    """T [s]."""


class PathJump(Row):
    """Jump of lengths or of their rates where a derivative of the path jumps."""

    cable: str
    """Cable with the largest jump."""
    length_m: float | None
    """Jump of its length; absent if it is continuous [m]."""
    of: str
    """`acceleration` or `jerk` of the platform."""
    rate_m_s: float | None
    """Jump of its rate [m/s]."""
    t_s: float
    """T [s]."""


class QuasiStatic(Row):
    """Frequencies of the motion and of the cables."""

    cable_hz: float
    """Lowest frequency of a cable as a taut string between fixed ends, on the whole path [Hz]."""
    motion_hz: float
    """Frequency below which 95 % of the square of the acceleration lie [Hz]."""


class TrajectoryRow(Row):
    """Robot at one time of a path. Lists have a number per cable."""

    acceleration_m_s2: NDArray[np.float64]
    """Acceleration of the platform origin [m/s²]."""
    angular_acceleration_rad_s2: NDArray[np.float64]
    """Angular acceleration of the platform [rad/s²]."""
    angular_velocity_rad_s: NDArray[np.float64]
    """Angular velocity of the platform [rad/s]."""
    cable_speeds_m_s: NDArray[np.float64]
    """Speed of each cable at the drum, positive while it is paid out [m/s]."""
    clearance_margin_m: float | None
    """Distance of the nearest pair beyond the required one [m].

    Absent if the robot file says nothing about distances."""
    first_frequency_hz: float | None
    """First natural frequency [Hz].

    At rest under these tensions; absent for cables without sag."""
    length_accelerations_m_s2: NDArray[np.float64]
    """Acceleration of the unstrained length of each cable [m/s²]."""
    length_rates_m_s: NDArray[np.float64]
    """Rate of the unstrained length of each cable [m/s].

    Positive while it is paid out."""
    limit: str | None
    """Limit of which the largest part is used.

    Absent without limits."""
    limit_cable: str | None
    """Cable to which this limit belongs."""
    motor_powers_w: NDArray[np.float64] | None
    """Power of the motor of each cable, negative while it brakes [W].

    Empty without winches."""
    motor_torques_n_m: NDArray[np.float64] | None
    """Torque of the motor of each cable, positive while it winds in [N m].

    None without a radius of the drum. Empty without winches."""
    position_m: NDArray[np.float64]
    """Position of the platform origin [m]."""
    quaternion_wxyz: NDArray[np.float64]
    """Orientation as a quaternion w, x, y, z."""
    roll_pitch_yaw_deg: NDArray[np.float64]
    """Roll, pitch, yaw of the platform [deg]."""
    t_s: float
    """Time since the start of the path [s]."""
    tensions_anchor_n: NDArray[np.float64]
    """Tension of each cable at the anchor [N]."""
    tensions_platform_n: NDArray[np.float64]
    """Tension of each cable at the platform [N]."""
    unstrained_lengths_m: NDArray[np.float64]
    """Unstrained length of each cable [m]."""
    used_part: float | None
    """Used part of this limit, above 1 beyond it.

    Absent where nothing is allowed."""
    velocity_m_s: NDArray[np.float64]
    """Velocity of the platform origin [m/s]."""


class RuleJump(Row):
    """Jump of the rule of tensions."""

    cable: str
    """Cable with the largest jump of the tension."""
    length_m: float
    """Jump of the length of the cable whose length jumps most [m]."""
    t_s: float
    """T [s]."""
    tension_n: float
    """Tension [N]."""


class Stations(Row):
    """Error of lengths that change in straight lines between stations, where it is largest."""

    cable: str
    """Cable."""
    displacement_m: float | None
    """Distance of the platform from its path there; absent if the lengths hold it nowhere near [m]."""
    error_m: float
    """Largest error of a length; half way between two stations [m]."""
    interval_s: float
    """Time between two stations [s]."""
    lowest_tension_n: float | None
    """Lowest tension in any cable there [N]."""
    needed: int
    """Needed."""
    t_s: float
    """T [s]."""
    tolerance_m: float
    """Tolerance of a length, and number of stations that keeps it [m]."""


class PowerSums(Row):
    """Largest sums of powers, each with its time."""

    braking_power_w: float
    """Braking power [W]."""
    braking_t_s: float
    """Braking t [s]."""
    driving_power_w: float
    """Driving power [W]."""
    driving_t_s: float
    """Driving t [s]."""


class InputGroup(Row):
    """Numbers that one option makes deviate."""

    count: int
    """Count of parameters in the group."""
    name: str
    """Name."""


class UncertainInput(Row):
    """Number of the robot file that deviates."""

    deviation: float | None
    """Standard deviation.

    Absent if it changes from pose to pose."""
    distribution: str
    """Distribution.

    Distribution: `normal` or `uniform`."""
    group: int
    """Index of its group, from 0."""
    path: str
    """Path of the number."""
    tolerance: float | None
    """Half width of the tolerance.

    Absent for a normal distribution."""
    unit: str
    """Unit of the number."""
    value: float | None
    """Value; empty if it changes from pose to pose.

    Value; absent if it changes from pose to pose."""


class FailedSamples(Row):
    """Sampled robots without results."""

    count: int
    """Count."""
    reason: str
    """Reason."""


class PositionDeviation(Row):
    """Deviation of the position of the platform origin."""

    covariance_m2: NDArray[np.float64]
    """Covariance of the position, world axes [m²]."""
    deviation_m: float
    """Standard deviation along the direction in which it is largest [m]."""
    direction: NDArray[np.float64]
    """Direction of the largest deviation, world axes."""


class ShareOfInput(Row):
    """Share of a number in the variance of a result."""

    path: str
    """Path."""
    share: float
    """Share."""


class WorstCase(Row):
    """Worst case within the tolerances."""

    down: float | None
    """Change at the corner of the tolerances where the linear result is smallest. The true worst case is at least as far."""
    linear: float
    """Sum of the absolute linear changes over all tolerances: neither a lower nor an upper bound."""
    up: float | None
    """Change at the opposite corner, where the linear result is largest."""


class UncertainResult(Row):
    """Result with its deviation."""

    at_hz: float | None
    """Frequency of a response [Hz]."""
    deviation: float | None
    """Standard deviation; absent if too few sampled robots have the result."""
    group_shares: NDArray[np.float64] | None
    """Shares of the groups in the variance; of a sampled result total shares, which may add up to more than 1."""
    interval_95: NDArray[np.float64] | None
    """Interval that holds 95 % of the robots."""
    largest: list[ShareOfInput] | None
    """Largest linear shares of single numbers in the variance."""
    linear_deviation: float | None
    """Standard deviation by the gradient, also of a sampled result."""
    mean: float | None
    """Mean of the sampled robots."""
    measure: Any
    """Identity as data: `kind`, and the cable, mode or frequency to which the result belongs."""
    method: str
    """Method: `linear` or `sampled`."""
    name: str
    """Name, such as `frequency 3` or `tension of cable "2" at the anchor`."""
    sampling_reason: str | None
    """Reason for sampling. With the requested method `linear` it is the reason why the linear deviation is doubtful."""
    shares: NDArray[np.float64] | None
    """Linear shares of all numbers, in the order of `inputs`; for one pose only."""
    unit: str
    """Unit."""
    value: float
    """Value of the undisturbed robot."""
    worst: WorstCase | None
    """Worst case within the tolerances."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "largest": ShareOfInput,
        "worst": WorstCase,
    }


class PoseUncertainty(Row):
    """Results at one pose."""

    failed: FailedSamples | None
    """Number of sampled robots without results, with the first reason."""
    position: PositionDeviation | None
    """Deviation of the platform's position; absent if the pose is not among the results or does not deviate."""
    position_m: NDArray[np.float64] | None
    """Pose of the undisturbed robot; absent if it has no equilibrium [m]."""
    reason: str | None
    """Reason why there are no results."""
    results: list[UncertainResult]
    """Results."""
    roll_pitch_yaw_deg: NDArray[np.float64] | None
    """Roll pitch yaw [deg]."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "failed": FailedSamples,
        "position": PositionDeviation,
        "results": UncertainResult,
    }


class UncertainResponse(Row):
    """Frequency response whose magnitudes and phases are results."""

    input: str
    """Input."""
    output: str
    """Output."""
    unit: str
    """Unit; magnitudes are in decibels of it, phases in degrees."""


class ControlRun(Row):
    """ControlRun."""

    caught: bool
    """Caught."""
    comparisons: int
    """Comparisons."""
    excess: float | None
    """Excess."""
    failed: int
    """Failed."""
    id: str
    """Id."""
    proves: str
    """Proves."""
    worst: str
    """Worst."""
    wrong: str
    """Wrong."""


class LevelCount(Row):
    """LevelCount."""

    comparisons: int
    """Comparisons."""
    level: Any
    """Level."""
    numbers: int
    """Numbers."""
    sources: int
    """Sources."""


class Comparison(Row):
    """Comparison."""

    bounded_by: str
    """Bounded by."""
    case: str
    """Case."""
    difference: float
    """Difference."""
    id: str
    """Id."""
    kind: Any
    """Kind."""
    level: Any
    """Level."""
    numbers: int
    """Numbers."""
    ours: NDArray[np.float64]
    """Ours."""
    quantity: str
    """Quantity."""
    source: str
    """Source."""
    theirs: NDArray[np.float64]
    """Theirs."""
    tolerance: float
    """Tolerance."""


class Section(Row):
    """Section."""

    id: str
    """Id."""
    note: str
    """Note."""
    rows: list[Comparison]
    """Rows."""
    title: str
    """Title."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "rows": Comparison,
    }


class AskedRow(Row):
    """Largest value of a quantity, with what asks for it."""

    angular_velocity_rad_s: NDArray[np.float64] | None
    """Angular velocity [rad/s]."""
    cable: str
    """Cable."""
    force_n: NDArray[np.float64]
    """Required load in addition to the dead load, world axes [N]."""
    moment_n_m: NDArray[np.float64]
    """Moment [N m]."""
    pose: PoseRow
    """Pose of the platform."""
    quantity: str
    """`tension`, `speed`, `acceleration`, `torque`, `power` or `brake-power`."""
    unit: str
    """Unit of the value."""
    value: float
    """Value."""
    velocity_m_s: NDArray[np.float64] | None
    """Velocity of the platform; absent for a tension [m/s]."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "pose": PoseRow,
    }


class NotHeldRow(Row):
    """Pose at which a required load is not held."""

    pose: PoseRow
    """Pose of the platform."""
    reason: str
    """Reason."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "pose": PoseRow,
    }


class OfferRow(Row):
    """Winch on offer, compared with the winch that serves every cable."""

    by: str | None
    """quantity of this part."""
    fits: bool
    """true if it is enough for every cable, as far as it says what it gives."""
    name: str
    """name of the winch on offer."""
    used: float | None
    """largest needed part of what it gives, above 1 for a winch that is too small; absent if it says nothing."""


class WinchRow(Row):
    """Winch that is needed."""

    acceleration_m_s2: float
    """largest acceleration of the cable at the drum [m/s²]."""
    brake_power_w: float
    """largest mechanical power of the motor that brakes [W]."""
    layers: int | None
    """layers of rope on the drum, three spare turns included; absent without width and radius of the drum and diameter of
    the rope."""
    length_max_m: float
    """largest unstrained length [m]."""
    length_min_m: float
    """least unstrained length [m]."""
    name: str
    """name of the cable, or `every cable` for a winch that serves all."""
    power_w: float
    """largest mechanical power of the motor that drives [W]."""
    rope_m: float
    """rope that goes on and off the drum between the extreme lengths [m]."""
    speed_m_s: float
    """largest speed of the cable at the drum [m/s]."""
    tension_n: float
    """largest tension at the drum [N]."""
    torque_n_m: float | None
    """largest torque of the motor; absent without a radius of the drum [N m]."""


class ComparedSets(Row):
    """Volumes of two sets on one grid, and of what they share."""

    common_volume_m3: float
    """Common volume [m³]."""
    only_other_m3: float
    """Only other [m³]."""
    only_own_m3: float
    """Volume that only this robot reaches, and that only the other one reaches [m³]."""
    other: str
    """Name of the other robot."""
    other_volume_m3: float
    """Other volume [m³]."""


class ConditionRow(Row):
    """Condition of a workspace, for reading."""

    at_least: float | None
    """Least value that is allowed."""
    at_most: float | None
    """Greatest value that is allowed."""
    of: str
    """Column of the quantity; `tensions` if only their limits count."""


class GridOfWorkspace(Row):
    """Grid on which a set was found."""

    first_step_m: float
    """Largest step with which the set was searched at first: separate parts and holes that are smaller can be missed [m]."""
    lower_m: NDArray[np.float64]
    """Lower [m]."""
    step_m: NDArray[np.float64]
    """Step along each axis [m]."""
    upper_m: NDArray[np.float64]
    """Upper [m]."""
    vertex_tolerance_m: float
    """Vertex tolerance [m]."""


class PartOfWorkspace(Row):
    """Part of a set, or a hole in it."""

    handles: int
    """Handles."""
    volume_m3: float
    """Volume; that of a part includes its holes [m³]."""


class InnerBox(Row):
    """Box inside a set."""

    lower_m: NDArray[np.float64]
    """Lower [m]."""
    upper_m: NDArray[np.float64]
    """Upper [m]."""
    volume_m3: float
    """Volume [m³]."""


class AreaOfWorkspace(Row):
    """Set of a planar platform."""

    area_m2: float
    """Area [m²]."""
    at_m: float
    """At [m]."""
    axis: str
    """Axis at right angles to the plane, and coordinate of the plane."""
    holes: int
    """Holes."""
    parts: int
    """Numbers of parts that do not touch each other, and of holes."""


class Proved(Row):
    """Results of `prove`, or of the proof of a workspace."""

    boxes: list[BoxRow]
    """Boxes of the division."""
    end: str
    """Reason why the division ended: `complete`, `boxes`, `time`, `undecided` or `stopped`."""
    inside: float
    """Volume that is proved inside."""
    loads: int
    """Number of required loads of which all others are combinations."""
    margin_n: float | None
    """Least distance of a tension from its limits if the box is inside; the least wrench that is missing if it is outside
    [N]."""
    outside: float
    """Volume that is proved outside."""
    pose: PoseRow
    """Middle of the box, and the orientation of the statement."""
    reason: str | None
    """Reason why the whole box is undecided."""
    static_model: str
    """Static model."""
    tried: int
    """Number of boxes that were proved or tried."""
    undecided: float
    """Volume that is neither."""
    undecided_share: float
    """Undecided volume over the volume that is not proved outside."""
    verdict: str
    """`inside`, `outside` or `undecided` for the whole box, or `divided` if parts of it are decided differently."""
    volume_unit: str
    """Unit of the volumes: m³, or m², m if the box has no width along one or two axes."""
    whole: float
    """Volume of the box, in the unit that is given."""
    within_deg: NDArray[np.float64]
    """Largest turns about the axes of the world, which belong to the statement at every position [deg]."""
    within_m: NDArray[np.float64]
    """Half widths of the box of positions [m]."""
    worst: list[BoxRow]
    """Largest undecided boxes, with the reasons."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "boxes": BoxRow,
        "pose": PoseRow,
        "worst": BoxRow,
    }


class RaysOfWorkspace(Row):
    """Set along rays."""

    center_m: NDArray[np.float64]
    """Center [m]."""
    count: int
    """Count."""
    cut: int
    """Rays along which the set reaches the box."""
    directions: NDArray[np.float64]
    """Unit vector of every ray, and the distances from the centre between which it is in the set."""
    intervals_m: NDArray[np.float64]
    """Intervals [m]."""
    with_several_intervals: int
    """Rays with more than one interval: the set is not star-shaped from the centre."""


class SectionOfWorkspace(Row):
    """Section of a set."""

    area_m2: float
    """Area [m²]."""
    at_m: float
    """At [m]."""
    axis: str
    """Axis."""
    polygons_m: NDArray[np.float64]
    """Closed polygons: counterclockwise around the set, clockwise around holes [m]."""


class VolumeRow(Row):
    """Volume of the set with what it was found with."""

    area_m2: float | None
    """Area of its surface [m²]."""
    by: str
    """Grid, rays, or hull of rays.

    `grid`, `rays` (all intervals of all rays) or `hull of rays` (triangles between their first ends)."""
    centroid_m: NDArray[np.float64] | None
    """Centroid [m]."""
    handles: int | None
    """Number of handles of all surfaces, 1 for a ring.

    Number of handles of all surfaces: 0 for balls, 1 for a ring."""
    holes: int | None
    """Number of holes that the outside does not reach."""
    parts: int | None
    """Number of parts that do not touch each other."""
    rays: int | None
    """Number of rays."""
    step_m: float
    """Largest step of the grid, or between points of a ray [m]."""
    volume_error_m3: float | None
    """Largest expected error of the volume [m³].

    Largest error that the volume is expected to have, by what the steps and points between the nodes leave open."""
    volume_m3: float
    """Volume of the set [m³]."""


class CableResults(Results):
    """Results of `cable`."""

    axes: Axes
    """Axes of the cable."""
    cable_model: str
    """Cable model."""
    chord_m: float
    """Chord [m]."""
    clamped_frequencies_hz: NDArray[np.float64] | None
    """Undamped natural frequencies with both ends fixed; absent for cable models without them [Hz]."""
    frequency_hz: NDArray[np.float64]
    """Frequency [Hz]."""
    in_plane_only: bool
    """In plane only."""
    lambda2: float | None
    """Lambda2."""
    lengths_held: bool | None
    """True if the unstrained lengths of a pose are held; absent otherwise."""
    local: Local
    """Stiffness along the chord, coupling, normal in plane and out of plane [N/m]."""
    name: str
    """Name."""
    parallel_tension_n: float
    """Parallel tension [N]."""
    robot: str | None
    """Name of the robot; absent if there are several."""
    sag_ratio: float | None
    """Sag ratio."""
    static_model: str
    """Static model."""
    string_frequency_hz: float | None
    """String frequency [Hz]."""
    tension_rule: str | None
    """Rule that chose the tensions; absent if there was no choice."""
    warnings: list[str]
    """Sentences that the user should know before trusting the numbers."""
    world: NDArray[np.complex128]
    """3×3 stiffness in world axes at each frequency [N/m]."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "axes": Axes,
        "local": Local,
    }


class CalibrateResults(Results):
    """Results of `calibrate`."""

    accuracy: ToolAccuracy | None
    """Accuracy of the tool; absent if none was asked for, or if the readings do not tell it."""
    anchors: list[AnchorRow]
    """Anchors with their covariance."""
    arrivals: int
    """Number of starts that arrived at the best minimum."""
    chi2: float
    """Sum of the squares of the residuals, divided by the deviations of the data."""
    covariance: list[CovarianceRow] | None
    """Covariance of the numbers of the robot file, for `uncertainty`; none if the readings do not tell it."""
    data: int
    """Number of readings and measured coordinates."""
    degrees_of_freedom: int
    """Degrees of freedom."""
    determined: str
    """Sentence on what the readings determine."""
    distances: list[DistanceRow]
    """Distances."""
    fit: str
    """Sentence on the fit of the readings."""
    frame: str
    """Frame in words."""
    inner_total_m: float | None
    """Inner total [m]."""
    is_determined: bool
    """True if χ² is a parabola along the weakest combination and no combination is lost."""
    iterations: int
    """Iterations."""
    left_out: LeftOut | None
    """Number of candidates that were left out: no tensions within the limits, too near to a body, or out of reach."""
    length_std_m: float | None
    """Standard deviation of a reading, given or from the residuals [m]."""
    minima: list[MinimumRow] | None
    """Further minima that fit."""
    poses_needed: int | None
    """Least number of proposed poses that reaches the wanted deviation; absent if none was wanted or no number does."""
    proposals: list[ProposalRow] | None
    """Proposals."""
    residual_rms_m: float
    """Root mean square of the residuals of the readings [m]."""
    robot: str | None
    """Name of the robot; absent if there are several."""
    robot_file: str
    """Robot file with the calibrated anchors and attachments."""
    rows: list[ReadingRow]
    """Rows."""
    starts: int
    """Starts."""
    total_m: float | None
    """Root of the sum of the variances of the values, in the frame and with inner conditions [m]."""
    walk: Walk | None
    """Walk along the weakest combination, with everything else fitted again."""
    warnings: list[str]
    """Sentences that the user should know before trusting the numbers."""
    weak_combinations: list[WeakRow]
    """Weak combinations."""
    weakest_m: float | None
    """Largest deviation of a combination of values in the frame [m]."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "accuracy": ToolAccuracy,
        "anchors": AnchorRow,
        "covariance": CovarianceRow,
        "distances": DistanceRow,
        "left_out": LeftOut,
        "minima": MinimumRow,
        "proposals": ProposalRow,
        "rows": ReadingRow,
        "values": CalibratedValue,
        "walk": Walk,
        "weak_combinations": WeakRow,
    }


class CheckResults(Results):
    """Results of `check`."""

    cables: list[CheckedCable]
    """Cables."""
    clearance: CheckedClearance | None
    """Required distances; absent if the file gives none."""
    degrees_of_freedom: int
    """Degrees of freedom."""
    gravity_m_s2: NDArray[np.float64]
    """Gravity [m/s²]."""
    load: LoadRow | None
    """Load on the platform; absent if there is none."""
    materials: list[CheckedRope]
    """Materials."""
    notes: list[str] | None
    """Remarks on unusual values, which may be intended or a slip; absent if there are none."""
    obstacles: list[CheckedBody] | None
    """Bodies that stand in the world; absent if there are none."""
    platform: CheckedPlatform
    """Platform of a robot file."""
    platform_bodies: list[CheckedBody] | None
    """Bodies that move with the platform, in its frame; absent if there are none."""
    pose: CheckedPose | None
    """Pose of a robot file."""
    required: CheckedRequired | None
    """Required loads and velocities; absent if the file gives none."""
    required_loads: list[LoadRow] | None
    """Further required loads, of which any one may act; absent if there are none."""
    robot: str | None
    """Name of the robot; absent if there are several."""
    source: str
    """Source."""
    state: str
    """`lengths`, `pose` or `none`."""
    supports: list[CheckedSupport] | None
    """Flexible supports; absent on a rigid frame."""
    warnings: list[str]
    """Sentences that the user should know before trusting the numbers."""
    wind: WindRow | None
    """Wind."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "cables": CheckedCable,
        "clearance": CheckedClearance,
        "load": LoadRow,
        "materials": CheckedRope,
        "obstacles": CheckedBody,
        "platform": CheckedPlatform,
        "platform_bodies": CheckedBody,
        "pose": CheckedPose,
        "required": CheckedRequired,
        "required_loads": LoadRow,
        "supports": CheckedSupport,
        "wind": WindRow,
    }


class ClearanceResults(Results):
    """Results of `clearance`."""

    free: bool
    """True if no pair touches, and every one keeps its required distance."""
    move_to: PoseRow | None
    """End of the move; absent without one."""
    pairs: list[ClearanceRow]
    """All pairs, that with the least margin first."""
    pose: PoseRow
    """Pose of the platform."""
    robot: str | None
    """Name of the robot; absent if there are several."""
    static_model: str
    """Static model."""
    warnings: list[str]
    """Sentences that the user should know before trusting the numbers."""
    way: WayAround | None
    """Way to the end of the move on which every pair keeps its distance, if it was searched."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "move_to": PoseRow,
        "pairs": ClearanceRow,
        "pose": PoseRow,
        "way": WayAround,
    }


class CompareResults(Results):
    """Results of `compare`."""

    advice: AdviceRow
    """Recommendation: the simplest model that is good enough."""
    assembly: str
    """Assembly."""
    below_hz: float
    """Below [Hz]."""
    compared: NDArray[np.int64]
    """Indices of the compared modes in the list of the reference, from 0."""
    frozen_sag: FrozenSagRow | None
    """Reason why a model with static sag is worse than a spring; absent if it is not."""
    in_plane_only: bool
    """In plane only."""
    lengths_held: bool | None
    """True if the unstrained lengths of a pose are held; absent otherwise."""
    models: list[ModelRow]
    """Models."""
    platform_share: float | None
    """Minimum fraction of the kinetic energy in the platform for a compared mode; absent if all modes are compared."""
    reference: str
    """Reference."""
    robot: str | None
    """Name of the robot; absent if there are several."""
    static_model: str
    """Static model."""
    tension_rule: str | None
    """Rule that chose the tensions; absent if there was no choice."""
    tolerance: float
    """Tolerance."""
    warnings: list[str]
    """Sentences that the user should know before trusting the numbers."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "advice": AdviceRow,
        "frozen_sag": FrozenSagRow,
        "models": ModelRow,
    }


class DesignResults(Results):
    """Results of `design`."""

    after: float
    """Value of the goal with the chosen values."""
    assembly: str
    """Assembly."""
    band_sides: list[SidesTried] | None
    """Choices of the sides to which frequencies leave the band, if there were several."""
    before: float
    """Value of the goal with the values of the file."""
    cable_model: str
    """Cable model."""
    converged: bool
    """True if no step gains more than the tolerance."""
    demands: list[DemandRow] | None
    """Demands, each at the pose where it is met least."""
    ending: str
    """Reason for the end of the search, as a sentence."""
    evaluations: int
    """Number of evaluated robots, those of all choices of sides included."""
    exchanges: list[ExchangeRow] | None
    """Exchanges of attachments."""
    gains: list[ChangeGain]
    """Part of the gain of each entry of the changes."""
    goal: str
    """Name of the goal."""
    goal_means: str
    """Goal in words."""
    history: NDArray[np.float64]
    """Value of the goal after each iteration."""
    in_plane_only: bool
    """In plane only."""
    iterations: int
    """Iterations."""
    lengths_held: bool | None
    """True if the unstrained lengths of a pose are held; absent otherwise."""
    limits: list[str]
    """Sentences on what limits the result."""
    measure: Any
    """Identity of the number that improves, as `gradient` writes it."""
    poses: list[DesignPose]
    """Results at the poses."""
    robot: str | None
    """Name of the robot; absent if there are several."""
    robot_file: str
    """Robot file with the values."""
    ropes: list[RopeTried] | None
    """Ropes that were tried."""
    static_model: str
    """Static model."""
    tension_rule: str | None
    """Rule that chose the tensions; absent if there was no choice."""
    unit: str
    """Unit."""
    warnings: list[str]
    """Sentences that the user should know before trusting the numbers."""
    winches: str | None
    """Winches in vibration; absent if they are as in the robot file."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "band_sides": SidesTried,
        "demands": DemandRow,
        "exchanges": ExchangeRow,
        "gains": ChangeGain,
        "poses": DesignPose,
        "ropes": RopeTried,
        "values": ChosenValue,
    }


class EstimateResults(Results):
    """Results of `estimate`."""

    alarms: list[EstimateAlarm]
    """Alarms in the order of their times."""
    cable_errors: list[CableErrors]
    """Cable errors."""
    cables: list[str]
    """Names of the cables, in the order of all lists."""
    fit: str
    """Sentence on the fit of the readings."""
    log_rows: int
    """Number of rows of the log."""
    not_determined: list[str]
    """Sentences on numbers that these sensors do not determine."""
    robot: str | None
    """Name of the robot; absent if there are several."""
    rows: list[EstimateRow]
    """Rows."""
    sensors: list[SensorFit]
    """Sensors."""
    warnings: list[str]
    """Sentences that the user should know before trusting the numbers."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "alarms": EstimateAlarm,
        "cable_errors": CableErrors,
        "rows": EstimateRow,
        "sensors": SensorFit,
    }


class GradientResults(Results):
    """Results of `gradient`."""

    assembly: str
    """Assembly."""
    cable_model: str
    """Cable model."""
    held: str
    """Quantity that is held while a number changes: `lengths` or `pose`."""
    held_means: str
    """Sentence that says what is held, and by which rule the rest follows."""
    in_plane_only: bool
    """In plane only."""
    lengths_held: bool | None
    """True if the unstrained lengths of a pose are held; absent otherwise."""
    parameters: list[GradientParameter]
    """Numbers of the robot file; one column of `derivatives` each."""
    per: str
    """Unit of the derivatives: `unit`, `percent` or `tolerance`."""
    refused: list[RefusedResult] | None
    """Results without a gradient, each with the reason."""
    results: list[GradientResult]
    """Results; one row of `derivatives` each."""
    robot: str | None
    """Name of the robot; absent if there are several."""
    static_model: str
    """Static model."""
    tension_rule: str | None
    """Rule that chose the tensions; absent if there was no choice."""
    warnings: list[str]
    """Sentences that the user should know before trusting the numbers."""
    winches: str | None
    """Winches in vibration; absent if they are as in the robot file."""
    without_derivative: list[str] | None
    """Paths of numbers without derivatives, such as limits."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "parameters": GradientParameter,
        "refused": RefusedResult,
        "results": GradientResult,
    }


class GustResults(Results):
    """Results of `gust`."""

    assembly: str
    """Assembly."""
    below_hz: float
    """Below [Hz]."""
    cable_model: str
    """Cable model."""
    duration_s: float
    """Duration [s]."""
    frequency_hz: NDArray[np.float64]
    """Frequency [Hz]."""
    in_plane_only: bool
    """In plane only."""
    lengths_held: bool | None
    """True if the unstrained lengths of a pose are held; absent otherwise."""
    mean_wind_m_s: NDArray[np.float64]
    """Mean wind [m/s]."""
    modes: list[AirDamping]
    """Modes below the limit, with their damping in still air and by the mean wind."""
    outputs: list[GustRow]
    """Outputs."""
    robot: str | None
    """Name of the robot; absent if there are several."""
    static_model: str
    """Static model."""
    tension_rule: str | None
    """Rule that chose the tensions; absent if there was no choice."""
    turbulence: TurbulenceRow
    """Turbulence of the results."""
    warnings: list[str]
    """Sentences that the user should know before trusting the numbers."""
    winches: str | None
    """Winches in vibration; absent if they are as in the robot file."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "modes": AirDamping,
        "outputs": GustRow,
        "turbulence": TurbulenceRow,
    }


class IdentifyResults(Results):
    """Results of `identify`."""

    assignment: ModeAssignment | None
    """Assignment of frequencies without a number, unless responses were measured as well."""
    chi2: float
    """Sum of the squares of all residuals, those of priors included."""
    chi2_per_degree: float
    """Chi2 per degree."""
    converged: bool
    """True if the last search has ended at a minimum, and the starts have not ended apart."""
    correlations: NDArray[np.float64]
    """Correlations."""
    degrees_of_freedom: int
    """Degrees of freedom."""
    deviation_factor: float
    """Factor by which the deviations of the values were multiplied."""
    evaluations: int
    """Evaluations."""
    frequencies: list[FrequencyRow] | None
    """Frequencies."""
    frequency_rms: float | None
    """Root mean square of the relative differences of all natural frequencies."""
    frequency_rms_before: float | None
    """Root mean square before the fit, with the same modes as partners."""
    histories: list[HistoryOfPoles] | None
    """Time histories with the natural frequencies that were found in them."""
    measurements_needed: int | None
    """Least number of proposed measurements that reaches the wanted deviation; absent if none was wanted or no number
    does."""
    proposals: list[ProposedMeasurement] | None
    """Measurements to make next."""
    residuals: int
    """Residuals."""
    responses: list[FittedResponse] | None
    """Responses."""
    robot: str | None
    """Name of the robot; absent if there are several."""
    robot_file: str
    """Robot file with the values."""
    singular_values: NDArray[np.float64]
    """Singular values."""
    starts: list[StartRow]
    """Starts."""
    statics: list[StaticRow] | None
    """Statics."""
    strong_correlations: list[str]
    """Strong correlations."""
    verdict: str
    """Verdict."""
    warnings: list[str]
    """Sentences that the user should know before trusting the numbers."""
    weak_combinations: list[str]
    """Combinations of values that the measurements do not determine."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "assignment": ModeAssignment,
        "frequencies": FrequencyRow,
        "histories": HistoryOfPoles,
        "proposals": ProposedMeasurement,
        "responses": FittedResponse,
        "starts": StartRow,
        "statics": StaticRow,
        "values": ValueRow,
    }


class LoadsResults(Results):
    """Results of `loads`."""

    acceleration_max_m_s2: float | None
    """Largest acceleration in every direction from rest [m/s²]."""
    capacity_margin_n: float | None
    """Radius of the largest ball of loads that can be added to every required load, moments over the length of the
    platform [N]."""
    closure: bool
    """True if straight cables could balance every load with tensions that are high enough."""
    dead_load_held: bool
    """True if the dead load with the lightest payload is held within the limits."""
    dead_load_reason: str | None
    """Reason why the dead load is not held."""
    dof: int
    """Dof."""
    platform_length_m: float
    """Length by which moments are divided in the margin, and angular accelerations multiplied [m]."""
    pose: PoseRow
    """Pose of the platform."""
    rank: int
    """Number of independent wrenches of the cables, and the degrees of freedom."""
    required: RequiredHeld | None
    """Required loads and how much of them is held; absent if nothing is required or the dead load is not held."""
    robot: str | None
    """Name of the robot; absent if there are several."""
    static_model: str
    """Static model."""
    tension_factor: float
    """Tension factor."""
    warnings: list[str]
    """Sentences that the user should know before trusting the numbers."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "pose": PoseRow,
        "required": RequiredHeld,
    }


class ModesResults(Results):
    """Results of `modes`."""

    assembly: str
    """Assembly."""
    below_hz: float
    """Below [Hz]."""
    cable_model: str
    """Cable model."""
    cable_names: list[str]
    """Cable names."""
    certified: bool
    """Certified."""
    count_below: int
    """Count below."""
    damped_certified: bool | None
    """True if a count proves that every mode has its damped mode; absent if damping ratios are of first order."""
    decay_percent: float | None
    """Percentage of the amplitude to which modes decay in `decay_time_s`; absent for rigid cables [%]."""
    first_platform_mode: FirstPlatformMode | None
    """First mode of the platform; absent if none lies below the limit."""
    in_plane_only: bool
    """In plane only."""
    input: str | None
    """Input."""
    lengths_held: bool | None
    """True if the unstrained lengths of a pose are held; absent otherwise."""
    modes: list[ModeRow]
    """Modes."""
    output: str | None
    """Output."""
    peak_unit: str | None
    """Unit of `peak`."""
    platform_share: float
    """Minimum fraction of the kinetic energy in the platform for `first_platform_mode`."""
    robot: str | None
    """Name of the robot; absent if there are several."""
    share_platform: list[FirstPlatformMode] | None
    """Modes below it that move the platform considerably, with at least a fifth of their kinetic energy: a motion of the
    platform that is split beside a resonance of a cable."""
    static_model: str
    """Static model."""
    stations: list[StationsRow] | None
    """Stations."""
    support_names: list[str] | None
    """Names of the flexible supports; absent on a rigid frame."""
    tension_rule: str | None
    """Rule that chose the tensions; absent if there was no choice."""
    unstable_directions: int
    """Directions without a frequency, in which the equilibrium is unstable or indifferent."""
    warnings: list[str]
    """Sentences that the user should know before trusting the numbers."""
    winches: str | None
    """Winches in vibration; absent if they are as in the robot file."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "first_platform_mode": FirstPlatformMode,
        "modes": ModeRow,
        "share_platform": FirstPlatformMode,
        "stations": StationsRow,
    }


class ObservabilityResults(Results):
    """Results of `observability`."""

    best_addition: str | None
    """Addition that reduces the deviations of all numbers most, by the product of their ratios."""
    cases: list[ObservedCase]
    """Deviations with the encoders alone, with these sensors, and with each sensor or pose besides."""
    not_determined: list[str]
    """Sentences on numbers that these sensors do not determine."""
    numbers: list[ObservedNumber]
    """Numbers of the state with their deviations."""
    poses: int
    """Number of poses."""
    robot: str | None
    """Name of the robot; absent if there are several."""
    sensors: list[str]
    """Sensors besides the encoders of all cables."""
    warnings: list[str]
    """Sentences that the user should know before trusting the numbers."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "cases": ObservedCase,
        "numbers": ObservedNumber,
    }


class ParametersResults(Results):
    """Results of `parameters`."""

    parameters: list[ParameterRow]
    """Numbers in the order of the file's documentation: robot, platform, ropes, cables, load, wind, pose."""
    robot: str | None
    """Name of the robot; absent if there are several."""
    warnings: list[str]
    """Sentences that the user should know before trusting the numbers."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "parameters": ParameterRow,
    }


class PayloadResults(Results):
    """Results of `payload`."""

    mass_kg: float
    """Mass of the platform, without payload [kg]."""
    maximum: BoundRow | None
    """Maximum payload; absent if no maximum tension limits it."""
    minimum: BoundRow
    """Minimum payload; zero if the tensions without payload are within their limits."""
    payload_center_m: NDArray[np.float64]
    """Payload center [m]."""
    pose: PoseRow
    """Pose of the platform."""
    robot: str | None
    """Name of the robot; absent if there are several."""
    static_model: str
    """Static model."""
    warnings: list[str]
    """Sentences that the user should know before trusting the numbers."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "maximum": BoundRow,
        "minimum": BoundRow,
        "pose": PoseRow,
    }


class PoseErrorResults(Results):
    """Results of `pose-error`."""

    held: HeldPoseRow | None
    """Origin of the unstrained lengths; absent if they are given."""
    points: list[PoseErrorRow]
    """Points."""
    robot: str | None
    """Name of the robot; absent if there are several."""
    threshold: ThresholdRow | None
    """Minimum mass at which springs are good enough."""
    unstrained_length_m: NDArray[np.float64]
    """Unstrained lengths, the same at every mass [m]."""
    warnings: list[str]
    """Sentences that the user should know before trusting the numbers."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "held": HeldPoseRow,
        "points": PoseErrorRow,
        "threshold": ThresholdRow,
    }


class ProveResults(Results):
    """Results of `prove`."""

    boxes: list[BoxRow]
    """Boxes of the division."""
    end: str
    """Reason why the division ended: `complete`, `boxes`, `time`, `undecided` or `stopped`."""
    inside: float
    """Volume that is proved inside."""
    loads: int
    """Number of required loads of which all others are combinations."""
    margin_n: float | None
    """Least distance of a tension from its limits if the box is inside; the least wrench that is missing if it is outside
    [N]."""
    outside: float
    """Volume that is proved outside."""
    pose: PoseRow
    """Middle of the box, and the orientation of the statement."""
    reason: str | None
    """Reason why the whole box is undecided."""
    robot: str | None
    """Name of the robot; absent if there are several."""
    static_model: str
    """Static model."""
    tried: int
    """Number of boxes that were proved or tried."""
    undecided: float
    """Volume that is neither."""
    undecided_share: float
    """Undecided volume over the volume that is not proved outside."""
    verdict: str
    """`inside`, `outside` or `undecided` for the whole box, or `divided` if parts of it are decided differently."""
    volume_unit: str
    """Unit of the volumes: m³, or m², m if the box has no width along one or two axes."""
    warnings: list[str]
    """Sentences that the user should know before trusting the numbers."""
    whole: float
    """Volume of the box, in the unit that is given."""
    within_deg: NDArray[np.float64]
    """Largest turns about the axes of the world, which belong to the statement at every position [deg]."""
    within_m: NDArray[np.float64]
    """Half widths of the box of positions [m]."""
    worst: list[BoxRow]
    """Largest undecided boxes, with the reasons."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "boxes": BoxRow,
        "pose": PoseRow,
        "worst": BoxRow,
    }


class SettleResults(Results):
    """Results of `settle`."""

    assembly: str
    """Assembly."""
    below_hz: float
    """Below [Hz]."""
    cable_model: str
    """Cable model."""
    cables: list[str] | None
    """Names of the cables, in the order of the lengths; absent without samples."""
    command_kind: str | None
    """`stop`, `move` or `trajectory`."""
    damped_certified: bool
    """True if a count proves that every mode has its damped mode."""
    duration_s: float | None
    """Time from its start to its end, with the shaper [s]."""
    during: list[HistoryRow] | None
    """Motion while the command runs, at negative times."""
    held_exact_m: NDArray[np.float64] | None
    """Displacement between the equilibria with the wrench and without it; absent if there is none with it, and with ideal
    cables [m]."""
    held_m: NDArray[np.float64] | None
    """Displacement of the point under the wrench, linear, world axes [m]."""
    history: list[HistoryRow]
    """Motion from the release or the end of the command on."""
    history_up_to_hz: float | None
    """Frequency up to which modes are in the history; absent if all are [Hz]."""
    in_plane_only: bool
    """In plane only."""
    lengths: list[LengthsRow] | None
    """Lengths over time, if they are requested."""
    lengths_held: bool | None
    """True if the unstrained lengths of a pose are held; absent otherwise."""
    lowest_tension: LowestTension | None
    """Lowest tension of a cable during a command and after it, or after a release."""
    modes: list[SettlingMode]
    """Modes that take part, the largest amplitude first."""
    never_settles: NeverSettles | None
    """Motion that never ends, because nothing damps it; absent if the point settles."""
    omitted_m: float | None
    """Bound of what the modes above the limit add to the displacement at the release [m]."""
    omitted_tension_n: float | None
    """Bound of the change of the tension of a cable, averaged along it, by the modes above the limit; absent if none is
    known [N]."""
    payloads: list[WithPayload] | None
    """Vibration that the commanded lengths leave with payloads, if they are requested."""
    peak_m: float
    """Maximum distance of the point from its rest in the history [m]."""
    robot: str | None
    """Name of the robot; absent if there are several."""
    settled_s: float | None
    """Last time at which the point is at the tolerance, since the release or the end of the command; absent if it never
    settles [s]."""
    shaping: Shaping | None
    """Shaper and what it does."""
    static_model: str
    """Static model."""
    surely_settled_s: float | None
    """Time from which on the sum of all amplitudes is within the tolerance; absent if it never is [s]."""
    tension_rule: str | None
    """Rule that chose the tensions; absent if there was no choice."""
    tolerance_m: float
    """Tolerance [m]."""
    warnings: list[str]
    """Sentences that the user should know before trusting the numbers."""
    winches: str | None
    """Winches in vibration; absent if they are as in the robot file."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "during": HistoryRow,
        "history": HistoryRow,
        "lengths": LengthsRow,
        "lowest_tension": LowestTension,
        "modes": SettlingMode,
        "never_settles": NeverSettles,
        "payloads": WithPayload,
        "shaping": Shaping,
    }


class SimulateResults(Results):
    """Results of `simulate`."""

    below: list[BelowRow] | None
    """Parts of the robot that are behind the surface of a half space, such as below a floor, in some rows; nothing stops
    them. Absent if there are none."""
    cables: list[str]
    """Names of the cables, in the order of all lists."""
    cuts: list[CutRow]
    """Cables that failed."""
    degree: int
    """Degree."""
    duration_s: float
    """Duration [s]."""
    elements: int
    """Elements."""
    energy_defect_j: float
    """Largest error of the energy balance [J]."""
    errors: list[ColumnError] | None
    """Bound of the error of each column, from its difference from a finer run; absent without one."""
    is_statistical: bool
    """True if slack ropes with mass make the history depend on the mesh, so that its peaks are statistics."""
    lengths_held: bool | None
    """True if the unstrained lengths of a pose are held; absent otherwise."""
    nearest: NearestRow | None
    """Time at which the parts of the robot are nearest; absent if its file says nothing about distances."""
    peaks: list[Peak]
    """Largest tensions, and root mean squares, of this run and of the finer one."""
    points: list[str] | None
    """Names of the chosen points, in the order of all lists."""
    robot: str | None
    """Name of the robot; absent if there are several."""
    rows: list[SimulatedRow]
    """Rows."""
    slack: list[SlackRow]
    """Cables that were slack, with the time at which their tension first fell below 0.5 N."""
    steps: StepNumbers
    """StepNumbers of a run."""
    stopped_at_s: float | None
    """Time at which the run was stopped from outside; absent if it came to its end [s]."""
    stretch_losses: list[StretchLossRow] | None
    """Loss of the stretch in each mode of the platform at the start; absent without a loss factor."""
    tension_rule: str | None
    """Rule that chose the tensions; absent if there was no choice."""
    tolerance_m: float
    """Tolerance [m]."""
    warnings: list[str]
    """Sentences that the user should know before trusting the numbers."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "below": BelowRow,
        "cuts": CutRow,
        "errors": ColumnError,
        "nearest": NearestRow,
        "peaks": Peak,
        "rows": SimulatedRow,
        "slack": SlackRow,
        "steps": StepNumbers,
        "stretch_losses": StretchLossRow,
    }


class SpeedsResults(Results):
    """Results of `speeds`."""

    cables: list[CableSpeeds]
    """Cables."""
    directions: list[DirectionRow]
    """Largest speeds along the coordinates of the platform: axes of the world, and turns about them."""
    every_direction: LargestSpeed
    """Largest speed of the platform origin in every direction without turning [m/s]."""
    lengths_held: bool | None
    """True if the unstrained lengths of a pose are held; absent otherwise."""
    pose: PoseRow
    """Pose of the platform."""
    required: RequiredSpeeds | None
    """Work of the winches for the required velocities; absent if none is required."""
    robot: str | None
    """Name of the robot; absent if there are several."""
    static_model: str
    """Static model."""
    tension_rule: str | None
    """Rule that chose the tensions; absent if there was no choice."""
    warnings: list[str]
    """Sentences that the user should know before trusting the numbers."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "cables": CableSpeeds,
        "directions": DirectionRow,
        "every_direction": LargestSpeed,
        "pose": PoseRow,
        "required": RequiredSpeeds,
    }


class StaticsResults(Results):
    """Results of `statics`."""

    another_stable_equilibrium: OtherStable | None
    """Another stable equilibrium, if a short search found one."""
    cables: list[CableRow]
    """Cables."""
    centre: CentreRow | None
    """Proof that the tensions of the rule `centre` are the only ones; absent for other rules."""
    equilibria: list[EquilibriumRow] | None
    """All equilibria that the search of `all` found, with the lowest energy first."""
    free_motions: list[FreeMotionRow] | None
    """Motions that no cable opposes by its tension; absent unless the directions of the cables are dependent or the
    equilibrium is indifferent."""
    friction_interval: FrictionRow | None
    """Interval in which friction of pulleys leaves the robot; absent unless requested."""
    held: HeldRow | None
    """Motion from the pose whose lengths are held to the equilibrium; absent if no lengths are held."""
    iterations: int
    """Iterations."""
    load: LoadRow | None
    """Load on the platform; absent if there is none."""
    mass_kg: float
    """Mass [kg]."""
    nearest_pose_distance_m: float | None
    """Distance from the requested pose; present only with fewer cables than degrees of freedom and a requested pose [m]."""
    pose: PoseRow
    """Pose of the platform."""
    residual: float
    """Residual."""
    robot: str | None
    """Name of the robot; absent if there are several."""
    search: Search | None
    """Statistics of a search for all equilibria."""
    stable: bool | None
    """True for a stable equilibrium; absent for ideal cables, which are rigid."""
    static_model: str
    """Static model."""
    stiffness_min_n_per_m: float | None
    """Stiffness min [N/m]."""
    supports: list[SupportRow] | None
    """Flexible supports; absent on a rigid frame."""
    tension_rule: str | None
    """Tension rule; absent if there was no choice of tensions."""
    warnings: list[str]
    """Sentences that the user should know before trusting the numbers."""
    wind: WindRow | None
    """Wind; absent in still air."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "another_stable_equilibrium": OtherStable,
        "cables": CableRow,
        "centre": CentreRow,
        "equilibria": EquilibriumRow,
        "free_motions": FreeMotionRow,
        "friction_interval": FrictionRow,
        "held": HeldRow,
        "load": LoadRow,
        "pose": PoseRow,
        "search": Search,
        "supports": SupportRow,
        "wind": WindRow,
    }


class StiffnessResults(Results):
    """Results of `stiffness`."""

    antisymmetric_fraction: float | None
    """Norm of the antisymmetric part divided by the norm of the matrix; absent if the matrix is symmetric by theory."""
    assembly: str
    """Assembly."""
    cable_model: str
    """Cable model."""
    frequency_hz: float
    """Frequency [Hz]."""
    imag: NDArray[np.float64]
    """Imag."""
    in_plane_only: bool
    """In plane only."""
    lengths_held: bool | None
    """True if the unstrained lengths of a pose are held; absent otherwise."""
    real: NDArray[np.float64]
    """Real."""
    robot: str | None
    """Name of the robot; absent if there are several."""
    static_model: str
    """Static model."""
    tension_rule: str | None
    """Rule that chose the tensions; absent if there was no choice."""
    warnings: list[str]
    """Sentences that the user should know before trusting the numbers."""
    winches: str | None
    """Winches in vibration; absent if they are as in the robot file."""


class TrajectoryResults(Results):
    """Results of `trajectory`."""

    cables: list[str]
    """Names of the cables, in the order of all lists."""
    duration_s: float
    """Duration [s]."""
    extremes: list[Extreme]
    """Largest and lowest numbers on the path, with cable and time."""
    inertia_factor: float | None
    """Smallest factor with which the inertia is the largest one that any tensions within their limits hold; absent where
    the cables leave no choice of tensions."""
    length_commands: list[LengthCommand] | None
    """Tensions under a controller that commands lengths alone, with computed and with geometric lengths; absent for a
    robot with as many cables as degrees of freedom."""
    lengths_held: bool | None
    """True if the unstrained lengths of a pose are held; absent otherwise."""
    limit_changes: list[LimitChange]
    """Times at which a tension reaches a limit or leaves it: the rates of all lengths jump there."""
    misses_m: NDArray[np.float64] | None
    """Distances at which the path passes the poses on its way; absent without such poses [m]."""
    most_used: MostUsed | None
    """Limit of which the largest part is used; absent if the robot file has none. All of a minimum tension is used where
    the rule holds a cable there by its choice."""
    nearest: Nearest | None
    """Nearest pair on the path; absent if the robot file says nothing about distances."""
    notes: list[str]
    """Sentences that explain the largest numbers."""
    path_jumps: list[PathJump]
    """Times at which a derivative of the path jumps, and with it lengths or their rates."""
    quasi_static: QuasiStatic | None
    """Frequencies of the motion and of the cables."""
    robot: str | None
    """Name of the robot; absent if there are several."""
    rows: list[TrajectoryRow]
    """Rows."""
    rule_jumps: list[RuleJump]
    """Times at which the rule of tensions goes over to other tensions, and with them the lengths."""
    static_model: str
    """Static model."""
    stations: Stations | None
    """Controller with straight lines between its stations; absent if no length bends."""
    sums: PowerSums | None
    """Largest sums over all winches of the powers that drive and that brake; absent without winches."""
    tension_rule: str | None
    """Rule that chose the tensions; absent if there was no choice."""
    used: list[MostUsed]
    """Largest used part of every kind of limit: of a maximum tension T/T_max, of a minimum tension T_min/T."""
    warnings: list[str]
    """Sentences that the user should know before trusting the numbers."""
    within_limits: bool
    """True if every limit of tensions, winches and distances is kept on the whole path."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "extremes": Extreme,
        "length_commands": LengthCommand,
        "limit_changes": LimitChange,
        "most_used": MostUsed,
        "nearest": Nearest,
        "path_jumps": PathJump,
        "quasi_static": QuasiStatic,
        "rows": TrajectoryRow,
        "rule_jumps": RuleJump,
        "stations": Stations,
        "sums": PowerSums,
        "used": MostUsed,
    }


class UncertaintyResults(Results):
    """Results of `uncertainty`."""

    assembly: str
    """Assembly."""
    cable_model: str
    """Cable model."""
    evaluations: int
    """Number of robots that were computed for the samples and the corners of the tolerances."""
    groups: list[InputGroup]
    """Groups of numbers, one per option."""
    held: str
    """Quantity that is held while the numbers deviate: `lengths` or `pose`."""
    held_means: str
    """Sentence that says what is held, and by which rule the rest follows."""
    in_plane_only: bool
    """In plane only."""
    inputs: list[UncertainInput]
    """Numbers that deviate."""
    lengths_held: bool | None
    """True if the unstrained lengths of a pose are held; absent otherwise."""
    notes: list[str]
    """Notes on the accuracy."""
    poses: list[PoseUncertainty]
    """Results at each pose."""
    response: UncertainResponse | None
    """Frequency response among the results."""
    robot: str | None
    """Name of the robot; absent if there are several."""
    samples: int
    """Number of sampled robots per pose that needs them."""
    static_model: str
    """Static model."""
    tension_rule: str | None
    """Rule that chose the tensions; absent if there was no choice."""
    warnings: list[str]
    """Sentences that the user should know before trusting the numbers."""
    winches: str | None
    """Winches in vibration; absent if they are as in the robot file."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "groups": InputGroup,
        "inputs": UncertainInput,
        "poses": PoseUncertainty,
        "response": UncertainResponse,
    }


class ValidateResults(Results):
    """Results of `validate`."""

    comparisons: int
    """Comparisons."""
    controls: list[ControlRun]
    """Controls."""
    levels: list[LevelCount]
    """Levels."""
    numbers: int
    """Numbers."""
    passed: int
    """Passed."""
    robot: str | None
    """Name of the robot; absent if there are several."""
    sections: list[Section]
    """Sections."""
    sources: int
    """Sources."""
    warnings: list[str]
    """Sentences that the user should know before trusting the numbers."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "controls": ControlRun,
        "levels": LevelCount,
        "sections": Section,
    }


class WinchesResults(Results):
    """Results of `winches`."""

    asked: list[AskedRow]
    """Winch that serves every cable: what asks for each of its numbers."""
    held: int
    """Number of poses at which every required load is held; the others ask for no winch."""
    not_held: NotHeldRow | None
    """First pose at which a required load is not held."""
    offers: list[OfferRow] | None
    """Winches on offer; absent without offers."""
    poses: int
    """Number of poses."""
    robot: str | None
    """Name of the robot; absent if there are several."""
    static_model: str
    """Static model."""
    warnings: list[str]
    """Sentences that the user should know before trusting the numbers."""
    winches: list[WinchRow]
    """Winch that serves every cable, then that of each cable."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "asked": AskedRow,
        "not_held": NotHeldRow,
        "offers": OfferRow,
        "winches": WinchRow,
    }


class WorkspaceResults(Results):
    """Results of `workspace`."""

    bounds_m: NDArray[np.float64]
    """Smallest box around the set [m]."""
    compared: ComparedSets | None
    """Comparison with another robot."""
    complete: bool
    """True if everything was found: otherwise the work was stopped before the steps were as small as requested, or before
    the vertices had their places."""
    conditions: list[ConditionRow]
    """Conditions."""
    cut_area_m2: float
    """Area in which the faces of the box cut the set [m²]."""
    evaluations: int
    """Number of positions that were evaluated."""
    grid: GridOfWorkspace
    """Grid on which a set was found."""
    holes: list[PartOfWorkspace]
    """Holes."""
    inner_box: InnerBox | None
    """Largest box whose nodes are all in the set."""
    orientations: str
    """Orientations."""
    parts: list[PartOfWorkspace]
    """Parts that do not touch each other, and holes, the largest first."""
    plane: AreaOfWorkspace | None
    """Plane of a planar platform, in which the set is an area; absent in space. Volumes are those of a slab of 1 m."""
    proof: Proved | None
    """Proof in which parts of the box required loads are held."""
    rays: RaysOfWorkspace | None
    """Set along rays."""
    robot: str | None
    """Name of the robot; absent if there are several."""
    roll_pitch_yaw_deg: NDArray[np.float64]
    """Roll, pitch and yaw of every orientation, and which of them have to be possible: `all` or `some` [deg]."""
    sections: list[SectionOfWorkspace]
    """Sections."""
    static_model: str
    """Static model."""
    touches: list[str]
    """Faces of the box up to which the set reaches: it may go on behind them."""
    triangles: NDArray[np.int64]
    """Triangles."""
    triangles_of_surface: int
    """Number of triangles on the surface of the set; those after them lie on the faces of the box."""
    vertices_m: NDArray[np.float64]
    """Closed surface: vertices, and triangles by the numbers of their vertices from 0, counterclockwise from outside [m]."""
    volumes: list[VolumeRow]
    """Volumes: with the steps of the grid, with two and four of them as one, and along rays."""
    warnings: list[str]
    """Sentences that the user should know before trusting the numbers."""

    _PARTS: ClassVar[dict[str, type[Row]]] = {
        "compared": ComparedSets,
        "conditions": ConditionRow,
        "grid": GridOfWorkspace,
        "holes": PartOfWorkspace,
        "inner_box": InnerBox,
        "parts": PartOfWorkspace,
        "plane": AreaOfWorkspace,
        "proof": Proved,
        "rays": RaysOfWorkspace,
        "sections": SectionOfWorkspace,
        "volumes": VolumeRow,
    }


# Class of the results of each command.
OF_COMMANDS.update(
    {
        "cable": CableResults,
        "calibrate": CalibrateResults,
        "check": CheckResults,
        "clearance": ClearanceResults,
        "compare": CompareResults,
        "design": DesignResults,
        "estimate": EstimateResults,
        "gradient": GradientResults,
        "gust": GustResults,
        "identify": IdentifyResults,
        "loads": LoadsResults,
        "modes": ModesResults,
        "observability": ObservabilityResults,
        "parameters": ParametersResults,
        "payload": PayloadResults,
        "pose-error": PoseErrorResults,
        "prove": ProveResults,
        "settle": SettleResults,
        "simulate": SimulateResults,
        "speeds": SpeedsResults,
        "statics": StaticsResults,
        "stiffness": StiffnessResults,
        "trajectory": TrajectoryResults,
        "uncertainty": UncertaintyResults,
        "validate": ValidateResults,
        "winches": WinchesResults,
        "workspace": WorkspaceResults,
    }
)
