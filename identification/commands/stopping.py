"""Ctrl-C is answered at once, and the program has ended two seconds later, whatever it was doing.

Python notices an interrupt between two of its own steps only, and not within a simulation or a
compilation. So the signal also wakes a thread (`signal.set_wakeup_fd`), which says that the program
stops. Where this has not come back from native code after `GRACE`, the thread ends it; so does a
second Ctrl-C. What was half-written then lies in drafts, which no reader takes for results and the
next run removes.
"""

from __future__ import annotations

import os
import select
import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

GRACE = 1.5  # [s] for native code to return
STOPPED = 130  # exit code, as a shell gives it
_TICK = 0.02  # [s]


@contextmanager
def stoppable(name: str) -> Iterator[None]:
    """Answer Ctrl-C in the block: it says so, and raises KeyboardInterrupt as soon as it can.

    Args:
        name: of the program.
    """
    if threading.current_thread() is not threading.main_thread() or os.name != "posix":
        yield
        return
    heard = threading.Event()

    def interrupt(number: int, frame: FrameType | None) -> None:
        heard.set()
        raise KeyboardInterrupt

    read, write = os.pipe()
    os.set_blocking(write, False)
    handler = signal.signal(signal.SIGINT, interrupt)
    woken = signal.set_wakeup_fd(write, warn_on_full_buffer=False)
    watch = threading.Thread(target=_watch, args=(name, read, heard), daemon=True)
    watch.start()
    try:
        yield
    except Exception as error:  # a library may have made another error of the interrupt
        if heard.is_set():
            raise KeyboardInterrupt from error
        raise
    finally:
        signal.set_wakeup_fd(woken)
        signal.signal(signal.SIGINT, handler)
        os.close(write)  # the thread says what is left to say, and closes the other end
        watch.join(GRACE)


def _watch(name: str, read: int, heard: threading.Event) -> None:
    """Say that the program stops, and end it where it does not."""
    said = False
    while number := os.read(read, 1):
        if number[0] != signal.SIGINT:
            continue
        if said:
            os._exit(STOPPED)
        said = True
        os.write(2, f"{name}: stopping …\n".encode())
        if not _is_heard(read, heard):
            os._exit(STOPPED)
    os.close(read)


def _is_heard(read: int, heard: threading.Event) -> bool:
    """Whether the program hears an interrupt within `GRACE`, and before a second one."""
    end = time.monotonic() + GRACE
    while time.monotonic() < end and not select.select([read], [], [], 0)[0]:
        if heard.wait(_TICK):
            return True
    return heard.is_set()
