"""A channel that is reviewed for some kinds, ``{sensitive: [Video]}``, as ``conduit: [Video]`` of nodes (S7, S11)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import jsonschema
import pytest
import yaml

import rosprivacy
from rosprivacy.analysis.errors import InputErrors
from rosprivacy.ingest.labels.label_schema import label_schema
from rosprivacy.ontology.vocabulary import load
from tests.helpers.fleet_files import policy

if TYPE_CHECKING:
    from pathlib import Path

BOTH = "labels: 1\nnodes:\n  /n0: {source: [Video, Voice]}\n  /n1: {leak: [Health]}\n"


def open_at(folder: Path, said: str) -> list[str]:
    """The kinds for which the channel is open."""
    (folder / "p.xml").write_text(policy("/n0>/a", "/n1</a"), "utf-8")
    (folder / "l.yaml").write_text(f"{BOTH}topics:\n  /a: {said}\n", "utf-8")
    analysis = rosprivacy.analyze(str(folder / "p.xml"), str(folder / "l.yaml")).analysis
    return [kind for one in analysis.open if one.element.name == "/a" for kind in one.categories]


@pytest.mark.parametrize(
    ("said", "left"),
    [
        ("", ["Video", "Voice"]),
        ("sensitive", []),
        ("{sensitive: [Video]}", ["Voice"]),
        ("{sensitive: [Video, Voice], note: looked at}", []),
        ("{sensitive: [PersonImage]}", ["Voice"]),  # a broader kind covers it
        ("{sensitive: [FaceImage]}", ["Video", "Voice"]),  # a narrower or other one does not
        ("{sensitive: [Video], never: [Voice]}", []),
    ],
)
def test_it_is_reviewed_for_these_kinds_only(tmp_path: Path, said: str, left: list[str]) -> None:
    assert open_at(tmp_path, said) == left
    schema = label_schema(load().categories.values())
    jsonschema.validate(yaml.safe_load((tmp_path / "l.yaml").read_text("utf-8")), schema)


def test_it_lets_pass_what_it_is_reviewed_for(tmp_path: Path) -> None:
    (tmp_path / "p.xml").write_text(policy("/n0>/a", "/n1</a"), "utf-8")
    for said, verdict in (("sensitive: [Video]", "leak"), ("never: [Video]", "no-leak-found")):
        text = f"labels: 1\nnodes:\n  /n0: {{source: [Video]}}\n  /n1: {{leak: [Video]}}\ntopics:\n  /a: {{{said}}}\n"
        (tmp_path / "l.yaml").write_text(text, "utf-8")
        assert rosprivacy.analyze(str(tmp_path / "p.xml"), str(tmp_path / "l.yaml")).analysis.verdict == verdict, said


def test_what_contradicts_itself_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(InputErrors, match="/a is sensitive for Video here and never"):
        open_at(tmp_path, "{sensitive: [Video], never: [Video]}")
