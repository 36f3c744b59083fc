"""What the commands answer, kept so that a change of the code's shape is seen not to change it.

    python benchmarks/golden.py --against COMMIT [--quick]    both answer here: equal to the bit
    python benchmarks/golden.py [--quick]                     beside `benchmarks/golden/`
    python benchmarks/golden.py --write [--quick]             keeps the answers there

An answer is the JSON of a command less its seconds, the text that it prints and, of a search, the
text of its report. Other processors end sums in other digits, and a search may take another step
for that: what is kept shows a change and proves none. Two commits on one machine are equal to the
bit, or they are not. Cases whose logs are absent are skipped and named. `--quick` takes two
minutes.
"""

from __future__ import annotations

import argparse
import io
import json
import os
import re
import subprocess
import sys
import tarfile
import tempfile
from collections.abc import Iterator, Mapping
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

from golden_logs import write_logs

ROOT = Path(__file__).resolve().parents[1]
KEPT = ROOT / "benchmarks" / "golden"
DATA = ROOT.parent / "shared" / "data"
SHOWN = 12  # differences of a case
DIGITS = 4  # that are kept and compared where the machine is another one
TIMES = {"seconds", "stages", "versions", "configuration", "processor_seconds"}  # told by no answer
A_TIME = re.compile(r"\b\d+(\.\d+)? ?(s|min|ms)\b")
INCA, ANY = "inca_mj", "identification"
# Name, program, arguments; MADE, DATA and EXAMPLES are folders.
QUICK: tuple[tuple[str, str, str], ...] = (
    ("compare", INCA, "compare EXAMPLES/log.csv"),
    ("identify", INCA, "identify EXAMPLES/log.csv --free lambda b J K_t"),
    ("linearize", INCA, "linearize --pose 0.2 0 1.3 0 0 0"),
    ("pendulum_fit", ANY, "fit MADE/pendulum.toml MADE/pendulum_log.csv"),
    ("pendulum_fit_free_run", ANY, "fit MADE/pendulum_free.toml MADE/pendulum_log.csv"),
    ("pendulum", ANY, "discover MADE/pendulum.toml MADE/pendulum_log.csv"),
    ("cart", ANY, "discover MADE/cart.toml MADE/cart_log.csv"),
    ("shipped_alike", INCA, "discover EXAMPLES/log.csv --spread none --no-film"),
)
REST: tuple[tuple[str, str, str], ...] = (
    ("calibrate", INCA, "calibrate EXAMPLES/log.csv"),
    ("shipped", INCA, "discover EXAMPLES/log.csv --no-film"),
    ("practice_null", INCA, "discover DATA/practice_prbs/log_001.csv --no-film"),
    ("practice_single", INCA, "discover DATA/practice_multisine/log_008.csv --no-film"),
    ("practice_pair", INCA, "discover DATA/practice_multisine/log_025.csv --no-film"),
    ("practice_unknown", INCA, "discover DATA/practice_multisine/log_028.csv --no-film"),
    ("spread_robot", INCA, "discover DATA/practice_robots/robot_02_a.csv --no-film"),
    ("three_records", INCA, "discover DATA/practice_robots/robot_07_a.csv"
     " DATA/practice_robots/robot_07_b.csv DATA/practice_robots/robot_07_c.csv --no-film"),
    ("cart_free_run", ANY, "discover MADE/cart_free.toml MADE/cart_log.csv"),
    ("arm", ANY, "discover MADE/arm.toml MADE/arm_log.csv"),
    ("arm_null", ANY, "discover MADE/arm.toml MADE/arm_null_log.csv"),
    ("elastic", ANY, "discover MADE/elastic.toml MADE/elastic_log.csv"),
    ("elbow", ANY, "discover EXAMPLES/elbow/elbow.toml EXAMPLES/elbow/first.csv"
     " --confirm EXAMPLES/elbow/second.csv"),
    ("linearize_arm", ANY, "linearize MADE/arm.toml"),
)  # fmt: skip


def main() -> int:
    """Answer the cases and compare them; 1 where one differs."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="the cases of two minutes")
    parser.add_argument("--only", nargs="+", metavar="CASE", help="names of cases")
    parser.add_argument("--against", metavar="COMMIT", help="is asked the same, here and now")
    parser.add_argument("--write", action="store_true", help="keep the answers")
    given = parser.parse_args()
    cases = [*QUICK, *(() if given.quick and not given.only else REST)]
    names = [case[0] for case in cases]
    unknown = [name for name in given.only or () if name not in names]
    if unknown:
        parser.error(f"no case {', '.join(unknown)}; the cases are {', '.join(names)}")
    cases = [case for case in cases if not given.only or case[0] in given.only]
    different = 0
    with tempfile.TemporaryDirectory() as made, tempfile.TemporaryDirectory() as trees:
        write_logs(Path(made))
        other = None if given.against is None else checkout(given.against, Path(trees))
        for name, program, line in cases:
            folders = {"MADE": made, "DATA": str(DATA), "EXAMPLES": str(ROOT / "examples")}
            if "DATA" in line and not DATA.is_dir():
                print(f"{name}: skipped, its logs are not here", flush=True)
                continue
            now = answer(ROOT, program, line, folders)
            if now["code"] not in (0, 1) or not now["result"]:
                print(f"{name}: no answer, {' '.join(now['said'])}", flush=True)
                different += 1
                continue
            if given.write:
                keep(name, now)
                print(f"{name}: kept", flush=True)
                continue
            before = kept(name) if other is None else answer(other, program, line, folders)
            lines = [*differences(before, now if other else rounded(now))]
            different += bool(lines)
            more = [f"and {len(lines) - SHOWN} more"] if len(lines) > SHOWN else []
            told = "differs" if lines else "equal"
            print(f"{name}: {told}", *lines[:SHOWN], *more, sep="\n  ", flush=True)
    return int(different > 0)


def checkout(commit: str, folder: Path) -> Path:
    """Returns a folder with the files of a commit."""
    done = subprocess.run(["git", "archive", commit], cwd=ROOT, capture_output=True, check=False)
    if done.returncode:
        sys.exit(f"golden.py: {done.stderr.decode().strip()}")
    packed = done.stdout
    with tarfile.open(fileobj=io.BytesIO(packed)) as archive:
        archive.extractall(folder, filter="data")
    return folder


def answer(tree: Path, program: str, line: str, folders: Mapping[str, str]) -> dict[str, Any]:
    """Returns what a command of a checkout answers: its exit code, result, text and report."""
    with tempfile.TemporaryDirectory() as out:
        words = [re.sub("|".join(folders), lambda m: folders[m[0]], word) for word in line.split()]
        command = [sys.executable, "-m", program, *words, "--quiet", "--out", f"{out}/out"]
        done = subprocess.run(
            command, cwd=tree, env={**os.environ, "PYTHONPATH": str(tree)},
            capture_output=True, text=True, check=False,
        )  # fmt: skip
        places = {**folders, "OUT": out, "TREE": str(tree)}
        result, report = Path(out, "out", "result.json"), Path(out, "out", "report.html")
        found = json.loads(result.read_text(encoding="utf-8")) if result.exists() else {}
        page = Words.of(report.read_text(encoding="utf-8")) if report.exists() else []
        return {
            "code": done.returncode,
            "result": without_times(found, places),
            "said": [without_places(each, places) for each in done.stderr.splitlines()],
            "text": [without_places(each, places) for each in done.stdout.splitlines()],
            "report": [without_places(each, places) for each in page],
        }


def without_times(found: Any, places: Mapping[str, str]) -> Any:
    """The result less what another run tells otherwise."""
    if isinstance(found, dict):
        return {k: without_times(v, places) for k, v in found.items() if k not in TIMES}
    if isinstance(found, list):
        return [without_times(v, places) for v in found]
    return without_places(found, places) if isinstance(found, str) else found


def without_places(text: str, places: Mapping[str, str]) -> str:
    """A line with names in the place of folders, and without times."""
    for name, place in places.items():
        text = text.replace(place, name)
    return A_TIME.sub("TIME", text)


class Words(HTMLParser):
    """The text of a page, a line for each piece, without what a browser runs or draws."""

    def __init__(self) -> None:
        super().__init__()
        self.lines: list[str] = []
        self.inside = 0

    @staticmethod
    def of(page: str) -> list[str]:
        """Returns the text of a page."""
        words = Words()
        words.feed(page)
        return words.lines

    def handle_starttag(self, tag: str, attrs: Any) -> None:
        self.inside += tag in {"script", "style", "svg"}

    def handle_endtag(self, tag: str) -> None:
        self.inside -= tag in {"script", "style", "svg"}

    def handle_data(self, data: str) -> None:
        if not self.inside and data.strip():
            self.lines.append(" ".join(data.split()))


def differences(a: Any, b: Any, where: str = "") -> Iterator[str]:
    """Yields a line for each place at which two answers differ."""
    if isinstance(a, dict) and isinstance(b, dict):
        for key in [*a, *(k for k in b if k not in a)]:
            yield from differences(a.get(key), b.get(key), f"{where}/{key}")
    elif isinstance(a, list) and isinstance(b, list) and len(a) == len(b):
        for k, pair in enumerate(zip(a, b, strict=True)):
            yield from differences(*pair, f"{where}/{k}")
    elif a != b:
        short = [repr(x)[:80] for x in (a, b)]
        yield f"{where}: {short[0]} became {short[1]}"


def rounded(found: Any) -> Any:
    """An answer with a few digits of each number; of its text and report the words alone."""
    if isinstance(found, dict):
        return {k: rounded(v) for k, v in found.items()}
    if isinstance(found, list):
        return [rounded(v) for v in found]
    if isinstance(found, float):
        return float(f"{found:.{DIGITS}g}")
    return re.sub(r"[-−]?\d+(\.\d+)?(e[-+]?\d+)?", "#", found) if isinstance(found, str) else found


def keep(name: str, now: dict[str, Any]) -> None:
    """Write an answer into the folder of those that are kept."""
    KEPT.mkdir(exist_ok=True)
    text = json.dumps(rounded(now), ensure_ascii=False)  # a line: `differences` tells what changed
    (KEPT / f"{name}.json").write_text(text + "\n", encoding="utf-8")


def kept(name: str) -> Any:
    """Returns an answer that is kept; an empty one where there is none."""
    path = KEPT / f"{name}.json"
    return json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}


if __name__ == "__main__":
    sys.exit(main())
