"""Worlds of a pendulum, a cart, a two-link arm and a six-joint arm, for logs whose truth is known.

Everything here is written a second time: dynamics, integrator, friction, effects, controllers and
sensors share no code with `identification` but what compiles them, and none with MuJoCo. Coloured
noise is that of the hidden worlds of INCA. Only the file formats (MJCF, TOML, CSV) and the names of
effects are those of the project.
"""
