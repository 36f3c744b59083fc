"""A lever on a position servo, integrated in plain numpy with what the servo of its model lacks.

J dv/dt = clip(γ² k_p b(e) - γ² k_v v + k_i z, ±γ F) - d v - m g l cos q,    e = x/γ - q
|dx/dt| <= 1/w, towards u         b(e) = e - clip(e, ±d_b)         dz/dt = e
"""

from dataclasses import dataclass
from functools import cache

import numpy as np
from plain_logs import plain_log

from identification import Log
from identification.effects.plant.joint_plant import JointPlant, joint_plant

STEP, FINE = 0.01, 10  # between samples [s], and steps of the integration in one of them
MJCF = """<mujoco model="lever">
  <option timestep="0.002" integrator="RK4"/>
  <worldbody><body name="bar" gravcomp="{float}"><joint name="pivot" axis="0 -1 0" damping="0.08"/>
    <inertial pos="0.15 0 0" mass="0.4" diaginertia="1e-3 3e-3 3e-3"/></body></worldbody>
  <actuator><position name="aim" joint="pivot" kp="{kp}" kv="{kv}" gear="{gear}"{filter}
      forcerange="-{most} {most}"/></actuator>
  <sensor><jointpos name="angle" joint="pivot"/></sensor>
</mujoco>"""
J, WEIGHT, DAMPING = 0.4 * 0.15**2 + 3e-3, 0.4 * 9.81 * 0.15, 0.08


@dataclass(frozen=True, kw_only=True)
class Servo:
    """A servo and what it lacks."""

    kp: float = 8.0
    kv: float = 0.3
    gear: float = 1.0
    most: float = 50.0  # largest force of the actuator
    timeconst: float = 0.0  # of the filter of its setpoint, in the model [s]
    w: float = 0.0  # one over the largest rate of its setpoint [s/rad]
    band: float = 0.0  # half its dead band
    k_i: float = 0.0
    weight: float = WEIGHT  # m g l [N m]

    def text(self) -> str:
        """The model's file, without what it lacks."""
        late = f' timeconst="{self.timeconst}"' if self.timeconst else ""
        return MJCF.format(kp=self.kp, kv=self.kv, gear=self.gear, most=self.most, filter=late,
                           float=0 if self.weight else 1)  # fmt: skip

    def rate(self, s: np.ndarray, x: float) -> np.ndarray:
        """Of q, v and z."""
        q, v, z = s
        e, most = x / self.gear - q, abs(self.gear) * self.most
        f = self.kp * (e - np.clip(e, -self.band, self.band)) - self.kv * v
        f = np.clip(self.gear**2 * f + self.k_i * z, -most, most)
        return np.array([v, (f - DAMPING * v - self.weight * np.cos(q)) / J, e])

    def moved(self, u: np.ndarray, q: float = 0.0, z: float = 0.0) -> np.ndarray:
        """Angles at the samples of setpoints (N,), from rest, shape (N, 1)."""
        s, x, h, out = np.array([q, 0.0, z]), u[0], STEP / FINE, []
        for target in u:
            out.append([s[0]])
            for _ in range(FINE):
                most = h / self.w if self.w else np.inf
                old = x if self.w else target
                x = old + np.clip(target - old, -most, most)
                a = self.rate(s, old)
                b = self.rate(s + h / 2 * a, (old + x) / 2)
                c = self.rate(s + h / 2 * b, (old + x) / 2)
                s = s + h / 6 * (a + 2 * b + 2 * c + self.rate(s + h * c, x))
        return np.array(out)


def setpoints(seed: int, samples: int) -> np.ndarray:
    """Steps and waves of a setpoint, shape (N,) [rad]."""
    rng, t = np.random.default_rng(seed), np.arange(samples) * STEP
    levels = np.repeat(rng.uniform(-0.4, 0.4, samples // 35 + 1), 35)[:samples]
    f, p = rng.uniform(0.2, 1.1, (2, 1)), rng.uniform(0, 6, (2, 1))
    return levels + 0.25 * np.sin(2 * np.pi * f * t + p).sum(axis=0)


def servo_log(u: np.ndarray, y: np.ndarray | None = None) -> Log:
    """A log of setpoints (N,) and angles (N, 1)."""
    y = 0.3 * np.sin(np.arange(len(u)) * STEP)[:, None] if y is None else y
    return plain_log(u[:, None], y, "aim", "angle", STEP, units={"aim": "rad", "angle": "rad"})


@cache
def lever(servo: Servo) -> JointPlant:
    """The plant of a servo's model, with all candidates."""
    return joint_plant(servo.text(), (), servo_log(setpoints(0, 100)))
