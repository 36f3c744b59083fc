"""How often a discovery names the right effect; prints one JSON object.

    python benchmarks/discovery.py --practice FOLDER [--only single/1.0/] [--jobs 2]
    python benchmarks/discovery.py --worlds 60 --seed 1000 --ratio 3 --coloured --wrong-shapes
    python benchmarks/discovery.py --null-study 300 [--coloured]

Logs with labels, hidden worlds of the independent reference, or the scores alone where nothing is
missing. Every finished log is one line of `--out`, and `--resume` goes on after the last of them;
progress goes to stderr. Rates have Wilson's 95 % intervals.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import time
import traceback
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from discovery_null import null_summary, null_task, null_tasks
from discovery_statistics import summary
from discovery_tasks import COUNTS, USUAL, logs_of, practice_tasks, world_tasks

THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")


def pinned(count: Any) -> None:
    """A core for this process: many small matrices, and other processes beside it."""
    cores = sorted(os.sched_getaffinity(0))
    with count.get_lock():
        os.sched_setaffinity(0, {cores[count.value % len(cores)]})
        count.value += 1


def answer_of(found: Any) -> dict[str, Any]:
    """A discovery as a row keeps it."""
    from identification.report.finding_json import finding_to_json

    above = found.before.rms**2 - min(found.noise_rms**2 + found.disturbance_rms**2,
                                      found.after.rms**2)  # fmt: skip
    named = [
        {
            "name": n.candidate.effect.name, "where": n.candidate.where,
            "confidence": n.confidence, "one_of": n.one_of,
            "set": [r.candidate.effect.name for r in n.rivals
                    if n.one_of and r.candidate.effect.name != n.candidate.effect.name],
            "sizes": {name: p[0] for name, p in n.parameters.items()},
            "t": n.proof.t, "share": n.proof.share, "gain": n.gain,
        }
        for n in found.named
    ]  # fmt: skip
    return {
        "verdict": found.verdict, "unexplained": found.unexplained, "named": named,
        "findings": [finding_to_json(finding) for finding in found.findings],
        "before": found.before.rms, "after": found.after.rms, "noise": found.noise_rms,
        "disturbance": found.disturbance_rms,
        "gap_closed": (found.before.rms**2 - found.after.rms**2) / above if above > 0 else None,
        "scores": [[s.candidate.effect.name, s.candidate.where, s.gain] for s in found.scores[:5]],
        "stages": dict(found.seconds),
    }  # fmt: skip


def study(task: dict[str, Any]) -> dict[str, Any]:
    """One log from its making to its answer; an error is a row too."""
    begin = time.perf_counter()
    try:
        logs, truth = logs_of(task)
        from inca_mj.workflows.discovery import discover
        from inca_mj.workflows.spread import spread_of

        # a world stands at rest with what it lacks, as a robot that was let go; practice was held
        spread = spread_of(task["spread"])
        answer = answer_of(discover(logs, settled="seed" in task, spread=spread))
    except Exception as error:
        return {"key": task["key"], "error": f"{type(error).__name__}: {error}",
                "trace": traceback.format_exc(limit=-3)}  # fmt: skip
    return {"key": task["key"], "truth": truth, "answer": answer,
            "seconds": time.perf_counter() - begin}  # fmt: skip


def run(work: Any, tasks: list[dict[str, Any]], jobs: int, out: Path) -> None:
    """Every task in its turn; each result is written down at once."""
    begin, spawn = time.perf_counter(), get_context("spawn")
    count = spawn.Value("i", 0)
    with (
        ProcessPoolExecutor(
            jobs, spawn, initializer=pinned if jobs > 1 else None, initargs=(count,) * (jobs > 1)
        ) as pool,
        out.open("a") as file,
    ):
        futures = {pool.submit(work, task): task for task in tasks}
        for n, future in enumerate(as_completed(futures), 1):
            try:
                rows = future.result()
            except Exception as error:  # a process died
                rows = {"key": futures[future]["key"], "error": f"{type(error).__name__}: {error}"}
            for row in rows if isinstance(rows, list) else [rows]:
                file.write(json.dumps(row) + "\n")
            file.flush()
            said = rows if isinstance(rows, dict) else rows[-1]
            print(f"{n}/{len(tasks)} {time.perf_counter() - begin:.0f} s {line(said)}",
                  file=sys.stderr, flush=True)  # fmt: skip


def line(row: dict[str, Any]) -> str:
    """A row in a line."""
    if "error" in row:
        return f"{row['key']}: {row['error']}"
    if "answer" not in row:
        return f"{row['key']}: {', '.join(row['false']) or 'no name'}"
    true = " + ".join(e["name"] for e in row["truth"]["effects"]) or "nothing"
    named = " + ".join(
        f"{n['name']}, {n['where']} ({n['confidence']:.2f})" for n in row["answer"]["named"]
    )
    return f"{row['key']}: {true} -> {named or row['answer']['verdict']} ({row['seconds']:.0f} s)"


def kept(out: Path, keys: set[str]) -> list[dict[str, Any]]:
    """Rows of a file whose keys (or robots) are asked for, the last of each."""
    rows = {}
    for text in out.read_text().splitlines() if out.exists() else ():
        try:
            row = json.loads(text)
        except json.JSONDecodeError:  # an interrupted line
            continue
        if row["key"] in keys or row["key"].rpartition("/")[0] in keys:
            rows[row["key"]] = row
    return list(rows.values())


def main() -> None:
    """Run the study that is asked for."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    add = parser.add_argument
    add("--practice", type=Path, nargs="+", default=[], help="folders with labels.json")
    add("--only", default="", help="kind/ratio/name, each may be empty")
    add("--worlds", type=int, default=0)
    add("--null-study", type=int, default=0)
    add("--robots", type=int, default=10, help="of the null study")
    add("--seed", type=int, default=1000)
    add("--ratio", type=float, default=None, help="1, 3 or 10 by chance when not given")
    add("--duration", type=float, default=USUAL, help="of a world [s]")
    for flag in ("--coloured", "--wrong-shapes", "--null", "--as-built", "--resume"):
        add(flag, action="store_true")
    add("--effects", type=int, default=1, choices=COUNTS, help="hidden in a world")
    add("--records", type=int, default=1, help="of a world, each with its input and start")
    add("--spread", default="usual", help="none, usual, or a file")
    add("--limit", type=int, default=None, help="logs at most")
    add("--jobs", type=int, default=1)
    add("--out", type=Path, default=Path("out/discovery.jsonl"))
    options = parser.parse_args()
    tasks = [t for folder in options.practice for t in practice_tasks(folder, options.only)]
    tasks += world_tasks(options)
    work: Any = study
    if options.null_study:
        work, draws = null_task, max(1, options.null_study // options.robots)
        tasks = null_tasks(options, draws)
    tasks = [{**task, "spread": options.spread} for task in tasks[: options.limit]]
    options.out.parent.mkdir(parents=True, exist_ok=True)
    if not options.resume:
        options.out.unlink(missing_ok=True)
    keys = {t["key"] for t in tasks}
    done = {r["key"] for r in kept(options.out, keys) if "error" not in r}
    done |= {key.rpartition("/")[0] for key in done}
    for name in THREADS:  # before the processes start: libraries read them once
        os.environ[name] = "1"
    run(work, [t for t in tasks if t["key"] not in done], options.jobs, options.out)
    rows = kept(options.out, keys)
    if options.null_study:
        print(json.dumps(null_summary(rows)))
    else:
        print(json.dumps({"summary": summary(rows), "logs": rows}))


if __name__ == "__main__":
    main()
