"""The pucks of a scene, what each is called, and where it begins."""

from __future__ import annotations

from puck_tables._core.arrays import FloatArray
from puck_tables.scene.pucks_and_posts import ScenePuck
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.world.paths import rows_of


def pucks_of(scene: SceneSpec) -> tuple[ScenePuck, ...]:
    """The pucks of a scene; a single one with its launch.

    >>> from puck_tables import Pocket, Puck, Scene
    >>> pucks_of(Scene(Puck(0.04), pockets=[Pocket((1.0, 0.0), 0.1)]))[0].radius
    0.04
    """
    if scene.pucks:
        return scene.pucks
    kept: dict[str, tuple[ScenePuck, ...]] = vars(scene)  # it is asked for often, and checked anew
    if "_pucks" not in kept:
        puck = scene.puck
        kept["_pucks"] = (
            ScenePuck(
                puck.radius, puck.height, puck.friction, puck.mass, puck.gravity, puck.pressure,
                puck.gyration, puck.base, launch=scene.launch, force=scene.force,
                constraint=scene.constraint,
            ),
        )  # fmt: skip
    return kept["_pucks"]


def called(puck: ScenePuck, number: int) -> str:
    """A puck in a message, a table and a legend.

    >>> from puck_tables import Puck
    >>> called(Puck(0.1, name="striker"), 3), called(Puck(0.1), 3)
    ('striker', 'puck 3')
    """
    return puck.name or f"puck {number}"


def names_of(scene: SceneSpec) -> tuple[str, ...]:
    """What all its pucks are called."""
    return tuple(called(puck, number) for number, puck in enumerate(pucks_of(scene)))


def who(scene: SceneSpec, number: int) -> str:
    """A puck of a scene in a sentence: the only one has no number.

    >>> from puck_tables import Puck, Scene
    >>> who(Scene(Puck(0.1)), 0)
    'the puck'
    """
    return called(scene.pucks[number], number) if scene.pucks else "the puck"


def start_of(puck: ScenePuck) -> tuple[float, float]:
    """Where a puck is at first."""
    if puck.path:
        rows = rows_of(puck.path)
        return float(rows[0, 1]), float(rows[0, 2])
    return puck.launch.position


def with_launch(scene: SceneSpec, number: int, launch: FloatArray) -> SceneSpec:
    """The scene with a launch vx, vy, spin (3,) of one of its pucks."""
    path = f"puck[{number}].launch" if scene.pucks else "launch"
    vx, vy, spin = launch.tolist()
    return scene.at({f"{path}.velocity": [vx, vy], f"{path}.spin": spin})
