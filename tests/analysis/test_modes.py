"""A mode that there is not is an error with the nearest, wherever it is made; never another mode (rule S6)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

import rosprivacy
from rosprivacy.analysis.modes import Mode, Paths, View
from rosprivacy.ingest.policies.flow_graph import build
from rosprivacy.settings import Settings
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Callable

CARE_HOME = str(ROOT / "examples/care-home/care-home.policy.xml")
WRONG = {
    "Declared": (View, "--view: 'Declared' is none of declared, enforced; did you mean declared?"),
    "enforce": (View, "--view: 'enforce' is none of declared, enforced; did you mean enforced?"),
    "alle": (Paths, "--paths: 'alle' is none of witness, disjoint, all; did you mean all?"),
    "": (Paths, "--paths: '' is none of witness, disjoint, all; did you mean"),
}


@pytest.mark.parametrize("word", WRONG)
def test_a_word_that_is_no_mode_is_an_error_with_the_nearest(word: str) -> None:
    mode, message = WRONG[word]
    made: list[Callable[[Any], object]] = [mode]
    if mode is View:
        made += [
            lambda view: rosprivacy.analyze(CARE_HOME, view=view),
            lambda view: Settings(view=view),
            lambda view: build((), view),
        ]
    else:
        made += [lambda paths: rosprivacy.analyze(CARE_HOME, paths=paths), lambda paths: Settings(paths=paths)]
    for make in made:
        with pytest.raises(rosprivacy.InputErrors) as refused:
            make(word)
        assert str(refused.value).startswith(message)


def test_one_name_in_settings_made_by_hand_is_a_list_of_one() -> None:
    """It was read letter by letter."""
    for name in ("add", "categories", "data_types", "identity_factors", "ontologies"):
        one: dict[str, Any] = {name: "Video"}
        assert getattr(Settings(**one), name) == ("Video",)


@pytest.mark.parametrize("mode", [View, Paths])
def test_every_word_of_a_mode_is_taken(mode: type[Mode]) -> None:
    assert [mode(str(one)) for one in mode] == list(mode)
