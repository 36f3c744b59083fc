"""A log and what it is used for: some records of a robot are fitted, the others only confirm.

Physics is shared by all records. Where each begins, and what its file says of it alone (a payload,
a supply voltage), is its own.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from identification.logs.log import Log

Role = Literal["fit", "confirm"]


@dataclass(frozen=True)
class Record:
    """A log and what it is used for.

    Attributes:
        log: what was measured.
        role: "fit" or "confirm".
        values: values of the plant's parameters that hold for this record alone, by name.
    """

    log: Log
    role: Role
    values: Mapping[str, float] = field(default_factory=dict)
