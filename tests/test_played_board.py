"""The page of a board to play on, in a real browser without a network."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from commands import invoke
from test_explorer import CHROMIUM, browser, sync_api  # noqa: F401 - a fixture

import puck_tables as pt

pytestmark = [
    pytest.mark.skipif(CHROMIUM is None, reason="no Chromium here"), pytest.mark.thorough,
]  # fmt: skip
SCENE = """
title = "Two men </script>"
[[puck]]
radius = 0.03
friction = 0.1
name = "one"
[[puck]]
radius = 0.03
friction = 0.1
name = "two"
launch.position = [0.3, 0.0]
[[puck]]
radius = 0.05
name = "mallet"
path = [[0, -0.3, 0.2]]
[[wall]]
corners = [[-0.6, -0.4], [0.6, -0.4], [0.6, 0.4], [-0.6, 0.4]]
[[pocket]]
point = [0.55, 0.35]
radius = 0.05
"""


@pytest.fixture(scope="module")
def scene(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("played") / "two.toml"
    path.write_text(SCENE)
    made = invoke("explore", "--scene", path, "-o", f"{path}.html")
    assert made.exit_code == 0, made.output
    return path


def until(page: Any, what: str) -> None:
    """Wait for it; the page allows no code of others, so it is asked from outside."""
    for _ in range(600):
        if page.evaluate(what):
            return
        page.wait_for_timeout(50)
    raise AssertionError(what)


@pytest.fixture
def page(browser: Any, scene: Path) -> Iterator[Any]:  # noqa: F811
    said: list[str] = []
    page = browser.new_page(viewport={"width": 1000, "height": 900})
    page.context.set_offline(True)
    page.on("console", lambda message: said.append(message.text))
    page.on("pageerror", lambda error: said.append(str(error)))
    page.goto(Path(f"{scene}.html").as_uri())
    until(page, "window.played !== undefined")
    yield page
    assert said == []
    page.close()


def place_of(page: Any, x: float, y: float) -> tuple[float, float]:
    """Where a place of the board is on the page."""
    box = page.locator("#board").bounding_box()
    dx, dy = page.evaluate(f"[px({x}), py({y})]")
    return box["x"] + dx, box["y"] + dy


def test_a_drag_strikes_as_the_world_does(page: Any, scene: Path):
    """The puck goes where the page foretold, and where World says; undo takes it back."""
    page.mouse.move(*place_of(page, 0.0, 0.0))
    page.mouse.down()
    page.mouse.move(*place_of(page, 0.2, 0.01), steps=3)
    page.wait_for_timeout(100)
    speed, heading = (float(page.locator(f"#{one}").input_value()) for one in ("speed", "heading"))
    assert heading == pytest.approx(2.86, abs=0.2)
    velocity = page.evaluate("pulled()")
    page.mouse.up()
    assert speed == pytest.approx((velocity[0] ** 2 + velocity[1] ** 2) ** 0.5, abs=0.01)
    until(page, "!playing && played.board().time > 0.1")
    world = pt.Scene.load(scene).world()
    world.strike("one", velocity)
    world.advance(page.evaluate("played.board().time"))
    mine = page.evaluate("played.board().state().map(s => [s.x, s.y, s.angle])")
    for one, other in zip(mine, world.state()[:, :3].tolist(), strict=True):
        assert one == pytest.approx(other, abs=1e-9)
    assert abs(world.state()[1, 0] - 0.3) > 0.01  # it was hit
    page.locator("#undo").click()
    assert page.evaluate("played.board().time") == 0.0


def test_a_mallet_follows_the_hand(page: Any):
    page.mouse.move(*place_of(page, -0.3, 0.2))
    page.mouse.down()
    page.mouse.move(*place_of(page, -0.2, -0.2), steps=3)
    page.wait_for_timeout(1500)
    x, y = page.evaluate("[played.board().state()[2].x, played.board().state()[2].y]")
    page.mouse.up()
    assert (x, y) == pytest.approx((-0.2, -0.2), abs=5e-3)


def test_strikes_by_numbers_and_refusals_are_said(page: Any):
    page.locator("#speed").fill("1e9")
    page.locator("#strike button").click()
    assert "beyond, nothing is known" in page.locator("#said").inner_text()
    assert page.evaluate("played.board().time") == 0.0
    page.locator("#speed").fill("0.5")
    page.locator("#heading").fill("180")
    page.locator("#strike button").click()
    until(page, "!playing && played.board().time > 0.1")
    assert page.evaluate("played.board().state()[0].x") < -0.1
    page.locator("#move").check()
    page.mouse.move(*place_of(page, *page.evaluate("[played.board().state()[0].x, 0]")))
    page.mouse.down()
    page.mouse.move(*place_of(page, 0.1, 0.3), steps=3)
    page.mouse.up()
    x, y = page.evaluate("[played.board().state()[0].x, played.board().state()[0].y]")
    assert (x, y) == pytest.approx((0.1, 0.3), abs=5e-3)
    page.locator("#start").click()
    assert page.evaluate("played.board().state()[0].x") == 0.0
    assert page.title() == "Two men </script>"
