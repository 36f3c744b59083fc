"""Random linear plants with their dense covariance, and a slider with effects to find."""

from functools import cache
from types import SimpleNamespace

import mujoco
import numpy as np

from identification import Log, Parameter, ParameterSet
from identification.discovery.nominal_model import NominalModel
from identification.discovery.options import DiscoveryOptions
from identification.effects.effect import Candidate, Effect
from identification.effects.sizes import Size
from identification.estimation.priors import Priors
from identification.innovations.discovery import INNOVATIONS
from identification.innovations.scoring.scores import score
from identification.innovations.scoring.sensitivities import Sensitivity
from identification.innovations.state import InnovationSearch
from identification.innovations.task import DiscoveryTask
from identification.kalman.linear import LinearPlant
from identification.kalman.point import Point
from identification.kalman.refit import Refit
from identification.model.coordinates import Coordinates
from identification.model.plant import ModelPlant
from identification.model.predictor import Predictor

STEP = 0.02  # between samples [s]
OPTIONS = DiscoveryOptions()


def linear_plant(rng, samples=40, nx=3, nu=2, ny=2):
    """A random time-varying plant whose errors grow and fade."""
    A = 0.9 * np.eye(nx) + 0.15 * rng.standard_normal((samples - 1, nx, nx))
    return LinearPlant(A, rng.standard_normal((samples - 1, nx, nu)), rng.standard_normal((ny, nx)))


def response(plant):
    """Outputs of all samples from inputs of all samples, shape (N ny, N nu)."""
    n, _, nu = plant.B.shape
    ny = len(plant.C)
    out = np.zeros((n + 1, ny, n + 1, nu))
    for j in range(n):
        x = plant.B[j]
        for k in range(j + 1, n + 1):
            out[k, :, j] = plant.C @ x
            if k < n:
                x = plant.A[k] @ x
    return out.reshape((n + 1) * ny, (n + 1) * nu)


def coloured(samples, nu, noise, sampling_time=STEP):
    """Covariance of the inputs' error over σ², shape (N nu, N nu)."""
    lag = np.abs(np.subtract.outer(np.arange(samples), np.arange(samples)))
    each = np.diag(noise.of_inputs(nu) ** 2)
    return np.kron(np.exp(-lag * sampling_time / noise.time), each)


def covariance(plant, noise):
    """Of the stacked residual over σ², the slow and obvious way."""
    T = response(plant)
    n, nu = len(plant.B) + 1, plant.B.shape[2]
    sensors = np.tile(noise.of_outputs(len(plant.C)) ** 2, n)
    return np.diag(sensors) + T @ coloured(n, nu, noise) @ T.T


def effect(sign=0, m=1, largest=10.0):
    names = "abcdefgh"[:m]
    sizes = tuple(Size(n, "N", largest, 1e-3, sign) for n in names)
    return Effect("push", "f", sizes, places={"joint": ""})


def sensitivity(S, sign=0, name="push"):
    of = effect(sign, S.shape[2])
    return Sensitivity(Candidate(Effect(name, "f", of.sizes, places=of.places), "joint", {}), S)


def point_of(plant, e, J):
    """A point without a simulator behind it."""
    p = J.shape[2]
    names = tuple(f"p{j}" for j in range(p))
    wide = np.full(p, np.inf)
    space = Coordinates(names, np.zeros(p, bool), -wide, wide, np.ones(p))
    log = SimpleNamespace(sampling_time=STEP)
    return Point(
        predictor=SimpleNamespace(log=log), space=space, q=np.zeros(p), e=e, J=J, linear=plant
    )


def refit_at(point, level, prior, mean=None):
    """A fit with these priors that has ended at a point."""
    mean = np.zeros(len(prior)) if mean is None else mean
    std, priors = np.ones(len(prior)), Priors(point.space, mean, prior)
    return Refit(point=point, level=level, std=std, priors=priors, steps=0)


def scored(point, level, prior, sensitivities, mean=None):
    """Scores at a point, as if a fit with these priors had ended there."""
    return score(refit_at(point, level, prior, mean), sensitivities, OPTIONS)


SLIDER = """<mujoco>
  <option timestep="0.01" gravity="0 0 0" integrator="RK4"/>
  <worldbody><body name="cart"><inertial pos="0 0 0" mass="2" diaginertia="1 1 1"/>
    <joint name="slide" type="slide" axis="1 0 0" damping="3"/></body></worldbody>
  <actuator><general name="force" joint="slide" gear="1" gainprm="5" biastype="affine"/></actuator>
  <sensor><jointpos name="position" joint="slide"/></sensor>
</mujoco>"""

RECORDS = (
    Parameter(name="mass", value=2.0, unit="kg", where="body/cart.mass", lower=0.0, upper=100.0),
    Parameter(
        name="damping", value=3.0, unit="N s/m", where="joint/slide.damping", lower=0.0, upper=100.0
    ),
    Parameter(name="x0", value=0.0, unit="m", where="qpos[0]"),
    Parameter(name="v0", value=0.0, unit="m/s", where="qvel[0]"),
    Parameter(
        name="spring.k",
        value=0.0,
        unit="N/m",
        where="joint/slide.stiffness",
        lower=0.0,
        upper=1e3,
        symbol="k",
    ),
    Parameter(name="offset.f", value=0.0, unit="N", where="actuator/force.biasprm[0]", symbol="f"),
    Parameter(
        name="rubbing.c",
        value=0.0,
        unit="N",
        where="joint/slide.frictionloss",
        lower=0.0,
        upper=1e3,
        symbol="c",
    ),
)
EFFECTS = (
    Effect("spring", "-k x", (Size("k", "N/m", 30.0, 1e-2, 1),), places={"joint": ""}),
    Effect("offset", "f", (Size("f", "N", 3.0, 1e-2),), places={"joint": ""}),
    Effect("rubbing", "-c sgn v", (Size("c", "N", 2.0, 1e-2, 1),), places={"joint": ""}),
)
FREE = ("mass", "damping", "x0", "v0")
KNOWN = np.array([0.3, 0.3, 0.05, 0.05])
SENSOR = 1e-3  # std of the position sensor [m]


def slider(**values):
    model = mujoco.MjModel.from_xml_string(SLIDER)
    return ModelPlant(model, ParameterSet("slider", RECORDS).with_values(values))


def nominal_model(**values):
    return NominalModel(slider(**values), FREE, KNOWN)


def task(log, options=OPTIONS, model=None):
    """What does the slider, or another model, lack to explain a log?"""
    return DiscoveryTask(
        nominal_model=model or nominal_model(), log=log, effects=EFFECTS, options=options
    )


def steps(samples, seed=1, hold=10):
    """A random input of levels ±1 that lasts `hold` samples each, shape (N, 1)."""
    levels = np.random.default_rng(seed).choice([-1.0, 1.0], samples // hold + 1)
    return np.repeat(levels, hold)[:samples, None]


def record(plant, samples=500, seed=0, error=None, noise=SENSOR):
    """What the position sensor says when the input has an error that the log does not know."""
    u = steps(samples)
    time = STEP * np.arange(samples)
    names = {"input_names": ("force",), "output_names": ("position",)}
    fed = Log(
        time=time, inputs=u if error is None else u + error, outputs=np.zeros_like(u), **names
    )
    y = Predictor(plant, fed, ()).predict(np.empty((1, 0)))[0]
    y = y + noise * np.random.default_rng(seed).standard_normal(y.shape)
    return Log(time=time, inputs=u, outputs=y, **names, units={"force": "N", "position": "m"})


def wander(samples, rms, time, seed):
    """A low-passed error of the input, shape (N, 1)."""
    rng, a = np.random.default_rng(seed), np.exp(-STEP / time)
    w = rms * rng.standard_normal((samples, 1))
    for k in range(1, samples):
        w[k] = a * w[k - 1] + np.sqrt(1 - a**2) * w[k]
    return w


def disturbed(error=0.0, **values):
    """A log of a slider whose values are not the model's, and whose force wanders a little."""
    robot = slider(**{"mass": 2.2, "damping": 2.7, "x0": 0.01, "v0": 0.02, **values})
    return record(robot, 500, seed=11, error=error + wander(500, 0.03, 0.1, seed=8))


def stepped(state: InnovationSearch) -> list[InnovationSearch]:
    """A state and all that follow it, the finished one last."""
    seen = [state]
    while not seen[-1].is_finished:
        seen.append(INNOVATIONS.step(seen[-1], print))
    return seen


@cache
def searched(**values) -> list[InnovationSearch]:
    """Every state of a search in a disturbed log."""
    return stepped(INNOVATIONS.begin(task(disturbed(**values)), print))
