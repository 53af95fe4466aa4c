"""The page of a fit for a class: what stands on it, that it is whole, and what is refused."""

from __future__ import annotations

import re
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from commands import invoke

import puck_tables as pt
from puck_tables.plot.fit_page import page

pytest.importorskip("matplotlib")
VOID = {"meta", "br", "use", "path", "image", "rect", "line", "circle"}


class Checked(HTMLParser):
    """Every tag is closed by its own; the text outside of pictures and styles is kept."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.text = ""

    def handle_starttag(self, tag: str, attrs: list) -> None:
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        if tag not in VOID:
            assert self.open and self.open.pop() == tag, tag

    def handle_data(self, data: str) -> None:
        if not {"svg", "style"} & {*self.open}:
            self.text += data


@pytest.fixture(scope="module")
def found():
    t = np.arange(120) / 60.0
    path = pt.Puck(radius=0.0381, height=0.0254, friction=0.15).states((2.0, 0.5), 40.0, t)
    noise = np.random.default_rng(1).normal(0.0, 1.0, (120, 3)) * [3e-4, 3e-4, 5e-3]
    place = np.stack([path.x, path.y], axis=1) + noise[:, :2]
    track = pt.Track(t, place, path.orientation + noise[:, 2], "<film> & one")
    return pt.fit(track, pt.Puck(radius=0.0381), laws=["uniform", "hertz"])


def test_the_page_says_what_was_found_assumed_and_left(found):
    html = page(found)
    read = Checked()
    read.feed(html)
    assert not read.open
    friction = found["friction"]
    assert f"Friction coefficient f = {friction.value:.6f} ±" in read.text
    for words in (
        "<film> & one", "What was assumed", "The table is level", "radius (radius of the base): "
        "0.0381 m", "χ² is", "degrees of freedom", "95 of 100 times within", "Which floor",
        "hertz", "f = v/(g t)", "t / s", *found.remarks,
    ):  # fmt: skip
        assert words in read.text, words
    assert html.count("class='blank'") >= 10 and html.count("<svg") == 2
    assert html.count("aria-label=") == 2
    # it loads nothing: what looks like addresses are names of XML and of the drawing program
    loaded = re.findall(r"(?:src|href)=[\"'](?!#)([^\"']*)", html)
    assert not [one for one in loaded if not one.startswith("data:")], loaded
    rows = re.findall(r"<tr><td>(\d\.\d{4})</td>", html)
    assert rows[0] == "0.0000" and len(rows) == 16


def test_a_film_without_noise_has_intervals_that_are_seen():
    t = np.arange(60) / 60.0
    path = pt.Puck(radius=0.0381, height=0.0254, friction=0.3).states((2.0, 0.5), 40.0, t)
    places = np.stack([path.x, path.y], axis=1)
    clean = pt.fit(pt.Track(t, places, path.orientation), pt.Puck(radius=0.0381))
    ends = {name: one.interval for name, one in clean.numbers.items() if one.how != "known"}
    html, told = page(clean), str(clean)
    for name, interval in ends.items():
        low, high = map(float, interval.split(" to "))
        assert low < clean[name].value < high, (name, interval)
        assert high - low == pytest.approx(clean[name].high - clean[name].low, rel=0.1)
        assert interval in html and f"95 %: {interval}" in told
    panels = [one for one in clean.plot().axes if one.get_title() == "rise of chi²"]
    assert [one.get_xlabel().split(" - ")[0] for one in panels] == ["friction", "delta"]
    for panel, name in zip(panels, ("friction", "delta"), strict=True):
        low, high = panel.get_xlim()
        assert 1.0 < (high - low) / (clean[name].high - clean[name].low) < 3.0


def test_python_and_the_command_write_the_same(tmp_path: Path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    t = np.arange(40) / 50.0
    rows = [f"{a!r},{1.2 * a - 0.7 * a * a!r}" for a in t.tolist()]
    Path("a.csv").write_text("t [s],s [m]\n" + "\n".join(rows))
    words = ["fit", "a.csv", "--noise", "0.0005", "--report"]
    said = invoke(*words, "b.html")
    assert said.exit_code == 0 and "wrote b.html" in said.stderr
    result = pt.fit(pt.read_tracks("a.csv"), pt.Puck(0.04), free="friction", noise=(5e-4, None))
    Path("c.html").write_text("before")
    with pytest.raises(pt.errors.OutputError):
        result.report("c.html")
    result.report("c.html", overwrite=True)
    with pytest.raises(pt.InputError, match=r"\.html"):
        result.report("c.pdf")
    one, two = (re.sub(r"<svg.*?</svg>", "", Path(n).read_text("utf-8"), flags=re.S)
                for n in ("b.html", "c.html"))  # fmt: skip
    assert one == two and one.startswith("<!DOCTYPE html>")
    for name, message in (("b.html", "exists already"), ("b.txt", ".html"), ("a.csv", "")):
        again = invoke(*words, name)
        assert again.exit_code != 0 and message in again.stderr
    assert Path("a.csv").read_text().startswith("t [s]")


def test_a_fit_that_runs_away_says_so_on_its_page(found):
    from dataclasses import replace

    html = page(replace(found, astray="Nothing is determined: it runs away"))
    assert "<p class='found'>Nothing is determined: it runs away.</p>" in html
