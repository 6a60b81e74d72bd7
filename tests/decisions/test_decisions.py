"""The figures of ``figures.md``: decisions and keys from a policy to the answer of hand-made labels."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pytest

from rosprivacy.labelling.conversation import BY_ITSELF
from tests.decisions.counting import asked, by_hand
from tests.decisions.truths import care_home, entries, truths
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

PAGE = ROOT / "tests" / "decisions" / "figures.md"


def test_a_label_file_is_taken_apart_into_what_is_typed() -> None:
    text = (
        'labels: 1\nnodes:\n  /a: conduit  # why\n  /b:\n    leak: [Video]\nchannels:\n  "/c/*": mundane\n'
        "pins:\n  topics:\n    /c/d: [Video]\n"
    )
    assert [(one.section, one.name, one.keys) for one in entries(text)] == [
        ("nodes", "/a", 11), ("nodes", "/b", 16), ("channels", "/c/*", 15),
    ]  # fmt: skip


@pytest.mark.slow
def test_at_the_care_home_questions_come_to_the_same_answer_with_fewer_keys(tmp_path: Path) -> None:
    hand, (count, person) = by_hand(care_home()), asked(care_home(), tmp_path / "labels.yaml")
    assert count.same
    assert person.remarks == []
    assert count.decisions < hand.decisions
    assert 2 * count.keys < hand.keys


@pytest.mark.corpus
@pytest.mark.slow
def test_the_figures_of_the_page(corpus: Path, tmp_path: Path) -> None:
    page = PAGE.read_text("utf-8")
    for truth in truths(corpus, tmp_path):
        hand, (count, person) = by_hand(truth), asked(truth, tmp_path / "labels.yaml")
        assert count.same, truth.name
        assert all(remark.endswith(BY_ITSELF) for remark in person.remarks)
        row = [
            truth.name, f"{hand.decisions} ({hand.taking_away})", f"{count.decisions} ({count.taking_away})",
            f"{count.typed}", f"{hand.keys}", f"{count.keys}", f"{count.rows}", f"{count.judged}",
        ]  # fmt: skip
        assert re.search(re.escape(f"| {' | '.join(row)} |"), page), row
        if truth.name == "RMF office":
            told = f"{count.decisions} decisions and {count.keys} keys, in place of {hand.decisions} and {hand.keys:,}"
            assert told in (ROOT / "docs" / "suggestions.md").read_text("utf-8")
