"""Labels of nodes with pinned code -> what of them holds for the code that is there now (rules S11, S16).

In: a graph with what is bound to it, label files, and the versions of the code that was read. Out: the same with what
still holds, and a diagnostic for each node of which the code is another. Of such a node no word of a user is a review
or takes anything away, in whatever label file it stands; what brings data in, lets it out or derives it holds. Of code
that was not read nothing is known: then all labels hold, and that is told.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import CODE_CHANGED, CODE_NOT_READ, STANDARD, Diagnostic, Severity
from rosprivacy.analysis.text import counted
from rosprivacy.ingest.labels.pins import spot

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

    from rosprivacy.analysis.model import Bound, FlowGraph, Place, Policy, Statement
    from rosprivacy.ingest.labels.label_file import Labels
    from rosprivacy.ingest.labels.pins import CodePin, CodeVersion, Spot

    Versions = Callable[[str], Sequence[CodeVersion]]  # of a unit, in each checkout that has it

SEEN_NONE: tuple[str, ...] = ()


class ReviewedCode(NamedTuple):
    """What is bound to a graph as far as it speaks of the code that is there, and what a reader has to know."""

    bound: Bound
    diagnostics: tuple[Diagnostic, ...]


def with_reviewed_code(
    graph: FlowGraph, bound: Bound, files: Sequence[Labels], policies: Iterable[Policy]
) -> ReviewedCode:
    """Return what is bound to a graph with what holds for the code that policies were made of."""
    checkouts = sorted({policy.checkout for policy in policies if policy.checkout})
    if not checkouts or not any(file.code_pins for file in files):
        return under_code(graph, bound, files, None)
    from rosprivacy.ingest.scan.checkout import code_of  # noqa: PLC0415 - light start

    codes = [code_of(*folders, launch=launch) for folders, launch in checkouts]
    return under_code(graph, bound, files, lambda unit: [one for code in codes if (one := code.version(unit))])


def under_code(graph: FlowGraph, bound: Bound, files: Iterable[Labels], versions: Versions | None) -> ReviewedCode:
    """Return what is bound to a graph with what holds for the code that is there.

    Parameters
    ----------
    versions
        None where no code was read.
    """
    pins = [pin for file in files for pin in file.code_pins]
    if not pins:
        return ReviewedCode(bound, ())
    vertices: dict[Spot, list[int]] = defaultdict(list)
    for vertex, element in enumerate(graph.elements):
        vertices[spot(element)].append(vertex)
    there = [pin for pin in pins if pin.ends[0] in vertices]
    if versions is None:
        return ReviewedCode(bound, tuple(_not_read(there)))
    changed = [(pin, message) for pin in there if (message := _changed(pin, versions))]
    aged = {vertex for pin, _ in changed for vertex in vertices[pin.ends[0]]}
    ends = {index: {graph.flows[index].source, graph.flows[index].target} for index in bound.flows}
    elements = {v: _unseen(said) if v in aged else said for v, said in bound.elements.items()}
    flows = {index: said if ends[index].isdisjoint(aged) else _unseen(said) for index, said in bound.flows.items()}
    said = {pin: [s for v in vertices[pin.ends[0]] for s in bound.elements.get(v, ())] for pin, _ in changed}
    told = (Diagnostic(_label_of(pin, said[pin]), Severity.WARNING, message, CODE_CHANGED) for pin, message in changed)
    return ReviewedCode(replace(bound, elements=elements, flows=flows), tuple(told))


def _unseen(statements: Iterable[Statement]) -> tuple[Statement, ...]:
    """What users say, as it holds of what nobody has seen."""
    return tuple(one._replace(pinned=SEEN_NONE) if one.rank[0] > STANDARD else one for one in statements)


def _label_of(pin: CodePin, statements: Iterable[Statement]) -> Place:
    """The label in the file of a pin by which its node was reviewed; the pin where there is none."""
    said = [one for one in statements if one.place.file == pin.place.file]
    return max(said, key=lambda one: (one.rank, -one.place.line)).place if said else pin.place


def _changed(pin: CodePin, versions: Versions) -> str:
    """What to tell of a node whose code is another than the one that is pinned; empty where it is not."""
    units = []
    for unit, reviewed in pin.versions:
        now = versions(unit)
        if not now:
            units.append(f"{shown(unit)}, which is not in the code that was read")
        units += [f"{shown(unit)} ({one.place})" for one in now if one.hash != reviewed][:1]
    if not units:
        return ""
    ((_, name),) = pin.ends
    what = f"{shown(name)} is open again: reviewed at another version of {' and of '.join(units)}"
    return f"{what}; look at it, then run rosprivacy labels --pin-code"


def _not_read(pins: Iterable[CodePin]) -> Iterator[Diagnostic]:
    """One line for each label file with pins of code that was not read."""
    by_file: dict[str, list[CodePin]] = defaultdict(list)
    for pin in pins:
        by_file[pin.place.file].append(pin)
    for some in by_file.values():
        what = f"the code of {counted(len(some), 'reviewed node')} was not read: it may be another than was reviewed"
        hint = "name the checkout or its launch file in place of the policy"
        yield Diagnostic(some[0].place, Severity.WARNING, f"{what}; {hint}", CODE_NOT_READ, len(some))
