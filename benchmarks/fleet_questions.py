"""The questions of docs/first-questions.md on robots that all differ: what the server looks at for each, as they grow.

The robots are those of ``fleet_wiring``. They are loaded first, against bare writes of the same rows.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from fleet_wiring import fleet, loaded
from graph_database import bare, private_server, served, timed, wipe
from measure import REPOSITORY, Measured, NotMeasured, Row, compared

from rosprivacy.ingest.neo4j_graph.loading import load
from rosprivacy.ontology.vocabulary import load as load_vocabulary

if TYPE_CHECKING:
    from collections.abc import Iterator

    from neo4j import Driver

    from rosprivacy.ingest.neo4j_graph.rows import RobotRows

SIZES = (100, 1_000)  # robots
PAGES = (REPOSITORY / "docs" / "first-questions.md", REPOSITORY / "tests" / "queries" / "more_questions.md")


@dataclass(frozen=True, slots=True)
class Cost:
    """Of one question: how often the server touched its store, and the seconds until it had all rows."""

    hits: int
    seconds: float


def rows(*, quick: bool) -> Iterator[Row]:
    """Declare what is measured.

    Raises
    ------
    NotMeasured
        In the quick form.
    """
    if quick:
        raise NotMeasured("a server and minutes; in the full form only")
    asked = questions()
    with private_server() as (driver, _), TemporaryDirectory() as folder:
        costs: list[dict[str, Cost]] = []
        for robots in SIZES:
            written = list(loaded(fleet(Path(folder), robots), load_vocabulary()))
            yield Row(
                f"load {robots:,} robots that all differ", "bare UNWIND … CREATE",
                partial(_against_bare, driver, written), bound=3,
            )  # fmt: skip
            wipe(driver)
            load(driver, written, load_vocabulary())
            costs.append({title: cost(driver, text) for title, text in asked.items()})
        few, many = costs
        for title in asked:
            yield Row(
                f"hits per robot of {SIZES[1]:,}: {title}", f"{SIZES[0]}", partial(_per_robot, few[title], many[title])
            )


def questions() -> dict[str, str]:
    """The questions of the pages, with the Cypher that is right."""
    parts = [part for page in PAGES for part in re.split(r"^### ", page.read_text("utf-8"), flags=re.MULTILINE)[1:]]
    return {part.partition("\n")[0]: re.findall(r"```cypher\n(.*?)```", part, re.DOTALL)[0] for part in parts}


def _against_bare(driver: Driver, written: list[RobotRows]) -> Measured:
    sides = []
    for write in (lambda: load(driver, written, load_vocabulary()), lambda: bare(driver, written)):
        wipe(driver)
        sides.append([timed(write)])
    return compared(sides, f"{sum(robot.size for robot in written):,} rows")


def cost(driver: Driver, text: str) -> Cost:
    """Ask once to warm up, once for the hits, once for the time."""
    served(driver, text, {})
    with driver.session() as session:
        result = session.run(f"PROFILE {text}")
        list(result)  # a profile is there when all rows are
        plan = result.consume().profile
    return Cost(hits(plan or {}), served(driver, text, {}))


def hits(plan: Any) -> int:
    """How often the store was touched by a plan and all below it."""
    return int(plan.get("dbHits", 0)) + sum(hits(below) for below in plan.get("children", ()))


def _per_robot(few: Cost, many: Cost) -> Measured:
    ratio = many.hits / max(1, few.hits) / (SIZES[1] / SIZES[0])
    return Measured(f"{many.hits:,} in {many.seconds * 1000:.0f} ms", f"{few.hits:,}", ratio)
