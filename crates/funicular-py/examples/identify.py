"""Mass, centre of mass and modulus of the rope from two noisy responses of a robot that differs from its file."""

import warnings

import funicular
import numpy as np
from matplotlib import pyplot
from style import ROBOTS, save

# With 2 % of damping in the ropes, 150 lines show nearly every peak, and the search ends at its first start.
damping = {"materials.rope-4mm.damping_ratio": 0.02}
nominal = funicular.Robot.from_file(ROBOTS / "yuan2014-4mm.toml").with_(damping)
# The measurement: responses of a robot with other values, and 2 % of noise.
truth = {"platform.mass_kg": 11.1, "platform.center_of_mass_m.x": 0.012, "materials.rope-4mm.youngs_modulus_pa": 2.2e10}
hz = np.geomspace(0.6, 4, 150)
points = {"input_point_m": [0.03, -0.02, 0.05], "output_point_m": [0.1, 0.08, 0.02]}
random = np.random.default_rng(2014)
# A measurement has the lines of its analyser, narrow peaks or not.
warnings.simplefilter("ignore", funicular.ResponseWarning)


def measured(output: str) -> dict:
    exact = nominal.with_(truth).frf(hz, "fz", output, **points)
    noise = random.normal(size=(2, hz.size)) * 0.02 * abs(exact) / np.sqrt(2)
    response = exact + noise[0] + 1j * noise[1]
    return {"input": "fz", "output": output, "frequency_hz": hz, "real": response.real, "imag": response.imag, **points}


responses = [measured(output) for output in ("az", "ax")]
found = nominal.identify(list(truth), {"responses": responses})
for path, value, deviation in zip(found.names, found.x, found.deviations, strict=True):
    print(f"{path}: {value:.5g} ± {deviation:.2g}, true {truth[path]:.5g}")

figure, axes = pyplot.subplots(2, figsize=(3.4, 3.6), sharex=True, layout="constrained")
for ax, response in zip(axes, responses, strict=True):
    signals = hz, response["input"], response["output"]
    ax.semilogy(hz, abs(response["real"] + 1j * response["imag"]), ".", color="0.6", markersize=2, label="measured")
    ax.semilogy(hz, abs(nominal.frf(*signals, **points)), ":", label="file")
    ax.semilogy(hz, abs(found.robot.frf(*signals, **points)), label="fitted")
    ax.set(ylabel=f"{response['output']}/{response['input']} [1/kg]")
axes[0].legend(ncols=3)
axes[1].set(xlabel="frequency [Hz]")
save(figure, "identify")
