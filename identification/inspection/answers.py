"""Which input a column answers: the largest cross-correlation, and how late it is.

    r(k) = Σ u(t) z(t + k h) / (|u| |z|),    0 <= k h <= 2 s

u and z have no mean and no straight line. z is the column itself, its rate, or its acceleration: a
joint under a servo goes where the input is, one under a motor is accelerated by it. Which of the
three answers best is therefore a sign of what an input is.

Waves alone tell no sign: the position of a free mass answers a slow force against it, and half a
period later so does every form. What answers against an input is told as that only where no form
answers with it as soon, and half as well.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from identification.logs.sampling import FloatArray

LONGEST = 2.0  # [s] that an answer may be late
MOST = 2**14  # samples that are compared
TINY = 1e-12  # size of a signal that is constant but for rounding
SMOOTH = 5  # samples whose mean is differentiated
SETPOINT = 0.8  # correlation of a position with a command that it follows
NEAR = (0.5, 1.5)  # of such a command, that the position goes
LEAST = 0.3  # correlation below which nothing is told
RIVAL = 0.7  # of a correlation against an input, that one with it may be its true answer
OF = ("itself", "rate", "acceleration")


@dataclass(frozen=True)
class Answer:
    """The input that an output answers, as the data show it."""

    output: str
    input: str
    correlation: float  # r of the largest size, in [-1, 1]
    lag: float  # [s]
    of: str  # of the output: one of `OF`
    gain: float  # r |z| / |u|, in the unit of the output, or of its differences, by the input's

    @property
    def is_setpoint(self) -> bool:
        """Tells whether the input looks like a command of the position, in the same unit."""
        is_near = NEAR[0] <= self.gain <= NEAR[1]
        return self.of == OF[0] and self.correlation >= SETPOINT and is_near


def find_answers(
    step: float, inputs: Mapping[str, FloatArray], outputs: Mapping[str, FloatArray]
) -> tuple[Answer, ...]:
    """Returns for each output the input that it answers best; none where nothing is clear.

    Inputs and outputs are given by name, shape (n,), finite, every `step` [s].
    """
    seen = {name: _centred(u[:MOST]) for name, u in inputs.items()}
    found = []
    for name, y in outputs.items():
        forms = [_centred(z) for z in _forms(y[:MOST])]
        each = [
            _answer(name, other, of, u, z, sign, step)
            for other, u in seen.items() if other != name
            for of, z in zip(OF, forms, strict=True) for sign in (1, -1)
        ]  # fmt: skip
        best = max(each, key=lambda a: abs(a.correlation), default=None)
        if best is not None and best.correlation < 0:
            least = max(LEAST, RIVAL * abs(best.correlation))
            soon = [a for a in each if a.correlation >= least and a.lag <= best.lag]
            best = max(soon, key=lambda a: a.correlation, default=best)
        if best is not None and abs(best.correlation) >= LEAST:
            found.append(best)
    return tuple(a for a in found if not _is_backwards(a, found))


def _is_backwards(answer: Answer, others: Sequence[Answer]) -> bool:
    """Returns whether the input of an answer rather answers its output.

    Of columns whose names do not tell them apart each is tried as the input of the other. What
    answers comes late, and looks more like what it answers than the other way round.
    """
    return any(
        (b.output, b.input) == (answer.input, answer.output)
        and (abs(b.correlation), b.lag) > (abs(answer.correlation), answer.lag)
        for b in others
    )


def _answer(
    output: str, name: str, of: str, u: FloatArray, z: FloatArray, sign: int, step: float
) -> Answer:
    """Returns how a form of an output answers an input, or the input with the other sign."""
    size = float(np.linalg.norm(u)), float(np.linalg.norm(z))
    if min(size) <= TINY:
        return Answer(output, name, 0.0, 0.0, of, 0.0)
    r, lag = _best(u / size[0], sign * z / size[1], step)
    r *= sign
    return Answer(output, name, r, lag, of, r * size[1] / size[0])


def _forms(y: FloatArray) -> Sequence[FloatArray]:
    """Returns a column, its rate and its acceleration, of means in which noise is smaller."""
    smooth = np.convolve(np.pad(y, SMOOTH // 2, mode="edge"), np.ones(SMOOTH) / SMOOTH, "valid")
    rate = np.gradient(smooth)
    return [y, rate, np.gradient(rate)]


def _centred(x: FloatArray) -> FloatArray:
    """Returns a signal without its mean and its straight line."""
    t = np.linspace(-1, 1, len(x))
    x = x - x.mean()
    return np.asarray(x - t * (x @ t) / (t @ t))


def _best(u: FloatArray, z: FloatArray, step: float) -> tuple[float, float]:
    """Returns the most positive correlation and its lag [s]."""
    n = len(u)
    product = np.fft.rfft(z, 2 * n) * np.conj(np.fft.rfft(u, 2 * n))
    r = np.fft.irfft(product, 2 * n)[: max(1, min(n // 2, round(LONGEST / step)))]
    k = int(np.argmax(r))
    return float(r[k]), k * step
