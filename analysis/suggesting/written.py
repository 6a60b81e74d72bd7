"""A proposed label as it is written into a label file: under which section and name, and what is said there.

``mundane`` is written as ``never`` of the broadest category, and a conduit for every kind as one of the broadest: it
means the same, and there is room for a note beside it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.suggesting.carried_kinds import ANYTHING
from rosprivacy.analysis.suggesting.evidence import DERIVATION, MUNDANE, NEVER, SANITIZER
from rosprivacy.analysis.written_names import literal

if TYPE_CHECKING:
    from rosprivacy.analysis.suggesting.evidence import Label

TYPED_AS = (  # in a conversation, where no question offers it; it takes nothing away
    "a label is typed as '/camera node source Video', '/screen node leak Video' or "
    "'/finder node derives Video FaceTemplate', and Enter"
)


class WrittenLabel(NamedTuple):
    """What stands in a label file: ``section: {name: said}``."""

    section: str
    name: str
    said: dict[str, Any]


def written(label: Label) -> WrittenLabel:
    """Return what a label is in a label file.

    >>> from rosprivacy.analysis.model import Element, Method
    >>> from rosprivacy.analysis.suggesting.evidence import Label
    >>> node = Element("node", "/n")
    >>> written(Label(node, "source", "Video")).said, written(Label(node, "sanitizer", "Video", Method.DROP)).said
    ({'source': ['Video']}, {'sanitizer': {'Video': 'drop'}})
    >>> written(Label(Element("topic", "/a*"), "mundane"))
    WrittenLabel(section='topics', name='=/a*', said={'never': ['PersonalData']})
    """
    kind = label.kind or ANYTHING
    said: dict[str, Any] = {label.role: [kind]}
    if label.role == SANITIZER:
        said = {SANITIZER: {kind: str(label.method)}}
    elif label.role == DERIVATION:
        said = {"derives": [{"from": kind, "to": label.to}]}
    elif label.role == MUNDANE:
        said = {NEVER: [kind]}
    return WrittenLabel(f"{label.element.kind}s", literal(label.element.name), said)
