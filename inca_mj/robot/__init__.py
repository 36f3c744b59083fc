"""The INCA 6D by its numbers: parameters, geometry, kinematics, the law of a cable drive."""
