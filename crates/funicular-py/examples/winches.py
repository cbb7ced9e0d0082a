"""Control of a platform by the lengths of its cables, with the motors' own control in the model (docs/control.md)."""

import control
import funicular
import numpy as np
from matplotlib import pyplot
from style import ROBOTS, save

# CoGiRo with a position control in every winch: its motors yield and damp the platform.
servo = 'gear_ratio = 3\ncontrol = "position"\nbandwidth_hz = 5\ncontrol_damping_ratio = 0.7\n'
text = (ROBOTS / "cogiro-winches.toml").read_text(encoding="utf-8").replace("gear_ratio = 3\n", servo)
rest = funicular.Robot.from_toml(text).equilibrium()

# One command lifts the platform: every cable is shortened by its component of a vertical motion.
lengths = [f"length:{name}" for name in rest.robot.cable_names]
pull = rest.force_on_platform_n
lift = -pull[:, 2:] / np.linalg.norm(pull, axis=1, keepdims=True)
model = rest.state_space(lengths, ["z", "vz"], below_hz=6, tolerance=0.03)
robot = control.ss(model.A, model.B @ lift, model.C, model.D @ lift)

# u = 4/s ∫(z_ref − z) dt − 0.1 s vz: an integral, and damping by the measured velocity.
law = control.ss([[0]], [[1, 0]], [[4]], [[0, 0.1]])
closed = control.feedback(robot * law, np.eye(2))[0, 0]
assert closed.poles().real.max() < 0

figure, (left, right) = pyplot.subplots(1, 2, figsize=(7, 2.6), layout="constrained")
hz = np.linspace(0.05, 6, 600)
full = (rest.frf(hz, lengths, ["z", "vz"]) * lift[:, 0, None]).sum(axis=1)
of_law = control.frequency_response(law, 2 * np.pi * hz).complex[0]
full_closed = full[0] * of_law[0] / (1 + full[0] * of_law[0] + full[1] * of_law[1])
for response, system, label in (
    (full[0], robot[0, 0], "command of the winches"),
    (full_closed, closed, "with feedback"),
):
    left.semilogy(hz, abs(response), color="0.7", linewidth=3)
    left.semilogy(hz, abs(control.frequency_response(system, 2 * np.pi * hz).complex), label=label)
left.set(xlabel="frequency [Hz]", ylabel="|z| per command [m/m]")
left.legend()

time = np.linspace(0, 4, 2000)
for system, label in ((robot[0, 0], "command of the winches"), (closed, "with feedback")):
    right.plot(time, 10 * control.step_response(system, time).outputs, label=label)
right.set(xlabel="time [s]", ylabel="z after a step of 10 mm [mm]")
right.legend()
save(figure, "winches")
