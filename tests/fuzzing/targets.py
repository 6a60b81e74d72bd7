"""The targets: what is made for each reader, how it is read, and how what it accepts is analysed.

All files lie in the current folder, beside ``base.xml`` and the labels that go with it.
"""

from __future__ import annotations

from contextlib import closing, suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import rosprivacy
from rosprivacy.analysis import durations
from rosprivacy.analysis.errors import InputError, InputErrors, QueryError
from rosprivacy.analysis.model import Confidence, Element, Place, Profile
from rosprivacy.analysis.suggesting.evidence import HIDING
from rosprivacy.analysis.suggesting.library_rules import CPP, PYTHON, NodeUse
from rosprivacy.analysis.suggesting.name_rules import of_topic
from rosprivacy.analysis.suggesting.packages import nodes_of_packages, package_evidence
from rosprivacy.bag_copy import share_bag
from rosprivacy.explorer.journal import read_journal
from rosprivacy.explorer.session import Session
from rosprivacy.ingest.decisions.decision_chain import examine, heads, log_text
from rosprivacy.ingest.decisions.decision_log import merged, parse_log, read_log_or_file
from rosprivacy.ingest.decisions.decisions_file import read_decisions
from rosprivacy.ingest.deployed.governance import open_topics, read_governance
from rosprivacy.ingest.deployed.permissions import policy_of, read_permissions
from rosprivacy.ingest.deployed.zenoh_grants import read_zenoh
from rosprivacy.ingest.fleet.fleet_file import read_fleet
from rosprivacy.ingest.known_packages.package_file import read_package
from rosprivacy.ingest.labels.label_file import parse_labels, read_labels
from rosprivacy.ingest.language_model import answers_in, read_exchanges
from rosprivacy.ingest.mitigation.limits_file import read_limits
from rosprivacy.ingest.policies import names, wildcards
from rosprivacy.ingest.policies.policy_xml import read_policy
from rosprivacy.ingest.policies.saved_graph import read_saved
from rosprivacy.ingest.running.bag_folders import read_bags
from rosprivacy.ingest.running.node_info import TextFiles
from rosprivacy.ingest.suggestion_rules.accepting import accept
from rosprivacy.ingest.suggestion_rules.comments import taken_apart
from rosprivacy.ingest.suggestion_rules.rule_files import read_library_rules, read_name_rules
from rosprivacy.labelling.annotating import annotated, differences
from rosprivacy.labelling.model_interview import AskedModel, judged
from rosprivacy.mitigation import run_mitigation
from rosprivacy.observing import written
from rosprivacy.ontology.own import with_own
from rosprivacy.ontology.vocabulary import load
from rosprivacy.parts import parquet
from rosprivacy.queries.library import parse
from rosprivacy.queries.run import refuse_too_much
from rosprivacy.report.compare.earlier import read_earlier
from rosprivacy.report.json_text import as_text
from rosprivacy.settings import Settings
from tests.fuzzing import (
    bag_texts,
    code_texts,
    label_texts,
    log_texts,
    node_info_texts,
    other_texts,
    package_texts,
    policy_texts,
    security_texts,
    suggestion_texts,
)
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from rosprivacy.ontology.known import Known
    from rosprivacy.result import Result
    from tests.fuzzing.choices import Choices

TODAY = "2026-06-01"
ANYBODY = Profile("/a", "/a", Place("governance.xml", 1))
SEEN_AT = "2026-06-01T00:00:00Z"


@dataclass(frozen=True)
class Target:
    """A reader.

    Attributes
    ----------
    share
        Of a thousand inputs.
    make
        Files by name; the first one is mutated now and then.
    read
        Raises one of our errors for what is refused.
    analyse
        Of what was accepted; None where nothing is analysed.
    arguments
        Of the command that reads it; none where there is none without a server.
    words
        Which dictionary of ``mutations`` the mutations take; none for files that are no text.
    """

    name: str
    share: int
    make: Callable[[Choices], Mapping[str, str | bytes]]
    read: Callable[[], Any]
    analyse: Callable[[], Result] | None = None
    arguments: tuple[str, ...] = ()
    words: str = "label"


@cache
def _base() -> Result:
    return rosprivacy.analyze("base.xml", "base.yaml", today=TODAY)


@cache
def _known() -> Known:
    from rosprivacy.ontology.vocabulary import SHIPPED, _shipped

    return _shipped(tuple((ROOT / "ontology" / name).read_bytes() for name in SHIPPED))[0]


def _limits() -> Result:
    as_text(run_mitigation(_base(), "limits.yaml").document())
    return _base()


def _matched() -> None:
    """What a package says is never certain, and of nodes that are there."""
    graph = _base().analysis.graph
    for said in package_evidence(graph, nodes_of_packages(graph, {}, [read_package("package.yaml", load())])):
        assert said.confidence is not Confidence.CERTAIN
        assert said.label.element in graph.elements


def _named() -> None:
    """No rule about a name is certain."""
    rules, _ = read_name_rules(["names.yaml"], load())
    for name in ("/a", "/c/image", "/robot/eye", "/n0"):
        assert all(one is None or one.rule.confidence is not Confidence.CERTAIN for one in (of_topic(name, rules),))


def _used() -> None:
    """No rule about a library is certain, and one that speaks is one of the file or of ours."""
    rules, _ = read_library_rules(["libraries.yaml"], load())
    for name in ("cv2.VideoCapture.read", "open(w)", "curl_easy_init", "$ ros2 bag record"):
        for language in (PYTHON, CPP):
            for section in (rules.brings_in, rules.lets_out, rules.makes):
                one = rules.spoken(section, NodeUse(name, language, ANYBODY.place))
                assert one is None or one.confidence is not Confidence.CERTAIN


def _accepted() -> None:
    """What is accepted by its confidence hides nothing, and what is left says what it said."""
    text = Path("labels.yaml").read_bytes().decode("utf-8", "replace")
    _, before = taken_apart("labels.yaml", text)
    done = accept("labels.yaml", text, [Confidence.MAY], "somebody", "2026-01-01", load())
    rest, left = taken_apart("labels.yaml", done.text)
    assert len(before) == len(left) + done.count
    assert all(one in [other._replace(line=0) for other in before] for one in [each._replace(line=0) for each in left])
    assert all(
        one._replace(line=0) in [each._replace(line=0) for each in left]
        for one in before
        if one.hides and one.confidence is Confidence.MAY
    )
    parse_labels(rest, load(), name="labels.yaml")


def _taken_up() -> None:
    """Each edit of a journal is refused or done; what is then saved is read as the session understood it."""
    with closing(Session.open(["base.xml"], ["edited.yaml"], Settings(today=TODAY))) as session:
        for edit in read_journal(Path("journal.jsonl")).edits:
            with suppress(InputErrors):
                session.history.do(edit)
        session.save()
        saved = rosprivacy.analyze("base.xml", "edited.yaml", today=TODAY)
        assert [one.id for one in saved.findings] == [one.id for one in session.findings]
        assert saved.analysis.verdict == session.verdict


def _logged() -> None:
    """What is read is what the program wrote: no line can be taken out, changed or moved, and two logs join either way.

    A problem that ``verify`` would name is a reason to refuse the log.
    """
    name, data = "decisions.jsonl", Path("decisions.jsonl").read_bytes()
    entries, problems = examine(data)
    read_log_or_file(name, load(), TODAY)
    assert not problems, problems
    assert log_text(entries).encode() == data
    lines = data.splitlines(keepends=True)
    for at, line in enumerate(lines):
        for other in ([], [line.replace(b'"when":"', b'"when":"0', 1)], [line, line]):
            changed = b"".join([*lines[:at], *other, *lines[at + 1 :]])
            assert examine(changed, heads(entries))[1], (at, other)
    theirs = Path("theirs.jsonl").read_bytes()
    facts = {"account": {}, "when": "2026-06-02T00:00:00Z"}
    for ours, others in ((data, theirs), (theirs, data), (data, data)):
        text, undecided = merged(name, ours, "theirs.jsonl", others, facts)
        joint = parse_log("joined.jsonl", text.encode(), load(), TODAY)
        assert joint.head not in ("", heads(entries)) or ours == others or not undecided
        for one in (ours, others):
            assert {entry.hash for entry in examine(one)[0]} <= {entry.hash for entry in examine(text.encode())[0]}


def _answered() -> None:
    """Whatever a language model answered, it takes nothing away, and is said of what was asked."""
    asked = {"n1": AskedModel(Element("node", "/robot/eye"), "/robot/eye", (), (), (), ())}
    asked["n2"] = AskedModel(Element("topic", "/c/image"), "/c/image", (), (), (), ())
    for one in read_exchanges("asked.json").exchanges:
        for said in judged(answers_in(one.answer or b"", "m").answers, asked, load().categories, "m").evidence:
            assert said.confidence is Confidence.MAY
            assert said.label.role not in HIDING
            assert said.label.kind in load().categories


def _since() -> Result:
    from rosprivacy.cli.diff import DiffFormat, _text
    from rosprivacy.report.compare.difference import difference
    from rosprivacy.report.compare.snapshot import snapshot

    old, new = snapshot(read_earlier("old.json").document, None), snapshot(_base().document(), _base().policies)
    for one, other in ((old, new), (new, old), (old, old)):
        for form in DiffFormat:
            _text(difference(one, other), form)
    for name in ("html", "markdown"):
        _base().to(name, since="old.json")
    _base().to("html", since="old.json", redact=True, language="de")
    return _base()


def _bags() -> None:
    """The folder, and each of its files alone; what one of them is refused for, the whole command is."""
    for bag in read_bags(["bag", "bag/bag_0.mcap", "bag/bag_0.db3"]):
        assert all(one.isprintable() for one in (*bag.gaps, *bag.extras, *bag.notes)), bag
        assert bag.messages is None or bag.complete
    Path("mundane.yaml").write_text('labels: 1\nchannels: {"*": mundane}\n', "utf-8")
    for file in ("bag", "bag/bag_0.mcap", "bag/bag_0.db3"):
        _shared(file)


def _shared(bag: str) -> None:
    """What may be shared of it is a whole recording again; of what is refused nothing is written."""
    copy = Path("copy.mcap")
    copy.unlink(missing_ok=True)
    try:
        share_bag(bag, ["all"], copy, (), ("mundane.yaml",), Settings())
    except (InputError, InputErrors):
        assert not copy.exists()
    if copy.exists():
        (again,) = read_bags([str(copy)])
        assert again.complete


def _observed() -> None:
    """What is made of the text is a policy that is read, of which each grant was seen; of nothing none is made."""
    door = TextFiles(("graph.txt",), lambda: SEEN_AT, SEEN_AT)
    made = written(next(door.looks()))
    Path("seen.policy.xml").unlink(missing_ok=True)
    if made is None:
        return
    Path("seen.policy.xml").write_bytes(made.policy)
    policy = read_policy("seen.policy.xml")
    assert all(grant.observation for grant in policy.grants)
    assert all(one.isprintable() for one in made.remarks), made.remarks


def _annotated(file: str) -> None:
    """What is made of the code is a label file that says what the code says."""
    made = annotated([file], load())
    assert all(line.isprintable() for line in made.text.split("\n")), made.text
    Path("made.yaml").unlink(missing_ok=True)
    Path("made.yaml").write_bytes(made.text.encode())
    assert not differences(made, "made.yaml", load())


def _governance() -> None:
    """What is left open is granted to every enclave."""
    read = read_governance(Path("governance.xml").read_bytes(), "governance.xml")
    for rule in read.rules:
        assert all(grant.enclave == "/a" for grant in open_topics("governance.xml", rule, [ANYBODY], ()).grants)


def _results() -> None:
    document, rows = parquet.read("results")
    list(rows)
    assert isinstance(document["verdict"], str)


def _query() -> None:
    text = Path("asked.cypher").read_text("utf-8", "replace")
    parse("asked", text)
    try:
        refuse_too_much(text)
    except QueryError as error:  # of a query that has no file, so no place
        raise QueryError(f"asked.cypher: {error}") from None


def _duration() -> None:
    text = Path("duration").read_text("utf-8")
    durations.parts(text)
    try:
        read = durations.parse(text)
    except ValueError as error:
        raise InputError("duration", 1, str(error), "write it otherwise") from None
    assert str(read) == text
    assert not read.can_be_longer(read)


def _names() -> None:
    """What the rules of S4 say of any two patterns."""
    some = Path("names").read_text("utf-8").split("\n")
    for a in some:
        resolved = names.resolve(a, "/x", "n")
        names.endpoints("publish", "topic", resolved)
        names.literals(a), names.literal_prefix(a), names.is_pattern(a)
        for b in some:
            meet = names.overlaps(a, b)
            assert meet == names.overlaps(b, a), f"overlap of {a!r} and {b!r} is not symmetric"
            if not names.is_pattern(b) and names.covers(a, b):
                assert meet, f"{a!r} covers {b!r}, and does not overlap it"
    wildcards.some_name(tuple(some[:2]), tuple(some[2:]))


def _with_base(*more: str) -> tuple[str, ...]:
    return ("analyze", "base.xml", "-l", "base.yaml", *more)


TARGETS = {target.name: target for target in (
    Target(
        "policy", 250, policy_texts.policy_files, lambda: read_policy("policy.xml"),
        lambda: rosprivacy.analyze("policy.xml", "star.yaml", today=TODAY),
        ("analyze", "policy.xml", "-l", "star.yaml"), "policy",
    ),
    Target(
        "labels", 181, label_texts.labels, lambda: read_labels("labels.yaml", load()),
        lambda: rosprivacy.analyze("base.xml", "labels.yaml", today=TODAY, paths="all"),
        ("analyze", "base.xml", "-l", "labels.yaml"),
    ),
    Target(
        "standard", 60, label_texts.standard, lambda: read_labels("standard.yaml", load(), shipped=True),
        lambda: rosprivacy.analyze("base.xml", "base.yaml", standard_channels="standard.yaml", today=TODAY),
        _with_base("--standard-channels", "standard.yaml"),
    ),
    Target(
        "decisions", 90, label_texts.decisions, lambda: read_decisions("decisions.yaml", load(), TODAY),
        lambda: rosprivacy.analyze("base.xml", "base.yaml", decisions="decisions.yaml", today=TODAY),
        _with_base("--decisions", "decisions.yaml"),
    ),
    Target(
        "decision-log", 40, log_texts.decision_log, _logged,
        lambda: rosprivacy.analyze("base.xml", "base.yaml", decisions="decisions.jsonl", today=TODAY),
        _with_base("--decisions", "decisions.jsonl"),
    ),
    Target(
        "limits", 60, label_texts.limits, lambda: read_limits("limits.yaml", _base().analysis.graph), _limits,
        ("mitigate", "base.xml", "-l", "base.yaml", "--limits", "limits.yaml"),
    ),
    Target(
        "fleet", 50, label_texts.fleet, lambda: read_fleet("fleet.yaml", load()),
        lambda: rosprivacy.analyze_fleet("fleet.yaml", today=TODAY), ("analyze", "--fleet", "fleet.yaml"),
    ),
    Target(
        "ontology", 1, other_texts.ontology, lambda: with_own(_known(), Path("own.ttl").read_bytes(), "own.ttl"),
        lambda: rosprivacy.analyze("base.xml", "base.yaml", ontologies="own.ttl", today=TODAY),
        _with_base("--ontology", "own.ttl"),
    ),
    Target(
        "graph", 60, policy_texts.saved_graph, lambda: read_saved("graph.json"),
        lambda: rosprivacy.analyze((), "star.yaml", add="graph.json", today=TODAY),
        ("analyze", "--add", "graph.json", "-l", "star.yaml"),
    ),
    Target(
        "analysis", 30, other_texts.analysis, lambda: read_earlier("old.json"), _since,
        ("diff", "old.json", "base.xml", "-l", "base.yaml"),
    ),
    Target("parquet", 3, other_texts.parquet, _results, words=""),
    Target("query", 25, other_texts.query, _query),
    Target("duration", 25, other_texts.duration, _duration, words=""),
    Target(
        "bag", 30, bag_texts.bag, _bags, lambda: rosprivacy.analyze("base.xml", "bag.yaml", today=TODAY),
        ("bag", "bag", "bag/bag_0.mcap", "bag/bag_0.db3", "-l", "base.yaml"),
    ),
    Target(
        "node-info", 30, node_info_texts.node_info, _observed,
        lambda: rosprivacy.analyze("seen.policy.xml", "star.yaml", today=TODAY),
        ("observe", "--text", "graph.txt", "--at", SEEN_AT),
    ),
    Target(
        "permissions", 20, security_texts.permission_files,
        lambda: policy_of(read_permissions(Path("permissions.xml").read_bytes(), "permissions.xml"), 0, ()),
        lambda: rosprivacy.analyze("permissions.xml", "star.yaml", allow_unsigned=True, today=TODAY),
        ("analyze", "permissions.xml", "--allow-unsigned", "-l", "star.yaml"), "policy",
    ),
    Target(
        "governance", 10, security_texts.governance_files, _governance, words="policy",
    ),
    Target(
        "zenoh", 20, security_texts.access_files, lambda: read_zenoh(["node.json5"], None),
        lambda: rosprivacy.analyze("node.json5", "star.yaml", today=TODAY),
        ("analyze", "node.json5", "-l", "star.yaml"),
    ),
    Target("name-rules", 10, suggestion_texts.name_rules, _named),
    Target("journal", 10, label_texts.journal, _taken_up),
    Target("library-rules", 10, suggestion_texts.library_rules, _used),
    Target("suggestions", 10, suggestion_texts.suggested, _accepted),
    Target("model-exchanges", 10, suggestion_texts.recorded, _answered),
    Target("package", 10, package_texts.package, _matched),
    Target(
        "python-code", 10, code_texts.python, lambda: _annotated("a.py"), arguments=("annotations", "a.py"),
    ),
    Target("cpp-code", 10, code_texts.cpp, lambda: _annotated("a.cpp"), arguments=("annotations", "a.cpp")),
    Target("names", 25, other_texts.names, _names, words=""),
)}  # fmt: skip
