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


_INERTIA = "diag(0.8, 1.5, 1.8) 1e-4"
_TRIAL = ("parameter", "value", "initial", "estimated", "fitting")
_STEP = ("parameter", "initial value", "estimated value")
_FIXED = ("(fix)", "(fix)", "(fix)")
# How the symbols are called here; a triple is one row of the thesis.
NAMES = {
    "λ": "lambda", "β": "beta", "[x, y, z]": "x y z", "[φ, θ, ψ]": "roll pitch yaw",
    "I": "I_x I_y I_z",
}  # fmt: skip

_TABLES = (
    PrintedTable(
        "2.1",
        "List of the parameters used in simulation",
        ("parameter", "symbol", "value", "source"),
        (
            ("Radius of the roller 1 (mm)", "R", "17.5", "Datasheet"),
            ("Radius of the roller 2 (mm)", "R_s", "6", "Datasheet"),
            ("Stiffness of additional spring (N/m)", "k_s", "16", "Measurement"),
            ("Elastic modulus of cable (N.m/m)", "λ", "32224", "Measurement"),
            ("Damping coefficient of cable (N/m/s)", "b", "10", "Arbitrary"),
            ("Moment of inertia (kgm^2)", "J", "3.0563e-5", "Computed"),
            ("Viscous friction coefficient", "b_v", "0.3e-3", "Arbitrary"),
            ("Coulomb friction coefficient", "b_c", "0.005", "Arbitrary"),
            ("Smooth coefficient of friction", "β", "0.8", "Arbitrary"),
            ("Motor torque constant (Nm/A)", "K_t", "0.0603", "Datasheet"),
            ("Mass of moving platform (kg)", "m", "0.1725", "Datasheet"),
            ("Moment of inertia of MP (kgm^2)", "I", _INERTIA, "Datasheet"),
        ),
    ),
    PrintedTable(
        "3.1",
        "Description of nonlinear grey-box model of the INCA robot in Matlab",
        ("what", "number"),
        (("inputs", "8"), ("states", "36"), ("outputs", "8"), ("free parameters", "5"),
         ("parameters", "11")),
    ),
    PrintedTable(
        "3.2",
        "List of parameters used to obtain simulated data",
        ("parameter", "symbol", "value"),
        (
            ("Radius of the roller 1 (mm)", "R", "17.5"),
            ("Radius of the roller 2 (mm)", "R_s", "6"),
            ("Stiffness of the additional spring (N/m)", "k_s", "16"),
            ("Elastic modulus of cable (N.m/m)", "λ", "25000"),
            ("Damping coefficient of cable (N/m/s)", "b", "8"),
            ("Moment of inertia (kgm^2)", "J", "8e-5"),
            ("Viscous friction coefficient", "b_v", "0.0002"),
            ("Coulomb friction coefficient", "b_c", "0.005"),
            ("Smooth coefficient of friction", "β", "0.8"),
            ("Motor torque constant (Nm/A)", "K_t", "0.08"),
            ("Mass of moving platform (kg)", "m", "0.1725"),
            ("Moment of inertia of MP (kgm^2)", "I", _INERTIA),
            ("Initial position of moving platform (m)", "[x, y, z]", "[0, 0, 1.43]"),
            ("Initial Euler angles of moving platform (rad)", "[φ, θ, ψ]", "[0, 0, 0]"),
        ),
    ),
    PrintedTable(
        "3.3",
        "Trial.1: List of estimated parameters",
        _TRIAL,
        (
            ("R", "0.0175", "0.0175", "0.0199", "86.3%"),
            ("R_s", "0.006", "0.006", "0.0070", "83.3%"),
            ("k_s", "16", "16", "17.189", "93.1%"),
            ("λ", "25000", "31250", "36171.1", "55.3%"),
            ("b", "8", "16", "2.2650", "28.7%"),
            ("J", "0.00008", "0.0001", "0.00011", "62.5%"),
            ("b_v", "0.0002", "0.00017", "0.00027", "65.0%"),
            ("b_c", "0.005", "0.004", "0.00697", "62.0%"),
            ("β", "0.8", "1", "0.8075", "99.1%"),
            ("K_t", "0.08", "0.08", "0.1099", "62.5%"),
            ("m", "0.1725", "0.1725", "0.1725", "100%"),
            ("[x, y, z]", "[0, 0, 1.43]", "[0.025, 0.025, 1.5]", "[0.003, 0.0, 1.421]", "99.3%"),
        ),
    ),
    PrintedTable(
        "3.4",
        "Trial.2: List of estimated parameters",
        _TRIAL,
        (
            ("R", "0.0175", *_FIXED),
            ("R_s", "0.006", *_FIXED),
            ("k_s", "16", *_FIXED),
            ("λ", "25000", "31250", "29177.9", "83.3%"),
            ("b", "8", "16", "13.35", "not fit"),
            ("J", "0.00008", "0.0001", "7.79e-5", "97.4%"),
            ("b_v", "0.0002", "0.00017", "0.000197", "98.5%"),
            ("b_c", "0.005", "0.004", "0.00505", "99.0%"),
            ("β", "0.8", "1", "0.7396", "92.5%"),
            ("K_t", "0.08", *_FIXED),
            ("m", "0.1725", *_FIXED),
            ("[x, y, z]", "[0, 0, 1.43]", *_FIXED),
        ),
    ),
    PrintedTable(
        "3.5",
        "Trial.3: List of estimated parameters",
        _TRIAL,
        (
            ("R", "0.0175", *_FIXED),
            ("R_s", "0.006", *_FIXED),
            ("k_s", "16", *_FIXED),
            ("λ", "25000", "26250", "25598.3", "97.6%"),
            ("b", "8", "7.2", "17.036", "not fit"),
            ("J", "0.00008", "8.4e-5", "7.78e-5", "97.4%"),
            ("b_v", "0.0002", "0.00019", "0.000197", "98.5%"),
            ("b_c", "0.005", "0.00475", "0.00506", "98.8%"),
            ("β", "0.8", "0.84", "0.7374", "92.1%"),
            ("K_t", "0.08", *_FIXED),
            ("m", "0.1725", *_FIXED),
            ("[x, y, z]", "[0, 0, 1.43]", *_FIXED),
        ),
    ),
    PrintedTable(
        "3.6",
        "Trial.4: List of estimated parameters",
        _TRIAL,
        (
            ("R", "0.0175", *_FIXED),
            ("R_s", "0.006", *_FIXED),
            ("k_s", "16", *_FIXED),
            ("λ", "25000", "26250", "25392.6", "98.4%"),
            ("b", "8", "7.2", "19.0473", "not fit"),
            ("J", "0.00008", "8.4e-5", "7.78e-5", "97.4%"),
            ("b_v", "0.0002", "0.00019", "0.000197", "98.5%"),
            ("b_c", "0.005", "0.00475", "0.00506", "98.8%"),
            ("β", "0.8", "0.84", "0.741", "92.1%"),
            ("K_t", "0.08", *_FIXED),
            ("m", "0.1725", *_FIXED),
            ("[x, y, z]", "[0, 0, 1.43]", *_FIXED),
        ),
    ),
    PrintedTable(
        "3.7",
        "Step.1: List of estimated parameters",
        _STEP,
        (
            ("R", "0.0175", "0.0148"),
            ("R_s", "0.006", "0.0085"),
            ("k_s", "16", "18.877"),
            ("λ", "25000", "36540.3"),
            ("b", "2", "8.107"),
            ("J", "0.0001", "8.934e-5"),
            ("b_v", "0.0002", "7.999e-5"),
            ("b_c", "0.005", "0.0143"),
            ("β", "0.8", "0.9996"),
            ("K_t", "0.0603", "0.1328"),
            ("m", "0.17246", "0.2499"),
            ("[x, y, z]", "[0, 0, 1.47]", "[-0.006, -0.005, 1.428]"),
        ),
    ),
    PrintedTable(
        "3.8",
        "Step.2: List of estimated parameters",
        _STEP,
        (
            ("R", "0.0175", "0.0115"),
            ("R_s", "0.006", "fix"),
            ("k_s", "16", "fix"),
            ("λ", "36540.3", "26407.7"),
            ("b", "8.107", "fix"),
            ("J", "8.935e-5", "8.342e-5"),
            ("b_v", "7.999e-5", "8.366e-5"),
            ("b_c", "0.01428", "0.01457"),
            ("β", "0.9996", "0.9189"),
            ("K_t", "0.08", "0.073"),
            ("m", "0.25", "0.2384"),
            ("[x, y, z]", "[0, 0, 1.43]", "fix"),
        ),
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
