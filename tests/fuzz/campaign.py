"""Cases of one reader, each in a process that may die of it; every case can be made again.

A case is its reader, a seed and a number. Right is what is read, or refused by an InputError of one
line. Anything else is a find: another exception, a death of the process, or no end.
"""

from __future__ import annotations

import faulthandler
import multiprocessing
import os
import random
import resource
import tempfile
import time
import traceback
import warnings
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from multiprocessing.sharedctypes import Synchronized
from pathlib import Path
from typing import Any

from mutation import mutated
from targets import TARGETS

from identification.errors import InputError

PATIENCE = 30.0  # [s] of the processor for one case
WAITING = 20  # times as long for one that waits, or whose machine has others to serve
_TICK = 0.1  # [s]
MEMORY = 4 * 2**30  # [bytes] beyond what the process has at first
_LONGEST = 2000  # letters of a message


@dataclass
class Tally:
    """What came of the cases of one reader; `finds` are (kind, number, what was said)."""

    counts: Counter[str] = field(default_factory=Counter)
    finds: list[tuple[str, int, str]] = field(default_factory=list)
    seconds: float = 0.0


def case(name: str, seed: int, number: int, right: dict[str, bytes]) -> tuple[str, bytes]:
    """The changed file of a case: its name and its bytes."""
    chance = random.Random(f"{name}/{seed}/{number}")
    file = chance.choice(TARGETS[name].changed)
    return file, mutated(right[file], chance)


def right_files(name: str, folder: Path) -> dict[str, bytes]:
    """The right files of a reader, which are also written into a folder."""
    TARGETS[name].make(folder)
    return {file: (folder / file).read_bytes() for file in TARGETS[name].changed}


def outcome(name: str, folder: Path) -> tuple[str, str]:
    """What a reader makes of a folder: read, refused, or a find and what was said."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            TARGETS[name].read(folder)
    except InputError as error:
        said = str(error)
        if "\n" in said or not said.isprintable() or len(said) > _LONGEST:
            return "cryptic", repr(said)
        return "refused", said
    except Exception:  # the finds of a fuzzer
        return "traceback", traceback.format_exc()
    return "read", ""


def run(name: str, seed: int, numbers: range) -> Tally:
    """The cases of a reader.

    Args:
        name: of the reader.
        seed: of all cases.
        numbers: which cases.
    """
    context, tally, begun = multiprocessing.get_context("fork"), Tally(), time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        right = right_files(name, Path(folder))
        TARGETS[name].read(Path(folder))  # is right
        first = numbers.start
        while first < numbers.stop:
            at = context.Value("q", first - 1)
            receive, send = context.Pipe(duplex=False)
            process = context.Process(
                target=_work,
                args=(name, seed, range(first, numbers.stop), right, Path(folder), at, send),
            )
            process.start()
            send.close()
            for kind, number, said in _told(receive, process, at):
                tally.counts[kind] += 1
                if kind not in ("read", "refused"):
                    tally.finds.append((kind, number, said))
            process.join()
            first = at.value + 1
    tally.seconds = time.perf_counter() - begun
    return tally


def _work(
    name: str, seed: int, numbers: range, right: dict[str, bytes], folder: Path,
    at: Synchronized[int], send: Any,
) -> None:  # fmt: skip
    """Read case after case and tell what came of each."""
    faulthandler.disable()  # a crash is counted
    pages = int(Path("/proc/self/statm").read_text().split()[0])
    limit = pages * resource.getpagesize() + MEMORY
    resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    for number in numbers:
        at.value = number
        file, content = case(name, seed, number, right)
        for other, usual in right.items():
            (folder / other).write_bytes(content if other == file else usual)
        send.send((*outcome(name, folder), number))
    send.close()


def _told(receive: Any, process: Any, at: Synchronized[int]) -> Iterator[tuple[str, int, str]]:
    """What a process tells until it ends, and how it ended if not by itself."""
    last = at.value
    while True:
        if not _in_time(receive, process):
            process.kill()
            process.join()
            yield "hang", at.value, f"no end within {PATIENCE:g} s of the processor"
            return
        try:
            kind, said, last = receive.recv()
        except EOFError:
            process.join()
            if process.exitcode:
                at.value = max(at.value, last)
                yield "crash", at.value, f"exit code {process.exitcode}"
            return
        yield kind, last, said


def _in_time(receive: Any, process: Any) -> bool:
    """Whether a process tells something, or ends, before the patience with it does."""
    began, used = time.monotonic(), _processor_time(process.pid)
    while not receive.poll(_TICK):
        if _processor_time(process.pid) - used > PATIENCE:
            return False
        if time.monotonic() - began > WAITING * PATIENCE:
            return False
    return True


def _processor_time(number: int) -> float:
    """What a process has taken of the processor [s]; proc(5) tells the fields."""
    behind_name = Path(f"/proc/{number}/stat").read_text().rpartition(")")[2].split()
    return sum(int(behind_name[k]) for k in (11, 12)) / os.sysconf("SC_CLK_TCK")
