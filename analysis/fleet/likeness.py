"""Which robots of a graph stand for which robots of a fleet, and what differs only in the robot (rule S10)."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.findings.findings import finding_id
from rosprivacy.analysis.model import Element

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from rosprivacy.analysis.answer import Finding


class Likeness(NamedTuple):
    """Which robots of a graph stand for which robots of a fleet.

    Attributes
    ----------
    members
        A robot of the graph -> the robots that are alike, itself first; names that are no key are infrastructure and
        what is shared, which stand for themselves and count as no robot.
    second
        A second robot of the graph -> the first one, which it is like: needed to find what goes from one to another.
    models
        As ``members``; empty where there is no model.
    """

    members: Mapping[str, tuple[str, ...]]
    second: Mapping[str, str] = {}
    models: Mapping[str, str] = {}

    def is_robot(self, name: str) -> bool:
        """Return whether a name is that of a robot of the graph."""
        return name in self.members or name in self.second

    def weight(self, name: str) -> int:
        """Return for how many the robot of an element stands; what is no robot stands for itself."""
        return 0 if name in self.second else len(self.members.get(name, ("",)))

    @property
    def robots(self) -> int:
        """How many robots the fleet has; none where it is no fleet."""
        return sum(map(len, self.members.values()))

    def alike(self, element: Element) -> Element:
        """Return the element as it would be on any robot."""
        e = element
        return Element(e.kind, e.name, "", e.leg, e.side, e.without) if self.is_robot(e.robot) else e

    def shared(self, elements: Iterable[Element]) -> frozenset[str]:
        """Return the names under which elements are filed that no robot has."""
        return frozenset({element.robot for element in elements if not self.is_robot(element.robot)})

    def count(self, finding: Finding) -> int:
        """Return for how many findings of the fleet one of the graph stands; 0 if another does."""
        return self.between(finding.source.robot, finding.leak.robot)

    def between(self, source: str, leak: str) -> int:
        """Return the same for the robots of source and leak."""
        if source in self.second or self.second.get(leak, source) != source:
            return 0
        if leak in self.second:
            return self.weight(source) * (self.weight(source) - 1)
        return self.weight(source) * (1 if leak == source else self.weight(leak))

    def alone(self, source: Element, leak: Element) -> bool:
        """Return whether what begins and ends so stands for no other of its kind."""
        robots = {source.robot, leak.robot}
        return not robots & self.second.keys() and all(self.weight(robot) == 1 for robot in robots)

    def across(self, finding: Finding) -> bool:
        """Return whether data gets from one robot to another."""
        return self.apart(finding.source, finding.leak)

    def apart(self, source: Element, leak: Element) -> bool:
        """Return whether these are elements of two robots."""
        return source.robot != leak.robot and self.is_robot(source.robot) and self.is_robot(leak.robot)

    def placed(self, name: str) -> tuple[str, ...]:
        """Return the robots of the fleet for which a robot of the graph stands; none for what is no robot."""
        return self.members.get(self.second.get(name, name), ())


NO_ROBOTS = Likeness({})


def pattern_id(finding: Finding, likeness: Likeness) -> str:
    """Return the id of the pattern of a finding; without robots it is that of the finding.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> likeness = Likeness({"amr-1": ("amr-1",), "amr-2": ("amr-2",)})
    >>> one, other = (analyse(*factory(robot)).findings[0] for robot in likeness.members)
    >>> one.id == other.id, {pattern_id(finding, likeness) for finding in (one, other)}
    (False, {'97ef632758ef7fc3'})
    """
    return pattern_of(
        finding.kind, finding.category, finding.source, finding.leak, likeness, plain_also=finding.plain_also
    )


def pattern_of(
    kind: str, category: str, source: Element, leak: Element, likeness: Likeness, *, plain_also: bool = False
) -> str:
    """Return the id of the pattern of what would be a finding.

    >>> from rosprivacy.analysis.model import Element
    >>> likeness = Likeness({"amr-1": ("amr-1",), "amr-2": ("amr-2",)})
    >>> camera = Element("node", "/camera", "amr-1")
    >>> archives = [Element("node", "/archive", name) for name in likeness.members]
    >>> [pattern_of("disclosure", "Video", camera, archive, likeness) for archive in archives]  # of one robot, across
    ['1158fa035bd7d664', 'f8c322aefdae946b']
    """
    kind = f"across {kind}" if likeness.apart(source, leak) else kind
    return finding_id(category, likeness.alike(source), likeness.alike(leak), kind, plain_also=plain_also)
