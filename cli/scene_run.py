"""Scenes behind ``puck simulate`` and ``puck sweep``: options as numbers of one."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import click
from puck_tables.cli.options import DEFAULT_DECEL, DEFAULT_DELTA, SCALED, packed, real_numbers
from puck_tables.cli.values import scenes

from puck_tables.errors import InputError


@dataclass(frozen=True)
class SceneChoice:
    """A scene, and numbers in it."""

    scene: str | None
    changes: tuple[str, ...]

    def __bool__(self) -> bool:
        return self.scene is not None or bool(self.changes)

    @property
    def name(self) -> str:
        """Which file refusals name."""
        return self.scene or "scene"

    def reads(self, tables: dict[str, Any]) -> list[str]:
        """The files that a run reads: that of the scene, and those that it names."""
        from puck_tables._core.digest import files_named

        return [*([] if self.scene is None else [self.scene]), *files_named(tables)]


scene_options = packed(
    "chosen", SceneChoice,
    click.option("--scene", metavar="FILE|NAME", shell_complete=scenes, help="A scene file, or one "
                 "that comes along (see 'puck scene list'); other options change its numbers."),
    click.option("--set", "changes", multiple=True, metavar="PATH=VALUE", help="A number of the "
                 "scene, like floor.slope=0.1, wall[0].restitution=0.8 or "
                 "puck[0].launch.velocity=[1,0]; as often as needed."),
)  # fmt: skip

PATHS = {
    "v0": "launch.velocity", "w0": "launch.spin", "speed": "launch.velocity[0]",
    "base": "puck.base", "radius": "puck.radius", "height": "puck.height",
    "mass": "puck.mass", "friction": "puck.friction", "gyration": "puck.gyration",
    "gravity": "gravity", "frames": "frames", "tol": "tol",
}  # fmt: skip
KEPT = (
    "times", "explain", "as_json", "output", "plot", "movie", "overwrite", "threads", "cluster",
    "random", "seed", "spreads", "regions",
)  # fmt: skip
INSTEAD = {  # of options that no scene has
    **dict.fromkeys(SCALED, "puck.height and puck.friction set it"),
    "heading": "launch.velocity has it", "pressure": "--set puck.pressure=NAME has it",
}  # fmt: skip


def scene_tables(
    ctx: click.Context, chosen: SceneChoice, own: tuple[str, ...] = (),
    scattering: Iterable[str] = (),
) -> dict[str, Any]:  # fmt: skip
    """The scene that options describe: a file or defaults, then options, then --set.

    ``own``: parameters of the command that are no numbers of the scene; ``scattering``: numbers of
    it that --spread gives.
    """
    from puck_tables.scene.entries import set_path
    from puck_tables.scene.library import find_scene

    scene, source = chosen.scene, click.core.ParameterSource.DEFAULT
    fields = {
        name: value
        for name, value in ctx.params.items()
        if ctx.get_parameter_source(name) is not source
        and name not in ("scene", "changes", *KEPT, *own)
    }
    tables = _default_tables(fields) if scene is None else find_scene(scene)
    named = dict.fromkeys(scattering, "--spread")
    for name, value in fields.items():
        if name in SCALED and scene is None:
            continue
        flag = next(p.opts[0] for p in ctx.command.params if p.name == name)
        if name not in PATHS:
            hint = f" ({_of_each(tables, INSTEAD[name])})" if name in INSTEAD else ""
            raise InputError(f"{flag} has no place in a scene{hint}: leave it out")
        _refuse_one_for_all(tables, flag, PATHS[name], _as_text(value))
        if PATHS[name] in named:
            raise InputError(f"--{name} and --spread {PATHS[name]} clash: both give it")
        named[PATHS[name]] = f"--{name}"
        if name == "gravity":  # in place of what pucks of the file have
            pucks = tables.get("puck", {})
            for puck in pucks if isinstance(pucks, list) else [pucks]:
                puck.pop("gravity", None)
        set_path(tables, PATHS[name], _as_toml(value))
    for change in chosen.changes:
        path, equals, text = change.partition("=")
        if not equals or not text:
            raise InputError(f"--set {change}: write PATH=VALUE, like floor.slope=0.1")
        path = path.strip()
        _refuse_one_for_all(tables, f"--set {path}", path, text.strip())
        clash = named.get(path) or named.get(path.partition("[")[0])
        if clash is not None:
            raise InputError(f"{clash} and --set {path} clash: both give {path}")
        named[path] = "--set"
        set_path(tables, path, _value(text.strip()))
    return tables


def _refuse_one_for_all(tables: dict[str, Any], flag: str, path: str, value: str) -> None:
    """Refuse a number of the only puck where there are several."""
    pucks, own = tables.get("puck"), _of_each(tables, path)
    if isinstance(pucks, list) and path == "puck.gravity":
        raise InputError(f"{flag}: all pucks of a scene have its gravity: write --gravity {value}")
    if isinstance(pucks, list) and own != path:
        last = len(pucks) - 1
        more = f", and so on to puck[{last}] for all of them" if last > 0 else ""
        raise InputError(
            f"{flag} is for a scene of one puck, and here each has its own: write "
            f'--set "{own}={value}" for the first{more}'
        )


def _of_each(tables: dict[str, Any], words: str) -> str:
    """Paths of a puck or its launch as a scene of several pucks has them, of the first."""
    if not isinstance(tables.get("puck"), list):
        return words
    return re.sub(r"\b(?<!\.)(puck(?=\.)|launch\b)", _first_of, words)


def _first_of(matched: re.Match[str]) -> str:
    return "puck[0]" if matched[1] == "puck" else "puck[0].launch"


def _as_text(value: Any) -> str:
    """An option's value as --set takes it."""
    written = _as_toml(value)
    if isinstance(written, list):
        return f"[{','.join(f'{number:.12g}' for number in written)}]"
    return f"{written:.12g}" if isinstance(written, float) else str(written)


def _default_tables(fields: dict[str, Any]) -> dict[str, Any]:
    """The puck in natural units of the other commands, as dimensions: f = J/g, h = δ r/2f."""
    from puck_tables.motion.body import STANDARD_GRAVITY

    real = real_numbers(fields)
    launch = {"velocity": [0.0, 0.0]}
    if "base" in fields:
        own = {} if "friction" in fields else {"friction": 1.0}
        more = {} if real else {"gravity": fields.get("decel", DEFAULT_DECEL)}
        return {"puck": own, "launch": launch, **more}
    tables: dict[str, Any] = {"puck": {"radius": 1.0}, "launch": launch}
    if real:
        return tables
    for name in SCALED:
        if isinstance(fields.get(name), tuple | list):
            raise InputError(f"--{name} cannot range in a scene: let puck.height range (--set)")
    radius = fields.get("radius", 1.0)
    if isinstance(radius, tuple | list) or not radius > 0.0:
        raise InputError("--radius must be a number greater than 0 m")
    friction = fields.get("decel", DEFAULT_DECEL) / STANDARD_GRAVITY
    if not friction > 0.0:
        raise InputError("--decel must be greater than 0 m/s^2")
    tables["puck"]["friction"] = friction
    tables["puck"]["height"] = fields.get("delta", DEFAULT_DELTA) * radius / (2.0 * friction)
    return tables


def _as_toml(value: Any) -> Any:
    """An option's value as a scene file would have it: ranges as text, vectors as lists."""
    if isinstance(value, tuple) and len(value) == 3:
        return f"{value[0]!r}:{value[1]!r}:{value[2]}"
    return list(value) if isinstance(value, tuple) else value


def _value(text: str) -> Any:
    """A value of --set: TOML, or else a text such as a range."""
    from puck_tables.scene.library import toml_in

    try:
        return toml_in(f"value = {text}")["value"]
    except (ValueError, KeyError, RecursionError):
        pass
    listed = text.removeprefix("[").removesuffix("]").split(",")  # 0,10,20 or [3cm,4cm]
    if len(listed) > 1 and all(re.match(r"\s*[-+]?\.?[0-9]", one) for one in listed):
        return [_value(one.strip()) for one in listed]
    return text
