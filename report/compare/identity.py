"""What elements and findings of two documents are told apart by: the same for ``diff`` and for ``report --since``.

In: a document of the contract. Out: keys of texts, for ``report/compare/matching.py``. Of a fleet, a robot that stands
for others counts by its model, so that it does not matter which one is shown.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Self

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rosprivacy.report.compare.matching import Key


@dataclass(frozen=True, slots=True)
class Identity:
    """The keys of a document.

    Attributes
    ----------
    models
        A robot of a fleet that is shown -> its model; empty for a single robot.
    patterns
        Id of a finding -> its pattern in a fleet.
    """

    models: Mapping[str, str]
    patterns: Mapping[str, Mapping[str, Any]]

    @classmethod
    def of(cls, document: Mapping[str, Any]) -> Self:
        """Read a document."""
        fleet = document.get("fleet")
        if not fleet:
            return cls({}, {})
        models = {group["robot"]: group["model"] or group["robot"] for group in fleet["alike"]}
        return cls(models, {pattern["finding"]: pattern for pattern in fleet["patterns"]})

    def element(self, element: Mapping[str, Any]) -> Key:
        """Return (robot or model, kind, name, leg)."""
        robot = self.models.get(element["robot"], element["robot"])
        return (robot, element["kind"], element["name"], element.get("leg", ""))

    def finding(self, finding: Mapping[str, Any]) -> Key:
        """Return (kind, category, source, leak, whether it goes across robots, whether beside a pseudonymised one)."""
        pattern = self.patterns.get(finding["id"])
        across = "across" if pattern and pattern["across"] else ""
        ends = (self._end(finding["source"]), self._end(finding["leak"]))
        beside = "beside" if finding.get("beside_pseudonymised") else ""
        return (finding["kind"], finding["category"], *ends, across, beside)

    def _end(self, element: Mapping[str, Any]) -> str:
        """A source or leak by name; with its robot where that is none, such as what is shared."""
        robot = "" if element["robot"] in self.models or not element["robot"] else f"{element['robot']}:"
        return f"{robot}{element['kind']} {element['name']}"
