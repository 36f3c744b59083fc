"""Records of a cart on a rail, from equations that share nothing with MuJoCo.

    m v' = K u(t - τ) - d v - k (q - q_0) - f(q, v)

f is a bump that is narrower than the nodes of any curve of a search: the rail moves over 0.7 m.
"""

from functools import cache

import numpy as np

from identification.discovery.nominal_model import NominalModel
from identification.discovery.options import DiscoveryOptions
from identification.effects.axes import Axis
from identification.effects.plant.joint_plant import candidates, joint_plant
from identification.logs.log import Log
from identification.model.parameter import Parameter
from identification.prediction.fits.nominal_fit import fit_nominal
from identification.prediction.task import RecordsTask
from identification.windows.records import as_records

MASS, DAMPING, GEAR = 1.52, 4.6, 5.5  # [kg], [N s/m], [N]
STEP, SMALL, HORIZON, NOISE = 0.005, 2.5e-4, 0.4, 2e-5  # [s], [s], [s], [m]
MIDDLE, REACH = 0.4, 0.35  # of the rail [m]
WIDTH, AT, SIZE = 0.03, 0.425, 1.2  # of the bump [m], [m], [N]
MJCF = """<mujoco model="cart"><option timestep="0.0025" integrator="RK4"/>
  <worldbody><body name="cart"><joint name="rail" type="slide" axis="1 0 0" damping="4"/>
    <geom type="box" size=".05 .03 .02" mass="1.4" contype="0" conaffinity="0"/></body></worldbody>
  <actuator><motor name="drive" joint="rail" gear="5.5"/></actuator>
  <sensor><jointpos name="position" joint="rail"/></sensor></mujoco>"""
PARAMETERS = (
    Parameter(name="m", value=1.4, unit="kg", where="body/cart.mass", lower=0.1, upper=9.0),
    Parameter(
        name="d", value=4.0, unit="N s/m", where="joint/rail.damping", lower=0.0, upper=90.0
    ),
)  # fmt: skip
AXIS = Axis(joint="rail", kind="slide", force=14.0, speed=1.0, travel=0.7, middle=MIDDLE)


def push(q, v, size):
    """A force of one direction, whatever the motion is."""
    return -size


def rub(q, v, size):
    """A force against the motion."""
    return -size * np.sign(v)


def rise(q, v, size):
    """A force while the position rises."""
    return -size if v > 0 else 0.0


def record(seed, force=push, size=SIZE, seconds=10.0, late=0.0, spring=0.0, is_smooth=False):
    """A record under a controller that follows a path; its input is smooth, or jumps too.

    Args:
        seed: of the path.
        force: of the bump.
        size: of the bump [N].
        seconds: how long it lasts.
        late: how much later the inputs act than their stamps say [s].
        spring: k [N/m].
        is_smooth: whether no jumps are added to the input.
    """
    rng = np.random.default_rng(seed)
    n, every = round(seconds / STEP), round(STEP / SMALL)
    ω, φ, a = 2 * np.pi * rng.uniform(0.08, 0.5, 4), rng.uniform(0, 6.3, 4), rng.uniform(0.4, 1, 4)
    t = STEP * np.arange(n)
    wave = np.sin(np.outer(t, ω) + φ) @ a
    path = MIDDLE + REACH * wave / np.abs(wave).max()
    rate = np.gradient(path, STEP)
    kicks = np.repeat(rng.choice([-0.8, 0.8], n // 30 + 1), 30)[:n] * (not is_smooth)
    u, y, q, v = np.zeros(n), np.zeros(n), path[0], rate[0]
    for i in range(n):
        wanted = 40 * (path[i] - q) + 4 * (rate[i] - v) + 0.8 * rate[i] + kicks[i]
        u[i], y[i] = round(min(3.0, max(-3.0, wanted)), 3), q
        for j in range(every):
            k = int(np.floor((i * every + j) * SMALL / STEP - late / STEP + 1e-9))
            x = 2 * (q - AT) / WIDTH
            bump = force(q, v, size * 0.5 * (1 + np.cos(np.pi * x))) if abs(x) < 1 else 0.0
            f = GEAR * (u[k] if k >= 0 else 0.0) - DAMPING * v - spring * (q - MIDDLE) + bump
            q += SMALL * (v + SMALL * f / MASS / 2)
            v += SMALL * f / MASS
    return Log(
        time=t, inputs=u[:, None], outputs=(y + NOISE * rng.standard_normal(n))[:, None],
        input_names=("drive",), output_names=("position",),
        units={"drive": "1", "position": "m"}, name=f"record {seed}",
    )  # fmt: skip


@cache
def cart():
    """The cart as its drawing has it."""
    return joint_plant(MJCF, PARAMETERS, record(0, seconds=1.0), joints=(AXIS,))


def searched(logs, names=()):
    """What a search of records is asked, and the fit of the nominal model to the first two."""
    records = as_records(logs[:2], logs[2:])
    base = NominalModel(cart(), ("m", "d"), np.array([0.5, 0.5]), HORIZON)
    known = candidates(cart(), ("m", "d"))
    task = RecordsTask(
        nominal_model=base, records=records, options=DiscoveryOptions(),
        effects=tuple(e for e in known if not names or e.name in names),
    )  # fmt: skip
    return task, fit_nominal(base, records)
