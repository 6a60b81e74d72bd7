"""What may be shown of anybody's text is decided in one module, and holds for any text."""

from __future__ import annotations

import ast

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.text import blanked, fit, one_line, printable, shortened
from tests.helpers.house import parsed
from tests.helpers.paths import ROOT

HERE = ROOT / "analysis" / "text.py"
FORMATS = {ROOT / "report" / "json_text.py": "Turtle and JSON escape in ways of their own"}
DANGEROUS = "\n\r\t\0\x1b\x7f\x85\x9b\u2028\u2029\u202a\u202e\u2066\u2069\u200f\ufeff\udc80"


@given(st.text(st.one_of(st.characters(), st.sampled_from(DANGEROUS)), max_size=300))
def test_nothing_unprintable_is_shown(text: str) -> None:
    for way in (printable, blanked, shown, fit, one_line, lambda text: shortened(text, 20)):
        assert way(text).isprintable()


@given(st.text(max_size=5_000))
def test_nothing_endless_is_shown(text: str) -> None:
    assert len(shown(text)) <= 201
    assert len(fit(text)) <= 165
    assert len(one_line(text)) <= 2_001
    assert len(shortened(text, 20)) <= 20


@pytest.mark.xdist_group("house")
def test_what_is_unprintable_is_replaced_in_one_module() -> None:
    """Others may refuse such text; to make it printable is here."""
    replacing = set()
    for room in ("analysis", "ingest", "ontology", "queries", "report", "src/rosprivacy"):
        for file in (ROOT / room).rglob("*.py"):
            if "isprintable" not in file.read_text("utf-8"):
                continue
            chosen = [node.test for node in ast.walk(parsed(file.resolve())) if isinstance(node, ast.IfExp)]
            if any("isprintable" in ast.unparse(test) for test in chosen):
                replacing.add(file.resolve())
    assert replacing == {HERE, *FORMATS}
