"""Decisions from a session: in the file of decisions, at once, with all that stood there; else nothing is written."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

import rosprivacy
from rosprivacy.analysis.errors import RosPrivacyError
from rosprivacy.explorer.session import Session
from rosprivacy.settings import Settings
from tests.helpers.factory import FACTORY

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.explorer.deciding import How

BEFORE, RUN2 = str(FACTORY / "before.policy.xml"), str(FACTORY / "run2.labels.yaml")
SIGNED: How = {"reason": "the archive is in the building", "owner": "A. Lee"}


def begun(file: Path | None) -> Session:
    return Session.open([BEFORE], [RUN2], Settings(decisions=str(file) if file else None))


def test_what_is_decided_counts_at_once_and_means_what_the_file_means(tmp_path: Path) -> None:
    file = tmp_path / "decisions.yaml"
    session = begun(file)
    first, second = session.findings
    session.decide(first.id, "accept", reason="inside", owner="A. Lee", expires="2999-12-31", legal_basis=("6(1)(f)",))
    session.decide(second.id, "delegate", owner="the operator")
    assert session.version == 2
    assert [finding.accepted for finding in session.findings] == [True, False]
    whole = rosprivacy.analyze(BEFORE, RUN2, decisions=file).document()
    now = session.result.document()
    assert (now["findings"], now["verdict"], now["decisions"]) == (
        whole["findings"], whole["verdict"], whole["decisions"],
    )  # fmt: skip
    session.label("/robot_camera", conduit=True)  # edits after it are under it
    assert [finding.accepted for finding in session.findings] == [False]


def test_what_others_wrote_meanwhile_stays(tmp_path: Path) -> None:
    file = tmp_path / "decisions.yaml"
    session = begun(file)
    first, second = session.findings
    session.decide(first.id, "avoid")
    file.write_text(file.read_text("utf-8") + f"# by hand\n- {{id: {second.id}, decision: mitigate}}\n", "utf-8")
    session.decide(first.id, "accept", **SIGNED)
    text = file.read_text("utf-8")
    assert "# by hand" in text
    assert f"id: {second.id}" in text
    assert "history" in text
    assert session.result.decided is not None
    assert str(session.result.decided.on[second.id].choice) == "mitigate"


@pytest.mark.parametrize(
    ("choice", "said"),
    [
        ("accept", {}),
        ("accept", {"reason": "x"}),
        ("accept", {**SIGNED, "expires": "2020-01-01"}),
        ("accept", {**SIGNED, "expires": "soon"}),
        ("accept", {**SIGNED, "legal_basis": ("because",)}),
        ("allow", SIGNED),
    ],
)
def test_what_is_no_decision_writes_nothing(tmp_path: Path, choice: str, said: How) -> None:
    file = tmp_path / "decisions.yaml"
    session = begun(file)
    with pytest.raises(RosPrivacyError):
        session.decide(session.findings[0].id, choice, **said)
    assert not file.exists()
    assert session.version == 0


def test_without_a_file_or_a_finding_nothing_is_decided(tmp_path: Path) -> None:
    session = begun(None)
    with pytest.raises(RosPrivacyError, match="no decisions file"):
        session.decide(session.findings[0].id, "accept", **SIGNED)
    session = begun(tmp_path / "decisions.yaml")
    with pytest.raises(RosPrivacyError, match="is no finding"):
        session.decide("0123456789abcdef", "accept", **SIGNED)


def test_a_file_that_is_none_of_decisions_is_not_written_over(tmp_path: Path) -> None:
    file = tmp_path / "decisions.yaml"
    session = begun(file)
    file.write_text("labels: 1\nnodes: {}\n", "utf-8")
    with pytest.raises(RosPrivacyError):
        session.decide(session.findings[0].id, "avoid")
    assert file.read_text("utf-8") == "labels: 1\nnodes: {}\n"
