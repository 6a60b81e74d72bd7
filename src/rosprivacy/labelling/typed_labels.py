"""Labels that a person types in a conversation: what a node does, where no question offers it (issue 21).

In: a line, what is known of the system. Out: the label. What a name or a library says of a node is often another kind
of data than the right one; then the node is asked about, and the person knows better. Such a line takes nothing away.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import InputErrors, shown
from rosprivacy.analysis.suggesting.written import TYPED_AS, WrittenLabel
from rosprivacy.analysis.written_names import did_you_mean, literal, nearest
from rosprivacy.labelling.tried_labels import with_more

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from rosprivacy.analysis.model import Element
    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.result import Result

FROM_AND_TO = 2


def typed_label(line: str, elements: Iterable[Element], vocabulary: Vocabulary) -> WrittenLabel | str:
    """Return the label that a line says, or in words why it says none.

    Parameters
    ----------
    line
        Name, ``node``, role, kinds: of ``derives`` from which, and to which; of the others one or more.

    Examples
    --------
    >>> from rosprivacy.analysis.model import Element
    >>> from rosprivacy.ontology.vocabulary import load
    >>> nodes = [Element("node", "/lidar")]
    >>> typed_label("/lidar node source Location", nodes, load())
    WrittenLabel(section='nodes', name='/lidar', said={'source': ['Location']})
    >>> typed_label("/lidar node source Biometrik", nodes, load())
    "unknown category 'Biometrik'; did you mean Biometric?"
    """
    said: dict[str, Any]
    match line.split():
        case [name, "node", "source" | "leak" as role, *kinds] if kinds:
            said = {role: list(dict.fromkeys(kinds))}
        case [name, "node", "derives", *kinds] if len(set(kinds)) == len(kinds) == FROM_AND_TO:
            said = {"derives": [dict(zip(("from", "to"), kinds, strict=True))]}
        case _:
            return TYPED_AS
    return _unknown(name, kinds, elements, vocabulary) or WrittenLabel("nodes", literal(name), said)


def contradiction(label: WrittenLabel, result: Result) -> str:
    """Return what a label goes against, in words; nothing if it can be said beside all that is said."""
    try:
        with_more(result, [label], "this label")
    except InputErrors as error:
        return str(error)
    return ""


def _unknown(name: str, kinds: Sequence[str], elements: Iterable[Element], vocabulary: Vocabulary) -> str:
    nodes = dict.fromkeys(one.name for one in elements if one.is_node)
    if name not in nodes:
        near = nearest(name, nodes)
        return f"no node is called {shown(name)!r}; {did_you_mean(near)}" if near else TYPED_AS
    other = next((one for one in kinds if one not in vocabulary.hierarchy.ancestors), "")
    return f"unknown category {shown(other)!r}; {vocabulary.hint(other)}" if other else ""
