"""The linearised twin against its simulation: the tension of a cable hangs on an activation."""

import numpy as np
from effect_cases import full

from identification import Log, Predictor
from identification.kalman.linear import linearise
from inca_mj.robot.inputs import make_input
from inca_mj.twin.logs import ANGLES, CURRENTS

SMALL = 1e-4  # of a current's error [A]


def test_the_answer_to_an_unlogged_current_is_that_of_the_simulation():
    """To what the Jacobian changes within a sample; without the activations it is 200 % off."""
    u = make_input("prbs", 2.0)
    log = Log(
        time=0.01 * np.arange(len(u)),
        inputs=u,
        outputs=np.zeros_like(u),
        input_names=CURRENTS,
        output_names=ANGLES,
    )
    error = SMALL * np.random.default_rng(0).standard_normal(u.shape)
    none = np.empty((1, 0))
    plain, moved = (
        Predictor(
            full(),
            Log(
                time=log.time,
                inputs=inputs,
                outputs=log.outputs,
                input_names=CURRENTS,
                output_names=ANGLES,
            ),
            (),
        ).predict(none)[0]
        for inputs in (u, u + error)
    )
    linear = linearise(Predictor(full(), log, ()), none[0])
    x, y = np.zeros(linear.A.shape[1]), [np.zeros(8)]
    for A, B, w in zip(linear.A, linear.B, error[:-1], strict=True):
        x = A @ x + B @ w
        y.append(linear.C @ x)
    answer = moved - plain
    assert np.linalg.norm(answer - y) < 0.1 * np.linalg.norm(answer)
