"""Hidden worlds: logs of a robot with known effects, to test a discovery that does not know them.

The reference's equations with effects of their own, an integrator of their own, and noise; no
physics code is shared with the MuJoCo twin.
"""

from inca_mj.studies.worlds.catalogue import ALL_EFFECTS as ALL_EFFECTS
from inca_mj.studies.worlds.catalogue import CHANGES as CHANGES
from inca_mj.studies.worlds.catalogue import FAULTS as FAULTS
from inca_mj.studies.worlds.catalogue import HIDDEN_EFFECTS as HIDDEN_EFFECTS
from inca_mj.studies.worlds.catalogue import SHAPES as SHAPES
from inca_mj.studies.worlds.catalogue import UNLISTED as UNLISTED
from inca_mj.studies.worlds.catalogue import draw_effect as draw_effect
from inca_mj.studies.worlds.catalogue import effect as effect
from inca_mj.studies.worlds.effect import HiddenEffect as HiddenEffect
from inca_mj.studies.worlds.plant import HiddenPlant as HiddenPlant
from inca_mj.studies.worlds.plant import make_plant as make_plant
from inca_mj.studies.worlds.plant import simulate_world as simulate_world
from inca_mj.studies.worlds.setting import EVERY as EVERY
from inca_mj.studies.worlds.setting import VARIED as VARIED
from inca_mj.studies.worlds.setting import HiddenSetting as HiddenSetting
from inca_mj.studies.worlds.setting import make_currents as make_currents
from inca_mj.studies.worlds.tolerances import AS_BUILT as AS_BUILT
from inca_mj.studies.worlds.tolerances import EXACT as EXACT
from inca_mj.studies.worlds.tolerances import Tolerances as Tolerances
from inca_mj.studies.worlds.world import HiddenTruth as HiddenTruth
from inca_mj.studies.worlds.world import HiddenWorld as HiddenWorld
from inca_mj.studies.worlds.world import records as records
from inca_mj.studies.worlds.world import world as world
