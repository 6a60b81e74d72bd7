"""Parameter files set what they set for nodes of some names."""

from __future__ import annotations

import pytest

from rosprivacy.analysis.errors import InputError
from rosprivacy.ingest.scan.launch.parameter_files import ParameterEntry, fits, read_parameters


@pytest.mark.parametrize(
    ("text", "node"),
    [
        ("camera:\n  ros__parameters:\n    topic: /a\n", "/camera"),
        ("/camera:\n  ros__parameters:\n    topic: /a\n", "/camera"),
        ("/**:\n  ros__parameters:\n    topic: /a\n", "/**"),
        ("robot:\n  camera:\n    ros__parameters:\n      topic: /a\n", "/robot/camera"),
        ("/robot/camera:\n  ros__parameters:\n    topic: /a\n", "/robot/camera"),
        ("/*/camera:\n  ros__parameters:\n    topic: /a\n", "/*/camera"),
    ],
)
def test_an_entry_names_its_node(text: str, node: str) -> None:
    assert read_parameters(text, "p.yaml") == (ParameterEntry(node, "topic", "/a"),)


def test_inner_maps_have_dots_and_lists_are_texts() -> None:
    text = "n:\n  ros__parameters:\n    a:\n      b: 1\n    c: [x, y]\n"
    assert [(one.name, one.value) for one in read_parameters(text, "p")] == [("c", "[x, y]"), ("a.b", "1")]


@pytest.mark.parametrize(
    ("pattern", "node", "answer"),
    [
        ("/camera", "/camera", True),
        ("/camera", "/robot/camera", False),
        ("/**", "/robot/camera", True),
        ("/*/camera", "/robot/camera", True),
        ("/*/camera", "/a/robot/camera", False),
        ("/**/camera", "/a/robot/camera", True),
    ],
)
def test_patterns_fit_as_in_rcl(pattern: str, node: str, answer: bool) -> None:  # noqa: FBT001
    assert fits(pattern, node) is answer


def test_what_is_not_yaml_is_refused_with_its_line() -> None:
    with pytest.raises(InputError) as caught:
        read_parameters("a: 1\nb: [", "p.yaml")
    assert caught.value.file == "p.yaml"
