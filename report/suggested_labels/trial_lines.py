"""A trial -> lines for the terminal: the three ways out that weigh most, and what was not seen.

Nothing here is a finding: each way says which suggestion it hangs on, and which question would settle it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import GAPS
from rosprivacy.analysis.suggesting.evidence import DERIVATION, LEAK, SOURCE
from rosprivacy.analysis.text import counted

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.model import Category, Doubt, Element
    from rosprivacy.analysis.suggesting.evidence import LabelProposal, SuggestedLabel
    from rosprivacy.analysis.suggesting.trial import WayOut

    Line = tuple[str, str]  # text, style

SHOWN = 3  # ways out, and names in a row
KINDS_SHOWN = 4
TO = {"network": "to a network", "domain": "to another DDS domain", "file": "to a file", "display": "to a display",
      "loudspeaker": "to a loudspeaker", "device": "to a device", "": "where to is not known"}  # fmt: skip
NO_WAY = "No way out is seen, even if they are right. That is no all-clear:"
NO_SOURCE = "nothing is suggested, and nothing stated, that brings personal data in"
NO_EXIT = "nothing is suggested, and nothing stated, that lets data out"


def trial_lines(
    nodes: int,
    supposed: Sequence[LabelProposal],
    left_out: Sequence[LabelProposal],
    ways: Sequence[WayOut],
    unknown: Sequence[Element],
    doubts: Iterable[Doubt],
    categories: Mapping[str, Category],
) -> Iterator[Line]:
    """Yield what a trial comes to, without the verdict.

    Parameters
    ----------
    nodes
        How many there are.
    supposed, left_out, ways, unknown
        As of ``Trial``.
    doubts
        Of the answer as it is stated.
    """
    gaps = [doubt for doubt in doubts if doubt.name in GAPS]
    if not supposed:
        yield f"{counted(nodes, 'node')}. No suggestion says what brings personal data in or lets it out.", ""
    else:
        what = f"{counted(len(supposed), 'suggestion')} of what brings personal data in, makes it, or lets it out"
        yield f"{counted(nodes, 'node')}, {what}. Nobody has confirmed them.", ""
    if ways:
        yield f"If they are right, data gets out at {counted(len(ways), 'place')}{_first(ways)}:", "bold"
    for number, way in enumerate(ways[:SHOWN], 1):
        yield "", ""
        yield from _way(number, way, categories)
    if more := ways[SHOWN:]:
        yield "", ""
        yield f"{counted(len(more), 'more place', 'more places')}: {_names([way.exit for way in more])}", ""
    yield "", ""
    if not ways:
        yield NO_WAY, "yellow"
        roles = {one.label.role for one in supposed}
        yield from ((f"  {text}", "") for role, text in ((SOURCE, NO_SOURCE), (LEAK, NO_EXIT)) if role not in roles)
    yield from _not_seen(unknown, left_out, gaps)


def _first(ways: Sequence[WayOut]) -> str:
    return f". The {SHOWN} that weigh most" if len(ways) > SHOWN else ""


def _way(number: int, way: WayOut, categories: Mapping[str, Category]) -> Iterator[Line]:
    first = way.findings[0]
    yield f"{number}. {shown(way.exit.name)}, {TO[way.where]}", "bold"
    yield f"   {_kinds(way.kinds)}", ""
    path = " -> ".join(shown(element.name) for element in dict.fromkeys(first.witness))
    yield f"   {first.category}: {path}", "red"
    for one in way.proposals:
        yield f"   {one.confidence}: {_meaning(one.label)}", ""
        yield f"     {shown(one.evidence[0].reason)}", "dim"
    if way.proposals:
        yield f"   To settle it: {_question(way.proposals[0].label, first.category, categories)}", "bold"
    else:
        yield "   This is stated, not suggested.", "bold"


def _kinds(kinds: Sequence[str]) -> str:
    """What gets out there, a few by name."""
    if len(kinds) <= KINDS_SHOWN + 1:
        return ", ".join(kinds)
    return f"{', '.join(kinds[:KINDS_SHOWN])} and {len(kinds) - KINDS_SHOWN} more kinds"


def _meaning(label: SuggestedLabel) -> str:
    name = shown(label.element.name)
    if label.role == DERIVATION:
        return f"{name} makes {label.to} of {label.kind}"
    return f"{name} brings {label.kind} in" if label.role == SOURCE else f"{name} lets data out"


def _question(label: SuggestedLabel, category: str, categories: Mapping[str, Category]) -> str:
    name = shown(label.element.name)
    if label.role == DERIVATION:
        made, of = (categories[kind].text("title", "en") for kind in (label.to, label.kind))
        return f"does {name} make data of the kind '{made}' out of '{of}'?"
    kind = categories[label.kind if label.role == SOURCE else category].text("title", "en")
    if label.role == SOURCE:
        return f"does {name} bring in data of the kind '{kind}'?"
    return f"does {name} keep, show or send on what it gets, such as '{kind}'?"


def _not_seen(unknown: Sequence[Element], left_out: Sequence[LabelProposal], gaps: Sequence[Doubt]) -> Iterator[Line]:
    """What neither labels nor suggestions speak of: there may be more ways out."""
    if unknown:
        what = counted(len(unknown), "node")
        yield f"Not known: what {what} {'does' if len(unknown) == 1 else 'do'} with data: {_names(unknown)}", "yellow"
    if left_out:
        names = list(dict.fromkeys(one.label.element for one in left_out))
        yield f"Left out, since labels say otherwise: suggestions about {_names(names)}", "yellow"
    for doubt in gaps:
        yield f"Not seen: {doubt.message}", "yellow"


def _names(elements: Sequence[Element]) -> str:
    names = ", ".join(shown(element.name) for element in elements[:SHOWN])
    return f"{names} and {len(elements) - SHOWN} more" if len(elements) > SHOWN else names
