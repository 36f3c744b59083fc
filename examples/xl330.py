"""A real motor: a Dynamixel XL330 that swings 0.49 kg on an arm of 0.1 m; what does it lack?

    (m l² + J_a) ẇ = g u - D w - f_c tanh(w/v₀) + f_0 - m 9.81 l sin q      u = duty x supply [V]

g = K_t/R, and D holds the back-EMF K_t K_e/R: u and q alone do not tell it from viscous friction.
The 16 records are those of github.com/Rhoban/bam: 4 trajectories, each under 4 gains k_p. What was
asked with gains of 100 and 400 is fitted; 200 and 800 are only predicted.
Run it: python examples/xl330.py FOLDER [--figure FILE.png]
"""

import argparse
import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np

from identification import Log, Parameter
from identification.discovery.discover import discover
from identification.discovery.extend import Base
from identification.estimate_windows import estimate_windows
from identification.irregular import on_a_grid
from identification.joints.axes import axes
from identification.joints.plant import JointPlant, candidates, joint_plant
from identification.window_error import window_error

MODEL = Path(__file__).parents[1] / "models" / "xl330.xml"
F_C, F_0 = "coulomb_friction.f_c@hinge", "offset.f_0@hinge"
RECORDS = (
    Parameter("g", 0.1, "N m/V", "actuator/motor.gear[0]", lower=0.0),
    Parameter("D", 0.05, "N m s/rad", "joint/hinge.damping", lower=0.0),
    Parameter("J_a", 0.005, "kg m^2", "joint/hinge.armature", lower=0.0),
    Parameter(F_C, 0.05, "N m", "effect", lower=0.0, about="Coulomb level"),
    Parameter(F_0, 0.0, "N m", "effect", scale=0.01, about="an encoder off by f_0/m 9.81 l"),
    Parameter("q_0", 0.0, "rad", "qpos[0]", scale=1e-2),
    Parameter("w_0", 0.0, "rad/s", "qvel[0]", scale=1e-1),
)
NAMES = tuple(p.name for p in RECORDS[:5])
KNOWN = np.array([0.3, 0.3, 0.3, 0.5, 0.02, 0.02, 0.5])  # 30 %, 50 %, and what rest may hide
MORE = (  # one effect each, and where its fit begins: the authors' M3 and M2
    {"load_dependent_friction.mu@hinge": 0.1},
    {"stribeck_friction.f_s@hinge": 0.02, "stribeck_friction.v_s": 1.0},
)
FITTED, HELD = (100, 400), (200, 800)  # k_p
STEP, WIDEST = 0.01, 0.02  # of the grid, and a gap that is still bridged [s]
HORIZON = 0.2  # of predictions [s]
FULL = 885  # a load of 100 %
LONG = 400  # samples that a discovery needs


def read_xl330(path: Path, step: float = STEP) -> Log:
    """One record while its torque is on, on an even grid, straight lines between samples.

    When it is off, the bridge may be open: u is then not 0 V, and the back-EMF has no current.
    """
    raw = json.loads(Path(path).read_text(encoding="utf-8"))
    on = [entry for entry in raw["entries"] if entry["torque_enable"]]
    time, angle, load, volts = (
        np.array([entry[key] for entry in on], float)
        for key in ("timestamp", "position", "load", "input_volts")
    )
    duty = np.where(load > 2**15 - 1, load - 2**16, load) / FULL
    t, on_grid = on_a_grid(time, {"motor": duty * volts, "angle": angle}, step, WIDEST)
    return Log(
        t, on_grid["motor"][:, None], on_grid["angle"][:, None], ("motor",), ("angle",),
        units={"motor": "V", "angle": "rad"}, name=f"{raw['trajectory']}, k_p {raw['kp']}",
        hold="foh",
    )  # fmt: skip


def read_all(folder: Path, gains: Sequence[int]) -> list[Log]:
    """The records of some gains."""
    logs = [read_xl330(path) for path in sorted(folder.glob("*.json"))]
    return [log for log in logs if int(log.name.split()[-1]) in gains]


def joined(logs: Sequence[Log], length: float = HORIZON) -> Log:
    """Records one after the other, each cut to whole windows: a fit over windows sees no seam."""
    n = round(length / logs[0].sampling_time)
    ends = [len(log) // n * n for log in logs]
    u = np.concatenate([log.inputs[:end] for log, end in zip(logs, ends, strict=True)])
    y = np.concatenate([log.outputs[:end] for log, end in zip(logs, ends, strict=True)])
    time = logs[0].sampling_time * np.arange(len(u))
    return replace(logs[0], time=time, inputs=u, outputs=y, name="all that is fitted")


def xl330_plant(fastest: Log) -> JointPlant:
    """The plant; v₀ is 1 % of the top speed of one record, so that values hold for all."""
    joints = axes(mujoco.MjModel.from_xml_path(str(MODEL)), fastest)
    return joint_plant(MODEL, RECORDS, fastest, joints=joints)


def main(folder: Path, figure: Path | None) -> None:
    """Fit, discover on each record, fit with one effect more, predict the other gains."""
    fitted, held = (read_all(folder, gains) for gains in (FITTED, HELD))
    plant = xl330_plant(fitted[-1])  # the faster and faster sine under the higher gain
    every = joined(fitted)
    fit = estimate_windows(plant, every, NAMES, HORIZON, tolerance=1e-3)
    show(fit)

    free = tuple(p.name for p in RECORDS)
    for log in fitted:
        if len(log) > LONG:
            base = Base(plant.with_values(fit.values), free, KNOWN, HORIZON)
            found = discover(base, log, candidates(plant, free))
            named = [n.candidate.effect.name for n in found.named]
            first = [f"{s.candidate.effect.name} {s.gain:.0f}" for s in found.scores[:3]]
            print(f"{log.name}: {found.verdict} {named}, first {first}", flush=True)

    more, without = [], errors(plant, held, fit.values)
    for start in MORE:
        names = (*NAMES, *start)
        e = estimate_windows(plant, every, names, HORIZON, {**fit.values, **start}, tolerance=1e-3)
        more.append((e, errors(plant, held, e.values)))
        print({n: f"{e.values[n]:.4g}" for n in start}, "fitted:",
              change([fit.residual.ravel()], [e.residual.ravel()]),
              "| held out:", change(without, more[-1][1]), flush=True)  # fmt: skip
    best, with_it = min(more, key=lambda pair: pair[0].rms)  # the held records choose nothing
    show(best)
    for log, a, b in zip(held, without, with_it, strict=True):
        print(f"{log.name}:", change([a], [b]))
    for length in (0.1, 0.5):
        a, b = (errors(plant, held, e.values, length) for e in (fit, best))
        print(f"held out over {length} s:", change(a, b), flush=True)
    if figure:
        draw(figure, plant, held[-1], [fit.values, best.values])


def show(fit):
    """Print estimates."""
    print({n: f"{v:.4g} ± {s:.2g}" for (n, v), s in zip(fit.values.items(), fit.std, strict=True)})


def errors(plant, logs, values, length=HORIZON):
    """In windows whose starts are free, of each record [rad]."""
    return [window_error(plant, log, length, values).ravel() for log in logs]


def rms(each):
    """Over all records."""
    return float(np.sqrt(np.mean(np.concatenate(each) ** 2)))


def change(without, with_it):
    """Errors of two fits, in words."""
    a, b = rms(without), rms(with_it)
    return f"{1e3 * a:.2f} -> {1e3 * b:.2f} mrad, mean square {100 * (b**2 / a**2 - 1):+.0f} %"


def draw(path, plant, log, sets):
    """A record, and what it is predicted to be over windows with two sets of values."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.5, 4.5), layout="constrained")
    FigureCanvasAgg(figure)
    top, low = figure.subplots(2, sharex=True)
    errors = [window_error(plant, log, HORIZON, values)[..., 0] for values in sets]
    n = round(HORIZON / log.sampling_time)
    t = log.time[: errors[0].size].reshape(-1, n)
    y = log.outputs[: errors[0].size, 0].reshape(-1, n)
    top.plot(log.time, log.outputs[:, 0], "k", lw=2.5, alpha=0.3, label="measured")
    gap = np.full((len(t), 1), np.nan)  # between windows
    for error, color, label in zip(errors, ("C3", "C0"), ("without", "with"), strict=True):
        for axis, line in ((top, y - error), (low, 1e3 * error)):
            axis.plot(np.hstack([t, gap]).ravel(), np.hstack([line, gap]).ravel(), color, lw=1,
                      label=label)  # fmt: skip
    top.set(ylabel="angle [rad]", title=f"{log.name}: predicted over {HORIZON} s, not fitted")
    low.set(ylabel="error [mrad]", xlabel="time [s]")
    top.legend(loc="upper left", fontsize=8)
    figure.savefig(path, dpi=90)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path, nargs="?", default=Path("data/xl330/raw"))
    parser.add_argument("--figure", type=Path)
    given = parser.parse_args()
    if any(given.folder.glob("*.json")):
        main(given.folder, given.figure)
    else:
        print(f"{given.folder} has no records; get them from github.com/Rhoban/bam, and say where")
