"""Saves results in a child that is killed, or whose disk fails, at each of its calls in turn.

    python saving_cases.py kill|ENOSPC|full CASE FOLDER

Each call that opens a file to write, makes, links, renames or removes a name, or brings a file to
the disk is met once. What every command does with its results (`conclude`) is run in a child, and
after it the folder is looked at as a user finds it, and as the next run finds it. Prints one JSON
list: each call with the exit code and what the folder then held, old, new or a part.
"""

import errno
import json
import os
import subprocess
import sys
from dataclasses import dataclass, field
from functools import cache
from itertools import count
from pathlib import Path

from folder_cases import list_foreign

from identification.commands.common import Output, conclude
from identification.errors import InputError
from identification.storage import results
from identification.storage.files import write_text
from identification.storage.folders import draft_of, refuse_foreign

CALLS = ("os.rename", "os.mkdir", "os.link", "os.remove", "os.rmdir", "os.chmod", "os.utime")
WRITES = os.O_WRONLY | os.O_RDWR | os.O_CREAT
OLD = {"result.json": "old", "robot.toml": "old", "film.mp4": "old"}
LONG = 6000  # letters of a file, more than a page of a disk
LEFT = (".draft-", ".moving-")  # names of what a killed program leaves
MINE = {".mine": "hidden", "notes/log.csv": "time,u\n0,1\n"}  # what a user may have in the folder


@dataclass(frozen=True)
class Command:
    """What `conclude` needs of a command."""

    output: Output = field(default_factory=Output)


def save(out: Path) -> None:
    """Save results as a command does: two files, then a report."""
    conclude(
        Command(Output(json=True, out=out, quiet=True)), {"value": 1}, "",
        keep=lambda folder: write_text(folder / "robot.toml", "new".ljust(LONG)),
        draw=lambda folder: write_text(folder / "report.html", "new".ljust(LONG)),
    )  # fmt: skip


def prepare(case: str, out: Path) -> None:
    """Make the folder of a case: new, older, hidden (a file of a user), folders."""
    if case == "new":
        return
    out.mkdir(parents=True)
    with draft_of(out) as draft:
        for name, text in OLD.items():
            (draft.folder / name).write_text(text)
        draft.save()
    for name in {"hidden": [".mine"], "folders": MINE}.get(case, ()):
        (out / name).parent.mkdir(exist_ok=True)
        (out / name).write_text(MINE[name])


def content(folder: Path) -> dict[str, str]:
    """The files of a folder and of those in it, but for the record and what is left of a kill."""
    if not folder.exists():
        return {}
    names = [f.relative_to(folder).as_posix() for f in folder.rglob("*") if f.is_file()]
    kept = [n for n in names if not n.startswith((*LEFT, ".made.json"))]
    texts = {name: (folder / name).read_text().strip() for name in kept}
    if "result.json" in texts and is_new(folder / "result.json"):
        texts["result.json"] = "new"
    return texts


def is_new(path: Path) -> bool:
    """Whether a result.json is whole and that of `save`."""
    text = path.read_text()
    return text != "old" and json.loads(text)["value"] == 1


def child(out: Path, number: int, what: str, met: int) -> int:
    """Save in a child that meets the call of a number; its exit code, 9 where it was killed."""
    process = os.fork()
    if process:
        return os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])
    seen = count()

    def meet(name: str) -> None:
        if next(seen) == number:
            os.write(met, f"{name}\n".encode())
            if what == "kill":
                os._exit(9)
            code = getattr(errno, what)
            raise OSError(code, os.strerror(code))

    def hook(event: str, arguments: tuple[object, ...]) -> None:
        if event in CALLS or (event == "open" and int(arguments[2] or 0) & WRITES):
            meet(event)

    os.fsync = lambda file: meet("os.fsync")
    with open(os.devnull, "w") as nowhere:
        sys.stdout = sys.stderr = nowhere
        sys.addaudithook(hook)
        try:
            save(out)
        except (InputError, OSError):  # as `run_program` does
            os._exit(2)
    os._exit(0)


def main(what: str, case: str, place: str) -> None:
    """Meet every call once, and check the folder after each."""
    os.fsync = lambda file: None  # no kill of a process tells whether a disk has a file
    results.package_version = cache(results.package_version)  # files of packages, each read once
    read, met = os.pipe()
    os.set_blocking(read, False)
    found = []
    for number in count():
        home = Path(place) / str(number)
        home.mkdir(parents=True)
        out = home / "out"
        prepare(case, out)
        before, names = content(out), sorted(p.name for p in home.iterdir())
        mine = {name: text for name, text in before.items() if name in MINE}
        new = {"result.json": "new", "robot.toml": "new", **mine}
        whole = [new, {**new, "report.html": "new"}]
        code, left = child(out, number, what, met), content(out)
        try:
            call = os.read(read, 4096).decode().strip()
        except BlockingIOError:  # all calls were met before
            break
        state = "old" if left == before else "new" if left in whole else "part"
        found.append((call, code, state))
        assert code in ((9,) if what == "kill" else (0, 2)), found[-1]
        assert {**left, **mine} == left, (found[-1], left)  # files of the user stay
        if code == 9:
            refuse_foreign(out)  # the next run accepts it, and finishes what was begun
            assert content(out) in ([before] if state == "old" else []) + whole, (found[-1], left)
        elif code == 2:  # nothing was written or touched
            assert left == before, (found[-1], left)
            assert sorted(p.name for p in home.iterdir()) == names, found[-1]
        else:
            assert left in whole, (found[-1], left)
        assert list_foreign(out) == []
        save(out)
        assert content(out) == whole[1], (found[-1], content(out))
        hidden = [p.name for p in (*home.iterdir(), *out.iterdir()) if p.name.startswith(LEFT)]
        assert hidden == [] or code != 9, (found[-1], hidden)  # those of killed programs go
    sys.__stdout__.write(json.dumps(found) + "\n")


def fill_disks(case: str, place: str) -> None:
    """Save on disks of more and more pages, and check the folder after each."""
    found = []
    for pages in range(2, 24):
        home = Path(place)
        subprocess.run(
            ["mount", "-t", "tmpfs", "-o", f"size={4 * pages}k", "none", place], check=True
        )
        try:
            prepare(case, home / "out")
        except (InputError, OSError):  # not even the old results have room
            subprocess.run(["umount", place], check=True)
            continue
        before = content(home / "out")
        code, left = child(home / "out", -1, "ENOSPC", 2), content(home / "out")
        whole = [{"result.json": "new", "robot.toml": "new"}]
        whole += [{**whole[0], "report.html": "new"}]
        assert left == before if code == 2 else left in whole, (pages, code, left)
        refuse_foreign(home / "out")
        found.append((code, "report.html" in left))
        subprocess.run(["umount", place], check=True)
    sys.__stdout__.write(json.dumps(found) + "\n")


if __name__ == "__main__":
    sys.stdout = open(os.devnull, "w")  # noqa: SIM115
    fill_disks(*sys.argv[2:]) if sys.argv[1] == "full" else main(*sys.argv[1:])
