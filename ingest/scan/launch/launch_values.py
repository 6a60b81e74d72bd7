"""What an argument of a launch file can be: texts and substitutions, and every text that they come to.

In: values as the readers of Python, XML and YAML find them. Out: alternatives, each a text with how it is known; what
the sources leave open stands in braces. Where two values hang on the same choice (an argument with two values that
stands in a namespace and in a remapping), only those of the same choice go together.
"""

from __future__ import annotations

import posixpath
import re
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.ingest.scan.scan_facts import DEFAULT, LITERAL

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

MOST_VALUES = 32  # alternatives of a value; beyond that it is open
LONGEST = 4000  # characters of a value: no name and no path is longer
PACKAGE = "package://"  # begins the path of what a package shares; its name follows
CHECKOUT = "checkout:"  # begins a path from the root of the checkout
OPEN = re.compile(r"\{[^{}]*\}")
DEEPEST = 40  # values in values


class Substitution(NamedTuple):
    """A text that is made when the launch file runs.

    Attributes
    ----------
    sort
        ``configuration`` (name, default), ``environment`` (name, default), ``share`` and ``prefix`` (of a package),
        ``joined`` (parts of a path), ``text`` (parts one after the other), ``folder`` (of a path), ``expression``
        (Python), ``here`` (the folder of the launch file), ``rewritten`` (a file of parameters, what is written into
        it, what is replaced in it), ``contents`` (of a file), ``method`` (of a text, with its name and arguments).
    """

    sort: str
    parts: tuple[object, ...]


class Open(NamedTuple):
    """A value that the sources do not fix; for people why."""

    why: str


class Choice(NamedTuple):
    """One of several values.

    Attributes
    ----------
    chooser
        What decides: choices of the same go together.
    """

    options: tuple[object, ...]
    chooser: str


class Perhaps(NamedTuple):
    """A value that is there only under a condition of the code."""

    value: object


class Alternative(NamedTuple):
    """One text that a value can be.

    Attributes
    ----------
    text
        Open parts in braces.
    why
        Of the open parts.
    picks
        What was chosen for it: (choice, number), sorted.
    """

    text: str
    surety: str = LITERAL
    why: tuple[str, ...] = ()
    picks: tuple[tuple[str, int], ...] = ()


Alternatives = tuple[Alternative, ...]


def choice(options: Iterable[object], chooser: str) -> object:
    """Return one of several values; the value itself where there is only one.

    >>> choice(["a", "a"], "line 3"), choice(["a", "b"], "line 3")
    ('a', Choice(options=('a', 'b'), chooser='line 3'))
    """
    flat: list[object] = []
    for option in options:
        inner = option.options if isinstance(option, Choice) else (option,)
        flat += [one for one in inner if not any(one is other or _equal(one, other) for other in flat)]
        if len(flat) > MOST_VALUES:
            return Open(f"more than {MOST_VALUES} values")
    return flat[0] if len(flat) == 1 else Choice(tuple(flat), chooser)


def _equal(value: object, other: object) -> bool:
    """Whether two values are plainly the same; values in values are not looked into."""
    flat = not isinstance(value, Substitution) or all(isinstance(part, str) for part in value.parts)
    return (
        type(value) is type(other)
        and isinstance(value, str | int | float | Substitution | Open)
        and flat
        and value == other
    )


class LaunchContext:
    """What substitutions look at: configurations and variables of the environment, each with its alternatives.

    Parameters
    ----------
    spend
        Called for every value that is looked at; ends what takes too long.
    evaluate
        A Python expression -> its value.
    """

    def __init__(self, spend: Callable[[], None], evaluate: Callable[[str], object]) -> None:
        self.spend = spend
        self.evaluate = evaluate
        self.configurations: dict[str, Alternatives] = {}
        self.environment: dict[str, Alternatives] = {}
        self.folder = ""  # of the launch file

    def texts(self, value: object, depth: int = 0) -> Alternatives:  # noqa: PLR0911 - one for each type
        """Return every text that a value can be."""
        self.spend()
        if depth > DEEPEST:
            return still_open("nested too deeply")
        if isinstance(value, str):
            return (Alternative(value[:LONGEST]),)
        if isinstance(value, bool):
            return (Alternative("true" if value else "false"),)
        if isinstance(value, int | float):
            return (Alternative(str(value)[:LONGEST]),)
        if value is None:
            return (Alternative(""),)
        if isinstance(value, Open):
            return still_open(value.why)
        if isinstance(value, Perhaps):
            return self.texts(value.value, depth + 1)
        if isinstance(value, Choice):
            return self._chosen(value, depth)
        if isinstance(value, list):
            return self._joined(value, "", depth)
        if isinstance(value, Substitution):
            return self._substituted(value, depth)
        return still_open(getattr(value, "name", "") or "a value that is no text")

    def _chosen(self, value: Choice, depth: int) -> Alternatives:
        made = [
            one._replace(picks=both)
            for number, option in enumerate(value.options)
            for one in self.texts(option, depth + 1)
            if (both := together(one.picks, ((value.chooser, number),))) is not None
        ]
        return tuple(made) if 0 < len(made) <= MOST_VALUES else still_open(f"more than {MOST_VALUES} values")

    def _joined(self, parts: Sequence[object], separator: str, depth: int) -> Alternatives:
        whole = combined([self.texts(part, depth + 1) for part in parts])
        if whole is None:
            return still_open(f"more than {MOST_VALUES} values")
        join = (lambda texts: posixpath.join(*texts)) if separator else "".join
        return tuple(_merged(join([one.text for one in row] or [""]), row) for row in whole)

    def _substituted(self, value: Substitution, depth: int) -> Alternatives:  # noqa: PLR0911 - one for each sort
        first = value.parts[0] if value.parts else None
        if value.sort in ("text", "joined"):
            return self._joined(value.parts, "/" if value.sort == "joined" else "", depth)
        if value.sort == "here":
            return (Alternative(self.folder),)
        made = self.texts(first, depth + 1)
        if value.sort in ("configuration", "environment"):
            held = self.configurations if value.sort == "configuration" else self.environment
            return self._looked_up(made, held, value, depth)
        if value.sort == "share":
            return tuple(one._replace(text=PACKAGE + one.text) for one in made)
        if value.sort == "prefix":
            return tuple(one._replace(text=f"{PACKAGE}{one.text}/../..") for one in made)
        if value.sort == "folder":
            return tuple(one._replace(text=posixpath.dirname(one.text)) for one in made)
        if value.sort == "method":
            return tuple(_by_method(one, *value.parts[1:]) for one in made)
        if value.sort == "expression":
            return self._evaluated(made, depth)
        return still_open(value.sort)

    def _looked_up(
        self, names: Alternatives, table: Mapping[str, Alternatives], value: Substitution, depth: int
    ) -> Alternatives:
        made: list[Alternative] = []
        for name in names:
            values = table.get(name.text)
            if values is None and len(value.parts) > 1:
                values = tuple(one._replace(surety=DEFAULT) for one in self.texts(value.parts[1], depth + 1))
            if values is None:
                values = still_open(f"the {value.sort} {name.text}", name.text)
            made += [
                one._replace(picks=both) for one in values if (both := together(one.picks, name.picks)) is not None
            ]
        return tuple(made) if 0 < len(made) <= MOST_VALUES else still_open(f"more than {MOST_VALUES} values")

    def _evaluated(self, written: Alternatives, depth: int) -> Alternatives:
        made: list[Alternative] = []
        for one in written:
            if one.why:
                made.append(Alternative("{expression}", one.surety, one.why, one.picks))
                continue
            for value in self.texts(self.evaluate(one.text), depth + 1):
                both = together(value.picks, one.picks)
                made += [] if both is None else [_merged(value.text, (value, one))]
        return tuple(made) if 0 < len(made) <= MOST_VALUES else still_open(f"more than {MOST_VALUES} values")


def _by_method(text: Alternative, name: object, *arguments: object) -> Alternative:
    """What a method of a text makes of text; nothing of text that is open."""
    try:
        made = text.text if text.why else getattr(text.text, str(name))(*arguments)
    except (TypeError, ValueError):
        return text._replace(text=f"{{{name}}}", why=(*text.why, str(name)))
    return _merged(made, [text]) if isinstance(made, str) else text


def still_open(why: str, name: str = "") -> Alternatives:
    """Return the one alternative of which nothing is known."""
    word = re.sub(r"[{}\s]+", " ", name or why).strip()
    return (Alternative(f"{{{word or '?'}}}", LITERAL, (why,)),)


def together(
    picks: tuple[tuple[str, int], ...], added: tuple[tuple[str, int], ...]
) -> tuple[tuple[str, int], ...] | None:
    """Return what two alternatives chose; None where they cannot go together.

    >>> together((("x", 0),), (("y", 1),)), together((("x", 0),), (("x", 1),))
    ((('x', 0), ('y', 1)), None)
    """
    if not added or picks == added:
        return picks
    both = dict(picks)
    for name, number in added:
        if both.setdefault(name, number) != number:
            return None
    return tuple(sorted(both.items()))


def combined(slots: Sequence[Alternatives]) -> list[tuple[Alternative, ...]] | None:
    """Return each way to fill some slots; None where there are more than can be told."""
    wide = [number for number, slot in enumerate(slots) if len(slot) != 1 or slot[0].picks]
    rows: list[tuple[tuple[Alternative, ...], tuple[tuple[str, int], ...]]] = [((), ())]
    for number in wide:
        rows = [
            ((*row, one), both)
            for row, picks in rows
            for one in slots[number]
            if (both := together(picks, one.picks)) is not None
        ]
        if len(rows) > MOST_VALUES:
            return None
    whole = []
    for row, _ in rows:
        filled = [slot[0] if slot else Alternative("") for slot in slots]
        for number, one in zip(wide, row, strict=True):
            filled[number] = one
        whole.append(tuple(filled))
    return whole


def path_text(path: str) -> str:
    """Return a path as people know it: a package and what follows, or from the root of the checkout.

    >>> path_text("package://nav2_bringup/launch/../x.py"), path_text("checkout:a/launch/../b.py")
    ('nav2_bringup/x.py', 'a/b.py')
    """
    return posixpath.normpath(path.removeprefix(PACKAGE).removeprefix(CHECKOUT)) if path else ""


def _merged(text: str, parts: Iterable[Alternative]) -> Alternative:
    """The alternative that some alternatives make together."""
    listed = list(parts)
    surety = DEFAULT if any(part.surety == DEFAULT for part in listed) else LITERAL
    why = tuple(dict.fromkeys(reason for part in listed for reason in part.why))
    picks: tuple[tuple[str, int], ...] = ()
    for part in listed:
        picks = together(picks, part.picks) or picks
    if len(text) > LONGEST:
        return Alternative("{too long}", surety, (*why, "a value that is too long"), picks)
    return Alternative(text, surety, why, picks)
