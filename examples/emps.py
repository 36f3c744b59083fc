"""Another robot than INCA: EMPS, a real axis with a ball screw; what do its published values lack?

    M v̇ = g u - F_v v - f_c tanh(v/v₀) + f_0           u [V] -> v̇; g is known

The data are DATA_EMPS.mat and DATA_EMPS_PULSES.mat of Janot, Gautier, Brunot (2019); see
nonlinearbenchmark.org.
Run it: python examples/emps.py FOLDER [FIGURE.png]
"""

import sys
from pathlib import Path

import numpy as np
from scipy.io import loadmat

from identification import (
    Log,
    NominalModel,
    Parameter,
    Predictor,
    candidates,
    decimate,
    describe_rejected,
    discover,
    estimate,
    estimate_windows,
    joint_plant,
    save_png,
    window_error,
    windows_figure,
)

MODEL = Path(__file__).parents[1] / "models" / "emps.xml"
F_C, F_0 = "coulomb_friction.f_c@slide", "offset.f_0@slide"
PUBLISHED = {"M": 95.11, "F_v": 203.5, F_C: 20.39, F_0: 3.16}  # ours pushes: theirs is -3.16
START = {"M": 70.0, "F_v": 150.0, F_C: 30.0, F_0: 0.1}  # where the fit begins
RECORDS = (
    Parameter(name="M", value=95.11, unit="kg", where="body/carriage.mass", lower=0.0),
    Parameter(name="F_v", value=203.5, unit="N s/m", where="joint/slide.damping", lower=0.0),
    Parameter(name=F_C, value=20.39, unit="N", where="effect", lower=0.0, about="Coulomb level"),
    Parameter(name=F_0, value=3.16, unit="N", where="effect", about="constant force"),
    Parameter(name="x_0", value=0.0, unit="m", where="qpos[0]", scale=1e-3),
    Parameter(name="v_0", value=0.0, unit="m/s", where="qvel[0]", scale=1e-2),
)
KNOWN = np.array([0.3, 0.3, 0.3, 5.0, 1.0, 1.0])  # 30 %, 5 N, and for the start 1 mm, 10 mm/s
EVERY = 10  # samples of 1 ms
SHOWN = 5.0  # of the figure [s]
HORIZON = 0.2  # of predictions [s]: an axis integrates what disturbs it, and a free run drifts


def read_emps(path, every=EVERY):
    """A log of EMPS with every n-th sample, the voltage between them as straight lines."""
    data = loadmat(path)
    names = {"input_names": ("drive",), "output_names": ("position",)}
    time = np.arange(len(data["qm"])) * 1e-3
    units = {"drive": "V", "position": "m"}
    log = Log(
        time=time,
        inputs=data["vir"],
        outputs=data["qm"],
        **names,
        units=units,
        name=Path(path).stem,
    )
    return decimate(log, every)


def main(folder, figure=None):
    """Fit, discover, confirm on the other record."""
    log, pulses = (read_emps(folder / f"DATA_EMPS{s}.mat") for s in ("", "_PULSES"))
    plant = joint_plant(MODEL, RECORDS, log)
    fit = estimate_windows(plant, log, tuple(START), HORIZON, START)
    for (name, value), std in zip(fit.values.items(), fit.std, strict=True):
        print(f"{name:28} {value:7.2f} ± {std:.2f}, published {PUBLISHED[name]:7.2f}"
              f" ({100 * (value / PUBLISHED[name] - 1):+.1f} %)")  # fmt: skip

    free = tuple(p.name for p in RECORDS)
    found = discover(NominalModel(plant, free, KNOWN, HORIZON), log, candidates(plant, free), print)
    print(found.verdict, "| unexplained:", found.unexplained)
    for named in found.named:
        print(named.candidate.effect.name, named.parameters, f"confidence {named.confidence:.2f}")
    print(*describe_rejected(found))

    more = {n: v for n, v in found.final.point.values.items() if n not in free}  # its sizes
    best = estimate_windows(plant, log, (*START, *more), HORIZON, {**fit.values, **more})
    print({name: round(value, 2) for name, value in best.values.items()})
    for name, record in (("DATA_EMPS", log), ("PULSES, to which nothing was fitted", pulses)):
        for length in (0.1, 0.2, 0.5):
            a, b = (mean_square(plant, record, length, e.values) for e in (fit, best))
            print(f"{name}, {length} s windows: rms {1e6 * a**0.5:.1f} -> {1e6 * b**0.5:.1f} µm,"
                  f" mean square {100 * (b / a - 1):+.0f} %")  # fmt: skip
        a, b = (free_run(plant, record, e.values, e.states) for e in (fit, best))
        print(f"{name}, free run of {record.duration:.0f} s: rms {a:.4f} -> {b:.4f} m")

    if figure:
        models = {"published laws": fit.values, f"and {', '.join(more) or 'nothing'}": best.values}
        part = pulses.between(0.0, SHOWN)
        save_png(windows_figure(plant, part, HORIZON, models), figure, dpi=100)
    for sizes in ({}, more):  # as the published table: fitted by the free run of one record
        whole = estimate(plant, log, (*free, *sizes), sizes)
        values = {n: v for n, v in whole.values.items() if n not in ("x_0", "v_0")}
        print(f"fitted by its free run, {', '.join(sizes) or 'nominal'}: rms on PULSES"
              f" {1e3 * free_run(plant, pulses, values):.2f} mm")  # fmt: skip


def mean_square(plant, log, length, values):
    """Of the error in windows whose starts are free [m^2]."""
    return np.mean(window_error(plant, log, length, values) ** 2)


def free_run(plant, log, values, states=None):
    """Rms error of the whole record [m], begun as its first window or at its first sample."""
    x, v = (log.outputs[0, 0], 0.0) if states is None else (states.qpos[0, 0], states.qvel[0, 0])
    y = Predictor(plant, log, (), {**values, "x_0": x, "v_0": v}).predict(np.empty((1, 0)))[0]
    return np.sqrt(np.mean((log.outputs - y) ** 2))


if __name__ == "__main__":
    where = Path(sys.argv[1] if len(sys.argv) > 1 else "data/emps")
    if (where / "DATA_EMPS.mat").exists():
        main(where, *sys.argv[2:3])
    else:
        print(f"{where} has no DATA_EMPS.mat; get it from nonlinearbenchmark.org and say where")
