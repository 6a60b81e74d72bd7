"""Why data of one element does not get to another: the names of a question -> vertices and categories -> ``WhyNot``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, shown
from rosprivacy.analysis.whatif.why_not import why_not
from rosprivacy.analysis.written_names import A_LITTLE, FEW, did_you_mean, meant, nearest

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.whatif.why_not import WhyNot
    from rosprivacy.ontology.vocabulary import Vocabulary


def explained(
    analysis: Analysis, vocabulary: Vocabulary, source: str, leak: str, categories: Iterable[str] = ()
) -> tuple[WhyNot, ...]:
    """Return for each category what is between two elements.

    Parameters
    ----------
    source, leak
        Names; of a fleet ``robot:name``.
    categories
        To ask about; empty for what the source emits, or for all if it emits nothing.

    Raises
    ------
    InputError
        If nothing is called so, or nothing emits the category.
    """
    found = analysis.spread
    ends = [vertices_called(analysis, name) for name in (source, leak)]
    names = [category.name if (category := vocabulary.find(name)) else name for name in categories]
    unknown = [name for name in names if name not in found.categories]
    if unknown:
        emitted = ", ".join(found.categories) or "none"
        raise InputError("-c", 0, f"no source or derivation emits {shown(unknown[0])!r}", f"emitted are: {emitted}")
    if not found.categories:
        raise InputError(
            "labels", 0, "no label names a source", "say where data comes in: nodes: {/x: {source: [Video]}}"
        )
    begun = [name for name in found.categories if any(found.begins(v) & found.both(name) for v in ends[0])]
    return tuple(why_not(analysis, ends[0], ends[1], name) for name in names or begun or found.categories)


def vertices_called(analysis: Analysis, written: str, asked: str = "why-not") -> list[int]:
    """Return the vertices that a name means; a node before a channel of the same name.

    Parameters
    ----------
    asked
        By which a message calls what the name was given to.

    Raises
    ------
    InputError
        If nothing is called so.
    """
    known: dict[str, list[int]] = {}
    elements = analysis.graph.elements
    for vertex, element in enumerate(elements):
        known.setdefault(element.full_name, []).append(vertex)
    if meant(written) not in known:
        close = nearest(written, known, FEW, A_LITTLE)
        hint = did_you_mean(close, "see the names with rosprivacy labels --init")
        raise InputError(asked, 0, f"no element is called {shown(written)!r}", hint)
    found = known[meant(written)]
    return [vertex for vertex in found if not elements[vertex].is_channel] or found
