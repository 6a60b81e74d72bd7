"""Every answer is what ``hashes.tsv`` says; ``python -m tests.golden`` writes a change that is wanted."""

from __future__ import annotations

import pytest

from tests.golden.__main__ import by_turns, differences, on_two_seeds


@pytest.mark.slow
def test_every_answer_is_as_it_was(*, thorough: bool) -> None:
    """Of a change each call on one of two seeds of Python's hashes; each week on both, as ``hashes.tsv`` is written."""
    assert differences(on_two_seeds() if thorough else by_turns()) == []
