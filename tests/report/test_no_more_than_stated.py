"""No row of the Article 30 record, and no answer of the CNIL file, says more than the files state (property).

Random facts about a camera, a microphone, a cloud and a disk: each word that could be a stated fact has to be one of
what the row is about, and what is not stated has to be said so.
"""

from __future__ import annotations

import csv
import io
import json
import re
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import rosprivacy
from rosprivacy.analysis.findings import processed
from rosprivacy.analysis.python_311 import chdir
from rosprivacy.ingest.labels.countries import countries
from rosprivacy.report import row_texts
from rosprivacy.report.catalogs.words import Words
from rosprivacy.report.page import article30, persons
from tests.helpers.fleet_files import policy

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

POLICY = policy("cam>/v<", "mic>/a<", "up><v,a", "log><v,a")
SOURCES = {"/cam": "Video", "/mic": "Voice"}
TITLES = {"Video": "video of persons", "Voice": "voice"}
WORDS = Words("en")
OPEN = WORDS("record.open")
BASES = ("6(1)(a)", "6(1)(e)", "9(2)(a)", "9(2)(h)", "9(3)", "10")
DURATIONS = {"P3D": "3 days", "P30D": "30 days", "P1Y": "1 year"}
TRANSFERS = {"standard-clauses": "standard contractual clauses", "derogation": "derogation"}
MARK = re.compile(r"\b(?:why|who|officer|operator|contract|group)-\w+")
ARTICLE = re.compile(r"(?<![\d(.])(?:6\(1\)\([a-f]\)|9\(2\)\([a-j]\)|9\(3\)|10)(?![\d(])")


@dataclass
class Said:
    """What the files state, by place: of the system under the empty name."""

    facts: dict[str, dict[str, Any]] = field(default_factory=dict)

    def labels(self) -> str:
        nodes = {name: {"source": [kind], **self.facts[name]} for name, kind in SOURCES.items()}
        elements = {"cloud": {"kind": "external-system"} | self.facts["cloud"]}
        elements |= {"disk": {"kind": "storage"} | self.facts["disk"]}
        nodes |= {"/up": {"conduit": ["PersonalData"]}, "/log": {"conduit": ["PersonalData"]}}
        flows = [{"from": "/up", "to": "cloud"}, {"from": "/log", "to": "disk"}]
        return json.dumps({"labels": 1, **self.facts[""], "nodes": nodes, "elements": elements, "flows": flows})

    def of(self, place: str, what: str, kind: str) -> list[str]:
        """What a place states of a kind of data: of it by name, or else of all."""
        said: Any = self.facts[place].get(what, [])
        return list(said.get(kind, ()) if isinstance(said, dict) else said)

    def nearest(self, exit_: str, what: str, kind: str, group: str = "") -> list[str]:
        """What counts: of the exit, or else of the source, or else of the system."""
        (source,) = (name for name, of in SOURCES.items() if of == kind)
        for place in (exit_, source, ""):
            if some := [one for one in self.of(place, what, kind) if one.startswith(group)]:
                return some
        return []


@st.composite
def stated(draw: st.DrawFn) -> Said:
    """Each fact with a word of its own, so that one that is told of another place is seen."""
    facts: dict[str, dict[str, Any]] = {"": maybe(draw, {"controller": "who-sys", "dpo": "officer-sys"})}
    for place, name in (("", "sys"), ("/cam", "cam"), ("/mic", "mic"), ("cloud", "cloud"), ("disk", "disk")):
        mine = facts.setdefault(place, {})
        some = [f"why-{name}1", f"why-{name}2"]
        mine |= maybe(draw, {"purpose": draw(st.sampled_from([some, {"Video": some[:1], "Voice": some[1:]}]))})
        bases = st.lists(st.sampled_from(BASES), min_size=1, max_size=3, unique=True)
        mine |= maybe(draw, {"legal_basis": draw(st.one_of(bases, st.builds(lambda one: {"Video": one}, bases)))})
    for place in SOURCES:
        facts[place] |= maybe(draw, {"subjects": [f"group-{place[1:]}"]})
    for place in ("cloud", "disk"):
        roles = draw(st.sampled_from(["processor", "controller"]))
        facts[place] |= maybe(draw, {
            "operator": f"operator-{place}", "recipient": roles, "contract": f"contract-{place}",
            "country": draw(st.sampled_from(["DE", "US", "CN", "JP"])),
            "transfer": draw(st.sampled_from(sorted(TRANSFERS))),
        })  # fmt: skip
    durations = st.sampled_from(sorted(DURATIONS))
    kept = st.one_of(durations, st.fixed_dictionaries({"Video": durations}))
    facts["disk"] |= maybe(draw, {"retention": draw(kept), "encrypted": draw(st.booleans())})
    return Said(facts)


def maybe(draw: st.DrawFn, facts: Mapping[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in facts.items() if draw(st.booleans())}


def outputs(said: Said) -> tuple[list[dict[str, str]], dict[int, str]]:
    """The rows of the record by field, and the answers of the CNIL file by question."""
    with TemporaryDirectory() as folder, chdir(folder):
        Path("p.xml").write_text(POLICY, "utf-8")
        Path("l.yaml").write_text(said.labels(), "utf-8")
        result = rosprivacy.analyze("p.xml", "l.yaml")
        record, file = result.to("article30"), json.loads(result.to("cnil-pia"))
    columns = {WORDS(f"record.{name}"): name for name in article30.RecordEntry.__dataclass_fields__}
    *rows, _ = csv.DictReader(io.StringIO(record.removeprefix("\ufeff")))  # the last is the answer it rests on
    answers = {one["reference_to"]: one["data"]["text"] or "\n".join(one["data"]["list"]) for one in file["answers"]}
    answers[0] = "\n".join(measure["content"] for measure in file["measures"])
    return [{columns[key]: cell for key, cell in row.items()} for row in rows], answers


def check(said: Said) -> None:
    rows, answers = outputs(said)
    assert {(row["category"], row["exit"]) for row in rows} == {(t, e) for t in TITLES.values() for e in EXITS}
    for row in rows:
        check_row(row, said)
    check_answers(answers, said)


EXITS = ("cloud", "disk")


def check_row(row: Mapping[str, str], said: Said) -> None:
    kind = next(name for name, title in TITLES.items() if title == row["category"])
    exit_, open_ = row["exit"], row["complete"]
    source = next(name for name, of in SOURCES.items() if of == kind)
    here = said.facts[exit_]
    purpose, basis = said.nearest(exit_, "purpose", kind), bases(said, exit_, kind)
    group = said.facts[source].get("subjects", [])
    who = [said.facts[""][key] for key in ("controller", "dpo") if key in said.facts[""]]
    operated = [here[key] for key in ("operator", "contract") if key in here]
    told = " ".join(row.values())
    assert {*MARK.findall(told)} == {*purpose, *group, *who, *operated}
    assert {*ARTICLE.findall(row["basis"])} == basis
    assert {*re.findall(r"\b[A-Z]{2}\b", row["country"])} - {"EEA"} == {here.get("country")} - {None}
    assert ("processor" in row["recipient"]) == (here.get("recipient") == "processor")
    assert (OPEN in row["purpose"]) == (not purpose)
    assert (f"6(1): {OPEN}" in row["basis"]) == (not any(one.startswith("6") for one in basis))
    assert (OPEN in row["controller"]) == ("controller" not in said.facts[""])
    assert ("30(1)(b)" in open_) == (not purpose)
    assert ("30(1)(c)" in open_) == (not group)
    assert ("30(1)(d)" in open_) == (not {"operator", "recipient"} <= here.keys())
    check_transfer(row["transfer"], open_, here)
    check_kept(row, kind, said)


def bases(said: Said, exit_: str, kind: str) -> set[str]:
    return {basis for group in ("6", "9", "10") for basis in said.nearest(exit_, "legal_basis", kind, group)}


def check_transfer(cell: str, open_: str, here: Mapping[str, Any]) -> None:
    """A safeguard is told only where one is stated, or a decision covers the whole country."""
    area = countries().areas.get(here.get("country", ""), "")
    named = {basis for basis, words in TRANSFERS.items() if words in cell}
    assert named <= {here.get("transfer")}
    assert ("adequacy decision (Article 45)" in cell) <= (area == "adequate")
    if not here.get("transfer") and area in ("third", "partly", ""):
        assert "30(1)(e)" in open_
        assert cell == OPEN or "no basis is stated" in cell


def check_kept(row: Mapping[str, str], kind: str, said: Said) -> None:
    """Durations and encryption are those of the row's own place; where none is stated, it is to be completed."""
    disk = said.facts["disk"] if row["exit"] == "disk" else {}
    kept = disk.get("retention")
    kept = kept.get(kind) if isinstance(kept, dict) else kept
    told = {code for code, words in DURATIONS.items() if re.search(rf"\b{words}\b", row["retention"])}
    assert told == ({kept} if kept else set())
    assert ("30(1)(f)" in row["complete"]) == (OPEN in row["retention"]) == (not kept)
    assert ("encrypted" in row["measures"]) == (disk.get("encrypted") is True)
    assert ("not encrypted" in row["note"]) == (disk.get("encrypted") is False)


def check_answers(answers: Mapping[int, str], said: Said) -> None:
    """Of each kind of data, what is stated of an end of it; nothing where nobody states anything."""
    whole = [one for facts in said.facts.values() for one in strings(facts)]
    for text in answers.values():
        assert {*MARK.findall(text)} <= {*whole}
    for kind, title in TITLES.items():
        source = next(name for name, of in SOURCES.items() if of == kind)
        purpose = {why for end in (*EXITS, source) for why in said.nearest(end, "purpose", kind)}
        basis = {one for end in (*EXITS, source) for one in bases(said, end, kind)}
        group = said.facts[source].get("subjects", [])
        assert {*re.findall(r"why-\w+", section(answers.get(211, ""), title))} == purpose
        assert {*re.findall(r"why-\w+", section(answers[121], title))} == purpose
        assert {*re.findall(r"group-\w+", section(answers[121], title))} == {*group}
        assert {*ARTICLE.findall(section(answers.get(212, ""), title))} == basis
    assert ("who-sys" in answers.get(112, "")) == ("controller" in said.facts[""])
    assert ("encrypted at rest" in answers[0]) == (said.facts["disk"].get("encrypted") is True)
    processors = [facts for e in EXITS if (facts := said.facts[e]).get("recipient") == "processor"]
    operators = {facts["operator"] for facts in processors if "operator" in facts}
    assert {*re.findall(r"operator-\w+", answers.get(226, ""))} == operators
    for place in EXITS:
        line = re.search(rf"<li>[^<]*\b{place}: ([^<]*)</li>", answers[227])
        assert line is not None
        assert {*re.findall(r"\b[A-Z]{2}\b", line[1])} == {*[said.facts[place].get("country", "")]} - {""}
        assert {basis for basis in TRANSFERS if basis in line[1]} <= {said.facts[place].get("transfer")}


def section(text: str, title: str) -> str:
    """The part of an answer about one kind of data."""
    parts = re.split(r"<p><strong>", text)
    return "".join(part for part in parts if part.startswith(title))


def strings(value: Any) -> Iterable[str]:
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict):
        for inner in value.values():
            yield from strings(inner)
    elif isinstance(value, list):
        for inner in value:
            yield from strings(inner)


@given(stated())
@settings(max_examples=25, deadline=None)
def test_no_row_says_more_than_the_files_state(said: Said) -> None:
    check(said)


@pytest.mark.slow
@given(stated())
@settings(max_examples=settings().max_examples * 2, deadline=None)
def test_more_of_them(said: Said) -> None:
    check(said)


NOTHING = Said({place: {} for place in ("", "/cam", "/mic", "cloud", "disk")})
EACH = Said({
    "": {"controller": "who-sys"},
    "/cam": {"purpose": ["why-cam1"], "legal_basis": ["6(1)(a)"], "subjects": ["group-cam"]},
    "/mic": {"purpose": ["why-mic1"], "legal_basis": ["6(1)(e)"]},
    "cloud": {"country": "US", "operator": "operator-cloud"},
    "disk": {"encrypted": False, "retention": {"Video": "P3D"}},
})  # fmt: skip


RIGHT = processed._Rows._ways


def of_all_sources(rows: Any) -> Any:
    """A wrong look-up: whatever any source states, for whatever gets anywhere."""
    found = RIGHT(rows)
    return [(reach, way) for reach, _ in found for _, way in found]


MUTANTS: dict[str, tuple[Any, str, Callable[..., Any], Said]] = {
    "a safeguard that nobody stated": (row_texts, "transfer", lambda *_: ["US: derogation (Article 49)"], NOTHING),
    "a measure that nobody stated": (article30, "_measures", lambda *_: iter(["disk: encrypted at rest"]), NOTHING),
    "an operator as the controller": (persons, "controllers", lambda *_: "operator-cloud", NOTHING),
    "a purpose that is taken as known": (article30, "completed", lambda *_: "operation", NOTHING),
    "the country of another element": (article30, "country", lambda *_: "DE (in the EEA)", EACH),
    "a time limit of another kind": (article30, "_retention", lambda *_: ["disk: 3 days"], EACH),
    "the purposes of all sources": (processed._Rows, "_ways", of_all_sources, EACH),
}


@pytest.mark.parametrize("name", MUTANTS)
def test_the_property_sees_a_record_that_says_more(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    where, what, wrong, said = MUTANTS[name]
    check(said)
    monkeypatch.setattr(where, what, wrong)
    with pytest.raises(AssertionError):
        check(said)
