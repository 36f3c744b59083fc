"""EMPS: an electro-mechanical positioning system, one axis with a ball screw.

    M v̇ = g u - F_v v - f_c sign v + f_0            u [V] -> x [m]; g = 35.15 N/V is known

The files are DATA_EMPS.mat and DATA_EMPS_PULSES.mat (1 kHz), every tenth sample is kept. The first
half of the first record is fitted; its second half and the record with pulses confirm.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
from scipy.io import loadmat

from identification import Log, decimate
from robots import needed
from robots.emps_evidence import protocol, published_errors
from robots.measured_robot import PROJECT_MODELS, Free, MeasuredRobot, PublishedModel, PublishedSize

MODEL = PROJECT_MODELS / "emps.xml"
EVERY = 10  # samples of 1 ms
SOURCE = "Janot, Gautier, Brunot 2019, nonlinearbenchmark.org"
FREE = (
    Free(name="M", path="body/carriage.mass", value=95.11, known=0.3, unit="kg"),
    Free(name="F_v", path="joint/slide.damping", value=203.5, known=0.3, unit="N s/m"),
    Free(name="coulomb_friction.f_c@slide", value=20.39, known=0.3, unit="N"),
    Free(name="offset.f_0@slide", value=3.16, known=5.0, unit="N", scale=1.0),
)
PUBLISHED = tuple(
    PublishedSize(name=n, value=v, unit=u, source=SOURCE)
    for n, v, u in (
        ("M", 95.11, "kg"), ("F_v", 203.5, "N s/m"), ("coulomb_friction.f_c@slide", 20.39, "N"),
        ("offset.f_0@slide", 3.16, "N"),  # ours pushes: theirs is -3.16
        ("asymmetric_viscous_friction.d_a@slide", 0.5 * (166.7 - 240.4), "N s/m"),
    )
)  # fmt: skip


def read_record(path: Path, every: int = EVERY) -> Log:
    """A record with every n-th sample; the voltage between them as straight lines."""
    data = loadmat(needed(path))
    log = Log(
        time=np.arange(len(data["qm"]), dtype=float) * 1e-3, inputs=data["vir"], outputs=data["qm"],
        input_names=("drive",), output_names=("position",),
        units={"drive": "V", "position": "m"}, name=path.stem,
    )  # fmt: skip
    return decimate(log, every)


def read(data: Path) -> MeasuredRobot:
    """The axis from the folder of all data."""
    log, pulses = (read_record(data / "emps" / f"DATA_EMPS{s}.mat") for s in ("", "_PULSES"))
    first, second = _halves(log)
    return MeasuredRobot(
        name="emps", title="EMPS, one axis with a ball screw", source=SOURCE, model=MODEL,
        free=FREE, horizon=0.2, fit=(first,), confirm=(second, pulses),
        second=((second,), (first, pulses)),
        expected=("asymmetric_viscous_friction",), published=PUBLISHED,
        models=(PublishedModel(name="their values, symmetric friction", source=SOURCE,
                               errors=partial(published_errors, MODEL)),),
        evidence=lambda outcome: protocol(MODEL, log, pulses, outcome),
    )  # fmt: skip


def _halves(log: Log) -> tuple[Log, Log]:
    """The halves of a log, each a record of its own whose time begins at 0 s."""
    n = len(log) // 2
    halves = []
    for rows, what in ((slice(0, n), "first half"), (slice(n, None), "second half")):
        halves.append(
            replace(
                log, time=log.time[rows] - log.time[rows][0], inputs=log.inputs[rows],
                outputs=log.outputs[rows], name=f"{log.name}, {what}",
            )
        )  # fmt: skip
    return halves[0], halves[1]
