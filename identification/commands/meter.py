"""Bars of progress on a terminal, one below the other where stages lie in stages."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext

from identification.progress import watched

SLOW = 0.5  # [s] before a bar is drawn, so that short stages do not flicker


def metered(quiet: bool) -> AbstractContextManager[None]:
    """Show the stages of the block on stderr, with the time that each will still take.

    Nothing is shown where stderr is no terminal, or when it shall be quiet.
    """
    return nullcontext() if quiet or not sys.stderr.isatty() else watched(_bar)


@contextmanager
def _bar(what: str, steps: int) -> Iterator[Callable[[], None]]:
    from tqdm import tqdm

    with tqdm(total=steps, desc=what, leave=False, delay=SLOW, file=sys.stderr) as meter:

        def advance() -> None:
            meter.total = max(meter.total, meter.n + 1)
            meter.update()

        yield advance
