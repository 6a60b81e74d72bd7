"""Equal robots made from the public TurtleBot3 policy: 24 kinds of data, one cloud that all write to and hear from.

The program reads equal robots once and lets two of them stand for all. So a fleet is measured both ways: through the
fleet file, as a user would, and with every robot placed as itself, as if it was like no other.
"""

from __future__ import annotations

import json
import multiprocessing
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from lxml import etree
from measure import Measured, Row, calls_per_robot, corpus, per_robot, side_by_side, timed, timed_or_counted
from turtlebot import MANY, POLICY, STEP_5, chosen_categories, label_file, six_lists

from rosprivacy.analysis.findings.concerns import concerns
from rosprivacy.analysis.fleet.patterns_of_pairs import Groups
from rosprivacy.analysis.kernel.spreading import spread
from rosprivacy.answering import answer
from rosprivacy.ingest.fleet.alike_robots import Alike
from rosprivacy.ingest.fleet.fleet_graph import place
from rosprivacy.ontology.vocabulary import load
from rosprivacy.question import Question
from rosprivacy.settings import Settings
from rosprivacy.systems.fleet_system import fleet_system

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from typing import Any

    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.ingest.fleet.fleet_graph import Placed
    from rosprivacy.ontology.vocabulary import Vocabulary

ROBOTS = 1_000
SMALL = ("/camera", "/filter", "/planner", "/uplink", "/base")  # nodes of a small robot that have a label


def turtlebots(folder: Path, robots: int) -> str:
    """Write the file of a fleet of so many robots; return its name."""
    base = json.loads((corpus() / STEP_5).read_text("utf-8"))
    names, made_up = chosen_categories(MANY)
    assert not made_up, "the ontology has so many kinds"
    labels = folder / "turtlebot.labels.json"
    labels.write_text(label_file({name: six_lists(base, i) for i, name in enumerate(names)}), "utf-8")
    model = {"policies": [str(corpus() / POLICY)], "labels": [labels.name]}
    flows = [{"from": "*:/recoveries_server", "to": "cloud"}, {"from": "cloud", "to": "*:/amcl"}]
    return _written(folder / f"turtlebots{robots}.json", {"robot": model}, robots, flows)


def small_robots(folder: Path, robots: int) -> str:
    """The same for robots of 20 nodes and 60 topics."""
    model = _small_model(folder)
    flows = [{"from": "*:/uplink", "to": "cloud"}, {"from": "cloud", "to": "*:/planner"}]
    return _written(folder / f"small{robots}.json", {"robot": model}, robots, flows)


def different_robots(folder: Path, robots: int) -> str:
    """The same for robots of which each has a policy of its own, with a topic of its own."""
    models = {f"robot{i}": _small_model(folder, f"/own{i}") for i in range(robots)}
    flows = [{"from": "*:/uplink", "to": "cloud"}, {"from": "cloud", "to": "*:/planner"}]
    return _written(folder / f"different{robots}.json", models, 1, flows)


def _small_model(folder: Path, own: str = "") -> dict[str, Any]:
    """Write policy and labels of a small robot; ``own`` is a topic that one of its nodes writes beside the others."""
    policy = folder / f"small{own.removeprefix('/')}.policy.xml"
    nodes = [*SMALL, *(f"/node{i:02}" for i in range(20 - len(SMALL)))]
    profiles = []
    for i, node in enumerate(nodes):
        written = "".join(f"<topic>/topic{3 * i + j:02}</topic>" for j in range(3))
        written += f"<topic>{own}</topic>" if own and node == nodes[-1] else ""
        read = "".join(f"<topic>/topic{(3 * i - 1 - 2 * j) % 60:02}</topic>" for j in range(6))
        lines = f'<topics publish="ALLOW">{written}</topics><topics subscribe="ALLOW">{read}</topics>'
        profiles.append(f'<profile ns="/" node="{node[1:]}">{lines}</profile>')
    enclave = f'<enclave path="/robot"><profiles>{"".join(profiles)}</profiles></enclave>'
    policy.write_text(f'<policy version="0.2.0"><enclaves>{enclave}</enclaves></policy>', "utf-8")
    labels = folder / "small.labels.json"
    said = {"/camera": {"source": ["Video"]}, "/uplink": {"leak": ["Voice"]}, "/base": {"source": ["Location"]}}
    labels.write_text(json.dumps({"labels": 1, "nodes": said}), "utf-8")
    return {"policies": [policy.name], "labels": [labels.name]}


def _written(file: Path, models: dict[str, dict[str, Any]], each: int, flows: list[dict[str, str]]) -> str:
    fleet = {
        "fleet": 1,
        "models": models,
        "groups": [{"robots": each, "model": model} for model in models],
        "elements": {"cloud": {"kind": "external-system", "country": "DE"}},
        "flows": flows,
    }
    file.write_text(json.dumps(fleet), "utf-8")
    return str(file)


def everything(known: Vocabulary) -> Question:
    """What is asked: all that is known."""
    return Question(Settings(include_root="/"), known, None, None, "")


def answered(file: str, known: Vocabulary) -> dict[str, Any]:
    """Read a fleet, analyse it, and make the report: all that a command does but start."""
    question = everything(known)
    return answer(fleet_system(file, question), question).document()


def as_themselves(file: str, known: Vocabulary) -> Placed:
    """The graph of a fleet in which each robot stands for itself, as if no two were alike."""
    read = fleet_system(file, everything(known))
    (member,) = read.members.values()
    groups = [Alike((robot,), joined=True) for robot in read.fleet.robots]
    return place(read.fleet, groups, {r.id: replace(member, robot=r) for r in read.fleet.robots}, "declared")


def sets(placed: Placed, known: Vocabulary) -> Spread:
    """All categories through the graph."""
    return spread(placed.graph, placed.bound, known.hierarchy)


def patterns(placed: Placed, known: Vocabulary) -> int:
    """The same, and all pairs of source and leak put into patterns: everything but the ways."""
    found = sets(placed, known)
    kinds = tuple(concerns(found, placed.bound, known.hierarchy))
    return sum(len(some) for some in Groups(placed.likeness)(found, kinds, found.all_bits).values())


def rows(*, quick: bool) -> Iterator[Row]:
    """Declare what is measured: equal robots through the fleet file, and the same each placed as itself."""
    known = load()
    with TemporaryDirectory() as name:
        folder = Path(name)
        robots = ROBOTS // 10 if quick else ROBOTS
        yield Row(
            f"{robots:,} equal TurtleBot3, fleet file to report",
            "one",
            lambda: _equal(folder, known, robots, quick=quick),
            bound=20,
            counts=quick,
        )
        sizes = (10_000 if quick else 100_000, 1_000)
        what = f"per robot, fleet file to report: {sizes[0]:,} equal small ones"
        yield Row(what, f"{sizes[1]:,}", lambda: _small(folder, known, sizes, quick=quick), 1.5, counts=quick)
        different = (200, 50) if quick else (1_000, 100)
        what = f"per robot, fleet file to report: {different[0]:,} different small ones"
        yield Row(
            what, f"{different[1]:,}", lambda: _different(folder, known, different, quick=quick), 1.5, counts=quick
        )
        what = f"{different[0]:,} different small robots, fleet file to report"
        yield Row(what, "bare lxml", lambda: _bare(folder, known, different[0]), bound=90)
        if quick:
            return
        large, small = 300, 30
        placed = [as_themselves(turtlebots(folder, robots), known) for robots in (large, small)]
        what = f"per TurtleBot3: {large} placed as themselves"
        yield Row(what, f"{small}", lambda: _placed(sets, placed, known, (large, small)), bound=1.5)
        what = "the same, with patterns of all pairs, which grow with the square"
        yield Row(what, f"{small}", lambda: _placed(patterns, placed, known, (large, small)))
        what = f"memory of {large} TurtleBot3 placed as themselves, per million flows"
        yield Row(what, "", lambda: _memory(folder, large))


def _equal(folder: Path, known: Vocabulary, robots: int, *, quick: bool) -> Measured:
    """Compare a fleet of equal robots with one of them.

    Raises
    ------
    AssertionError
        If the cloud does not join the robots: then it would be a thousand times one robot.
    """
    many, one = turtlebots(folder, robots), turtlebots(folder, 1)
    told = answered(many, known)
    across = [p for p in told["fleet"]["patterns"] if p["across"]]
    assert across[0]["findings"] == robots * (robots - 1), "everything is connected"
    size = f"{told['elements']:,} elements, {told['flows']:,} flows, {MANY} kinds; read and analysed once, two for all"
    return timed_or_counted(5, lambda: answered(many, known), lambda: answered(one, known), quick=quick, note=size)


def _small(folder: Path, known: Vocabulary, sizes: tuple[int, int], *, quick: bool) -> Measured:
    large, small = (small_robots(folder, robots) for robots in sizes)
    note = "there is little to do for each, so the cost of each falls"
    return each_of((large, small), known, sizes, note, quick=quick)


def _different(folder: Path, known: Vocabulary, sizes: tuple[int, int], *, quick: bool) -> Measured:
    large, small = (different_robots(folder, robots) for robots in sizes)
    return each_of((large, small), known, sizes, "80 elements each, and a cloud that joins all", quick=quick)


def each_of(fleets: tuple[str, str], known: Vocabulary, sizes: tuple[int, int], note: str, *, quick: bool) -> Measured:
    """Compare what one robot costs in a large fleet and in a small one, in the quick form by calls."""
    works = (lambda: answered(fleets[0], known)), (lambda: answered(fleets[1], known))
    if quick:
        return replace(calls_per_robot(*works, sizes), note=note)
    return per_robot(side_by_side(3, *works), sizes, note)


def _bare(folder: Path, known: Vocabulary, robots: int) -> Measured:
    """Time different robots against lxml, which goes through the elements of their policies and does nothing more."""
    file = different_robots(folder, robots)
    policies = [folder / f"smallown{i}.policy.xml" for i in range(robots)]
    return timed(
        3, lambda: answered(file, known), lambda: [sum(1 for _ in etree.parse(policy).iter()) for policy in policies]
    )


def _placed(
    work: Callable[[Placed, Vocabulary], object], placed: list[Placed], known: Vocabulary, sizes: tuple[int, int]
) -> Measured:
    seconds = side_by_side(1, lambda: work(placed[0], known), lambda: work(placed[1], known))
    size = f"{len(placed[0].graph.elements):,} elements, {len(placed[0].graph.flows):,} flows as Python objects"
    return per_robot(seconds, sizes, size)


def _memory(folder: Path, robots: int) -> Measured:
    """Peak of a process of its own that does the same."""
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        peak, flows = pool.apply(_peak, (turtlebots(folder, robots),))
    note = "resident peak of a process of its own, less what it has before it reads: graph, sets and pairs"
    return Measured(f"{peak / flows:.0f} MB", note=note)


def _peak(file: str) -> tuple[int, int]:
    """(bytes more than at the start, flows)."""
    known = load()
    answered(file, known)  # imports and caches; one robot's worth of objects
    before = _resident()
    placed = as_themselves(file, known)
    patterns(placed, known)
    return _resident() - before, len(placed.graph.flows)


def _resident() -> int:
    """The most that this process has held in memory so far, in bytes; not what its parent held, as getrusage says."""
    lines = Path("/proc/self/status").read_text("ascii").splitlines()
    return next(int(line.split()[1]) * 1024 for line in lines if line.startswith("VmHWM"))
