"""A pendulum told in TOML, and records of it with masses and offsets of their own."""

from functools import cache

import pytest
from records_cases import AXIS, MJCF, PARAMETERS, record

from identification import joint_plant, write_log
from identification.model.parameter import Parameter

MASS, OFFSET = "body/arm.mass", "offset.f_0@hinge"
TOML = """
model = "pendulum.xml"
free = ["J", "d"]
horizon = 0.2
[parameters.J]
path = "joint/hinge.armature"
value = 1.5e-3
unit = "kg m^2"
[parameters.d]
path = "joint/hinge.damping"
value = 0.03
unit = "N m s/rad"
"""
OWN = TOML.replace('"d"]', f'"d", "{OFFSET}"]\nown = ["{OFFSET}"]') + (
    f'[parameters."{OFFSET}"]\nvalue = 0.0\n'
)


@cache
def plant():
    mass = Parameter(name=MASS, value=0.5, unit="kg", where=MASS, lower=0.0)
    return joint_plant(MJCF, (*PARAMETERS, mass), record(samples=50), joints=(AXIS,))


def measured(seed, values=None, samples=240):
    """A record of a pendulum of J = 2e-3 kg m² and d = 0.02 N m s/rad, if nothing else is said."""
    return record(seed, samples=samples, values=values or {}, plant=plant())


def make_folder(path):
    (path / "pendulum.xml").write_text(MJCF)
    (path / "robot.toml").write_text(TOML)
    (path / "own.toml").write_text(OWN)
    return path


def written(folder, *logs):
    paths = [folder / f"log_{k}.csv" for k in range(len(logs))]
    for log, path in zip(logs, paths, strict=True):
        write_log(log, path)
    return paths


def assert_true(found, name, value):
    assert abs(found.values[name] - value) < 4 * found.std[name]
    assert found.values[name] == pytest.approx(value, rel=0.03)
