"""DDS-Security XML from anybody -> elements in their order, with every problem at its line; and DDS domains.

In: the text of a permissions or governance file. Out: a ``XmlSection`` that is asked for its children one after the
other, as the schemas demand them, and notes what is missing, misplaced or no value of its kind; ``Domains`` that a rule
is about.

Source: DDS-Security 1.1, 9.4.1.2 (governance) and 9.4.1.3 (permissions), with their XML schemas. Where the middlewares
take more than the schema (``TRUE``, elements of a topic rule in another order), it is taken here too. A range of
domains without ``<max>`` is open-ended in the standard; Fast DDS and Cyclone DDS read it as one domain
(``CommonParser.cpp``, ``access_control_parser.c``): so a rule is about some domains surely, and about others perhaps.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputErrors, PolicyError, shown
from rosprivacy.analysis.model import Diagnostic, Place, Severity
from rosprivacy.ingest.policies.xinclude import parsed

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

    from lxml import etree

    from rosprivacy.analysis.errors import InputError

BOOLEANS = {"true": True, "1": True, "false": False, "0": False}
LAST_DOMAIN = 2**32 - 1  # as the schema has it
LAST_OF_ROS = 232  # the ports of UDP suffice for no more
Spans = tuple[tuple[int, int], ...]
"""(first, last) of each range of domains, both in it."""


@dataclass(frozen=True, slots=True)
class Domains:
    """A set of domains.

    Attributes
    ----------
    closed
        The ranges that have both ends, sorted.
    opened
        Where ranges without ``<max>`` begin, sorted.
    """

    closed: Spans
    opened: tuple[int, ...] = ()

    @property
    def spans(self) -> Spans:
        """All that a rule may be about.

        >>> Domains(((0, 0),), (7,)).spans == ((0, 0), (7, LAST_DOMAIN))
        True
        """
        return (*self.closed, *((first, LAST_DOMAIN) for first in self.opened))

    @property
    def certain(self) -> Spans:
        """What it is about to every middleware.

        >>> Domains(((0, 0),), (7,)).certain
        ((0, 0), (7, 7))
        """
        return (*self.closed, *((first, first) for first in self.opened))

    def __contains__(self, domain: int) -> bool:
        """Whether a rule may be about a domain.

        >>> 3 in Domains(((0, 0), (2, 5))), 1 in Domains(((0, 0), (2, 5)))
        (True, False)
        """
        return bool(common(self.spans, ((domain, domain),)))

    def surely(self, domain: int) -> bool:
        """Return whether a rule is about a domain to every middleware.

        >>> Domains((), (7,)).surely(7), Domains((), (7,)).surely(8), 8 in Domains((), (7,))
        (True, False, True)
        """
        return bool(common(self.certain, ((domain, domain),)))

    def __str__(self) -> str:
        return written(self.spans)


def common(spans: Spans, other: Spans) -> Spans:
    """Return what is in both.

    >>> common(((0, 5), (9, 9)), ((3, 7),))
    ((3, 5),)
    """
    both = ((max(a, c), min(b, d)) for a, b in spans for c, d in other)
    return tuple(sorted({(first, last) for first, last in both if first <= last}))


def without(spans: Spans, excluded: Spans) -> Spans:
    """Return what is left when some domains are taken out.

    >>> without(((0, 9),), ((3, 4), (9, 20)))
    ((0, 2), (5, 8))
    """
    for low, high in excluded:
        spans = tuple(
            (first, last)
            for start, end in spans
            for first, last in ((start, min(end, low - 1)), (max(start, high + 1), end))
            if first <= last
        )
    return tuple(sorted(set(spans)))


def written(spans: Spans) -> str:
    """Return ranges as a person writes them.

    >>> written(Domains(((0, 0), (2, 5)), (7,)).spans)
    '0, 2 to 5, 7 and above'
    """
    return ", ".join(
        str(first) if first == last else f"{first} and above" if last == LAST_DOMAIN else f"{first} to {last}"
        for first, last in spans
    )


@dataclass(frozen=True, slots=True)
class XmlSource:
    """Where a text stands, and what was found wrong in it.

    Attributes
    ----------
    before
        Lines of the file before the text, as in a signed file.
    """

    file: str
    before: int = 0
    problems: list[InputError] = field(default_factory=list)

    def place(self, element: etree._Element) -> Place:
        """Return file and line of an element."""
        return Place(self.file, self.before + (element.sourceline or 0))

    def problem(self, element: etree._Element, message: str, hint: str) -> None:
        """Note what is wrong at an element, once: its children are gone through for each name."""
        error = PolicyError(self.file, self.place(element).line, message, hint)
        if str(error) not in map(str, self.problems):
            self.problems.append(error)

    def check(self) -> None:
        """Raise what was found wrong, by line."""
        if self.problems:
            raise InputErrors(sorted(self.problems, key=lambda error: error.line))


def warning(place: Place, message: str, code: str = "") -> Diagnostic:
    """Return a warning, fit to be shown."""
    return Diagnostic(place, Severity.WARNING, shown(message), code)


def section_of(data: bytes, file: str) -> str:
    """Return what a text has in its ``<dds>``: ``permissions``, ``domain_access_rules``; empty for all else."""
    try:
        root = parsed(data, file)
    except PolicyError:
        return ""  # who reads it says why not
    return str(root[0].tag).rpartition("}")[2] if len(root) else ""


def security_entries(data: bytes, source: XmlSource, section: str, entry: str) -> list[XmlSection]:
    """Return the entries of ``<dds><section>`` in a text; that there are none is a problem.

    Raises
    ------
    InputErrors
        If it is not XML that we take.
    """
    try:
        root = parsed(data, source.file)
    except PolicyError as error:
        line = error.line + source.before if error.line else 0
        raise InputErrors([PolicyError(error.file, line, error.problem, error.hint)]) from None
    top = XmlSection(root, source)
    if top.tag != "dds":
        source.problem(root, f"the root element is <{shown(top.tag)}>, not <dds>", f"name a file with <{section}>")
        return []
    found = top.child(section)
    entries = list(found.children({entry})) if found else []
    if found and not entries:
        source.problem(found.element, f"<{section}> is empty", f"add a <{entry}>")
    return entries


@dataclass(frozen=True, slots=True)
class XmlSection:
    """An element and where it stands."""

    element: etree._Element
    source: XmlSource

    @property
    def tag(self) -> str:
        """Its name without a namespace."""
        return str(self.element.tag).rpartition("}")[2]

    @property
    def place(self) -> Place:
        """File and line."""
        return self.source.place(self.element)

    @property
    def text(self) -> str:
        """What stands in it, as the middlewares read it: comments taken out, nothing trimmed."""
        return self.element.text or ""

    def children(self, allowed: Collection[str]) -> Iterator[XmlSection]:
        """Yield the children that belong here; what does not is a problem."""
        for element in self.element:
            child = XmlSection(element, self.source)
            if child.tag in allowed:
                yield child
            else:
                expected = " or ".join(f"<{name}>" for name in sorted(allowed))
                self.source.problem(element, f"<{shown(child.tag)}> in <{self.tag}>", f"here comes {expected}")

    def child(self, tag: str, among: Collection[str] = ()) -> XmlSection | None:
        """Return the child of a name, others of which are ``among``; that it is missing or there twice is a problem."""
        found = [child for child in self.children({tag, *among}) if child.tag == tag]
        if not found:
            self.source.problem(self.element, f"<{self.tag}> without <{tag}>", f"add <{tag}>")
            return None
        for extra in found[1:]:
            self.source.problem(extra.element, f"second <{tag}> in <{self.tag}>", "remove it")
        return found[0]

    def chosen(self, values: Collection[str], default: str) -> str:
        """Return the text, which is one of some values; the default, with the problem noted, if it is another."""
        text = self.text.strip()
        if text in values:
            return text
        self.source.problem(
            self.element, f"{shown(repr(text))} in <{self.tag}>", f"write {' or '.join(sorted(values))}"
        )
        return default

    def boolean(self) -> bool:
        """Return the truth value that is written."""
        text = self.text.strip().lower()
        if text in BOOLEANS:
            return BOOLEANS[text]
        self.source.problem(self.element, f"{shown(repr(text))} in <{self.tag}>", "write true or false")
        return False

    def domains(self) -> Domains:
        """Return the domains of ``<domains>`` (9.4.1.2.4.1, 9.4.1.3.2.3.1.1)."""
        closed, opened = set(), set()
        for child in self.children({"id", "id_range"}):
            if child.tag == "id":
                number = child.number()
                closed.add((number, number))
                continue
            ends = {end.tag: end.number() for end in child.children({"min", "max"})}
            low, high = ends.get("min", 0), ends.get("max", LAST_DOMAIN)
            if not ends or low > high:
                self.source.problem(child.element, "<id_range> that holds no domain", "write <min> and <max>")
            elif "max" in ends:
                closed.add((low, high))
            else:
                opened.add(low)
        if not (closed or opened):
            self.source.problem(self.element, "<domains> is empty", "add <id>0</id>")
        return Domains(tuple(sorted(closed)), tuple(sorted(opened)))

    def number(self) -> int:
        """Return the number of a domain that is written; 0, with the problem noted, if it is none."""
        text = self.text.strip()
        if text.isascii() and text.isdecimal() and len(text) < len(str(2**32)):
            return int(text)
        self.source.problem(self.element, f"{shown(repr(text))} in <{self.tag}>", "write the number of a domain")
        return 0
