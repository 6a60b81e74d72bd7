"""What is written to Neo4j of the examples is, row for row, what ``golden_rows.tsv`` says; no server is needed.

``python -m tests.ingest.neo4j_graph.test_golden_rows FOLDER`` writes the rows themselves there, one a line and sorted,
to compare those of two commits with ``diff -r``; without a folder it writes a change of the hashes that is wanted.
"""

from __future__ import annotations

import hashlib
import json
import re
import sys
from dataclasses import replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import pytest

from rosprivacy.analysis.python_311 import Self, chdir
from rosprivacy.answering import answer
from rosprivacy.bags import answer_bags
from rosprivacy.both_views import both_views, both_views_of_fleet
from rosprivacy.ingest.neo4j_graph.bag_rows import load_bags
from rosprivacy.ingest.neo4j_graph.loading import load
from rosprivacy.ingest.neo4j_graph.schema import NODES, RELATIONSHIPS
from rosprivacy.question import question_of
from rosprivacy.settings import Settings
from rosprivacy.systems.fleet_system import fleet_system, rows_of_fleet
from rosprivacy.systems.robot_system import answer_robot, robot_of
from tests.golden.runs import FLEETS, ROBOTS, lay_out

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

HASHES = Path(__file__).with_name("golden_rows.tsv")
KIND = re.compile(
    r"(?:(?:MERGE|CREATE) \([nf]:|(?:CREATE|MERGE) \(a\)-\[r:|AS row MATCH \(r:(?=`Robot`.* SET r \+=))`(\w+)`"
)
TYPES = {"STRING": str, "INTEGER": int, "BOOLEAN": bool, "LIST<STRING>": list}
VERSION = ("assumptions", "digest")  # they hold the version of the program


class _Written:
    """A driver, its session, a transaction and its result at once: keeps what is written, and has no robot."""

    def __init__(self, known: tuple[str, ...] = ()) -> None:
        self.lines: list[str] = []
        self._known = known

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        """Nothing is open."""

    def session(self) -> _Written:
        return self

    def execute_write(self, work: Callable[..., Any], *given: Any) -> Any:
        return work(self, *given)

    execute_read = execute_write

    def run(self, statement: str, **parameters: Any) -> Any:
        rows = parameters.pop("rows", [{}])
        self.lines += [json.dumps([statement, parameters, _comparable(row)], sort_keys=True) for row in rows]
        asked = "AS known" in statement
        return _Answer([{"name": name, "version": 1, "known": True} for name in self._known] if asked else [])


class _Answer(list[dict[str, Any]]):
    def consume(self) -> None:
        """There is nothing more."""


def _comparable(row: Any) -> Any:
    if not isinstance(row, dict) or "properties" not in row:
        return row
    return {**row, "properties": {key: value for key, value in row["properties"].items() if key not in VERSION}}


def written() -> Iterator[tuple[str, list[str]]]:
    """By name, what is written of each example."""
    with TemporaryDirectory() as laid, chdir(laid):
        lay_out(Path(laid), None)
        for name, (policy, *more) in ROBOTS.items():
            if name != "misspelt":  # it is refused
                decisions = more[more.index("--decisions") + 1] if "--decisions" in more else None
                settings = Settings(decisions=decisions, allow_unsigned="--allow-unsigned" in more)
                yield from _of_robot(name, (policy,), (more[more.index("-l") + 1],), settings)
        for name, file in [("fleet", "examples/fleet/fleet.yaml"), *_random_fleets()]:
            yield from _of_fleet(name, file)
        care, labels = ROBOTS["care-home"][0], ROBOTS["care-home"][2]
        bags = answer_bags(["examples/care-home/recording"], (care,), (labels,), Settings())
        driver = _Written(("r1",))
        load_bags(driver, bags.rows("r1"), "r1", bags.vocabulary)  # type: ignore[arg-type]  # as above
        yield "bag", sorted(line.replace(str(Path(laid).resolve()), "") for line in driver.lines)


def _random_fleets() -> Iterator[tuple[str, str]]:
    for number in range(FLEETS // 2):
        yield f"f{number:02}", f"random/f{number:02}.fleet.yaml"


def _of_robot(
    name: str, policies: tuple[str, ...], labels: tuple[str, ...], settings: Settings
) -> Iterator[tuple[str, list[str]]]:
    enforced = answer_robot(policies, labels, replace(settings, view="enforced"))
    for view, result in (("both", both_views(policies, labels, settings)), ("enforced", enforced)):
        yield f"{name} {view}", _loaded([robot_of("r1", result)], result.vocabulary)
    yield f"{name} again", _loaded([robot_of("r1", enforced)], enforced.vocabulary, ("r1",))


def _of_fleet(name: str, file: str) -> Iterator[tuple[str, list[str]]]:
    for view, most in (("declared", None), ("enforced", None), ("declared", 1))[:: 2 if name == "fleet" else 1]:
        question = question_of(Settings(view=view))._replace(every=True, most_across=most)
        system = fleet_system(file, question)
        result = answer(system, question)
        if view == "declared" and most is None:
            result = replace(result, enforced=both_views_of_fleet(file, Settings()).enforced)
        rows = rows_of_fleet(system, question, result)
        yield f"{name} {view} {most} {rows.left_out}", _loaded(rows, system.vocabulary)


def _loaded(rows: Any, vocabulary: Any, known: tuple[str, ...] = ()) -> list[str]:
    driver = _Written(known)
    load(driver, rows, vocabulary)  # type: ignore[arg-type]  # as much of a driver as a load needs
    return sorted(driver.lines)


@cache
def all_written() -> dict[str, list[str]]:
    return dict(written())


def hashes() -> Iterator[str]:
    for name, lines in all_written().items():
        yield f"{hashlib.sha256(chr(10).join(lines).encode()).hexdigest()[:16]}\t{len(lines)}\t{name}"


@pytest.mark.slow
def test_rows_are_as_they_were() -> None:
    assert list(hashes()) == HASHES.read_text("utf-8").splitlines()


@pytest.mark.slow
def test_every_property_of_a_row_is_declared_with_its_type() -> None:
    declared = {node.label: node.properties for node in NODES} | {kind.type: kind.properties for kind in RELATIONSHIPS}
    seen = set()
    for statement, _, row in map(json.loads, {line for lines in all_written().values() for line in lines}):
        if isinstance(row, dict) and "row.properties" in statement:
            match = KIND.search(statement)
            assert match, statement
            types = {field.name: TYPES[field.type] for field in declared[match[1]]}
            seen.add(match[1])
            for name, value in row["properties"].items():
                assert value is None or type(value) is types[name], (match[1], name)
                assert not isinstance(value, list) or all(isinstance(item, str) for item in value)
    assert {"Element", "AddedFinding", "Robot", "Bag", "FLOWS_TO", "SANITIZES", "ACROSS"} <= seen


if __name__ == "__main__":
    if sys.argv[1:]:
        folder = Path(sys.argv[1]).resolve()
        for name, lines in all_written().items():
            (folder / name.replace(" ", "-")).write_text("\n".join([*lines, ""]), "utf-8")
    else:
        HASHES.write_text("\n".join([*hashes(), ""]), "utf-8")
