"""The cross-check: derivatives, then all cases at all steps; limits, verdict and sentences."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from typing import Any

from identification.errors import InputError
from identification.model.parameter import ParameterSet
from identification.model.rollout import substeps
from inca_mj.reference import simulate_reference
from inca_mj.robot.geometry import INCA, Geometry
from inca_mj.robot.inputs import refuse_duration
from inca_mj.robot.parameters import parameter_set
from inca_mj.verification.derivatives import DerivativeErrors, compare_derivatives
from inca_mj.verification.trajectories import (
    CASES,
    SAMPLING_TIME,
    Row,
    compare_runs,
    crossing,
    leading_slope,
    make_case,
    slope,
)

STEPS = (2e-3, 1e-3, 5e-4, 2.5e-4)  # [s]
DERIVATIVE_LIMIT = 1e-9  # relative
STEPS_JUDGED = (1e-3, 5e-4)  # the twin's step, and half of it [s]
# Largest angle error at those steps [rad]: RK4 where cables stay taut, the quaternion's h² where
# the platform turns, and a kink of order 1 where cables snap taut.
ANGLE_LIMITS = {
    "prbs": (1e-5, 1e-6),
    "step": (1e-4, 2.5e-5),
    "spin": (1e-4, 2.5e-5),
    "drop": (5e-2, 2.5e-2),
}
# An angle error e moves R e of cable; ten times that covers the platform's lever arms.
POSITION_PER_ANGLE = 10 * 0.0175  # [m/rad]
# ... and changes a tension by λ R e/d, ten times that where all cables err at once.
TENSION_PER_ANGLE = 10 * 32224 * 0.0175 / 2.5  # [N/rad]
ORDER, ORDER_LIMIT = 4.0, 0.3

Check = tuple[bool, str]


def crosscheck(
    parameters: ParameterSet | None = None,
    geometry: Geometry = INCA,
    *,
    duration: float = 10.0,
    steps: Sequence[float] = STEPS,
    cases: Sequence[str] = CASES,
    states: int = 10_000,
    seed: int = 0,
    progress: Callable[[str], None] | None = None,
) -> CrossCheck:
    """Compare the MuJoCo twin with the reference ODE.

    Args:
        parameters: values of both; the thesis' Table 3.2 when None.
        geometry: anchors of the cables.
        duration: of each trajectory [s].
        steps: of the twin [s]; each divides 10 ms.
        cases: which of `CASES` to run.
        states: number of random states for the accelerations.
        seed: of the random states.
        progress: told in words what is done next.

    Raises:
        InputError: a case is unknown, a step does not divide 10 ms, the duration is less than
            two samples, fewer than one state is asked for, or the start admits no rest.
        DivergenceError: the reference cannot be integrated.
    """
    parameters = parameters or parameter_set()
    if states < 1:
        raise InputError(f"cannot compare at {states} states; give 1 or more")
    refuse_duration(duration, SAMPLING_TIME)
    for step in steps:
        substeps(SAMPLING_TIME, step)
    made = [make_case(name, parameters, geometry, duration) for name in cases]
    say = progress or (lambda _: None)

    # The references need Python and its lock, the twin's runs do without: they overlap.
    with ThreadPoolExecutor(1) as worker:
        references = [
            worker.submit(
                simulate_reference, parameters, geometry, c.time, c.currents, start=c.start
            )
            for c in made
        ]
        say(f"accelerations at {states} random states")
        derivatives = compare_derivatives(states, seed, parameters, geometry)
        found = []
        for case, reference in zip(made, references, strict=True):
            for step in steps:
                say(f"{case.name}, {duration:g} s at {1e3 * step:g} ms")
                found.append(compare_runs(case, reference.result, parameters, geometry, step))
    rows, notes = zip(*found, strict=True) if found else ((), ())
    return CrossCheck(derivatives, rows, tuple(note for note in notes if note))


@dataclass(frozen=True)
class CrossCheck:
    """Errors of the twin against the reference.

    Attributes:
        derivatives: relative errors at random states.
        rows: one for each case and step: case, step [s], max_angle_error [rad],
            max_position_error [m], max_tension_error [N]; errors are None when a run diverged.
        notes: a sentence for each run that diverged.
    """

    derivatives: DerivativeErrors
    rows: tuple[Row, ...]
    notes: tuple[str, ...] = ()

    @property
    def order(self) -> float | None:
        """Order of the angle error on the PRBS over the steps where RK4's own error leads.

        `inca_mj.verification.trajectories` says what leads at smaller steps; `orders` are over all.
        None when the PRBS was not run at three steps or more.
        """
        return leading_slope(*self._errors("prbs", "max_angle_error"))

    @property
    def orders(self) -> dict[str, float | None]:
        """Order of the angle error by case, over all steps that did not diverge."""
        return {case: slope(*self._errors(case, "max_angle_error")) for case in self.cases}

    @property
    def tension_orders(self) -> dict[str, float | None]:
        """Order of the tension error by case, over all steps that did not diverge."""
        return {case: slope(*self._errors(case, "max_tension_error")) for case in self.cases}

    @property
    def cases(self) -> tuple[str, ...]:
        """Cases that were run."""
        return tuple(dict.fromkeys(str(row["case"]) for row in self.rows))

    @property
    def passed(self) -> bool:
        """Tells whether every limit that could be judged was kept, and nothing diverged."""
        return all(kept for kept, _ in self._checks()) and not self._diverged_at_model_step()

    @property
    def sentences(self) -> tuple[str, ...]:
        """The verdict, a limit or an observation each."""
        judged = tuple(("" if kept else "NOT KEPT: ") + text for kept, text in self._checks())
        verdict = (
            "The MuJoCo twin and the reference ODE, which share no physics code,"
            f" {'agree' if self.passed else 'DISAGREE'}."
        )
        return (verdict, *judged, *self._observations(), *self.notes)

    def to_json(self) -> dict[str, Any]:
        """Returns the whole result as plain JSON values."""
        return {
            "rows": [dict(row) for row in self.rows],
            "order": self.order,
            "orders": self.orders,
            "tension_orders": self.tension_orders,
            "derivatives": asdict(self.derivatives),
            "passed": self.passed,
            "sentences": list(self.sentences),
        }

    def _errors(self, case: str, name: str) -> tuple[list[float], list[float | None]]:
        rows = [row for row in self.rows if row["case"] == case]
        return [row["step"] for row in rows], [row[name] for row in rows]

    def _checks(self) -> Iterator[Check]:
        worst = self.derivatives.largest
        yield (
            worst <= DERIVATIVE_LIMIT,
            f"Accelerations at {self.derivatives.states} random states agree to {worst:.1e}"
            f" relative (limit {DERIVATIVE_LIMIT:g}).",
        )
        for row in self.rows:
            for k, step in enumerate(STEPS_JUDGED):
                if abs(row["step"] / step - 1) < 1e-6:
                    yield _judge(row, ANGLE_LIMITS[row["case"]][k])
        if self.order is not None:
            yield (
                abs(self.order - ORDER) <= ORDER_LIMIT,
                f"On the PRBS the error falls with order {self.order:.2f} of the step where"
                f" RK4's own error leads (limit {ORDER:g} ± {ORDER_LIMIT:g}).",
            )

    def _diverged_at_model_step(self) -> bool:
        """Returns whether a run diverged at a step that the limits are set for, or below."""
        longest = max(STEPS_JUDGED) * (1 + 1e-6)
        return any(row["max_angle_error"] is None and row["step"] <= longest for row in self.rows)

    def _observations(self) -> Iterator[str]:
        if not self.passed and self.derivatives.largest <= DERIVATIVE_LIMIT:
            yield (
                "The equations agree at random states, so it is the step that is too coarse for"
                " these values: simulate them with a smaller --step."
            )
        if self.order is None and "prbs" in self.cases:
            yield "The order was not judged: too few steps or too short a run show it."
        below = crossing(*self._errors("prbs", "max_angle_error")) if "prbs" in self.cases else 0.0
        if 0 < below < float("inf"):
            yield (
                f"Below a step of {1e3 * below:.2g} ms the PRBS error falls with the square of the"
                " step only: this MuJoCo's RK4 turns the platform by averaged angular velocities,"
                " which is exact to second order for rotations that do not commute."
            )
        why = {
            "step": "all steps together, RK4's order and the quaternion's",
            "prbs": "all steps together, RK4's order and the quaternion's",
            "drop": "cables turn taut within a step, a kink that costs RK4 its order",
            "spin": "the platform turns, and the quaternion's second order leads",
        }
        for case in CASES:
            order = self.orders.get(case)
            if order is not None:
                yield f"Order over all steps, {case}: {order:.1f} ({why[case]})."


def _judge(row: Row, angle: float) -> Check:
    """Returns whether a run keeps the limits that follow from one on its angles [rad]."""
    limits = {
        "angle": (angle, "rad"),
        "position": (POSITION_PER_ANGLE * angle, "m"),
        "tension": (TENSION_PER_ANGLE * angle, "N"),
    }
    errors = {what: row[f"max_{what}_error"] for what in limits}
    head = f"{row['case']} at {1e3 * row['step']:g} ms: "
    if None in errors.values():
        return False, head + "diverged."
    kept = all(errors[what] <= limit for what, (limit, _) in limits.items())
    shown = ", ".join(
        f"{what} {errors[what]:.1e} (limit {limit:.1e}) {unit}"
        for what, (limit, unit) in limits.items()
    )
    return kept, f"{head}largest errors {shown}."
