"""Where a system or one of its elements works: ``context`` and ``country`` of label and fleet files, and of a database.

In: a value with its line, or properties of the graph. Out: contexts of the closed list ``CONTEXTS``, a country code; a
problem for what is neither (rule S11).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import CONTEXTS, Surroundings
from rosprivacy.analysis.written_names import A_LITTLE, FEW, did_you_mean, nearest
from rosprivacy.ingest.labels.countries import countries

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from rosprivacy.analysis.model import FlowGraph
    from rosprivacy.ingest.reading.yaml_values import Value


class Problems(Protocol):
    """What notes a problem at a line: a reader of any of our formats."""

    def problem(self, line: int, problem: str, hint: str) -> None:
        """Note a problem."""


def read_contexts(reader: Problems, value: Value) -> tuple[str, ...]:
    """Return the contexts of a list, or of one name; what is none of them is a problem, with the nearest names."""
    items = (value,) if value.kind == "text" else value.items
    if not items:
        reader.problem(value.line, "context names nothing", f"write some of {', '.join(CONTEXTS)}, or remove it")
    found = set()
    for item in items:
        if item.kind == "text" and item.text in CONTEXTS:
            found.add(item.text)
        else:
            what = f"unknown context {shown(item.text)!r}" if item.text else f"a {item.kind} where a context is named"
            reader.problem(item.line, what, _hint(item.text))
    return tuple(sorted(found))


def read_country(reader: Problems, value: Value) -> str:
    """Return the country code that a value states; empty where it states none, which is a problem."""
    if value.text in countries().areas:  # YAML takes NO for 'no', so the text counts
        return value.text
    written = repr(shown(value.text)) if value.text else f"a {value.kind}" if value.kind != "empty" else "nothing"
    what = f"{written} is not an ISO 3166-1 country code"
    reader.problem(value.line, what, countries().hint(value.text))
    return ""


def surroundings_of(said: Mapping[str, Any], *, ros: bool) -> Surroundings:
    """Return what properties of an element in the database state.

    Parameters
    ----------
    ros
        Whether its country is that of its system; of an element outside ROS it is a fact of its own.

    Raises
    ------
    TypeError
        If they cannot be understood; the message says why.

    Examples
    --------
    >>> surroundings_of({"context": ["care"], "country": "DE"}, ros=True)
    Surroundings(contexts=('care',), country='DE')
    """
    contexts = said.get("context") or []
    if not isinstance(contexts, list) or not all(isinstance(name, str) for name in contexts):
        raise TypeError("context is not a list of texts")
    for name in contexts:
        if name not in CONTEXTS:
            raise TypeError(f"unknown context {shown(name)!r}; {_hint(name)}")
    country = said.get("country") or "" if ros else ""
    if country and country not in countries().areas:
        raise TypeError(f"country {shown(str(country))!r} is not an ISO 3166-1 code")
    return Surroundings(tuple(sorted(set(contexts))), country)


def joined(several: Iterable[Surroundings]) -> Surroundings:
    """Put together what several say of one thing: every context holds; the last country that is stated does.

    >>> joined([Surroundings(("care",)), Surroundings(("school",), "FR")])
    Surroundings(contexts=('care', 'school'), country='FR')
    """
    found = list(several)
    contexts = {name for one in found for name in one.contexts}
    return Surroundings(tuple(sorted(contexts)), next((one.country for one in reversed(found) if one.country), ""))


def everywhere(graph: FlowGraph, own: Mapping[int, Surroundings], system: Surroundings) -> dict[int, Surroundings]:
    """Return the surroundings of each element that can bring data in: its own, with those of its system."""
    found: dict[int, Surroundings] = {}
    for vertex, element in enumerate(graph.elements) if own or system else ():
        if element.is_channel:
            continue
        of_system = system if element.is_node else Surroundings(system.contexts)
        both = joined((of_system, own.get(vertex, Surroundings())))
        if both:
            found[vertex] = both
    return found


def _hint(text: str) -> str:
    return did_you_mean(nearest(text.casefold(), CONTEXTS, FEW, A_LITTLE), f"one of {', '.join(CONTEXTS)}")
