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
        If the section or the entry is wrong, or a file says the same of more kinds of elements than the section has.
    """
    if section not in KINDS:
        raise InputErrors(
            [LabelError("labels", 0, f"unknown section {shown(section)!r}", f"one of {', '.join(KINDS)}")]
        )
    entry = parse_labels({"labels": 1, section: {name: said}}, vocabulary, name=f"{section} {name}")
    return (*(file if file.shipped else _without(file, section, name) for file in files), entry)


def _without(labels: Labels, section: str, name: str) -> Labels:
    """The labels without the entries of a section for a name."""
    kinds = set(KINDS[section])
    gone = [entry for entry in labels.entries if entry.name == name and kinds.intersection(entry.kinds)]
    for entry in gone:
        if not kinds.issuperset(entry.kinds):
            what = f"{shown(name)!r} is labelled for more than {section}"
            raise InputErrors([LabelError(entry.place.file, entry.place.line, what, "replace it under channels")])
    if not gone:
        return labels
    file = f"{labels.file} without {section} {name}"
    return replace(
        labels,
        file=file,
        sha256=hashlib.sha256(f"{labels.sha256} {file}".encode("utf-8", "surrogatepass")).hexdigest(),
        entries=tuple(entry for entry in labels.entries if entry not in gone),
        elements=tuple(one for one in labels.elements if one.name != name or one.kind not in kinds),
    )
