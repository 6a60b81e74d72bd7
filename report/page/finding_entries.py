"""Findings -> the entries of a report: one path to assess each, hop by hop, with policy lines and what is to be asked.

In: an ``Index``. Out: ``PathEntry``, in the order of the document; those that differ only in the robot are one (rule
S10). What people decided about a finding stands with it, and decisions that match none; what the law asks for and
nobody wrote down is named (``analysis/legal.py``).
"""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.text import fit, printable
from rosprivacy.report.catalogs.words import finding_reason, first_of
from rosprivacy.report.finding_facts import gaps_of, grouped, in_order, made_of
from rosprivacy.report.naming import key, line, name
from rosprivacy.report.page.index import anchor, finding_pattern, kind_anchor, state
from rosprivacy.report.page.look_at import revealed
from rosprivacy.report.robots import forms_in_words

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.legal import Gap
    from rosprivacy.report.catalogs.words import Words
    from rosprivacy.report.page.index import Index

FIELDS = ("reason", "condition", "owner", "legal_basis", "date", "expires", "ticket", "state")
DATES = ("date", "expires")
ACCEPT, ORPHANED = "accept", "orphaned"


class DecisionText(NamedTuple):
    """One decision, in words.

    Attributes
    ----------
    decision
        What was decided.
    rows
        (name of the field, value).
    flags
        What has changed since, and what is missing.
    """

    decision: str
    rows: tuple[tuple[str, str], ...]
    flags: tuple[str, ...]


def decision_of(finding: Mapping[str, Any], index: Index) -> DecisionText | None:
    """Return the decision that holds for a finding, or held until it expired; None if there is none."""
    said = finding.get("decision")
    return _decision(said, (finding,), index) if said else None


def orphans(index: Index) -> tuple[DecisionText, ...]:
    """Return the decisions that match no finding, in the order of their file."""
    said = index.document.get("decisions", ())
    return tuple(_decision(entry, (), index) for entry in said if entry["state"] == ORPHANED)


def _decision(decision: Mapping[str, Any], findings: Iterable[Mapping[str, Any]], index: Index) -> DecisionText:
    words, what = index.words, decision["choice"]
    rows = [(words(f"decision.{key}"), _value(decision[key], key, index)) for key in FIELDS if decision.get(key)]
    rows += _answers(decision, words)
    rows += [(words("decision.history"), _step(step, index)) for step in decision.get("history", ())]
    flags = (*_changed(decision, index), *(_flags(decision, findings, index) if what == ACCEPT else ()))
    return DecisionText(words.of_value(f"decision.{what}", what), tuple(rows), flags)


def _changed(decision: Mapping[str, Any], index: Index) -> Iterator[str]:
    """What is not as it was when it was decided."""
    for change in decision.get("changed", ()):
        yield index.words(
            f"decision.changed.{change['what']}", before=printable(change["before"]), now=printable(change["now"])
        )


def _answers(decision: Mapping[str, Any], words: Words) -> list[tuple[str, str]]:
    """The legal questions that a person answered, with the answers."""
    answers = decision.get("answers", {}).items()
    return [(words.of_value(f"confirm.{code}", printable(code)), printable(text)) for code, text in answers]


def _step(step: Mapping[str, Any], index: Index) -> str:
    """One entry of a log: what, by whom, when, its hash, by which it is found there, and what was answered."""
    words, dash = index.words, "–"
    entry = words(
        "decision.step",
        when=printable(step["when"]),
        decision=words.of_value(f"decision.{step['decision']}", printable(step["decision"])),
        owner=printable(step["owner"]) or dash,
        account=printable(step["account"]),
        expires=words.date(step["expires"]) if step["expires"] else dash,
        reason=printable(step["reason"]) or dash,
        hash=step["hash"][:16],
    )
    return "; ".join([entry, *(f"{question} {answer}" for question, answer in _answers(step, words))])


def _value(value: Any, key: str, index: Index) -> str:
    words, text = index.words, printable(str(value))
    if key == "state":
        return words.of_value(f"decision.state.{value}", text)
    if key == "legal_basis":
        return "; ".join(words.basis(printable(str(part))) for part in value)
    return words.date(text) if key in DATES else text


def _flags(decision: Mapping[str, Any], findings: Iterable[Mapping[str, Any]], index: Index) -> Iterator[str]:
    """What an acceptance lacks: a legal basis, a ground for special categories, one of chapter V, an end."""
    for gap in gaps_of(decision, list(findings)):
        yield gap_in_words(gap, index)


def gap_in_words(gap: Gap, index: Index) -> str:
    """Return a sentence about what an acceptance lacks."""
    provision = index.provision(gap.category, gap.provision)
    return index.words(f"decision.gap.{gap.lack.name.lower()}", data=index.data(gap.category), provision=provision)


LINES = 4  # policy lines shown of one step
SHOWN_AT_MOST = 3  # robots of one form that are named beside their number


class EntryLine(NamedTuple):
    """A policy line, and whose it is."""

    place: str
    of: str


class Hop(NamedTuple):
    """An element of a path, and the step that leaves it.

    Attributes
    ----------
    notes
        What labels say of it; ``open`` whether nobody reviewed it.
    end
        ``source``, ``leak`` or empty.
    verb, lines, further_lines
        Of the step, empty at the end: what the policy allows, by which lines, and how many more there are.
    data
        What goes along the step, where it is not what went before.
    """

    name: str
    kind: str
    notes: tuple[str, ...]
    open: bool
    end: str
    verb: str = ""
    lines: tuple[EntryLine, ...] = ()
    further_lines: int = 0
    data: str = ""


class PathEntry(NamedTuple):
    """A path to assess: a finding, or findings that differ only in the robot.

    Attributes
    ----------
    id, anchor, number
        Of the first finding; ``alike`` are the ids of those that differ only in the robot.
    detailed
        Whether the page tells it by itself; else it has no hops and notes, and its anchor is that of its kind of data.
    kind, state, article9, category
        As in the contract; the state is ``open``, ``decided``, ``accepted`` or ``dismissed``.
    sentence
        What it says, in one sentence.
    robots
        That it is the same on, the first included; empty where there is one.
    spread
        On how many robots it is, in sentences; empty where there is one.
    where
        The same robots by how the finding stands there, in words, with their names: of those that are alike on a fleet
        the one that is shown.
    pattern
        On a fleet, the id of the pattern: what decisions name.
    same_way
        (number, anchor) of an entry before it that has the same hops; None if there is none.
    begins_as, begins
        (number, anchor) of the entry before it that has its first hops with their policy lines, and how many these
        are; None where they are too few to name another path for them.
    through
        Other recipients that every path leads through.
    notes
        What a person has to know or answer.
    mark
        ``new`` or ``changed`` since the earlier report; else empty.
    """

    id: str
    anchor: str
    number: int
    kind: str
    state: str
    category: str
    article9: str
    data: str
    source: str
    leak: str
    sentence: str
    pseudonymised: bool
    hops: tuple[Hop, ...]
    notes: tuple[str, ...]
    special: str
    alike: tuple[str, ...]
    robots: tuple[str, ...]
    paths: tuple[str, ...]
    decision: DecisionText | None
    mark: str = ""
    spread: tuple[str, ...] = ()
    pattern: str = ""
    detailed: bool = True
    where: tuple[tuple[str, tuple[str, ...]], ...] = ()
    same_way: tuple[int, str] | None = None
    begins_as: tuple[int, str] | None = None
    begins: int = 0

    @property
    def new_hops(self) -> tuple[Hop, ...]:
        """The hops that no entry before it has told."""
        return () if self.same_way else self.hops[self.begins :]

    @property
    def brief(self) -> str:
        """The path in one line, for those who do not see its picture."""
        return " → ".join(hop.name for hop in self.hops)


def finding_entries(index: Index, marks: Mapping[str, str] | None = None) -> tuple[PathEntry, ...]:
    """Return the entries.

    Parameters
    ----------
    marks
        Id of a finding -> ``new`` or ``changed``; such findings are put together only with their like.

    Complexity: O(hops of all findings).
    """
    marks = marks or {}
    decided = {finding["id"]: decision_of(finding, index) for finding in index.findings}

    def pattern(finding: Mapping[str, Any]) -> Any:
        return finding_pattern(finding), marks.get(finding["id"]), decided[finding["id"]]

    fleet = index.patterns  # there each finding is one of its pattern
    findings = in_order(index.findings, index.document)
    groups = [[finding] for finding in findings] if fleet else grouped(findings, pattern)
    numbers = Counter(group[0]["category"] for group in groups)
    left = dict.fromkeys(numbers, share(numbers.values()))
    entries = []
    for number, group in enumerate(groups, 1):
        left[group[0]["category"]] -= 1
        entries.append(_entry(number, group, index, decided, marks, detailed=left[group[0]["category"]] >= 0))
    return tuple(_ways_once(entries))


WORTH = 2  # hops that two paths begin with, so that the second names the first for them


def _ways_once(entries: Iterable[PathEntry]) -> Iterator[PathEntry]:
    """The entries; one that goes along the hops of one before, or begins so, says it."""
    first: dict[tuple[Hop, ...], tuple[int, str]] = {}
    begun: dict[tuple[Hop, ...], tuple[int, str]] = {}
    for entry in entries:
        at = entry.number, entry.anchor
        way = first.setdefault(entry.hops, at) if entry.hops else at
        if way != at:
            yield entry._replace(same_way=way)
            continue
        beginnings = [entry.hops[:number] for number in range(WORTH, len(entry.hops))]
        shared = [hops for hops in beginnings if hops in begun]
        yield entry._replace(begins_as=begun[shared[-1]], begins=len(shared[-1])) if shared else entry
        for hops in beginnings:
            begun.setdefault(hops, at)


def _entry(
    number: int,
    group: list[Mapping[str, Any]],
    index: Index,
    decided: Mapping[str, DecisionText | None],
    marks: Mapping[str, str],
    *,
    detailed: bool,
) -> PathEntry:
    finding = group[0]
    decision = decided[finding["id"]]
    stands = state(finding)
    robots = _robots(group, index)
    return PathEntry(
        id=finding["id"],
        anchor=anchor(finding["id"]) if detailed else kind_anchor(finding["category"]),
        detailed=detailed,
        number=number,
        kind=finding["kind"],
        state="decided" if decision and stands == "open" else stands,
        category=finding["category"],
        article9=finding["article9"],
        data=index.data(finding["category"], pseudonymised=finding["pseudonymised"]),
        source=name(finding["source"]),
        leak=name(finding["leak"]),
        sentence=sentence_of(finding, index),
        pseudonymised=finding["pseudonymised"],
        hops=tuple(hops_of(finding, index)) if detailed else (),
        notes=tuple(_notes(finding, index)) if detailed else (),
        special=_special(finding, index),
        alike=tuple(f["id"] for f in group[1:]),
        robots=robots,
        paths=tuple(" → ".join(map(name, path)) for path in finding.get("paths", ())),
        decision=decision,
        mark=marks.get(finding["id"], ""),
        spread=tuple(_spread(finding, robots, index)),
        pattern=index.patterns.get(finding["id"], {}).get("id", ""),
        where=tuple(_where(finding, robots, index)),
    )


def _robots(group: list[Mapping[str, Any]], index: Index) -> tuple[str, ...]:
    if index.alike:
        return tuple(map(fit, index.patterns[group[0]["id"]]["robots"]))
    return tuple(fit(finding["source"]["robot"]) for finding in group) if len(group) > 1 else ()


def _spread(finding: Mapping[str, Any], robots: tuple[str, ...], index: Index) -> Iterator[str]:
    """On which robots it is, a sentence for each form; robots that are few are named."""
    words, pattern = index.words, index.patterns.get(finding["id"])
    if not pattern:
        if robots:
            yield words("entry.robots", robots=words.count(len(robots), "robot"))
        return
    if not robots:
        yield words("entry.fleet.none")
        return
    yield words("entry.fleet", n=len(robots), all=words.count(len(index.robots()), "of_robots"))
    if pattern["across"]:
        yield words("entry.fleet.across", n=pattern["findings"])
    for some, form in _forms(pattern, index):
        names = f" ({words.row(map(fit, some))})" if len(some) <= SHOWN_AT_MOST else ""
        yield words.pair(f"{words.count(len(some), 'robot')}{names}", f"{form}.")


def _forms(pattern: Mapping[str, Any], index: Index) -> list[tuple[Sequence[str], str]]:
    words = index.words
    said = {
        "dismissed": (words("fleet.dismissed"), words("fleet.dismissed.not")),
        "accepted": (words("fleet.accepted"), words("fleet.accepted.not")),
        "pseudonymised": (words("fleet.hidden"), words("fleet.hidden.not")),
    }
    return forms_in_words(pattern.get("forms", ()), said)


def _where(finding: Mapping[str, Any], robots: tuple[str, ...], index: Index) -> Iterator[tuple[str, tuple[str, ...]]]:
    pattern = index.patterns.get(finding["id"])
    if not pattern:
        if robots:
            yield index.words("column.robots"), robots
        return
    for some, form in _forms(pattern, index) or [(pattern["robots"], "")]:
        said = index.words.count(len(some), "robot")
        if some:
            yield f"{said}, {form}" if form else said, tuple(_standing(some, index))


def _standing(robots: Sequence[str], index: Index) -> Iterator[str]:
    """Robots, each with how many are like it: their names are in the table of the fleet."""
    left = dict.fromkeys(robots)
    for shown, alike in index.alike.items():
        if shown in left and left.keys() >= set(alike):
            more = f" ({index.words.count(len(alike), 'robot')})" if len(alike) > 1 else ""
            yield f"{fit(shown)}{more}"
            for robot in alike:
                del left[robot]
    yield from map(fit, left)


def sentence_of(finding: Mapping[str, Any], index: Index) -> str:
    """Return what a finding says, in one sentence."""
    data = index.data(finding["category"], pseudonymised=finding["pseudonymised"])
    ends = {"source": name(finding["source"]), "leak": name(finding["leak"])}
    alone = finding["kind"] == "disclosure" and len(finding["witness"]) == 1
    of, makers = made_of(finding)
    if makers:
        made = {"of": index.data(of), "makers": index.words.row(map(name, makers))}
        said = index.words(f"entry.made.{finding['kind']}", data=data, **made, **ends)
    else:
        said = index.words("entry.single" if alone else f"entry.{finding['kind']}", data=data, **ends)
    return said[:1].upper() + said[1:]


def _notes(finding: Mapping[str, Any], index: Index) -> Iterator[str]:
    words = index.words
    if reason := finding_reason(finding, words, index.data):
        yield words("entry.because", reason=reason)
    yield from revealed(finding, index)
    if "gdpr" in finding:
        yield words(f"entry.gdpr.{finding['gdpr']}")
    if finding["dismissed"]:
        yield words("entry.dismissed", names=words.row(map(name, finding["through"])))
    if finding.get("beside_pseudonymised"):
        yield words("entry.beside")
    if finding["pseudonymised"]:
        yield words("entry.pseudonymised")
    if (finding["disjoint_paths"] or 1) > 1:
        yield words("entry.ways", n=finding["disjoint_paths"])
    if finding.get("paths_bounded"):
        yield words("entry.bounded", n=len(finding["paths"]))


def _special(finding: Mapping[str, Any], index: Index) -> str:
    turned = finding["special_from"]
    return index.words("entry.special", element=name(turned)) if turned else ""


def hops_of(finding: Mapping[str, Any], index: Index) -> Iterator[Hop]:
    """Return the witness: each element with what labels say of the data that is there, and the step that leaves it."""
    witness, steps = finding["witness"], finding["steps"]
    data = [(step["category"], step["pseudonymised"]) for step in steps]
    for number, element in enumerate(witness):
        last = number == len(steps)
        here = [category for category, _ in data[max(number - 1, 0) : number or 1]]
        here = list(dict.fromkeys([*here, *([finding["category"]] if last else [])]))
        alone = {finding["category"], *(category for category, _ in data)} == {finding["category"]}
        notes, is_open = _label_texts(element, here, index, alone=alone)
        end = "leak" if last else "source" if number == 0 else ""
        if last:
            yield Hop(name(element), index.words.kind(element), notes, is_open, end)
            continue
        changed = data[number] != data[number - 1] if number else not _brings_in(element, *data[0], index)
        label = index.data(data[number][0], pseudonymised=data[number][1]) if changed else ""
        lines = tuple(_lines(steps[number], index))
        verb = index.words(f"verb.{steps[number]['role']}")
        yield Hop(
            name(element),
            index.words.kind(element),
            notes,
            is_open,
            end,
            verb,
            *first_of(lines, LINES),
            label,
        )


def _brings_in(element: Mapping[str, Any], category: str, pseudonymised: bool, index: Index) -> bool:  # noqa: FBT001
    """Whether labels say of the element that it is a source of just these data."""
    return not pseudonymised and "source" in index.roles.get((key(element), category), ())


SHORT = ("source", "conduit", "leak")  # roles that need no kind of data where a path has one


def _label_texts(
    element: Mapping[str, Any], categories: Collection[str], index: Index, *, alone: bool
) -> tuple[tuple[str, ...], bool]:
    """What labels say of an element, and whether it is open; where a path has one kind, that is not named again."""
    notes = [
        index.words(f"role.{role}.it" if alone and role in SHORT else f"role.{role}", data=index.data(category))
        for category in categories
        for role in index.roles.get((key(element), category), ())
    ]
    return tuple(notes), any((key(element), category) in index.unreviewed for category in categories)


def _lines(step: Mapping[str, Any], index: Index) -> Iterator[EntryLine]:
    for grant in step["policy"]:
        of = index.words("policy.of", enclave=fit(grant["enclave"]), profile=fit(grant["profile"]))
        yield EntryLine(line(grant), of if grant["enclave"] or grant["profile"] else "")


BOUND = 2_000  # paths that one page tells one by one, some 8 MB


def share(numbers: Iterable[int], bound: int = BOUND) -> int:
    """Return how many of each kind are told at most, so that the page tells ``bound``: what a kind lacks, others get.

    >>> share([5, 400, 3000], 1000), share([5, 400], 1000)
    (595, 400)
    """
    counts = sorted(numbers)
    for position, number in enumerate(counts):
        each = bound // (len(counts) - position)
        if number > each:
            return max(each, 1)
        bound -= number
    return counts[-1] if counts else 0
