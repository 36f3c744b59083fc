"""Sweeps for tests, and their records without times."""

import json
from pathlib import Path

import pyarrow.dataset

from identification.sweep.config import read_sweep
from identification.sweep.rows import RUN, comparable
from identification.sweep.run import Serial, run_sweep
from identification.sweep.store import Store

METHOD = Path(__file__).parent / "sweep_method.py"
GRID = "[study.grid]\nsize = [0.5, 2, 8]\nword = ['a', 'b']\n"


def write(folder, text=GRID, count=2, name="TOSS", head="seed = 7\n"):
    """The TOML of a sweep of tosses."""
    folder.mkdir(exist_ok=True)
    path = folder / "tosses.toml"
    path.write_text(f"{head}[[study]]\nmethod = '{METHOD}:{name}'\ncount = {count}\n{text}")
    return path


def run(path, folder, backend=None, known=(), **how):
    """Run a sweep; the text of its records without times."""
    with Store(read_sweep(path, dict(known)), folder) as store:
        run_sweep(store, backend or Serial(), **how)
        store.finish()
        return [*comparable(store.rows())]


def read(folder):
    """The records as anyone reads them: the Parquet files of a folder, without times, in order."""
    table = pyarrow.dataset.dataset(folder / "records").to_table().sort_by("task")
    return [
        json.dumps({k: v for k, v in row.items() if not k.startswith(RUN)}, sort_keys=True)
        for row in table.to_pylist()
    ]
