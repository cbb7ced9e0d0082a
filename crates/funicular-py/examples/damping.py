"""Damping of a platform by state feedback, designed on a state space of few states (docs/control.md)."""

import control
import funicular
import numpy as np
from matplotlib import pyplot
from style import save

rest = funicular.Robot.example().equilibrium()
model = rest.state_space(["fz"], ["z"], below_hz=5, order=10)
robot = model.to_control()
gain, _, _ = control.lqr(robot, model.C.T @ model.C, [[2e-9]])
closed = control.ss(model.A - model.B @ gain, model.B, model.C - model.D @ gain, model.D)

figure, (left, right) = pyplot.subplots(1, 2, figsize=(7, 2.6), layout="constrained")
hz = np.unique(np.concatenate([np.linspace(0.1, 5, 800), model.frequency_hz[model.frequency_hz < 5]]))
left.semilogy(hz, abs(rest.frf(hz, "fz", "z")), color="0.7", linewidth=3, label="full model")
left.semilogy(hz, abs(control.frequency_response(robot, 2 * np.pi * hz).complex), label=f"{model.order} states")
left.semilogy(hz, abs(control.frequency_response(closed, 2 * np.pi * hz).complex), label="with feedback")
left.set(xlabel="frequency [Hz]", ylabel="|z / fz| [m/N]")
left.legend()

time = np.linspace(0, 12, 3000)
for system, label in ((robot, "without feedback"), (closed, "with feedback")):
    right.plot(time, 1000 * control.step_response(system, time).outputs, label=label)
right.set(xlabel="time [s]", ylabel="z after a step of 1 N [mm]")
right.legend()
save(figure, "damping")
