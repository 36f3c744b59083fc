"""What the cross-check found, what it is judged by, and that in sentences."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from inca_mj.crosscheck.derivatives import DerivativeErrors
from inca_mj.crosscheck.order import crossing, leading_slope, slope
from inca_mj.crosscheck.trajectories import CASES, Row

DERIVATIVE_LIMIT = 1e-9  # relative
ANGLE_LIMITS = {1e-3: 1e-5, 5e-4: 1e-6}  # step [s] -> largest angle error on the PRBS [rad]
ORDER, ORDER_LIMIT = 4.0, 0.3

Check = tuple[bool, str]


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

        `inca_mj.crosscheck.order` says what leads at smaller steps; `orders` are over all.
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
        """Whether every limit that could be judged was kept, and nothing diverged."""
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
        """All of it as plain JSON values."""
        return {
            "rows": [dict(row) for row in self.rows],
            "order": self.order,
            "orders": self.orders,
            "tension_orders": self.tension_orders,
            "derivatives": self.derivatives.to_json(),
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
        for h, error in zip(*self._errors("prbs", "max_angle_error"), strict=True):
            limit = next((e for step, e in ANGLE_LIMITS.items() if abs(step / h - 1) < 1e-6), None)
            if limit is not None:
                shown = "diverged" if error is None else f"{error:.1e} rad"
                yield (
                    error is not None and error <= limit,
                    f"PRBS at {1e3 * h:g} ms: largest motor angle error {shown}"
                    f" (limit {limit:g} rad).",
                )
        if self.order is not None:
            yield (
                abs(self.order - ORDER) <= ORDER_LIMIT,
                f"On the PRBS the error falls with order {self.order:.2f} of the step where"
                f" RK4's own error leads (limit {ORDER:g} ± {ORDER_LIMIT:g}).",
            )

    def _diverged_at_model_step(self) -> bool:
        """Whether a run diverged at a step that the limits are set for, or below."""
        longest = max(ANGLE_LIMITS) * (1 + 1e-6)
        return any(row["max_angle_error"] is None and row["step"] <= longest for row in self.rows)

    def _observations(self) -> Iterator[str]:
        below = crossing(*self._errors("prbs", "max_angle_error")) if "prbs" in self.cases else 0.0
        if 0 < below < float("inf"):
            yield (
                f"Below a step of {1e3 * below:.2g} ms the PRBS error falls with the square of the"
                " step only: MuJoCo's RK4 turns the handle by averaged angular velocities, which"
                " is exact to second order for rotations that do not commute."
            )
        why = {
            "step": "all steps together, RK4's order and the quaternion's",
            "prbs": "all steps together, RK4's order and the quaternion's",
            "drop": "cables turn taut within a step, a kink that costs RK4 its order",
            "spin": "the handle turns, and the quaternion's second order leads",
        }
        for case in CASES:
            order = self.orders.get(case)
            if order is not None:
                yield f"Order over all steps, {case}: {order:.1f} ({why[case]})."
