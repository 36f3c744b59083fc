"""A real motor: a Dynamixel XL330 that swings 0.49 kg on an arm of 0.1 m; what does it lack?

    (m l² + J_a) ẇ = g u - D w - f_c tanh(w/v₀) + f_0 - m 9.81 l sin q      u = duty x supply [V]

g = K_t/R, and D holds the back-EMF K_t K_e/R: u and q alone do not tell it from viscous friction.
The 16 records are those of github.com/Rhoban/bam: 4 trajectories, each under 4 gains k_p. What was
asked with gains of 100 and 400 is fitted; 200 and 800 are only predicted.
Run it: python examples/xl330.py FOLDER [--figure FILE.png]
"""

import argparse
from pathlib import Path

import mujoco
import numpy as np
from xl330_log import read_all

from identification import (
    JointPlant,
    Log,
    NominalModel,
    Parameter,
    axes,
    candidates,
    discover,
    estimate_windows,
    joined,
    joint_plant,
    save_png,
    window_error,
    windows_figure,
)

MODEL = Path(__file__).parents[1] / "models" / "xl330.xml"
F_C, F_0 = "coulomb_friction.f_c@hinge", "offset.f_0@hinge"
RECORDS = (
    Parameter(name="g", value=0.1, unit="N m/V", where="actuator/motor.gear[0]", lower=0.0),
    Parameter(name="D", value=0.05, unit="N m s/rad", where="joint/hinge.damping", lower=0.0),
    Parameter(name="J_a", value=0.005, unit="kg m^2", where="joint/hinge.armature", lower=0.0),
    Parameter(name=F_C, value=0.05, unit="N m", where="effect", lower=0.0, about="Coulomb level"),
    Parameter(
        name=F_0,
        value=0.0,
        unit="N m",
        where="effect",
        scale=0.01,
        about="an encoder off by f_0/m 9.81 l",
    ),
    Parameter(name="q_0", value=0.0, unit="rad", where="qpos[0]", scale=1e-2),
    Parameter(name="w_0", value=0.0, unit="rad/s", where="qvel[0]", scale=1e-1),
)
NAMES = tuple(p.name for p in RECORDS[:5])
KNOWN = np.array([0.3, 0.3, 0.3, 0.5, 0.02, 0.02, 0.5])  # 30 %, 50 %, and what rest may hide
MORE = (  # one effect each, and where its fit begins: the authors' M3 and M2
    {"load_dependent_friction.mu@hinge": 0.1},
    {"stribeck_friction.f_s@hinge": 0.02, "stribeck_friction.v_s": 1.0},
)
FITTED, HELD = (100, 400), (200, 800)  # k_p
HORIZON = 0.2  # of predictions [s]
LONG = 400  # samples that a discovery needs


def xl330_plant(fastest: Log) -> JointPlant:
    """The plant; v₀ is 1 % of the top speed of one record, so that values hold for all."""
    joints = axes(mujoco.MjModel.from_xml_path(str(MODEL)), fastest)
    return joint_plant(MODEL, RECORDS, fastest, joints=joints)


def main(folder: Path, figure: Path | None) -> None:
    """Fit, discover on each record, fit with one effect more, predict the other gains."""
    fitted, held = (read_all(folder, gains) for gains in (FITTED, HELD))
    plant = xl330_plant(fitted[-1])  # the faster and faster sine under the higher gain
    every = joined(fitted, HORIZON, "all that is fitted")
    fit = estimate_windows(plant, every, NAMES, HORIZON, tolerance=1e-3)
    show(fit)

    free = tuple(p.name for p in RECORDS)
    for log in fitted:
        if len(log) > LONG:
            nominal_model = NominalModel(plant.with_values(fit.values), free, KNOWN, HORIZON)
            found = discover(nominal_model, log, candidates(plant, free))
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
        sets = {"without": fit.values, "with": best.values}
        save_png(windows_figure(plant, held[-1], HORIZON, sets), figure, dpi=100)


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


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path, nargs="?", default=Path("data/xl330/raw"))
    parser.add_argument("--figure", type=Path)
    given = parser.parse_args()
    if any(given.folder.glob("*.json")):
        main(given.folder, given.figure)
    else:
        print(f"{given.folder} has no records; get them from github.com/Rhoban/bam, and say where")
