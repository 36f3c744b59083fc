"""The whole cross-check: derivatives, then all cases at all steps."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor

from identification.errors import InputError
from identification.model.parameter import ParameterSet
from identification.model.rollout import substeps
from inca_mj.robot.geometry import INCA, Geometry
from inca_mj.robot.inputs import LONGEST
from inca_mj.robot.parameters import parameter_set
from inca_mj.verification.derivatives import compare_derivatives
from inca_mj.verification.result import CrossCheck
from inca_mj.verification.trajectories import (
    CASES,
    SAMPLING_TIME,
    compare_runs,
    make_case,
    run_reference,
)

STEPS = (2e-3, 1e-3, 5e-4, 2.5e-4)  # [s]


def crosscheck(
    parameters: ParameterSet | None = None,
    geometry: Geometry = INCA,
    *,
    duration: float = 10.0,
    steps: Sequence[float] = STEPS,
    cases: Sequence[str] = CASES,
    states: int = 10_000,
    seed: int = 0,
    progress: Callable[[str], None] | None = None,
) -> CrossCheck:
    """Compare the MuJoCo twin with the reference ODE.

    Args:
        parameters: values of both; the thesis' Table 3.2 when None.
        geometry: anchors of the cables.
        duration: of each trajectory [s].
        steps: of the twin [s]; each divides 10 ms.
        cases: which of `CASES` to run.
        states: number of random states for the accelerations.
        seed: of the random states.
        progress: told in words what is done next.

    Raises:
        InputError: a case is unknown, a step does not divide 10 ms, the duration is less than
            two samples, fewer than one state is asked for, or the start admits no rest.
        DivergenceError: the reference cannot be integrated.
    """
    parameters = parameters or parameter_set()
    if states < 1:
        raise InputError(f"cannot compare at {states} states; give 1 or more")
    if not 2 * SAMPLING_TIME <= duration <= LONGEST:
        raise InputError(
            f"a duration of {duration:g} s is not between two samples of {SAMPLING_TIME:g} s and"
            f" {LONGEST:g} s; give one that is"
        )
    for step in steps:
        substeps(SAMPLING_TIME, step)
    made = [make_case(name, parameters, geometry, duration) for name in cases]
    say = progress or (lambda _: None)

    # The references need Python and its lock, the twin's runs do without: they overlap.
    with ThreadPoolExecutor(1) as worker:
        references = [worker.submit(run_reference, case, parameters, geometry) for case in made]
        say(f"accelerations at {states} random states")
        derivatives = compare_derivatives(states, seed, parameters, geometry)
        found = []
        for case, reference in zip(made, references, strict=True):
            for step in steps:
                say(f"{case.name}, {duration:g} s at {1e3 * step:g} ms")
                found.append(compare_runs(case, reference.result, parameters, geometry, step))
    rows, notes = zip(*found, strict=True) if found else ((), ())
    return CrossCheck(derivatives, rows, tuple(note for note in notes if note))
