"""An effect that fails as soon as its size is not zero, while a stage of a search runs."""

from contextlib import contextmanager
from dataclasses import replace

import numpy as np

from identification.effects.plant.jointed import JointPlant
from identification.errors import DivergenceError, InputError
from identification.model.plant import ModelPlant

HOWS = ("diverges", "is refused", "cannot be solved", "divides by zero", "gives NaN")
ERRORS = {
    "diverges": DivergenceError("the motors have more inertia than the robot; take a smaller rho"),
    "is refused": InputError("no body has these numbers; take other sizes"),
    "cannot be solved": np.linalg.LinAlgError("singular matrix"),
    "divides by zero": ZeroDivisionError("float division by zero"),
}


class Failing:
    """Makes plants fail where the size of an effect is not zero, while `is_active`.

    Attributes:
        reached: how often a plant was asked for such a size meanwhile.
    """

    def __init__(self, size: str, how: str) -> None:
        self.size, self.how, self.reached, self.is_active = size, how, 0, False

    @contextmanager
    def active(self):
        before, self.is_active = self.is_active, True
        try:
            yield
        finally:
            self.is_active = before

    def within(self, monkeypatch, module, function):
        """Fail while a function of a module runs."""
        whole = getattr(module, function)

        def failing(*args, **kwargs):
            with self.active():
                return whole(*args, **kwargs)

        monkeypatch.setattr(module, function, failing)

    def install(self, monkeypatch):
        for kind in (ModelPlant, JointPlant):
            monkeypatch.setattr(kind, "settings", self._settings(kind.settings))
        return self

    def _settings(self, whole):
        def settings(plant, names, values):
            names = list(names)
            state, numbers = whole(plant, names, values)
            own = plant.parameters.values().get(self.size, 0.0)
            column = np.asarray(values)[:, names.index(self.size)] if self.size in names else own
            is_there = np.broadcast_to(column != 0.0, len(values))
            if not (self.is_active and is_there.any()):
                return state, numbers
            self.reached += 1
            if self.how in ERRORS:
                raise ERRORS[self.how]
            qpos = np.where(is_there[:, None], np.nan, state.qpos)
            return replace(state, qpos=qpos), [(s, _with_nan(x, is_there)) for s, x in numbers]

        return settings


def _with_nan(column, is_there):
    """A column of model numbers, NaN in the value sets that fail."""
    return np.where(is_there.reshape(-1, *[1] * (np.ndim(column) - 1)), np.nan, column)
