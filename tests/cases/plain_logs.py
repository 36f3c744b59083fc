"""A log by its columns alone."""

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
