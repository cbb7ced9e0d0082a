"""Results of Yuan, Courteille and Deblaise 2014: pose error of simpler static models over the load, and the influence
of cable dynamics on a frequency response."""

import funicular
from matplotlib import pyplot
from style import ROBOTS, save

figure, (left, right) = pyplot.subplots(1, 2, figsize=(6.9, 2.5), layout="constrained")

for millimetres, line in ((4, "-"), (8, "--")):
    robot = funicular.Robot.from_file(ROBOTS / f"yuan2014-{millimetres}mm.toml")
    rows = robot.sweep({"platform.mass_kg": (10.55, 86.35, 39)}, ["pose-error"], pose=[0, 0, 0.5])
    for colour, (column, label) in enumerate(
        {
            "catenary_from_ideal_distance_m": "ideal cables",
            "spring_from_catenary_distance_m": "springs",
        }.items()
    ):
        left.semilogy(
            rows["platform.mass_kg"], 1e3 * rows[column], line, color=f"C{colour}", label=f"{label}, {millimetres} mm"
        )
left.set(xlabel="platform mass [kg]", ylabel="pose error [mm]")
left.legend(ncols=2, loc="lower center", bbox_to_anchor=(0.5, 1))

# Fig. 7: acceleration along y per force along z. The paper gives neither point: both are the attachment of cable 3 here.
test = funicular.Robot.from_file(ROBOTS / "yuan2014-dynamic-test.toml")
point = [0.136, 0.05, 0.0]
for label, model in (("dynamic stiffness", "shallow-dynamic"), ("massless springs", "spring")):
    hz, response = test.equilibrium().frf(
        [0.3, 10],
        input="fz",
        output="ay",
        input_point_m=point,
        output_point_m=point,
        cable_model=model,
        assembly="without-geometric-stiffness",
        in_plane_only=True,
        adaptive=True,
    )
    right.semilogy(hz, abs(response), label=label, linewidth=0.9)
# Springs have no damping: their peaks have no bound.
right.set(xlabel="frequency [Hz]", ylabel="$|a_y/f_z|$ [1/kg]", xlim=(0.3, 10), ylim=(1e-6, 1e3))
right.legend(loc="lower right")
save(figure, "paper")
