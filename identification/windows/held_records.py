"""The windows of several records, their parameters held, in as few batches as there can be."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np

from identification.model.rollout import State
from identification.windows.held import HeldWindows, held_windows
from identification.windows.shooting import Shooting


@dataclass(frozen=True)
class HeldRecords:
    """Windows of some records, none of which has a free parameter.

    Attributes:
        parts: the windows, one a record.
        groups: indices of records that are simulated in one batch, and their windows together.
    """

    parts: tuple[Shooting, ...]
    groups: tuple[tuple[tuple[int, ...], HeldWindows], ...]

    def residuals(
        self, moves: Sequence[np.ndarray], at: Sequence[np.ndarray] | None = None
    ) -> tuple[np.ndarray, ...]:
        """Returns r at moves of states (W, nx), (W, L ny + nx) a record; NaN where one diverges.

        Args:
            moves: one array a record.
            at: masks of the windows that are simulated, shape (W,) a record, whose rows alone are
                returned; all of them when None.
        """
        masks = at or [np.ones(len(d), bool) for d in moves]
        out: dict[int, np.ndarray] = {}
        for records, held in self.groups:
            some = np.concatenate([masks[k] for k in records])
            d = np.concatenate([moves[k] for k in records])[some]
            part = held if some.all() else held.rows(some)
            r = part.residual(d) if some.any() else np.zeros((0, held.size + d.shape[1]))
            out |= {k: r[part.record == i] for i, k in enumerate(records)}
        return tuple(out[k] for k in range(len(self.parts)))


def hold(parts: Sequence[Shooting]) -> HeldRecords:
    """Returns the windows of some records with parameters held, grouped into batches."""
    each, groups = [held_windows(part) for part in parts], []
    rest = list(range(len(each)))
    while rest:
        alike = tuple(k for k in rest if _is_alike(each[rest[0]], each[k]))
        rest = [k for k in rest if k not in alike]
        groups.append((alike, _together([each[k] for k in alike])))
    return HeldRecords(tuple(parts), tuple(groups))


def _is_alike(one: HeldWindows, other: HeldWindows) -> bool:
    """Returns whether the windows of two records can be simulated in one batch."""
    return (
        one.predictors[0].plant is other.predictors[0].plant
        and [slot for slot, _ in one.numbers] == [slot for slot, _ in other.numbers]
        and one.outputs.shape[1:] == other.outputs.shape[1:]
        and one.inputs.shape[1:] == other.inputs.shape[1:]
        and (one.every, one.hold_kind, one.has_rough_slopes)
        == (other.every, other.hold_kind, other.has_rough_slopes)
        and one.predictors[0].log.sampling_time == other.predictors[0].log.sampling_time
        and one.predictors[0].log.output_names == other.predictors[0].log.output_names
        and np.array_equal(one.whitener, other.whitener)
    )


def _together(each: Sequence[HeldWindows]) -> HeldWindows:
    """Returns the windows of several records that are alike, one record after the other."""
    columns = zip(*([column for _, column in h.numbers] for h in each), strict=True)
    slots = [slot for slot, _ in each[0].numbers]
    first = State(
        *(np.concatenate([getattr(h.first, f.name) for h in each]) for f in fields(State))
    )

    def rows(name: str) -> np.ndarray:
        return np.concatenate([getattr(h, name) for h in each])

    return replace(
        each[0], predictors=tuple(h.predictors[0] for h in each), first=first,
        record=np.repeat(np.arange(len(each)), [len(h.record) for h in each]),
        numbers=tuple((s, np.concatenate(c)) for s, c in zip(slots, columns, strict=True)),
        times=rows("times"), inputs=rows("inputs"), outputs=rows("outputs"), weight=rows("weight"),
    )  # fmt: skip
