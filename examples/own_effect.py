"""An effect of your own: one compiled function, one record; then ask whether a log needs it.

    Δτ = -c |φ| tanh(β ω)      INCA: the cable rubs on what is wound already
    b  = c |q|                 friction of any joint of any MJCF: the guide is tighter at its ends

Run it: python examples/own_effect.py
"""

from dataclasses import replace
from math import tanh

import numpy as np
from numba import njit

from identification import (
    Effect,
    Log,
    NominalModel,
    Parameter,
    Predictor,
    Size,
    candidates,
    discovery_text,
    joint_plant,
    places,
)
from identification import discover as discover_joints
from inca_mj import (
    CATALOGUE,
    DRIVES_EACH,
    build_twin,
    discover,
    make_input,
    run_to_log,
    simulate,
    spread_of,
)

# ----------------------------------------------------------------- of INCA's drives


@njit
def winding_friction(s, p):
    """Torque on a motor [N m]: s is what is known of its drive, p the effect's parameters."""
    return -p[0] * abs(s.phi) * tanh(s.beta * s.omega)


WINDING_FRICTION = Effect(
    "winding_friction",
    law="-c |φ| tanh(β ω)",
    sizes=(Size("c", "N m/rad", largest=2e-3, probe=1e-4, sign=1, about="growth per radian"),),
    places=DRIVES_EACH,  # on all drives alike, or on one
    phrase="friction: grows with what is wound",
    hooks={"torque": winding_friction},
)


def robot_with_it(c=5e-4):
    """A twin of which the law has the effect; its parameters are called after it."""
    return build_twin(effects=[WINDING_FRICTION]).with_values({"winding_friction.c": c})


def log_with_it(seconds=10.0, c=5e-4, noise=5e-4):
    """A log of that robot under the thesis' input, with noise on its encoders [rad]."""
    clean = run_to_log(simulate(robot_with_it(c), make_input("prbs", seconds)), "own effect")
    errors = noise * np.random.default_rng(0).standard_normal(clean.outputs.shape)
    seen = (*clean.input_names, *clean.output_names)
    units = {name: clean.units[name] for name in seen}
    return replace(clean, outputs=clean.outputs + errors, extras={}, units=units)


def find(log, effects=(*CATALOGUE, WINDING_FRICTION)):
    """What the nominal model lacks of a log of a robot whose drives are all alike."""
    return discover(log, effects=effects, spread=spread_of("none"))


# ----------------------------------------------------------------- of a joint of any MJCF

SLIDER = """<mujoco model="slider">
  <option timestep="0.002" gravity="0 0 0" integrator="RK4"/>
  <worldbody><body name="cart"><inertial pos="0 0 0" mass="2" diaginertia="1 1 1"/>
    <joint name="slide" type="slide" axis="1 0 0" damping="3" stiffness="20"/>
  </body></worldbody>
  <actuator><general name="force" joint="slide" gear="5"/></actuator>
  <sensor><jointpos name="position" joint="slide"/></sensor>
</mujoco>"""
MASS = Parameter(name="mass", value=2.0, unit="kg", where="body/cart.mass", lower=0.0, upper=100.0)
DAMPING = Parameter(
    name="damping", value=3.0, unit="N s/m", where="joint/slide.damping", lower=0.0, upper=100.0
)


@njit
def guide_friction(s, p):
    """Largest friction on a joint [N]: s is what is known of it, p the effect's parameters."""
    return p[0] * abs(s.q)


GUIDE_FRICTION = Effect(
    "guide_friction",
    law="at most c |q|, against the motion",
    sizes=(Size("c", "N/m", largest=5.0, probe=0.05, sign=1, about="growth along the way"),),
    places=places("joint", ("slide",)),
    phrase="friction: grows towards the ends",
    hooks={"friction": guide_friction},
)


def slider_log(samples=1200, c=1.0, noise=5e-4, step=0.01):
    """A log of a slider that has the effect, with noise on its position [m]."""
    rng, time = np.random.default_rng(0), np.arange(samples) * step
    u = np.repeat(rng.choice([-1.0, 1.0], samples // 20 + 1), 20)[:samples, None]
    moved = 0.5 * np.sin(time)[:, None]  # shows how far the joint moves, before there is a log
    log = Log(
        time=time,
        inputs=u,
        outputs=moved,
        input_names=("force",),
        output_names=("position",),
        units={"position": "m"},
    )
    plant = slider(log)
    y = Predictor(plant, log, ("guide_friction.c@slide",)).predict(np.array([[c]]))[0]
    return replace(log, outputs=y + noise * rng.standard_normal(y.shape))


def slider(log):
    """The slider with the own effect beside the catalogue's."""
    return joint_plant(SLIDER, (MASS, DAMPING), log, own_effects=[GUIDE_FRICTION])


def find_on_slider(log):
    """What the nominal slider lacks of a log, the own effect among the candidates."""
    plant, free = slider(log), ("mass", "damping")
    nominal_model = NominalModel(plant, free, np.array([0.3, 0.3]))
    return discover_joints(nominal_model, log, candidates(plant, free))


if __name__ == "__main__":
    print(discovery_text(find_on_slider(slider_log())))
    print(discovery_text(find(log_with_it())))
