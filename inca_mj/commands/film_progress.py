"""The messages of a film while it is drawn: how long it takes, by the rate of its first frames."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, field

from identification.progress import duration

FIRST = 10  # frames whose rate is measured; the first of all also waits for the renderer
SOON = 5.0  # [s] after which the rate of fewer frames is told
EVERY = 15.0  # [s] between two lines


@dataclass
class FilmProgress:
    """Counts the frames of a film, and says how long the rest will take.

    Attributes:
        tell: is told each line.
        fps: frames per second of the film.
        lines: whether it is told a line now and then; where stderr is a terminal, a bar says it.
        clock: the time [s].
        hint: how to do without the film; told where it begins.
    """

    tell: Callable[[str], None]
    fps: float
    lines: bool = field(default_factory=lambda: not sys.stderr.isatty())
    clock: Callable[[], float] = time.monotonic
    hint: str = ""
    _first: int = 0
    _begun: float = 0.0
    _said: float = 0.0
    _is_promised: bool = False

    def __call__(self, done: int, frames: int) -> None:
        """Counts one frame more.

        Args:
            done: frames that are drawn; some may have been before the first call.
            frames: of the whole film.
        """
        now = self.clock()
        if not self._first:
            self._first, self._begun, self._said = done, now, now
            more = f"; {self.hint}" if self.hint else ""
            self.tell(f"film: {frames} frames, {frames / self.fps:.3g} s of film{more}")
            return
        left = (now - self._begun) / (done - self._first) * (frames - done)
        if done == frames:
            return
        if not self._is_promised:
            if done - self._first >= FIRST or now - self._begun >= SOON:
                self._said, self._is_promised = now, True
                self.tell(f"film: {frames} frames, about {duration(left)} to draw")
        elif self.lines and now - self._said >= EVERY:
            self._said = now
            self.tell(f"film: {done} of {frames} frames, {duration(left)} left")
