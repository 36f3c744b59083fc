"""Linear models of a MuJoCo plant: at an operating point, minimal, in modes, and over a grid."""
