"""How the size and the shape of an effect are drawn, and written into the numbers of a joint."""

from __future__ import annotations

import numpy as np

from joint_worlds import slots as at
from joint_worlds.hidden import Habits, Put, Rng, Shape


def put_into(*columns: int, **named: int) -> Put:
    """Writes the size into some columns, and the shape into others."""

    def put(joint: np.ndarray, size: float, shape: Shape) -> None:
        joint[list(columns)] = size
        for word, column in named.items():
            joint[column] = shape[word]

    return put


def wave(cos: int, sin: int, waves: int) -> Put:
    """Writes cosine and sine of the drawn phase, and how many waves where that has a column."""

    def put(joint: np.ndarray, size: float, shape: Shape) -> None:
        joint[cos], joint[sin] = size * np.cos(shape["phase"]), size * np.sin(shape["phase"])
        if waves >= 0:
            joint[waves] = shape["n"]

    return put


def limit(joint: np.ndarray, size: float, shape: Shape) -> None:
    """A limit between the largest input (size 0), one often reached (1), and less."""
    if size:
        joint[at.LIMIT] = shape["full"] * (shape["often"] / shape["full"]) ** size


def signed(put: Put) -> Put:
    """With the sign that was drawn."""
    return lambda joint, size, shape: put(joint, shape["sign"] * size, shape)


def sign(habits: Habits, rng: Rng) -> Shape:
    """Either sign."""
    return {"sign": float(rng.choice([-1.0, 1.0]))}


def peak(habits: Habits, rng: Rng) -> Shape:
    """Speed [rad/s or m/s] and power of a Stribeck peak."""
    return {"v_s": habits.speed * float(np.exp(rng.uniform(np.log(0.03), np.log(0.2)))),
            "p": float(rng.uniform(1.0, 2.0))}  # fmt: skip


def hinge_wave(habits: Habits, rng: Rng) -> Shape:
    """Whole periods of a turn, two of which at least lie in the travel."""
    least = int(np.ceil(2 * np.pi / habits.travel))
    return {"n": float(rng.integers(max(3, least), 13)), "phase": float(rng.uniform(0, 2 * np.pi))}


def slide_wave(habits: Habits, rng: Rng) -> Shape:
    n = np.pi / habits.travel * rng.uniform(3.0, 12.0)  # periods in the travel
    return {"n": float(n), "phase": float(rng.uniform(0, 2 * np.pi))}


def wave_of(habits: Habits, rng: Rng) -> Shape:
    return (hinge_wave if habits.travel > 0.4 else slide_wave)(habits, rng)


def bump(habits: Habits, rng: Rng) -> Shape:
    """Place and width of a bump within the travel [rad or m]."""
    return {**sign(habits, rng), "place": float(habits.travel * rng.uniform(-0.5, 0.5)),
            "width": float(habits.travel * rng.uniform(0.15, 0.4))}  # fmt: skip


def stop(habits: Habits, rng: Rng) -> Shape:
    """Where a soft stop begins, from the middle [rad or m]."""
    return {"place": float(habits.travel * rng.uniform(0.4, 0.7))}


def fast(habits: Habits, rng: Rng) -> Shape:
    """The speed from which a brake acts [rad/s or m/s]."""
    return {"speed": float(habits.speed * rng.uniform(0.2, 0.5))}


def beside(habits: Habits, rng: Rng) -> Shape:
    """One to three radians of the sine in a radian of the neighbour: no more than two periods."""
    return {"waves": float(rng.uniform(1.0, 3.0)), "phase": float(rng.uniform(0, 2 * np.pi))}


def ripple(habits: Habits, rng: Rng) -> Shape:
    """One to three periods in the whole travel [1/rad or 1/m]."""
    return {"waves": float(np.pi / habits.travel * rng.uniform(1.0, 3.0))}
