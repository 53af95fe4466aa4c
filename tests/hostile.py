"""Every public function and method with arguments that it takes, and arguments that nobody wants.

What a draw replaces is one argument or two; the others stay good, so that each is looked at.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from decimal import Decimal
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

import puck_tables as pt
from puck_tables import chetaev, contact, motion

Door = tuple[Callable[..., Any], dict[str, Any]]


def hostile() -> list[Any]:
    """Values that nobody wants, made anew: some are used up, some could be changed."""
    texts = ["", "a", "1e-8", "nan", "\x00", "x" * 10_000, "0:1:3", b"1", np.str_("a"), Path("a")]
    odd = [None, True, False, ..., 1j, object(), {}, set(), {"a": 1.0}, {1.0, 2.0}, pt.Puck(1.0)]
    lists = [
        (), [], range(3), iter([1.0, 2.0]), [1.0, [2.0]], [[1.0, 2.0], [3.0]], [None], ["a", "b"],
        [1.0], (1.0, 2.0, 3.0), [1.0, math.nan], [10**400, 1], [2.0, 1.0], (1e30, 0.0),
        (1e-30, 1e-30), (1e200, 1e200), (1e12, 1e12),
    ]  # fmt: skip
    arrays = [
        np.empty(0), np.empty((0, 2)), np.zeros((2, 3)), np.ones((1, 1, 2)), np.array(1.0),
        np.array([0.5, 0.7]), np.array(["a"]), np.array([None]), np.array([1j]),
        np.array([True, False]), np.array(math.nan), np.ma.masked_array([1.0, 2.0], [True, False]),
    ]  # fmt: skip
    numbers = [
        Decimal("1.5"), Fraction(1, 3), np.float32(0.5), np.int8(1), np.bool_(True), 10**400,
        np.datetime64("2020-01-01"), np.timedelta64(3, "s"), -(10**30), 2**63, 0, 1, -1, 3, 1.5,
        -1.5, 0.0, -0.0, math.nan, math.inf, -math.inf, 1e-12, 1e12, 1e30, -1e30, 1e300, 1e-300,
        5e-324,
    ]  # fmt: skip
    return [*texts, *odd, *lists, *arrays, *numbers]


@cache
def puck() -> pt.Puck:
    return pt.Puck(radius=0.04, height=0.02, friction=0.2)


@cache
def scene() -> pt.Scene:
    wall = pt.Wall((0.3, 0.0), normal=(-1.0, 0.0), restitution=0.5)
    return pt.Scene(puck(), pt.Floor(slope=0.05), pt.Launch((1.0, 0.2), 20.0), walls=[wall])


@cache
def board() -> pt.Scene:
    cue = pt.Puck(0.03, friction=0.1, name="cue", launch=pt.Launch((1.0, 0.0)))
    red = pt.Puck(0.03, friction=0.1, name="red", launch=pt.Launch(position=(0.3, 0.0)))
    return pt.Scene(pucks=[cue, red])


@cache
def world() -> pt.World:
    return board().world()


@cache
def led_world() -> pt.World:
    return pt.Scene(pucks=[pt.Puck(0.03, path=[[0.0, 0.0, 0.0]], name="mallet")]).world()


def on_copy(verb: str) -> Callable[..., Any]:
    return lambda **given: getattr(world().copy(), verb)(**given)


def arrays_of(found: Any) -> Any:
    """What is computed when first asked for, too."""
    found.path_length, found.dataset(), found.explain(), repr(found)
    return found


KIND: dict[str, Any] = {"pressure": "uniform", "gyration": math.sqrt(0.5)}
FRICTION: dict[str, Any] = {"friction": 0.2, "height": 0.04, "gravity": 9.8, "radius": 0.05}
HEIGHT: dict[str, Any] = {"delta": 0.5, "decel": 1.0, "radius": 1.0}
TWO = (1.0, 0.5)
RESULT_OF: dict[str, Callable[[], Any]] = {
    "stops": cache(lambda: pt.stop([TWO, (2.0, 0.0)], 3.0, jacobian=True)),
    "states": cache(lambda: pt.states(TWO, 3.0, 0.2, jacobian=True)),
    "sample": cache(lambda: puck().sample(20, 1, speed=pt.Normal(1.0, 0.1))),
    "law": cache(lambda: pt.StribeckLaw(0.3, 0.2, 0.1)),
    "table": cache(lambda: pt.SpeedLaw([0.0, 1.0], [0.3, 0.2])),
    "pressure": cache(lambda: pt.law_of("uniform")),
    "asperity": cache(lambda: chetaev.Asperity(1e-6, 1e-5, 1.0, 0.1)),
}


def of_result(name: str, verb: str) -> Callable[..., Any]:
    return lambda **given: getattr(RESULT_OF[name](), verb)(**given)


def _of_arrays() -> dict[str, Door]:
    return {
        "stop": (lambda **k: arrays_of(pt.stop(**k)), {
            "velocity": TWO, "spin": 2.0, **HEIGHT, "tol": 1e-8, "method": None, "table": None,
            **KIND, "jacobian": False, "threads": 1}),
        "stop of friction": (lambda **k: pt.stop(**k), {
            "velocity": TWO, "spin": 2.0, **FRICTION, "jacobian": True}),
        "states of friction": (lambda **k: pt.states(**k), {
            "velocity": TWO, "spin": 2.0, "time": 0.1, **FRICTION, "jacobian": True}),
        "states": (lambda **k: pt.states(**k), {
            "velocity": TWO, "spin": 2.0, "time": 0.1, **HEIGHT, "table": None, **KIND,
            "jacobian": False, "threads": 1}),
        "stop_arrays": (lambda **k: pt.stop_arrays(**k), {
            "vx": 1.0, "vy": 0.1, "spin": 2.0, **HEIGHT, "tol": 1e-8, **KIND}),
        "state_arrays": (lambda **k: pt.state_arrays(**k), {
            "vx": 1.0, "vy": 0.1, "spin": 2.0, "time": 0.2, **HEIGHT, **KIND}),
        "resultants": (lambda **k: pt.resultants(**k), {"phi": 0.3, "delta": 0.5}),
        "critical_delta": (contact.critical_delta, {"phi": 0.3}),
        "is_full_contact": (contact.is_full_contact, {"phi": 0.3, "delta": 0.5}),
        "loaded_share": (contact.loaded_share, {"phi": 0.3, "delta": 1.5}),
        "one_sided_resultants": (contact.one_sided_resultants, {"phi": 0.3, "delta": 1.5}),
        "speed_resultants": (contact.speed_resultants, {
            "phi": 0.3, "speed": 0.2, "law": RESULT_OF["table"](), "height_ratio": 0.1}),
        "approach_exponent": (motion.approach_exponent, {"delta": 0.5}),
        "curvature_slope": (motion.curvature_slope, {"delta": 0.5}),
        "limit_angle": (motion.limit_angle, {"delta": 0.5, **KIND}),
        "limit_ratio": (motion.limit_ratio, {"delta": 0.5, **KIND}),
        "regime": (motion.regime, {
            "velocity": TWO, "spin": 1.0, "delta": 0.5, "radius": 1.0, **KIND}),
    }  # fmt: skip


def _of_pucks() -> dict[str, Door]:
    p = puck()
    numbers = {"radius": 0.04, "height": 0.02, "friction": 0.2, "mass": 0.1, "gravity": 9.8}
    return {
        "Puck": (pt.Puck, {**numbers, **KIND}),
        "Puck.similar": (pt.Puck.similar, {**HEIGHT, "mass": 1.0, **KIND}),
        "Puck.stop": (p.stop, {
            "velocity": TWO, "spin": 2.0, "tol": 1e-8, "method": None, "table": None,
            "jacobian": False, "threads": 1}),
        "Puck.states": (p.states, {
            "velocity": TWO, "spin": 2.0, "time": 0.1, "table": None, "jacobian": False}),
        "Puck.simulate": (p.simulate, {
            "velocity": TWO, "spin": 2.0, "frames": None, "times": None, "tol": 1e-9,
            "method": None, "exact": False, "table": None}),
        "Puck.regime": (p.regime, {"velocity": TWO, "spin": 2.0}),
        "Puck.aim": (p.aim, {
            "target": TWO, "spin": 2.0, "speed": None, "stop_time": None, "max_speed": None,
            "max_spin": None, "count": 3, "threads": 1}),
        "Puck.holds": (p.holds, {"force": (0.1, 0.0), "torque": 0.0, "angle": 0.1}),
        "Puck.limit_surface": (p.limit_surface, {"n": 31}),
        "Puck.wrench": (p.wrench, {
            "velocity": TWO, "spin": 2.0, "angle": 0.1, "jacobian": True}),
        "Puck.twist": (p.twist, {"force": (0.1, 0.0), "torque": 1e-3, "angle": 0.1}),
        "push": (pt.push, {
            "puck": pt.Puck(base="box:0.2x0.1", friction=0.3), "at": (-0.1, 0.02),
            "velocity": (0.05, 0.0), "friction": 0.2, "angle": 0.1, "duration": 0.1, "frames": 3}),
        "Puck.sweep": (p.sweep, {
            "spin": [0.0, 5.0], "speed": 1.0, "velocity": None, "heading": None, "radius": None,
            "height": None, "friction": None, "gravity": None, "tol": 1e-8, "method": None,
            "table": None, "threads": 1, "chunk": 64, "progress": None, "store": None,
            "cluster": None, "overwrite": False, "launches": None}),
        "Puck.sample": (p.sample, {
            "count": 10, "seed": 1, "tol": 1e-8, "method": None, "table": None, "threads": 1,
            "chunk": 64, "progress": None, "cluster": None, "velocity": TWO,
            "spin": pt.Normal(1.0, 0.1)}),
        "export_source": (lambda **k: pt.export_source(**k), {
            "language": "c", "what": "resultants", "tol": 1e-2, "puck": None}),
        "stops.derivative": (of_result("stops", "derivative"), {"of": "stop_x", "by": "vx"}),
        "stops.spread": (of_result("stops", "spread"), {
            "covariance": np.eye(3) * 1e-6, "of": ("vx", "vy", "spin"), "samples": 0, "seed": 0}),
        "states.spread": (of_result("states", "spread"), {
            "covariance": np.eye(3) * 1e-6, "of": ("vx", "vy", "spin"), "samples": 3, "seed": 0}),
        "states.derivative": (of_result("states", "derivative"), {"of": "x", "by": "vx"}),
        "sample.chance": (of_result("sample", "chance"), {"region": (0.5, 0.0, 0.1)}),
        "sample.covariance": (of_result("sample", "covariance"), {"names": None}),
        "sample.density": (of_result("sample", "density"), {"bins": 4, "extent": None}),
        "sample.quantiles": (of_result("sample", "quantiles"), {"shares": (0.5,)}),
        "sample.summary": (of_result("sample", "summary"), {"regions": ()}),
        "Normal": (lambda **k: pt.Normal(**k).drawn("a", 1, 0, 3), {"mean": 1.0, "deviation": 0.1}),
        "Uniform": (lambda **k: pt.Uniform(**k).drawn("a", 1, 0, 3), {"low": 0.0, "high": 0.1}),
    }  # fmt: skip


def _of_laws() -> dict[str, Door]:
    return {
        "law_of": (pt.law_of, {"text": "uniform"}),
        "profile_law": (pt.profile_law, {
            "radii": [0.0, 0.5, 1.0], "pressure": [1.0, 0.5, 0.2], "name": "a"}),
        "StribeckLaw": (pt.StribeckLaw, {
            "static": 0.3, "kinetic": 0.2, "speed": 0.1, "exponent": 1.0, "viscous": 0.0}),
        "PowerLaw": (pt.PowerLaw, {"a": 0.1, "exponent": 0.5, "b": 0.1}),
        "CurlingLaw": (pt.CurlingLaw, {"a": 0.1, "b": 0.1, "c": 0.1}),
        "SpeedLaw": (pt.SpeedLaw, {
            "speeds": [0.0, 1.0], "values": [0.3, 0.2], "kind": "cubic"}),
        "SpeedLaw.from_csv": (pt.SpeedLaw.from_csv, {"path": "none.csv", "kind": "cubic"}),
        "SpeedLaw.largest": (of_result("table", "largest"), {"top": 0.5}),
        "SpeedLaw.pieces": (of_result("table", "pieces"), {"top": 0.5}),
        "law.largest": (of_result("law", "largest"), {"top": 0.5}),
        "law.pieces": (of_result("law", "pieces"), {"top": 0.5}),
        "Law.friction": (of_result("pressure", "friction"), {"phi": 0.3, "delta": 0.5}),
        "Law.resultants": (of_result("pressure", "resultants"), {"phi": 0.3, "delta": 0.5}),
        "RestitutionTable": (pt.RestitutionTable, {"speeds": [0.0, 1.0], "values": [1.0, 0.5]}),
        "Plastic": (pt.Plastic, {"yield_speed": 0.1}),
        "Viscoelastic": (pt.Viscoelastic, {"loss": 0.1}),
        "table_for": (pt.table_for, {
            "law": "uniform", "accuracy": None, "progress": None, "top_speed": None}),
        "Table.shipped": (pt.Table.shipped, {"kind": "resultants"}),
        "Table.load": (pt.Table.load, {"path": "none.h5"}),
    }  # fmt: skip


def _of_scenes() -> dict[str, Door]:
    made = {
        "Launch": (pt.Launch, {
            "velocity": TWO, "spin": 1.0, "position": TWO, "orientation": 0.0, "time": 0.0}),
        "Floor": (pt.Floor, {
            "slope": 0.1, "downhill": 0.0, "velocity": TWO, "turning": 0.1, "centre": TWO,
            "strips": None, "patches": (), "orthotropic": None, "law": ""}),
        "Drag": (pt.Drag, {
            "sliding": 0.1, "quadratic": 0.1, "spinning": 0.1, "spinning_quadratic": 0.1}),
        "Lateral": (pt.Lateral, {"strength": 0.1, "speed_exponent": 1.0, "spin_exponent": 1.0}),
        "Force": (pt.Force, {"constant": TWO, "torque": 0.1, "over_time": ""}),
        "Edge": (pt.Edge, {"point": TWO, "normal": TWO}),
        "Wall": (pt.Wall, {
            "point": TWO, "normal": TWO, "restitution": 0.5, "tangential": 0.0, "friction": 0.1}),
        "Constraint": (pt.Constraint, {
            "kind": "blade", "angle": 0.0, "reach": 0.0, "velocity": TWO, "side_slip": 0.1}),
        "Orthotropic": (pt.Orthotropic, {"friction": (0.1, 0.2), "direction": 0.1}),
        "Strips": (pt.Strips, {"borders": (0.0,), "friction": (0.1, 0.2), "direction": 0.1}),
        "Grip": (pt.Grip, {"over_time": ((0.0, 1.0), (1.0, 0.5)), "where": "floor"}),
        "Patch": (pt.Patch, {"friction": 0.1, "centre": TWO, "radius": 0.1, "corners": ()}),
        "Puck": (pt.Puck, {
            "radius": 0.03, "friction": 0.1, "name": "a", "colour": "", "launch": pt.Launch()}),
        "Arc": (pt.Arc, {
            "point": TWO, "radius": 0.1, "start": 0.0, "span": 1.0, "restitution": 1.0}),
        "Post": (pt.Post, {"point": TWO, "radius": 0.1, "restitution": 1.0, "tangential": -1.0}),
        "Pocket": (pt.Pocket, {"point": TWO, "radius": 0.1}),
        "Rim": (pt.Rim, {
            "puck": "a", "partner": "b", "restitution": 1.0, "tangential": 0.0, "friction": 0.1}),
    }  # fmt: skip
    return {
        **{f"pt.{name}": door for name, door in made.items()},
        "Scene": (pt.Scene, {
            "puck": puck(), "floor": pt.Floor(), "launch": pt.Launch(TWO), "drag": pt.Drag(),
            "lateral": pt.Lateral(), "force": pt.Force(), "pucks": (), "walls": (), "posts": (),
            "arcs": (), "pockets": (), "edges": (), "rims": (), "constraint": None,
            "time": 1.0, "frames": 3, "tol": 1e-6, "title": "", "ranges": {}}),
        "Scene.load": (pt.Scene.load, {"name": "incline"}),
        "Scene.from_tables": (pt.Scene.from_tables, {
            "tables": {"puck": {"radius": 1.0}}, "source": "a"}),
        "Scene.simulate": (scene().simulate, {"times": None}),
        "Scene.at": (scene().at, {"numbers": {"launch.spin": 1.0}}),
        "Scene.unit_of": (scene().unit_of, {"path": "launch.spin"}),
        "Scene.sample": (scene().sample, {
            "count": 3, "seed": 1, "spreads": {"launch.spin": pt.Normal(5.0, 0.1)}, "threads": 1,
            "chunk": 4, "progress": None, "cluster": None}),
        "Scene.sweep": (pt.Scene(puck(), launch=pt.Launch(TWO, [1.0, 2.0])).sweep, {
            "threads": 1, "chunk": 4, "progress": None, "cluster": None}),
        "board.simulate": (board().simulate, {"times": None}),
        "board.aim": (board().aim, {
            "target": (0.6, 0.0), "puck": "red", "striker": "cue", "pocket": None, "hits": None,
            "spin": None, "speed": None, "max_speed": None, "max_spin": None, "max_impacts": 1,
            "count": 2, "progress": None}),
        "rows_over_time": (pt.rows_over_time, {
            "function": lambda t: (t, 0.0, 0.0), "until": 1.0, "accuracy": 1e-3}),
        "World": (pt.World, {"scene": board()}),
        "World.at": (on_copy("at"), {"time": 0.1}),
        "World.over": (on_copy("over"), {"times": 0.0}),
        "World.advance": (on_copy("advance"), {"duration": 0.1}),
        "World.events_since": (on_copy("events_since"), {"time": 0.0}),
        "World.strike": (on_copy("strike"), {
            "puck": "cue", "velocity": TWO, "spin": 1.0, "impulse": (0.1, 0.0), "point": None}),
        "World.place": (on_copy("place"), {
            "puck": "cue", "position": (0.1, 0.1), "angle": 1.0, "velocity": TWO, "spin": 1.0}),
        "World.set_state": (on_copy("set_state"), {
            "states": [[0.0, 0.0, 0.0, 1.0, 0.0, 0.0], [0.3, *(0.0,) * 5]]}),
        "World.remove": (on_copy("remove"), {"puck": "cue"}),
        "World.add": (on_copy("add"), {
            "puck": pt.Puck(0.01, friction=0.1, launch=pt.Launch(position=(0.1, 0.4)))}),
        "World.drive": (lambda **given: led_world().copy().drive(**given), {
            "puck": "mallet", "velocity": TWO, "spin": 1.0}),
        "World.reaction": (lambda **given: led_world().copy().reaction(**given), {
            "puck": "mallet"}),
        "World.apply_force": (on_copy("apply_force"), {
            "puck": "cue", "force": (0.1, 0.0), "torque": 0.01, "duration": 0.1}),
    }  # fmt: skip


def _of_chetaev() -> dict[str, Door]:
    pendulum = chetaev.ConstrainedSystem(
        [1.0], lambda x, t: (np.array([[[0.0, 1.0]]]), np.zeros(1)), [(0.0, 0.0)]
    )
    asperity = RESULT_OF["asperity"]()
    return {
        "Asperity": (chetaev.Asperity, {
            "amplitude": 1e-6, "length": 1e-5, "load": 1.0, "mass": 0.1, "pull": 0.0}),
        "Asperity.height": (asperity.height, {"x": 1e-6}),
        "Asperity.incline": (asperity.incline, {"x": 1e-6}),
        "Asperity.multipliers": (asperity.multipliers, {"x": 1e-6, "speed": 0.1}),
        "Asperity.press": (asperity.press, {"x": 1e-6, "speed": 0.1}),
        "asperity_curve": (chetaev.asperity_curve, {
            "asperity": asperity, "speed": [0.001, 0.01], "progress": None}),
        "asperity_motion": (chetaev.asperity_motion, {
            "asperity": asperity, "x": 0.0, "speed": 0.01, "times": [0.0, 1e-4]}),
        "ConstrainedSystem": (chetaev.ConstrainedSystem, {
            "masses": [1.0], "constraints": pendulum.constraints, "force": [(0.0, 0.0)],
            "friction": 0.0, "rate": None}),
        "constrained_motion": (chetaev.constrained_motion, {
            "system": pendulum, "position": [(0.0, 0.0)], "velocity": [(1.0, 0.0)],
            "times": [0.0, 0.1], "tol": 1e-6, "until": None}),
        "patch_stop": (chetaev.patch_stop, {
            "velocity": TWO, "spin": 1.0, "rings": 1, "delta": 0.1, "decel": 1.0, "radius": 1.0,
            "tol": 1e-4}),
        "patch_system": (chetaev.patch_system, {
            "rings": 1, "delta": 0.1, "decel": 1.0, "radius": 1.0, "mass": 1.0}),
    }  # fmt: skip


@cache
def doors() -> dict[str, Door]:
    return _of_arrays() | _of_pucks() | _of_laws() | _of_scenes() | _of_chetaev()
