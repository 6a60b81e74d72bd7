"""The report for the terminal: what it says, in which order, and that no name can break it."""

from __future__ import annotations

from io import StringIO
from pathlib import Path
from typing import Any

import pytest
from rich.console import Console

import rosprivacy
from rosprivacy.report.text.analysis import print_report
from tests.helpers.paths import ROOT


def report(document: dict[str, Any], **options: Any) -> list[str]:
    text = StringIO()
    print_report(Console(file=text, highlight=False, emoji=False), document, **options)
    return text.getvalue().splitlines()


def analyze(policy: str, labels: str, **options: Any) -> dict[str, Any]:
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(ROOT / "examples")
        return rosprivacy.analyze([policy], [labels], **options).document()


@pytest.fixture(scope="module")
def care_home() -> dict[str, Any]:
    return analyze("care-home/care-home.policy.xml", "care-home/care-home.labels.yaml")


def test_the_channels_of_the_infrastructure_file_are_not_said_to_be_the_standard_files() -> None:
    """S13: what was taken away is told with whose word it was."""
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(ROOT / "examples" / "factory")
        result = rosprivacy.analyze("before.policy.xml", ["run1.labels.yaml", "rosprivacy:infrastructure"])
    assert "(rosprivacy labels --standard), or by rosprivacy:infrastructure (rosprivacy labels --inf" in result.to(
        "text"
    )
    assert ", or by rosprivacy:infrastructure." in result.to("markdown")


def test_the_first_line_is_the_verdict(care_home: dict[str, Any]) -> None:
    assert report(care_home)[0] == "leak: data can reach a leak"
    assert report(care_home, quiet=True) == ["leak: data can reach a leak"]


def test_a_witness_is_drawn_hop_by_hop_with_element_role_and_line(care_home: dict[str, Any]) -> None:
    lines = report(care_home)
    start = lines.index("1. FaceTemplate, made of Video at /face_recognizer: /camera -> /uplink   [59dc667b0ca44e0f]")
    assert lines[start + 1 : start + 8] == [
        "   /camera  (node, source of Video)",
        "     | publishes  care-home.policy.xml:10",
        "   /camera/image  (topic)",
        "     | is read by  care-home.policy.xml:32",
        "   /face_recognizer  (node, derivation of Video, sanitizer of Video)",
        "     | publishes  care-home.policy.xml:35   now FaceTemplate",
        "   /face_recognizer/faces  (topic)",
    ]


def test_pseudonymised_data_is_called_so(care_home: dict[str, Any]) -> None:
    assert any(line.startswith("3. pseudonymised Video: /camera -> /recorder") for line in report(care_home))


def test_what_needs_review_comes_frontier_first(care_home: dict[str, Any]) -> None:
    document = analyze("factory/before.policy.xml", "factory/run1.labels.yaml")
    groups = ("Review next", "Channels not", "Nodes behind")
    titles = [line for line in report(document) if line.startswith(groups)]
    assert titles == [
        "Review next (nodes that data reaches first): 3",
        "Channels not reviewed: 5 (7 counting the legs of services and actions)",
        "Nodes behind those: 1",
    ]
    assert not any("not reviewed" in line for line in report(care_home))


def test_long_lists_are_cut_and_say_so_unless_verbose() -> None:
    document = analyze("factory/before.policy.xml", "factory/run1.labels.yaml", standard_channels=None)
    more = [line for line in report(document) if "(-v shows all)" in line]
    assert more
    assert len(report(document, verbose=True)) > len(report(document))
    assert not any("(-v shows all)" in line for line in report(document, verbose=True))


def test_what_was_assumed_is_said(care_home: dict[str, Any]) -> None:
    text = "\n".join(report(care_home))
    assert "view declared: each node does what its own profile says" in text
    assert "75 standard ROS channels taken as mundane" in text
    assert "labels are a person's word; this is no legal verdict" in text


def test_names_cannot_break_the_report(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Control characters, rich's markup, line ends, right-to-left marks, 4,000 characters."""
    name = "/[bold]x[/bold]&#10;leak: &#x202E;" + "a" * 4000
    profile = f'<profile ns="/" node="a"><topics publish="ALLOW"><topic>{name}</topic></topics></profile>'
    monkeypatch.chdir(tmp_path)  # files have short names
    policy = Path("p.xml")
    enclave = f'<enclave path="/"><profiles>{profile}</profiles></enclave>'
    policy.write_text(f'<policy version="0.2.0"><enclaves>{enclave}</enclaves></policy>')
    labels = Path("l.yaml")
    labels.write_text("labels: 1\nnodes: {/a: {source: [Video]}}\n")
    lines = report(rosprivacy.analyze([str(policy)], [str(labels)]).document(), verbose=True)
    named = [line for line in lines if "[bold]" in line]
    assert named
    for shown in named:
        assert shown.isprintable()
        assert "\\n" in shown
        assert len(shown) < 400
    assert not any(line.startswith("leak:") for line in lines)
