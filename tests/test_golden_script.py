"""The golden file is what its script computes, and the script computes what it says."""

from __future__ import annotations

import importlib.util
import json
from pathlib import Path

import pytest
from mpmath import mp
from rarely import few

GOLDEN = Path(__file__).parent / "golden"


@pytest.fixture(scope="module")
def script():
    spec = importlib.util.spec_from_file_location("make_golden", GOLDEN / "make_golden.py")
    module = importlib.util.module_from_spec(spec)
    with mp.workdps(15):  # the script sets the precision of mpmath as it goes
        spec.loader.exec_module(module)
        yield module


def test_file_is_the_script_s(script):
    """Every value again, at two precisions and with the identities asserted on the way."""
    text = (GOLDEN / "resultants.json").read_text(encoding="utf-8")
    content = script.golden()
    assert json.loads(text) == content
    assert text == script.as_text(content)


@pytest.mark.parametrize("phi", few(1, [0.2, 1.1]))
def test_formulas_agree_with_the_defining_double_integrals(script, phi):
    direct, p = script.by_definition(phi), script.integrals(phi)
    for name in "abcde":
        assert abs(direct[name] - p[name]) <= 1e-17


def test_nothing_of_the_package_is_used():
    source = (GOLDEN / "make_golden.py").read_text(encoding="utf-8")
    assert "import puck_tables" not in source and "from puck_tables" not in source
