"""Label files -> ``Labels``: what a person says of elements, flows and kinds of data.

In: YAML or JSON in the format of the documentation, or the paper's JSON with its six lists. Out: statements, each
with its line and rank, not yet joined to a graph (``binding.py`` does that). All problems of a file are raised at
once.

Source: the paper, section II-A, for the roles; rules S7, S8 and S13 for what they mean.
"""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass
from functools import lru_cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.bounds import BOUNDS
from rosprivacy.analysis.errors import InputError, InputErrors, LabelError, shown
from rosprivacy.analysis.model import UNSTATED, Place, Surroundings
from rosprivacy.analysis.non_ros import EVERY
from rosprivacy.ingest.labels.entries import OWN, PROPOSED, ROBOT, SHIPPED
from rosprivacy.ingest.labels.label_reader import LabelReader, check_mundane
from rosprivacy.ingest.policies.names import covered
from rosprivacy.ingest.reading import yaml_values
from rosprivacy.ingest.reading.format_reader import read_values

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from rosprivacy.analysis.bounds import Bounds
    from rosprivacy.analysis.model import Diagnostic, Element, Processing
    from rosprivacy.ingest.labels.entries import Entry, FlowEntry, Limit, Stated
    from rosprivacy.ingest.labels.pins import CodePin, Pin, TypePin
    from rosprivacy.ingest.reading.yaml_values import Value
    from rosprivacy.ontology.vocabulary import Vocabulary

OURS, SHIPPED_FILES = "rosprivacy:", ("standard", "infrastructure")
STANDARD, INFRASTRUCTURE = (f"{OURS}{name}" for name in SHIPPED_FILES)


@dataclass(frozen=True, slots=True)
class Labels:
    """One label file, or labels from memory.

    Attributes
    ----------
    shipped
        Whether it comes with the program: then a name that matches nothing is no error.
    elements
        Elements outside ROS (rule S9).
    limits
        How long kinds of data may be kept at most.
    own
        Whether it is about one robot of a fleet, and outranks its model's.
    surroundings
        Where the system works, as the top of the file states it.
    processing
        Who is responsible for the whole system, what it is for, on which basis.
    pins
        What a person has seen where globs decide (rule S11); None of a file without.
    type_pins
        With what a person took lines ``only: by-type``; None of a file without.
    code_pins
        Of which code labels of nodes speak.
    """

    file: str
    sha256: str
    entries: tuple[Entry, ...]
    flows: tuple[FlowEntry, ...] = ()
    diagnostics: tuple[Diagnostic, ...] = ()
    shipped: bool = False
    elements: tuple[Stated, ...] = ()
    limits: tuple[Limit, ...] = ()
    own: bool = False
    surroundings: Surroundings = Surroundings()  # noqa: RUF009 - it is frozen
    processing: Processing = UNSTATED
    pins: tuple[Pin, ...] | None = None
    type_pins: tuple[TypePin, ...] | None = None
    code_pins: tuple[CodePin, ...] = ()


class LabelErrors(InputErrors):
    """All problems of label files, with what could be read of them.

    Attributes
    ----------
    labels
        What was read all the same: names that match nothing can be told in the same run.
    """

    def __init__(self, errors: Iterable[InputError], labels: tuple[Labels, ...] = ()) -> None:
        super().__init__(errors)
        self.labels = labels


def read_labels(
    file: str,
    vocabulary: Vocabulary,
    *,
    category: str = "PersonalData",
    shipped: bool = False,
    own: bool = False,
    bounds: Bounds = BOUNDS,
    include_root: str | None = None,
) -> Labels:
    """Read one label file.

    Parameters
    ----------
    file
        Path; or ``rosprivacy:standard`` or ``rosprivacy:infrastructure``, which come with the program.
    category
        What the paper's six lists are about; of no effect on other files.
    shipped
        Read it as one that comes with the program: of lower rank, and free to name what is not there.
    own
        It is about one robot of a fleet, and outranks what its model's files say.
    include_root
        Folder that the bags which it names may not leave, links followed; by default its own.

    Raises
    ------
    InputErrors
        With every problem of the file, each a ``LabelError`` of one line.
    """
    name = file.removeprefix(OURS)
    shipped = shipped or (file.startswith(OURS) and name in SHIPPED_FILES)
    path = _shipped_path(name) if file.startswith(OURS) and shipped else file
    top, data = read_values(path, partial(LabelError, file), bounds)
    tier = OWN if not shipped else PROPOSED if file == INFRASTRUCTURE else SHIPPED
    reader = LabelReader(file, vocabulary, category, tier, ROBOT if own else 0, bounds=bounds, root=include_root or "")
    return _labels(reader, top, data, shipped=shipped, own=own)


def parse_labels(
    text: str | Mapping[str, Any],
    vocabulary: Vocabulary,
    *,
    name: str,
    category: str = "PersonalData",
    bounds: Bounds = BOUNDS,
) -> Labels:
    """Read labels that stand in memory, as text or as what a YAML or JSON reader makes of it; see ``read_labels``.

    Parameters
    ----------
    name
        By which messages and reports call them; lines are those of the text.
    """
    try:
        text = text if isinstance(text, str) else json.dumps(text, ensure_ascii=False, indent=1)
        top = yaml_values.parse(text, partial(LabelError, name), bounds)
    except InputError as error:
        raise InputErrors([error]) from None
    except (TypeError, ValueError) as error:
        hint = "write maps, lists, texts, numbers"
        raise InputErrors([LabelError(name, 0, f"not as in YAML or JSON: {shown(str(error))}", hint)]) from None
    return _labels(
        LabelReader(name, vocabulary, category, OWN, bounds=bounds), top, text.encode("utf-8", "surrogatepass")
    )


def _labels(reader: LabelReader, top: Value, data: bytes, *, shipped: bool = False, own: bool = False) -> Labels:
    reader.document(top)
    if shipped:
        check_mundane(reader, top)
    labels = Labels(
        reader.file,
        hashlib.sha256(data).hexdigest(),
        tuple(reader.entries),
        tuple(reader.flows),
        tuple(reader.diagnostics),
        shipped,
        tuple(reader.elements),
        tuple(reader.limits),
        own,
        reader.surroundings,
        reader.processing,
        reader.pins,
        reader.type_pins,
        reader.code_pins,
    )
    if reader.problems:
        raise LabelErrors(reader.problems, (labels,))
    return labels


def unknown_categories(labels: Labels, vocabulary: Vocabulary) -> Iterator[LabelError]:
    """Yield a problem for each category of labels that were read with another ontology than this."""
    statements = [said for entry in labels.entries for said in entry.statements]
    statements += [said for flow in labels.flows for said in flow.statements]
    named = {(name, said.place) for said in statements for name in (*said.categories, said.to)}
    named |= {(name, stated.place) for stated in labels.elements for name, _ in stated.outside.retention}
    named |= {(name, Place(labels.file, 0)) for name, _ in labels.limits}
    processing = [labels.processing, *(entry.processing for entry in labels.entries)]
    named |= {(name, one.place) for one in processing for name, _ in (*one.purposes, *one.bases)}
    named |= {(name, pin.place) for pin in labels.pins or () for name in pin.categories}
    for name, place in named:
        if name != EVERY and name not in vocabulary.categories:
            hint = "give parse_labels the ontologies that analyze gets"
            yield LabelError(place.file, place.line, f"unknown category {shown(name)!r}", hint)


def shipped_text(name: str) -> str:
    """Return a label file that comes with the program, as text: one of ``SHIPPED_FILES``."""
    return Path(_shipped_path(name)).read_text("utf-8")


def _shipped_path(name: str) -> str:
    return str(Path(__file__).with_name(f"{name}.yaml"))


def infrastructure_of(elements: Iterable[Element], vocabulary: Vocabulary) -> frozenset[tuple[str, str]]:
    """Return (kind, name) of those channels that the file of infrastructure proposes to take as mundane (rule S13)."""
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
