"""The explorer, in a real browser without a network: its numbers, drags, keys, a narrow window."""

from __future__ import annotations

import dataclasses
import math
import os
import re
import shlex
import shutil
from collections.abc import Iterator
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from commands import invoke
from rarely import nightly, thorough

import puck_tables as pt
from puck_tables.explore.page import LAWS, TOL

sync_api = pytest.importorskip("playwright.sync_api")
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="no Chromium here")
DEGREE = math.pi / 180.0


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> str:
    path = tmp_path_factory.mktemp("explorer") / "page.html"
    made = invoke("explore", "-o", path)
    assert made.exit_code == 0, made.output
    assert path.stat().st_size < 300_000
    return path.as_uri()


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    sandbox = [] if os.getuid() else ["--no-sandbox"]
    with sync_api.sync_playwright() as play:
        chromium = play.chromium.launch(executable_path=CHROMIUM, args=sandbox)
        yield chromium
        chromium.close()


@pytest.fixture(scope="module")
def tab(browser: Any, address: str) -> tuple[Any, list[str]]:
    """A page of a browser, and what it says: a new page takes longer than most tests."""
    said: list[str] = []
    page = browser.new_page()
    page.context.set_offline(True)
    page.on("console", lambda message: said.append(message.text))
    page.on("pageerror", lambda error: said.append(str(error)))
    page.on("request", lambda request: request.url == address or said.append(request.url))
    return page, said


@pytest.fixture
def page(tab: tuple[Any, list[str]], address: str) -> Iterator[Any]:
    page, said = tab
    said.clear()
    page.set_viewport_size({"width": 1280, "height": 900})
    page.goto(address)
    yield page
    assert said == []


def shown(page: Any) -> tuple[dict[str, float], dict[str, Any]]:
    return page.evaluate("explorer.now"), page.evaluate("explorer.run()")


def launched(now: dict[str, float]) -> tuple[pt.Puck, tuple[float, float], float]:
    law = next(one for one in LAWS if one.name == now["law"])
    puck = pt.Puck(
        radius=now["radius"] / 1e3, height=now["height"] / 1e3, friction=now["friction"],
        pressure=law.name, gyration=law.gyration,
    )  # fmt: skip
    along = (math.cos(now["heading"] * DEGREE), math.sin(now["heading"] * DEGREE))
    return puck, (now["speed"] * along[0], now["speed"] * along[1]), now["spin"]


@pytest.mark.parametrize(("law", "count"), [(one.name, 3 if one.file else 12) for one in LAWS])
def test_numbers_are_the_library_s(page: Any, law: str, count: int):
    rng = np.random.default_rng(5)
    page.evaluate(f"explorer.setLaw('{law}')")
    for _ in range(count):
        low = {
            "speed": 0, "heading": -180, "spin": -150, "radius": 5, "height": 0, "friction": 0.01,
        }  # fmt: skip
        high = {
            "speed": 5, "heading": 180, "spin": 150, "radius": 200, "height": 200, "friction": 1,
        }  # fmt: skip
        for name in low:
            page.evaluate(f"explorer.set('{name}', {rng.uniform(low[name], high[name])})")
        now, run = shown(page)
        puck, velocity, spin = launched(now)
        slip = math.hypot(now["speed"], puck.radius * spin)
        time, size = slip / puck.decel, slip**2 / puck.decel
        tallest = puck.body.law.delta_max
        assert puck.delta <= tallest * (1.0 + 1e-12)
        puck = dataclasses.replace(puck, height=puck.height * (1.0 - 1e-12))  # rounding
        stop = puck.stop(velocity, spin, tol=1e-8)
        assert abs(run["time"] - stop.stop_time) < 1.01 * TOL * time
        assert abs(run["x"] - stop.stop_position[0]) < 1.01 * TOL * size
        assert abs(run["y"] - stop.stop_position[1]) < 1.01 * TOL * size
        states = np.array(run["states"])[::20]
        truth = puck.states(velocity, spin, states[:, 0])
        assert np.abs(states[:, 1] - truth.x).max() < 2.0 * TOL * size
        assert np.abs(states[:, 4] - truth.vx).max() < 2.0 * TOL * slip


def test_the_pressure_under_the_base_balances_its_friction(page: Any):
    """Friction acts h/2 below the centre; the load, r/4 of its slope off, makes up for it."""
    for name, value in (("height", 100), ("friction", 0.15), ("moment", 50)):
        page.evaluate(f"explorer.set('{name}', {value})")
    now, run = shown(page)
    puck, velocity, spin = launched(now)
    path = puck.states(velocity, spin, [run["t"] - 1e-3, run["t"] + 1e-3])
    pull = np.array([np.diff(path.vx), np.diff(path.vy)]).ravel() / 2e-3 / puck.gravity
    assert run["tilt"] == pytest.approx((-2.0 * pull * puck.height / puck.radius), rel=1e-4)


def drag(page: Any, handle: str, by: tuple[float, float]) -> None:
    box = page.locator("#plane").bounding_box()
    x, y = page.evaluate(f"explorer.{handle}()")
    page.mouse.move(box["x"] + x, box["y"] + y)
    page.mouse.down()
    page.mouse.move(box["x"] + x + by[0], box["y"] + y + by[1], steps=5)
    page.mouse.up()


def test_the_arrow_is_dragged(page: Any):
    before = page.evaluate("({...explorer.now})")
    drag(page, "tipOfArrow", (0.0, -60.0))
    now, _ = shown(page)
    assert now["heading"] > before["heading"] + 15.0
    assert now["spin"] == before["spin"]


def test_the_ring_is_dragged_also_through_zero(page: Any):
    """It is turned clockwise once; the knob stands 0.65 of a turn from no spin."""
    page.evaluate("explorer.set('spin', 50); explorer.refresh(true)")
    box = page.locator("#plane").bounding_box()
    centre, knob = page.evaluate("[explorer.seen(0, 0), explorer.knobOfRing()]")
    x, y = knob[0] - centre[0], knob[1] - centre[1]
    page.mouse.move(box["x"] + knob[0], box["y"] + knob[1])
    page.mouse.down()
    for turn in np.linspace(0.0, 2.0 * math.pi, 13)[1:]:
        c, s = math.cos(turn), math.sin(turn)
        page.mouse.move(box["x"] + centre[0] + c * x - s * y, box["y"] + centre[1] + s * x + c * y)
    page.mouse.up()
    now, _ = shown(page)
    assert now["spin"] == pytest.approx(50.0 * (0.65 - 1.0) / 0.65, rel=1e-3)


def test_a_click_is_a_target_that_is_hit(page: Any):
    box = page.locator("#plane").bounding_box()
    page.mouse.click(box["x"] + 320, box["y"] + 90)
    now, run = shown(page)
    assert (run["x"], run["y"]) == pytest.approx(now["target"], abs=1e-9)
    puck, velocity, spin = launched(now)
    assert puck.stop(velocity, spin).stop_position == pytest.approx(now["target"], abs=1e-4)


def test_keys_and_sliders(page: Any):
    before = page.evaluate("({...explorer.now})")
    page.locator("#plane").focus()
    for key in ("ArrowUp", "ArrowUp", "ArrowLeft", "+", "+", "+"):
        page.keyboard.press(key)
    now, _ = shown(page)
    assert now["speed"] == pytest.approx(before["speed"] + 0.1)
    assert now["heading"] == pytest.approx(before["heading"] + 2.0)
    assert now["spin"] == pytest.approx(before["spin"] + 6.0)
    page.locator("[name=friction-range]").focus()
    page.keyboard.press("ArrowRight")
    assert page.evaluate("explorer.now.friction") == pytest.approx(before["friction"] + 1e-3)
    page.locator("[name=radius-number]").fill("50")
    assert page.evaluate("explorer.now.radius") == 50


def test_the_address_keeps_it_and_commands_say_it(page: Any, address: str):
    page.evaluate("explorer.set('spin', 33); explorer.set('heading', 0); explorer.refresh(true)")
    page.wait_for_url("**spin=33&**")
    page.locator("#python").click()
    room: dict[str, Any] = {}
    exec(page.locator("#copied").text_content(), room)
    assert room["run"].spin[0] == 33.0
    page.locator("#command").click()
    command = page.locator("#copied").text_content().split()
    assert invoke(*command[1:]).exit_code == 0
    page.goto(address + "#spin=-12&speed=1&no=3")
    assert page.evaluate("explorer.now.spin") == -12


@pytest.mark.parametrize("law", [one for one in LAWS if one.file], ids=lambda one: one.name)
def test_a_law_is_chosen_by_keys_kept_and_said(page: Any, address: str, law: Any):
    page.locator("[name=law]").focus()
    for _ in range(LAWS.index(law)):
        page.keyboard.press("ArrowDown")
    assert page.evaluate("explorer.now.law") == law.name
    page.wait_for_url(f"**law={law.name}&**")
    page.locator("#python").click()
    room: dict[str, Any] = {}
    exec(page.locator("#copied").text_content(), room)
    assert room["puck"].pressure == law.name and room["puck"].gyration == law.gyration
    _, run = shown(page)
    assert run["time"] == pytest.approx(room["run"].stop_time, rel=1e-5)
    page.locator("#command").click()
    assert f"--pressure {law.name} --gyration" in page.locator("#copied").text_content()
    page.goto(f"{address}#law=nothing&spin=3")
    assert page.evaluate("explorer.now.law") == law.name


def test_every_law_loads_the_base_where_it_presses(page: Any):
    """At the middle and at 0.9 of the radius: whether something is drawn there."""
    pixel = """(places) => { const canvas = document.getElementById("base");
      const sheet = Object.assign(document.createElement("canvas"), {
        width: canvas.width, height: canvas.height });
      const pen = sheet.getContext("2d", { willReadFrequently: true });
      pen.drawImage(canvas, 0, 0);
      const size = Math.min(canvas.clientWidth, canvas.clientHeight) / 2 - 18;
      const middle = canvas.clientWidth / 2, ratio = canvas.width / canvas.clientWidth;
      return places.map((x) =>
        pen.getImageData((middle + x * size) * ratio, canvas.height / 2, 1, 1).data[3] > 0); }"""
    page.evaluate("explorer.set('speed', 0)")  # no arrow in the way
    loaded = {}
    for law in LAWS:
        page.evaluate(f"explorer.setLaw('{law.name}'); explorer.refresh(true)")
        loaded[law.name] = page.evaluate(pixel, [-0.3, -0.9, -0.97])
    assert loaded == {
        "uniform": [True, True, True], "hertz": [True, True, True],
        "annulus:0.8": [False, True, True], "ring": [False, False, True],
    }  # fmt: skip


def test_the_look_ups_that_come_along_are_those_that_are_written():
    """Their heads: law, radius of gyration, largest δ, error and version."""
    for law in LAWS[1:]:
        text = (files("puck_tables.tables") / law.file).read_text()
        head = " ".join(text[:400].split())
        assert f"puck-tables {pt.__version__}: stop, state, resultants" in head
        assert f"error {TOL:g} " in head
        assert (
            f"pressure {law.name}, k/r = {law.gyration:g}, 0 <= delta <= {law.tallest:g}." in head
        )


@pytest.mark.parametrize("law", [*map(nightly, LAWS[1:-1]), thorough(LAWS[-1])])
def test_they_are_made_again_the_same(law: Any):
    """Number by number but for the last digit, which another machine may round otherwise."""
    puck = pt.Puck(radius=1.0, pressure=law.name, gyration=law.gyration)
    made = pt.export_source("js", tol=TOL, puck=puck).text
    kept = (files("puck_tables.tables") / law.file).read_text()
    number = re.compile(r"-?\d*\.?\d+(?:e-?\d+)?")
    assert number.sub("", made) == number.sub("", kept)
    ours, theirs = (np.array(number.findall(one), float) for one in (made, kept))
    np.testing.assert_allclose(ours, theirs, rtol=1e-6, atol=20.0)


CORNERS = {
    "box": [(-100, -50), (100, -50), (100, 50), (-100, 50)],
    "clockwise": [(0, 0), (0, 90), (40, 30)],
    "arrow": [(0, 0), (80, -40), (20, 0), (80, 40)],
}


@pytest.mark.parametrize("name", CORNERS)
def test_a_drawn_base_moves_as_the_library_s(page: Any, name: str):
    assert page.evaluate(f"explorer.setCorners({[list(one) for one in CORNERS[name]]})")
    base = pt.Base.polygon(np.array(CORNERS[name]) / 1000.0)
    rng = np.random.default_rng(3)
    for speed, spin in ((2.0, 40.0), (0.0, 90.0), (3.0, 0.0), (0.5, -100.0)):
        page.evaluate(f"explorer.set('speed', {speed}); explorer.set('spin', {spin})")
        page.evaluate(f"explorer.set('heading', {rng.uniform(-180, 180)})")
        now, run = shown(page)
        heading = now["heading"] * DEGREE
        puck = pt.Puck(base=base, friction=now["friction"])
        told = puck.simulate((speed * math.cos(heading), speed * math.sin(heading)), spin)
        slip = math.hypot(speed, puck.gyration * spin)
        time, size = slip / puck.decel, slip**2 / puck.decel
        assert abs(run["time"] - told.stop_time) < 5e-6 * time
        assert np.hypot(*(np.array([run["x"], run["y"]]) - told.stop_position)) < 5e-6 * size
        assert abs(run["turn"] - told.body_angle) < 5e-6 * size / puck.gyration
        states = np.array(run["states"])[::20]
        truth = puck.states(
            (speed * math.cos(heading), speed * math.sin(heading)), spin, states[:, 0]
        )
        assert np.hypot(states[:, 1] - truth.x, states[:, 2] - truth.y).max() < 5e-6 * size
        assert np.abs(states[:, 6] - truth.spin).max() < 2e-5 * slip / puck.gyration


def test_a_base_is_drawn_by_hand_by_text_and_kept(page: Any, address: str):
    page.evaluate("explorer.setLaw('drawn'); explorer.refresh(true)")
    box = page.locator("#base").bounding_box()
    size = min(box["width"], box["height"]) / 2 - 18
    middle = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(middle[0], middle[1] - size / 5**0.5)  # between two corners of the box
    page.mouse.down()
    page.mouse.move(middle[0], middle[1] - 0.9 * size, steps=4)
    page.mouse.up()
    assert page.evaluate("explorer.drawn.corners.length") == 5
    tip = max(page.evaluate("explorer.drawn.corners"), key=lambda one: one[1])
    assert page.evaluate("explorer.now.radius") * (tip[1] + 0.2) > 30
    box_text = page.locator("#corners")
    before = page.evaluate("explorer.drawn.corners")
    for wrong in ("0,0; 1,1", "0,0; 60,60; 60,0; 0,60", "0,0; 900,0; 0,900", "a,b; 1,2; 3,4"):
        box_text.fill(wrong)
        assert not box_text.evaluate("one => one.checkValidity()")
        assert page.evaluate("explorer.drawn.corners") == before
    box_text.fill("-60,-20; 60,-20; 60,20; -60,20")
    page.evaluate("explorer.set('heading', 90); explorer.set('speed', 1); explorer.refresh(true)")
    page.wait_for_url("**speed=1&heading=90&**")
    _, run = shown(page)
    room: dict[str, Any] = {}
    page.locator("#python").click()
    exec(page.locator("#copied").text_content(), room)
    assert run["time"] == pytest.approx(room["run"].stop_time, rel=1e-5)
    page.locator("#command").click()
    words = shlex.split(page.locator("#copied").text_content())
    assert invoke(*words[1:]).exit_code == 0
    kept = page.url
    page.goto(address)
    page.goto(kept)
    assert shown(page)[1]["time"] == pytest.approx(run["time"], rel=1e-6)
    assert page.evaluate("explorer.aimAt(0.4, 0.3)")
    _, run = shown(page)
    assert (run["x"], run["y"]) == pytest.approx((0.4, 0.3), abs=1e-6)
    page.goto(address)
    page.goto(address + "#law=drawn&corners=0,0;60,60;60,0;0,60")  # its sides cross: it is said
    page.wait_for_function("!document.getElementById('corners').checkValidity()")
    assert page.locator("#corners").input_value().startswith("0,0;60,60")


def test_a_narrow_window_hides_nothing(page: Any):
    page.set_viewport_size({"width": 390, "height": 800})
    page.wait_for_timeout(200)
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    for name in ("plane", "speeds", "ratio", "base", "map"):
        assert page.locator(f"#{name}").bounding_box()["width"] > 150


def test_axe_finds_nothing(page: Any):
    axe = pytest.importorskip("axe_playwright_python.sync_playwright")
    assert axe.Axe().run(page).response["violations"] == []
    page.evaluate("explorer.setLaw('drawn'); explorer.refresh(true)")
    assert axe.Axe().run(page).response["violations"] == []


@pytest.mark.parametrize(("name", "why"), [("explorer.txt", "FILE.html"), ("there.html", "exists")])
def test_refusals(name: str, why: str, tmp_path: Path):
    (tmp_path / "there.html").write_text("mine")
    said = invoke("explore", "-o", tmp_path / name)
    assert said.exit_code != 0
    assert why in said.output
    assert (tmp_path / "there.html").read_text() == "mine"
