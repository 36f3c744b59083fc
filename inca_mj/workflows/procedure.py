"""The two steps of the thesis on its real robot, with what Tables 3.7 and 3.8 free and fix.

Step 1 (Table 3.7) frees all eleven parameters and the start position, and begins at the table's
initial values. Step 2 (Table 3.8) frees R, λ, J, b_v, b_c, β, K_t and m. Of these R and K_t begin
at their nominal values and the others where step 1 ended. R_s, k_s and the start position are fixed
at their nominal values, b where step 1 ended.

The text of section 3.3.2 says that step 2 fixes what a data sheet or a measurement gives. The table
is what was done: it frees R, λ, K_t and m as well, and fixes b, which nothing gives. The first half
of the log is fitted (5 of 10 s), and the whole log is predicted.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from identification import Log
from identification.estimation.estimation import Options, estimate
from identification.estimation.fit import Fit, assess
from identification.model.parameter import ParameterSet
from inca_mj.robot.geometry import INCA, Geometry
from inca_mj.robot.parameters import TIMESTEP
from inca_mj.twin.twin import build_twin
from inca_mj.twin.wiring import refuse_miswired
from inca_mj.workflows.comparison import timestep_for
from inca_mj.workflows.identification import Identification, better

STEP_1 = {
    "R": 0.0175, "R_s": 0.006, "k_s": 16.0, "lambda": 25000.0, "b": 2.0, "J": 1e-4, "b_v": 2e-4,
    "b_c": 0.005, "beta": 0.8, "K_t": 0.0603, "m": 0.17246, "x": 0.0, "y": 0.0, "z": 1.47,
}  # fmt: skip
STEP_2 = ("R", "lambda", "J", "b_v", "b_c", "beta", "K_t", "m")
AT_NOMINAL = ("R", "K_t")  # free in step 2, and not begun where step 1 ended
HELD_FROM_STEP_1 = ("b",)


def identify_as_thesis(
    log: Log,
    parameters: ParameterSet | None = None,
    geometry: Geometry = INCA,
    *,
    options: Options | None = None,
    progress: Callable[[str], None] | None = None,
    timestep: float = TIMESTEP,
    trust: Sequence[str] = (),
) -> Identification:
    """Identify the robot from a log by the two steps of the thesis' section 3.3.

    Args:
        log: what was measured; its split `estimation`, or its first half, is fitted.
        parameters: nominal values, where step 2 fixes R_s, k_s and the start, and begins R and
            K_t; the thesis' Table 3.2 when None.
        geometry: anchors of the cables.
        options: how to search; `Options(horizons=(1.0,))` is the thesis' single free-run fit.
        progress: is told one line per accepted step.
        timestep: largest step of the integrator [s].
        trust: checks of the log that you overrule, words of `inca_mj.twin.logs.JUDGED`.

    Raises:
        InputError: the log is not wired as the robot is, or a start has no pretension.
        DivergenceError: the first values cannot be simulated.
    """
    step = timestep_for(log.sampling_time, timestep)
    plant = build_twin(parameters, geometry, timestep=step, visual=False)
    refuse_miswired(log, plant, trust)
    fitted = log.part("estimation")

    first = assess(estimate(plant, fitted, tuple(STEP_1), STEP_1, options, progress), log)
    if first.estimate.status == "stopped":
        return Identification(log=log, fits=(first,), best=0)
    found, nominal = first.estimate.values, plant.parameters.values()
    held = plant.with_values({name: found[name] for name in HELD_FROM_STEP_1})
    start = {name: (nominal if name in AT_NOMINAL else found)[name] for name in STEP_2}
    second: Fit = assess(estimate(held, fitted, STEP_2, start, options, progress), log)
    return Identification(log=log, fits=(first, second), best=better(first, second))
