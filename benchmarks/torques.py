"""Payloads and false names by torques: arms in closed loop whose armatures and masses are free.

    python benchmarks/torques.py [--seeds 20] [--nulls 40] [--joints 2 6] [--measured DATA]

An arm of 2 or 6 geared hinges follows two references of five harmonics, one record is fitted and
one confirms. Its controller is unknown to the model. Positions have noise of 50 µrad, which the
controller sees, and the torques noise of 1 % of their rms. The true masses, armatures and frictions
differ from the model's by their priors (10, 15 and 30 %). In a half of the worlds the last body
carries a load of 10 to 20 % of the arm's mass at its end, in the others nothing is missing.
`--measured` compares the torques of a UR10e instead, by both splits of its records, with the
authors' parameters on the same equations, and those of EMPS. Rows go to
`benchmarks/results/torques.jsonl`; seconds are those of the processor.
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import mujoco
import numpy as np
from rows import search_commit

from identification import Log, fit_torques, read_robot
from identification.report.torque_words import size_words
from identification.torques.bodies import read_numbers

ROWS = Path(__file__).resolve().parent / "results" / "torques.jsonl"
STEP, SAMPLED, LASTS = 0.0005, 20, 20.0  # the controller takes each step, the log every 20th
Y, Z = "0 1 0", "0 0 1"
AXES = {2: (Y, Y), 6: (Z, Y, Y, Y, Z, Y)}
NOISE, TORQUE_NOISE, LOAD = 5e-5, 0.01, 0.2
FILTER = 0.03  # of the rates that the controller makes of positions, in each step
SPREAD = {"mass": 0.1, "armature": 0.15, "friction": 0.3}
HARMONICS, SLOWEST = 5, 0.1  # of the reference, and its first frequency [Hz]


def arm(joints: int, rng: np.random.Generator | None, load: float = 0.0) -> str:
    """The MJCF of an arm: the model's numbers, or true ones drawn about them."""

    def of(kind: str) -> float:
        return 1.0 if rng is None else float(np.exp(SPREAD[kind] * rng.standard_normal()))

    text = ""
    for k in range(joints):
        m, length = 6.0 * 0.6**k, 0.4 * 0.8**k
        inertia = " ".join(f"{m * length**2 * x:.6g}" for x in (0.1, 0.1, 0.02))
        m *= of("mass")
        size = 4.0 * 0.5**k
        text += (
            f'<body name="b{k}" pos="0 0 {0.5 * 0.8**k if k else 0.3:.4f}"><joint name="j{k}"'
            f' axis="{AXES[joints][k]}"'
            f' armature="{size / 4 * of("armature"):.6g}" damping="{size * of("friction"):.6g}"'
            f' frictionloss="{size * of("friction"):.6g}"/>'
            f'<inertial pos="0.02 0.01 {length / 2:.4f}" mass="{m:.6g}" diaginertia="{inertia}"/>'
            f'<site name="s{k}" pos="0 0 {length:.4f}"/>'
        )
    end = 0.4 * 0.8 ** (joints - 1)
    if load:
        text += (f'<body pos="0 0 {end:.4f}"><inertial pos="0 0 0" mass="{load:.6g}"'
                 ' diaginertia="1e-5 1e-5 1e-5"/></body>')  # fmt: skip
    text += "</body>" * joints
    motors = "".join(f'<motor name="t{k}" joint="j{k}"/>' for k in range(joints))
    sensors = "".join(f'<jointpos name="q{k}" joint="j{k}"/>' for k in range(joints))
    return (
        f'<mujoco><compiler angle="radian"/><option timestep="{STEP}" integrator="implicitfast"/>'
        f"<worldbody>{text}</worldbody><actuator>{motors}</actuator><sensor>{sensors}</sensor>"
        "</mujoco>"
    )


def record(truth: str, joints: int, rng: np.random.Generator, name: str) -> Log:
    """A record of an arm that follows a reference."""
    model = mujoco.MjModel.from_xml_string(truth)
    data = mujoco.MjData(model)
    frequency = SLOWEST * np.arange(1, HARMONICS + 1)
    a = rng.uniform(0.1, 0.35, (joints, HARMONICS)) / np.sqrt(np.arange(1, HARMONICS + 1))
    p = rng.uniform(0, 2 * np.pi, (joints, HARMONICS))
    M = np.array([4.0 * 0.5**k for k in range(joints)])
    kp, kd = 400.0 * M, 40.0 * M
    data.qpos = (a * np.sin(p)).sum(axis=1)
    rows, slow, seen = [], np.zeros(joints), data.qpos.copy()
    for k in range(int(LASTS / STEP)):
        phase = 2 * np.pi * frequency * k * STEP + p
        ref = (a * np.sin(phase)).sum(axis=1)
        rate = (a * 2 * np.pi * frequency * np.cos(phase)).sum(axis=1)
        measured = data.qpos + NOISE * rng.standard_normal(joints)
        slow += FILTER * ((measured - seen) / STEP - slow)
        seen = measured
        u = kp * (ref - measured) + kd * (rate - slow)
        if k % SAMPLED == 0:
            rows.append([k * STEP, *u, *measured])
        data.ctrl = u
        mujoco.mj_step(model, data)
    table = np.array(rows)
    torque = table[:, 1 : 1 + joints]
    torque = torque + TORQUE_NOISE * torque.std(axis=0) * rng.standard_normal(torque.shape)
    return Log(
        time=table[:, 0], inputs=torque, outputs=table[:, 1 + joints :],
        input_names=[f"t{k}" for k in range(joints)], output_names=[f"q{k}" for k in range(joints)],
        name=name, hold="foh",
    )  # fmt: skip


def world(joints: int, seed: int, loaded: bool) -> dict[str, Any]:
    """What torques say of one arm."""
    rng = np.random.default_rng([seed, joints, loaded])
    mass = sum(6.0 * 0.6**k for k in range(joints))
    load = LOAD * mass * float(rng.uniform(0.5, 1.0)) if loaded else 0.0
    truth = arm(joints, rng, load)
    first, second = (record(truth, joints, rng, name) for name in ("a", "b"))
    free = {f"joint/j{k}.armature": SPREAD["armature"] for k in range(joints)}
    free |= {f"body/b{k}.mass": SPREAD["mass"] for k in range(joints)}
    with TemporaryDirectory() as folder:
        path = Path(folder)
        (path / "arm.xml").write_text(arm(joints, None), encoding="utf-8")
        names = ", ".join(f'"{name}"' for name in free)
        toml = f'model = "arm.xml"\nfree = [{names}]\nhorizon = 0.2\n'
        toml += "".join(f'[parameters."{n}"]\nknown = {s}\n' for n, s in free.items())
        (path / "arm.toml").write_text(toml, encoding="utf-8")
        robot = read_robot(path / "arm.toml", first, [second], ["wiring", "units", "steps"])
        began = time.process_time()
        found = fit_torques(robot)
        seconds = time.process_time() - began
    first_name = found.named[0] if found.named else None
    payload = next((s for s in found.named if s.missing.name in ("payload", "load")), None)
    return {
        "joints": joints, "seed": seed, "load": load, "seconds": round(seconds, 2),
        "named": [s.missing.title for s in found.named],
        "first": None if first_name is None else first_name.missing.title,
        "mass": None if payload is None else float(payload.size[0]),
        "std": None if payload is None else float(payload.std[0]),
        "nearest_chance": found.found.scores[0].chance, "commit": search_commit(),
    }  # fmt: skip


def measured(data: Path, turned: bool) -> dict[str, Any]:
    """What torques say of the UR10e, and what its authors' parameters leave of them."""
    from robots import ur10e
    from robots.ur10e_evidence import published

    folder = data / "ur10e"
    fit, confirm = (
        [ur10e.read_record(folder / f"{name}.csv", 0.01) for name in names]
        for names in ((ur10e.CONFIRM, ur10e.FIT) if turned else (ur10e.FIT, ur10e.CONFIRM))
    )
    robot = read_robot(folder / "full1.toml", fit, confirm, ["wiring", "units"])
    began = time.process_time()
    found = fit_torques(robot)
    seconds, e = time.process_time() - began, found.found
    theirs = published(folder / "ur10e.xml").compile()
    left, count = np.zeros(6), np.zeros(6)
    for rows in e.equations.rows[len(fit) :]:
        friction = np.array(ur10e.FRICTION).T
        predicted = np.einsum("kjbn,bn->kj", rows.bodies, read_numbers(theirs))
        predicted += theirs.dof_armature * rows.a
        predicted += friction[0] * rows.v + friction[1] * rows.sign + friction[2]
        left += np.where(rows.used, (rows.y - predicted) ** 2, 0.0).sum(axis=0)
        count += rows.used.sum(axis=0)
    return {
        "robot": "ur10e", "fitted": [log.name for log in fit], "seconds": round(seconds, 1),
        "named": [f"{s.missing.title}: {size_words(s)}" for s in found.named],
        "joints": list(ur10e.JOINTS), "torque": np.sqrt(np.mean(np.concatenate(
            [r.drives.sum(axis=2) ** 2 for r in e.equations.rows[len(fit) :]]), axis=0)).tolist(),
        "base_fit": e.unseen[0].tolist(), "model": e.unseen[1].tolist(),
        "final": e.unseen[2].tolist(), "authors": np.sqrt(left / count).tolist(),
        "commit": search_commit(),
    }  # fmt: skip


def measured_axis(data: Path) -> dict[str, Any]:
    """What torques say of EMPS, an axis with a ball screw, of which values are published."""
    from robots import emps

    axis = emps.read(data)
    model = ROWS.parents[2] / "models" / "emps.toml"
    robot = read_robot(model, [*axis.fit], [*axis.confirm], ["wiring", "units"])
    began = time.process_time()
    found = fit_torques(robot)
    return {
        "robot": "emps", "seconds": round(time.process_time() - began, 1),
        "values": {n: [v, found.std[n]] for n, v in found.values.items()},
        "published": [95.11, 203.5, 20.39, 3.16],
        "named": [f"{s.missing.title}: {size_words(s)}" for s in found.named],
        "model": found.found.unseen[1].tolist(), "final": found.found.unseen[2].tolist(),
        "commit": search_commit(),
    }  # fmt: skip


def main() -> None:
    """Make the rows of all worlds."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, default=20, help="arms with a load, of each kind")
    parser.add_argument("--nulls", type=int, default=40, help="arms without, over all kinds")
    parser.add_argument("--joints", type=int, nargs="+", default=[2, 6], choices=AXES)
    parser.add_argument("--measured", type=Path, help="folder of the measured robots")
    given = parser.parse_args()
    if given.measured is not None:
        with ROWS.open("a", encoding="utf-8") as stream:
            for turned in (False, True):
                stream.write(json.dumps(measured(given.measured, turned)) + "\n")
            stream.write(json.dumps(measured_axis(given.measured)) + "\n")
        return
    count = given.nulls // len(given.joints)
    tasks = [(j, s, True) for j in given.joints for s in range(given.seeds)]
    tasks += [(j, s, False) for j in given.joints for s in range(count)]
    with ROWS.open("a", encoding="utf-8") as stream:
        for task in tasks:
            row = world(*task)
            stream.write(json.dumps(row) + "\n")
            stream.flush()
            print(row)


if __name__ == "__main__":
    main()
