"""What is refused on a board before it is run, by name, and laws that stand in files."""

from __future__ import annotations

import tomllib

import pytest

import puck_tables as pt
from puck_tables.scene.library import as_toml
from puck_tables.scene.restitution import restitution_law

PUCK = pt.Puck(0.03, friction=0.1, name="puck", launch=pt.Launch((1.0, 0.0)))
OTHER = pt.Puck(0.03, friction=0.1, name="other", launch=pt.Launch(position=(0.3, 0.0)))


def mallet(*rows: tuple[float, float, float]) -> pt.Puck:
    return pt.Puck(0.05, name="mallet", path=rows)


@pytest.mark.parametrize(("place", "words"), [
    ({"posts": [pt.Post((0.5, 0.52), 0.02)]},
     r"post\[0\]: mallet is driven through it between 1 s and 2 s, 0.05 m deep"),
    ({"walls": [pt.Wall((0.9, 0.0), normal=(-1.0, 0.0))]},
     r"wall\[0\]: mallet is driven through it between 1 s and 2 s, 0.15 m deep"),
    ({"arcs": [pt.Arc((0.0, 0.5), 0.9)]}, r"arc\[0\]: mallet is driven through it"),
])  # fmt: skip
def test_a_path_through_what_stands_is_refused_by_name(place: dict, words: str):
    driven = mallet((0.0, 0.0, 0.5), (1.0, 0.0, 0.5), (2.0, 1.0, 0.5))
    with pytest.raises(pt.InputError, match=words):
        pt.Scene(pucks=[PUCK, driven], **place)


def test_a_path_that_touches_is_none():
    wall, post = pt.Wall((1.05, 0.0), normal=(-1.0, 0.0)), pt.Post((0.5, 0.57), 0.02)
    driven = mallet((0.0, 0.0, 0.5), (2.0, 1.0, 0.5))
    assert pt.Scene(pucks=[PUCK, driven], walls=[wall], posts=[post]).pucks[1].path


def test_a_rim_that_says_nothing_is_refused():
    with pytest.raises(pt.InputError, match=r"rim\[0\]: says nothing"):
        pt.Scene(pucks=[PUCK, OTHER], rims=[pt.Rim("puck", "other")])


@pytest.mark.parametrize(("hits", "who"), [("puck", "the striker"), ("other", "the puck that")])
def test_a_puck_that_is_to_hit_itself_is_refused(hits: str, who: str):
    with pytest.raises(pt.InputError, match=f"hits = {hits}: this is {who}"):
        pt.Scene(pucks=[PUCK, OTHER]).aim((0.5, 0.0), puck="other", hits=hits)


def test_a_table_of_restitution_made_in_python_stands_in_a_file():
    law = pt.RestitutionTable([0.0, 1.0, 3.0], [0.9, 0.8, 1.0 / 3.0])
    scene = pt.Scene(pucks=[pt.Puck(0.03, friction=0.1, restitution=law), OTHER])
    again = pt.Scene.from_tables(tomllib.loads(as_toml(scene)))
    assert again.pucks[0].restitution == law.name
    assert restitution_law(again.pucks[0].restitution) == law


def test_points_that_are_none_are_refused():
    with pytest.raises(pt.InputError, match="must be speeds, m/s, and restitutions"):
        pt.Scene(pucks=[PUCK, pt.Puck(0.03, restitution="table:0.9")])


@pytest.mark.parametrize(("more", "words"), [
    ({"floor": pt.Floor(turning=1.0), "time": 1.0}, "not for a moving floor"),
    ({"pucks": [pt.Puck(0.03, friction=0.1, constraint=pt.Constraint("rail"), name="led",
                         launch=pt.Launch((1.0, 0.0))), OTHER]}, "striker led is led by a rail"),
])  # fmt: skip
def test_aim_is_not_for_what_is_carried_or_led(more: dict, words: str):
    with pytest.raises(pt.InputError, match=words):
        pt.Scene(**{"pucks": [PUCK, OTHER], **more}).aim((0.5, 0.0), puck="other")
