"""Friction over the slip speed under every round load: tables, scenes, and what is refused."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from rarely import few, thorough
from scenes import end_of
from scipy.integrate import quad_vec

import puck_tables as pt
from puck_tables import CurlingLaw, SpeedLaw, StribeckLaw, Table, law_of, profile_law
from puck_tables.contact.base import Base
from puck_tables.contact.integrals import slip_direction
from puck_tables.contact.law_moments import law_moments, packed_law
from puck_tables.contact.round_load import load_of_law
from puck_tables.kernels.base_clipping import whole_contour
from puck_tables.kernels.base_friction import REACH, packed, under_load
from puck_tables.kernels.elliptic_sums import Ellipse
from puck_tables.kernels.law_sums import law_sums
from puck_tables.kernels.speed_quadrature_kernel import FINE
from puck_tables.table.speed_grid import patches_of, rays_under
from puck_tables.table.speed_patch import FilledPatch, truth_at
from puck_tables.table.speed_table import SpeedTable

ICE = CurlingLaw(0.02, 0.064, 0.06)
ROWS = SpeedLaw([0.0, 0.3, 0.7, 1.0, 3.0], [0.3, 0.2, 0.25, 0.25, 0.1])
PROFILE = profile_law([0.1, 0.4, 0.7, 1.0], [1.0, 2.0, 0.2, 0.8])
ALIKE = Ellipse(1.0, 1.0, 1.0, 0.0)
PRESSURES = ("ring", "galin", "hertz", "annulus:0.8", PROFILE)
# over ρ = sin θ: W ρ dρ as a function of θ, over dθ, up to a factor
WEIGHTS = {
    "uniform": lambda s, c: s * c, "galin": lambda s, c: s, "hertz": lambda s, c: s * c * c,
    "annulus:0.8": lambda s, c: s * c * (s > 0.8),
    PROFILE.name: lambda s, c: np.interp(s, *PROFILE.profile) * (s > 0.1) * s * c,
}  # fmt: skip
CUTS = {"annulus:0.8": [0.8], PROFILE.name: [0.1, 0.4, 0.7]}


@cache
def brute(f, name: str, phi: float, speed: float, reach: float = 1.0) -> np.ndarray:
    """Means of f times e_x, e_y x, e_x y, t = x e_y − y e_x and t y, by nested rules."""
    v, w = np.cos(phi), np.sin(phi)
    knots = np.asarray(f.speeds[1:-1]) / speed if isinstance(f, SpeedLaw) else np.empty(0)

    def around(rho: float) -> np.ndarray:
        def at(t: float) -> np.ndarray:
            x, y = rho * np.sin(t), rho * np.cos(t)
            ux, uy = v - w * y, w * x
            u = np.hypot(ux, uy)
            ex, ey = (ux / u, uy / u) if u > 0.0 else (0.0, 0.0)
            turn = x * ey - y * ex
            return float(f(speed * u)) * np.array([ex, ey * x, ex * y, turn, turn * y])

        with np.errstate(all="ignore"):
            cosine = (v * v + (w * rho) ** 2 - knots**2) / (2.0 * v * w * rho)
        marks = np.arccos(cosine[np.abs(cosine) < 1.0]).tolist()
        gap = min(abs(v - w * rho) / max(np.sqrt(v * w * rho), 1e-9), 1.0)
        points = [gap * 3.0**k for k in range(30) if 0.0 < gap * 3.0**k < 3.0]
        return quad_vec(at, 0.0, np.pi, points=[*points, *marks], epsabs=1e-9)[0] / np.pi

    if name == "ring":
        return around(reach)
    weight = WEIGHTS[name]
    radii = [v / max(w * reach, 1e-9), *CUTS.get(name, []), *((knots - v) / w / reach),
             *((v - knots) / w / reach), *((v + knots) / w / reach)]  # fmt: skip
    points = [float(np.arcsin(r)) for r in radii if 0.0 < r < 1.0]
    load = quad_vec(lambda q: weight(np.sin(q), np.cos(q)), 0.0, 0.5 * np.pi, points=points)[0]
    total = quad_vec(
        lambda q: weight(np.sin(q), np.cos(q)) * around(reach * np.sin(q)), 0.0, 0.5 * np.pi,
        points=points, epsabs=3e-8 * load,
    )[0]  # fmt: skip
    return np.asarray(total / load)


def named(pressure) -> str:
    return pressure if isinstance(pressure, str) else pressure.name


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("pressure", "law", "reach"),
    [
        ("ring", ROWS, 1.0), ("ring", ICE, 0.6), ("galin", ICE, 1.0), ("hertz", ROWS, 1.0),
        ("hertz", StribeckLaw(0.3, 0.1, speed=0.3, exponent=4.0), 1.0), ("annulus:0.8", ROWS, 0.7),
        ("annulus:0.8", ICE, 1.0), (PROFILE, ICE, 1.0), (PROFILE, ROWS, 1.0),
        ("uniform", ICE, 0.5),
    ],
)  # fmt: skip
def test_a_table_is_what_brute_force_says(pressure, law, reach):
    accuracy, top = 1e-5, 3.0
    table = Table.build(law, accuracy, top_speed=top, pressure=pressure, reach=reach)
    assert table.accuracy.worst <= accuracy
    rng = np.random.default_rng(5)
    rim = np.arctan(1.0 / reach)
    for phi in (0.2, 0.7, rim - 1e-3, rim + 0.02, 1.3):
        speed = top * float(rng.uniform(0.1, 1.0)) / (np.cos(phi) + np.sin(phi))
        truth, p = brute(law, named(pressure), phi, speed, reach), table.integrals(phi, speed)
        found = np.array([np.cos(phi), *[np.sin(phi)] * 3, np.cos(phi)]) * np.array(p)
        assert np.abs(found - truth).max() <= accuracy * law.largest(top)


@pytest.mark.parametrize(
    ("pressure", "accuracy"),
    [("ring", 1e-7), ("annulus:0.8", 1e-8), *(
        thorough(*case)
        for case in (("galin", 1e-6), ("hertz", 1e-6), (PROFILE, 1e-6), ("annulus:0.9995", 1e-6))
    )],
)  # fmt: skip
def test_a_constant_coefficient_is_that_of_the_pressure_at_every_height(pressure, accuracy):
    table = Table.build(SpeedLaw([0.0, 3.0], [0.4, 0.4]), accuracy, pressure=pressure)
    law = law_of(pressure) if isinstance(pressure, str) else pressure
    phi = np.linspace(-np.pi / 2, np.pi / 2, 401)
    weight = np.stack([np.cos(phi), np.sin(phi) * np.cos(phi), np.sin(phi)])
    for delta in (0.0, 0.5, 0.98 * law.delta_max):
        found = np.stack(table.resultants(phi, 2.0, delta / 0.4))
        error = weight * (found - 0.4 * np.stack(law.resultants(phi, delta)))
        assert np.abs(error).max() < 10.0 * accuracy
    with pytest.raises(pt.errors.ContactError, match="would lift"):
        table.resultants(phi, 2.0, 1.01 * law.delta_max / 0.4)
    with pytest.raises(pt.errors.ContactError, match="would lift"):
        table.refuse_height(1.01 * law.delta_max / 0.4)
    table.refuse_height(0.99 * law.delta_max / 0.4)


@pytest.mark.parametrize(
    ("law", "off", "inner", "outer"),
    [
        (ICE, 2e-8, 0.0, 0.4), (ROWS, 5e-6, 0.3, 1.0), thorough(ICE, 2e-8, 0.3, 1.0),
        thorough(ROWS, 5e-6, 0.0, 0.4), thorough(ICE, 2e-8, 0.383, 0.438),
        thorough(ROWS, 5e-6, 0.383, 0.438),
    ],
)  # fmt: skip
def test_under_an_annulus_it_is_the_sum_along_the_contour(law, off, inner, outer):
    """Whose panels do not end where the slip is that of a corner: 1e-6 is theirs."""
    base = Base.annulus(outer, inner) if inner else Base.disc(outer)
    pressure = f"annulus:{inner / outer!r}" if inner else "uniform"
    table = Table.build(law, 1e-8, top_speed=3.0, pressure=pressure, reach=outer)
    ends = np.append(np.asarray(law.speeds) if law is ROWS else [0.0, 0.064, 0.5], 3.0)
    shape = packed(base, 0.0)
    contour = packed_law(*law_moments(law, np.unique(ends)))
    rng = np.random.default_rng(2)
    phi = np.concatenate(
        [rng.uniform(0.0, np.pi / 2, 60), np.arctan(1.0 / outer) + np.array([1e-6, -1e-4])]
    )
    if inner:
        phi = np.append(phi, np.arctan(1.0 / inner) + np.array([1e-7, -1e-3]))
    for angle in phi.tolist():
        speed = 3.0 * float(rng.random()) / (np.cos(angle) + np.sin(angle))
        v, w = speed * np.cos(angle), speed * np.sin(angle)
        sums = law_sums(shape, *whole_contour(shape, 0), shape[REACH], contour, ALIKE, v, 0.0, w)
        x, _, turning = under_load(sums, 1.0 / base.area, 0.0, 0.0)
        rho = table.resultants(angle, speed)
        found = np.cos(angle) * float(rho.parallel), 0.5 * np.sin(angle) * float(rho.spin)
        assert np.abs(np.subtract(found, (x, turning))).max() < off * law.largest(3.0)


@pytest.mark.thorough
@pytest.mark.parametrize("pressure", few(2, ["annulus:0.8", PROFILE]))
def test_between_rays_the_order_is_that_of_the_splines(pressure):
    """A smooth law, all patches halved alike."""
    load = load_of_law(pressure, 1.0, ICE)
    breaks, rays = np.array([0.0, 0.3, 1.5]), rays_under(ICE, load)
    rng = np.random.default_rng(1)
    phi, share = rng.uniform(0.0, np.pi / 2, 600), rng.random(600) ** 0.5
    Q = 1.5 * share / (np.cos(phi) + np.sin(phi))
    direction = slip_direction(phi)
    weight = np.stack([np.cos(phi), np.sin(phi), np.sin(phi), np.cos(phi)])
    truth = np.moveaxis(truth_at(ICE, load, 1.5, direction, Q), -1, 0)
    errors = []
    for cells in (10, 20, 40):
        parts = [
            FilledPatch(patch, ICE, load, 1.0, n, FINE)
            for n, patch in enumerate(patches_of(breaks, 1, rays))
        ]
        for part in parts:
            part.cells = [cells, cells]
            part.fill()
        table = SpeedTable(
            np.concatenate([part.values.reshape(-1, 4) for part in parts]), breaks=breaks,
            cells=np.array([part.cells for part in parts]), law=ICE, pressure=load.law,
        )  # fmt: skip
        p = table.integrals(phi, Q)
        errors.append(np.abs(weight * (np.stack([p.a, p.b, p.d, p.e]) - truth)).max())
    assert (np.log2(np.array(errors[:-1]) / errors[1:]) > 3.9).all()


@pytest.mark.parametrize(
    ("law", "pressure"), [(ROWS, "annulus:0.5"), (ICE, "annulus:0.5"), (ROWS, "ring")]
)
def test_a_table_is_saved_with_its_pressure_and_judged(tmp_path, law, pressure):
    table = Table.build(law, 1e-4, top_speed=2.0, pressure=pressure, reach=0.9)
    again = Table.load(table.save(tmp_path / "law.h5").source)
    assert again.pressure == law_of(pressure) and again.reach == 0.9
    assert again.validate(points=100).passed
    phi = np.linspace(0.0, np.pi / 2, 50)
    assert np.array_equal(again.resultants(phi, 0.9).spin, table.resultants(phi, 0.9).spin)


def test_what_no_table_is_made_of():
    for law, how, message in (
        (lambda u: 0.2 + u, {"pressure": "ring", "top_speed": 1.0}, "not a function"),
        (ICE, {"pressure": "sponge", "top_speed": 1.0}, "no pressure law is called"),
        (ICE, {"reach": 1.5, "top_speed": 1.0}, "reach must be"),
        (ICE, {"pressure": replace(law_of("ring"), name="own"), "top_speed": 1.0}, "profile_law"),
    ):
        with pytest.raises(pt.InputError, match=message):
            Table.build(law, 1e-3, **how)
    with pytest.raises(pt.errors.AccuracyError, match="from 1e-09"):
        Table.build(ICE, 1e-11, pressure="ring", top_speed=1.0)


# Scenes

LAUNCH = pt.Launch(velocity=(0.9, 0.1), spin=20.0)


def end_under(puck: pt.Puck, law, **how) -> np.ndarray:
    return end_of(puck, pt.Floor(law=law), LAUNCH, **how)


@pytest.mark.parametrize("law", few(1, [ICE, ROWS.as_rows().tolist()]))
@pytest.mark.parametrize("height", [0.0, 0.06])
def test_a_band_is_a_base_of_its_contour_and_a_pressure(law, height):
    """The middle moved by a hair makes it a base of which friction is summed."""
    tol, known = 1e-6, {"height": height, "gyration": 0.05}
    band = end_under(pt.Puck(base=Base.annulus(0.06, 0.045), **known), law, tol=tol)
    summed = pt.Puck(base=Base.annulus(0.06, 0.045, centre=(1e-9, 0.0)), **known)
    assert end_under(summed, law, tol=tol) == pytest.approx(band, abs=5e-6)
    round_one = pt.Puck(radius=0.06, pressure="annulus:0.75", height=height, gyration=0.05 / 0.06)
    assert end_under(round_one, law, tol=tol) == pytest.approx(band, abs=5e-6)


def test_a_rim_around_the_band_changes_nothing():
    stone = pt.Puck(base="annulus:0.06x0.045", height=0.05, gyration=0.05)
    wide = pt.Puck(base="annulus:0.06x0.045", height=0.05, gyration=0.05, radius=0.14)
    assert end_under(wide, ICE) == pytest.approx(end_under(stone, ICE), abs=5e-6)


@pytest.mark.thorough
@pytest.mark.parametrize("pressure", few(2, ["ring", "hertz", "galin", PROFILE]))
def test_a_tall_puck_under_any_pressure_is_what_its_equations_say(pressure):
    """Its rates at the launch by brute force, and heat from the way that it takes."""
    puck = pt.Puck(radius=0.05, height=0.03, pressure=pressure, mass=0.3)
    scene = pt.Scene(puck, pt.Floor(law=ICE), launch=LAUNCH, tol=1e-4)
    run = scene.simulate()
    assert run.end == "at rest" and abs(run.energy_residual) < 1e-6  # steps are for that
    step = 1e-4
    close = scene.simulate([0.0, step, 2.0 * step])
    vx, vy = (-1.5 * v[0] + 2.0 * v[1] - 0.5 * v[2] for v in (close.vx, close.vy))
    speed, rim = float(np.hypot(*LAUNCH.velocity)), 0.05 * LAUNCH.spin
    phi, Q = float(np.arctan2(rim, speed)), float(np.hypot(speed, rim))
    a, b, _, d, _ = brute(ICE, named(pressure), phi, Q)
    mean = law_of(pressure).mean_square if isinstance(pressure, str) else pressure.mean_square
    g = 2.0 * 0.03 / 0.05 / (4.0 * mean)
    along = a / (1.0 - g * g * b * (b - d))  # F∥/N: the balance of moments
    across = g * along * b
    ex, ey = np.array(LAUNCH.velocity) / speed
    pull = -puck.gravity * np.array([along * ex - across * ey, along * ey + across * ex])
    assert np.array([vx, vy]) / step == pytest.approx(pull, abs=2e-3 * np.abs(pull).max())


def test_pucks_of_several_loads_slide_on_one_law_each_as_alone():
    kinds = [
        pt.Puck(0.05, launch=pt.Launch(position=(0.0, 0.0), velocity=(0.8, 0.0), spin=9.0)),
        pt.Puck(
            0.05, pressure="ring",
            launch=pt.Launch(position=(0.0, 1.0), velocity=(0.7, 0.0), spin=-5.0),
        ),
        pt.Puck(
            0.06, base="annulus:0.05x0.04", height=0.04,
            launch=pt.Launch(position=(0.0, 2.0), velocity=(0.8, 0.1), spin=9.0),
        ),
        pt.Puck(
            0.12, base="box:0.1x0.1",
            launch=pt.Launch(position=(0.0, 3.0), velocity=(0.8, 0.1), spin=9.0),
        ),
    ]  # fmt: skip
    floor = pt.Floor(law=CurlingLaw(0.02, 0.3, 0.1))
    together = pt.Scene(pucks=kinds, floor=floor).simulate()
    for n, kind in enumerate(kinds):
        alone = pt.Scene(pucks=[kind], floor=floor).simulate()
        for name in ("x", "y", "orientation"):
            assert together.last[name][n] == pytest.approx(alone.last[name][0], abs=1e-8)


def test_a_scene_says_what_its_pressure_does_not_allow():
    own = pt.Puck(radius=0.05, pressure=replace(law_of("ring"), name="own"))
    with pytest.raises(pt.InputError, match=r"floor.law: .*profile_law"):
        pt.Scene(own, pt.Floor(law=ICE), launch=LAUNCH).simulate()
    tall = pt.Puck(radius=0.05, pressure="ring", height=0.4)
    with pytest.raises(pt.errors.ContactError, match="would lift"):
        pt.Scene(
            tall, pt.Floor(law=CurlingLaw(0.02, 0.064, 0.1)), launch=LAUNCH, tol=1e-5
        ).simulate()
