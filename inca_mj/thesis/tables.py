"""The thesis' tables with a column of ours beside its printed ones."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from identification.estimation.fit import Fit
from identification.report.page.page import Table
from inca_mj.robot.parameters import parameter_set
from inca_mj.thesis.prints import FITS, NAMES, TABLES, PrintedTable
from inca_mj.thesis.trials import TrialResult
from inca_mj.twin.twin import Twin

FIXED = "fixed"


def parameter_table(number: str, name: str) -> Table:
    """Returns Table 2.1 or 3.2: the printed value of each parameter, and ours in SI units."""
    printed, known = TABLES[number], parameter_set(name)
    values = known.values()
    rows = []
    for row in printed.rows:
        names = NAMES.get(row[1], row[1]).split()
        rows.append((*row, _joined(values, names), known[names[0]].unit))
    return Table((*printed.columns, "here, in SI units", "unit"), tuple(rows))


def model_table(robot: Twin) -> Table:
    """Returns Table 3.1: the size of the model there and here."""
    model = robot.model
    ours = {
        "inputs": str(model.nu),
        "states": f"{model.nq + model.nv + model.na - 1}"
        f" ({model.nq} positions, of which a quaternion has one too many, {model.nv} velocities,"
        f" {model.na} no-load lengths)",
        "outputs": "8",
        "free parameters": "any; 6 in trials 2 to 4",
        "parameters": f"{len(robot.parameters.records)}, with the platform's inertia and start",
    }
    rows = tuple((what, number, ours[what]) for what, number in TABLES["3.1"].rows)
    return Table(("what", "thesis", "here"), rows)


def trial_table(number: str, result: TrialResult) -> Table:
    """Returns one of Tables 3.3 to 3.6: the thesis' estimates and ours."""
    shown = result.to_json()["parameters"]
    found = {name: p["estimated"] for name, p in shown.items()}
    fits = {name: p["fit_percent"] for name, p in shown.items()}

    def ours(names: list[str]) -> tuple[object, ...]:
        if names[0] not in found:
            return FIXED, FIXED
        known = [fits[name] for name in names if fits[name] is not None]
        return _joined(found, names), f"{np.mean(known):.4f}%"

    return _beside(TABLES[number], ("ours", "our fitting"), ours)


def step_table(number: str, fit: Fit, true: Mapping[str, float]) -> Table:
    """Returns Table 3.7 or 3.8: the real robot as printed, a simulated one with its true values."""
    values = fit.estimate.values
    std = dict(zip(values, fit.std, strict=True))

    def ours(names: list[str]) -> tuple[object, ...]:
        if names[0] not in values:
            return _joined(true, names), FIXED, FIXED
        spread = [std[name] for name in names]
        text = ", ".join(f"{s:.2g}" for s in spread) if np.isfinite(spread).all() else "unknown"
        return _joined(true, names), _joined(values, names), text

    head = ("simulated robot: true", "estimated", "std")
    return _beside(TABLES[number], head, ours)


def fits_table(number: str, fit: np.ndarray, loss: float) -> Table:
    """Returns the table beside Figures 3.4 to 3.7 and 3.10 to 3.13: fit of each motor, and loss.

    Ours are the fits (8,) [%] and the loss by equation 3.5.
    """
    printed = FITS[number]
    rows = [
        (f"Angle of motor {k}", f"{theirs:g} %", f"{ours:z.3f} %")
        for k, (theirs, ours) in enumerate(zip(printed.fits, fit, strict=True), 1)
    ]
    rows.append(("Summary", f"{printed.mean:g} %", f"{fit.mean():z.3f} %"))
    rows.append(("Loss function, equation 3.5", f"{printed.loss:.4g}", f"{loss:.3g}"))
    if printed.matlab_loss is not None:
        rows.append(("Loss function, as MATLAB prints it", f"{printed.matlab_loss:.6g}", "–"))
    return Table(("output", "thesis", "ours"), tuple(rows))


def _beside(
    printed: PrintedTable, head: tuple[str, ...], ours: Callable[[list[str]], tuple[object, ...]]
) -> Table:
    rows = tuple((*row, *ours(NAMES.get(row[0], row[0]).split())) for row in printed.rows)
    columns = tuple(f"thesis: {c}" if k else c for k, c in enumerate(printed.columns))
    return Table((*columns, *head), rows)


def _joined(values: Mapping[str, float], names: list[str]) -> str:
    text = ", ".join(_number(values[name]) for name in names)
    return f"[{text}]" if len(names) > 1 else text


def _number(value: float) -> str:
    """Returns a number in five digits; what is below a nanometre or a nanoradian is zero."""
    return "0" if abs(value) < 1e-9 else f"{value:.5g}"
