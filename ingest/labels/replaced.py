"""One entry of label files replaced, in memory: what would follow if a person said something else of one element.

In: label files as they were read, and an entry. Out: the same without what they say of that name, and the entry as
labels of its own, above none of them. The name and the hash of a file that loses an entry say so (rule S12).
"""

from __future__ import annotations

import hashlib
from dataclasses import replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputErrors, LabelError, shown
from rosprivacy.analysis.model import NON_ROS
from rosprivacy.ingest.labels.label_file import Labels, parse_labels
from rosprivacy.ingest.labels.label_reader import SECTIONS

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.ontology.vocabulary import Vocabulary

KINDS = {**SECTIONS, "elements": NON_ROS}


def with_entry(
    files: Iterable[Labels], section: str, name: str, said: object, vocabulary: Vocabulary
) -> tuple[Labels, ...]:
    """Return label files with one entry in place of all that they say of a name; shipped files stay.

    Parameters
    ----------
    section
        One of ``KINDS``.
    name
        As the files write it: a glob stands for the entry of that glob.
    said
        The entry as in a label file; None to say nothing of it.

    Raises
    ------
    InputErrors
        If the section or the entry is wrong.
    """
    what = f"{section} {name}"
    if section not in KINDS:
        raise InputErrors([LabelError(what, 0, f"unknown section {shown(section)!r}", f"one of {', '.join(KINDS)}")])
    entry = parse_labels({"labels": 1, section: {name: said}}, vocabulary, name=what)
    kinds = frozenset(KINDS[section])
    return (*(file if file.shipped else _without(file, kinds, name, what) for file in files), entry)


def _without(labels: Labels, kinds: frozenset[str], name: str, what: str) -> Labels:
    """The labels without entries of some kinds and a name."""
    entries = []
    for entry in labels.entries:
        kept = tuple(kind for kind in entry.kinds if entry.name != name or kind not in kinds)
        entries += [replace(entry, kinds=kept)] if kept else []
    elements = tuple(one for one in labels.elements if one.name != name or one.kind not in kinds)
    if (tuple(entries), elements) == (labels.entries, labels.elements):
        return labels
    digest = hashlib.sha256(f"{labels.sha256} without {what}".encode("utf-8", "surrogatepass")).hexdigest()
    return replace(
        labels, file=f"{labels.file} without {what}", sha256=digest, entries=tuple(entries), elements=elements
    )
