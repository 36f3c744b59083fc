"""Laws whose work a curve of the data does, which was found later at the same joint.

    m: mean square of the fitted windows      m_1 - m_2: what the law explained when it was found
                                              m_3 - m_4: what it explains beside the curve

A cause that is in no catalogue is first explained by its nearest neighbour, as well as that can,
and then a curve draws what is left. The two together are one unlisted force, and no name: the curve
alone does what the law did. Where m_3 - m_4 is less than `OWN_SHARE` of m_1 - m_2, the law
is told and not named. A law whose cause is another one than the curve's explains as much as before.
"""

from __future__ import annotations

from dataclasses import replace

from identification.prediction.extension import refitted
from identification.prediction.forced import acts_on_joints
from identification.prediction.screening import places_of
from identification.prediction.task import Change, WindowSearch
from identification.prediction.trial import OWN_SHARE
from identification.progress import Progress


def drop_drawn_laws(state: WindowSearch, progress: Progress) -> Change:
    """Returns the state's model without laws that a later curve at their joint makes needless."""
    model, accepted, task = state.model, state.accepted, state.task
    kept, lost = [*accepted], []
    for k, law in enumerate(accepted):
        curves = [c.candidate for c in accepted[k + 1 :] if c.candidate.effect.is_curve]
        drawn = {place for c in curves for place in places_of(c.where)}
        effect, mine = law.candidate.effect, {*places_of(law.candidate.where)}
        if effect.is_curve or not mine <= drawn or not acts_on_joints(effect):
            continue
        rest = [c for c in model.candidates if c.key != law.candidate.key]
        without = refitted(model, rest, task.nominal_model, task.confirm)
        if without is None:
            continue
        beside = without.fitted_power - model.fitted_power
        if beside < OWN_SHARE * law.explained:
            progress(f"{effect.name}, {law.candidate.where}: a curve does the same, and more")
            model, kept = without, [a for a in kept if a is not law]
            lost.append(replace(law, doubt="drawn"))
    return model, tuple(kept), tuple(lost)
