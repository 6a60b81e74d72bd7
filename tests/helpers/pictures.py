"""What tests of pictures share: the pictures of the examples, and a system whose names mean harm."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from rosprivacy.analysis.findings.findings import analyse
from rosprivacy.analysis.findings.flows_to_leaks import PathsToLeaks
from rosprivacy.analysis.hierarchy import Hierarchy
from rosprivacy.analysis.model import Bound, Category, Element, Flow, FlowGraph, Grant, Place, Profile, Statement
from rosprivacy.report.page.figures import Inline, Wishes, pictures_of
from rosprivacy.report.pictures import narrow, views
from rosprivacy.report.pictures.graphviz import Graphviz
from rosprivacy.report.pictures.narrow import represented
from tests.helpers.graphs import care_home, factory, hospital

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.report.pictures.picture import Box, Picture
    from rosprivacy.result import Result

HOSTILE = (
    "/<script>alert(1)</script>",
    '/"];n0->n1;x["',
    "/a\\",
    "/\\N\\G\\n\\l",
    "/&amp;&lt;&#60;b&#62;#quot;",
    "/line\nfeed\r\ttab\x00\x1b[31m",
    "/مرحبا/שלום",
    "/\u202egnp.exe\u2066",
    "/%%{init: {'theme':'dark'}}%%",
    "/end",
    "/style:x#<>;classDef a fill:red;",
    "/--><!--",
    "/]]>",
    "/`b` ```",
    "/\ud800\uffff",
    "/𝒳😀",
    "/" + "x" * 3999,
    "/perception" * 400,
)
HIERARCHY = Hierarchy.of([Category("Video", "urn:Video", "Video", "Video", "Video")])


def every_grant(result: Result) -> list[Grant]:
    return [grant for policy in result.policies for grant in policy.grants]


def ros(result: Result) -> Picture:
    return views.ros_view(result.analysis, every_grant(result))


@cache
def pictures() -> dict[str, Picture]:
    """What the golden files hold."""
    two, four, care = factory(2), factory(4), care_home()
    finding = care.analysis.findings[0]
    profiles = care.analysis.graph.profiles
    return {
        "factory-ros": ros(two),
        "factory-privacy": views.privacy_view(PathsToLeaks(two.analysis)),
        "factory-filtered": views.privacy_view(PathsToLeaks(four.analysis)),
        "care-home-ros": narrow.grouped(narrow.folded(ros(care)), "enclave", profiles),
        "care-home-privacy": narrow.folded(views.privacy_view(PathsToLeaks(care.analysis))),
        "care-home-finding": views.finding_view(PathsToLeaks(care.analysis), finding),
        "fleet-privacy": narrow.grouped(narrow.folded(fleet_privacy()), "robot", ()),
    }


def fleet_privacy() -> Picture:
    """One robot for all that are alike."""
    result = hospital()
    assert result.fleet
    likeness = result.fleet.likeness
    return represented(views.privacy_view(PathsToLeaks(result.analysis), likeness.second), likeness)


def hostile(names: Iterable[str] = HOSTILE) -> Analysis:
    """A source sends to every topic, and a leak reads them; these two, files and enclaves have hostile names too."""
    names = sorted(set(names))
    elements = [Element("node", f"{names[0]}source"), Element("node", f"{names[-1]}leak")]
    elements += [Element("topic", name) for name in names]
    place = Place(f"{names[0]}.xml", 3)
    grants = tuple(Grant(True, "publish", "topic", name, names[-1], elements[0].name, place) for name in names)
    flows = [Flow(0, i + 2, "publish", (grants[i],)) for i in range(len(names))]
    flows += [Flow(i + 2, 1, "subscribe", (grants[i],)) for i in range(len(names))]
    profiles = (Profile(names[-1], elements[0].name, place),)
    graph = FlowGraph(tuple(elements), tuple(flows), (), profiles)
    said = {0: (_statement("source"),), 1: (_statement("leak"),)}
    return analyse(graph, Bound(said), HIERARCHY)


def _statement(role: str) -> Statement:
    return Statement(role, ("Video",), (1, 0), Place("labels", 1))


def names_of(boxes: Iterable[Box]) -> set[str]:
    return {name for box in boxes for name in box.names}


def of_findings(analysis: Analysis, wishes: Wishes | None = None) -> list[Inline | None]:
    """The pictures of all findings, for a page."""
    with Graphviz() as graphviz:
        return list(pictures_of(graphviz, PathsToLeaks(analysis), analysis.findings, wishes))
