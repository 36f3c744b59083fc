"""Two models of one robot that share no physics code must agree: the twin and the reference ODE.

They share the parameters and the geometry only. What is compared: accelerations at random
states (`derivatives`), and trajectories at several steps of the twin (`trajectories`).
"""
