import numpy as np

from inca_mj.rendering.legend import SLACK, tension_scale


def test_colour_follows_tension_and_slack_is_grey():
    scale = tension_scale(np.array([[0.0, 3.2, 9.7]]))
    assert (scale.low, scale.high) == (3.0, 10.0)
    colours = scale(np.array([-1.0, 0.0, 3.2, 6.0, 9.7]))
    np.testing.assert_array_equal(colours[:2], [SLACK, SLACK])
    lightness = colours[2:, :3] @ [0.2126, 0.7152, 0.0722]
    assert (np.diff(lightness) > 0.05).all()


def test_every_run_has_a_scale():
    for tension in (np.zeros((3, 8)), np.full((3, 8), 4.0)):
        scale = tension_scale(tension)
        assert scale.high > scale.low
        assert np.isfinite(scale(tension[0])).all()
