"""A callback that compiles quickly, and robots whose laws come from the cache or from numba."""

import os
import subprocess
import sys
from math import tanh
from pathlib import Path

from numba import njit, types

SIGNATURE = types.double(types.double, types.double)


@njit
def _friction(v):
    return 0.3 * tanh(5.0 * v)


def power(q, v):
    """A callback with a function of its own and one of the C library."""
    return _friction(v) * v + 0.5 * q * q


# Prints what two robots with effects do, to the bit; with "refuse" numba may not compile their law.
ROBOTS = """
import hashlib, sys
from numba.core.ccallback import CFunc

def refuse(callback):
    raise AssertionError("numba compiles " + callback.__qualname__)

if sys.argv[1:] == ["refuse"]:
    CFunc.compile = refuse

from identification.effects.plant.joint_plant import joint_plant
from joint_cases import DAMPING, MASS, SLIDER, run, slider_log, steps
from inca_mj import build_twin, make_input, simulate
from inca_mj.effects.catalogue import CATALOGUE

sizes = {"stribeck_friction.f_s": 0.01, "cable_creep.c": 0.05, "air_drag.c": 0.1,
         "pulley_radius.r_p": 0.01, "current_saturation.c": 1.0}
names = {name.partition(".")[0] for name in sizes}
log = slider_log(steps(100))
every = joint_plant(SLIDER, (MASS, DAMPING), log).effects
few = [e for e in every if e.name in ("stribeck_friction", "stiffness")]
slider = joint_plant(SLIDER, (MASS, DAMPING), log, effects=few)
slid = run(slider, log, **{"stribeck_friction.f_s@slide": 0.3, "stiffness.k@slide": 2.0})
robot = build_twin(effects=[e for e in CATALOGUE if e.name in names]).with_values(sizes)
ran = simulate(robot, make_input("prbs", duration=0.5))
for states in (slid, ran.angles, ran.tension):
    print(states.std(), hashlib.sha256(states.tobytes()).hexdigest())
"""


def start(*arguments: str, **environment: str) -> subprocess.Popen:
    """A process that simulates the robots, with other environment variables."""
    places = [str(Path(__file__).parent), *filter(None, [os.environ.get("PYTHONPATH")])]
    return subprocess.Popen(
        [sys.executable, "-c", ROBOTS, *arguments],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(places), **environment},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def output(process: subprocess.Popen) -> str:
    """What a process has printed; it must have ended well."""
    said, errors = process.communicate()
    if process.returncode:
        raise AssertionError(errors)
    return said
