"""The labelled set is whole and split before rules are tuned, and what is suggested keeps to it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from rosprivacy.analysis.suggesting.evidence import ANYTHING
from rosprivacy.ontology.vocabulary import load
from tests.helpers.paths import ROOT
from tests.labelled.labelled_set import (
    DERIVES,
    KINDS,
    LEAK,
    READERS,
    SOURCE,
    TUNED,
    Pair,
    answers,
    judged,
    kappa,
    labelled,
    met,
    said,
    systems,
)
from tests.labelled.measuring import LOOKS, Share, measured, policy_text, table, types_text

if TYPE_CHECKING:
    from pathlib import Path

STATEMENTS = 300  # that the readers made together


def test_the_split_is_by_batch() -> None:
    dev, held_out = systems()
    assert {one.batch for one in dev} == set(TUNED)
    assert held_out
    assert not {one.batch for one in held_out} & set(TUNED)


def test_what_is_held_out_is_of_other_people() -> None:
    owners = [{one.repository.partition("/")[0].lower() for one in part} for part in systems()]
    assert not owners[0] & owners[1]
    assert len(owners[1]) == len(systems()[1])


def test_readers_answered_for_whole_batches_both() -> None:
    """A batch that nobody labelled yet breaks nothing; one that is labelled in part, or by one reader, does."""
    every = [one for part in systems() for one in part]
    read = labelled(every)
    assert {one.batch for one in read} >= set(TUNED)
    assert not {one.batch for one in read} & {one.batch for one in every if one not in read}
    for reader in READERS:
        assert set(answers(reader)) == {one.name for one in read}


def test_each_reader_answered_for_each_node_with_known_kinds() -> None:
    every = labelled(one for part in systems() for one in part)
    readers = [said(reader, every) for reader in READERS]
    assert {pair.kind for some in readers for pair in some if pair.role != LEAK} <= KINDS <= set(load().categories)
    assert sum(map(len, readers)) >= STATEMENTS


def test_readers_agree_far_more_than_by_chance() -> None:
    assert kappa(labelled(one for part in systems() for one in part)) > 0.5


def test_kinds_that_cover_each_other_agree() -> None:
    overlaps = load().hierarchy.overlaps
    image, depth, voice = (Pair("s", "/n", "source", kind) for kind in ("PersonImage", "DepthImage", "Voice"))
    assert met(depth, [image], overlaps)
    assert not met(voice, [image], overlaps)
    assert not met(image._replace(node="/m"), [image], overlaps)


def test_the_broadest_kind_finds_nothing() -> None:
    """Who says of every node that it brings in some personal data has said nothing."""
    overlaps = load().hierarchy.overlaps
    voice, anything = (Pair("s", "/n", "source", kind) for kind in ("Voice", ANYTHING))
    assert not met(voice, [anything], overlaps)
    assert not met(anything, [voice], overlaps)


def test_what_is_missed_is_agreed_and_not_suggested(tmp_path: Path) -> None:
    one = next(system for part in systems() for system in part if system.name == "facerec_pkg")
    found, truth = measured([one], LOOKS[-1], tmp_path), judged([one], load().hierarchy.overlaps)
    assert set(found.missed) <= truth.agreed
    assert len(found.missed) == sum(share.of - share.part for share in found.recall.values()) == found.unseen.of > 0


def test_a_source_that_is_found_is_asked_about_and_one_of_that_kind_is_found(tmp_path: Path) -> None:
    """A broader kind finds it, any kind asks about it."""
    for one in systems()[0][:5]:
        found = measured([one], LOOKS[0], tmp_path)
        shares = [found.by_that_kind, found.recall["source"], found.asked_about]
        assert sorted(share.part for share in shares) == [share.part for share in shares]
        assert {share.of for share in shares} == {found.asked_about.of}


@pytest.mark.slow
def test_what_is_disputed_counts_neither_way() -> None:
    every = labelled(one for part in systems() for one in part)
    truth = judged(every, load().hierarchy.overlaps)
    assert not truth.agreed & truth.disputed
    assert truth.agreed | truth.disputed == said("reader_a", every) | said("reader_b", every)


def test_wilson_is_wilson() -> None:
    low, high = Share(9, 10).interval()
    assert (round(low, 3), round(high, 3)) == (0.596, 0.982)
    assert Share(0, 0).interval() == (0.0, 1.0)


def test_systems_become_policies_and_types() -> None:
    dev, _ = systems()
    one = next(system for system in dev if system.name == "Medi-Buddy")
    assert "<topic>/scan_raw</topic>" in policy_text(one)
    assert "  /scan_raw: {types: [sensor_msgs/msg/LaserScan]}" in types_text(one)


@pytest.mark.slow
def test_what_is_suggested_of_all_systems_that_rules_may_be_tuned_on(tmp_path: Path) -> None:
    """What is held out is measured by hand, once rules are tuned.

    ``certain`` is never wrong; all that is looked at finds more sources than types alone, and than names alone; and
    figures.md tells all figures, docs/suggestions.md those that a reader needs.
    """
    looks = {look.name: measured(systems()[0], look, tmp_path) for look in LOOKS}
    assert {name: found.wrong["certain"] for name, found in looks.items() if found.wrong["certain"]} == {}
    sources = {name: found.recall["source"].part for name, found in looks.items()}
    assert sources["everything"] >= max(sources["types alone"], sources["names alone"])
    assert table(looks) in (ROOT / "tests" / "labelled" / "figures.md").read_text("utf-8")
    page = (ROOT / "docs" / "suggestions.md").read_text("utf-8")
    found, without_code = looks["everything"], looks["without code"]
    for shares, name, word in (
        (found.precision, "likely", "`likely`"), (found.precision, "may", "`may`"),
        (found.recall, SOURCE, "sources"), (found.recall, DERIVES, "derivations"), (found.recall, LEAK, "leaks"),
    ):  # fmt: skip
        assert f"{shares[name].part} of {shares[name].of} {word}" in page
    fewer = (without_code.recall[role].part for role in (SOURCE, DERIVES, LEAK))
    assert "without code {}, {} and {}.".format(*fewer) in page
