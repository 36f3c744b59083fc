import mujoco
import numpy as np
import pytest

from identification.errors import GraphicsError
from inca_mj.rendering.graphics import renderer
from inca_mj.robot.inputs import make_input
from inca_mj.twin.run import simulate
from inca_mj.twin.twin import build_twin


@pytest.fixture(scope="session")
def opengl():
    try:
        with renderer(mujoco.MjModel.from_xml_string("<mujoco/>"), 8, 8):
            return
    except GraphicsError as error:
        pytest.skip(f"this machine cannot draw: {error}")


@pytest.fixture(scope="session")
def short_run():
    return simulate(build_twin(), make_input("prbs", 1.0))


@pytest.fixture(scope="session")
def pulled_run():
    return simulate(build_twin(), np.tile([2.0] + 7 * [0.0], (61, 1)))
