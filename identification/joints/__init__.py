"""Effects that a hinge or slide joint of any MJCF may have, and a plant that has them.

Names: `axes` says what a log shows of each joint, `catalogue` lists what it may lack, `joint_plant`
compiles a model that can have it, and `candidates` is what `discover` is then given.
"""
