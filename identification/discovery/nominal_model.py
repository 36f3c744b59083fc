"""The nominal model: its free parameters, and what is known of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from identification.errors import InputError
from identification.model.parameter import Parameter
from identification.model.plant import start_place
from identification.model.predictor import Plant

# Of a logarithm, for the prior of a shape about the grid value with the best score; the grids are
# about as coarse.
SHAPE_STD = 1.0
MIN_START_SHARE = 1e-3  # of a probe: the search for a size begins at least this far from zero


@dataclass(frozen=True)
class NominalModel:
    """The nominal model: its plant, its free parameters, and what is known of them.

    Attributes:
        plant: the model with all candidate effects compiled in.
        names: of the free parameters, p of them.
        std: std of the prior of each in coordinates (`identification.model.coordinates`): relative
            for a positive parameter, else in units of the parameter's scale, shape (p,).
        horizon: length of the windows over which predictions are judged [s]; None for a free run
            of the whole log, which says little of a robot that integrates what disturbs it.
        own: those of the names of which each record has a value of its own.
        mean: means of priors by name, in the parameters' units; of the others it is the plant's
            own value, where every search begins.
        own_values: by record and by name, where the search of a record's own values begins; the
            plant's own value where not given.
        groups: names that share one std, by what they have in common: deviations of the drives by
            the name of their common value, displacements of points. Their std is the largest that
            is believed.
        scattering: those groups whose std the data show; of the others it stays.
        scatter: the std of some groups, as the data show it; `std` where not given.
        deviants: by the name of a deviation, the effect and its place that it is when it is too
            large for scatter; of an effect of several sizes in their order.
        is_bounded: whether fits keep every member of a group within `max_scatter` std.
        held: by name, the least and the largest value that fits believe, in the parameter's unit.

    Raises:
        InputError: there is not one std for each name.
    """

    plant: Plant
    names: tuple[str, ...]
    std: np.ndarray
    horizon: float | None = None
    own: tuple[str, ...] = ()
    mean: Mapping[str, float] = field(default_factory=dict)
    own_values: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    groups: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    scattering: tuple[str, ...] = ()
    scatter: Mapping[str, float] = field(default_factory=dict)
    deviants: Mapping[str, tuple[str, str]] = field(default_factory=dict)
    is_bounded: bool = False
    held: Mapping[str, tuple[float, float]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if np.shape(self.std) != (len(self.names),):
            raise InputError(
                f"{len(self.names)} free parameters have std of the shape {np.shape(self.std)};"
                " give one for each"
            )

    @property
    def grouped(self) -> dict[str, str]:
        """The group of each name that has one."""
        return {name: group for group, names in self.groups.items() for name in names}

    @property
    def prior_std(self) -> np.ndarray:
        """The std of each prior, with the scatter that the data show, shape (p,)."""
        group = self.grouped
        pairs = zip(self.names, self.std, strict=True)
        return np.array([self.scatter.get(group.get(name, ""), std) for name, std in pairs])

    @property
    def linear(self) -> tuple[str, ...]:
        """Names whose prior has a mean that is not positive: it is none of a logarithm."""
        return tuple(n for n, mean in self.mean.items() if mean <= 0)


def nonzero(record: Parameter, value: float) -> float:
    """Returns the value of a size, moved away from zero where it is too near to it."""
    least = MIN_START_SHARE * record.scale
    return value if abs(value) > least else least * (1 if record.upper > 0 else -1)


def without_starts(nominal_model: NominalModel) -> NominalModel:
    """Returns a nominal model without free parameters that are entries of the initial state.

    Args:
        nominal_model: any.
    """
    plant, names = nominal_model.plant, nominal_model.names
    at = plant.parameters
    keep = [k for k, n in enumerate(names) if start_place(at[n].where, plant.model) is None]
    kept = tuple(names[k] for k in keep)
    return replace(
        nominal_model, names=kept, std=nominal_model.std[keep],
        own=tuple(n for n in nominal_model.own if n in kept),
        mean={n: mean for n, mean in nominal_model.mean.items() if n in kept},
    )  # fmt: skip
