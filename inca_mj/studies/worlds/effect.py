"""The common base of effects: a frozen record that knows where in the equations it acts.

A field of a law is a `size`, which is zero where the effect is off, or a `shape`. Both may name the
column of `layout` that they are written to: sizes are added there, shapes replace.
"""

from __future__ import annotations

from dataclasses import Field, dataclass, field, fields, make_dataclass, replace
from math import hypot, inf, isfinite
from typing import Any, ClassVar, Self

import numpy as np

from identification.errors import InputError
from inca_mj.robot.geometry import DRIVES
from inca_mj.studies.worlds import layout as at


def size(default: float, column: int | None = None, *, positive: bool = False) -> Any:
    """Returns a field that is zero where the effect is off."""
    return field(default=default, metadata={"size": True, "column": column, "positive": positive})


def shape(
    default: float, column: int | None = None, *, positive: bool = True, times: float = 1.0
) -> Any:
    """Returns a field that a change of size leaves; `times` it is written to its column."""
    return field(default=default, metadata={"column": column, "positive": positive, "times": times})


class HiddenNumbers:
    """The numbers of a plant while its effects write theirs.

    Attributes:
        A: exit points in O, shape (8, 3) [m].
        B: connectors from the centre of mass, in the platform frame, shape (8, 3) [m].
        centre: centre of mass in the platform frame, shape (3,) [m].
        force: external force on the platform's origin, in O, shape (3,) [N].
        carried: the part of `force` that the pretension balances, shape (3,) [N].
        weight_carried: whether the pretension balances the weight of the cables.
        D: a row per drive, columns of `layout`.
        P: of the platform, entries of `layout`.
    """

    def __init__(self, A: np.ndarray, B: np.ndarray) -> None:
        self.A, self.B = A.copy(), B.copy()
        self.centre, self.force, self.carried = np.zeros((3, 3))
        self.weight_carried = False
        self.D, self.P = np.zeros((DRIVES, at.DRIVE_COLUMNS)), np.zeros(at.PLATFORM_ENTRIES)
        self.D[:, at.CURRENT_LIMIT] = np.inf
        self.D[:, at.PULLEY_SIDE] = np.where(A[:, 2] > A[:, 2].mean(), 1.0, -1.0)


@dataclass(frozen=True, kw_only=True)
class HiddenEffect:
    """A physical effect that the reference lacks.

    A robot may have it with sizes z of |z| xⁿ ≤ `largest`, at x = `reach` and the law's exponent n.

    Raises:
        InputError: a number is not finite, or a positive one is not positive.
    """

    name: ClassVar[str]
    acts_on: ClassVar[str] = "platform"
    largest: ClassVar[float] = inf
    reach: ClassVar[float] = 1.0
    is_smooth: ClassVar[bool] = True  # whether a small size of it acts as a large one does
    is_part: ClassVar[bool] = False  # whether it is a part that deviates, as every part may

    def __post_init__(self) -> None:
        for f in fields(self):
            value = getattr(self, f.name)
            if isinstance(value, float) and not (
                isfinite(value) or (f.name in self.sizes and value > 0)
            ):
                raise InputError(f"{self.name}: {f.name} = {value} is not a finite number")
            if f.metadata.get("positive") and not value > 0:
                raise InputError(f"{self.name}: {f.name} = {value:g} must be positive")

    @property
    def sizes(self) -> tuple[str, ...]:
        """The fields that are zero where the effect is off."""
        return tuple(f.name for f in fields(self) if "size" in f.metadata)

    @property
    def where(self) -> str:
        """The part of the robot it acts on."""
        return self.acts_on

    @property
    def most(self) -> float:
        """The factor by which its sizes can grow so that a robot may still have it."""
        length = hypot(*(getattr(self, name) for name in self.sizes))
        return self.largest / (length * self.reach ** getattr(self, "exponent", 0.0))

    def scaled(self, factor: float) -> Self:
        """Returns the same effect with its sizes times `factor`; its shape stays."""
        return replace(self, **{name: factor * getattr(self, name) for name in self.sizes})

    def column(self, numbers: HiddenNumbers, column: int) -> np.ndarray:
        """Returns a view of the numbers of a column that this effect writes, here an entry of P."""
        return numbers.P[column : column + 1]

    def put(self, numbers: HiddenNumbers) -> None:
        """Write the effect's numbers where the equations read them."""
        for f in fields(self):
            if (column := f.metadata.get("column")) is None:
                continue
            view = self.column(numbers, column)
            if "size" in f.metadata:
                view += getattr(self, f.name)
            else:
                view[:] = f.metadata["times"] * getattr(self, f.name)


@dataclass(frozen=True, kw_only=True)
class HiddenDriveEffect(HiddenEffect):
    """An effect on every drive (`drive` None) or on one of them (1 to 8)."""

    acts_on = "all drives"
    drive: int | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.drive is not None and self.drive not in range(1, DRIVES + 1):
            raise InputError(f"{self.name}: no drive {self.drive}; give 1 to {DRIVES}, or none")

    @property
    def where(self) -> str:
        """All drives (cables), or the one drive."""
        return self.acts_on if self.drive is None else f"drive {self.drive}"

    def column(self, numbers: HiddenNumbers, column: int) -> np.ndarray:
        """Returns a view of one column of D, the rows of this effect's drives only."""
        rows = slice(None) if self.drive is None else slice(self.drive - 1, self.drive)
        return numbers.D[rows, column]


@dataclass(frozen=True, kw_only=True)
class HiddenOneDriveEffect(HiddenDriveEffect):
    """An effect that tells one drive from the others."""

    is_part = True
    drive: int | None = 1

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.drive is None:
            raise InputError(f"{self.name}: name its drive, 1 to {DRIVES}")


def kind(name: str, of: type[HiddenEffect], largest: float, **parts: Any) -> type[HiddenEffect]:
    """Returns an effect that needs no code: its sizes and shapes are written to their columns.

    `parts` are fields by `size` and `shape`; anything else is an attribute of the class.
    """
    made = [(n, type(f.default), f) for n, f in parts.items() if isinstance(f, Field)]
    other = {n: part for n, part in parts.items() if not isinstance(part, Field)}
    namespace = {"name": name, "largest": largest, "__module__": of.__module__, **other}
    return make_dataclass(name, made, bases=(of,), namespace=namespace, frozen=True, kw_only=True)
