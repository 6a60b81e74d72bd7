"""docs/first-questions.md and more_questions.md: each right question gives what memory says, each naive one does not.

One database for both pages: the fleet, the care home and the factory of the examples, a kiosk, a lab in both views, a
cart with a file that nobody read, and a crane without labels.
What memory says is counted from the analysis: a robot of the graph of a fleet stands for all that are like it.
"""

from __future__ import annotations

import re
from collections import Counter
from typing import TYPE_CHECKING, Any, NamedTuple

import pytest

import rosprivacy
from rosprivacy.analysis.errors import InputError
from rosprivacy.analysis.fleet.likeness import NO_ROBOTS
from rosprivacy.analysis.model import DISCLOSURE, STORAGE_LIMITATION, THIRD_COUNTRY, Rank
from rosprivacy.analysis.python_311 import chdir
from rosprivacy.both_views import both_views
from rosprivacy.ingest.neo4j_graph.loading import Run, load
from rosprivacy.private_neo4j import connection
from rosprivacy.robot_doubts import doubt_lines
from rosprivacy.settings import Settings
from rosprivacy.systems.robot_system import robot_of
from tests.helpers.fleet_files import policy, write
from tests.helpers.fleet_rows import VOCABULARY, rows_and_answer
from tests.helpers.graphs import analysed, care_home, factory
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from neo4j import Driver

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.fleet.likeness import Likeness
    from rosprivacy.analysis.model import Element
    from rosprivacy.ingest.neo4j_graph.rows import RobotRows
    from rosprivacy.private_neo4j.connection import Connection
    from rosprivacy.result import Result

PAGE, MORE = ROOT / "docs" / "first-questions.md", ROOT / "tests" / "queries" / "more_questions.md"
SYSTEMS = "tests/cases/queries/systems"
MONDAY, TUESDAY, WEDNESDAY, THURSDAY = (Run(f"2026-11-{day}T08:00:00Z", "1.0", str(day)) for day in range(23, 27))
SITES = {"east": ("factory",), "north": ("carrier_01", "guide_01", "lab"), "south": ("carrier_lent", "kiosk")}
SAME_NUMBER = "the same number of rows"
NO_GROUND = "no source is known, or no leak"  # as the page has it
Rows = Counter[tuple[Any, ...]]


class Block(NamedTuple):
    """A question of the page: its sentence, the right Cypher, and the naive one with what it says of its answer."""

    right: str
    naive: str
    claim: str


def blocks(page: str) -> dict[str, Block]:
    """The questions of a page by their sentences; each has one right block, and at most one naive."""
    questions = {}
    for part in re.split(r"^### ", page, flags=re.MULTILINE)[1:]:
        sentence = part.partition("\n")[0]
        right, *naive = re.findall(r"```cypher\n(.*?)```", part, re.DOTALL)
        assert sentence not in questions
        assert len(naive) <= 1
        assert "// naive" not in right
        claim = re.match(r"// naive: (.*)\n", naive[0]) if naive else None
        assert (claim is None) == (not naive), sentence
        questions[sentence] = Block(right, naive[0] if naive else "", claim[1] if claim else "")
    return questions


TEXT = PAGE.read_text("utf-8") + MORE.read_text("utf-8")
QUESTIONS = blocks(TEXT)


class Standing(NamedTuple):
    """A finding of a pair of robots."""

    robot: str
    leak_robot: str
    finding: Finding

    @property
    def ends(self) -> tuple[str, str, str, str]:
        return self.robot, self.finding.category, self.finding.source.name, self.finding.leak.name


class LoadedSystem:
    """A system as memory has it; of a single robot the elements have no robot, and its name is that of the load."""

    def __init__(self, name: str, result: Result) -> None:
        self.name, self.result, self.analysis = name, result, result.analysis
        self.likeness: Likeness = result.fleet.likeness if result.fleet else NO_ROBOTS

    def robots(self, element: Element) -> tuple[str, ...]:
        """For which robots of the database an element stands."""
        if element.robot in self.likeness.second:
            return ()
        return (self.name,) if self.name else self.likeness.placed(element.robot) or (element.robot,)

    @property
    def robot_names(self) -> list[str]:
        return [self.name] if self.name else [name for group in self.likeness.members.values() for name in group]

    def findings(self) -> Iterator[Standing]:
        for f in self.analysis.findings:
            a, b = f.source.robot, f.leak.robot
            if a in self.likeness.second or self.likeness.second.get(b, a) != a:
                continue
            for robot in self.robots(f.source):
                others = self.likeness.placed(b) if b in self.likeness.second else self.robots(f.leak)
                for other in others if a != b else (robot,):
                    if robot != other or b not in self.likeness.second:
                        yield Standing(robot, other, f)


class Memory:
    """What the analyses say together, question by question."""

    def __init__(self, fleet: Result, cart: Result) -> None:
        kiosk = analysed(f"{SYSTEMS}/kiosk.policy.xml", f"{SYSTEMS}/kiosk.labels.yaml")
        with chdir(ROOT):
            crane = rosprivacy.analyze(["examples/factory/before.policy.xml"])
            self.lab = both_views(
                (f"{SYSTEMS}/shared_enclave.policy.xml",), (f"{SYSTEMS}/shared_enclave.labels.yaml",), Settings()
            )
        self.kiosk = LoadedSystem("kiosk", kiosk)
        self.robots = {
            "care-home": care_home(), "kiosk": kiosk, "factory": factory(1), "lab": self.lab, "cart": cart,
            "crane": crane,
        }  # fmt: skip
        self.systems = [LoadedSystem("", fleet), *(LoadedSystem(name, result) for name, result in self.robots.items())]
        self.all = [s for system in self.systems for s in system.findings()]
        self.standing = [s for s in self.all if not s.finding.dismissed]
        self.names = [name for system in self.systems for name in system.robot_names]

    def rows(self) -> list[RobotRows]:
        """Those of the robots that have a policy each, as they are on Monday."""
        return [robot_of(name, result) for name, result in (self.robots | {"factory": factory(2)}).items()]

    def of_kind(self, kind: str = DISCLOSURE, category: str = "") -> list[Standing]:
        return [s for s in self.standing if s.finding.kind == kind and category in ("", s.finding.category)]

    def places(self, test: Callable[[Element, LoadedSystem], bool]) -> set[tuple[str, str, str]]:
        """(robot, kind, name) of elements."""
        return {
            (robot, element.kind, element.name)
            for system in self.systems
            for element in system.analysis.graph.elements
            if test(element, system)
            for robot in system.robots(element)
        }

    def open_places(self, *, frontier: bool) -> set[tuple[str, str, str]]:
        return {
            (robot, q.element.kind, q.element.name)
            for system in self.systems
            for q in system.analysis.open
            if q.frontier or not frontier
            for robot in system.robots(q.element)
        }

    def carrying(self, category: str = "PersonalData") -> set[tuple[str, str, str]]:
        """Where data of a category, or of a narrower one, gets to."""
        ancestors = VOCABULARY.hierarchy.ancestors
        return {
            (robot, carried.element.kind, carried.element.name)
            for system in self.systems
            for carried in system.analysis.carried
            if any(category in ancestors[kind] for kind in carried.categories)
            for robot in system.robots(carried.element)
        }

    def verdict(self, robot: str) -> str:
        """Of a robot, from what ends at it and what is open on it."""
        if any(robot in (s.robot, s.leak_robot) for s in self.standing):
            return "leak"
        return "undetermined" if any(robot == name for name, _ in self.reasons()) else "no-leak-found"

    def reasons(self) -> set[tuple[str, str]]:
        """(robot, what keeps its verdict from being that no leak was found)."""
        unread = {
            (name, line)
            for name, result in self.robots.items()
            for line in doubt_lines(doubt for doubt in result.doubts if doubt.rank is Rank.BREAKS)
        }
        is_open = {(robot, f"open: {kind} {name}") for robot, kind, name in self.open_places(frontier=False)}
        reasons = unread | is_open
        bare = {name for name, result in self.robots.items() if result.analysis.lacking} - dict(reasons).keys()
        return reasons | {(name, NO_GROUND) for name in bare}

    def article9(self) -> set[tuple[Any, ...]]:
        law = {name: [one.name for one in c.law] for name, c in VOCABULARY.categories.items()}
        return {
            (s.robot, s.finding.kind, *s.ends[1:])
            for s in self.standing
            if any(name.startswith("GDPR Art. 9(1)") for name in law[s.finding.category])
        }

    def across_robots(self) -> list[tuple[Any, ...]]:
        return [
            (s.robot, s.leak_robot, *s.ends[1:])
            for s in self.all
            if s.finding.kind == DISCLOSURE and s.robot != s.leak_robot and {s.robot, s.leak_robot} <= {*self.names}
        ]

    def lines_of_wildcards(self) -> set[tuple[Any, ...]]:
        return {
            (s.robot, wildcard.name, step.grants[0].place.file, step.grants[0].place.line)
            for s in self.standing
            for step in s.finding.steps
            for wildcard in (step.source, step.target)
            if wildcard.side and step.grants
        }

    def additions(self) -> list[tuple[Any, ...]]:
        assert self.lab.enforced is not None
        findings = [added.finding for added in self.lab.enforced.added]
        return [("lab", f.category, f.source.name, f.leak.name) for f in findings]

    def readers(self) -> set[tuple[str]]:
        graph = self.kiosk.analysis.graph
        return {
            (graph.elements[flow.target].name,)
            for flow in graph.flows
            if graph.elements[flow.source].name == "/image" and graph.elements[flow.target].is_node
        }

    def on_a_single_robot(self) -> list[tuple[Any, ...]]:
        alike: dict[Any, list[Standing]] = {}
        for s in self.standing:
            f = s.finding
            leak = "" if s.leak_robot == s.robot or s.leak_robot in self.names else s.leak_robot
            key = f.kind, s.ends[1:], f.pseudonymised, leak, s.leak_robot in self.names and s.leak_robot != s.robot
            alike.setdefault(key, []).append(s)
        return [
            (s.robot, s.finding.kind, *s.ends[1:])
            for group in alike.values()
            if len({s.robot for s in group}) == 1
            for s in group
        ]

    def label_lines(self) -> set[tuple[str, int]]:
        return {
            (statement.place.file, statement.place.line)
            for system in self.systems
            for statements in system.result.bound.elements.values()
            for statement in statements
            if statement.rank[0] == 1
        }

    def changes(self) -> set[tuple[Any, ...]]:
        before, after = ({s.ends for s in LoadedSystem("factory", factory(run)).findings()} for run in (2, 1))
        assert before != after
        return {
            (ends[0], what, *ends[1:])
            for what, some in (("gone", before - after), ("new", after - before))
            for ends in some
        }


def counted(number: int) -> list[tuple[int]]:
    return [(number,)]


CHECKS: dict[str, Callable[[Memory], Any]] = {
    "Whose data gets to a country outside the EEA without a stated basis?": lambda m: {
        (s.robot, s.finding.category, s.finding.leak.name) for s in m.of_kind(THIRD_COUNTRY)
    },
    "From which source does video get to which leak?": lambda m: {
        (s.robot, s.finding.source.name, s.leak_robot, s.finding.leak.name)
        for s in m.all
        if (s.finding.kind, s.finding.category) == (DISCLOSURE, "Video")
    },
    "Which cameras are behind the face templates that get out?": lambda m: {
        (s.robot, s.finding.source.name) for s in m.of_kind(category="FaceTemplate")
    },
    "Where does video get out?": lambda m: {(s.leak_robot, s.finding.leak.name) for s in m.of_kind(category="Video")},
    "How many pairs of a source and a leak are there to work on?": lambda m: counted(len(m.of_kind())),
    "How many findings begin or end at each robot?": lambda m: [
        (name, sum(name in (s.robot, s.leak_robot) for s in m.standing)) for name in m.names
    ],
    "Whose video gets out as it is, not pseudonymised?": lambda m: {
        (s.robot,) for s in m.of_kind(category="Video") if not s.finding.pseudonymised
    },
    "Which findings can fall under Article 9(1)?": Memory.article9,
    "Whose data gets out at another robot?": Memory.across_robots,
    "What could get out if nodes went beyond their own profiles?": Memory.additions,
    "Which policy lines let findings pass a name with wildcards?": Memory.lines_of_wildcards,
    "Which nodes may read the topic `/image` of the kiosk?": Memory.readers,
    "How many services does personal data get to?": lambda m: counted(
        sum(kind == "service" for _, kind, _ in m.carrying())
    ),
    "How many elements has the care home?": lambda _: counted(len(care_home().analysis.graph.elements)),
    "Which elements does biometric data get to?": lambda m: m.carrying("Biometric"),
    "What is kept too long, and where?": lambda m: {
        (s.leak_robot, s.finding.leak.name, s.finding.category) for s in m.of_kind(STORAGE_LIMITATION)
    },
    "How many robots are there?": lambda m: counted(len(m.names)),
    "On which robots was no leak found, with nothing left open?": lambda m: [
        (name,) for name in m.names if m.verdict(name) == "no-leak-found"
    ],
    "On which robots is the verdict undetermined, and why?": lambda m: [
        reason for reason in m.reasons() if m.verdict(reason[0]) == "undetermined"
    ],
    "Which elements should a person review first?": lambda m: m.open_places(frontier=True),
    "What is a finding on a single robot only?": Memory.on_a_single_robot,
    "How many findings begin at each of our sites?": lambda m: [
        (site, sum(s.robot in robots for s in m.standing)) for site, robots in SITES.items()
    ],
    "How many lines of our label files say something of elements?": lambda m: counted(len(m.label_lines())),
    "Which findings came or went since Tuesday?": Memory.changes,
    "Which loads were cut off?": lambda _: [(THURSDAY.at,)],
}


@pytest.fixture(scope="module")
def memory(neo4j_server: Connection, tmp_path_factory: pytest.TempPathFactory) -> Memory:
    """What memory says, once the database of the page is there."""
    assert neo4j_server
    cart = cart_of(tmp_path_factory.mktemp("cart"))
    with chdir(ROOT):
        fleet, result = rows_and_answer("examples/fleet/fleet.yaml")
        memory = Memory(result, cart)
        with connection.open_driver(connection.connection(None)) as driver:
            driver.execute_query("MATCH (n) DETACH DELETE n")
            load(driver, [*fleet, *memory.rows()], VOCABULARY, run_of=MONDAY)
            driver.execute_query(
                "UNWIND $pairs AS pair MERGE (s:Site {name: pair[0]}) WITH s, pair "
                "MATCH (r:Robot {name: pair[1]}) CREATE (r)-[:STANDS_AT]->(s)",
                pairs=[[site, robot] for site, robots in SITES.items() for robot in robots],
            )
            load(driver, [robot_of("factory", factory(1))], VOCABULARY, run_of=TUESDAY)
            load(driver, [robot_of("factory", factory(1))], VOCABULARY, run_of=WEDNESDAY)
            with pytest.raises(InputError):
                load(driver, cut_off(), VOCABULARY, run_of=THURSDAY)
    return memory


@pytest.fixture(scope="module")
def page_driver(memory: Memory) -> Iterator[Driver]:
    assert memory
    with connection.open_driver(connection.connection(None)) as driver:
        yield driver


def cart_of(folder: Path) -> Result:
    """A robot with a file that nobody read, and a channel that nobody known reads."""
    with chdir(folder):
        write("cart/robot.policy.xml", policy("/camera>/image,/shout", "/screen</image", "/uplink</warmth"))
        write("cart/part.xml", policy("/camera>/more").partition("<enclaves>")[2].partition("</enclaves>")[0])
        write(
            "cart.yaml",
            "labels: 1\nnodes: {/camera: {source: [Video]}, /screen: conduit, /uplink: {leak: [Video]}}\n"
            "channels: {/image: sensitive, /shout: sensitive}\n",
        )
        return rosprivacy.analyze(["cart"], ["cart.yaml"])


def cut_off() -> Iterator[RobotRows]:
    """Robots of a file that cannot be read to its end."""
    yield robot_of("factory", factory(1))
    raise InputError("fleet.yaml", 1, "is gone", "")


def asked(driver: Driver, query: str) -> Rows:
    records = driver.execute_query(query).records
    return Counter(tuple(record.values()) for record in records)


def operators(plan: dict[str, Any]) -> Iterator[str]:
    yield plan["operatorType"].partition("@")[0]
    for child in plan.get("children", ()):
        yield from operators(child)


def claim_of(right: Rows, naive: Rows) -> str:
    """What the page says of a naive answer beside the right one.

    Its only number; where each row is a name with a number, the first number that is another; else how many rows it is.
    """
    numbers, others = (
        {row[0] if len(row) > 1 else "": row[-1] for row in sorted(rows, key=str) if isinstance(row[-1], int)}
        for rows in (right, naive)
    )
    if len(numbers) == right.total() and len(others) == naive.total() and {len(row) for row in right} <= {1, 2}:
        name = next(name for name in numbers if name in others and numbers[name] != others[name])
        return f"{others[name]:,}{f' for {name}' if name else ''}, not {numbers[name]:,}"
    if right.total() == naive.total():
        return SAME_NUMBER
    return f"{naive.total():,} {'row' if naive.total() == 1 else 'rows'}, not {right.total():,}"


def test_each_question_has_a_check() -> None:
    assert QUESTIONS.keys() == CHECKS.keys()
    assert len(QUESTIONS) <= 25
    assert TEXT.count("```cypher\n") == sum(1 + bool(block.naive) for block in QUESTIONS.values())


@pytest.mark.database
@pytest.mark.parametrize("question", QUESTIONS)
def test_the_right_form_gives_what_memory_says(question: str, memory: Memory, page_driver: Driver) -> None:
    block = QUESTIONS[question]
    expected = Counter(CHECKS[question](memory))
    assert expected
    assert asked(page_driver, block.right) == expected
    plan = page_driver.execute_query("EXPLAIN " + block.right).summary.plan
    assert plan
    assert "AllNodesScan" not in [*operators(plan)]


@pytest.mark.database
@pytest.mark.parametrize("question", [question for question, block in QUESTIONS.items() if block.naive])
def test_the_naive_form_gives_something_else(question: str, page_driver: Driver) -> None:
    block = QUESTIONS[question]
    right, naive = asked(page_driver, block.right), asked(page_driver, block.naive)
    assert right != naive
    assert block.claim == claim_of(right, naive)
