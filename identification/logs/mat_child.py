"""A program that turns a MATLAB file on stdin into plain arrays on stdout, for `read_mat`.

scipy's reader is machine code that a damaged file can crash, or make fill the memory. Here it can
end no other program. Exit code 3: version 7.3; 4: any other error.
"""

import io
import sys
import warnings

import numpy as np

MEMORY = 8 * 2**30  # [bytes] of addresses: sixteen times the largest file
NEWER, DAMAGED = 3, 4  # exit codes
MATRIX, ODD = "=", "?"  # before the name of a full real matrix, and of anything else
KINDS = "fiub"


def convert(raw: bytes) -> bytes:
    """Returns a MATLAB file's variables as .npz; only the name of what is no full real matrix."""
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


def main() -> int:
    """Convert stdin to stdout; returns the exit code."""
    try:
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    except (ImportError, ValueError, OSError):  # no such limits on this system
        pass
    try:
        sys.stdout.buffer.write(convert(sys.stdin.buffer.read()))
    except NotImplementedError:
        return NEWER
    except Exception:  # a damaged file may raise any exception
        return DAMAGED
    return 0


if __name__ == "__main__":
    sys.exit(main())
