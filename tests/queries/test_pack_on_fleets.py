"""Every question of the pack held to memory, on random fleets that are written as files (rules S7 to S12).

Robots leak at each other, at the infrastructure and at a cloud; kinds that sources name are broader than those that
leaks name. What is loaded has one robot for all that are alike; in memory each stands for itself.
"""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any, NamedTuple

import pytest

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.answering import answer
from rosprivacy.ingest.neo4j_graph.loading import load
from rosprivacy.queries.library import find, pack
from rosprivacy.systems.fleet_system import fleet_system, rows_of_fleet
from tests.helpers.pack_memory import QUESTION, VOCABULARY, Fleet, Memory, place_of
from tests.helpers.written_fleets import KINDS, fleet

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping
    from pathlib import Path

    from neo4j import Driver, Record

    from rosprivacy.ingest.neo4j_graph.rows import RobotRows


class Check(NamedTuple):
    """Columns that are compared, and with which parameters a question is asked besides ``robot``."""

    columns: str
    parameters: tuple[Mapping[str, str], ...] = ({},)
    memory: str = ""


BY_KIND_ASKED = ({}, *({"category": kind} for kind in KINDS))
FINDING = "robot category source leak leak_robot"
CHECKS = {
    "findings": Check(
        "robot kind category source leak leak_robot pseudonymised dismissed may_be verdict", BY_KIND_ASKED
    ),
    "findings-by-pattern": Check("robots category source leak kind pattern may_be", BY_KIND_ASKED),
    "findings-by-robot": Check("robot category findings dismissed ending"),
    "findings-by-data-type": Check(FINDING, tuple({"type": one} for one in ("video", "audio", "template", "text"))),
    "findings-by-identity-factor": Check(FINDING, tuple({"factor": one} for one in ("location", "physiological"))),
    "findings-under-article": Check(FINDING, ({"may": "true"}, {"may": "false"})),
    "leak-paths": Check(f"{FINDING} path policy may_be", BY_KIND_ASKED),
    "leak-paths-of-category": Check(f"{FINDING} may_be", BY_KIND_ASKED[1:]),
    "leak-path-graph": Check(f"{FINDING} may_be", BY_KIND_ASKED),
    "data-graph": Check("robot category from to to_robot may_be", BY_KIND_ASKED),
    "leaks-behind-leaks": Check(f"{FINDING} path pseudonymised"),
    "lines-behind-findings": Check("findings policy robots categories"),
    "pseudonymised-at-leaks": Check(f"{FINDING} path"),
    "reaching-leak": Check(
        "robot category source pseudonymised dismissed leak_robot path", ({"leak": "/n1"}, {"leak": "cloud1"})
    ),
    "robots": Check("robot verdict findings dismissed open part"),
    "verdicts": Check("verdict view robots part doubts number_of_doubts"),
    "robots-that-differ": Check("robot more_findings fewer_findings more_open fewer_open"),
    "open-elements": Check("frontier distance robot kind element categories"),
    "review-next": Check("distance kind element categories robots"),
    "category-overview": Check("category sources elements findings open"),
    "carrying-both": Check(
        "robot kind element may_be",
        ({"first": "Video", "second": "Voice"}, {"first": "Biometric", "second": "Location"}),
    ),
    "derivations": Check("robot category node source behind_leak source_robot"),
    "reach-of-source": Check("robot category kind element element_robot", ({"source": "/n0"}, {"source": "/n2"})),
    "sources-of-element": Check(
        "robot kind category source source_robot", ({"element": "/n3"}, {"element": "/b"}, {"element": "cloud1"})
    ),
    "path-between": Check("robot", ({"from": "/n0", "to": "/n3", "mundane": "true"},)),
    "storages": Check("robot storage holds written_by read_by"),
    "sanitizers": Check("robot sanitizer category"),
    "unstated-methods": Check("robot sanitizer category label"),
    "leaks-not-reached": Check("robot leak category"),
    "shared-channels": Check("findings robot kind channel categories", ({"least": "1"},)),
    "wildcards-on-leak-paths": Check("robot wildcard"),
    "labels-of-element": Check("robot kind says category label", ({"element": "/n1"}, {"element": "/b"})),
    "mixed-enclaves": Check("robot enclave category sources leaks sanitizers"),
    "unused-grants": Check("robot enclave node role policy", ({"mundane": "true"},)),
    "beyond-profiles": Check("robot asked"),
    "denied-grants-that-cut": Check(
        "robot category start end leak reached end_robot leak_robot", ({"otherwise": "true"},)
    ),
    "enclave-neighbours-of-sanitizers": Check("robot enclave sanitizer category neighbours already reads writes"),
    "bags": Check("bag", memory="none"),
    "message-types": Check("channel", memory="none"),
    "changes": Check("robot what", memory="none"),
    "loads": Check("at", memory="none"),
}


def test_every_question_is_held() -> None:
    assert CHECKS.keys() == pack().keys()


def written(numbers: Iterable[int], folder: Path) -> tuple[list[Fleet], list[RobotRows]]:
    """Fleets of which labels agree: what memory says of them, and their rows."""
    fleets, rows = [], []
    for number in numbers:
        try:
            system = fleet_system(fleet(number, folder, apart=False), QUESTION)
            rows += list(rows_of_fleet(system, QUESTION, answer(system, QUESTION)))
        except InputErrors:
            continue
        system = fleet_system(fleet(number, folder, apart=True), QUESTION)
        fleets.append(Fleet(system, answer(system, QUESTION)))
    return fleets, rows


def asked(driver: Driver, name: str, check: Check, parameters: Mapping[str, str]) -> Counter[tuple[Any, ...]]:
    query = find(name)
    found = driver.execute_query(query.text, query.values(parameters))
    rows = ([record[column] for column in check.columns.split()] for record in found.records if _counts(name, record))
    return Counter(AS_SHOWN.get(name, tuple)([_plain(value) for value in row]) for row in rows)


def _plain(value: Any) -> Any:
    if isinstance(value, list):
        return tuple(map(_plain, value))
    return place_of(value) if isinstance(value, str) and (".xml:" in value or ".yaml:" in value) else value


def _step(row: list[Any]) -> tuple[Any, ...]:
    """Ids as names; what stands for an element at the end of what comes to it is that element."""
    robot, category, start, end, *rest = row
    return (robot, category, start.split("|")[2], end.split("|")[2], *rest)


AS_SHOWN: dict[str, Callable[[list[Any]], tuple[Any, ...]]] = {"data-graph": _step}


def _counts(name: str, row: Record) -> bool:
    """Whether memory says something of a row: not of an element's way to itself, nor of kinds that get nowhere."""
    if name == "data-graph":
        return bool(row["from"] != row["to"])
    return name != "sanitizers" or bool(row["gets"])


ONCE = {  # several rows that differ in other columns only
    "data-graph", "findings-by-data-type", "findings-by-identity-factor", "findings-under-article", "carrying-both",
    "wildcards-on-leak-paths", "labels-of-element", "leaks-not-reached", "unstated-methods", "leak-path-graph",
    "leak-paths-of-category", "denied-grants-that-cut",
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.database
@pytest.mark.parametrize("count", [20, pytest.param(130, marks=pytest.mark.thorough)])
def test_the_rows_are_what_memory_says(count: int, driver: Driver, tmp_path: Path) -> None:
    fleets, rows = written(range(count), tmp_path)
    load(driver, rows, VOCABULARY)
    if count > 100:
        assert len(fleets) >= 100
        across = [f for one in fleets for f in one.analysis.findings if f.source.robot != f.leak.robot]
        assert len(across) > 300
    memory = Memory(fleets)
    robots = [name for one in fleets[1::20] for name in sorted(one.verdicts)]  # of each part of a fleet
    wrong: dict[str, Any] = {}
    for name, check in CHECKS.items():
        takes_robot = any(field.name == "robot" for field in find(name).parameters)
        for parameters in check.parameters:
            for robot in ["", *robots[: 6 if count > 100 else 1]] if takes_robot else [""]:
                given = {**parameters, **({"robot": robot} if robot else {})}
                said = {key: value for key, value in given.items() if key != "mundane"}
                if name == "path-between":
                    said = {"start": said.pop("from"), "end": said.pop("to"), **said}
                method = getattr(memory, check.memory or name.replace("-", "_"))
                expected, found = Counter(method(**said)), asked(driver, name, check, given)
                if name in ONCE:
                    expected, found = Counter({*expected}), Counter({*found})
                if expected != found:
                    wrong.setdefault(name, (given, [*(found - expected)][:3], [*(expected - found)][:3]))
    assert not wrong
