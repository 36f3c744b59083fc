"""Models and systems whose linear models are known on paper."""

import mujoco
import numpy as np

from identification.linear.operating_points import OperatingPoints
from identification.linear.system import LinearSystem

MASS, SPRING, DAMPER, GEAR = 2.0, 50.0, 3.0, 5.0
OSCILLATOR = f"""<mujoco><option timestep="0.001" gravity="0 0 0" integrator="RK4"/>
  <worldbody><body name="cart"><inertial pos="0 0 0" mass="{MASS}" diaginertia="1 1 1"/>
    <joint name="slide" type="slide" axis="1 0 0" damping="{DAMPER}" stiffness="{SPRING}"/>
  </body></worldbody>
  <actuator><general name="force" joint="slide" gear="{GEAR}"/></actuator>
  <sensor><jointpos name="position" joint="slide"/>
    <actuatorfrc name="pull" actuator="force"/></sensor></mujoco>"""
PENDULUM = """<mujoco><option timestep="0.001" integrator="RK4"/>
  <worldbody><body name="bob"><joint name="swing" axis="0 1 0" damping="0.1"/>
    <inertial pos="0 0 -0.5" mass="0.5" diaginertia="0.01 0.01 0.01"/></body></worldbody>
  <actuator><motor name="torque" joint="swing"/></actuator>
  <sensor><jointpos name="angle" joint="swing"/></sensor></mujoco>"""
INERTIA = (0.02, 0.05, 0.06)
SATELLITE = f"""<mujoco><option timestep="0.001" gravity="0 0 0" integrator="RK4"/>
  <worldbody><body name="satellite"><freejoint name="free"/>
    <inertial pos="0 0 0" mass="1" diaginertia="{INERTIA[0]} {INERTIA[1]} {INERTIA[2]}"/>
    <site name="here"/></body></worldbody>
  <sensor><gyro name="gyro" site="here"/></sensor></mujoco>"""


def compiled(xml: str) -> mujoco.MjModel:
    return mujoco.MjModel.from_xml_string(xml)


def point(model, qpos, qvel=None, inputs=None) -> OperatingPoints:
    return OperatingPoints(
        model=model,
        qpos=np.array([qpos], float),
        qvel=np.zeros((1, model.nv)) if qvel is None else np.array([qvel], float),
        act=np.zeros((1, model.na)),
        inputs=np.zeros((1, model.nu)) if inputs is None else np.array([inputs], float),
        time=np.zeros(1),
    )


def system(A, B, C, D=None) -> LinearSystem:
    n, m, p = len(A), B.shape[1], C.shape[0]
    return LinearSystem(
        A=A, B=B, C=C, D=np.zeros((p, m)) if D is None else D,
        states=tuple(f"x{k}" for k in range(n)), inputs=tuple(f"u{k}" for k in range(m)),
        outputs=tuple(f"y{k}" for k in range(p)), x=np.zeros(n), u=np.zeros(m), y=np.zeros(p),
        rate=np.zeros(n),
    )  # fmt: skip


def random_system(seed, n=6, m=2, p=2) -> LinearSystem:
    """A minimal system, with probability one, some of it unstable."""
    rng = np.random.default_rng(seed)
    return system(rng.normal(size=(n, n)), rng.normal(size=(n, m)), rng.normal(size=(p, n)),
                  rng.normal(size=(p, m)))  # fmt: skip


def padded(small: LinearSystem, unreached: int, unfelt: int, seed: int) -> LinearSystem:
    """A system with further states that no input reaches or no output feels, mixed at random.

    The scales of the states differ by six decades.
    """
    rng = np.random.default_rng(seed)
    n, r, f = len(small.A), unreached, unfelt
    A = np.zeros((n + r + f, n + r + f))
    A[:n, :n] = small.A
    A[:n, n : n + r] = rng.normal(size=(n, r))  # what nobody reaches acts on the rest
    A[n : n + r, n : n + r] = rng.normal(size=(r, r))
    A[n + r :] = rng.normal(size=(f, n + r + f))  # what nobody feels is acted on
    B = np.vstack([small.B, np.zeros((r, small.B.shape[1])), rng.normal(size=(f, 2))])
    C = np.hstack([small.C, rng.normal(size=(small.C.shape[0], r)), np.zeros((2, f))])
    Q = np.linalg.qr(rng.normal(size=A.shape))[0] * 10.0 ** rng.uniform(-3, 3, len(A))
    return system(np.linalg.inv(Q) @ A @ Q, np.linalg.inv(Q) @ B, C @ Q, small.D)
