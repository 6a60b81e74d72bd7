"""What pages share from one answer to the next changes no byte of them, and no suggestion."""

from __future__ import annotations

from random import Random
from typing import TYPE_CHECKING

import pytest

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.explorer.edits import element_id
from rosprivacy.explorer.questions import questions
from rosprivacy.explorer.web.application import Site
from rosprivacy.explorer.web.standing import Standing
from rosprivacy.labelling.knowledge import what_is_known
from rosprivacy.labelling.suggesting import suggested_by
from rosprivacy.labelling.suggesting_on_demand import Suggester
from rosprivacy.report.catalogs.words import Words
from rosprivacy.report.document.analysis import label_key
from rosprivacy.settings import Settings
from tests.helpers.explorers import FACTORY, Explorer, copied

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from rosprivacy.explorer.session import Session

    Explore = Callable[..., Explorer]

CARE_HOME = FACTORY.parent / "care-home"
SYSTEMS = {
    "factory": (FACTORY / "before.policy.xml", FACTORY / "run2.labels.yaml"),
    "care-home": (CARE_HOME / "care-home.policy.xml", CARE_HOME / "care-home.labels.yaml"),
}
KINDS = ("Video", "Voice", "Location")
EDITS, ROLES = 8, ("conduit", "source", "leak", "undo", "unlabel", "types")


def edit(session: Session, random: Random) -> None:
    """One edit at random: some are refused, and change nothing."""
    element = random.choice(session.result.analysis.graph.elements)
    key, role = label_key(element), random.choice(ROLES)
    try:
        if role == "undo":
            session.undo()
        elif role == "unlabel":
            session.unlabel(key["name"], kind=key["section"])
        elif element.is_node:
            session.label(
                key["name"], **{"conduit": True} if role in ("conduit", "types") else {role: [random.choice(KINDS)]}
            )
        elif role == "types":
            session.label(key["name"], kind=key["section"], types=["sensor_msgs/msg/Image"])
        else:
            session.label(key["name"], kind=key["section"], never=[random.choice(KINDS)])
    except InputErrors:
        pass


@pytest.mark.slow
@pytest.mark.parametrize("system", SYSTEMS)
@pytest.mark.parametrize("seed", range(2))
def test_a_page_is_the_same_to_the_byte_whatever_was_shown_before(
    system: str, seed: int, explore: Explore, tmp_path: Path
) -> None:
    policy, labels = SYSTEMS[system]
    explorer, random = explore(policy, copied(labels, tmp_path)), Random(seed)  # noqa: S311 - repeatable
    for _ in range(EDITS):
        edit(explorer.session, random)
        at = element_id(random.choice(explorer.session.result.analysis.graph.elements).identity)
        fresh = Site(explorer.session, Settings(), Words("en"), explorer.door)
        for query in ("", f"at={at}", "hide=Video", "draw=all"):
            assert explorer.site._page(query).body == fresh._page(query).body
        fresh.close()


@pytest.mark.parametrize("system", SYSTEMS)
@pytest.mark.parametrize("seed", range(3))
def test_suggestions_for_an_element_are_those_that_are_made_for_all(
    system: str, seed: int, explore: Explore, tmp_path: Path
) -> None:
    policy, labels = SYSTEMS[system]
    session, random = explore(policy, copied(labels, tmp_path)).session, Random(seed)  # noqa: S311 - repeatable
    known = what_is_known(session.result.vocabulary, Settings())
    suggester, told = Suggester(known), 0
    for _ in range(EDITS):
        edit(session, random)
        standing = Standing(session, suggester)
        every = suggested_by(known, session.result).proposals
        told += len(every)
        for element in standing.elements.values():
            of_it = tuple(one for one in every if one.label.element.identity == element.identity)
            assert standing.suggestions.of(element.identity) == of_it
        for roles in (("source",), ("source", "leak")):
            order = dict.fromkeys(one.label.element.identity for one in every if one.label.role in roles)
            whole = tuple(tuple(one for one in every if one.label.element.identity == at) for at in order)
            assert standing.suggestions.of_role(*roles) == whole
        assert questions(session.result, order=standing.order) == session.questions()
    assert told
