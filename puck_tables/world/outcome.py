"""How the pucks of a scene are moved, in words."""

from __future__ import annotations

from puck_tables.scene.parts import Drag, Force
from puck_tables.scene.pieces import PieceSpec
from puck_tables.scene.plan import EMPIRICAL
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.world.agreement import (
    TABLE_ERROR,
    called,
    flight_error,
    frictions_under,
    has_closed_forms,
    is_integrated,
    pieces_of,
)

_NAMED = 6  # pucks of one way


def ways_of(scene: SceneSpec) -> str:
    """How the pucks of a scene are moved, a line for each way, and which they are.

    Examples
    --------
    >>> from puck_tables import Piece, Scene
    >>> ways_of(Scene(pucks=[Piece(0.1, friction=0.1)]))
    '1 puck looked up from impact to impact'
    """
    pieces = pieces_of(scene)
    ways: dict[str, list[str]] = {}
    for number, piece in enumerate(pieces):
        ways.setdefault(_way_of(scene, piece), []).append(called(piece, number))
    lines = []
    for way, names in ways.items():
        shown = ""
        if len(ways) > 1:
            more = f" and {len(names) - _NAMED} more" if len(names) > _NAMED else ""
            shown = f" ({', '.join(names[:_NAMED])}{more})"
        lines.append(f"{len(names)} puck{'s' if len(names) != 1 else ''} {way}{shown}")
    if scene.lateral.strength != 0.0:
        lines.append(EMPIRICAL)
    return "\n".join(lines)


def _way_of(scene: SceneSpec, piece: PieceSpec) -> str:
    """How a puck is moved, and why it is not looked up."""
    if piece.path:
        return "driven along a path"
    floor, frictions = scene.floor, frictions_under(scene, piece)
    integrated = [is_integrated(scene, piece, friction) for friction in frictions]
    if any(integrated):
        acts = {
            piece.constraint.kind if piece.constraint else "": piece.constraint is not None,
            "slope": floor.slope > 0.0,
            "turntable": floor.turning != 0.0,
            "force": piece.force != Force(),
            "drag": scene.drag != Drag(),
            "lateral force (empirical)": scene.lateral.strength != 0.0,
            "friction law": bool(floor.law),
            "orthotropic friction": floor.orthotropic is not None,
            "no closed forms": not all(has_closed_forms(piece, one) for one in frictions),
            f"tol below the {TABLE_ERROR:g} of tables": flight_error(scene) < TABLE_ERROR,
        }
        what = ", ".join(name for name, there in acts.items() if there)
        where = "" if all(integrated) else " on some of the floor"
        return f"integrated from impact to impact{where}: {what}"
    if not any(frictions):
        return "in closed form, without dry friction"
    way = "looked up from impact to impact"
    if floor.strips is not None or floor.patches:
        way = "looked up from impact or border to the next, integrated where astride"
    return f"{way}, over the belt" if any(floor.velocity) else way
