"""Ctrl-C is answered at once, and the program has ended two seconds later, whatever it was doing.

Python notices an interrupt between two of its own steps only, and not within a simulation or a
compilation. So the signal also wakes a thread (`signal.set_wakeup_fd`), which says that the program
stops. Where the program has not ended after `GRACE`, be it within native code or waiting for a
thread of its own, the thread ends it; so does a second Ctrl-C. What was half-written then lies in
drafts, which no reader takes for results and the next run removes. What is drawn after the results
were saved may be left out (`leaving_out`).
"""

from __future__ import annotations

import os
import select
import signal
import sys
import threading
import time
from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from types import FrameType

_LEFT_OUT: deque[str] = deque()  # the sentence for an interrupt in what may be left out
GRACE = 1.5  # [s] for native code to return, and to keep what is worth keeping
AGAIN = 0.01  # [s] after which an interrupt is raised again that machine code has lost
STOPPED = 130  # exit code, as a shell gives it
NO_ANSWER = (
    "A search that is stopped keeps nothing; its lines above say which effects were in the model."
    " --minutes 2 ends it sooner, with an answer."
)


@contextmanager
def stoppable(name: str) -> Iterator[None]:
    """Answer Ctrl-C in the block: it says so, and raises KeyboardInterrupt as soon as it can."""
    if threading.current_thread() is not threading.main_thread() or os.name != "posix":
        yield
        return
    heard = threading.Event()

    def interrupt(number: int, frame: FrameType | None) -> None:
        heard.set()
        raise KeyboardInterrupt

    def lost(error: sys.UnraisableHookArgs) -> None:
        # A function of Python that machine code calls cannot pass an error on (numba's compiler
        # calls one for its cache, MuJoCo one for its warnings): Python would print it and go on.
        if isinstance(error.exc_value, KeyboardInterrupt):
            signal.setitimer(signal.ITIMER_REAL, AGAIN)
        else:
            unraisable(error)

    read, write = os.pipe()
    os.set_blocking(write, False)
    unraisable, sys.unraisablehook = sys.unraisablehook, lost
    handler = signal.signal(signal.SIGINT, interrupt)
    alarm = signal.signal(signal.SIGALRM, interrupt)
    woken = signal.set_wakeup_fd(write, warn_on_full_buffer=False)
    watch = threading.Thread(target=_watch, args=(name, read), daemon=True)
    watch.start()
    try:
        yield
    except Exception as error:  # a library may have made another error of the interrupt
        if heard.is_set():
            raise KeyboardInterrupt from error
        raise
    finally:
        signal.set_wakeup_fd(woken)
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, alarm)
        signal.signal(signal.SIGINT, handler)
        sys.unraisablehook = unraisable
        os.close(write)  # the thread says what is left to say, and closes the other end
        watch.join(GRACE)


@contextmanager
def leaving_out(sentence: str) -> Iterator[None]:
    """Say on Ctrl-C in the block, once, what it leaves out and where the rest is."""
    _LEFT_OUT.append(sentence)
    try:
        yield
    except KeyboardInterrupt:
        with suppress(IndexError, OSError):  # unless the thread has said it
            sys.stderr.write(f"{_LEFT_OUT.pop()}\n")
            sys.stderr.flush()
        raise
    finally:
        _LEFT_OUT.clear()


def at_end(code: int = 0) -> None:
    """Make an interrupt change nothing, once all is done and only the process has to end.

    A process that was stopped ends here. Python would free first what it holds, and contexts of
    OpenGL take seconds in which no other thread runs.

    Python ends by the signal itself, whatever the exit code, where an interrupt came while it ran
    a text as code, as each dataclass does that is imported: it remembers this until it runs a text
    again (`unhandled_keyboard_interrupt` in CPython).
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    exec("")
    if code == STOPPED:
        with suppress(OSError, ValueError, AttributeError):  # stdout is full, closed or none
            sys.stdout.flush()
        os._exit(code)


def _watch(name: str, read: int) -> None:
    """Say that the program stops, and end it where it does not."""
    end = None
    while True:
        patience = None if end is None else max(0.0, end - time.monotonic())
        if not select.select([read], [], [], patience)[0]:
            os._exit(STOPPED)
        number = os.read(read, 1)
        if not number:
            break
        if number[0] != signal.SIGINT:
            continue
        if end is not None:
            os._exit(STOPPED)
        end = time.monotonic() + GRACE
        os.write(2, f"{name}: stopping …\n".encode())
        with suppress(IndexError):
            os.write(2, f"{_LEFT_OUT.pop()}\n".encode())
    os.close(read)
