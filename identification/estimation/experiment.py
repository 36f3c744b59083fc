"""A planned experiment, and the Fisher information that it would give.

    S = ∂ŷ/∂q / σ  (n ny × p),   F = SᵀS                         white noise of std σ on each output

See `identification.estimation.information` for what follows from it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import mujoco
import numpy as np

from identification.errors import InputError
from identification.estimation.information import Information, information_of
from identification.estimation.resolution import Resolved, resolve, round_off
from identification.logs.log import Log
from identification.model.coordinates import coordinates
from identification.model.predictor import Plant, Predictor
from identification.model.sensitivity import refuse_without_effect, sensitivity


@dataclass(frozen=True, kw_only=True)
class Experiment:
    """A planned experiment.

    Raises:
        InputError: the noise is not positive, or the inputs do not fit the model.
    """

    plant: Plant  # the model, with the values at which the sensitivities are taken
    inputs: np.ndarray = field(repr=False)  # shape (n, nu), in the units of the model's controls
    sampling_time: float  # between samples [s]
    outputs: tuple[str, ...]  # names of the model's sensors that will be read
    sigma: float  # std of the white noise on each output, in the outputs' unit
    hold: str = "zoh"  # "zoh" or "foh"
    # values of parameters where they are not the plant's own
    fixed: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if not (np.isfinite(self.sigma) and self.sigma > 0):
            raise InputError(f"the noise has std {self.sigma:g}; give a positive one")
        inputs, nu = np.asarray(self.inputs, float), self.plant.model.nu
        if inputs.ndim != 2 or inputs.shape[1] != nu:
            raise InputError(f"inputs have shape {inputs.shape}; the model takes (N, {nu})")

    def log(self) -> Log:
        """Returns the inputs as a log whose outputs are still zero."""
        model = self.plant.model
        n = len(self.inputs)
        return Log(
            time=np.array(np.arange(n) * self.sampling_time, dtype=np.float64),
            inputs=np.array(self.inputs, dtype=np.float64),
            outputs=np.zeros((n, len(self.outputs))),
            input_names=tuple(mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_ACTUATOR, i) or f"u{i}"
                  for i in range(model.nu)),
            output_names=self.outputs,
            hold=self.hold,
        )  # fmt: skip


def information(
    experiment: Experiment,
    names: Sequence[str],
    nuisance: Sequence[str] = (),
    resolved: bool = True,
) -> Information:
    """Returns what an experiment would say about parameters, from 4 p simulations or more.

    Args:
        experiment: the plant, its inputs, the outputs that are measured, and their noise.
        names: the parameters of interest.
        nuisance: parameters that are unknown too but of no interest, such as a start pose.
        resolved: whether the errors of the sensitivities are estimated. Without this estimate 2 p
            simulations are enough, and a direction counts as felt unless round-off hides it.

    Raises:
        InputError: a name is unknown or named twice, has no effect on any output, or there are
            fewer readings than parameters.
        DivergenceError: a simulation left the finite numbers.
    """
    every = (*names, *nuisance)
    parameters = experiment.plant.parameters
    values = {**parameters.values(), **experiment.fixed}
    start = np.array([parameters[n].value if n not in values else values[n] for n in every])
    space = coordinates(parameters, every, start)
    log = experiment.log()
    if log.outputs.size < len(every):
        raise InputError(
            f"{log.outputs.size} readings cannot tell {len(every)} parameters; take a longer log"
        )
    predictor = Predictor(experiment.plant, log, every, dict(experiment.fixed))
    q, y = space.encode(start), predictor.predict(start)[0]

    def whiten(J: np.ndarray) -> np.ndarray:
        return J.reshape(-1, J.shape[2]) / experiment.sigma

    if resolved:
        found = resolve(predictor, space, q, y, whiten)
    else:
        S = whiten(sensitivity(predictor, space, q))
        found = Resolved(every, S, np.zeros_like(S), round_off(whiten(y[:, :, None])))
    J = experiment.sigma * found.S.reshape(*y.shape, -1)
    refuse_without_effect(J, every, replace(log, outputs=y))  # of what would be measured
    return information_of(found, space, len(names))
