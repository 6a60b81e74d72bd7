"""Our whole command against the paper's method: TurtleBot3, 1, 3 and 24 kinds of data, fresh processes.

The paper's method answers for one kind of data, so it runs once for each, one process after the other; ours runs once.
Both sides get the same roles: for the first kind exactly those of the paper's own file (step 5), for the others a
few elements play another role, so that neither side answers the same question twice.
"""

from __future__ import annotations

import json
import sys
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from measure import REPOSITORY, Row, corpus, run, run_each, timed
from more_categories import extra_names

from rosprivacy.ontology.vocabulary import load

if TYPE_CHECKING:
    from collections.abc import Iterator

POLICY = "policies/ros-swg__turtlebot3_demo/policies/tb3_gazebo_policy.xml"
STEP_5 = "categorizations/JonasWoh__ROS2PrivacyGraph/categorizations/categorization_turtlebot3_step_5.json"
MANY = 24
START = "half of it is start: Python, typer, lxml, YAML and our own modules"
BENCHMARKS = REPOSITORY / "benchmarks"

SixLists = dict[str, list[str]]


def rows(*, quick: bool) -> Iterator[Row]:
    """Declare what is measured: both sides for 1, 3 and 24 kinds of data."""
    policies = corpus()
    base = json.loads((policies / STEP_5).read_text("utf-8"))
    policy = policies / POLICY
    for count in (1, 3, MANY):
        with TemporaryDirectory() as name:
            folder = Path(name)
            names, extra = chosen_categories(count)
            lists = {name: six_lists(base, number) for number, name in enumerate(names)}
            ours = _ours(policy, folder, lists, extra)
            papers = [_paper(policy, folder, name, one) for name, one in lists.items()]
            rounds = (2 if quick else 5) if count == MANY else (5 if quick else 15)
            run(*ours)
            _check(folder, names)
            note = f"{extra} of the {count} kinds are made up in memory: the ontology has too few" if extra else ""
            yield Row(
                f"the command, {count} kind{'s' if count > 1 else ''} of data, TurtleBot3",
                "the paper's method for each",
                partial(timed, rounds, partial(run, *ours), partial(run_each, papers), note=note),
            )
            if count == MANY:
                yield Row(
                    f"the command, {MANY} kinds of data, TurtleBot3",
                    "the paper's method for ONE",
                    partial(timed, rounds * 4, partial(run, *ours), partial(run, *papers[0]), note=START),
                    bound=1,
                    goal=True,
                )


def chosen_categories(count: int) -> tuple[list[str], int]:
    """Return names of kinds of data of which none is broader than another, and how many of them are made up.

    The paper's runs know nothing of each other, so no statement about one kind may hold for another.
    """
    ancestors = load().hierarchy.ancestors
    inner = {above for name, up in ancestors.items() for above in up if above != name}
    names = sorted(name for name in ancestors if name not in inner)[:count]
    extra = count - len(names)
    return names + extra_names(extra), extra


def six_lists(base: SixLists, number: int) -> SixLists:
    """Return the paper's categorization, from the second kind of data on with a few roles changed.

    One conduit becomes a source, a leak or a sanitizer, and one mundane channel sensitive.
    """
    lists = {role: list(names) for role, names in base.items()}
    if number:
        conduits, mundane = base["conduit"], base["mundane"]
        conduit = conduits[number % len(conduits)]
        lists["conduit"].remove(conduit)
        lists[("source", "leak", "sanitizer")[number // len(conduits) % 3]].append(conduit)
        channel = mundane[number * 5 // 3 % len(mundane)]
        lists["mundane"].remove(channel)
        lists["sensitive"].append(channel)
    return lists


def labels_of(names: list[str], folder: Path) -> Path:
    """Write a label file that says of each of some kinds of data what the paper's own file says, a little varied."""
    base = json.loads(corpus().joinpath(STEP_5).read_text("utf-8"))
    file = folder / f"{len(names)}.yaml"
    file.write_text(label_file({name: six_lists(base, number) for number, name in enumerate(names)}), "utf-8")
    return file


def label_file(lists: dict[str, SixLists]) -> str:
    """Return one label file (JSON is YAML too) that says of every kind of data what its six lists say."""
    nodes: dict[str, dict[str, object]] = {}
    channels: dict[str, object] = {}
    for role in ("source", "leak", "conduit"):
        for name, of in _named(lists, role).items():
            nodes.setdefault(name, {})[role] = of
    for name, of in _named(lists, "sanitizer").items():
        nodes.setdefault(name, {})["sanitizer"] = dict.fromkeys(of, "anonymise")
    for name in _named(lists, "sensitive"):
        channels[name] = "sensitive"
    for name, of in _named(lists, "mundane").items():
        channels[name] = "mundane" if len(of) == len(lists) else {"never": of}
    return json.dumps({"labels": 1, "nodes": nodes, "channels": channels}, indent=1)


def _named(lists: dict[str, SixLists], role: str) -> dict[str, list[str]]:
    """Element -> the kinds of data for which it has a role."""
    found: dict[str, list[str]] = {}
    for category, one in lists.items():
        for name in one[role]:
            found.setdefault(name, []).append(category)
    return found


def _ours(policy: Path, folder: Path, lists: dict[str, SixLists], extra: int) -> list[str | Path]:
    labels = folder / f"{len(lists)}.labels.yaml"
    labels.write_text(label_file(lists), "utf-8")
    program = [BENCHMARKS / "more_categories.py", str(extra)] if extra else ["-m", "rosprivacy"]
    options = ["--fail-on", "never", "--output", folder / "report.txt"]
    return [sys.executable, *program, "analyze", policy, "--labels", labels, *options]


def _paper(policy: Path, folder: Path, name: str, lists: SixLists) -> list[str | Path]:
    file = folder / f"{name}.json"
    file.write_text(json.dumps(lists), "utf-8")
    return [sys.executable, BENCHMARKS / "paper_method.py", policy, file]


def _check(folder: Path, names: list[str]) -> None:
    """Whether the report is about every kind of data: a run that answers less would be no measure."""
    report = (folder / "report.txt").read_text("utf-8")
    missing = [name for name in names if f"{name}: " not in report]
    if missing:
        sys.exit(f"no finding for {', '.join(missing)}")
