"""The beginning of a free run, estimated together with the parameters where the log tells it.

    x̂_0 = x̄_0 + δ,   δ ~ N(0, (W s)²)        x̄_0, s: parabola through the first samples; W = `WIDE`

A simulation begins where its log does, and the log knows this as well as a few noisy samples do. A
swing that begins 0.35 mrad or 3 mrad/s off keeps this error as long as it swings: the fit answers
with another damping, and what is left looks like an effect. Positions and rates of measured joints
are therefore free beside the parameters, as the states of windows are. They are of one log alone,
so that they are no values of the robot: the std of these contain them.

Where the log begins where the model rests, within noise, the model's start stands, and nothing of
it is free. So do entries that the robot's file gives, and the starts of models with equalities,
where one joint cannot begin elsewhere alone.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from identification.effects.plant.joint_plant import JointPlant
from identification.logs.noise import noise_floor
from identification.model.parameter import Parameter, ParameterSet
from identification.model.plant import start_place
from identification.robot.file.model_file import unit_of
from identification.robot.file.parameters import motion_of_start
from identification.robot.file.start import measured_begin, moved_begin
from identification.robot.robot import Robot

# Std of the prior over that of the parabola. The fit sees the same samples again, which so count by
# a hundredth more, and a parabola that is no good one may be off by several of its std.
WIDE = 10.0


def with_free_beginning(robot: Robot) -> tuple[JointPlant, Mapping[str, float]]:
    """Returns a robot's plant with entries of its start as parameters, and std of their priors.

    The std are by name, in the coordinates of a search; there are none where the model's start
    stands.

    Args:
        robot: whose free run is fitted.
    """
    file, log = robot.file, robot.log
    plant, model = robot.plant.with_values(log.values), robot.plant.model
    if model.neq or not moved_begin(file, model, log):
        return plant, {}
    written = [path for p in plant.parameters for path, _ in p.places]
    taken = {start_place(path, model) for path in (*file.start, *written)}
    noise = dict(zip(log.output_names, noise_floor(log.outputs), strict=True))
    free, std = [], {}
    for place, begin in measured_begin(model, log).items():
        if place in taken or not noise[begin.output] > 0:
            continue
        name = f"{place[0]}[{place[1]}]"
        width = WIDE * begin.std
        scale = max(width, motion_of_start(model, place, log))
        value = float(np.atleast_1d(getattr(plant.bare.start, place[0]))[place[1]])
        free.append(Parameter(name=name, where=name, unit=unit_of(model, name), value=value,
                              scale=scale))  # fmt: skip
        std[name] = width / scale
    bare, every = (
        ParameterSet(known.name, (*known.records, *free))
        for known in (plant.bare.parameters, plant.parameters)
    )
    return replace(plant, bare=replace(plant.bare, parameters=bare), parameters=every), std
