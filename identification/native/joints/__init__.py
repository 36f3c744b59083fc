"""Laws of joints as machine code: what a joint's effects see, friction, gears, states."""
