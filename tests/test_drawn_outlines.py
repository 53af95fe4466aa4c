"""Outlines that are drawn: bases with holes, closed walls and patches from SVG files."""

from __future__ import annotations

import math

import numpy as np
import pytest

import puck_tables as pt
from puck_tables._core.drawn_outlines import outlines_of
from puck_tables.contact.named_base import base_of

pytest.importorskip("svgelements")
PAGE = '<svg xmlns="http://www.w3.org/2000/svg" width="20cm" height="100mm" viewBox="0 0 400 200">'
BOX = '<g transform="translate(10,20)"><rect x="10" y="0" width="200" height="100"/></g>'


@pytest.fixture
def drawn(tmp_path):
    """Write what is drawn on a page of 20 cm by 10 cm, 0.5 mm a unit; its path."""

    def write(shapes: str, page: str = PAGE) -> str:
        file = tmp_path / f"{len(list(tmp_path.iterdir()))}.svg"
        file.write_text(f"{page}{shapes}</svg>")
        return str(file)

    return write


def test_a_box_with_a_hole_is_drawn(drawn, capsys):
    """It lies on the page from (10, 40) to (110, 90) mm, its hole from (20, 60) to (40, 70)."""
    hole = '<path d="M 40,60 v 20 h 40 v -20 z"/>'
    base = base_of(drawn(hole + BOX))
    told = [[(0.01, 0.04), (0.11, 0.04), (0.11, 0.09), (0.01, 0.09)],
            [(0.02, 0.06), (0.04, 0.06), (0.04, 0.07), (0.02, 0.07)]]  # fmt: skip
    other = pt.Base.polygon(told[0], holes=[told[1]])
    assert capsys.readouterr().err == ""
    for name in ("area", "middle", "gyration", "reach"):
        assert getattr(base, name) == pytest.approx(getattr(other, name), rel=1e-12)


def test_a_circle_is_chords_that_are_off_by_as_much_as_is_said(drawn, capsys):
    (rows,) = outlines_of(drawn('<circle cx="200" cy="100" r="80"/>'))
    assert "off by at most 0.0001 of its size" in capsys.readouterr().err
    middles = 0.5 * (rows + np.roll(rows, 1, axis=0)) - [0.1, 0.05]
    assert np.hypot(*(rows - [0.1, 0.05]).T) == pytest.approx(0.04, rel=1e-9)
    off = 0.04 - np.hypot(*middles.T)
    assert 0.3e-4 < off.max() / math.hypot(0.08, 0.08) <= 1e-4


def test_curves_that_turn_in_their_middle_are_followed(drawn):
    """A chord from end to end meets it there: that is no sign that it follows it."""
    (rows,) = outlines_of(drawn('<path d="M 0,200 C 200,0 200,400 400,200 L 200,-200 z"/>'))
    t = np.linspace(0.0, 1.0, 2001)[:, None]
    p, q, r, s = np.array([[0.0, 0.0], [0.1, 0.1], [0.1, -0.1], [0.2, 0.0]])
    true = (1 - t) ** 3 * p + 3 * t * (1 - t) ** 2 * q + 3 * t * t * (1 - t) * r + t**3 * s
    wave = rows[rows[:, 1] < 0.05]
    assert len(wave) > 20
    starts, sides = wave[:-1], np.diff(wave, axis=0)
    share = ((true[:, None] - starts) * sides).sum(axis=2) / (sides**2).sum(axis=1)
    nearest = starts + np.clip(share, 0.0, 1.0)[..., None] * sides
    off = np.hypot(*(true[:, None] - nearest).transpose(2, 0, 1)).min(axis=1)
    assert 1e-7 < off.max() < 1e-4 * 0.25


def test_an_island_on_a_board_and_a_patch_are_drawn(drawn):
    corners = [[0.01, 0.04], [0.11, 0.04], [0.11, 0.09], [0.01, 0.09]]
    puck = pt.Puck(0.02, friction=0.1, launch=pt.Launch((1.0, 0.3), position=(-0.2, 0.0)))
    runs = []
    for given in (drawn(BOX), corners):
        wall, patch = pt.Wall(corners=given, restitution=0.6), pt.Patch(0.05, corners=given)
        island = pt.Scene(pucks=[puck], walls=[wall]).simulate()
        assert any(event.what == "impact" for event in island.events)
        floor = pt.Scene(pucks=[puck], floor=pt.Floor(patches=[patch])).simulate()
        assert len(floor.events) > 1
        runs.append([event.time for run in (island, floor) for event in run.events])
    assert np.abs(np.subtract(*runs)).max() < 0.1 * floor.end_error  # corners are rounded


@pytest.mark.parametrize(
    ("shapes", "page", "said"),
    [
        ("", PAGE, "nothing is drawn"),
        ('<path d="M 0,0 L 1,1 L 0,1"/>', PAGE, "is not closed"),
        ('<path d="M 1,1 z"/>', PAGE, "goes round nothing"),
        ('<path d="M 0,0 L nan,10 L 10,0 z"/>', PAGE, "goes round nothing"),
        (BOX, PAGE.replace("20cm", "400"), "the page has no size"),
        (BOX, PAGE.replace(' height="100mm"', ""), "the page has no size"),
        (BOX, PAGE.replace("20cm", "20parsec"), "width must be a number"),
        ("<g>", PAGE, "damaged SVG file"),
    ],
)  # fmt: skip
def test_what_is_no_outline_is_refused_in_a_sentence(drawn, shapes, page, said):
    with pytest.raises(pt.InputError, match=said):
        base_of(drawn(shapes, page))


def test_several_islands_in_one_file_are_refused(drawn):
    two = drawn(BOX + '<circle cx="300" cy="50" r="20"/>')
    with pytest.raises(pt.InputError, match="2 outlines: leave one"):
        pt.Scene(pt.Puck(0.02, friction=0.1), walls=[pt.Wall(corners=two)]).simulate()
    with pytest.raises(pt.InputError, match="a hole must lie in the outline"):
        base_of(two)


def square(x: float, y: float, side: float) -> list[tuple[float, float]]:
    return [(x, y), (x + side, y), (x + side, y + side), (x, y + side)]


@pytest.mark.parametrize("other", [square(0.3, 0.3, 0.1), square(0.4, 0.4, 0.3)])
def test_holes_that_overlap_or_lie_in_each_other_are_refused(other):
    """What both leave out would be left out twice."""
    with pytest.raises(pt.InputError, match="two holes overlap, touch, or one lies in the other"):
        pt.Base.polygon(square(0.0, 0.0, 1.0), holes=[square(0.2, 0.2, 0.3), other])
