"""Source code with annotations -> a label file, or whether one is up to date.

In: names of files and folders. Out: text, and what differs. A label file that is written so says what the code says
and nothing else; labels by hand stand in another file.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import InputError, InputErrors, shown
from rosprivacy.analysis.text import counted, printable
from rosprivacy.ingest.code.annotated_elements import HEAD, attach, conflicts, label_text, lost_annotations
from rosprivacy.ingest.code.code_names import ROOT, is_ros_name
from rosprivacy.ingest.code.source_files import read_sources
from rosprivacy.ingest.labels.entries import SECTIONS
from rosprivacy.ingest.labels.label_file import parse_labels, read_labels
from rosprivacy.ingest.labels.label_writer import without_places
from rosprivacy.ingest.reading.bounded_file import beginning

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rosprivacy.ingest.code.annotated_elements import Labelled
    from rosprivacy.ingest.labels.entries import Entry
    from rosprivacy.ingest.labels.label_file import Labels
    from rosprivacy.ontology.vocabulary import Vocabulary

    Key = tuple[tuple[str, ...], str]  # kinds and name of an entry

OF_OTHERS = "not read, as code of others or not built here (name a folder by itself to have it read)"
NAME = "the labels of annotations"


class Annotated(NamedTuple):
    """What the annotations of source code say: how many files were read, what is said of which element, and as text.

    Attributes
    ----------
    of_others
        Folders with code of others, whose annotations were not read.
    """

    files: int
    labelled: tuple[Labelled, ...]
    text: str
    of_others: tuple[str, ...] = ()

    @property
    def size(self) -> str:
        """How much there is, for people."""
        annotations = len({one.place for one in self.labelled})
        elements = len({(one.section, one.name) for one in self.labelled})
        parts = (counted(annotations, "annotation"), counted(elements, "element"))
        told = f"{parts[0]} of {parts[1]} in {counted(self.files, 'file')}"
        return f"{told}; {OF_OTHERS}: {printable(', '.join(self.of_others))}" if self.of_others else told


def annotated(sources: Sequence[str], vocabulary: Vocabulary, namespace: str = ROOT) -> Annotated:
    """Read source code.

    Parameters
    ----------
    namespace
        Of nodes that state none in the code.

    Raises
    ------
    InputErrors
        With every problem, one line each.
    """
    if namespace != ROOT and not (namespace.startswith("/") and is_ros_name(namespace)):
        raise InputError("--namespace", 0, f"{shown(namespace)!r} is no namespace", "write it so: /robot")
    codes, of_others, unread = read_sources(sources)
    labelled, problems = attach(codes, vocabulary, namespace)
    if some := (*problems, *lost_annotations(unread, vocabulary), *conflicts(labelled, vocabulary)):
        raise InputErrors(some)
    return Annotated(len(codes), labelled, label_text(labelled, vocabulary, NAME), of_others)


def differences(annotated_code: Annotated, file: str, vocabulary: Vocabulary) -> tuple[str, ...]:
    """Return in which ways a label file says something else than the code, one line each; none if it says the same.

    In which line of the code something stands is no matter here, since that changes with every line above it.

    Raises
    ------
    InputErrors
        If it is no label file.
    """
    there, wanted = read_labels(file, vocabulary), parse_labels(annotated_code.text, vocabulary, name=NAME)
    places = {(SECTIONS[one.section], one.name): one.place for one in reversed(annotated_code.labelled)}
    old, new = _by_element(there), _by_element(wanted)
    lines = [f"{file}: {_entry_text(key)} is not in it; {places[key]} says it" for key in new.keys() - old.keys()]
    for key, entry in old.items():
        if key not in new:
            lines.append(f"{entry.place}: {_entry_text(key)} is in no annotation")
        elif without_places(entry) != without_places(new[key]):
            lines.append(f"{entry.place}: {_entry_text(key)} is not what {places[key]} says")
    if not lines and _rest(there) != _rest(wanted):
        lines.append(f"{file}: it says more than annotations can say")
    return tuple(map(printable, sorted(lines)))


def is_ours(file: str) -> bool:
    """Return whether a file is one that was written so, and may be written anew."""
    return beginning(file, len(HEAD)) == HEAD.encode()


def _by_element(labels: Labels) -> dict[Key, Entry]:
    return {(entry.kinds, entry.name): entry for entry in labels.entries}


def _entry_text(key: Key) -> str:
    kinds, name = key
    return f"{shown(name)} ({kinds[0] if len(kinds) == 1 else 'channel'})"


def _rest(labels: Labels) -> Labels:
    """What a file says beside its entries."""
    rest: Labels = without_places(replace(labels, file="", sha256="", entries=(), diagnostics=()))
    return rest
