"""An effect of the user's own, written out for the joint at which a force is missing."""

from __future__ import annotations

import json
from collections.abc import Sequence
from math import floor, log, log10, sqrt

from identification.quantities import held
from identification.report.discovery.missing_place import MissingPlace

FIELDS = {"position": "s.q", "rate": "s.v", "time": "s.time", "force": "s.f_u"}  # by first words
LARGEST, PROBE = 5.0, 0.1  # of the size that is to be believed, and of that which is tried


def own_stub(
    place: MissingPlace, robot: str, logs: Sequence[str], confirm: Sequence[str] = ()
) -> str:
    """Returns a Python file with an effect at the place, and a search that tries it.

    It is "" where another joint tells the place: an effect of one's own does not know it.

    The robot's TOML, logs that are fitted, and logs that confirm are paths from the file's folder.
    """
    if place.own is None:
        return ""
    x = next(field for word, field in FIELDS.items() if place.reads.startswith(word))
    middle, half = (place.low + place.high) / 2, (place.high - place.low) / 2
    width = half / sqrt(log(2)) or 0.1 * abs(middle) or 1.0  # at its ends is half of the force
    ways = {
        "rising": " if s.v > 0 else 0.0", "falling": " if s.v < 0 else 0.0",
        "against": " * (-1.0 if s.v > 0 else 1.0)", "with": " * (1.0 if s.v > 0 else -1.0)",
    }  # fmt: skip
    kind = "Torque" if place.force_unit == "N m" else "Force"
    size, confirming = abs(place.force), f"confirm=[{_files(confirm)}], " if confirm else ""
    bounds = f"largest={_number(LARGEST * size)}, probe={_number(PROBE * size)}"
    return f'''"""An effect of your own: {place}.

The search tried every known law, and none explains this. Write the law that you suspect in the
place of this bump, and run the file: python own_effect.py
"""

from math import exp
from pathlib import Path

from numba import njit

from identification import Effect, Size, discover, discovery_text, places, read_robot


@njit
def mine(s, p):
    """{kind} on {place.joint} [{place.force_unit}]; nothing where the size p[0] is zero.

    s.q: position, s.v: rate, s.f_u: force of the drives, s.f_g: of gravity, s.time: of the record.
    """
    x = ({x} - ({round(middle, 2 - floor(log10(width)))})) / {_number(width)}
    return p[0] * exp(-x * x){ways.get(place.moves, "")}


MINE = Effect(
    "mine",
    law="c exp(-x²)",
    sizes=(Size("c", "{place.force_unit}", {bounds}),),
    places=places("joint", ("{place.joint}",)),
    phrase="force: my own",
    hooks={{"force": mine}},
)

if __name__ == "__main__":
    here = Path(__file__).parent  # from which all paths are told
    robot = read_robot(
        {_files([robot])}, [{_files(logs)}], {confirming}own_effects=[MINE]
    )
    print(discovery_text(discover(robot)))
'''


def _files(paths: Sequence[str]) -> str:
    return ", ".join(f"here / {json.dumps(path, ensure_ascii=False)}" for path in paths)


def _number(value: float) -> str:
    """Returns a number of code with two digits."""
    return repr(float(held(value))) if abs(value) >= 1e-3 else f"{value:.2g}"
