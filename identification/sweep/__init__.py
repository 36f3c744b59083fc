"""Many tasks of one kind, on one machine or many: methods, tasks, records, and what they come to.

A *method* is a function of settings and a seed that returns one record. A *sweep* is a TOML that
says which methods run with which settings, and how often. Its *tasks* are plain data, so that a
*backend* may run them anywhere and in any order; the records are the same to the bit. They are kept
as Parquet as each task ends. The public names; `docs/sweeps.md` shows their use.
"""

from typing import TYPE_CHECKING

from identification.runtime.lazy import lazy

if TYPE_CHECKING:  # the public names
    # isort: off
    from identification.sweep.method import Method as Method
    from identification.sweep.method import Column as Column
    from identification.sweep.method import Seed as Seed
    from identification.sweep.method import Findings as Findings
    from identification.sweep.task import Sweep as Sweep
    from identification.sweep.config import read_sweep as read_sweep
    from identification.sweep.store import Store as Store
    from identification.sweep.run import run_sweep as run_sweep
    from identification.sweep.backend import Backend as Backend
    from identification.sweep.run import backend_of as backend_of
    from identification.sweep.settings import setting as setting
    from identification.sweep.settings import file_setting as file_setting
    # isort: on
else:
    __all__, __getattr__, __dir__ = lazy(__name__)
