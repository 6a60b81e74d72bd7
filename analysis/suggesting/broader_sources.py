"""Sources of a broader kind, where what is known names one narrower kind, and persons often another one.

In: evidence, rules about names. Out: evidence of the broader kinds that ``NameRules.broadened`` lists. A node that is
called after a transcript often writes a command; one that knows persons by a number often knows their names. So the
broader kind is asked about, too, as long as nobody has named the narrower one: ``may``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.model import Confidence
from rosprivacy.analysis.suggesting.evidence import DATA_FLOW, SOURCE

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rosprivacy.analysis.suggesting.carried_kinds import Rules
    from rosprivacy.analysis.suggesting.evidence import Evidence


def broader_sources(said: Iterable[Evidence], rules: Rules) -> Iterator[Evidence]:
    """Yield that a node may be a source of a broader kind, for each that is said to be one of a narrower kind.

    >>> from rosprivacy.analysis.example import CAMERA, factory
    >>> from rosprivacy.analysis.model import Confidence, Place
    >>> from rosprivacy.analysis.suggesting.carried_kinds import Rules
    >>> from rosprivacy.analysis.suggesting.evidence import Evidence, Label
    >>> from rosprivacy.analysis.suggesting.example_names import NAMES
    >>> graph, _, hierarchy = factory()
    >>> rules = Rules({}, {}, NAMES._replace(broadened=frozenset(["Biometric"])), hierarchy)
    >>> label = Label(graph.elements[CAMERA], "source", "FaceTemplate")
    >>> said = [Evidence(label, "name", Confidence.MAY, "a word", Place("names.yaml", 1))]
    >>> [one.label.kind for one in broader_sources(said, rules)]
    ['Biometric']
    """
    said = [one for one in said if one.label.role == SOURCE]
    known = {one.label for one in said}
    for one in said:
        for kind in sorted(rules.names.broadened & rules.hierarchy.ancestors[one.label.kind].keys()):
            label = one.label._replace(kind=kind)
            if label not in known:
                known.add(label)
                reason = f"{one.reason}; it may also be of another sort of {kind}"
                beside = one.label.kind
                yield one._replace(
                    label=label, ground=DATA_FLOW, confidence=Confidence.MAY, reason=reason, beside=beside
                )
