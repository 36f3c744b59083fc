"""The readers of files, each with right files that a fuzzer changes."""

import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.io import savemat

from identification import read_log, read_robot
from identification.commands.arguments import parsed
from identification.discovery.options import read_options
from identification.linear.export import load_system, save_system
from identification.linear.system import LinearSystem
from identification.storage.folders import MADE, whole_folder
from identification.sweep.config import read_sweep
from inca_mj.cli import Command
from inca_mj.robot.geometry import INCA, read_geometry, write_geometry
from inca_mj.robot.inputs import prbs
from inca_mj.twin.logs import ANGLES, CURRENTS, read_inca_log
from inca_mj.twin.run import load_run, save_run, simulate
from inca_mj.twin.saved import load_twin, save_twin
from inca_mj.twin.twin import build_twin
from inca_mj.workflows.spread import read_spread

ROOT = Path(__file__).parents[2]
SAMPLES = 60
OPTIONS = "min_proof_t = 3.0\nmax_effects = 4\n"
MODEL = """<mujoco model="slider">
  <compiler angle="radian"/>
  <option timestep="0.002" gravity="0 0 0" integrator="RK4"/>
  <default><joint damping="3"/></default>
  <worldbody><body name="cart"><inertial pos="0 0 0" mass="2" diaginertia="1 1 1"/>
    <joint name="slide" type="slide" axis="1 0 0" damping="3" armature="0.1"/>
    <geom name="box" type="box" size="0.1 0.1 0.1"/>
    <replicate count="3" offset="0.1 0 0"><geom type="sphere" size="0.01"/></replicate>
    <body name="pole" pos="0 0 0.1"><joint name="hinge" axis="0 1 0" range="-1 1"/>
      <geom type="capsule" fromto="0 0 0 0 0 0.5" size="0.02" density="500"/></body></body>
  </worldbody>
  <actuator><general name="force" joint="slide" gear="5" ctrlrange="-3 3" ctrllimited="true"/>
  </actuator>
  <sensor><jointpos name="position" joint="slide"/><jointpos name="angle" joint="hinge"/></sensor>
</mujoco>"""
ROBOT = """
model = "slider.xml"
outputs = ["position"]
free = ["mass", "joint/slide.damping", "qpos[0]", "qvel[0]"]
own = ["qpos[0]"]
horizon = 0.4
every = 2
trust = ["wiring"]
[columns]
position = "x"
[log.units]
x = "m"
[start]
"qvel[1]" = 0.0
[parameters.mass]
path = "body/cart.mass"
unit = "kg"
value = 2.1
prior = 0.2
lower = 0.1
upper = 10.0
scale = 1.0
[fixed]
"stribeck_friction.v_s" = 0.05
[effects]
joints = ["slide"]
only = ["stribeck_friction"]
"""


SWEEP = """
seed = 3
about = "a study"
[[study]]
method = "own.py:OWN"
name = "first"
count = 2
paired = true
[study.settings]
log = "log.csv"
[study.grid]
ratio = [1, 3, 10]
file = { files = "*.csv", label = { kind = "null" } }
"""
OWN = """
from dataclasses import dataclass
from pathlib import Path
from identification.sweep.method import Column, Method

@dataclass(frozen=True)
class Settings:
    ratio: int
    log: Path
    file: str = "a"

OWN = Method(
    about="nothing", settings=Settings, columns={"a": Column(float, "one")},
    run=lambda settings, seed: {"a": 1.0},
)
"""


@dataclass(frozen=True)
class Target:
    """A reader."""

    make: Callable[[Path], object]  # writes right files into a folder
    changed: tuple[str, ...]  # names of the files that are changed, one at a time
    read: Callable[[Path], object]  # reads what lies in a folder
    share: float  # of the cases of a run; slow readers have few


def _log(folder: Path) -> None:
    with (ROOT / "examples" / "log.csv").open() as file:
        (folder / "log.csv").write_text("".join(next(file) for _ in range(SAMPLES + 1)))
    (folder / "log.toml").write_text(
        'notes = "short"\nsampling_time = 0.01\nhold = "zoh"\n[units]\ntime = "s"\nangle = "rad"\n'
        '[columns]\nangle_1 = "angle_1"\n[splits]\nestimation = [0.0, 0.3]\n'
        "validation = [0.3, 0.59]\n"
    )


def _matlab(folder: Path) -> None:
    chance = np.random.default_rng(0)
    u, y = chance.uniform(-1, 1, (SAMPLES, 8)), chance.uniform(-1, 1, (SAMPLES, 8))
    savemat(folder / "log.mat", {"u": u, "y": y, "Ts": 0.01})


def _robot(folder: Path) -> None:
    (folder / "slider.xml").write_text(MODEL)
    (folder / "robot.toml").write_text(ROBOT)
    time = 0.01 * np.arange(SAMPLES)
    table = np.column_stack([time, np.sin(9 * time), 0.1 * np.sin(7 * time)])
    np.savetxt(folder / "log.csv", table, "%.9g", ",", header="time,force,x", comments="")


def _sweep(folder: Path) -> None:
    (folder / "sweep.toml").write_text(SWEEP)
    (folder / "own.py").write_text(OWN)
    (folder / "log.csv").touch()
    (folder / "labels.json").write_text('{"log": {"kind": "null", "effects": ["a"]}}')


def _results(folder: Path) -> None:
    with whole_folder(folder / "out") as draft:
        (draft / "result.json").write_text("{}")
    (folder / MADE).write_bytes((folder / "out" / MADE).read_bytes())


def _replaced(folder: Path) -> None:
    """Write results into a folder whose list of results is a changed one."""
    (folder / "out" / MADE).write_bytes((folder / MADE).read_bytes())
    with whole_folder(folder / "out") as draft:
        (draft / "result.json").write_text("{}")


def _system(folder: Path) -> None:
    names = {"states": ("x", "v"), "inputs": ("u",), "outputs": ("y",)}
    A, B, C, D = np.eye(2), np.ones((2, 1)), np.ones((1, 2)), np.zeros((1, 1))
    at = {"x": np.zeros(2), "u": np.zeros(1), "y": np.zeros(1), "rate": np.zeros(2)}
    save_system(LinearSystem(A=A, B=B, C=C, D=D, **at, **names), folder / "system.npz")


def _run(folder: Path) -> None:
    save_run(simulate(build_twin(), prbs(11, 0.01)), folder / "run.npz")


def _arguments(folder: Path) -> None:
    (folder / "arguments").write_text(
        "\n".join(("discover", "log.csv", "--confirm", "other.csv", "--spread", "usual",
                   "--param", "m=0.2", "lambda=26000", "--out", "out/x", "--json"))
    )  # fmt: skip


def _parse(folder: Path) -> object:
    words = (folder / "arguments").read_bytes().decode(errors="surrogateescape").split("\n")
    given = [w for w in words if w not in ("-h", "--help")]
    command = parsed(Command, "inca", "", given)
    return command.robot.parameters() if hasattr(command, "robot") else command


TARGETS = {
    "log": Target(_log, ("log.csv",), lambda d: read_inca_log(d / "log.csv"), 5),
    "sidecar": Target(_log, ("log.toml",), lambda d: read_inca_log(d / "log.csv"), 5),
    "lenient log": Target(
        _robot, ("log.csv",),
        lambda d: read_log(d / "log.csv", ["force"], ["x"], ["y"], lenient=True), 3,
    ),
    "geometry": Target(
        lambda d: write_geometry(INCA, d / "geometry.toml"), ("geometry.toml",),
        lambda d: build_twin(geometry=read_geometry(d / "geometry.toml")), 1.5,
    ),
    "spread": Target(
        lambda d: shutil.copy(ROOT / "models" / "inca6d_spread.toml", d / "spread.toml"),
        ("spread.toml",), lambda d: read_spread(d / "spread.toml"), 3,
    ),
    "options": Target(
        lambda d: (d / "options.toml").write_text(OPTIONS), ("options.toml",),
        lambda d: read_options(d / "options.toml"), 3,
    ),
    "run": Target(_run, ("run.npz",), lambda d: load_run(d / "run.npz"), 1),
    "twin": Target(
        lambda d: save_twin(build_twin(), d), ("model.xml", "effects.json"), load_twin, 0.7
    ),
    "robot": Target(
        _robot, ("robot.toml",), lambda d: read_robot(d / "robot.toml", d / "log.csv"), 1
    ),
    "MJCF": Target(
        _robot, ("slider.xml",), lambda d: read_robot(d / "robot.toml", d / "log.csv"), 1
    ),
    "sweep": Target(
        _sweep, ("sweep.toml", "labels.json"),
        lambda d: read_sweep(d / "sweep.toml", {}), 2,
    ),
    "results": Target(_results, (MADE,), _replaced, 2),
    "system": Target(_system, ("system.npz",), lambda d: load_system(d / "system.npz"), 2),
    "MATLAB": Target(
        _matlab, ("log.mat",), lambda d: read_log(d / "log.mat", CURRENTS, ANGLES), 0.02
    ),
    "command line": Target(_arguments, ("arguments",), _parse, 0.1),
}  # fmt: skip
