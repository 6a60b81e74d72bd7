"""Every answer is what ``hashes.tsv`` says; ``python -m tests.golden`` writes a change that is wanted."""

from __future__ import annotations

import pytest

from tests.golden.__main__ import differences, on_two_seeds


@pytest.mark.slow
def test_every_answer_is_as_it_was() -> None:
    assert differences(on_two_seeds()) == []
