"""Records of a pendulum whose friction holds, and searches for what its model lacks."""

from functools import cache

import numpy as np

from identification.discovery.candidates import list_common
from identification.discovery.nominal_model import NominalModel
from identification.discovery.options import DiscoveryOptions
from identification.effects.axes import Axis
from identification.effects.plant.joint_plant import JointPlant, candidates, joint_plant
from identification.logs.log import Log
from identification.model.parameter import Parameter
from identification.model.predictor import Predictor
from identification.prediction.discovery import discover_records
from identification.prediction.judging.extension import with_effect
from identification.prediction.scoring.first_fit import begin
from identification.prediction.scoring.scores import window_scores
from identification.windows.records import as_records

STEP = 0.01  # between samples [s]
HORIZON = 0.2  # [s]
NOISE = 3e-4  # of the encoder [rad]
MJCF = """<mujoco model="pendulum">
  <option timestep="0.005" integrator="RK4"/>
  <worldbody><body name="arm"><joint name="hinge" axis="0 1 0" damping="0.02"/>
    <inertial pos="0 0 -0.1" mass="0.5" diaginertia="1e-3 1e-3 1e-3"/></body></worldbody>
  <actuator><motor name="drive" joint="hinge"/></actuator>
  <sensor><jointpos name="angle" joint="hinge"/></sensor>
</mujoco>"""
PARAMETERS = tuple(
    Parameter(name=name, value=value, unit=unit, where=where, lower=0.0, upper=1.0)
    for name, value, unit, where in (
        ("J", 2e-3, "kg m^2", "joint/hinge.armature"),
        ("d", 0.02, "N m s/rad", "joint/hinge.damping"),
    )
)
FREE, KNOWN = ("J", "d"), np.array([0.5, 0.5])
AXIS = Axis(joint="hinge", kind="hinge", force=0.8, speed=8.0, travel=3.0, heavy=True)


@cache
def pendulum() -> JointPlant:
    log = record(seed=0, samples=50)
    return joint_plant(MJCF, PARAMETERS, log, joints=(AXIS,))


def record(seed=0, samples=500, values=None, noise=NOISE, plant=None, largest=0.7):
    """A record under a random torque that changes every 0.2 s; y is zero without a plant."""
    rng = np.random.default_rng(seed)
    u = np.repeat(rng.uniform(-largest, largest, samples // 20 + 1), 20)[:samples, None]
    time = np.arange(samples) * STEP
    log = Log(
        time=time, inputs=u, outputs=0.1 * np.sin(time)[:, None], input_names=("drive",),
        output_names=("angle",), units={"drive": "N m", "angle": "rad"}, name=f"record {seed}",
    )  # fmt: skip
    if plant is None:
        return log
    known = values or {}
    y = Predictor(plant, log, tuple(known)).predict(np.array([[*known.values()]]))[0]
    return Log(
        time=time, inputs=u, outputs=y + noise * rng.standard_normal(y.shape),
        input_names=log.input_names, output_names=log.output_names, units=dict(log.units),
        name=log.name,
    )  # fmt: skip


def records(count=4, values=None, noise=NOISE, samples=500):
    return [record(k + 1, samples, values, noise, pendulum()) for k in range(count)]


def nominal_model():
    plant = pendulum().with_values({"J": 1.5e-3, "d": 0.03})
    return NominalModel(plant, FREE, KNOWN, HORIZON)


def roles(logs):
    """The first two logs to fit, and the others to confirm."""
    return as_records(logs[:2], logs[2:])


def listed(*names):
    """Effects of the pendulum that a search may name."""
    return tuple(e for e in candidates(pendulum(), FREE) if e.name in names)


def search(logs, names, model=None, progress=None, **options):
    """What a search among some effects finds in logs of which the first two are fitted."""
    return discover_records(
        model or nominal_model(), logs[:2], logs[2:], listed(*names), progress,
        DiscoveryOptions(**options),
    )  # fmt: skip


def with_law(model, name, every):
    """A fitted model with one law more, in the kind that scores best, as records confirm it."""
    best, *_ = window_scores(model.fit, list_common(listed(name)))
    confirm = [r for r in every if r.role == "confirm"]
    return with_effect(model, begin(model, [best]), HORIZON, confirm)
