"""Change right files by chance and read them: `make fuzz` (ARGS="--cases 5000 --reader robot").

Prints what came of the cases of each reader, and keeps each find with its file in out/fuzz. Exit
code 1: there are finds.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("MUJOCO_GL", "disable")

from campaign import Tally, case, right_files, run
from targets import TARGETS

KINDS = ("read", "refused", "cryptic", "traceback", "crash", "hang")


def main() -> int:
    """Run the campaign; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cases", type=int, default=200_000, help="of all readers together")
    parser.add_argument("--reader", nargs="*", choices=[*TARGETS], default=[*TARGETS])
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--first", type=int, default=0, help="number of the first case")
    parser.add_argument("--out", type=Path, default=Path("out/fuzz"))
    parser.add_argument("--record", type=Path, help="JSON lines to which the counts are added")
    options = parser.parse_args()
    total, tallies = sum(TARGETS[name].share for name in options.reader), {}
    print(f"{'reader':<14}" + "".join(f"{kind:>11}" for kind in KINDS) + f"{'seconds':>11}")
    for name in options.reader:
        count = max(1, round(options.cases * TARGETS[name].share / total))
        tally = run(name, options.seed, range(options.first, options.first + count))
        tallies[name] = tally
        _keep(name, tally, options.seed, options.out)
        if options.record is not None:
            row = {"reader": name, "seed": options.seed, "first": options.first, "cases": count}
            row |= {"counts": dict(tally.counts), "seconds": round(tally.seconds, 1)}
            row["commit"] = _commit()
            with options.record.open("a") as record:
                record.write(json.dumps(row) + "\n")
        counts = "".join(f"{tally.counts[kind]:>11}" for kind in KINDS)
        print(f"{name:<14}{counts}{tally.seconds:>11.0f}", flush=True)
    every = sum((t.counts for t in tallies.values()), type(tally.counts)())
    found = sum(len(t.finds) for t in tallies.values())
    print(f"{every.total()} cases, {found} finds" + (f", kept in {options.out}" if found else ""))
    return int(found > 0)


def _commit() -> str:
    """The commit of the code that runs."""
    done = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=Path(__file__).parent,
                          text=True, capture_output=True, check=False)  # fmt: skip
    return done.stdout.strip()


def _keep(name: str, tally: Tally, seed: int, out: Path) -> None:
    """Write the files of the finds, the first of each kind of message."""
    seen: set[str] = set()
    for kind, number, said in tally.finds:
        last = said.strip().splitlines()[-1]
        where = [line for line in said.splitlines() if line.startswith("  File")]
        key = f"{kind} {where[-1] if where else ''} {last[:40]}"
        if key in seen:
            continue
        seen.add(key)
        folder = out / f"{name.replace(' ', '_')}-{seed}-{number}"
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory() as scratch:
            file, content = case(name, seed, number, right_files(name, Path(scratch)))
        (folder / file).write_bytes(content)
        same = sum(s.strip().splitlines()[-1] == last for _, _, s in tally.finds)
        (folder / "find.json").write_text(
            json.dumps({"kind": kind, "said": said, "alike": same}, indent=1)
        )


if __name__ == "__main__":
    sys.exit(main())
