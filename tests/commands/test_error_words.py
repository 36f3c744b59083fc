"""What a message lists: all good names, or the nearest of very many."""

from identification.errors import LISTED, NEAREST, unknown_name


def test_all_good_names_are_listed_and_the_likely_one_is_first():
    said = str(unknown_name("unit", "amp", ["volt", "ampere", "metre"]))
    assert said == "unknown unit 'amp'; did you mean 'ampere'? known: ampere, metre, volt"


def test_of_very_many_names_the_nearest_are_listed():
    names = [f"joint_{k}.damping" for k in range(LISTED)]
    assert str(unknown_name("parameter", "nothing", names)).count("joint_") == LISTED
    many = [*names, "mass"]
    said = str(unknown_name("parameter", "joint_7.damp", many))
    assert "did you mean 'joint_7.damping'? known: " in said
    assert said.endswith(f" and {len(many) - NEAREST} more")
    listed = said.partition("known: ")[2].partition(" and ")[0].split(", ")
    assert len(listed) == NEAREST
    assert listed == sorted(listed)
    assert "joint_7.damping" in listed
