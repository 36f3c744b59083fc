"""A log by its columns alone."""

import mujoco
import numpy as np

from identification import Log


def plain_log(u, y, inputs, outputs, step=0.01, **more):
    """A log from t = 0 on; its names stand in one text, with blanks between them, or in a tuple."""
    names = [text.split() if isinstance(text, str) else text for text in (inputs, outputs)]
    more = {"time": step * np.arange(len(u)), **more}
    return Log(inputs=u, outputs=y, input_names=names[0], output_names=names[1], **more)


def model_log(model, u, y, step=0.01, **more):
    """A log of the actuators and sensors of a model, under their names."""
    inputs = [model.actuator(i).name for i in range(model.nu)]
    outputs = [model.sensor(i).name for i in range(model.nsensor)]
    return plain_log(u, y, inputs, outputs, step, **more)


def stepped(model, u, start=0.0, step=0.01):
    """Positions (n, nq) of a model under inputs (n, nu) that are held, by MuJoCo's own steps."""
    data, y = mujoco.MjData(model), np.zeros((len(u), model.nq))
    data.qpos[:] = start
    for k in range(len(u)):
        y[k], data.ctrl[:] = data.qpos, u[k]
        mujoco.mj_step(model, data, round(step / model.opt.timestep))
    return y


def noise(shape, size, seed=0):
    """White noise of a std."""
    return size * np.random.default_rng(seed).standard_normal(shape)
