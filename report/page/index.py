"""A JSON document, looked up: what labels say of an element, what is open, what a kind of data is called.

In: a document of the contract and the words of a language. Out: an ``Index``, for the parts of a report. Keys that a
document may lack (``outside``, ``decisions``, …) are empty here. What differs only in the robot is one entry, with its
robots counted and listed (rule S10); robots of one row are told apart by the order in which they are named, so that a
path from one robot to another is not one inside a robot.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.model.message_type import PARAMETER_SERVICES
from rosprivacy.analysis.model.register_row import Cell
from rosprivacy.analysis.text import fit
from rosprivacy.report.finding_facts import grouped, looked_at
from rosprivacy.report.naming import key, name, text

if TYPE_CHECKING:
    from collections.abc import Collection, Hashable, Iterable, Mapping, Sequence

    from rosprivacy.report.catalogs.words import Words
    from rosprivacy.report.naming import Key

NOBODY: Mapping[str, Collection[str]] = MappingProxyType({})


@dataclass(frozen=True)
class Index:
    """Look-ups in a document; each is made once, when it is first used."""

    document: Mapping[str, Any]
    words: Words = field(repr=False)

    @cached_property
    def categories(self) -> dict[str, Mapping[str, Any]]:
        """By name."""
        return {category["name"]: category for category in self.document["categories"]}

    @cached_property
    def looked_at(self) -> list[Mapping[str, Any]]:
        """The provisions to look at that a reader sees."""
        return looked_at(self.document)

    @cached_property
    def roles(self) -> dict[tuple[Key, str], list[str]]:
        """(element, category) -> what labels say of it."""
        return {(key(said["element"]), said["category"]): said["roles"] for said in self.document["roles"]}

    @cached_property
    def cleaned(self) -> dict[tuple[Key, str], Mapping[str, Any]]:
        """(element, category) that gets there and is said to be cleaned there -> what is said."""
        reached = (row for row in self.document["sanitizers"] if row["reached"])
        return {(key(row["element"]), row["category"]): row for row in reached}

    @cached_property
    def of_role(self) -> dict[str, dict[Key, list[str]]]:
        """Role -> element -> categories."""
        found: dict[str, dict[Key, list[str]]] = {}
        for (element, category), roles in self.roles.items():
            for role in roles:
                found.setdefault(role, {}).setdefault(element, []).append(category)
        return found

    @cached_property
    def elements(self) -> dict[Key, Mapping[str, Any]]:
        """Elements that a label, a fact or data speaks of, by key."""
        rows = [*self.document["roles"], *self.outside.values(), *self.document["carries"], *self.document["open"]]
        found = {key(row["element"]): row["element"] for row in rows}
        found |= {key(element): element for finding in self.findings for element in finding["witness"]}
        return found

    @cached_property
    def unreviewed(self) -> set[tuple[Key, str]]:
        """(element, category) that nobody has reviewed."""
        return {
            (key(question["element"]), name) for question in self.document["open"] for name in question["categories"]
        }

    @cached_property
    def outside(self) -> dict[Key, Mapping[str, Any]]:
        """What is stated about elements outside ROS."""
        return {key(row["element"]): row for row in self.document.get("outside", ())}

    @cached_property
    def subjects(self) -> dict[Key, list[str]]:
        """Whom the data of a source are about."""
        return {key(row["element"]): [fit(group) for group in row["subjects"]] for row in self.document["subjects"]}

    @property
    def register(self) -> Sequence[Mapping[str, Any]]:
        """The rows of the register."""
        rows: Sequence[Mapping[str, Any]] = self.document.get("register", ())
        return rows

    @cached_property
    def periods(self) -> dict[tuple[Key, str], tuple[str, ...]]:
        """(place, kind of data) -> how long it is kept there, by the rows of the register."""
        return {
            (key(place), row["category"]): tuple(row["retention"]) for row in self.register for place in row["places"]
        }

    def is_of(self, group: str | None, category: str) -> bool:
        """Return whether data of a group of persons are there as a kind; of None, of those that labels do not name."""
        rows = [row for row in self.register if row["category"] == category]
        if group is None:
            return not rows or any(Cell.SUBJECTS in row["to_complete"] for row in rows)
        return any(group == fit(name) for row in rows for name in row["subjects"])

    @cached_property
    def processed_for(self) -> dict[tuple[Key, str], Mapping[str, Any]]:
        """(element, category) -> what data that begin or end there are processed for, and on which basis."""
        return {(key(row["element"]), row["category"]): row for row in self.document.get("processed_for", ())}

    @property
    def findings(self) -> list[Mapping[str, Any]]:
        """All findings."""
        return list(self.document["findings"])

    @cached_property
    def by_id(self) -> dict[str, Mapping[str, Any]]:
        """Findings by their id."""
        return {finding["id"]: finding for finding in self.document["findings"]}

    @cached_property
    def to_assess(self) -> list[Mapping[str, Any]]:
        """Findings that are neither dismissed nor accepted."""
        return [finding for finding in self.findings if state(finding) == "open"]

    def data(self, category: str, *, pseudonymised: bool = False) -> str:
        """Return what a kind of data is called."""
        known = self.categories.get(category)
        title = (known and text(known, "title", self.words.language)) or self.words.of_value(
            f"category.{category}", fit(category)
        )
        return self.words("entry.data", data=title) if pseudonymised else title

    def provision(self, category: str, name: str) -> str:
        """Return what a provision that is stated of a kind of data is called; its name where it is not known."""
        known = self.categories.get(category, {})
        stated = (*known.get("law", ()), *known.get("in_context", ()))
        legal = next((legal for legal in stated if legal["provision"] == name), None)
        return text(legal, "provision", self.words.language) if legal else fit(name)

    def upwards(self, category: str) -> list[str]:
        """Return a kind of data and all broader ones, the nearest first."""
        return [category, *self.categories[category]["broader"]] if category in self.categories else [category]

    def all_data(self, categories: Iterable[str]) -> str:
        """Return several kinds of data in a row."""
        return self.words.row(self.data(category) for category in categories)

    def robots(self) -> list[str]:
        """Return the names of the robots that data or a finding is at; of a fleet, of all robots."""
        if self.alike:
            return sorted(robot for robots in self.alike.values() for robot in robots)
        return sorted({element["robot"] for element in self.elements.values()} - {""})

    @cached_property
    def alike(self) -> dict[str, list[str]]:
        """A robot of a fleet that is shown -> all that it stands for, itself included; empty for a single robot."""
        fleet = self.document.get("fleet")
        return {group["robot"]: group["robots"] for group in fleet["alike"]} if fleet else {}

    @cached_property
    def patterns(self) -> dict[str, Mapping[str, Any]]:
        """Id of a finding of a fleet -> the pattern that it shows."""
        fleet = self.document.get("fleet")
        return {pattern["finding"]: pattern for pattern in fleet["patterns"]} if fleet else {}

    def names(self, elements: Iterable[Mapping[str, Any]]) -> tuple[str, ...]:
        """Return the names of elements, each once; one that several robots have, with their number."""
        return names_of(elements, self.words, self.alike)

    def names_by_node(self, elements: Iterable[Mapping[str, Any]], *, counted: bool = False) -> tuple[str, ...]:
        """Return the same, where all parameter services of a node are one; or, counted, those of all nodes."""
        nodes, others = whole_nodes(elements)
        if counted:
            of_nodes = self.words.count(weight((robot for robot, _ in nodes), self.alike), "node")
        else:
            of_nodes = self.words.row(
                self.names({"robot": robot, "kind": "node", "name": node} for robot, node in nodes)
            )
        return (*([self.words("services", nodes=of_nodes)] if nodes else []), *self.names(others))


def state(finding: Mapping[str, Any]) -> str:
    """Return where a finding stands: ``accepted``, ``dismissed`` or ``open``."""
    if finding.get("accepted"):
        return "accepted"
    return "dismissed" if finding["dismissed"] else "open"


def node_of_service(element: Mapping[str, Any]) -> tuple[str, str] | None:
    """Return (robot, name) of the node whose parameter service an element is; None if it is none.

    >>> node_of_service({"robot": "r", "kind": "service", "name": "/camera/list_parameters"})
    ('r', '/camera')
    """
    node, _, service = element["name"].rpartition("/")
    return (element["robot"], node) if element["kind"] == "service" and service in PARAMETER_SERVICES else None


def whole_nodes(
    elements: Iterable[Mapping[str, Any]],
) -> tuple[tuple[tuple[str, str], ...], tuple[Mapping[str, Any], ...]]:
    """Return the nodes of which all parameter services are among the elements, as (robot, name), and the others."""
    elements = tuple(elements)
    services: dict[tuple[str, str], set[str]] = {}
    for element in elements:
        if node := node_of_service(element):
            services.setdefault(node, set()).add(element["name"].rpartition("/")[2])
    whole = tuple(node for node, names in services.items() if names == PARAMETER_SERVICES.keys())
    return whole, tuple(element for element in elements if node_of_service(element) not in whole)


def anchor(finding_id: str) -> str:
    """Return where a finding stands in a page."""
    return f"way-{finding_id}"


def kind_anchor(name: str) -> str:
    """Return where a kind of data stands in a page; names are parts of IRIs, so anything may be in them."""
    return f"kind-{''.join(c if c.isascii() and c.isalnum() else f'_{ord(c):x}' for c in fit(name))}"


def without_robots(elements: Iterable[Mapping[str, Any]]) -> tuple[tuple[Any, ...], ...]:
    """Return elements with numbers in place of robots.

    >>> without_robots([{"robot": "b", "kind": "node", "name": "/x"}, {"robot": "a", "kind": "topic", "name": "/y"}])
    ((0, 'node', '/x', '', False), (1, 'topic', '/y', '', False))
    """
    numbers: dict[str, int] = {"": -1}
    return tuple(
        (numbers.setdefault(e["robot"], len(numbers) - 1), e["kind"], e["name"], e.get("leg", ""), "pattern" in e)
        for e in elements
    )


def finding_pattern(finding: Mapping[str, Any]) -> Hashable:
    """Return what findings have in common that differ only in the robot; policy files are the robot's own."""
    elements = [*finding["witness"], finding["source"], finding["leak"], *finding["through"]]
    elements += [finding["special_from"]] if finding["special_from"] else []
    elements += [element for path in finding.get("paths", ()) for element in path]
    steps = tuple((step["role"], step["category"], step["pseudonymised"]) for step in finding.get("steps", ()))
    same = (finding["kind"], finding["category"], finding["pseudonymised"], finding["dismissed"])
    more = (finding.get("accepted"), finding.get("reason"), finding["disjoint_paths"])
    return (same, more, without_robots(elements), steps, tuple(map(len, finding.get("paths", ()))))


def names_of(
    elements: Iterable[Mapping[str, Any]], words: Words, alike: Mapping[str, Collection[str]] = NOBODY
) -> tuple[str, ...]:
    """Return the names of elements, each once; one that several robots have, with their number.

    Parameters
    ----------
    alike
        A robot that stands for others -> these and itself.

    >>> from rosprivacy.report.catalogs.words import Words
    >>> names_of([{"robot": r, "kind": "node", "name": "/camera"} for r in ("r1", "r2")], Words("en"))
    ('/camera (2 robots)',)
    """
    groups = grouped(elements, lambda element: (element["kind"], element["name"]))
    return tuple(dict.fromkeys(_name_of(group, words, alike) for group in groups))


def _name_of(group: list[Mapping[str, Any]], words: Words, alike: Mapping[str, Collection[str]]) -> str:
    robots = weight({element["robot"] for element in group}, alike)
    return name(group[0]) if robots == 1 else f"{fit(group[0]['name'])} ({words.count(robots, 'robot')})"


def weight(robots: Iterable[str], alike: Mapping[str, Collection[str]]) -> int:
    """Return how many robots some robots stand for."""
    return sum(len(alike.get(robot, ("",))) for robot in robots)
