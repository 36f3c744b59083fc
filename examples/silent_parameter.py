"""A parameter that nothing reads: MuJoCo's issue 3286 asked why a search ended at once.

    τ = σ₀ z + σ₁ ż,   ż = v - σ₀ |v| z/g(v),   g(v) = τ_c + (τ_s - τ_c) exp(-(v/ω_s)²)

That is the friction (LuGre) of MuJoCo's `dcmotor`. Where the model's file leaves ω_s out, the peak
τ_s acts at no speed. Its gradient is then zero, and a search that asks no more ends where it began.
`estimate` refuses to begin, and names the parameter. With ω_s in the file it finds both levels.

Run it: python examples/silent_parameter.py
"""

from dataclasses import replace

import mujoco
import numpy as np

from identification import (
    Fit,
    InputError,
    Log,
    ModelPlant,
    Parameter,
    ParameterSet,
    Predictor,
    assess,
    estimate,
    fit_verdict,
)

MOTOR = """<mujoco model="motor">
  <option timestep="0.0005" gravity="0 0 0" integrator="RK4"/>
  <worldbody><body>
    <joint name="shaft" type="hinge" axis="0 0 1" damping="0.01"/>
    <inertial pos="0 0 0" mass="0.5" diaginertia="6e-4 6e-4 6e-4"/>
  </body></worldbody>
  <actuator>
    <dcmotor name="motor" joint="shaft" motorconst="0.05" resistance="1" lugre="{lugre}"/>
  </actuator>
  <sensor><jointpos name="angle" joint="shaft"/></sensor>
</mujoco>"""
COMPLETE = MOTOR.format(lugre="3 0.01 0.02 0.03 0.5")  # σ₀ σ₁ τ_c τ_s ω_s
WITHOUT_SPEED = MOTOR.format(lugre="3 0.01 0.02 0.03")
LEVELS = ParameterSet(
    "levels of friction",
    (
        Parameter(
            name="tau_c", value=0.02, unit="N m", where="actuator/motor.biasprm[3]", lower=0.0
        ),
        Parameter(
            name="tau_s", value=0.03, unit="N m", where="actuator/motor.biasprm[4]", lower=0.0
        ),
    ),
)
TRUTH = (0.015, 0.035)  # τ_c, τ_s of the motor that was recorded [N m]
NAMES = ("tau_c", "tau_s")


def plant(xml: str) -> ModelPlant:
    """The motor of a model file, with both levels free to move."""
    return ModelPlant(mujoco.MjModel.from_xml_string(xml), LEVELS)


def record(samples: int = 200, noise: float = 1e-4) -> Log:
    """A log of the complete motor: voltage [V] and angle [rad] at 100 Hz."""
    time = np.arange(samples) * 0.01
    voltage = np.sin(2 * np.pi * 0.5 * time) + np.sin(2 * np.pi * 1.3 * time)
    log = Log(
        time=time,
        inputs=voltage[:, None],
        outputs=np.zeros((samples, 1)),
        input_names=("motor",),
        output_names=("angle",),
        units={"angle": "rad"},
    )
    angle = Predictor(plant(COMPLETE), log, NAMES).predict(np.array([TRUTH]))[0]
    return replace(
        log, outputs=angle + noise * np.random.default_rng(0).standard_normal((samples, 1))
    )


def fitted(xml: str, log: Log) -> Fit:
    """Both levels from the log; an `InputError` where one of them has no effect."""
    return assess(estimate(plant(xml), log, NAMES))


if __name__ == "__main__":
    log = record()
    try:
        fitted(WITHOUT_SPEED, log)
    except InputError as error:
        print("without ω_s:", error)
    fit = fitted(COMPLETE, log)
    print("with ω_s:", {name: round(value, 5) for name, value in fit.estimate.values.items()})
    print(*fit_verdict(fit), sep="\n")
