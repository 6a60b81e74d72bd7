"""Literal names in code -> names of nodes and channels as ROS resolves them, and what code says plainly of these.

In: the files of a package. Out: the node that a class or a variable is, the full name at a call; types and comments
beside calls, as evidence for suggestions (comments are words of anybody: nothing is read out of them here). What is not
known has no name. Remapping and launch files are not seen: labels name what policies name, and a name that is not there
is an error then (rule S11).

Measured on public packages: two thirds of the ends of channels have a literal name, a third a node that is known.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.model import Place
from rosprivacy.ingest.code.source_code import NODE, NODE_CLASSES, class_of
from rosprivacy.ingest.policies.names import resolve

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rosprivacy.ingest.code.source_code import CallSite, Code

    PlacedName = tuple[str, str]  # kind and full name of an element

ROOT = "/"


class CodeNames:
    """The names in some files of source code.

    Parameters
    ----------
    namespace
        Of nodes that state none.
    """

    def __init__(self, codes: Sequence[Code], namespace: str = ROOT) -> None:
        self.namespace = namespace
        self._bases: dict[tuple[str, str], set[str]] = defaultdict(set)
        for code in codes:
            for one in code.classes:
                self._bases[code.language, one.name].update(one.bases)
        self._node_classes = {language: self._derived(language) for language in {code.language for code in codes}}
        self._of_file: dict[tuple[str, str], set[str | None]] = defaultdict(set)
        self._of_language: dict[tuple[str, str], set[str | None]] = defaultdict(set)
        self._in_a_namespace: set[tuple[str, str]] = set()  # file and owner: the code states one, a literal or not
        for code in codes:
            for site in code.sites:
                if site.kind == NODE and site.owner and not site.head and self.is_node(code, site):
                    name = self._of_site(site)
                    if site.namespace != "":
                        self._in_a_namespace.add((code.file, site.owner))
                    self._of_file[code.file, site.owner].add(name)
                    self._of_language[code.language, site.owner].add(name)

    def is_node(self, code: Code, site: CallSite) -> bool:
        """Return whether a site that may be one of a node is one."""
        name, classes = class_of(site.owner), self._node_classes[code.language]
        if not name:
            return True
        if not site.base:
            return name in classes
        known = self._bases.get((code.language, name))
        return site.base in (NODE_CLASSES if known is None else known) and site.base in classes

    def node(self, code: Code, owner: str) -> str:
        """Return the full name of the node that a class or a variable is; empty where it is not known."""
        here = self._of_file.get((code.file, owner), set())
        names = here or (self._of_language.get((code.language, owner), set()) if class_of(owner) else set())
        return next(iter(names)) or "" if len(names) == 1 else ""

    def name(self, code: Code, site: CallSite) -> str:
        """Return the full name at a site; empty where it is not known."""
        if site.kind == NODE:
            return self.node(code, site.owner) if site.head else self._of_site(site) or ""
        written = site.written or ""
        if not is_ros_name(written):
            return ""
        node = self.node(code, site.owner)
        unknown = written.startswith("~") or (code.file, site.owner) in self._in_a_namespace
        if not node and unknown and not written.startswith("/"):
            return ""
        space, _, base = node.rpartition("/") if node else (self.namespace, "", "")
        return resolve(written, space or ROOT, base)

    def _of_site(self, site: CallSite) -> str | None:
        """The name of a node where it is made."""
        written, space = site.written or "", site.namespace
        if not written.isascii() or not written.isidentifier() or space is None:
            return None
        space = resolve(space.rstrip("/"), self.namespace, "") if space.strip("/") else self.namespace
        return resolve(written, space, "") if is_ros_name(space) or space == ROOT else None

    def _derived(self, language: str) -> set[str]:
        """Classes of nodes: those of ROS, and what is derived from one."""
        known, before = set(NODE_CLASSES), 0
        while len(known) > before:
            before = len(known)
            known |= {name for (of, name), bases in self._bases.items() if of == language and bases & known}
        return known


def is_ros_name(name: str) -> bool:
    """Return whether a name is one that ROS takes as it is, without substitutions.

    >>> [is_ros_name(one) for one in ("image", "/a/b", "~/c", "~", "a//b", "{node}/x", "", "a b")]
    [True, True, True, True, False, False, False, False]
    """
    if name == "~":
        return True
    parts = name.removeprefix("~").removeprefix("/").split("/")
    return all(part.isascii() and part.isidentifier() for part in parts) and not name.startswith("~~")


class CodeEvidence(NamedTuple):
    """One call that makes an end of a channel.

    Attributes
    ----------
    kind
        ``topic``, ``service`` or ``action``.
    role
        ``publish``, ``subscribe``, ``reply``, ``request``, ``execute``, ``call``.
    name, node
        Full names of the channel and of its node; empty where the code does not say.
    type
        ``pkg/msg/Name``; empty where the file does not say.
    """

    place: Place
    kind: str
    role: str
    name: str = ""
    type: str = ""
    node: str = ""


def code_evidence(codes: Sequence[Code], namespace: str = ROOT) -> tuple[CodeEvidence, ...]:
    """Return what some files say of channels, by file and line.

    Parameters
    ----------
    namespace
        Of nodes that state none.
    """
    names = CodeNames(codes, namespace)
    return tuple(
        sorted(
            CodeEvidence(
                Place(code.file, site.lines.first),
                site.kind,
                site.role,
                names.name(code, site),
                site.type,
                names.node(code, site.owner),
            )
            for code in codes
            for site in code.sites
            if site.kind != NODE
        )
    )


def code_comments(codes: Sequence[Code], namespace: str = ROOT) -> dict[PlacedName, tuple[str, ...]]:
    """Return the comments beside each element whose name is a literal, by file and line.

    A comment beside calls about several elements is one of none.

    Parameters
    ----------
    namespace
        Of nodes that state none.

    Examples
    --------
    >>> from rosprivacy.ingest.code.source_code import CallSite, Code, SourceComment, SourceLines
    >>> call = CallSite("topic", "/faces", SourceLines(3, 3), SourceLines(3, 3), "", "publish")
    >>> lines = ((1, "of guests"), (2, "with names"), (9, "other"))
    >>> comments = tuple(SourceComment(line, text, True) for line, text in lines)
    >>> code_comments([Code("a.py", "python", comments, (), (call,))])
    {('topic', '/faces'): ('of guests', 'with names')}
    """
    names = CodeNames(codes, namespace)
    found: dict[PlacedName, list[str]] = defaultdict(list)
    for code in codes:
        beside = _elements_near(code, names)
        for comment in code.comments:
            elements = beside.get(comment.line, set())
            if len(elements) == 1 and comment.text.strip():
                found[next(iter(elements))].append(comment.text.strip())
    return {element: tuple(dict.fromkeys(texts)) for element, texts in found.items()}


def comments_above(code: Code) -> dict[int, int]:
    """Return by line of code the first of the comment lines directly above it."""
    above: dict[int, int] = {}
    for line in sorted({comment.line for comment in code.comments if comment.alone}):
        above[line + 1] = above.get(line, line)
    return above


def _elements_near(code: Code, names: CodeNames) -> dict[int, set[PlacedName]]:
    """By line the elements that a comment there is about."""
    above = comments_above(code)
    beside: dict[int, set[PlacedName]] = defaultdict(set)
    for site in code.sites:
        if site.kind == NODE and not names.is_node(code, site):
            continue
        if name := names.name(code, site):
            for line in range(above.get(site.statement.first, site.statement.first), site.statement.last + 1):
                beside[line].add((site.kind, name))
    return beside
