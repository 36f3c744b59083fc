"""The two parts of what no fit sees: one on which a search decides, and one of which it tells.

    fit      samples that a fit sees
    select   samples on which a search decides: it proves, drops and exchanges effects there
    report   samples that neither has seen, of which all errors and gains are told

    x_k = ‖E_k‖²        E: whitened residual of the fitted samples, or of fitted windows
    τ = 1 + 2 Σ_{k=1..M} ρ_k,    ρ: autocorrelation of x,    M: the smallest with M >= 5 τ(M)
    L = max(unit, 3 τ, n/20), no longer than n/9, in whole units        n: samples that no fit sees
    block b is report where s(b) = 2 mod 3, else select      s: sum of the digits of b to the base 3

The best of many effects gains more on the samples by which it was chosen than on others, also where
it is none. What is told of it must therefore be of others. τ is the time over which neighbours
repeat one another, so that n samples tell as much as n/τ that do not (Sokal 1997, whose window M
is). Blocks of L samples are given to the two parts in the order of Thue (1906) and Morse (1921) in
three letters, of which two select: two of three blocks decide, because half of them cost too many
names (`docs/discovery.md`). Unlike every third block this order has no period that a periodic
motion might share.

What the model lacks looks like memory too. Blocks are therefore no longer than a ninth of a
record. A record with fewer than `FEWEST_BLOCKS` blocks keeps no part untouched: both are then all
of it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

Part = Literal["select", "report"]

WINDOW = 5.0  # of τ, over which autocorrelations are added (Sokal 1997)
# Of τ. Sums over neighbouring blocks of a process with exponential memory then correlate by 0.1.
MEMORIES = 3.0
MOST_BLOCKS = 20  # of a record; more would only be shorter
LEAST_BLOCKS = 9  # into which a record is cut if its units allow, whatever the memory
FEWEST_BLOCKS = 5  # two of them are told of; with fewer none is kept untouched
REPORT_EVERY = 3  # one of so many blocks is told of, the others decide


@dataclass(frozen=True, eq=False)
class Parts:
    """The samples of a record on which a search decides, and those of which it tells."""

    select: np.ndarray  # those on which a search decides, shape (N,)
    # those of which it tells, shape (N,); the same as `select` where the record is too short to
    # keep a part untouched
    report: np.ndarray
    block: int  # length of a block in samples; 0 where there are none

    @property
    def is_kept(self) -> bool:
        """Tells whether the search has decided on no sample that is told of."""
        return not (self.select & self.report).any()

    def rows(self, part: Part) -> np.ndarray:
        """Returns the samples of a part, shape (N,)."""
        return self.select if part == "select" else self.report

    def between(self, rows: slice) -> Parts:
        """Returns the parts of some neighbouring samples, such as those of one record."""
        return Parts(self.select[rows], self.report[rows], self.block)


def inside(parts: Parts | None, part: Part, places: np.ndarray) -> np.ndarray:
    """Returns which windows lie wholly inside a part of their record, shape (W,).

    Their places are the first sample of each and the one behind its last, shape (W, 2). Without
    parts all of the record is in each.
    """
    if parts is None:
        return np.ones(len(places), bool)
    before = np.concatenate([[0], np.cumsum(parts.rows(part))])
    first, behind = places.T
    return np.asarray(before[behind] - before[first] == behind - first)


def divide(unseen: np.ndarray, unit: int, memory: float = 1.0, keep: bool = True) -> Parts:
    """Returns the parts of a record.

    Args:
        unseen: the samples that no fit sees, shape (N,).
        unit: a block is so many samples or a multiple of it; the longest window fits into it.
        memory: τ, in samples.
        keep: whether a part is kept untouched at all.
    """
    places = np.flatnonzero(unseen)
    n = len(places)
    wanted = np.clip(MEMORIES * memory, n / MOST_BLOCKS, n / LEAST_BLOCKS)
    block = unit * max(1, round(wanted / unit))
    count = n // block
    if count < FEWEST_BLOCKS or not keep:
        return Parts(unseen, unseen, 0)
    of_block = np.minimum(np.arange(n) // block, count - 1)  # the last one takes the remainder
    told = is_told(count)[of_block]
    select, report = np.zeros((2, len(unseen)), bool)
    select[places[~told]], report[places[told]] = True, True
    return Parts(select, report, block)


def join(parts: Sequence[Parts]) -> Parts:
    """Returns the parts of records that are joined in their order; the longest block counts."""
    select, report = (np.concatenate([getattr(p, n) for p in parts]) for n in ("select", "report"))
    return Parts(select, report, max(p.block for p in parts))


def is_told(count: int) -> np.ndarray:
    """Returns which of so many blocks are told of, shape (B,), in the order of Thue and Morse.

    With one block of m told it is their order in m letters: the sum of the digits to the base m,
    modulo m, is m - 1.
    """
    m = REPORT_EVERY
    sums, rest = np.zeros(count, int), np.arange(count)
    while rest.any():
        sums += rest % m
        rest //= m
    return sums % m == m - 1


def autocorrelation_time(series: Sequence[np.ndarray]) -> float:
    """Returns τ of x (n,) of some records of one process, in their steps, at least 1."""
    length = max(map(len, series))
    cov = np.zeros(length)
    for x in series:
        d = np.asarray(x, float) - np.mean(x)
        power = np.abs(np.fft.rfft(d, 2 * len(d))) ** 2
        cov[: len(d)] += np.fft.irfft(power)[: len(d)]
    if not cov[0] > 0:
        return 1.0
    tau = 2 * np.cumsum(cov / cov[0]) - 1
    enough = np.flatnonzero(np.arange(length) >= WINDOW * tau)
    return max(1.0, float(tau[enough[0] if len(enough) else -1]))
