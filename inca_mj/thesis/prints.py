"""The printed numbers of the thesis: its tables and its figures, cell by cell.

Numbers are kept as they are printed, misprints included; only powers of ten are written with an e.
The curves of the figures are lost: of Figures 3.4 to 3.13 the fits and losses beside them are left.
`(fix)` is a parameter that was not estimated.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class PrintedTable:
    """A table of the thesis."""

    number: str  # as in the thesis
    title: str  # its caption
    columns: tuple[str, ...]  # headings
    rows: tuple[tuple[str, ...], ...]  # cells as they are printed


@dataclass(frozen=True)
class PrintedFits:
    """The numbers of a figure of the thesis that compares data and model."""

    number: str  # of the figure
    title: str  # its caption
    fits: tuple[float, ...]  # of the angles of motors 1 to 8 [%]
    mean: float  # the "summary" [%]
    loss: float  # by equation 3.5
    matlab_loss: float | None = None  # as MATLAB prints it; None where it is not given


# How the symbols are called here; a triple is one row of the thesis.
NAMES = {
    "λ": "lambda", "β": "beta", "[x, y, z]": "x y z", "[φ, θ, ψ]": "roll pitch yaw",
    "I": "I_x I_y I_z",
}  # fmt: skip
_SYMBOLS = "R | R_s | k_s | λ | b | J | b_v | b_c | β | K_t | m"
_TRUE = "0.0175 | 0.006 | 16 | 25000 | 8 | 0.00008 | 0.0002 | 0.005 | 0.8 | 0.08 | 0.1725"
_DATASHEET = "(fix) | (fix) | (fix)"


def _table(number: str, title: str, /, **columns: str) -> PrintedTable:
    """Returns a table of columns, each a heading (`_` for a space) and its cells between bars."""
    cells = [column.split(" | ") for column in columns.values()]
    headings = tuple(name.replace("_", " ") for name in columns)
    return PrintedTable(number, title, headings, tuple(zip(*cells, strict=True)))


def _trial(n: int, initial: str, estimated: str, fitting: str) -> PrintedTable:
    """Returns the table of a trial."""
    return _table(
        f"3.{n + 2}", f"Trial.{n}: List of estimated parameters",
        parameter=f"{_SYMBOLS} | [x, y, z]", value=f"{_TRUE} | [0, 0, 1.43]",
        initial=initial, estimated=estimated, fitting=fitting,
    )  # fmt: skip


def _partial_trial(n: int, initial: str, estimated: str, fitting: str) -> PrintedTable:
    """Returns the table of a trial that holds what a data sheet gives; columns from λ to β."""
    columns = (f"{_DATASHEET} | {c} | {_DATASHEET}" for c in (initial, estimated, fitting))
    return _trial(n, *columns)


def _step(n: int, initial: str, estimated: str) -> PrintedTable:
    """Returns the table of a step."""
    return _table(
        f"3.{n + 6}", f"Step.{n}: List of estimated parameters",
        parameter=f"{_SYMBOLS} | [x, y, z]", initial_value=initial, estimated_value=estimated,
    )  # fmt: skip


def _list(number: str, title: str, spring: str, more: str = "", /, **columns: str) -> PrintedTable:
    """Returns a list of parameters; `more` are parameters below those of the robot."""
    return _table(
        number, title,
        parameter="Radius of the roller 1 (mm) | Radius of the roller 2 (mm) |"
        f" Stiffness of {spring} (N/m) | Elastic modulus of cable (N.m/m) |"
        " Damping coefficient of cable (N/m/s) | Moment of inertia (kgm^2) |"
        " Viscous friction coefficient | Coulomb friction coefficient |"
        " Smooth coefficient of friction | Motor torque constant (Nm/A) |"
        f" Mass of moving platform (kg) | Moment of inertia of MP (kgm^2){more}",
        **columns,
    )  # fmt: skip


_TABLES = (
    _list(
        "2.1", "List of the parameters used in simulation", "additional spring",
        symbol=f"{_SYMBOLS} | I",
        value="17.5 | 6 | 16 | 32224 | 10 | 3.0563e-5 | 0.3e-3 | 0.005 | 0.8 | 0.0603 | 0.1725"
        " | diag(0.8, 1.5, 1.8) 1e-4",
        source="Datasheet | Datasheet | Measurement | Measurement | Arbitrary | Computed"
        " | Arbitrary | Arbitrary | Arbitrary | Datasheet | Datasheet | Datasheet",
    ),
    _table(
        "3.1", "Description of nonlinear grey-box model of the INCA robot in Matlab",
        what="inputs | states | outputs | free parameters | parameters",
        number="8 | 36 | 8 | 5 | 11",
    ),
    _list(
        "3.2", "List of parameters used to obtain simulated data", "the additional spring",
        " | Initial position of moving platform (m)"
        " | Initial Euler angles of moving platform (rad)",
        symbol=f"{_SYMBOLS} | I | [x, y, z] | [φ, θ, ψ]",
        value="17.5 | 6 | 16 | 25000 | 8 | 8e-5 | 0.0002 | 0.005 | 0.8 | 0.08 | 0.1725"
        " | diag(0.8, 1.5, 1.8) 1e-4 | [0, 0, 1.43] | [0, 0, 0]",
    ),
    _trial(
        1,
        "0.0175 | 0.006 | 16 | 31250 | 16 | 0.0001 | 0.00017 | 0.004 | 1 | 0.08 | 0.1725"
        " | [0.025, 0.025, 1.5]",
        "0.0199 | 0.0070 | 17.189 | 36171.1 | 2.2650 | 0.00011 | 0.00027 | 0.00697 | 0.8075"
        " | 0.1099 | 0.1725 | [0.003, 0.0, 1.421]",
        "86.3% | 83.3% | 93.1% | 55.3% | 28.7% | 62.5% | 65.0% | 62.0% | 99.1% | 62.5% | 100%"
        " | 99.3%",
    ),
    _partial_trial(
        2, "31250 | 16 | 0.0001 | 0.00017 | 0.004 | 1",
        "29177.9 | 13.35 | 7.79e-5 | 0.000197 | 0.00505 | 0.7396",
        "83.3% | not fit | 97.4% | 98.5% | 99.0% | 92.5%",
    ),
    _partial_trial(
        3, "26250 | 7.2 | 8.4e-5 | 0.00019 | 0.00475 | 0.84",
        "25598.3 | 17.036 | 7.78e-5 | 0.000197 | 0.00506 | 0.7374",
        "97.6% | not fit | 97.4% | 98.5% | 98.8% | 92.1%",
    ),
    _partial_trial(
        4, "26250 | 7.2 | 8.4e-5 | 0.00019 | 0.00475 | 0.84",
        "25392.6 | 19.0473 | 7.78e-5 | 0.000197 | 0.00506 | 0.741",
        "98.4% | not fit | 97.4% | 98.5% | 98.8% | 92.1%",
    ),
    _step(
        1,
        "0.0175 | 0.006 | 16 | 25000 | 2 | 0.0001 | 0.0002 | 0.005 | 0.8 | 0.0603 | 0.17246"
        " | [0, 0, 1.47]",
        "0.0148 | 0.0085 | 18.877 | 36540.3 | 8.107 | 8.934e-5 | 7.999e-5 | 0.0143 | 0.9996"
        " | 0.1328 | 0.2499 | [-0.006, -0.005, 1.428]",
    ),
    _step(
        2,
        "0.0175 | 0.006 | 16 | 36540.3 | 8.107 | 8.935e-5 | 7.999e-5 | 0.01428 | 0.9996 | 0.08"
        " | 0.25 | [0, 0, 1.43]",
        "0.0115 | fix | fix | 26407.7 | fix | 8.342e-5 | 8.366e-5 | 0.01457 | 0.9189 | 0.073"
        " | 0.2384 | fix",
    ),
)  # fmt: skip
TABLES = {table.number: table for table in _TABLES}


def printed(number: str, column: str) -> dict[str, float]:
    """Returns a column of a table by the names of parameters here, without those that are fixed."""
    table, values = TABLES[number], dict[str, float]()
    for row in table.rows:
        cell = row[table.columns.index(column)]
        if "fix" not in cell:
            numbers = map(float, cell.strip("[]").split(", "))
            values |= zip(NAMES.get(row[0], row[0]).split(), numbers, strict=True)
    return values


_TRIAL_FIGURE = "Comparison between simulated data and estimated model output"
_REAL_FIGURE = "Comparison between measurement data and estimated model output"
_FITS = (
    PrintedFits(
        "3.4", f"Trial.1: {_TRIAL_FIGURE}",
        (97.75, 97.16, 98.33, 97.67, 97.08, 97.78, 98.35, 97.75), 97.74, 2.98e-5, 7.423e-26,
    ),
    PrintedFits(
        "3.5", f"Trial.2: {_TRIAL_FIGURE}",
        (97.77, 97.29, 98.37, 97.94, 97.13, 97.77, 98.42, 97.92), 97.82, 3.766e-6, 1.1644e-27,
    ),
    PrintedFits(
        "3.6", f"Trial.3: {_TRIAL_FIGURE}",
        (97.74, 97.28, 98.39, 97.95, 97.13, 97.75, 98.44, 97.93), 97.83, 3.744e-6, 1.3263e-27,
    ),
    PrintedFits(
        "3.7", f"Trial.4: {_TRIAL_FIGURE}",
        (97.77, 97.32, 98.42, 97.97, 97.16, 97.78, 98.47, 97.96), 97.85, 5.590e-6, 1.878e-20,
    ),
    PrintedFits(
        "3.10", f"Step.1: {_REAL_FIGURE}",
        (87.5, 89.8, 89.3, 89.2, 89.0, 89.1, 89.1, 88.5), 88.9, 0.0020, 6.17686e-11,
    ),
    PrintedFits(
        "3.11", "Step.1: Validation of estimated output",
        (87.1, 90.2, 89.8, 89.2, 89.1, 88.2, 89.7, 88.0), 88.9, 0.0025,
    ),
    PrintedFits(
        "3.12", f"Step.2: {_REAL_FIGURE}",
        (87.9, 89.9, 89.9, 88.8, 89.8, 88.5, 89.9, 88.3), 89.1, 0.0019, 9.5359e-11,
    ),
    PrintedFits(
        "3.13", "Step.2: Validation of estimated output",
        (87.99, 90.9, 90.5, 88.6, 90.2, 88.4, 90.4, 87.9), 89.4, 0.0022,
    ),
)  # fmt: skip
FITS = {fits.number: fits for fits in _FITS}

LOST = (
    "The log of the real robot was never published, so Tables 3.7 and 3.8 and the fits of Figures"
    " 3.10 to 3.13 stand here as they are printed: nobody can compute them again, or check them.",
    "Beside them stands the same procedure on a simulated robot whose values are known. It shows"
    " what the procedure can find, and says nothing of the real robot.",
    "The curves of the thesis' figures are lost: the text that this project works from has their"
    " captions and the numbers beside them only. All curves shown are ours.",
    "The coordinates of the exit points and connectors are lost too; those used here are assumed,"
    " so no curve could be the same as the thesis' to the last digit.",
)
