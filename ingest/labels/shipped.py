"""Channels that the program's own label files speak of, of some that are there (rule S13).

In: elements. Out: (kind, name) of those that the file of infrastructure proposes to take as mundane.
"""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

from rosprivacy.ingest.labels.label_file import INFRASTRUCTURE, read_labels
from rosprivacy.ingest.policies.names import covered

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.analysis.model import Element
    from rosprivacy.ontology.vocabulary import Vocabulary


def infrastructure_of(elements: Iterable[Element], vocabulary: Vocabulary) -> frozenset[tuple[str, str]]:
    """Return (kind, name) of those channels that the file of infrastructure covers."""
    names: dict[str, set[str]] = {}
    for element in elements:
        if element.is_channel:
            names.setdefault(element.kind, set()).add(element.name)
    if not names:
        return frozenset()
    entries = read_labels(INFRASTRUCTURE, vocabulary).entries
    written = {kind: tuple(entry.name for entry in entries if kind in entry.kinds) for kind in names}
    return frozenset((kind, name) for kind, some in names.items() for name in some if _is_one_of(name, written[kind]))


@lru_cache(maxsize=65536)  # after each answer of a session the same is asked
def _is_one_of(name: str, written: tuple[str, ...]) -> bool:
    return any(covered(one, (name,)) for one in written)
