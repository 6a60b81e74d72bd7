"""The small system of the examples in docstrings: a factory after the paper's, with one of each role.

::

    /camera -> /video -> /filter  -> /filtered -> /archive -> disk
        |          |---> /face_id -> /faces    ------^
        |          '-- DENY --x------------------> /archive
        '----> /rosout

Video begins at the camera. A filter pseudonymises it, a face recogniser makes face templates of it, and the archive
lets both out. ``/faces`` carries face templates only, and a shipped file says that ``/rosout`` carries nothing.

Source: the paper, section III, without the robot's arm; recogniser, disk and DENY are ours.
"""

from __future__ import annotations

from rosprivacy.analysis.hierarchy import Hierarchy
from rosprivacy.analysis.model import (
    ARTICLE_9,
    GLOB,
    SEGMENT,
    STANDARD,
    STATED,
    Bound,
    Category,
    Element,
    Flow,
    FlowGraph,
    Grant,
    Legal,
    Method,
    NonRosFacts,
    Place,
    Statement,
)
from rosprivacy.analysis.non_ros import by_kind

ARCHIVE, CAMERA, FACE_ID, FILTER, DISK, FACES, FILTERED, ROSOUT, VIDEO = range(9)  # vertices
NAMES = ("/archive", "/camera", "/face_id", "/filter", "disk", "/faces", "/filtered", "/rosout", "/video")
POLICY = ((CAMERA, ROSOUT), (CAMERA, VIDEO), (FACE_ID, FACES), (FILTER, FILTERED), (FACES, ARCHIVE),
          (FILTERED, ARCHIVE), (VIDEO, FACE_ID), (VIDEO, FILTER))  # fmt: skip
LAW = Legal("urn:gdpr-9-1", ARTICLE_9, "special categories", "2018-05-25", "conditional", "if it identifies a person")
CATEGORIES = {
    "Biometric": Category("Biometric", "urn:Biometric", "Biometric", "biometric data", "Data of a body."),
    "FaceTemplate": Category(
        "FaceTemplate", "urn:FaceTemplate", "FaceTemplate", "face template", "A face in numbers.", ("Biometric",),
        law=(LAW,),
    ),
    "Video": Category("Video", "urn:Video", "Video", "video", "Moving pictures.", reason="recital 51"),
}  # fmt: skip


def factory(robot: str = "") -> tuple[FlowGraph, Bound, Hierarchy]:
    """Return the graph, the labels and the hierarchy of the example, as ``analyse`` and ``spread`` take them.

    Line n of ``policy.xml`` grants row n of ``POLICY``; the labels stand in ``labels.yaml``.

    Parameters
    ----------
    robot
        The name of the robot that all of it is on.

    Examples
    --------
    >>> graph, bound, hierarchy = factory()
    >>> graph.elements[CAMERA].name, [str(place.place) for place in bound.elements[CAMERA]], hierarchy.broader("Video")
    ('/camera', ['labels.yaml:2'], [])
    """
    kinds = {DISK: "storage"} | dict.fromkeys((FACES, FILTERED, ROSOUT, VIDEO), "topic")
    elements = tuple(Element(kinds.get(v, "node"), name, robot) for v, name in enumerate(NAMES))
    grants = [_granted(elements, *ends, line) for line, ends in enumerate(POLICY, 1)]
    lost = _granted(elements, VIDEO, ARCHIVE, len(POLICY) + 1)
    deny = lost.grants[0]._replace(allow=False, place=Place("policy.xml", len(POLICY) + 2))
    graph = FlowGraph(
        elements, (Flow(ARCHIVE, DISK, STATED), *grants), denied=(lost._replace(denials=(deny,)),), profiles=()
    )
    bound = Bound(
        {
            ARCHIVE: (_label("leak", 1, "FaceTemplate", "Video"),),
            CAMERA: (_label("source", 2, "Video"),),
            FACE_ID: (_label("derivation", 3, "Video")._replace(to="FaceTemplate"),),
            FILTER: (_label("sanitizer", 4, "Video")._replace(method=Method.PSEUDONYMISE),),
            DISK: by_kind(elements[DISK]),
            FACES: (_label("only", 5, "FaceTemplate")._replace(naming=SEGMENT, rank=(STANDARD + 1, 0)),),
            ROSOUT: (Statement("mundane", (), (STANDARD, 0), Place("standard", 1), naming=GLOB, shipped=True),),
        },
        outside={DISK: NonRosFacts(country="DE", area="eea")},
    )
    return graph, bound, Hierarchy.of(CATEGORIES.values())


def _granted(elements: tuple[Element, ...], source: int, target: int, line: int) -> Flow:
    """What one line of the policy allows."""
    role, node, topic = ("subscribe", target, source) if elements[source].is_channel else ("publish", source, target)
    names = elements[topic].name, "/factory", elements[node].name
    return Flow(source, target, role, (Grant(True, role, "topic", *names, Place("policy.xml", line)),))


def _label(role: str, line: int, *categories: str) -> Statement:
    """What one line of the labels says, by a full name."""
    return Statement(role, categories, (STANDARD + 1, 1), Place("labels.yaml", line))
