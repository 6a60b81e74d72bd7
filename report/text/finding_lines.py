"""Findings as lines: a list, the details hop by hop, what was decided, what the enforced view adds, and the law once.

In: a JSON document of the contract. Out: lines. What a person decides first stands first.
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import CHANNELS, UNPROTECTED
from rosprivacy.analysis.text import blanked
from rosprivacy.report.catalogs.words import IN_ENGLISH, Words, finding_reason, spaced
from rosprivacy.report.finding_facts import data_made, in_order, looked_at
from rosprivacy.report.naming import key, kind_in, names_shown, shown_name
from rosprivacy.report.text.fleet import on_robots, robots_of
from rosprivacy.report.text.line_parts import place

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.report.text.line_parts import Line

MANY = 5  # findings; of more a list of one line each comes first
SHOWN_AT_MOST = 4  # kinds of data in one line
NARROWER = "⊇ "  # how the ontology writes, in other languages than English: if the data are of one of these kinds
VERBS = {  # (role, whether data goes into a channel) -> what is between the two
    ("publish", True): "publish",
    ("subscribe", False): "subscribe",
    ("request", True): "ask",
    ("request", False): "answer",
    ("reply", False): "ask",
    ("reply", True): "answer",
    ("call", True): "goal",
    ("call", False): "report",
    ("execute", False): "goal",
    ("execute", True): "report",
}


def verb(role: str, *, into_channel: bool, words: Words) -> str:
    """Return what is between two elements, as a flow's role says it; the role itself if it has no word."""
    return words.of_value(f"terminal.verb.{VERBS.get((role, into_channel), role)}", role)


def overview(report: Mapping[str, Any], words: Words) -> Iterator[Line]:
    """Return one line for each finding where there are many, and for those that one line of a governance is behind."""
    if len(report["findings"]) <= MANY:
        return
    unreviewed = {element for element, _ in _unreviewed(report, report["findings"])}
    yield "", ""
    yield words("terminal.findings", n=str(len(report["findings"]))), "bold"
    ordered = in_order(report["findings"], report)
    numbers = {finding["id"]: number for number, finding in enumerate(ordered, 1)}
    for finding, *others in _by_line(ordered):
        number = numbers[finding["id"]]
        if others:
            yield f"{number:>3}. {_group_line([finding, *others], _reason(finding, words), words)}", _style(finding)
            continue
        met = {key(e) for e in finding["witness"]} & unreviewed
        parts = [
            words.count(len(finding["steps"]), "terminal.hop"),
            *([words("terminal.number.unreviewed", n=len(met))] if met else []),
            *on_robots(report, finding, words),
            *_states(finding, words),
        ]
        title = _title(report, finding, words)
        yield f"{number:>3}. {title}, {', '.join(parts)}   [{finding['id']}]", _style(finding)


def details(
    report: Mapping[str, Any],
    findings: Sequence[Mapping[str, Any]],
    words: Words = IN_ENGLISH,
    detail_lines: Callable[[Mapping[str, Any]], Iterable[Line]] = lambda _: (),
) -> Iterator[Line]:
    """Return the findings hop by hop.

    Parameters
    ----------
    detail_lines
        What is told below each.
    """
    roles = {(key(said["element"]), said["category"]): said["roles"] for said in report["roles"]}
    unreviewed, folder = _unreviewed(report, findings), _policies_in(report)
    if folder and any(finding["steps"] for finding in findings):
        yield words("terminal.folder", folder=shown(folder)), "dim"
    for number, finding in enumerate(in_order(findings, report), 1):
        yield "", ""
        yield f"{number}. {_title(report, finding, words)}   [{finding['id']}]", _style(finding)
        yield from robots_of(report, finding, words)
        if "reason" in finding:
            yield f"   {_reason(finding, words)}", ""
        if finding["dismissed"]:
            through = ", ".join(shown_name(element) for element in finding["through"])
            past = words("terminal.past") if finding.get("beside_pseudonymised") else ""
            yield f"   {words('terminal.through', names=through, past=past)}", "dim"
        yield from _decision(finding, words)
        yield from _Way(roles, unreviewed, folder, words).lines(finding)
        yield from _paths(finding, words)
        if finding["special_from"]:
            yield f"   {words('terminal.special', element=shown_name(finding['special_from']))}", ""
        yield from detail_lines(finding)


def _reason(finding: Mapping[str, Any], words: Words) -> str:
    """Why it is one: in English with durations as they are stated."""
    return shown(finding["reason"]) if words.language == "en" else finding_reason(finding, words, str)


def enforced_lines(report: Mapping[str, Any], words: Words) -> Iterator[Line]:
    """Yield what remains if nodes do not keep to their profiles; nothing where nobody asked."""
    if "enforced" not in report:
        return
    added = report["enforced"]["added"]
    yield "", ""
    yield words("terminal.enforced", findings=words.count(len(added), "terminal.finding")), "bold"
    if elements := [shown_name(element) for element in report["enforced"].get("open", ())]:
        yield words.count(len(elements), "terminal.enforced.unreviewed", names=names_shown(elements, words)), ""
    by_id = {entry["finding"]["id"]: entry for entry in added}

    def additional(finding: Mapping[str, Any]) -> Iterator[Line]:
        yield from ((f"   {text}", "") for text in _added(report, by_id[finding["id"]], words))

    yield from details(report, [entry["finding"] for entry in added], words, additional)


def _added(report: Mapping[str, Any], entry: Mapping[str, Any], words: Words) -> Iterator[str]:
    """Where it is, what makes it possible, what takes it away: splitting first."""
    if entry.get("plain"):
        yield words("terminal.enforced.plain")
    if entry.get("beyond") == []:
        yield words("terminal.enforced.types")
    if robots := entry.get("robots"):
        everybody = words.count(report["fleet"]["robots"], "of_robots")
        yield words("terminal.enforced.on", n=str(len(robots)), robots=everybody, names=names_shown(robots, words))
    if opened := entry.get("opened_by"):
        yield words("terminal.enforced.opened", lines=", ".join(map(place, opened)))
    if not entry["enclaves"]:
        return
    yield words("terminal.enforced.by", enclaves=_listed(entry["enclaves"]))
    key = "terminal.enforced.split" if entry["split"] else "terminal.enforced.no.split"
    yield words(key, enclaves=_listed(entry["split"]))
    if move := entry.get("move"):
        yield words("terminal.enforced.move", profile=shown(move["profile"]), enclave=shown(move["enclave"]))
    if entry.get("deny"):
        yield words("terminal.enforced.deny", lines="; ".join(_deny(line, words) for line in entry["deny"]))
        lost = [f"{shown_name(of['node'])} {of['role']} {shown_name(of['channel'])}" for of in entry["loses"]]
        if lost:
            yield words("terminal.enforced.loses", rights="; ".join(lost))


def _deny(line: Mapping[str, Any], words: Words) -> str:
    values = {what: shown(line[what]) for what in ("role", "enclave", "file")}
    return words("terminal.enforced.line", channel=shown_name(line["channel"]), **values)


def _listed(enclaves: list[str]) -> str:
    return ", ".join(map(shown, enclaves))


def law_lines(
    report: Mapping[str, Any], findings: Iterable[Mapping[str, Any]], words: Words = IN_ENGLISH
) -> Iterator[Line]:
    """Return what a person has to look up about each kind of data that arrives somewhere, once for each kind."""
    ordered = in_order(findings, report)
    by_kind = {finding["category"]: finding for finding in ordered}
    findings_of = {kind: [finding for finding in ordered if finding["category"] == kind] for kind in by_kind}
    if not by_kind:
        return
    kinds = {category["name"]: category for category in report["categories"]}
    yield "", ""
    yield words("terminal.law.title"), "bold"
    for category, finding in by_kind.items():
        for legal in _law(finding, kinds, words):
            yield f"   {words('terminal.law.line', kind=category, **legal)}", "magenta"
        yield from _in_contexts(kinds.get(category, {}), findings_of[category], words)
        yield from _pointers(report, category, words)
        if finding["article9"] == "unknown":
            yield f"   {words('terminal.law.unknown', kind=category)}", "yellow"
        if finding["article9"] == "no":
            reason = _text(kinds[category], "reason", words) if category in kinds else ""
            yield f"   {words('terminal.law.no', kind=category, reason=reason)}", "dim"
    yield from _of_contexts(report, words)


def _law(finding: Mapping[str, Any], kinds: Mapping[str, Mapping[str, Any]], words: Words) -> Iterator[dict[str, str]]:
    """The provisions of a finding, with the texts that the ontology has of them."""
    stated = kinds.get(finding["category"], {}).get("law", ())
    for legal in finding["law"]:
        alike = (
            other for other in stated if all(other[key] == legal[key] for key in ("provision", "verdict", "condition"))
        )
        texts = next(alike, {**legal, "translations": {}})
        condition = _text(texts, "condition", words).removeprefix(NARROWER)
        yield {
            "provision": _text(texts, "provision", words),
            "may": words(f"terminal.may.{legal['verdict']}"),
            "condition": words("terminal.law.condition", condition=condition) if condition else "",
        }


def _text(of: Mapping[str, Any], field: str, words: Words, fit: Callable[[str], str] = str) -> str:
    """A text of the ontology in the reader's language, in English if there is no translation."""
    text = of.get("translations", {}).get(words.language, {}).get(field) or of[field]
    return spaced(fit(blanked(text)), words.language)


def _policies_in(report: Mapping[str, Any]) -> str:
    """The folder that all policies are in, empty if there is none that says anything."""
    files = [entry["file"] for entry in report["assumptions"].get("policies", ())]
    try:
        return os.path.commonpath([os.path.dirname(file) for file in files]) if files else ""  # noqa: PTH120 - text only
    except ValueError:  # some from the root, some not
        return ""


def _title(report: Mapping[str, Any], finding: Mapping[str, Any], words: Words) -> str:
    data = _data(finding["category"], words, pseudonymised=finding["pseudonymised"])
    asked = _may_be_asked(report, finding["category"], words)
    made = data_made(finding, f"{data}{asked}", words, str, shown_name)
    what = words(f"terminal.kind.{finding['kind']}", data=made)
    return words.pair(what, f"{shown_name(finding['source'])} -> {shown_name(finding['leak'])}")


def _data(category: str, words: Words, *, pseudonymised: bool) -> str:
    return words("terminal.hidden", kind=category) if pseudonymised else category


def _states(finding: Mapping[str, Any], words: Words) -> list[str]:
    return [words(f"terminal.state.{state}") for state in ("accepted", "dismissed") if finding[state]]


def _style(finding: Mapping[str, Any]) -> str:
    return "dim" if finding["dismissed"] or finding["accepted"] else "bold"


def _unreviewed(report: Mapping[str, Any], findings: Iterable[Mapping[str, Any]]) -> set[Any]:
    """(element, category) on the witnesses of some findings that nobody has reviewed."""
    on_paths = {key(element) for finding in findings for element in finding["witness"]}
    open_here = ((key(question["element"]), question) for question in report["open"])
    return {
        (element, name) for element, question in open_here if element in on_paths for name in question["categories"]
    }


class _Way(NamedTuple):
    """How a witness is told, hop by hop.

    Attributes
    ----------
    roles
        (element, category) -> what labels say.
    unreviewed
        (element, category) that nobody has reviewed.
    folder
        Of all policies.
    """

    roles: Mapping[Any, Any]
    unreviewed: Collection[Any]
    folder: str
    words: Words

    def lines(self, finding: Mapping[str, Any]) -> Iterator[Line]:
        """Return the witness: element, what labels say of it, policy line."""
        witness, steps, words = finding["witness"], finding["steps"], self.words
        data = [step["category"] for step in steps]
        for hop, element in enumerate(witness):
            # what is there: the data that arrives, at the source the data that leaves, at the leak what gets out too
            last = [] if hop < len(steps) else [finding["category"]]
            here = dict.fromkeys([*data[max(hop - 1, 0) : hop or 1], *last])
            roles_of = [(name, role) for name in here for role in self.roles.get((key(element), name), ())]
            notes = [
                f"{words(f'terminal.role.{role}', kind=name)}{self._of_another(finding, hop, role, name)}"
                for name, role in roles_of
            ]
            notes += [words("unreviewed") for name in here if (key(element), name) in self.unreviewed]
            style = "red" if any(role == "leak" for _, role in roles_of) else ""
            yield f"   {shown_name(element)}  ({', '.join([kind_in(element, words), *notes])})", style
            if hop < len(steps):
                before = steps[hop - 1] if hop else steps[hop]
                yield f"     | {self._step(steps[hop], before, witness[hop + 1])}", "dim"

    def _of_another(self, finding: Mapping[str, Any], hop: int, role: str, name: str) -> str:
        """Why a leak on the path does not dismiss a finding: it lets out what this one is not about (rule S10)."""
        between = role == "leak" and hop < len(finding["steps"]) and name != finding["category"]
        return self.words("terminal.another") if between else ""

    def _step(self, step: Mapping[str, Any], before: Mapping[str, Any], to: Mapping[str, Any]) -> str:
        """One hop: what the policy allows, where, and what the data has become."""
        words = self.words
        places = [f"{shown(_within(self.folder, grant['file']))}:{grant['line']}" for grant in step["policy"]]
        more = words("terminal.more", n=len(places) - 1) if len(places) > 1 else ""
        text = verb(step["role"], into_channel=to["kind"] in CHANNELS, words=words)
        what = f"{text}  {places[0]}{more}" if places else text
        if (step["category"], step["pseudonymised"]) == (before["category"], before["pseudonymised"]):
            return what
        return what + words("terminal.now", data=_data(step["category"], words, pseudonymised=step["pseudonymised"]))


def _within(folder: str, file: str) -> str:
    """A file's name as seen from a folder; as it is where it lies elsewhere."""
    inside = file.removeprefix(folder.rstrip("/") + "/") if folder else file
    return inside or file


def _paths(finding: Mapping[str, Any], words: Words) -> Iterator[Line]:
    if (finding["disjoint_paths"] or 1) > 1:
        yield f"   {words('terminal.disjoint', n=finding['disjoint_paths'])}", ""
    for path in finding.get("paths", ()):
        yield f"   {words('terminal.path', path=' -> '.join(shown_name(element) for element in path))}", ""
    if finding.get("paths_bounded"):
        yield f"   {words('terminal.bounded', n=len(finding['paths']))}", "yellow"


def _may_be_asked(report: Mapping[str, Any], category: str, words: Words) -> str:
    """Which of the kinds asked for data of another may be, with a space before; empty for what is asked for."""
    kinds = report["assumptions"].get("may_be_asked", {}).get(category)
    return words("terminal.may.be", kinds=names_shown(kinds, words)) if kinds else ""


def _by_line(findings: Iterable[Mapping[str, Any]]) -> list[list[Mapping[str, Any]]]:
    """Findings in their order; those of channels that one line of a governance leaves unprotected are together."""
    groups: dict[Any, list[Mapping[str, Any]]] = {}
    for finding in findings:
        stands = finding["kind"] == UNPROTECTED and not finding["accepted"]
        groups.setdefault(finding["reason"] if stands else finding["id"], []).append(finding)
    return list(groups.values())


def _group_line(group: Sequence[Mapping[str, Any]], reason: str, words: Words) -> str:
    """What findings have in common that one line stands behind, for one reason."""
    kinds = words.row(words.first(list(dict.fromkeys(finding["category"] for finding in group)), SHOWN_AT_MOST))
    channels = {key(finding["leak"]) for finding in group}
    counts = [words.count(len(group), "terminal.finding"), words.count(len(channels), "terminal.channel")]
    return f"{words(f'terminal.kind.{UNPROTECTED}', data=kinds)}, {', '.join(counts)}; {reason}"


def _decision(finding: Mapping[str, Any], words: Words) -> Iterator[Line]:
    """What was decided about a finding."""
    decision = finding.get("decision")
    if not decision:
        return
    from rosprivacy.analysis.decisions import Choice, State  # noqa: PLC0415 - light start

    choice, at = words(f"terminal.done.{decision['choice']}"), place(decision)
    expires = words.date(decision["expires"]) if decision["expires"] else ""
    if decision["state"] == State.EXPIRED:
        yield f"   {words('terminal.undecided', choice=choice, date=expires, place=at)}", "yellow"
        return
    owner = words("terminal.owner", owner=shown(decision["owner"])) if decision["owner"] else ""
    until = words("terminal.until", date=expires) if expires else ""
    basis = f", {', '.join(map(words.basis, decision['legal_basis']))}" if decision["legal_basis"] else ""
    style = "green" if decision["choice"] == Choice.ACCEPT else "yellow"
    yield f"   {choice}{owner}{until}{basis}  ({at})", style
    if decision["reason"]:
        yield f"      {shown(decision['reason'])}", style
    for change in decision.get("changed", ()):
        what = words.of_value(f"terminal.changed.{change['what']}", change["what"].replace("_", " "))
        before, now = shown(change["before"]), shown(change["now"])
        yield f"      {words('terminal.changed', what=what, before=before, now=now)}", "yellow"


def _in_contexts(kind: Mapping[str, Any], findings: Iterable[Mapping[str, Any]], words: Words) -> Iterator[Line]:
    """What data of a kind may reveal, once for each context and provision, with the sources there."""
    of_source: dict[tuple[str, str, str], dict[str, None]] = {}
    for finding in findings:
        for legal in finding.get("in_context", ()):
            at = legal["context"], legal["provision"], legal["condition"]
            of_source.setdefault(at, {})[shown_name(finding["source"])] = None
    for row in kind.get("in_context", ()):
        sources = of_source.get((row["context"], row["provision"], row["condition"]), {})
        if sources:
            texts = {what: _text(row, what, words, shown) for what in ("provision", "condition")}
            who = {"kind": kind["name"], "sources": ", ".join(sources), "context": row["context"]}
            sentence = f"terminal.law.context.{row['verdict']}"
            yield f"   {words(sentence, **who, **texts)}", "magenta"


def _pointers(report: Mapping[str, Any], category: str, words: Words) -> Iterator[Line]:
    """The provisions that a kind of data points at, in one line."""
    rows = [row for row in looked_at(report) if category in row["categories"]]
    if rows:
        yield f"   {words('terminal.law.look', kind=category, names=_names(rows, words))}", "dim"


def _of_contexts(report: Mapping[str, Any], words: Words) -> Iterator[Line]:
    """The provisions that each context of the system points at; those of every system are in the report."""
    for context in report.get("contexts", ()):
        rows = [row for row in looked_at(report) if context["name"] in row["contexts"]]
        if rows:
            yield f"   {words('terminal.law.look.context', context=context['name'], names=_names(rows, words))}", "dim"


def _names(rows: Iterable[Mapping[str, Any]], words: Words) -> str:
    return ", ".join(_text(row, "provision", words, shown) for row in rows)
