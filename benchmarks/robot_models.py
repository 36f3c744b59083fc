"""Small robots in the manner of MuJoCo Menagerie: loaded, fitted, and one hidden effect named.

    python benchmarks/robot_models.py [--robots leg crane] [--page]

Four of them are `examples/linkages`, the others lie in `benchmarks/robots/kinds`. Each is simulated
with an effect that its model lacks; the first of two records is fitted and searched, the second
confirms. Rows go to `benchmarks/results/robot_models.jsonl`, and `--page` writes
`docs/robot/models.md` of them. Seconds are those of the processor.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from rows import ROOT, of_newest, rows_of, search_commit

from identification import InputError, discover, fit, read_robot

sys.path.insert(0, str(ROOT / "examples" / "linkages"))
import record as linkages

ROWS = ROOT / "benchmarks" / "results" / "robot_models.jsonl"
PAGE = ROOT / "docs" / "robot" / "models.md"
KINDS = ROOT / "benchmarks" / "robots" / "kinds"
MORE = {
    "arm": linkages.Truth(
        "lift", "coulomb_friction", 0.8, ("pan", "lift", "flex"), 3e-4, 0.0, 0.6
    ),
    "finger": linkages.Truth("tip", "hardening", 0.15, ("knuckle", "tip"), 3e-4, 0.0, 12.0),
    "gripper": linkages.Truth("right", "coulomb_friction", 0.6, ("left", "right"), 2e-5, 0.0, 0.02),
}  # fmt: skip
WORDS = {
    "arm": "an arm with position servos",
    "finger": "a finger whose joints a tendon drives together",
    "leg": "a leg of a quadruped with PD drives",
    "four_bar": "a four-bar closed by a connect",
    "gripper": "a gripper whose fingers a joint equality couples",
    "crane": "a load on two tendons whose lengths are measured",
    "cart": "a cart with an end stop",
}
HEAD = """# Kinds of robots that were tried

`benchmarks/robot_models.py` makes this page. Each robot is a small model in the manner of MuJoCo
Menagerie, simulated with one effect that its model lacks; a log of 8 s at 100 Hz is fitted and
searched, another one confirms. The search tries the few candidates that the robot's file lists, at
every measured joint. One world each: this shows that such models are read, fitted and searched, and
gives no rates.

| robot | lacks | named | right | fit [s] | search [s] |
|---|---|---|---|---|---|
"""


def study(name: str) -> dict[str, Any]:
    """Returns what a fit and a search say of a robot."""
    own = name in linkages.ROBOTS
    folder = (Path(linkages.__file__).parent if own else KINDS) / name
    truth = linkages.ROBOTS[name] if own else MORE[name]
    row: dict[str, Any] = {"robot": name, "lacks": truth.effect, "where": truth.joint}
    with TemporaryDirectory() as place:
        logs = []
        for log, seed in (("first", 1), ("second", 2)):
            table, header = linkages.record(folder / "model.xml", truth, seed)
            logs.append(Path(place) / f"{log}.csv")
            np.savetxt(logs[-1], table, "%.7g", ",", header=header, comments="")
        try:
            robot = read_robot(folder / "robot.toml", logs[0], confirm=[logs[1]])
            begun = time.process_time()
            row["values"] = dict(fit(robot).values)
            row["fit_s"] = time.process_time() - begun
            begun = time.process_time()
            found = discover(robot)
        except InputError as error:
            return {**row, "refused": str(error).replace(place, "")}
    row["search_s"] = time.process_time() - begun
    row["verdict"] = str(found)
    row["named"] = [
        {"name": n.name, "where": n.where, "confidence": n.confidence} for n in found.named
    ]
    return row


def is_right(row: dict[str, Any]) -> bool:
    """Returns whether the hidden effect is named first, at its joint."""
    named = row.get("named") or [{}]
    name = str(named[0].get("name", "")).removeprefix("slide_")
    return len(named) == 1 and name == row["lacks"] and row["where"] in str(named[0].get("where"))


def page() -> str:
    """Returns the page of the newest rows."""
    rows = of_newest(rows_of(ROWS))
    lines = []
    for row in rows:
        said = "; ".join(f"`{n['name']}` at {n['where']}" for n in row.get("named", ()))
        said = said or ("refused" if "refused" in row else "nothing")
        times = (f"{row[k]:.0f}" if k in row else "" for k in ("fit_s", "search_s"))
        lines.append(
            f"| {WORDS[row['robot']]} | `{row['lacks']}` at {row['where']} | {said} |"
            f" {'yes' if is_right(row) else 'no'} | {' | '.join(times)} |"
        )
    return HEAD + "\n".join(lines) + f"\n\nAll rows are of commit {rows[-1]['commit']}.\n"


def main() -> None:
    """Make the rows, and the page where asked."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--robots", nargs="*", choices=[*WORDS], default=[*WORDS])
    parser.add_argument("--page", action="store_true", help="write docs/robot/models.md")
    asked = parser.parse_args()
    for name in asked.robots:
        row = {"key": name, "commit": search_commit(), **study(name)}
        with ROWS.open("a", encoding="utf-8") as file:
            file.write(json.dumps(row) + "\n")
        print(name, row.get("named", row.get("refused")), flush=True)
    if asked.page:
        PAGE.write_text(page(), encoding="utf-8")


if __name__ == "__main__":
    main()
