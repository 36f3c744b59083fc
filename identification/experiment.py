"""What an experiment would say about parameters, before it is done: Fisher information.

    S = ∂ŷ/∂q / σ  (n ny × p),   F = SᵀS                         white noise of std σ on each output
    cov(q̂) ≥ F⁻¹                                                  Cramér-Rao, all of q unknown
    S_a ← (I - S_n S_n⁺) S_a                                      nuisances S_n unknown, not asked for
    E = λ_min(F),   D = ln det F,   A = tr F⁻¹                    of the parameters that are asked for

q = ln(value) for a positive parameter, so its std is relative. E is the information on the worst
determined direction: F of an experiment is the sum of its parts', and none of them can lower E.
Source: Ljung, System Identification (1999), 7.4 and 13.2; Swevers et al. (1997) for robots.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import mujoco
import numpy as np

from identification.coordinates import coordinates
from identification.errors import InputError, unknown_name
from identification.identifiability import (
    BLIND,
    Combination,
    Identifiability,
    identifiability,
    known_combinations,
)
from identification.log import Log
from identification.predictor import Plant, Predictor
from identification.sensitivity import refuse_without_effect, sensitivity


@dataclass(frozen=True)
class Experiment:
    """An experiment that could be done.

    Attributes:
        plant: the model, at the values where its outputs' sensitivities are taken.
        inputs: shape (n, nu), in the units of the model's controls.
        sampling_time: between samples [s].
        outputs: names of the model's sensors that will be read.
        sigma: std of the white noise on each output, in the outputs' unit.
        hold: "zoh" or "foh".
        fixed: values of parameters where they are not the plant's own.

    Raises:
        InputError: the noise is not positive, or the inputs do not fit the model.
    """

    plant: Plant
    inputs: np.ndarray = field(repr=False)
    sampling_time: float
    outputs: tuple[str, ...]
    sigma: float
    hold: str = "zoh"
    fixed: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if not (np.isfinite(self.sigma) and self.sigma > 0):
            raise InputError(f"the noise has std {self.sigma:g}; give a positive one")
        inputs, nu = np.asarray(self.inputs, float), self.plant.model.nu
        if inputs.ndim != 2 or inputs.shape[1] != nu:
            raise InputError(f"inputs have shape {inputs.shape}; the model takes (N, {nu})")

    def log(self) -> Log:
        """The inputs as a log whose outputs are still zero."""
        model = self.plant.model
        n = len(self.inputs)
        return Log(
            np.arange(n) * self.sampling_time,
            self.inputs,
            np.zeros((n, len(self.outputs))),
            tuple(mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_ACTUATOR, i) or f"u{i}"
                  for i in range(model.nu)),
            self.outputs,
            hold=self.hold,
        )  # fmt: skip


@dataclass(frozen=True)
class Information:
    """What an experiment says about p parameters.

    Attributes:
        names: the parameters that are asked for, then the nuisances.
        asked: how many are asked for.
        logarithmic: which have q = ln(value), shape (p,).
        root: upper triangular, rootᵀ root = F of all, shape (p, p).
    """

    names: tuple[str, ...]
    asked: int
    logarithmic: np.ndarray
    root: np.ndarray

    @property
    def found(self) -> Identifiability:
        """Directions of the parameters asked for, the nuisances being unknown too."""
        return identifiability(_without(self.root, self.asked), self.names[: self.asked])

    @property
    def fisher(self) -> np.ndarray:
        """F of the parameters asked for, the nuisances being unknown, shape (asked, asked)."""
        S = _without(self.root, self.asked)
        return S.T @ S

    @property
    def std(self) -> np.ndarray:
        """Least std of q with all others unknown, shape (asked,): relative where logarithmic."""
        return self.found.std

    @property
    def conditional(self) -> np.ndarray:
        """Least std of q were all others known, shape (asked,)."""
        with np.errstate(divide="ignore"):
            return 1 / np.linalg.norm(self.root[:, : self.asked], axis=0)

    @property
    def ranking(self) -> tuple[str, ...]:
        """Parameters, best determined first."""
        return tuple(self.names[i] for i in np.argsort(self.std, kind="stable"))

    @property
    def combinations(self) -> list[Combination]:
        """Products that can be known where their factors cannot."""
        return known_combinations(self.found, self.logarithmic[: self.asked])

    @property
    def condition(self) -> float:
        """Strongest over weakest direction; infinite where one is blind."""
        strengths = self.found.strengths
        return float(strengths[0] / strengths[-1]) if not len(self.found.blind) else np.inf

    @property
    def E(self) -> float:
        """Smallest eigenvalue of F: 1/variance of the worst direction; 0 where one is blind."""
        return 0.0 if len(self.found.blind) else float(self.found.strengths[-1] ** 2)

    @property
    def D(self) -> float:
        """ln det F, -inf where a direction is blind."""
        return -np.inf if len(self.found.blind) else float(2 * np.log(self.found.strengths).sum())

    @property
    def A(self) -> float:
        """Sum of the variances, infinite where a direction is blind."""
        return float((self.std**2).sum())

    def with_data(self, other: Information) -> Information:
        """Of both experiments together.

        Raises:
            InputError: the other is about other parameters.
        """
        if other.names != self.names or other.asked != self.asked:
            raise InputError("two experiments add up when both are about the same parameters")
        return replace(self, root=np.linalg.qr(np.vstack([self.root, other.root]), "r"))

    def about(self, names: Sequence[str]) -> Information:
        """Of some of the parameters asked for, the rest being known; nuisances stay.

        Raises:
            InputError: a name was not asked for.
        """
        known = self.names[: self.asked]
        for name in names:
            if name not in known:
                raise unknown_name("parameter", name, known)
        kept = [*map(known.index, names), *range(self.asked, len(self.names))]
        root = np.linalg.qr(self.root[:, kept], "r")
        return Information(
            tuple(self.names[i] for i in kept), len(names), self.logarithmic[kept], root
        )


def information(
    experiment: Experiment, names: Sequence[str], nuisance: Sequence[str] = ()
) -> Information:
    """What an experiment would say, from 2 p simulations.

    Args:
        experiment: the plant, its inputs, what is read and how noisy.
        names: parameters that are asked for.
        nuisance: parameters that are unknown too but of no interest, such as a start pose.

    Raises:
        InputError: a name is unknown or named twice, has no effect on any output, or there are
            fewer readings than parameters.
        DivergenceError: a simulation left the finite numbers.
    """
    every = (*names, *nuisance)
    parameters = experiment.plant.parameters
    own = {**parameters.values(), **experiment.fixed}
    start = np.array([parameters[n].value if n not in own else own[n] for n in every])
    space = coordinates(parameters, every, start)
    log = experiment.log()
    if log.outputs.size < len(every):
        raise InputError(
            f"{log.outputs.size} readings cannot tell {len(every)} parameters; take a longer log"
        )
    predictor = Predictor(experiment.plant, log, every, dict(experiment.fixed))
    J = sensitivity(predictor, space, space.encode(start))
    refuse_without_effect(J, every, experiment.outputs)
    S = J.reshape(-1, len(every)) / experiment.sigma
    return Information(every, len(names), space.logarithmic, np.linalg.qr(S, "r"))


def determinable(found: Information) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Parameters that can be told apart, and those to hold fixed so that they can.

    Of each blind direction the parameter that moves most along it is held.
    """
    kept = list(found.names[: found.asked])
    held = []
    while len(blind := found.about(kept).found.blind):
        held.append(kept.pop(int(np.abs(blind[0]).argmax())))
        if not kept:
            break
    return tuple(kept), tuple(held)


def _without(root: np.ndarray, asked: int) -> np.ndarray:
    """Sensitivities to what is asked for that no move of the nuisances can imitate."""
    wanted, nuisance = root[:, :asked], root[:, asked:]
    if not nuisance.shape[1]:
        return wanted
    U, s, _ = np.linalg.svd(nuisance / np.linalg.norm(nuisance, axis=0), full_matrices=False)
    U = U[:, s > BLIND * s[0]]
    return wanted - U @ (U.T @ wanted)
