"""What a fit refuses, it refuses in a sentence that says what to do."""

from __future__ import annotations

import math
import re

import film_judge
import numpy as np
import pytest
from rarely import thorough

import puck_tables as pt
from puck_tables.film.film import marks_of_one
from puck_tables.fitting.estimate import estimate
from puck_tables.fitting.numbers import Number

TIMES = np.arange(60) / 60.0
PATH = film_judge.path((1.0, 0.2), 30.0, 0.2 * film_judge.G, 0.2, 0.04, TIMES)
NOISE = 3e-4 * np.random.default_rng(0).normal(size=(60, 2))
PLACE = PATH[:2].T + NOISE
TRACK = pt.Track(TIMES, PLACE, PATH[2] + 3.0 * NOISE[:, 0], "film")
PUCK = pt.Puck(radius=0.04)


@pytest.mark.parametrize(
    ("how", "words"),
    [
        ({"free": ["frictoin"]}, "did you mean 'friction'"),
        ({"free": ["friction", "friction"]}, "once"),
        ({"free": ["friction", "decel"]}, "say the same"),
        ({"free": ["delta", "height", "friction"]}, "say the same"),
        ({"free": ["delta"], "fixed": {"decel": 2.0, "friction": 0.2}}, "say the same"),
        ({"free": ["delta"]}, "neither free nor known"),
        ({"free": ["friction", "inner"]}, "annulus"),
        ({"free": ["friction"], "fixed": {"friction": 0.2}}, "both free and fixed"),
        ({"fixed": {"friction": 0.0}}, "greater than 0"),
        ({"fixed": {"friction": math.nan}}, "finite"),
        ({"fixed": {"launch_spni": 0.0}}, "launch_spin"),
        ({"fixed": {"delta": 0.1}, "prior": {"delta": (0.1, 0.1)}}, "fixed"),
        ({"prior": {"friction": (0.2, 0.0)}}, "standard deviation"),
        ({"prior": {"friction": 0.2}}, "standard deviation"),
        ({"bounds": {"friction": (0.3, 0.2)}}, "ascend"),
        ({"bounds": {"friction": (-1.0, -0.5)}}, "friction is greater than 0"),
        ({"bounds": {"delta": (5.0, 9.0)}}, "delta is from 0 to 4"),
        ({"bounds": {"decel": (-2.0, 0.0)}}, "decel is greater than 0 (m/s^2)"),
        ({"start": {"gyration": 0.7}}, "not free"),
        ({"start": {"friction": 0.1}, "bounds": {"friction": (0.4, 0.5)}}, "outside its bounds"),
        ({"noise": 3e-4}, "and of angles"),
        ({"noise": (0.0, 1e-3)}, "greater than 0"),
        ({"since": 5.0}, "0 frames in the time asked for"),
        ({"hold_out": 0.99}, "share"),
        ({"hold_out": "other"}, "the tracks are film"),
        ({"laws": ["unifrom"]}, "unifrom"),
        ({"laws": "uniform"}, "list"),
        ({"laws": ["ring", "ring"]}, "once"),
        ({"jitter": 0.0}, "jitter must be greater than 0"),
        ({"jitter": "guess"}, "'find'"),
        ({"law": "stribeck", "slip_speeds": (0.0, 1.0)}, "law and slip_speeds both"),
        ({"rows": (0.1, 0.1)}, "different places"),
        ({"rows": 0.5}, "first and of the last line"),
        ({"fixed": {"readout": 0.01}}, "rows="),
        ({"free": ["friction", "restitution"]}, "impacts=True"),
        ({"fixed": {"mass_ratio": 2.0}}, "impacts=True"),
        ({"walls": [(0.0, 1.0)]}, "two points"),
        ({"walls": [((0.0, 1.0), (0.0, 1.0))]}, "different points"),
        ({"walls": "left"}, "list"),
    ],
)
def test_questions_are_refused_before_anything_is_fitted(how, words, monkeypatch):
    monkeypatch.setattr("puck_tables.fitting.fit_tracks.initial_estimate", None)
    with pytest.raises(pt.InputError, match=re.escape(words)):
        pt.fit(TRACK, PUCK, **how)


@pytest.mark.parametrize(
    ("tracks", "words"),
    [
        ([], "no track"),
        (TIMES, "tracks must be"),
        (
            pt.Track([0.0, 1.0], [[0.0, 0.0], [1.0, 0.0]], name="two"),
            "two shows the puck in 2 frames:",
        ),
        (pt.Track(TIMES[:5], PLACE[:5], name="few"), "too few to judge their noise"),
        (pt.Track(TIMES, NOISE, 0.0 * TIMES, "flat"), "flat lies still"),
        (pt.Track(TIMES, 1e200 * PLACE, name="far"), "far: its places lie up to"),
        (pt.Track(1e200 * TIMES, PLACE, name="long"), "long: its times lie up to"),
    ],
)
def test_tracks_are_refused(tracks, words):
    with pytest.raises(pt.InputError, match=re.escape(words)):
        pt.fit(tracks, PUCK)


def test_heights_that_tip_are_refused_before_anything_is_fitted(monkeypatch):
    monkeypatch.setattr("puck_tables.fitting.fit_tracks.initial_estimate", None)
    with pytest.raises(pt.InputError, match="tip over"):
        pt.fit(TRACK, pt.Puck(radius=0.04, height=1e9))


def test_what_moves_a_puck_besides_friction_is_of_scenes():
    with pytest.raises(pt.InputError, match="this puck has a force, which acts in a scene alone"):
        pt.fit(TRACK, pt.Puck(radius=0.04, force=pt.Force((0.0, 0.1))))


@pytest.mark.parametrize("radius", [1e-300, 1e300])
def test_radii_of_no_puck_on_a_film_are_refused(radius):
    with pytest.raises(pt.InputError, match="radius of a puck on a film"):
        pt.fit(TRACK, pt.Puck(radius=radius))


def test_a_friction_of_no_surface_is_remarked():
    found = pt.fit(pt.Track(TIMES, 1e3 * PLACE), PUCK, fixed={"delta": 0.2})
    assert any("the unit of the places" in text for text in found.remarks)


def test_times_that_are_a_thousand_times_too_long_are_no_end_of_a_range():
    found = pt.fit(pt.Track(1e3 * TIMES, PLACE, TRACK.angle), PUCK)
    assert 0.0 < found["friction"].error < 1e-3 * found["friction"].value
    remark = found.remarks[0]
    assert "less than dry surfaces have" in remark and "the times" in remark


def test_advice_is_within_reason():
    straight = pt.Puck(radius=0.04, height=0.02, friction=0.2).states((1.0, 0.2), 0.0, TIMES)
    place = np.stack([straight.x, straight.y], axis=1) + NOISE
    for scale, said in ((1.0, True), (1e6, False)):
        found = pt.fit(pt.Track(TIMES, scale * place, 0.0 * TIMES), PUCK)
        assert any("more spin" in text for text in found.blind) is said


def test_a_puck_that_wobbles_lies_still():
    place = np.stack([1e-4 * np.sin(17.0 * TIMES), 0.0 * TIMES], axis=1)
    with pytest.raises(pt.InputError, match="wobbly lies still"):
        pt.fit(pt.Track(TIMES, place, name="wobbly"), PUCK)


def test_a_tilt_that_is_computed_to_be_none_is_shown_as_0():
    one = Number(3.5e-21, math.nan, 0.0, 0.01, "1", "found")
    assert (one.shown, one._replace(value=-1e-30).shown) == ("0", "0")
    assert one._replace(value=0.16).shown == "0.16"


def test_a_number_that_a_prior_frees_is_named():
    found = pt.fit(TRACK, PUCK, prior={"radius": (0.04, 1e-4)})
    assert "radius is found, too" in found.remarks[0]
    asked = pt.fit(TRACK, PUCK, prior={"friction": (0.2, 0.1)})
    assert not any("is found, too" in text for text in asked.remarks)


def test_a_number_on_its_bound_is_named():
    found = pt.fit(TRACK, PUCK, fixed={"delta": 0.2}, bounds={"friction": (0.3, 0.5)})
    assert any("friction lies on the end of its range, 0.3" in text for text in found.remarks)


@pytest.mark.thorough
@pytest.mark.parametrize("bounds", [(3.0, 9.0), (1.0, 2.0)])
def test_bounds_of_a_base_that_lifts_hold_the_start(bounds):
    found = pt.fit(TRACK, PUCK, bounds={"delta": bounds})["delta"]
    assert found.value == pytest.approx(bounds[0], abs=1e-3) and found.at_bound


@pytest.mark.thorough
def test_a_puck_whose_base_lifts_is_found_within_bounds():
    path = pt.Puck(radius=0.04, height=0.16, friction=0.2).states((1.0, 0.2), 30.0, TIMES)
    place = np.stack([path.x, path.y], axis=1) + NOISE
    found = pt.fit(pt.Track(TIMES, place, path.orientation), PUCK, bounds={"delta": (1.3, 3.0)})
    assert found["delta"].value == pytest.approx(1.6, abs=4.5 * found["delta"].error)


@pytest.mark.parametrize(
    ("pressure", "bounds", "words"),
    [
        ("uniform", (3.95, 4.0), "under pressure uniform delta is from 0 to 3.9"),
        ("hertz", (2.0, 3.0), "under pressure hertz delta is from 0 to 0.8"),
    ],
)
def test_bounds_beyond_motions_that_are_known_are_refused(pressure, bounds, words):
    with pytest.raises(pt.InputError, match=re.escape(words)):
        pt.fit(TRACK, pt.Puck(radius=0.04, pressure=pressure), bounds={"delta": bounds})


def test_a_start_beyond_the_range_is_put_inside():
    found = pt.fit(TRACK, PUCK)
    start = found.estimate.x.copy()
    start[found.estimate.problem.names.index((-1, "delta"))] = -0.4
    again = estimate(found.estimate.problem, start)
    np.testing.assert_allclose(again.x, found.estimate.x, rtol=1e-5, atol=1e-6)


def test_intervals_of_few_frames_are_those_of_student():
    few = pt.fit(pt.Track(TIMES[:12], PLACE[:12], TRACK.angle[:12]), PUCK, fixed={"delta": 0.2})
    number = few["friction"]
    half = (number.high - number.low) / (2.0 * number.error)
    assert few.degrees == 29 and half == pytest.approx(2.045, rel=0.03)
    assert "Student" in few.explain()


def test_names_of_a_result_are_checked():
    found = pt.fit(TRACK, PUCK)
    for ask in (lambda: found["mu"], lambda: found.launch(1), lambda: found.launch("other"),
                lambda: found.profile("gravity")):  # fmt: skip
        with pytest.raises(pt.InputError):
            ask()
    with pytest.raises(pt.InputError, match="Puck"):
        pt.fit(TRACK, "puck")


def test_a_few_frames_of_known_noise_are_fitted():
    found = pt.fit(pt.Track(TIMES[:6], PLACE[:6], name="few"), PUCK, noise=(3e-4, None),
                   fixed={"delta": 0.2, "launch_spin": 30.0})  # fmt: skip
    assert found["friction"].value == pytest.approx(0.2, abs=5.0 * found["friction"].error)


def test_two_tracks_of_one_name_are_told_apart():
    found = pt.fit([TRACK, pt.Track(TIMES, PLACE - 2.0 * NOISE, TRACK.angle, "film")], PUCK)
    assert [launch.name for launch in found.launches] == ["film 1", "film 2"]


def test_frames_without_place_or_angle_are_left_alone():
    place, angle = PLACE.copy(), np.array(TRACK.angle)
    place[10:20] = np.nan
    angle[30:35] = np.nan
    found = pt.fit(pt.Track(TIMES, place, angle), PUCK)
    assert found.estimate.residuals.size == 2 * 50 + 45
    assert found["friction"].value == pytest.approx(0.2, abs=5.0 * found["friction"].error)


@pytest.mark.parametrize("again", [TRACK, pt.Track(TIMES[20:], PLACE[20:], name="part"),
                                   pt.Track(TIMES + 9.0, PLACE, name="later")])  # fmt: skip
def test_the_same_film_twice_is_refused(again):
    with pytest.raises(pt.InputError, match="show the same frames"):
        pt.fit([TRACK, again], PUCK)


@pytest.mark.parametrize("tracks", [None, 3.0])
def test_what_is_no_track_is_refused(tracks):
    with pytest.raises(pt.InputError, match="tracks must be a Track or several"):
        pt.fit(tracks, pt.Puck(radius=0.04))


@pytest.mark.parametrize(
    ("radius", "angle", "words"),
    [
        thorough(0.04, -1.0, "if angles, or y, grew the other way"),
        thorough(0.04, 180.0 / math.pi, "if angles were in degrees"),
        thorough(0.04, math.pi / 180.0, "if angles were in rad"),
        (0.06, 1.0, "with a radius of 0.04 m (said to be 0.06 m)"),
        (0.04, 1.0, ""),
    ],
)
def test_what_was_said_wrongly_is_found_out(radius, angle, words):
    path = pt.Puck(radius=0.04, height=0.02, friction=0.2).states((1.5, 0.2), 60.0, TIMES)
    place = np.stack([path.x, path.y], axis=1) + NOISE
    track = pt.Track(TIMES, place, angle * (path.orientation + 3.0 * NOISE[:, 0]))
    found = pt.fit(track, pt.Puck(radius=radius))
    assert words in found.misfit and bool(found.misfit) is bool(words)
    if not 0.1 < abs(angle) < 10.0:  # no floor explains what a wrong unit leaves
        assert found.misfit.split(" times smaller ")[1].startswith(words)
    assert bool(found.complaints) is bool(words)


@pytest.mark.thorough
def test_angles_the_other_way_are_found_out_after_a_hand():
    rng = np.random.default_rng(0)
    times = np.arange(-36, 200) / 120.0
    times = times[rng.random(times.size) > 0.1]
    puck = pt.Puck(radius=0.0381, height=0.0254, friction=0.12)
    path = puck.states((1.8, 0.4), -25.0, np.maximum(times, 0.0))  # held until 0 s
    noise = rng.normal(size=(times.size, 3)) * [4e-4, 4e-4, 7e-3]
    place = np.stack([path.x, path.y], axis=1) + noise[:, :2]
    found = pt.fit(pt.Track(times, place, noise[:, 2] - path.orientation), pt.Puck(radius=0.0381))
    assert "something seems to touch the puck" in str(found)
    assert "if angles, or y, grew the other way" in found.misfit


def test_two_marks_on_one_puck_are_no_two_pucks():
    turned = PATH[2]
    away = 0.015 * np.stack([np.cos(turned), np.sin(turned)], axis=1)
    red, blue = (pt.Track(TIMES, PLACE + side * away, name=name)
                 for side, name in ((1.0, "a.csv: red"), (-1.0, "a.csv: blue")))  # fmt: skip
    with pytest.raises(pt.InputError, match=r"two marks on one puck.*--centre red,blue"):
        pt.fit([red, blue], PUCK)
    assert marks_of_one([red, blue]) and not marks_of_one([red, blue], 0.02)
    apart = pt.Track(TIMES, PLACE[::-1], name="a.csv: blue")
    assert not marks_of_one([red, apart])
