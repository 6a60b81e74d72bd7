"""Fleets in parts and in one graph, to be compared."""

from __future__ import annotations

from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.findings.findings import Options, analyse
from rosprivacy.analysis.fleet.counts import counted
from rosprivacy.analysis.fleet.patterns_of_pairs import Groups
from rosprivacy.analysis.model import GAPS, IN_PARTS, LEGAL_BASIS, RESTRICTED, RIDES
from rosprivacy.analysis.model.doubt import RANKS
from rosprivacy.analysis.python_311 import chdir
from rosprivacy.formats import Style, in_pieces
from rosprivacy.ingest.fleet.alike_robots import alike
from rosprivacy.ingest.fleet.fleet_file import read_fleet
from rosprivacy.ontology.vocabulary import load
from rosprivacy.parts import distributed
from rosprivacy.parts.distributed import Task, analyse_in_parts
from rosprivacy.parts.fleet_in_parts import SPARK, file_reader, result
from rosprivacy.parts.shown_robots import place_shown, shown
from rosprivacy.parts.workers import filled
from rosprivacy.question import Question
from rosprivacy.settings import Settings
from rosprivacy.systems.fleet_system import answer_fleet
from tests.helpers.fleet_files import policy, write
from tests.helpers.random_fleets import Case, found_in
from tests.helpers.systems import HIERARCHY

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

    from rosprivacy.ingest.fleet.dds_domains import Member
    from rosprivacy.ingest.fleet.fleet_file import Robot
    from rosprivacy.parts.distributed import Found
    from rosprivacy.parts.shown_robots import ShownRobots
    from rosprivacy.parts.units import Unit
    from rosprivacy.result import Result
    from tests.helpers.written_systems import Written


def given_members(members: dict[str, Member]) -> Callable[[Robot], Member]:
    return lambda robot: members[robot.id]


def question(case: Case) -> Task:
    fleet = case.fleet()
    members = {robot.id: case.member(robot) for robot in fleet.robots}
    return Task(fleet, alike(fleet), "declared", partial(given_members, members), HIERARCHY)


def rows(found: Found, told: ShownRobots) -> Any:
    """Verdict, patterns, deviants; and what each pattern shows."""
    patterns = {
        (p.id, p.count, p.robots, p.across, p.dismissed, p.pseudonymised, p.finding.source, p.finding.leak,
         p.finding.pseudonymised, p.finding.dismissed)
        for p in told.view.patterns
    }  # fmt: skip
    return found.verdict, patterns, set(found.deviants), found.emitted


def same(case: Case, scatter: Callable[[Sequence[Unit]], Any]) -> None:
    """The same verdict, patterns, deviants, counts, open elements, and sets at every element."""
    result = found_in(case)
    if result is None:
        return
    _, placed = result
    groups = Groups(placed.likeness)
    analysis = analyse(placed.graph, placed.bound, HIERARCHY, Options(choose=groups))
    view = groups.view(analysis)
    asked = question(case)
    found = analyse_in_parts(asked, scatter)
    told = shown(asked, found, place_shown(asked, found)[0], "witness", 100)
    expected = {
        (p.id, p.count, p.robots, p.across, p.dismissed, p.pseudonymised, p.finding.source, p.finding.leak,
         p.finding.pseudonymised, p.finding.dismissed)
        for p in view.patterns
    }  # fmt: skip
    assert rows(found, told) == (analysis.verdict, expected, set(view.deviants), analysis.emitted)
    assert found.counts == counted(placed.graph, analysis.spread, placed.likeness)
    assert found.open == sum(placed.likeness.weight(q.element.robot) for q in analysis.open)
    assert carried(found) == {e: bits for e, bits in everywhere(analysis.spread).items() if bits}
    known = {carried.element: carried for carried in analysis.carried}
    assert all(known[carried.element] == carried for carried in told.analysis.carried)


def everywhere(spread: Any) -> dict[Any, int]:
    return {element: spread.present(vertex) for vertex, element in enumerate(spread.graph.elements)}


def carried(found: Found) -> dict[Any, int]:
    """What is at each element of the parts and of the core."""
    sets: dict[Any, int] = {}
    for spread in [*found.parts.map(partial(filled, leaving=found.leaving)).collect(), found.core[1]]:
        mine = spread is found.core[1]
        border = set(found.border.elements)
        for element, bits in everywhere(spread).items():
            if bits and not element.robot.startswith("\0") and (mine or element not in border):
                assert element not in sets
                sets[element] = bits
    return sets


FLEET = """fleet: 1
models: {eye: {policies: eye.xml, labels: eye.yaml}, wall: {policies: wall.xml, labels: wall.yaml}}
robots:
  odd: {model: eye, labels: odd.yaml}
  hall_a: {model: eye, domain: hall}
  hall_b: {policies: hall.xml, labels: hall.yaml, domain: hall}
groups:
  - {robots: 4, model: eye}
  - {robots: 3, model: wall}
  - {robots: 2, model: eye, id: 'dim_*', domain: yard}
infrastructure:
  base: {policies: wall.xml, labels: wall.yaml}
  desk: {policies: wall.xml, labels: wall.yaml, domain: hall}
elements:
  bucket: {kind: storage, country: DE, retention: P30D}
  cloud: {kind: external-system, country: US}
flows:
  - {from: "*:/uplink", to: bucket, never: [Voice]}
  - {from: bucket, to: "base:/receiver"}
  - {from: "base:/screen", to: cloud}
  - {from: cloud, to: "wall_*:/receiver", only: [Video]}
  - {from: "eye_*:/uplink", to: "*:/receiver"}
  - {from: "eye_1:/uplink", to: "wall_*:/receiver", never: [Video]}
  - {from: "odd:/uplink", to: "hall_b:/mirror"}
"""


@pytest.fixture
def fleet_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """Robots of all sorts: alike, with labels of their own, in domains, infrastructure in one; hubs with limits."""
    monkeypatch.chdir(tmp_path)
    write("eye.xml", policy("/camera>/image", "/uplink</image"))
    write(
        "eye.yaml",
        "labels: 1\nnodes:\n  /camera: {source: [Video, Voice]}\n  /uplink: {sanitizer: {Voice: pseudonymise}}\n"
        "channels: {/image: sensitive}\nlimits: {Video: P7D}\n",
    )
    write("odd.yaml", "labels: 1\nnodes: {/uplink: {leak: [Video]}}\n")
    write("wall.xml", policy("/receiver>/picture", "/screen</picture"))
    write(
        "wall.yaml",
        "labels: 1\nnodes:\n  /receiver: {derives: [{from: Video, to: FaceTemplate}]}\n"
        "  /screen: {leak: [Biometric]}\n",
    )
    write("hall.xml", policy("/mirror>/map<im*"))
    write("hall.yaml", "labels: 1\nnodes: {/mirror: {leak: [Video]}}\n")
    write("f.yaml", FLEET)
    return "f.yaml"


OF_TWO = """fleet: 1
robots:
  one: {policies: one.xml, labels: one.yaml}
  two: {policies: two.xml, labels: two.yaml}
elements: {cloud: {kind: external-system, country: US}}
flows: [{from: "*:/n1", to: cloud}, {from: cloud, to: "two:/n2"}]
"""


@contextmanager
def fleet_of_two(factory: pytest.TempPathFactory, one: Written, two: Written) -> Iterator[str | None]:
    """Work in a folder with two robots that a cloud joins; None where their labels contradict each other."""
    folder = factory.mktemp("fleet")
    one.write(folder, "one")
    two.write(folder, "two")
    with chdir(folder):
        write("f.yaml", OF_TWO)
        try:
            answer_fleet("f.yaml", Settings())
        except InputErrors:
            yield None
        else:
            yield "f.yaml"


PER_ROBOT = (  # of the robots that are shown
    "carries", "roles", "open", "outside", "unreached", "denied", "sanitizers", "derivations", "subjects",
    "processing", "surroundings", "unknown_ends",
)  # fmt: skip
BEHIND = ("leak", "open")  # the nearest such elements behind what was taken away
OF_BEHIND = (*BEHIND, "perhaps")
OF_ELEMENTS = {LEGAL_BASIS, *RANKS} - {*GAPS, *RIDES, RESTRICTED}  # codes of what is told of an element
ASSUMED_PER_ROBOT = ("backups_taken_as_none", "taken_away_by")

ASKED = Settings(hangs_on=True)


def enclaves_of_fewer(got: list[dict[str, Any]], expected: list[dict[str, Any]]) -> None:
    """The enclaves with nodes of the robots that are shown."""
    known = {row["enclave"]: row["nodes"] for row in expected}
    assert all(set(row["nodes"]) <= set(known[row["enclave"]]) for row in got)


def ledger_of_fewer(got: list[dict[str, Any]], expected: list[dict[str, Any]]) -> None:
    """What was taken away at the robots that are shown.

    What lies behind it may be nearer on a robot that is not shown, or there alone: then it was not worked out.
    """
    for row in got:
        known = [other for other in expected if all(row[key] == other[key] for key in row if key not in OF_BEHIND)]
        assert any(_behind_of_fewer(row, other) for other in known), (row, known)


def _behind_of_fewer(row: dict[str, Any], other: dict[str, Any]) -> bool:
    """Whether a row names what may be behind in the whole fleet, or says that it was not worked out."""
    differ = [end for end in BEHIND if row[end] != other[end]]
    return all(row["perhaps"] if row[end] is None else other[end] or other["perhaps"] for end in differ)


COUNTED = ("elements", "closed", "reviewed", "flows", "flows_closed")


def globs_of_fewer(got: list[dict[str, Any]], expected: list[dict[str, Any]]) -> None:
    """What globs decide at the robots that are shown."""
    whole = {(row["file"], row["line"]): row for row in expected}
    for row in got:
        known = whole[row["file"], row["line"]]
        assert set(row["says"]) <= set(known["says"])
        assert all(row[key] <= known[key] for key in COUNTED), (row, known)


def standard_of_fewer(got: list[dict[str, Any]], expected: list[dict[str, Any]]) -> None:
    """Standard channels of the robots that are shown; what one keeps data from may lie on another robot only."""
    for row in got:
        assert any(
            {"keeps_from": other.get("keeps_from"), **row} == {"keeps_from": None, **other} for other in expected
        )


def purposes_of_fewer(got: list[dict[str, Any]], expected: list[dict[str, Any]]) -> None:
    """At what robots share, what those that are shown state; never more than what all of them do."""
    whole = {(*row["element"].values(), row["category"]): row for row in expected}
    for row in got:
        at = (*row["element"].values(), row["category"])
        known = whole[at]
        for key in ("controllers", "officers", "purposes", "legal_bases"):
            assert set(row[key]) <= set(known[key]), (key, row, known)


def register_of_fewer(got: list[dict[str, Any]], expected: list[dict[str, Any]]) -> None:
    """At what robots share, the persons of those that are shown, and that there are others; no other measures."""
    for row in got:
        ends = {(row["category"], *place.values()) for place in row["places"]}
        whole = [
            other
            for other in expected
            if row["category"] == other["category"]
            and (not ends or ends & {(other["category"], *place.values()) for place in other["places"]})
        ]
        subjects = {group for other in whole for group in other["subjects"]}
        assert set(row["subjects"]) <= subjects
        assert set(row["subjects"]) == subjects or "subjects" in row["to_complete"], (row, whole)
        measures = {one["element"]["name"] for other in whole for one in other["measures"]}
        assert measures.issuperset(one["element"]["name"] for one in row["measures"])


def doubts_of_fewer(got: dict[str, Any], expected: dict[str, Any]) -> None:
    """Of files all doubts, and that there are robots not shown; of elements those of fewer. The verdict is the same."""
    rows, known = got.pop("doubts"), expected.pop("doubts")
    (in_parts,) = (row for row in rows if row["doubt"] == IN_PARTS)
    rows.remove(in_parts)
    assert [row for row in rows if not row["element"]] == [row for row in known if not row["element"]]
    assert all(row in known for row in rows if row["element"])
    assert {row["doubt"] for row in rows if row["rank"] == "breaks"} == {
        row["doubt"] for row in known if row["rank"] == "breaks"
    }
    sentences = got.pop("sentence"), expected.pop("sentence")
    assert len({sentence.partition(";")[0] for sentence in sentences}) == 1, sentences


def documents(file: str, run: Callable[[str], Result], engine: str = SPARK) -> None:
    """The same bytes; of a large fleet the same document, but that its rows for robots are those of fewer.

    Parameters
    ----------
    run
        Asks for what ``ASKED`` does.
    """
    same_bytes(file, run, engine)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(distributed, "MOST_WHOLE", 0)
        _of_fewer(file, run, engine)


def same_bytes(file: str, run: Callable[[str], Result], engine: str, asked: Settings = ASKED) -> None:
    """The answer in memory, byte for byte, but for the name of the engine."""
    got, expected = (text_of(in_pieces(answer, "json1", Style())) for answer in (run(file), answer_fleet(file, asked)))
    assert got.replace(f'    "engine": "{engine}",\n', "") == expected


def text_of(pieces: Iterable[str] | str | bytes) -> str:
    assert not isinstance(pieces, bytes)
    return "".join(pieces)


def _of_fewer(file: str, run: Callable[[str], Result], engine: str) -> None:
    expected, got = answer_fleet(file, ASKED).document(), run(file).document()
    assert got["assumptions"].pop("engine") == engine
    (in_parts,) = (row for row in got["diagnostics"] if row["file"] == f"--engine {engine}")
    assert "open elements in the whole fleet: ways and distances are" in in_parts["message"]
    got["diagnostics"].remove(in_parts)
    purposes_of_fewer(got.pop("processed_for", []), expected.pop("processed_for", []))
    register_of_fewer(got.pop("register"), expected.pop("register"))
    doubts_of_fewer(got, expected)
    ledger_of_fewer(got.pop("taken_away"), expected.pop("taken_away"))
    enclaves_of_fewer(got.pop("enclaves"), expected.pop("enclaves"))
    flagged = [[row for row in told["diagnostics"] if row.get("code") in OF_ELEMENTS] for told in (got, expected)]
    assert all(row in flagged[1] for row in flagged[0])
    for told, some in zip((got, expected), flagged, strict=True):
        told["diagnostics"] = [row for row in told["diagnostics"] if row not in some]
    for key in PER_ROBOT:
        for row in got.pop(key, ()):
            known = (
                [other for other in expected[key] if other.get("element") == row["element"]] if "element" in row else []
            )
            assert row in expected[key] or key == "open", (key, row, known)
        expected.pop(key, None)
    globs_of_fewer(*(answer["assumptions"].pop("globs", []) for answer in (got, expected)))
    standard_of_fewer(*(answer["assumptions"].pop("standard_channels_reached", []) for answer in (got, expected)))
    for key in ASSUMED_PER_ROBOT:
        rows, known = (answer["assumptions"].pop(key, ()) for answer in (got, expected))
        assert all(row in known for row in rows), key
    assert got["assumptions"] == expected["assumptions"]
    assert got == expected


@dataclass(frozen=True)
class Listed:
    """Parts in a list."""

    values: tuple[Any, ...]

    def map(self, function: Callable[[Any], Any], *, keep: bool = False) -> Listed:
        del keep
        return Listed(tuple(map(function, self.values)))

    def collect(self) -> list[Any]:
        return list(self.values)


def scattered(units: Sequence[Unit], size: int = 1) -> Listed:
    return Listed(tuple(tuple(units[i : i + size]) for i in range(0, len(units), size)))


def in_list(file: str, size: int = 1, engine: str = SPARK) -> Result:
    vocabulary = load()
    fleet = read_fleet(file, vocabulary)
    asked = Task(
        fleet,
        alike(fleet),
        "declared",
        partial(file_reader, Settings(), str(Path.cwd()), fleet.root),
        vocabulary.hierarchy,
        hangs_on=True,
    )
    found = analyse_in_parts(asked, partial(scattered, size=size))
    return result(asked, found, Question(ASKED, vocabulary, None, None, ""), engine)
