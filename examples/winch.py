"""A winch of a real cable robot lifts and lowers 1 and 5 kg: gravity, friction, cogging.

    J ω̇ = K_t (i - i_c(q)) - m g r - f_c tanh(ω/v₀) - d ω          i [A] -> q; K_t is believed

First the balance of strokes at constant speed (`winch_strokes`), then what a fit over windows and
a discovery make of the same records. The data are lifting/ and dynamic_torque/ of
eliasoa/TTK4900_CDPR (NTNU).
Run it: python examples/winch.py FOLDER [--figure FILE]
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from winch_strokes import (
    RADIUS,
    STROKES,
    G,
    balance,
    draw,
    mass_and_motor,
    read_winch,
    ripple,
    stroke,
    waves,
    without_load,
)  # fmt: skip

from identification import (
    Log,
    NominalModel,
    Parameter,
    axes,
    candidates,
    describe_finding,
    discover,
    drives,
    estimate_windows,
    input_effects,
    joint_effects,
    joint_plant,
    on_a_grid,
    read_model,
)

MODEL = Path(__file__).parents[1] / "models" / "winch.xml"
ROTOR = 3e-4  # [kg m^2], a guess for an outrunner of this size; the load has m r^2
STEP, WIDEST = 0.03, 0.8  # of the grid, and gap bridged [s]: samples come every 24 to 32 ms
HORIZON = 1.0  # of predictions [s]
F_C, F_0 = "coulomb_friction.f_c@drum", "offset.f_0@drum"
# Up, a stop at the top, down: a record, where it begins, what is fitted, where it ends [s].
LOGS = (
    ("5kg/ODrive2/Down1", 12.6, 37.9, 44), ("5kg/ODrive0/Down1", 3, 24.4, 30.5),
    ("1kg/ODrive2/Down25", 5.9, 12.4, 19),
)  # fmt: skip


def winch_log(folder, record, wave=None):
    """A log of angle and current on an even grid, less i_c where its `wave` is given."""
    t, q, _, i = read_winch(folder, record)
    i = i if wave is None else i - waves(q) @ wave
    time, on = on_a_grid(t, {"angle": q, "motor": i}, STEP, WIDEST)
    time = time + t[np.isfinite(q) & np.isfinite(i)].min()
    names = {"input_names": ("motor",), "output_names": ("angle",)}
    units = {"motor": "A", "angle": "rad"}
    u, y = on["motor"][:, None], on["angle"][:, None]
    return Log(time=time, inputs=u, outputs=y, **names, units=units, name=record, hold="foh")


def records(mass, angle=0.0, rate=0.0):
    """What is free; the inertia is that of the load and a guess for the rotor."""
    return (
        Parameter(
            name="J",
            value=mass * RADIUS**2 + ROTOR,
            unit="kg m^2",
            where="joint/drum.armature",
            lower=0.0,
        ),
        Parameter(name="d", value=4e-4, unit="N m s/rad", where="joint/drum.damping", lower=0.0),
        Parameter(name=F_C, value=0.05, unit="N m", where="effect", lower=0.0),
        Parameter(name=F_0, value=-mass * G * RADIUS, unit="N m", where="effect", about="-m g r"),
        Parameter(name="q_0", value=angle, unit="rad", where="qpos[0]", scale=1e-3),
        Parameter(name="v_0", value=rate, unit="rad/s", where="qvel[0]", scale=1e-2),
    )


def winch_plant(log, mass):
    """The model with its candidates."""
    y = log.outputs[:, 0]
    known = axes(read_model(MODEL).compile(), log)
    effects = (*joint_effects(known), *input_effects(drives(log)))
    own = records(mass, y[0], (y[5] - y[0]) / (5 * log.sampling_time))
    return joint_plant(MODEL, own, log, effects=effects)


def explain(log, mass):
    """Fit over windows, on all and on the part that discovery fits; discover."""
    plant = winch_plant(log, mass)
    for part in (log, log.part("estimation")):
        fit = estimate_windows(plant, part, (F_C, F_0), HORIZON)
        f_c, f_0 = (f"{1e3 * v:.1f} ± {1e3 * s:.1f} mN m"
                    for v, s in zip(fit.values.values(), fit.std, strict=True))  # fmt: skip
        print(f"  {part.name}: f_c {f_c}, f_0 {f_0}, rms {fit.rms:.2f} rad")
    free = tuple(p.name for p in records(mass))
    known = np.array([0.5, 1.0, 0.5, 0.2, 0.1, 1.0])  # J, d, f_c relative; N m, rad, rad/s
    nominal_model = NominalModel(plant.with_values(fit.values), free, known, HORIZON)
    found = discover(nominal_model, log, candidates(plant, free))
    best = found.scores[0]
    print(f"  {found.verdict}; first score: {best.candidate.effect.name}, {best.gain:.0f}")
    for finding in found.findings:
        print("    left:", describe_finding(finding))
    for named in found.named:
        print("   ", named.candidate.effect.name, named.parameters, f"{named.confidence:.2f}")


def main(folder, figure=None):
    """Balance, ripple, fit over windows, discovery."""
    lifting = folder / "lifting"
    strokes = [stroke(lifting, *s) for s in STROKES]
    amperes = balance(strokes)
    without_load(folder)
    wave = {motor: ripple(strokes, motor) for motor in (2, 0)}
    if figure:
        draw(strokes, wave[2], amperes, figure)
    for record, begin, middle, end in LOGS:
        mass, motor = mass_and_motor(record)
        for less, words in ((None, "as logged"), (wave[motor], "less i_c")):
            log = winch_log(lifting, record, less).between(begin, end)
            splits = {"estimation": (begin, middle), "validation": (middle, end)}
            print(f"{record}, {words}")
            explain(replace(log, splits=splits), mass)


if __name__ == "__main__":
    where = Path(sys.argv[1] if len(sys.argv) > 1 else "data/ttk4900")
    if (where / "lifting").exists() and (where / "dynamic_torque").exists():
        main(where, sys.argv[3] if sys.argv[2:3] == ["--figure"] else None)
    else:
        print(f"{where} lacks lifting or dynamic_torque: see github.com/eliasoa/TTK4900_CDPR")
