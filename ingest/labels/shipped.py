"""Channels that the program's own label files speak of, of some that are there (rule S13).

In: elements. Out: (kind, name) of those that the file of infrastructure proposes to take as mundane.
"""

from __future__ import annotations

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
    return frozenset(
        (kind, name) for entry in entries for kind in entry.kinds for name in covered(entry.name, names.get(kind, ()))
    )
