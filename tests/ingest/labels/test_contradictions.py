"""Labels of one rank that contradict each other."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

import rosprivacy
from rosprivacy.analysis.errors import InputErrors
from rosprivacy.ingest.labels.label_file import read_labels
from rosprivacy.ontology.vocabulary import load

if TYPE_CHECKING:
    from pathlib import Path

from tests.helpers.label_files import SYSTEM, VIDEO, analyse, wrong

TWO = ("1.yaml:3", "2.yaml:3")


def both(text: str, *values: str) -> list[str]:
    """A label file for each value."""
    return [text % value for value in values]


@pytest.mark.parametrize(
    ("labels", "places"),
    [
        # in two files, and in one file by globs of the same rank
        (["nodes:\n  /filter: {leak: [Video]}", "\nnodes:\n  /filter: {conduit: [Video]}"], ("1.yaml:3", "2.yaml:4")),
        (["nodes:\n  '/fil*': {leak: [Video]}\n  '*lter': {conduit: [Video]}"], ("1.yaml:3", "1.yaml:4")),
        # S10: source and sanitizer of one category
        (["nodes:\n  /filter:\n    source: [Video]\n    sanitizer: {Video: drop}"], ("1.yaml:4", "1.yaml:5")),
        (["nodes:\n  /filter:\n    source: [Video]\n    conduit: [Video]"], ("1.yaml:4", "1.yaml:5")),
        (["nodes:\n  /filter:\n    sanitizer: [Video]\n    conduit: [Video]"], ("1.yaml:4", "1.yaml:5")),
        # one sanitizer, two methods; one source, through one channel and through all
        (both("nodes:\n  /filter: {sanitizer: {Video: %s}}", "drop", "anonymise"), TWO),
        (both("nodes:\n  /filter: {sanitizer: %s}", "{Video: drop}", "[Video]"), TWO),
        (both("nodes:\n  /filter: {source: %s}", "{Video: [/clean]}", "[Video]"), TWO),
        (both("channels:\n  /image: {only: [%s]}", "Video", "Voice"), TWO),
        # S7: `never` of the same or a broader kind than an `only` names
        (["channels:\n  /image:\n    only: [Video]\n    never: [PersonImage]"], ("1.yaml:4", "1.yaml:5")),
        (both("flows:\n  - {from: /camera, to: /image, only: [%s]}", "Video", "Voice"), TWO),
    ],
)
def test_labels_of_one_rank_that_contradict_each_other_are_refused_with_both_lines(
    tmp_path: Path, labels: list[str], places: tuple[str, str]
) -> None:
    found = wrong(tmp_path, *[f"labels: 1\n{text}" for text in labels], VIDEO)
    about_video = [line for line in found if "Video" in line]
    assert about_video
    for line in about_video:
        assert line.startswith(f"{places[1]}: ")
        assert f" at {places[0]}; " in line


@pytest.mark.parametrize(
    "labels",
    [
        ["channels:\n  /image: mundane", "channels:\n  /image: sensitive"],
        ["channels:\n  /image: mundane\ntopics:\n  /image: sensitive"],
        ["channels:\n  /image: mundane", "channels:\n  /image: {only: [Video]}"],
    ],
)
def test_a_contradiction_about_every_category_is_one_problem(tmp_path: Path, labels: list[str]) -> None:
    (line,) = wrong(tmp_path, *[f"labels: 1\n{text}" for text in labels])
    first, second = ("1.yaml:3", "2.yaml:3") if len(labels) > 1 else ("1.yaml:3", "1.yaml:5")
    assert line.startswith(f"{second}: ")
    assert f" at {first}; " in line


@pytest.mark.parametrize(
    "labels",
    [
        ["nodes: {/filter: {leak: [Video]}}", "nodes: {/filter: {leak: [Video]}}"],  # the same twice
        ["nodes: {/filter: {source: [Video], leak: [Video]}}"],  # S10: a finding by itself, not a contradiction
        ["nodes: {/filter: {leak: [Video], sanitizer: {Video: drop}}}"],  # lets it out, but passes nothing on
        ["nodes: {/filter: {leak: [Video], conduit: [Voice]}}"],
        ["channels: {/image: {only: [Video], never: [Voice]}}"],
        ["nodes: {/filter: conduit}", "channels: {/clean: mundane}"],
        ["channels: {/image: sensitive, /clean: mundane}"],
        ["nodes: {/filter: conduit}", "nodes: {/filter: {leak: [Video]}}"],  # S7: the nearest in the hierarchy wins
        ["channels: {/image: sensitive}", "channels: {/image: {never: [Video]}}"],
        ["channels: {'/ima*': sensitive, '*mage': {sensitive: [Video]}}"],  # S7: these say the same
        ["channels: {/image: sensitive}", "channels: {/image: sensitive}"],
        ["channels: {/image: {only: [Video]}}", "channels: {/image: {sensitive: [Video]}}"],
        ["channels: {/image: {only: [PersonImage], never: [Video]}}"],
    ],
)
def test_labels_that_agree_are_no_contradiction(tmp_path: Path, labels: list[str]) -> None:
    analyse(tmp_path, *[f"labels: 1\n{text}" for text in labels], VIDEO)


@pytest.mark.parametrize(
    ("channels", "carries"),
    [
        ("{'/ima*': {never: [PersonImage]}, /image: {only: [Video]}}", True),
        ("{'/ima*': {only: [Video]}, /image: {never: [PersonImage]}}", False),
        ("{/image: {only: [PersonImage], never: [Video]}}", False),  # the nearer
        ("{/image: {only: [Location], never: [ContactData]}}", True),  # an address is of both: a tie lets through
    ],
)
def test_of_only_and_never_the_higher_decides_then_the_nearer(tmp_path: Path, channels: str, carries: bool) -> None:  # noqa: FBT001
    """Rule S7."""
    kind = "PostalAddress" if "Location" in channels else "Video"
    source = f"labels: 1\nnodes: {{/camera: {{source: [{kind}]}}}}"
    result = analyse(tmp_path, source, f"labels: 1\nchannels: {channels}")
    assert ("/image" in {one.element.name for one in result.carried}) == carries


def test_every_contradiction_is_reported_at_once(tmp_path: Path) -> None:
    text = """labels: 1
nodes:
  /camera: {source: [Video], sanitizer: {Video: drop}}
  /filter: {leak: [Voice], conduit: [Voice]}
"""
    assert [line.split(": ")[0] for line in wrong(tmp_path, text)] == ["1.yaml:3", "1.yaml:4"]


def test_a_file_that_the_user_names_is_his_own_even_if_it_is_the_standard_one(tmp_path: Path) -> None:  # S11
    (tmp_path / "s.yaml").write_text("labels: 1\ntopics: {/none: mundane}")
    (tmp_path / "p.xml").write_text(SYSTEM)
    with pytest.raises(InputErrors, match="matches no topic"):
        rosprivacy.analyze(
            [str(tmp_path / "p.xml")], [str(tmp_path / "s.yaml")], standard_channels=str(tmp_path / "s.yaml")
        )


def test_the_report_lists_such_a_file_among_the_labels(tmp_path: Path) -> None:  # S12: what the answer rests on
    (tmp_path / "s.yaml").write_text("labels: 1\nnodes: {/camera: conduit}")
    (tmp_path / "p.xml").write_text(SYSTEM)
    file = str(tmp_path / "s.yaml")
    assumed = rosprivacy.analyze([str(tmp_path / "p.xml")], [file], standard_channels=file).document()["assumptions"]
    assert [label["file"] for label in assumed["labels"]] == [file]
    assert assumed["standard_channels"] is None


def test_a_former_spelling_of_dpv_is_read_with_a_notice(tmp_path: Path) -> None:
    file = tmp_path / "l.yaml"
    file.write_text("labels: 1\nnodes:\n  /a: {leak: [pd:Behavioral]}\n")
    found = read_labels(str(file), load())
    assert [s.categories for entry in found.entries for s in entry.statements] == [("Behaviour",)]
    (notice,) = found.diagnostics
    assert "pd:Behavioral is a former spelling; DPV spells it https://w3id.org/dpv/pd#Behavioural" in notice.message
