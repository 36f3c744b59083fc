"""A world: a robot whose truth is drawn, one hidden effect or none, and two records of it."""

from __future__ import annotations

import zlib
from dataclasses import dataclass, replace

import numpy as np
from departures import CONTROLLERS, EITHER_HALF, MISTUNED, POWERS, Departure

from identification.prediction.judging.trial import TWINS
from joint_worlds import slots as at
from joint_worlds.hidden import EVERY, HIDDEN, NULL, THREE, UNLISTED, Habits, Hidden, Shape
from joint_worlds.motion import ROBOTS, closed_loop, terms
from joint_worlds.reference import KINDS, reference
from joint_worlds.robot import KNOWN, PRESLIDING, SPREAD, Free, JointRobot
from joint_worlds.seen import Numbers, logged, ratio

RATIOS = (3.0, 10.0)  # of an effect over the sensors' noise
LEAST = 1.5  # below which a world would not show its effect
NEAR = 0.15  # the ratio may miss the drawn one by so much
TRIES = 4
CONTROLLER = 0.2  # the controller's numbers are off by up to so much
PUSH = (0.002, 0.01)  # unlogged torque, rms over the rms of the input
USUAL = Departure(name="usual", about="nothing departs")
OFTEN = 0.98  # share of the samples below the force that a limit is counted by
# Other names of a friction whose power is drawn.
OTHER_POWER = {"sublinear_friction": ("quadratic_friction",)}
JUMP = (0.05, 0.2)  # of a force that jumps, over the largest force of its drive
JUMPED = "offset"  # what such a force is once it has jumped
SEVERAL = 3  # effects at once
DRAWS = 12  # of several effects, until all of them show
COLOUR = (0.02, 0.1)  # its correlation time [s]


@dataclass(frozen=True)
class Record:
    """What was logged: inputs and outputs, shape (N, n) each, and the kind of reference."""

    kind: str
    inputs: np.ndarray
    outputs: np.ndarray


@dataclass(frozen=True)
class Acting:
    """One of several effects: names that are right, where it acts, words of right places, size."""

    effect: str
    names: tuple[str, ...]
    joint: str
    places: tuple[str, ...]
    size: float


@dataclass(frozen=True)
class _Control:
    p: np.ndarray
    computed: bool
    bandwidth: float


@dataclass(frozen=True, kw_only=True)
class World:
    """A robot, what is wrong with its nominal model, and its records."""

    robot: JointRobot  # as the nominal model knows it
    effect: str  # name of what is hidden, or "nothing"
    names: tuple[str, ...]  # names that are right; none where the force is in no catalogue
    joint: str  # where it acts
    # words of which an answer names one if its place is right; none where it is clear
    places: tuple[str, ...]
    # the name of the curve that draws a force which is in no catalogue, "-" where none does; ""
    # where the effect is listed, or there is none
    curve: str
    size: float  # of the effect, in the unit of its law
    shape: Shape  # what else was drawn of it
    ratio: float  # how much of it shows, in units of the sensors' noise
    # parameters that are not known exactly; `truth` has their true values by name
    free: tuple[Free, ...]
    truth: dict[str, float]
    coulomb: bool  # whether the nominal model has Coulomb friction
    push: float  # unlogged torque over the input, rms
    also: str = ""  # the name of a second effect; "" where there is none
    acting: tuple[Acting, ...] = ()  # the effects, where several of the catalogue act at once
    records: tuple[Record, Record]  # the one to fit and the one that confirms
    true: Numbers  # of the robot as it is
    control: _Control


class UnseenError(Exception):
    """No size of the effect that is allowed shows in a log of this robot, under its controller."""


def make_world(
    name: str, effect: str, seed: int, duration: float = 20.0, departure: Departure = USUAL,
    reach: float = 1.0,
) -> World:  # fmt: skip
    """Draw a world and simulate its records.

    Args:
        name: of the robot.
        effect: a name of `EVERY`, "nothing", or "three" of the catalogue at once.
        seed: of all that is drawn.
        duration: of a record [s].
        departure: from what is usual.
        reach: share of the robot's travel and speed that its references take.

    Raises:
        UnseenError: the largest size of the effect shows less than `LEAST`.
    """
    robot = ROBOTS[name]
    rng = np.random.default_rng([seed, robot.code, zlib.crc32(effect.encode())])
    for _ in range(DRAWS - 1 if effect == THREE else 0):  # some effects do not show on some robots
        try:
            return _world(robot, effect, rng, duration, departure, reach)
        except UnseenError:
            continue
    return _world(robot, effect, rng, duration, departure, reach)


def _world(
    robot: JointRobot, effect: str, rng: np.random.Generator, duration: float,
    departure: Departure, reach: float,
) -> World:  # fmt: skip
    """Returns what `make_world` draws.

    Raises:
        UnseenError: the largest size of an effect shows less than `LEAST`.
    """
    several = _drawn(robot, rng) if effect == THREE else ()
    hidden = EVERY.get(effect)
    known = {k for h in (*several, *([hidden] if hidden else [])) for k in h.known}
    free = tuple(f for f in robot.all_free if f.kind not in known)
    base = held_base(robot)
    if "coulomb" in known:
        base.joints[:, at.COULOMB] = 0.0
    for f in free:
        base = base.moved(f, rng.uniform(1 - SPREAD, 1 + SPREAD))
        if departure.spread > 1:
            far = departure.spread * KNOWN * float(np.clip(rng.normal(), -2, 2))
            base = base.moved(f, np.exp(far))
    mistuned = MISTUNED if departure.is_mistuned else CONTROLLER
    control = _Control(robot.plain()[0], bool(rng.integers(2)), robot.bandwidth)
    for f in robot.free:
        control.p[f.number] *= rng.uniform(1 - mistuned, 1 + mistuned)
    kinds = rng.choice(KINDS, 2, replace=False)
    if departure.is_mistuned:
        control = replace(control, bandwidth=robot.bandwidth * rng.uniform(*CONTROLLERS))
    count = round(duration / robot.sampling_time)
    aims = [
        reference(str(kind), reach * np.array(robot.travel), reach * np.array(robot.speed),
                  robot.sampling_time, count, rng)
        for kind in kinds
    ]  # fmt: skip
    still = _quiet(robot, base, control, aims[0])
    share = float(rng.uniform(*PUSH))
    own = [still[1], still[1] if departure is USUAL else _quiet(robot, base, control, aims[1])[1]]
    pushes = [
        departure.error(
            u, robot.sampling_time, share * still[1].std(axis=0), rng.uniform(*COLOUR), rng
        )
        for u in own
    ]
    places: tuple[str, ...] = ()
    curve, also, names = "", "", hidden.names(robot) if hidden else (NULL,)
    true, size, shape, shown, joint = base, 0.0, {}, 0.0, ""
    scene = _Scene(robot, base, free, control, aims[0], still, pushes[0], departure)
    if hidden is not None:
        chosen = _sized(scene, effect, rng)
        true, size, shape, shown = chosen.true, chosen.size, chosen.shape, chosen.shown
        joint, places = robot.joints[chosen.j], hidden.places(robot, chosen.j)
        curve = hidden.drawn_as(chosen.j) or hidden.curve
    acting: tuple[Acting, ...] = ()
    for one in several:
        chosen = _sized(scene, one.name, rng)
        j, size, shown = chosen.j, chosen.size, chosen.shown
        true = with_effect(robot, true, one.name, j, size, chosen.shape)
        mine = Acting(one.name, one.names(robot), robot.joints[j], one.places(robot, j), size)
        acting = (*acting, mine)
    if acting:
        names = (*dict.fromkeys(n for a in acting for n in a.names),)
    if departure.hides == "powers":
        names = (*dict.fromkeys((*names, *OTHER_POWER.get(effect, ()))),)
    if departure.hides == "unlisted":
        also = str(rng.choice([n for n, h in UNLISTED.items() if n != effect and h.joints(robot)]))
        second = _sized(scene, also, rng)
        true = with_effect(robot, true, also, second.j, second.size, second.shape)
    if departure.hides == "jumps":
        j = int(rng.integers(robot.n))
        joint, places, names = robot.joints[j], (robot.joints[j],), (JUMPED,)
        size = float(rng.uniform(*JUMP) * np.abs(still[1][:, j]).max() * rng.choice([-1.0, 1.0]))
        begun = round(count * rng.uniform(*EITHER_HALF)) + count * int(rng.integers(2))
        for k, push in enumerate(pushes):
            push[max(0, begun - k * count) :, j] += size
    try:
        records = [
            _record(robot, true, control, aim, str(kind), push, departure, rng)
            for kind, aim, push in zip(kinds, aims, pushes, strict=True)
        ]
    except np.linalg.LinAlgError:  # of a state that left the finite numbers
        raise UnseenError(f"{effect} of {robot.name}: its controller does not hold it") from None
    return World(
        robot=robot, effect=effect, names=names, also=also, acting=acting, joint=joint,
        places=places, curve=curve,
        size=size, shape=shape, ratio=shown, free=free, coulomb="coulomb" not in known,
        truth={f.name: float(base.p[f.number] if f.number is not None else base.joints[f.slot])
               for f in free},
        push=share, records=(records[0], records[1]), true=true, control=control,
    )  # fmt: skip


def further_record(world: World, aim: np.ndarray, seed: int) -> Record:
    """Returns another record of a world, which follows a motion (3, N, n): q, q̇ and q̈."""
    robot, h = world.robot, world.robot.sampling_time
    rng = np.random.default_rng([seed, robot.code])
    rms = world.push * world.records[0].inputs.std(axis=0)
    push = USUAL.error(np.zeros(aim.shape[1:]), h, rms, rng.uniform(*COLOUR), rng)
    return _record(robot, world.true, world.control, aim, "further", push, USUAL, rng)


def _drawn(robot: JointRobot, rng: np.random.Generator) -> tuple[Hidden, ...]:
    """Returns three effects of the catalogue, of which no two may be one force by two names."""
    out: list[Hidden] = []
    for name in rng.permutation(sorted(HIDDEN)):
        one = HIDDEN[str(name)]
        taken = {n for o in out for n in (*o.names(robot), TWINS.get(o.name, ""))}
        if len(out) < SEVERAL and one.joints(robot) and not taken & {*one.names(robot)}:
            out.append(one)
    return tuple(out)


@dataclass(frozen=True)
class _Scene:
    """What the size of an effect is counted in: a robot without it, and its motion."""

    robot: JointRobot
    base: Numbers
    free: tuple[Free, ...]
    control: _Control
    aim: np.ndarray
    still: tuple[np.ndarray, np.ndarray]
    push: np.ndarray
    departure: Departure


@dataclass(frozen=True)
class _Chosen:
    """An effect on joint j of a size that shows, and the robot with it."""

    true: Numbers
    j: int
    size: float
    shape: Shape
    shown: float


def _sized(scene: _Scene, effect: str, rng: np.random.Generator) -> _Chosen:
    """Draws an effect, and a size of it that shows as much as is drawn.

    Raises:
        UnseenError: the largest size shows less than `LEAST`.
    """
    robot, base, still, hidden = scene.robot, scene.base, scene.still, EVERY[effect]
    j = int(rng.choice(hidden.joints(robot)))
    habits = Habits(
        float(np.abs(still[1][:, j]).max()), float(np.abs(still[0][:, 1, j]).max()),
        float(np.abs(still[0][:, 0, j]).max()), robot.coulomb[j], robot.damping[j],
        float(np.quantile(np.abs(still[1][:, j]), OFTEN)),
    )  # fmt: skip
    shape, target = hidden.shape(habits, rng), float(np.exp(rng.uniform(*np.log(RATIOS))))
    if scene.departure.hides == "powers":
        shape = {**shape, "p": float(rng.uniform(*POWERS))}
    most = hidden.largest(habits)
    size, tried, shown, true = 0.2 * most, 0.0, 0.0, base
    for _ in range(TRIES):
        true, tried = with_effect(robot, base, effect, j, size, shape), size
        try:
            motion = _quiet(robot, true, scene.control, scene.aim)
        except np.linalg.LinAlgError:
            held = f"{effect} of {robot.name}: its controller does not hold {size:.2g} of it"
            raise UnseenError(held) from None
        shown = ratio(robot, true, base, scene.free, *motion, scene.push)
        if abs(shown / target - 1) < NEAR or (size == most and shown < target):
            break
        size = min(most, size * float(np.clip(target / max(shown, 1e-9), 0.05, 20)))
    if shown < LEAST:
        raise UnseenError(f"{effect} of {robot.name} shows {shown:.2g} times the noise at most")
    return _Chosen(true, j, tried, shape, shown)


def held_base(robot: JointRobot) -> Numbers:
    """The nominal robot, its contacts stiff against the sensors' noise and damped."""
    p, joints = robot.plain()
    M, c, g = np.zeros((robot.n, robot.n)), np.zeros(robot.n), np.zeros(robot.n)
    terms(robot.code, np.zeros(robot.n), np.zeros(robot.n), p, M, c, g)
    inertia = 1 / np.diag(np.linalg.inv(M))
    joints[:, at.STIFF] = np.array(robot.coulomb) / (PRESLIDING * robot.noise)
    joints[:, at.DAMP] = 1.4 * np.sqrt(joints[:, at.STIFF] * inertia)
    return Numbers(p, joints)


def with_effect(
    robot: JointRobot, base: Numbers, effect: str, j: int, size: float, shape: Shape
) -> Numbers:
    """A robot's numbers with an effect on joint j; a body's mass where the effect is one."""
    hidden, p, joints = EVERY[effect], base.p.copy(), base.joints.copy()
    if hidden.body == "payload":
        p[list(robot.payload)] = size * p[robot.link[0]]
    elif hidden.body == "link":
        p[list(robot.link)] *= 1 + size
    else:
        for k in range(robot.n) if hidden.everywhere else [j]:
            hidden.put(joints[k], size, shape)
    return Numbers(p, joints)


def _quiet(
    robot: JointRobot, numbers: Numbers, control: _Control, aim: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """States and inputs of a motion without any noise."""
    nothing = np.zeros(aim.shape[1:])
    states, u, _ = closed_loop(
        robot.code, numbers.p, numbers.joints, control.p, control.computed, control.bandwidth, aim,
        nothing, np.zeros(robot.n), nothing, robot.sampling_time / robot.substeps, robot.substeps,
    )  # fmt: skip
    return states, u


def _record(
    robot: JointRobot, numbers: Numbers, control: _Control, aim: np.ndarray, kind: str,
    push: np.ndarray, departure: Departure, rng: np.random.Generator,
) -> Record:  # fmt: skip
    """A motion as it is logged; push: unlogged torque, shape (N, n)."""
    h = robot.sampling_time
    errors = departure.noise((len(push), robot.n), np.array(robot.white), rng)
    states, u, _ = closed_loop(
        robot.code, numbers.p, numbers.joints, control.p, control.computed, control.bandwidth, aim,
        errors, robot.steps, push, h / robot.substeps, robot.substeps,
    )  # fmt: skip
    y = logged(robot, numbers.joints, states) + errors
    return Record(kind, u, robot.steps * np.round(y / robot.steps))
