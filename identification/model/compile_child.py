"""A program that compiles a model, whose path stands behind it or whose text is its input.

`identification.model.large` runs it where a model may be large: here that can end no other program.
Exit code 0: compiled, and its size in bytes is said; 3: MuJoCo refuses it, and says why where it is
compiled again; 4: no memory.
"""

import os
import sys

MEMORY = 8 * 2**30  # [bytes] of addresses, of which MuJoCo's library itself takes less than one
SECONDS = 20  # of the processor; the models of robots take a tenth of one
REFUSED, FULL = 3, 4  # exit codes


def main() -> int:
    """Compiles the model; returns the exit code."""
    os.environ["MUJOCO_GL"] = "disable"
    import mujoco

    try:
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    except (ImportError, ValueError, OSError):  # no such limits on this system
        pass
    try:
        if sys.argv[1:]:
            spec = mujoco.MjSpec.from_file(sys.argv[1])
        else:
            spec = mujoco.MjSpec.from_string(sys.stdin.buffer.read().decode())
        sys.stdout.write(f"{mujoco.mj_sizeModel(spec.compile())}\n")
    except MemoryError:
        return FULL
    except Exception as error:  # MuJoCo has errors of its own
        return FULL if "allocate" in str(error) or "bad_alloc" in str(error) else REFUSED
    return 0


if __name__ == "__main__":
    sys.exit(main())
