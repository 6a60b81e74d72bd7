"""A trial -> lines for the terminal: the three ways out that weigh most, and what was not seen.

Nothing here is a finding: each way says which suggestion it hangs on, and which question would settle it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import GAPS, SCAN_GAP, unresolved_rank
from rosprivacy.analysis.suggesting.evidence import DERIVATION, LEAK, SOURCE
from rosprivacy.analysis.suggesting.trial import weightiest
from rosprivacy.analysis.text import counted
from rosprivacy.analysis.written_names import listed
from rosprivacy.report.catalogs.words import IN_ENGLISH
from rosprivacy.report.naming import all_kinds

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.model import Category, Doubt, Element
    from rosprivacy.analysis.suggesting.evidence import LabelProposal, SuggestedLabel
    from rosprivacy.analysis.suggesting.trial import WayOut

    Line = tuple[str, str]  # text, style

SHOWN = 3  # ways out, and names in a row
KINDS_SHOWN = 4
ENDS_SHOWN = 6
ALL_OF_A_ROBOT = 50  # places where data gets out or may: what is not named is overlooked
GAPS_SHOWN = 12
TO = {"network": "to a network", "domain": "to another DDS domain", "file": "to a file", "display": "to a display",
      "loudspeaker": "to a loudspeaker", "device": "to a device", "": "where to is not known"}  # fmt: skip
OTHERWISE = " only along channels whose types are made for other data"
NO_WAY = "No way out is seen, even if they are right. That is no all-clear:"
NO_SOURCE = "nothing is suggested, and nothing stated, that brings personal data in"
NO_EXIT = "nothing is suggested, and nothing stated, that lets data out"


def trial_lines(
    nodes: int,
    supposed: Sequence[LabelProposal],
    left_out: Sequence[LabelProposal],
    unsure: Sequence[LabelProposal],
    ways: Sequence[WayOut],
    ends: Sequence[WayOut],
    unreached: Sequence[Element],
    unknown: Sequence[Element],
    doubts: Iterable[Doubt],
    categories: Mapping[str, Category],
) -> Iterator[Line]:
    """Yield what a trial comes to, without the verdict.

    Parameters
    ----------
    nodes
        How many there are.
    supposed, left_out, unsure, ways, ends, unreached, unknown
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
    if ways or ends:
        yield f"If they are right, {_places(ways, ends)}:", "bold"
    numbered = weightiest(ways, ends, categories, SHOWN)
    everywhere = {kind for way in (*ways, *ends) for kind in way.kinds}
    for number, way in enumerate(numbered, 1):
        yield "", ""
        yield from _way(number, way, everywhere, categories)
    if more := [way for way in ways if way not in numbered]:
        yield "", ""
        yield f"{counted(len(more), 'more place', 'more places')}: {_names(way.exit for way in more)}", ""
    if more := [way for way in ends if way not in numbered]:
        yield "", ""
        yield from _ends(more, everywhere)
    yield "", ""
    if not ways:
        yield NO_WAY, "yellow"
        roles = {one.label.role for one in supposed}
        yield from ((f"  {text}", "") for role, text in ((SOURCE, NO_SOURCE), (LEAK, NO_EXIT)) if role not in roles)
    if unreached:
        what = "Let data out, if suggestions are right, and nothing was seen to get there"
        yield f"{what}: {_names(unreached)}", "yellow"
    if unsure:
        yield f"Not counted beside what is surer: what may bring in {_of_kinds(unsure, categories)}", "yellow"
    yield from _not_seen(unknown, left_out, gaps)


def _places(ways: Sequence[WayOut], ends: Sequence[WayOut]) -> str:
    """At how many places data gets out, and at how many it may."""
    out = f"data gets out at {counted(len(ways), 'place')}"
    ending = f"ends at {counted(len(ends), 'node')} of which nobody says what becomes of it there"
    text = f"{out} and {ending}" if ways and ends else out if ways else f"data {ending}"
    return f"{text}. The {SHOWN} that weigh most" if len(ways) + len(ends) > SHOWN else text


def _ends(ends: Sequence[WayOut], everywhere: Collection[str]) -> Iterator[Line]:
    """What gets to nodes of which nobody says what they do with it."""
    yield "It also ends here, where it is kept, shown, sent, or made into something else:", "bold"
    for way in ends[:ENDS_SHOWN]:
        yield f"  {shown(way.exit.name)} gets {_kinds(way.kinds, everywhere)}", ""
    if more := ends[ENDS_SHOWN:]:
        yield f"  and {len(more)} more: {_names(way.exit for way in more)}", ""


def _way(number: int, way: WayOut, everywhere: Collection[str], categories: Mapping[str, Category]) -> Iterator[Line]:
    first = way.findings[0]
    yield f"{number}. {shown(way.exit.name)}, {TO[way.where]}", "bold"
    yield f"   {_kinds(way.kinds, everywhere)}", ""
    if unlikely := len(way.unlikely_kinds):
        yield f"   and {counted(unlikely, 'more kind', 'more kinds')}{OTHERWISE}", ""
    elif not way.likely:
        yield f"  {OTHERWISE}", ""
    path = " -> ".join(shown(element.name) for element in dict.fromkeys(first.witness))
    yield f"   {first.category}: {path}", "red"
    for one in way.proposals:
        yield f"   {one.confidence}: {_meaning(one.label)}", ""
        yield f"     {shown(one.evidence[0].reason)}", "dim"
    if way.proposals:
        yield f"   To settle it: {_question(way.proposals[0].label, first.category, categories)}", "bold"
    else:
        yield "   This is stated, not suggested.", "bold"


def _kinds(kinds: Sequence[str], everywhere: Collection[str]) -> str:
    """What gets out there, a few by name, and whether it is all that gets out anywhere."""
    if len(kinds) <= KINDS_SHOWN + 1:
        return ", ".join(kinds)
    names, more = ", ".join(kinds[:KINDS_SHOWN]), len(kinds) - KINDS_SHOWN
    every = all_kinds(kinds, everywhere, IN_ENGLISH)
    return f"{every}: {names} and {more} more" if every else f"{names} and {more} more kinds"


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
        what = f"what {counted(len(unknown), 'node')} {'does' if len(unknown) == 1 else 'do'} with data"
        yield f"Not known: {what}: {_names(unknown)}", "yellow"
    if left_out:
        names = list(dict.fromkeys(one.label.element for one in left_out))
        yield f"Left out, since labels say otherwise: suggestions about {_names(names, SHOWN)}", "yellow"
    ordered = sorted(gaps, key=lambda doubt: unresolved_rank(doubt.message))
    for doubt in ordered[:GAPS_SHOWN]:
        at = f"{doubt.place}: " if doubt.name == SCAN_GAP else ""
        yield f"Not seen: {at}{doubt.message}", "yellow"
    if more := ordered[GAPS_SHOWN:]:
        yield f"Not seen: {counted(len(more), 'more gap')}", "yellow"


def _of_kinds(proposals: Iterable[LabelProposal], categories: Mapping[str, Category]) -> str:
    """Kinds of data in a row, each with the nodes of which it is proposed."""
    nodes: dict[str, dict[Element, None]] = {}
    for one in proposals:
        nodes.setdefault(one.label.to or one.label.kind, {})[one.label.element] = None
    return "; ".join(f"{categories[kind].text('title', 'en')} ({_names(at, SHOWN)})" for kind, at in nodes.items())


def _names(elements: Iterable[Element], at_most: int = ALL_OF_A_ROBOT) -> str:
    return listed([element.name for element in elements], at_most)
