"""The figures of the thesis that are runs of its model, and the settings that each of them needs.

Figure 2.16 shows 2 A in motor 1 with the parameters of Table 2.1. Figures 3.2 and 3.3 show input
and output of the identification: the PRBS, 5 s at 100 Hz, with the parameters of Table 3.2. How
long Figure 2.16 is, and what its curves are, is lost.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from identification.errors import unknown_name


@dataclass(frozen=True)
class FigureSettings:
    """The settings that a figure of the thesis needs.

    Attributes:
        input: of `make_input`.
        set: parameter set.
        duration: [s].
        title: what it is called here.
    """

    input: str
    set: Literal["trial", "simulation"]
    duration: float
    title: str


FIGURES = {
    "2.16": FigureSettings("step", "simulation", 10.0, "Outputs of simulation"),
    "3.2": FigureSettings("prbs", "trial", 5.0, "Simulated input signals: currents of motors"),
    "3.3": FigureSettings("prbs", "trial", 5.0, "Simulated output signals: angles of motors"),
}


def figure_settings(number: str) -> FigureSettings:
    """Returns the settings of a figure by its number in the thesis.

    Raises:
        InputError: no run of the model gives a figure of that number.
    """
    if number not in FIGURES:
        raise unknown_name("figure", number, FIGURES)
    return FIGURES[number]
