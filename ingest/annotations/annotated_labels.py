"""What annotations say -> the text of a label file, each entry with the lines of code that it comes from.

In: statements by element. Out: text that is read as a label file. Two annotations that contradict each other are a
problem, by the rules of labels (S7, S10): the word of one person in two places of the code is of one rank.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, Any

from ruamel.yaml.comments import CommentedMap, CommentedSeq

from rosprivacy.analysis.errors import LabelError, shown
from rosprivacy.analysis.kernel.ranks import NONE_OF, decided
from rosprivacy.analysis.text import blanked, printable
from rosprivacy.ingest.annotations.annotation_text import NONE
from rosprivacy.ingest.labels.label_writer import NEW, NewLine, with_lines
from rosprivacy.ontology.vocabulary import TOP

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from rosprivacy.analysis.model import Statement
    from rosprivacy.ingest.annotations.attached import Key, Labelled
    from rosprivacy.ontology.vocabulary import Vocabulary

HEAD = "# Written by rosprivacy annotations"
HEADER = f"{HEAD}: change the comments in the code, not this file.\n{NEW}"
BARE = ("mundane", "sensitive", "conduit")  # of every kind of data: a label that stands alone
ROLE_NONE = {role: key for key, role in NONE_OF.items()}
CHANNELS = "channels"


def label_text(labelled: Sequence[Labelled], vocabulary: Vocabulary, file: str) -> str:
    """Return the text of a label file.

    Parameters
    ----------
    file
        For messages about the text itself.
    """
    by_element: dict[Key, list[Labelled]] = defaultdict(list)
    for one in labelled:
        by_element[one.section, one.name].append(one)
    lines = [_line(key, some) for key, some in sorted(by_element.items())]
    return with_lines(file, HEADER, lines, vocabulary)


def conflicts(labelled: Iterable[Labelled], vocabulary: Vocabulary) -> Iterator[LabelError]:
    """Yield where annotations contradict each other, or say together what no label file can say."""
    by_element: dict[Key, list[Statement]] = defaultdict(list)
    for one in labelled:
        by_element[one.section, one.name] += one.said
    for (section, name), own in sorted(by_element.items()):
        said = _united(own)
        beside = () if section in ("nodes", CHANNELS) else _united(by_element.get((CHANNELS, name), ()))
        yield from tuple(_contradictions(name, [*said, *beside], vocabulary)) or _not_together(name, said)


def _united(said: Iterable[Statement]) -> list[Statement]:
    """Statements with one for all channels that a source of one kind goes through, by file and line."""
    united: dict[Any, Statement] = {}
    for one in sorted(said, key=lambda s: (s.place.file, s.place.line)):
        key = (one.role, one.categories, bool(one.through), one.method, one.stated, one.to)
        first = united.setdefault(key, one)
        united[key] = first._replace(through=tuple(sorted({*first.through, *one.through})))
    return [*united.values()]


def _contradictions(name: str, said: Sequence[Statement], vocabulary: Vocabulary) -> Iterator[LabelError]:
    named = {category for one in said for category in (*one.categories, one.to) if category} or {TOP}
    for category in sorted({narrower for one in named for narrower in vocabulary.with_narrower(one)}):
        try:
            decided(name, said, category, vocabulary.hierarchy)
        except LabelError as error:
            yield error
            return


def _not_together(name: str, said: Sequence[Statement]) -> Iterator[LabelError]:
    """What contradicts nothing, and what one line of a label file cannot say."""
    bare = next((one for one in said if not one.categories and one.role in BARE), None)
    other = next((one for one in said if bare and one.role != bare.role), None)
    other = other or next((one for one in said if bare and one.categories), None)
    if bare and other:
        what = f"{shown(name)} is {bare.role} of every kind here and {other.role} at {printable(str(other.place))}"
        yield LabelError(*bare.place, what, "keep one of them, or name its kinds of data")
    for role, none in NONE_OF.items():
        back, stated = (next((one for one in said if one.role == key), None) for key in (none, role))
        if back and stated:
            what = f"{shown(name)} is {role} none here, and a {role} at {printable(str(stated.place))}"
            yield LabelError(*back.place, what, "keep one of them")
    sources = [one for one in said if one.role == "source"]
    free = next((one for one in sources if not one.through), None)
    through = next((one for one in sources if one.through), None)
    if free and through:
        what = (
            f"{shown(name)} is a source through all channels here, and through some at {printable(str(through.place))}"
        )
        yield LabelError(*free.place, what, "write source at the publishers alone, or at the class alone")


def _line(key: Key, some: Iterable[Labelled]) -> NewLine:
    section, name = key
    ordered = sorted(some, key=lambda one: (one.place, one.note))
    said = _united(statement for one in ordered for statement in one.said)
    notes = [blanked(one.note) for one in ordered if one.note]
    label = _label(said)
    if isinstance(label, str):  # takes no note of its own
        remark = ": ".join((_places(ordered), "; ".join(notes))) if notes else _places(ordered)
        return NewLine(section, name, remark, label)
    if notes:
        label["note"] = "; ".join(dict.fromkeys(notes))
    return NewLine(section, name, _places(ordered), _flow(label))


def _places(some: Iterable[Labelled]) -> str:
    return ", ".join(dict.fromkeys(str(one.place) for one in some))


def _label(said: Sequence[Statement]) -> str | dict[str, Any]:
    """The label as a label file has it."""
    if said[0].role in BARE and not said[0].categories:
        return said[0].role
    label: dict[str, Any] = {}
    for one in said:
        if one.role in ROLE_NONE:
            label[ROLE_NONE[one.role]] = NONE
        elif one.role == "source" and one.through:
            label.setdefault("source", {})[one.categories[0]] = list(one.through)
        elif one.role == "sanitizer":
            methods = label.setdefault("sanitizer", {})
            methods[one.categories[0]] = str(one.method) if one.stated else methods.get(one.categories[0])
        elif one.role == "derivation":
            label.setdefault("derives", []).append({"from": one.categories[0], "to": one.to})
        else:
            label[one.role] = sorted({*label.get(one.role, ()), *one.categories})
    return {key: dict(sorted(value.items())) if isinstance(value, dict) else value for key, value in label.items()}


def _flow(value: Any) -> Any:
    """The same in one line of YAML."""
    if isinstance(value, dict):
        made: Any = CommentedMap({key: _flow(one) for key, one in value.items()})
    elif isinstance(value, list):
        made = CommentedSeq(map(_flow, value))
    else:
        return value
    made.fa.set_flow_style()
    return made
