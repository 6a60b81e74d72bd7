"""Annotations -> the elements that they are about, and the text of a label file that says the same.

In: files of source code. Out: statements by element; the label file, each entry with the lines of code that it comes
from; and every problem. An annotation attached to nothing is one (rule S11); so are two that contradict each other, by
the rules of labels (S7, S10): the word of one person in two places of the code is of one rank. Which of several calls
is meant, and what a name that is no literal may be, is never guessed. An annotation in code that is not read, as code
of others (``vendor``, ``build``), is a problem too; most of such code has none, and may be of any age, so it is only
searched.
"""

from __future__ import annotations

from collections import defaultdict
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

from ruamel.yaml.comments import CommentedMap, CommentedSeq

from rosprivacy.analysis.errors import LabelError, shown
from rosprivacy.analysis.kernel.ranks import NONE_OF, decided
from rosprivacy.analysis.model import Place
from rosprivacy.analysis.text import blanked, printable
from rosprivacy.ingest.code.annotation_text import NONE, NOTE, OF_CHANNELS, OF_NODES, SIGN, Annotation, read_annotation
from rosprivacy.ingest.code.code_names import CodeNames, comments_above, is_ros_name
from rosprivacy.ingest.code.source_code import NODE, WRITES
from rosprivacy.ingest.code.source_files import MAX_BYTES
from rosprivacy.ingest.labels.label_writer import NEW, NewLine, with_lines
from rosprivacy.ingest.reading.bounded_file import read_regular
from rosprivacy.ontology.vocabulary import TOP

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from rosprivacy.analysis.errors import InputError
    from rosprivacy.analysis.model import Statement
    from rosprivacy.ingest.code.source_code import CallSite, Code, SourceLines
    from rosprivacy.ontology.vocabulary import Vocabulary

SECTION = {NODE: "nodes", "topic": "topics", "service": "services", "action": "actions"}
WHERE_TO_PUT = (
    "put it on the line of a call or class of a node, or directly above it; or name the element: privacy(/name): …"
)
BELOW = "*"  # image_transport adds /compressed and others; not all of them are granted, so it is one glob
Key = tuple[str, str]  # section of a label file, name
HEAD = "# Written by rosprivacy annotations"
HEADER = f"{HEAD}: change the comments in the code, not this file.\n{NEW}"
BARE = ("mundane", "sensitive", "conduit")  # of every kind of data: a label that stands alone
ROLE_NONE = {role: key for key, role in NONE_OF.items()}
CHANNELS = "channels"
COMMENT = ("#", "//", "/*", "*", "//!", "///")  # what an annotation comes behind
MARKS = (f"{SIGN}:", f"{SIGN}(")


class Labelled(NamedTuple):
    """What one annotation says of one element.

    Attributes
    ----------
    section, name
        As in a label file.
    """

    section: str
    name: str
    place: Place
    statements: tuple[Statement, ...] = ()
    note: str = ""


def attach(
    codes: Sequence[Code], vocabulary: Vocabulary, namespace: str
) -> tuple[tuple[Labelled, ...], tuple[InputError, ...]]:
    """Return what the annotations of some files say, by file and line, and all problems."""
    names = CodeNames(codes, namespace)
    labelled: list[Labelled] = []
    problems: list[InputError] = []
    for code in codes:
        problems += code.problems
        for made in _of_file(code, names, vocabulary):
            if isinstance(made, Labelled):
                labelled.append(made)
            else:
                problems.append(made)
    said = [one for one in labelled if one.statements]
    elements = {(one.section, one.name) for one in said}
    for note in (one for one in labelled if one.note):
        about = sorted(key for key in elements if key[1] == note.name and note.section in ("", key[0]))
        said += [note._replace(section=section) for section, _ in about]
        if not about and not problems:
            hint = "say what it does, or remove the note"
            problems.append(LabelError(*note.place, f"a note about {shown(note.name)}, of which nothing is said", hint))
    return tuple(sorted(said, key=lambda one: (one.place, one.section))), tuple(problems)


def _of_file(code: Code, names: CodeNames, vocabulary: Vocabulary) -> Iterator[Labelled | LabelError]:
    beside = _Beside(code, names)
    notes: list[tuple[CallSite, Annotation]] = []
    elements: dict[CallSite, list[Labelled]] = defaultdict(list)  # what others beside a call are about
    for comment in code.comments:
        read = read_annotation(comment.text, Place(code.file, comment.line), vocabulary)
        if read is None:
            continue
        if isinstance(read, LabelError) or read.name:
            yield read if isinstance(read, LabelError) else _by_name(read)
            continue
        site = beside.of(comment.line)
        if isinstance(site, LabelError):
            yield site
        elif read.word == NOTE:
            notes.append((site, read))
        else:
            made = _at_site(code, names, site, read)
            yield made
            elements[site] += [made] if isinstance(made, Labelled) else []
    for site, note in notes:
        section, name = SECTION[site.kind], names.name(code, site)
        about = {(one.section, one.name) for one in elements[site]} or {(section, name)}
        if name or elements[site]:
            yield from (Labelled(*element, note.place, note=note.note) for element in sorted(about))
        else:
            yield _no_name(note, site, "/name")


def _by_name(annotation: Annotation) -> Labelled:
    """What names its element; a note is about all that is said of that name."""
    section = "" if annotation.word == NOTE else "nodes" if annotation.word in OF_NODES else "channels"
    return Labelled(section, annotation.name, annotation.place, annotation.statements, annotation.note)


def _at_site(code: Code, names: CodeNames, site: CallSite, annotation: Annotation) -> Labelled | LabelError:
    name = names.name(code, site)
    if site.kind == NODE:
        if annotation.word in OF_CHANNELS:
            hint = f"write it at the call that makes the channel, or name it: privacy(/topic): {annotation.word} …"
            return LabelError(*annotation.place, f"{annotation.word} is said of a channel, and this is a node", hint)
        return (
            Labelled("nodes", name, annotation.place, annotation.statements)
            if name
            else _no_name(annotation, site, "/camera")
        )
    if annotation.word == "source":
        return _source(code, names, site, annotation)
    if annotation.word in OF_NODES:
        hint = f"write it at the node's class or constructor, or name the node: privacy(/camera): {annotation.word} …"
        return LabelError(*annotation.place, f"{annotation.word} is said of a node, and this is a {site.kind}", hint)
    return (
        Labelled(SECTION[site.kind], name, annotation.place, annotation.statements)
        if name
        else _no_name(annotation, site, "/image")
    )


def _source(code: Code, names: CodeNames, site: CallSite, annotation: Annotation) -> Labelled | LabelError:
    """A call that writes: its node is a source, through this channel (rule S8)."""
    if site.role not in WRITES:
        return LabelError(
            *annotation.place, "source at a subscription, which brings nothing in", "write it at the publisher"
        )
    if any(said.through or not said.categories for said in annotation.statements):
        hint = "write the kinds of data alone: privacy: source Video"
        return LabelError(*annotation.place, "the call itself says through which channel the data come", hint)
    name, node = names.name(code, site), names.node(code, site.owner)
    if not name or not node:
        return _no_name(annotation, site, "/camera", "source Video through /image")
    through = (name + BELOW,) if site.prefix else (name,)
    return Labelled(
        "nodes", node, annotation.place, tuple(said._replace(through=through) for said in annotation.statements)
    )


def _no_name(annotation: Annotation, site: CallSite, example: str, says: str = "") -> LabelError:
    written = site.written
    if written is not None and not is_ros_name(written):
        what = f"{shown(written)!r} is no full name of ROS"
    elif written is None:
        what = "the name here is no literal"
    else:
        what = "the node here has no name that is a literal"
    hint = f"name the element in the annotation: privacy({example}): {says or annotation.word}"
    return LabelError(*annotation.place, what, hint)


class _Beside:
    """Which class or call a line of a comment stands beside."""

    def __init__(self, code: Code, names: CodeNames) -> None:
        self.code = code
        self.names = names
        self.above = comments_above(code)
        self.sites = [site for site in code.sites if site.kind != NODE or names.is_node(code, site)]

    def of(self, line: int) -> CallSite | LabelError:
        """Return the site; a call alone goes before the statement that it is a part of."""
        sites = [site for site in self.sites if self._claims(site.lines, line)]
        sites = sites or [site for site in self.sites if self._claims(site.statement, line)]
        told_apart = {(self.names.name(self.code, site) or site.lines, site.kind, site.role) for site in sites}
        place = Place(self.code.file, line)
        if not sites:
            return LabelError(*place, "an annotation attached to nothing", WHERE_TO_PUT)
        if len(told_apart) > 1:
            what = f"an annotation beside {len(told_apart)} calls or classes"
            return LabelError(*place, what, "put each on a line of its own, or name the element: privacy(/name): …")
        return sites[0]

    def _claims(self, lines: SourceLines, line: int) -> bool:
        return self.above.get(lines.first, lines.first) <= line <= lines.last


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
        by_element[one.section, one.name] += one.statements
    for (section, name), own in sorted(by_element.items()):
        said = _united(own)
        beside = () if section in ("nodes", CHANNELS) else _united(by_element.get((CHANNELS, name), ()))
        yield from tuple(_contradictions(name, [*said, *beside], vocabulary)) or _not_together(name, said)


def _united(statements: Iterable[Statement]) -> list[Statement]:
    """Statements with one for all channels that a source of one kind goes through, by file and line."""
    united: dict[Any, Statement] = {}
    for one in sorted(statements, key=lambda s: (s.place.file, s.place.line)):
        key = (one.role, one.categories, bool(one.through), one.method, one.stated, one.to)
        first = united.setdefault(key, one)
        united[key] = first._replace(through=tuple(sorted({*first.through, *one.through})))
    return [*united.values()]


def _contradictions(name: str, statements: Sequence[Statement], vocabulary: Vocabulary) -> Iterator[LabelError]:
    named = {category for one in statements for category in (*one.categories, one.to) if category} or {TOP}
    for category in sorted({narrower for one in named for narrower in vocabulary.with_narrower(one)}):
        try:
            decided(name, statements, category, vocabulary.hierarchy)
        except LabelError as error:
            yield error
            return


def _not_together(name: str, statements: Sequence[Statement]) -> Iterator[LabelError]:
    """What contradicts nothing, and what one line of a label file cannot say."""
    bare = next((one for one in statements if not one.categories and one.role in BARE), None)
    other = next((one for one in statements if bare and one.role != bare.role), None)
    other = other or next((one for one in statements if bare and one.categories), None)
    if bare and other:
        what = f"{shown(name)} is {bare.role} of every kind here and {other.role} at {printable(str(other.place))}"
        yield LabelError(*bare.place, what, "keep one of them, or name its kinds of data")
    for role, none in NONE_OF.items():
        back, stated = (next((one for one in statements if one.role == key), None) for key in (none, role))
        if back and stated:
            what = f"{shown(name)} is {role} none here, and a {role} at {printable(str(stated.place))}"
            yield LabelError(*back.place, what, "keep one of them")
    sources = [one for one in statements if one.role == "source"]
    free = next((one for one in sources if not one.through), None)
    through = next((one for one in sources if one.through), None)
    if free and through:
        what = (
            f"{shown(name)} is a source through all channels here, and through some at {printable(str(through.place))}"
        )
        yield LabelError(*free.place, what, "write source at the publishers alone, or at the class alone")


def _line(key: Key, elements: Iterable[Labelled]) -> NewLine:
    section, name = key
    ordered = sorted(elements, key=lambda one: (one.place, one.note))
    said = _united(statement for one in ordered for statement in one.statements)
    notes = [blanked(one.note) for one in ordered if one.note]
    label = _label(said)
    if isinstance(label, str):  # takes no note of its own
        remark = ": ".join((_places(ordered), "; ".join(notes))) if notes else _places(ordered)
        return NewLine(section, name, remark, label)
    if notes:
        label["note"] = "; ".join(dict.fromkeys(notes))
    return NewLine(section, name, _places(ordered), _flow(label))


def _places(elements: Iterable[Labelled]) -> str:
    return ", ".join(dict.fromkeys(str(one.place) for one in elements))


def _label(statements: Sequence[Statement]) -> str | dict[str, Any]:
    """The label as a label file has it."""
    if statements[0].role in BARE and not statements[0].categories:
        return statements[0].role
    label: dict[str, Any] = {}
    for one in statements:
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


def lost_annotations(unread: Iterable[tuple[str, str]], vocabulary: Vocabulary) -> Iterator[LabelError]:
    """Yield a problem for each annotation in code that was left out.

    Parameters
    ----------
    unread
        As of ``Sources``.
    """
    for file, folder in unread:
        for number, line in enumerate(_lines(file), 1):
            before, sign, rest = line.partition(SIGN)
            text = (sign + rest).removesuffix("*/")
            if text.startswith(MARKS) and before.rstrip().endswith(COMMENT):
                place = Place(file, number)
                if _is_meant(text, read_annotation(text, place, vocabulary)):
                    what = f"this annotation is not read, since {shown(folder)} is taken for code of others"
                    hint = "name that folder, too, to have it read; or put a file COLCON_IGNORE into it to leave it out"
                    yield LabelError(*place, what, hint)


def _is_meant(text: str, read: Annotation | LabelError | None) -> bool:
    """Whether it is an annotation, or a wrong one about what a node does: others write of privacy, too."""
    word = text.partition(":")[2].split(maxsplit=1)[:1]
    return not isinstance(read, LabelError | None) or word in ([one] for one in OF_NODES)


def _lines(file: str) -> list[str]:
    """The lines of a file that may have an annotation."""
    try:
        data = read_regular(file, MAX_BYTES, partial(LabelError, file))
    except LabelError:
        return []
    return [line.rstrip() for line in data.decode("utf-8", "replace").split("\n")] if SIGN.encode() in data else []
