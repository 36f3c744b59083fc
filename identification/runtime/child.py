"""A process of its own reads one file that nobody vouches for: it can end no other program.

MuJoCo cannot be stopped while it compiles a model, and scipy's reader of MATLAB files is machine
code that a damaged file can crash, or make fill the memory. This file is also the program of that
process, `python -I child.py TASK [PATH]`, so that it imports nothing of the package.
"""

from __future__ import annotations

import io
import os
import subprocess
import sys
import warnings

MEMORY = 8 * 2**30  # [bytes] of addresses: sixteen times the largest file of a log
SECONDS = 20  # of the processor, for a model; those of robots take a tenth of one
REFUSED, FAILED = 3, 4  # exit codes: the library says why; damaged, or no memory
MATRIX, ODD = "=", "?"  # before the name of a full real matrix, and of anything else
KINDS = "fiub"


def run_child(
    task: str, raw: bytes, timeout: float, path: str = ""
) -> subprocess.CompletedProcess[bytes]:
    """Runs a task of `TASKS` in a process of its own.

    Args:
        task: its name.
        raw: what the process reads, on stdin.
        timeout: after which the process is ended [s].
        path: of a file that it reads instead.

    Raises:
        subprocess.TimeoutExpired: it was ended.
    """
    words = [task, path] if path else [task]
    return subprocess.run(
        [sys.executable, "-I", __file__, *words], input=raw, capture_output=True,
        timeout=timeout, check=False,
    )  # fmt: skip


def read_matlab(raw: bytes) -> bytes:
    """Returns a MATLAB file's variables as .npz; only the name of what is no full real matrix."""
    import numpy as np
    from scipy.io import loadmat

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # they are about variables that are not used
        content = loadmat(io.BytesIO(raw))
    out, arrays = io.BytesIO(), {}
    for name, value in content.items():
        if name.startswith("__"):
            continue
        good = isinstance(value, np.ndarray) and value.dtype.kind in KINDS and value.ndim == 2
        arrays[(MATRIX if good else ODD) + name] = value if good else np.zeros(0)
    np.savez(out, allow_pickle=False, **arrays)
    return out.getvalue()


def compile_model(raw: bytes) -> bytes:
    """Returns the size of a compiled model [bytes], as digits."""
    import mujoco

    path = sys.argv[2:]
    spec = mujoco.MjSpec.from_file(*path) if path else mujoco.MjSpec.from_string(raw.decode())
    return str(mujoco.mj_sizeModel(spec.compile())).encode()


TASKS = {"matlab": read_matlab, "model": compile_model}


def main() -> int:
    """Does the task that the command line names, from stdin to stdout; returns the exit code."""
    os.environ["MUJOCO_GL"] = "disable"
    task = sys.argv[1]
    try:
        import resource

        if task == "model":
            import mujoco  # noqa: F401  its library is loaded before memory and time are bounded

            resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    except (ImportError, ValueError, OSError):  # no such limits on this system
        pass
    try:
        sys.stdout.buffer.write(TASKS[task](sys.stdin.buffer.read()))
    except NotImplementedError:  # MATLAB 7.3
        return REFUSED
    except Exception as error:  # a damaged file may raise any exception, and MuJoCo has its own
        is_full = isinstance(error, MemoryError) or any(
            word in str(error) for word in ("allocate", "bad_alloc")
        )
        return FAILED if task == "matlab" or is_full else REFUSED
    return 0


if __name__ == "__main__":
    sys.exit(main())
