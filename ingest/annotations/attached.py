"""Annotations -> the elements that they are about: what an annotation names, or the class or call beside it.

In: files of source code. Out: statements by element, and every problem; an annotation attached to nothing is one
(rule S11). Which of several calls is meant, and what a name that is no literal may be, is never guessed.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import LabelError, shown
from rosprivacy.analysis.model import Place
from rosprivacy.ingest.annotations.annotation_text import NOTE, OF_CHANNELS, OF_NODES, Annotation, read_annotation
from rosprivacy.ingest.annotations.code_names import CodeNames, is_ros_name
from rosprivacy.ingest.annotations.source_code import NODE, WRITES

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from rosprivacy.analysis.errors import InputError
    from rosprivacy.analysis.model import Statement
    from rosprivacy.ingest.annotations.source_code import Code, Lines, Site
    from rosprivacy.ontology.vocabulary import Vocabulary

SECTION = {NODE: "nodes", "topic": "topics", "service": "services", "action": "actions"}
BESIDE = "put it on the line of a call or class of a node, or directly above it; or name the element: privacy(/name): …"
BELOW = "*"  # image_transport adds /compressed and others; not all of them are granted, so it is one glob
Key = tuple[str, str]  # section of a label file, name


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
    said: tuple[Statement, ...] = ()
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
    said = [one for one in labelled if one.said]
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
    notes: list[tuple[Site, Annotation]] = []
    elements: dict[Site, list[Labelled]] = defaultdict(list)  # what others beside a call are about
    for comment in code.comments:
        read = read_annotation(comment.text, Place(code.file, comment.line), vocabulary)
        if read is None:
            continue
        if isinstance(read, LabelError) or read.name:
            yield read if isinstance(read, LabelError) else _named(read)
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


def _named(one: Annotation) -> Labelled:
    """What names its element; a note is about all that is said of that name."""
    section = "" if one.word == NOTE else "nodes" if one.word in OF_NODES else "channels"
    return Labelled(section, one.name, one.place, one.said, one.note)


def _at_site(code: Code, names: CodeNames, site: Site, one: Annotation) -> Labelled | LabelError:
    name = names.name(code, site)
    if site.kind == NODE:
        if one.word in OF_CHANNELS:
            hint = f"write it at the call that makes the channel, or name it: privacy(/topic): {one.word} …"
            return LabelError(*one.place, f"{one.word} is said of a channel, and this is a node", hint)
        return Labelled("nodes", name, one.place, one.said) if name else _no_name(one, site, "/camera")
    if one.word == "source":
        return _source(code, names, site, one)
    if one.word in OF_NODES:
        hint = f"write it at the node's class or constructor, or name the node: privacy(/camera): {one.word} …"
        return LabelError(*one.place, f"{one.word} is said of a node, and this is a {site.kind}", hint)
    return Labelled(SECTION[site.kind], name, one.place, one.said) if name else _no_name(one, site, "/image")


def _source(code: Code, names: CodeNames, site: Site, one: Annotation) -> Labelled | LabelError:
    """A call that writes: its node is a source, through this channel (rule S8)."""
    if site.role not in WRITES:
        return LabelError(*one.place, "source at a subscription, which brings nothing in", "write it at the publisher")
    if any(said.through or not said.categories for said in one.said):
        hint = "write the kinds of data alone: privacy: source Video"
        return LabelError(*one.place, "the call itself says through which channel the data come", hint)
    name, node = names.name(code, site), names.node(code, site.owner)
    if not name or not node:
        return _no_name(one, site, "/camera", "source Video through /image")
    through = (name + BELOW,) if site.more else (name,)
    return Labelled("nodes", node, one.place, tuple(said._replace(through=through) for said in one.said))


def _no_name(one: Annotation, site: Site, example: str, says: str = "") -> LabelError:
    written = site.written
    if written is not None and not is_ros_name(written):
        what = f"{shown(written)!r} is no full name of ROS"
    elif written is None:
        what = "the name here is no literal"
    else:
        what = "the node here has no name that is a literal"
    hint = f"name the element in the annotation: privacy({example}): {says or one.word}"
    return LabelError(*one.place, what, hint)


class _Beside:
    """Which class or call a line of a comment stands beside."""

    def __init__(self, code: Code, names: CodeNames) -> None:
        self.code = code
        self.names = names
        self.above: dict[int, int] = {}  # line of code -> the first of the comment lines directly above it
        for line in sorted({comment.line for comment in code.comments if comment.alone}):
            self.above[line + 1] = self.above.get(line, line)
        self.sites = [site for site in code.sites if site.kind != NODE or names.is_node(code, site)]

    def of(self, line: int) -> Site | LabelError:
        """Return the site; a call alone goes before the statement that it is a part of."""
        sites = [site for site in self.sites if self._claims(site.lines, line)]
        sites = sites or [site for site in self.sites if self._claims(site.statement, line)]
        told_apart = {(self.names.name(self.code, site) or site.lines, site.kind, site.role) for site in sites}
        place = Place(self.code.file, line)
        if not sites:
            return LabelError(*place, "an annotation attached to nothing", BESIDE)
        if len(told_apart) > 1:
            what = f"an annotation beside {len(told_apart)} calls or classes"
            return LabelError(*place, what, "put each on a line of its own, or name the element: privacy(/name): …")
        return sites[0]

    def _claims(self, lines: Lines, line: int) -> bool:
        return self.above.get(lines.first, lines.first) <= line <= lines.last
