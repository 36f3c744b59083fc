"""Discovery on a log of the robot, with its nominal model, its priors and its catalogue."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from identification import Log
from identification.discovery.options import DiscoveryOptions
from identification.effects.effect import Effect
from identification.model.parameter import ParameterSet
from inca_mj.effects.catalogue import CATALOGUE
from inca_mj.robot.geometry import INCA, Geometry
from inca_mj.twin.logs import POSE
from inca_mj.twin.twin import build_twin
from inca_mj.twin.wiring import refuse_miswired
from inca_mj.workflows.comparison import timestep_for

if TYPE_CHECKING:
    from identification.discovery.result import Discovery

TIMESTEP = 2e-3  # [s]; RK4 errs by 0.03 mrad, 1/20 of an encoder's noise, at half the cost of 1 ms

# Values that the thesis calls measured or arbitrary are known to 30 %, those of data sheets better.
KNOWN = {
    "lambda": 0.3, "b": 0.3, "J": 0.3, "b_v": 0.3, "b_c": 0.3, "beta": 0.3, "K_t": 0.3,
    "k_s": 0.3, "R": 0.005, "m": 0.01, **dict.fromkeys(POSE, 0.1),
}  # fmt: skip


def discover(
    log: Log,
    parameters: ParameterSet | None = None,
    geometry: Geometry = INCA,
    *,
    effects: Sequence[Effect] = CATALOGUE,
    progress: Callable[[str], None] | None = None,
    timestep: float = TIMESTEP,
    settled: bool = False,
    options: DiscoveryOptions | None = None,
) -> Discovery:
    """Name the physical effect that the twin lacks to explain a log, and prove it.

    Args:
        log: what was measured; its part `estimation` (or first half) is fitted, and the rest is
            unseen data for the proof.
        parameters: nominal values; the thesis' Table 3.2 when None.
        geometry: anchors of the cables.
        effects: candidates; the catalogue of 25 by default.
        progress: is told a line per stage.
        timestep: largest step of the integrator [s].
        settled: True if the robot stood by itself for a while before the log began, so that it
            starts at rest with the effects that the twin lacks; False if it was held where the
            nominal model rests.
        options: the judgement constants; the defaults of `DiscoveryOptions` when None.

    Raises:
        InputError: the log is too short, is not wired as the robot is, or its start has no
            pretension.
        DivergenceError: the nominal model cannot be simulated.
    """
    step = timestep_for(log.sampling_time, timestep)
    refuse_miswired(log, build_twin(parameters, geometry, timestep=step, visual=False))

    # These imports are slow, so they come after the checks that may refuse the log.
    from identification.discovery.nominal_model import NominalModel
    from identification.discovery.search import discover as search
    from identification.discovery.search import refuse_unfit
    from inca_mj.workflows.look_alikes import told

    options = options or DiscoveryOptions()
    refuse_unfit(log, options)
    if progress is not None:
        progress(f"preparing the law of the cables with {len(effects)} effects")
    plant = build_twin(
        parameters, geometry, timestep=step, effects=effects, settled=settled, visual=False
    )
    nominal_model = NominalModel(plant, tuple(KNOWN), np.array([*KNOWN.values()]))
    return told(search(nominal_model, log, effects, progress, options))
