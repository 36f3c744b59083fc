"""Worlds outside the class of models: what departs from what a search takes for granted.

    y = φ + s_i v,       s_i of each sensor its own, or v by Student's t with ν degrees of freedom
    w: unlogged error of an input: low-passed noise of another time constant, in proportion to |u|,
       or partly u itself, low-passed
    truth = nominal exp(±2 s z)        twice the std s that the search was told
    f(v) = -c |v|^p sgn v,  p in [0.5, 3];    a jump at any time of a log;    two forces of no
    catalogue;    a controller with another bandwidth and another model of the robot

A departure says what is drawn in place of what usual worlds have. Robots of joints (`joint_worlds`)
and INCA (`inca_departures`) have the same ones.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from inca_mj.studies.worlds.sensor import coloured

LOUDER = 2.5  # times or a part of the usual noise, of each sensor by chance
TAILS = 3.0  # degrees of freedom of heavy-tailed noise: its kurtosis is infinite
FOLLOWED = 0.7  # share of an error's power that follows the command
FOLLOWS_AFTER = 0.05  # time constant with which it follows [s]
POWERS = (0.5, 3.0)  # of friction laws
EITHER_HALF = (0.1, 0.9)  # of a log, in which something jumps
CONTROLLERS = (0.4, 2.0)  # bandwidth over the usual one
MISTUNED = 0.6  # the numbers of its model are off by up to so much


@dataclass(frozen=True, kw_only=True)
class Departure:
    """What departs from a usual world; the defaults are a usual world."""

    name: str  # of the departure
    about: str  # what it is, as the page says it
    # "listed", or "powers", "jumps" and "unlisted": of these every world hides something
    hides: str = "listed"
    is_unequal: bool = False  # whether each sensor has a noise of its own
    is_heavy: bool = False  # whether the noise has heavy tails
    # correlation time of the inputs' error [s]; None for the usual one
    error_time: float | None = None
    is_proportional: bool = False  # whether that error is in proportion to the input
    is_following: bool = False  # whether a part of it follows the input
    spread: float = 1.0  # times the usual deviations of the parameters, or their std
    is_mistuned: bool = False  # whether the controller is another one than usual

    def noise(
        self, shape: tuple[int, int], std: np.ndarray, rng: np.random.Generator
    ) -> np.ndarray:
        """Returns noise of the sensors before they round, shape (N, n), of the std (n,) by chance.

        Heavy-tailed noise has the same std.
        """
        z = rng.normal(size=shape)
        if self.is_heavy:
            z = rng.standard_t(TAILS, size=shape) * np.sqrt((TAILS - 2) / TAILS)
        if self.is_unequal:
            z = z * np.exp(rng.uniform(-np.log(LOUDER), np.log(LOUDER), shape[1]))
        return np.asarray(z * std)

    def error(
        self, u: np.ndarray, step: float, rms: np.ndarray, time: float, rng: np.random.Generator
    ) -> np.ndarray:
        """Returns the unlogged error of inputs u (N, n), shape (N, n).

        Args:
            u: the inputs, or those of a motion without effect.
            step: between samples [s].
            rms: of each error, shape (n,).
            time: its usual correlation time [s].
            rng: of the error.
        """
        w = coloured(u.shape, step, 1.0, time if self.error_time is None else self.error_time, rng)
        if self.is_proportional:
            w = w * np.abs(u) / np.sqrt(np.mean(u**2, axis=0))
        if self.is_following:
            slow = low_passed(u - u.mean(axis=0), step, FOLLOWS_AFTER)
            slow /= np.sqrt(np.mean(slow**2, axis=0))
            w = np.sqrt(FOLLOWED) * slow + np.sqrt(1 - FOLLOWED) * w
        return np.asarray(w * rms)


def low_passed(u: np.ndarray, step: float, time: float) -> np.ndarray:
    """Returns signals (N, n) after a first-order filter that begins at rest."""
    a, out = np.exp(-step / time), np.zeros_like(u)
    for k in range(1, len(u)):
        out[k] = a * out[k - 1] + (1 - a) * u[k - 1]
    return out


DEPARTURES: dict[str, Departure] = {d.name: d for d in (
    Departure(name="unequal_sensors", is_unequal=True,
              about="each encoder has 0.4 to 2.5 times the usual noise"),
    Departure(name="heavy_tails", is_heavy=True,
              about="the noise of encoders has Student's t distribution with 3 degrees of freedom"),
    Departure(name="short_errors", error_time=0.005,
              about="errors of the inputs last 5 ms"),
    Departure(name="long_errors", error_time=1.0, about="errors of the inputs last 1 s"),
    Departure(name="proportional_errors", is_proportional=True,
              about="errors of the inputs are in proportion to the input"),
    Departure(name="following_errors", is_following=True,
              about="seven tenths of the power of the inputs' errors follow the command"),
    Departure(name="wide_deviations", spread=2.0,
              about="parameters differ from the model by twice the std that the search is told"),
    Departure(name="powers", hides="powers",
              about="a friction grows with a power of the speed, or a peak falls with one, drawn"
              " from 0.5 to 3"),
    Departure(name="jumps", hides="jumps",
              about="something jumps once, at any time of a log"),
    Departure(name="two_unlisted", hides="unlisted",
              about="two effects act that are in no catalogue"),
    Departure(name="unknown_controller", is_mistuned=True,
              about="the robot is under a controller that the model does not know"),
)}  # fmt: skip
