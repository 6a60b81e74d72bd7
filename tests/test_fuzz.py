"""Mutated policies and label files: a result, or one line for each problem; nothing else, and nothing opened outside.

Of files as people write them; ``tests/fuzzing`` does the same with what grammars make, for every reader.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import rosprivacy
from rosprivacy.analysis.errors import InputErrors, LabelError
from rosprivacy.ingest.labels.label_file import read_labels
from rosprivacy.ingest.policies.policy_xml import read_policy
from rosprivacy.ingest.policies.saved_graph import as_dict
from rosprivacy.ontology.vocabulary import load
from tests.fuzzing.mutations import Guard, hide, mutate, outcome, plant, words
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from random import Random

FACTORY = ROOT / "examples" / "factory"

POLICY = """<?xml version="1.0" encoding="UTF-8"?>
<policy version="0.2.0" xmlns:xi="http://www.w3.org/2001/XInclude">
  <enclaves>
    <enclave path="/robot">
      <profiles type="x">
        <profile ns="/" node="camera">
          <xi:include href="node.xml" xpointer="xpointer(/profile/*)"/>
          <topics publish="ALLOW" subscribe="DENY"><topic>image*</topic><topic>~/raw</topic></topics>
          <services reply="ALLOW"><service>/snap</service></services>
          <metadata><any/></metadata>
        </profile>
        <profile ns="/a" node="arm">
          <!-- a comment -->
          <topics subscribe="ALLOW"><topic>/image?[a-z]</topic><topic>/imagex</topic></topics>
          <topics subscribe="DENY"><topic>/image?b</topic></topics>
          <actions call="ALLOW" execute="DENY"><action>/spin</action><action>/s*</action></actions>
          <services request="ALLOW"><service>/snap</service><service>/x/_action/send_goal</service></services>
        </profile>
      </profiles>
    </enclave>
    <enclave path="/other">
      <profiles>
        <profile ns="/a" node="arm"><topics publish="ALLOW"><topic>/x/_action/status</topic></topics></profile>
      </profiles>
      <profiles><profile ns="" node="b"/></profiles>
    </enclave>
  </enclaves>
</policy>
"""
OLD = """<policy version="0.1.0"><profiles>
<profile ns="/" node="a"><topics publish="ALLOW"><topic>~x</topic></topics></profile></profiles></policy>
"""
LABELS = """\
labels: 1
nodes:
  /safety_camera: {source: [Video], note: a}
  /robot_camera: {source: {Video: [/robot_video]}}
  "/arch*": {leak: [Video, Voice], derives: [{from: Video, to: FaceTemplate}]}
  /navigator: conduit
  /emergency_stop: {sanitizer: {Video: pseudonymise, Voice: drop}, conduit: [Location]}
channels:
  /new_pose: mundane
  /safety_video: sensitive
  /robot_video: {only: [Video], note: b}
services:
  "/*": {never: [Health]}
flows:
  - {from: /navigator, to: /new_pose, never: [Video]}
"""
NAMES = "labels: 1\nnodes:\n  '*': {source: [Video], leak: [Voice], derives: [{from: Video, to: Voice}]}\n"
SIX = '{\n\t"source": ["/robot_camera"],\n\t"leak": ["/archive_server"],\n\t"mundane": []\n}\n'


WEEKDAYS = settings(
    max_examples=min(100, 2 * settings().max_examples),
    deadline=None,
    database=None,
    derandomize=True,
    suppress_health_check=list(HealthCheck),
)
SUNDAYS = settings(WEEKDAYS, max_examples=settings().max_examples * 15 // 2, derandomize=False)  # 1500, each week
DICE = st.randoms(use_true_random=True)  # seeded by hypothesis; spread more evenly than its own


@pytest.fixture(scope="module")
def root() -> Iterator[Path]:
    """A folder with policies and hostile links, beside one that nobody may read."""
    with tempfile.TemporaryDirectory() as folder:
        root, outside = Path(folder, "root"), Path(folder, "outside")
        root.mkdir()
        hide(outside)
        plant(root, outside)
        (root / "node.xml").write_bytes((FACTORY / "node.xml").read_bytes())
        (root / "names.yaml").write_text(NAMES)
        yield root


def never_crashes(root: Path, random: Random, kind: str, seeds: list[bytes], read: Callable[[Path], Any]) -> None:
    """Write a mutated seed and read it; nothing outside is opened."""
    outside = root.parent / "outside"
    file = root / f"mutated.{kind}"
    file.write_bytes(mutate(random, random.choice(seeds), words(kind, outside)))
    with Guard(outside) as guard:
        outcome(lambda: read(file))
    assert guard.opened == []


def policies() -> list[bytes]:
    return [POLICY.encode(), POLICY.encode(), OLD.encode(), (FACTORY / "before.policy.xml").read_bytes()]


def labels() -> list[bytes]:
    files = [path.read_bytes() for path in sorted(FACTORY.glob("*.labels.yaml"))]
    return [*files, SIX.encode(), LABELS.encode(), LABELS.encode()]


# ---------------------------------------------------------------- the net has no holes


def test_the_seeds_are_good(root: Path) -> None:
    for seed in policies():
        (root / "seed.xml").write_bytes(seed)
        assert read_policy(str(root / "seed.xml")).grants
        rosprivacy.analyze([str(root / "seed.xml")], [str(root / "names.yaml")]).document()
    for seed in labels():
        (root / "seed.yaml").write_bytes(seed)
        assert read_labels(str(root / "seed.yaml"), load()).entries


def test_the_guard_sees_what_python_and_what_c_opens(root: Path) -> None:
    from lxml import etree

    with Guard(root.parent / "outside") as guard:
        (root / "link.xml").read_text()
        assert len(guard.check()) > 0
    with Guard(root.parent / "outside") as guard:
        etree.parse(str(root / "link.xml"))
        assert guard.check() == ["secret.xml"]


def test_an_outcome_is_accepted_or_refused_and_nothing_else() -> None:
    def refuse(problem: str) -> None:
        raise InputErrors([LabelError("f", 1, problem, "do")])

    assert outcome(lambda: None) == "accepted"
    assert outcome(lambda: refuse("bad")) == "refused"
    with pytest.raises(AssertionError):
        outcome(lambda: refuse("two\nlines"))
    with pytest.raises(AssertionError):
        outcome(lambda: ["/outside_the_root"])
    with pytest.raises(ZeroDivisionError):
        outcome(lambda: 1 / 0)


# ---------------------------------------------------------------- mutations


def policy(root: Path, random: Random) -> None:
    def analyse(file: Path) -> Any:
        view: Any = random.choice(("declared", "enforced"))
        return rosprivacy.analyze([str(file)], [str(root / "names.yaml")], view=view, paths="all").document()

    never_crashes(root, random, "policy", policies(), analyse)


def fragment(root: Path, random: Random) -> None:
    (root / "p.xml").write_text(POLICY.replace("node.xml", "mutated.policy"))
    seeds = [(FACTORY / "node.xml").read_bytes()]
    never_crashes(root, random, "policy", seeds, lambda _: read_policy(str(root / "p.xml")))


def label_file(root: Path, random: Random) -> None:
    after = str(FACTORY / "after.policy.xml")
    never_crashes(root, random, "label", labels(), lambda file: rosprivacy.analyze([after], [str(file)]).document())


def saved_graph(root: Path, random: Random) -> None:
    (root / "p.xml").write_text(POLICY)
    seed = json.dumps(as_dict([read_policy(str(root / "p.xml"))]), indent=1)

    def add(file: Path) -> Any:
        return rosprivacy.analyze([], [str(root / "names.yaml")], add=(str(file),)).document()

    never_crashes(root, random, "label", [seed.encode()], add)


@pytest.mark.slow
@pytest.mark.parametrize("target", [policy, fragment, label_file, saved_graph], ids=lambda target: target.__name__)
def test_a_mutation_is_read_or_refused(
    root: Path,
    target: Callable[[Path, Random], None],
    thorough: bool,  # noqa: FBT001 - a fixture
) -> None:
    """Some for each change, the same ones; each week thousands of others."""

    @(SUNDAYS if thorough else WEEKDAYS)
    @given(DICE)
    def mutations(random: Random) -> None:
        target(root, random)

    mutations()


# ---------------------------------------------------------------- made from nothing


@WEEKDAYS
@given(st.binary(max_size=200))
def test_any_bytes_are_refused_as_policy_and_labels(root: Path, data: bytes) -> None:
    (root / "any").write_bytes(data)
    assert outcome(lambda: read_policy(str(root / "any"))) == "refused"
    outcome(lambda: read_labels(str(root / "any"), load()))


XML_TEXT = st.text(st.characters(exclude_categories=["Cs", "Cc"], exclude_characters="\ufffe\uffff"), max_size=8)


@WEEKDAYS
@given(XML_TEXT, XML_TEXT, XML_TEXT, XML_TEXT)
def test_any_names_are_carried_through_to_the_report(root: Path, ns: str, node: str, path: str, topic: str) -> None:
    from xml.sax.saxutils import escape, quoteattr

    head = f"<policy version='0.2.0'><enclaves><enclave path={quoteattr(path)}><profiles>"
    profile = (
        f"<profile ns={quoteattr(ns)} node={quoteattr(node)}><topics publish='ALLOW'><topic>{escape(topic)}</topic>"
    )
    tail = "</topics></profile></profiles></enclave></enclaves></policy>"
    (root / "names.xml").write_text(head + profile + tail, "utf-8")
    (root / "mundane.yaml").write_text("labels: 1\nchannels: {'*': mundane}")
    files = [str(root / "names.xml")], [str(root / "names.yaml"), str(root / "mundane.yaml")]
    outcome(lambda: rosprivacy.analyze(*files).document())


# ---------------------------------------------------------------- small files that cost much


def _system(topic: str) -> str:
    body = f'<topics publish="ALLOW" subscribe="ALLOW"><topic>{topic}</topic><topic>{"a" * 3000}</topic></topics>'
    profile = f'<profile ns="/" node="n">{body}</profile>'
    enclaves = f'<enclaves><enclave path="/e"><profiles>{profile}</profiles></enclave></enclaves>'
    return f'<policy version="0.2.0">{enclaves}</policy>'


@pytest.mark.parametrize(
    ("topic", "label"),
    [
        ("[" * 40_000, "/x"),
        *(
            pytest.param(*case, marks=pytest.mark.slow)
            for case in (
                ("*a" * 20_000, "/x"),
                ("?*" * 20_000, "/x"),
                ("[a-" * 10_000 + "]", "/x"),
                ("x", "[" * 150_000),
                ("x", "/" + "*a" * 20_000),
                ("x", "/" + "a" * 1_000_000),
            )
        ),
    ],
    ids=lambda text: f"{text[:4]}…{len(text)}",
)
def test_a_small_file_is_answered_soon(tmp_path: Path, topic: str, label: str) -> None:
    (tmp_path / "p.xml").write_text(_system(topic))
    (tmp_path / "l.json").write_text(json.dumps({"labels": 1, "topics": {label: "mundane", "/x": None, "*": None}}))
    command = [sys.executable, "-m", "rosprivacy", "analyze", "p.xml", "-l", "l.json"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=30, check=False)
    assert done.returncode in (0, 2, 4)
    assert "Traceback" not in done.stderr
