"""Compiled friction of tall pucks against that by arrays, whose own judges are elsewhere."""

from __future__ import annotations

import numpy as np
import pytest

from puck_tables.contact import one_sided_resultants
from puck_tables.contact.laws import law_of
from puck_tables.errors import ContactError
from puck_tables.table.friction_section import friction_ratios, many_ratios
from puck_tables.table.singular_lines import tall_resultants

RNG = np.random.default_rng(11)


@pytest.mark.parametrize("delta", [1.0001, 1.16, 2.0, 3.4, 3.9, 3.9637])
def test_the_same_by_both_in_any_order(delta: float):
    """Neighbours, strangers, both ends, both sides of π/4 and of where contact opens."""
    quarter = 0.25 * np.pi
    near = (quarter + np.outer([-1.0, 1.0], 10.0 ** -np.arange(1.0, 15.0, 2.0))).ravel()
    phi = np.concatenate([
        [0.0, 1e-300, 1e-12, quarter, 0.5 * np.pi], near, RNG.uniform(0.0, 0.5 * np.pi, 30),
        np.linspace(0.0, 1.0, 40),
    ])  # fmt: skip
    truth = np.stack(one_sided_resultants(phi, delta))
    found = np.stack(tall_resultants(phi, delta))
    np.testing.assert_allclose(found, truth, rtol=0, atol=2e-13 if delta <= 3.9 else 5e-12)


def test_the_same_bits_however_many_threads(monkeypatch: pytest.MonkeyPatch):
    phi = np.linspace(0.0, 1.2, 500)
    first = np.stack(tall_resultants(phi, 3.0))
    monkeypatch.setattr("puck_tables._core.executor.usable_cores", lambda: 1)
    np.testing.assert_array_equal(np.stack(tall_resultants(phi, 3.0)), first)


def test_pucks_beyond_the_fold_are_refused_as_ever():
    with pytest.raises(ContactError, match="more than one solution"):
        tall_resultants(np.array([0.783]), 3.98)
    with pytest.raises(ContactError, match="tips"):
        tall_resultants(np.array([0.5]), 4.0)


@pytest.mark.parametrize(("name", "delta"), [("uniform", 0.7), ("ring", 0.5)])
def test_other_pucks_have_theirs_from_the_law(name: str, delta: float):
    phi = np.linspace(0.0, 0.5 * np.pi, 9)
    law = law_of(name)
    by_law, many = friction_ratios(law, phi, delta), many_ratios(law, phi, delta)
    np.testing.assert_array_equal(by_law, many)
