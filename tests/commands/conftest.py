"""What tests of commands share: free runs of the twin that many of their logs need."""

from collections.abc import Iterator

import mujoco
import numpy as np
import pytest

from inca_mj.refusals import agreement, currents, wiring
from inca_mj.twin.twin import Twin


def _numbers(plant: Twin) -> tuple[object, ...]:
    """All that two twins have alike which do the same under the same currents."""
    model = np.empty(mujoco.mj_sizeModel(plant.model), np.uint8)
    mujoco.mj_saveModel(plant.model, None, model)
    values = plant.parameters.values()
    return model.tobytes(), (*values.items(),), plant.effects, plant.settled


@pytest.fixture(scope="module")
def each_run_once() -> Iterator[None]:
    """Lets a module simulate a twin once under the same currents, whatever angles its logs say.

    A free run knows the currents, their times and their hold, and nothing of the log's angles but
    their names, so that logs whose angles alone are wrong are all judged by the same runs.
    """
    simulated, known = agreement.angles_under, {}

    def angles(plant, log, currents):
        key = (
            _numbers(plant), currents.tobytes(), currents.shape, log.output_names,
            log.sampling_time, log.hold, log.begun,
        )  # fmt: skip
        if key not in known:
            known[key] = simulated(plant, log, currents)
        return np.copy(known[key])

    with pytest.MonkeyPatch.context() as patch:
        for module in (wiring, currents):
            patch.setattr(module, "angles_under", angles)
        yield
