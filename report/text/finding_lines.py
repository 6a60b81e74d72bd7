"""Findings as lines, by the places where data gets out: a list, the details hop by hop, what the enforced view adds.

In: a JSON document of the contract. Out: lines. What a person decides first stands first: a place has the rank of the
worst that gets there. Places are numbered, findings have ids.
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import CHANNELS, UNPROTECTED
from rosprivacy.report.catalogs.words import IN_ENGLISH, Words, finding_reason
from rosprivacy.report.finding_facts import data_made, grouped, in_order, made_of
from rosprivacy.report.naming import all_kinds, joined_by_and, key, kind_in, names_shown, shown_name, without_leg
from rosprivacy.report.text.fleet import on_robots, robots_of
from rosprivacy.report.text.line_parts import place

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.report.text.line_parts import Line

MANY = 5  # findings; of more a list of one line each comes first
SHOWN_AT_MOST = 4  # kinds of data in one line
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
    """Return a line or two for each finding where there are many, by the places where data gets out.

    Those that one line of a governance is behind are a single line: their ids are among the details.
    """
    if len(report["findings"]) <= MANY:
        return
    unreviewed = {element for element, _ in _unreviewed(report, report["findings"])}

    def remarks(finding: Mapping[str, Any]) -> tuple[str, ...]:
        met = {key(e) for e in finding["witness"]} & unreviewed
        return (
            words.count(len(finding["steps"]), "terminal.hop"),
            *([words("terminal.number.unreviewed", n=len(met))] if met else []),
            *on_robots(report, finding, words),
            *_states(finding, words),
        )

    exits = _exits(report["findings"], report)
    yield "", ""
    ways_out = words.count(len(exits), "exit")
    yield words("terminal.findings", n=str(len(report["findings"])), exits=ways_out), "bold"
    kinds = _plain_kinds(report["findings"])
    for number, exit_ in enumerate(exits, 1):
        numbered = f"{number:>3}. "
        titles = grouped(exit_, lambda finding: (_route(finding), _content(finding), remarks(finding)))
        if len(titles) == 1:
            place = shown_name(exit_[0]["leak"])
            title = words.pair(place, _title(report, titles[0], words, remarks(exit_[0])))
            yield f"{numbered}{title}", _style(exit_[0])
            continue
        yield f"{numbered}{_heading(exit_, kinds, words)}", _style(exit_[0])
        if not _behind_one_line(exit_[0]):
            for alike in titles:
                title = _title(report, alike, words, remarks(alike[0]))
                yield f"{' ' * len(numbered)}{title}", "dim" if _is_settled(alike[0]) else ""


def details(
    report: Mapping[str, Any],
    findings: Sequence[Mapping[str, Any]],
    words: Words = IN_ENGLISH,
    detail_lines: Callable[[Mapping[str, Any]], Iterable[Line]] = lambda _: (),
) -> Iterator[Line]:
    """Return the findings hop by hop, by the places where data gets out; a path that several have stands once.

    Parameters
    ----------
    detail_lines
        What is told below each.
    """
    roles = {(key(said["element"]), said["category"]): said["roles"] for said in report["roles"]}
    unreviewed, folder = _unreviewed(report, findings), _policies_in(report)
    way, kinds = _Way(roles, unreviewed, folder, words), _plain_kinds(findings)

    def before(finding: Mapping[str, Any]) -> tuple[Line, ...]:
        return tuple(_remarks(report, finding, words))

    def after(finding: Mapping[str, Any]) -> tuple[Line, ...]:
        return (*_paths(finding, words), *detail_lines(finding))

    if folder and any(finding["steps"] for finding in findings):
        yield words("terminal.folder", folder=shown(folder)), "dim"
    for number, exit_ in enumerate(_exits(findings, report), 1):
        routes = [
            grouped(route, lambda finding: (_content(finding), before(finding), after(finding)))
            for route in grouped(exit_, _route)
        ]
        alone = len(routes) == len(routes[0]) == 1
        yield "", ""
        if not alone:
            yield f"{number}. {_heading(exit_, kinds, words)}", _style(exit_[0])
        for route in routes:
            if not alone:
                yield "", ""
            same = len({after(titled[0]) for titled in route}) == 1
            for titled in route:
                first = titled[0]
                title, place = _title(report, titled, words), shown_name(first["leak"])
                placed = words.pair(place, title) if alone or _behind_one_line(first) else title
                yield f"{f'{number}.' if alone else '  '} {placed}", _style(first)
                yield from before(first)
                yield from () if same else after(first)
            yield from way.lines([finding for titled in route for finding in titled])
            yield from after(route[0][0]) if same else ()


def _exits(findings: Iterable[Mapping[str, Any]], report: Mapping[str, Any]) -> list[list[Mapping[str, Any]]]:
    """Findings of one place where data gets out together, and those that one line of a governance is behind."""

    def place_of(finding: Mapping[str, Any]) -> Any:
        return finding["reason"] if _behind_one_line(finding) else without_leg(finding["leak"])

    return grouped(in_order(findings, report), place_of)


def _behind_one_line(finding: Mapping[str, Any]) -> bool:
    """Whether it is about a channel that a governance leaves unprotected, perhaps with others."""
    return finding["kind"] == UNPROTECTED and not finding["accepted"]


def _route(finding: Mapping[str, Any]) -> Any:
    """Where it goes along, and what allows each step."""
    lines = [[(grant["file"], grant["line"]) for grant in step["policy"]] for step in finding["steps"]]
    return tuple(map(key, finding["witness"])), repr([step["role"] for step in finding["steps"]]), repr(lines)


def _content(finding: Mapping[str, Any]) -> Any:
    """What findings of one route have in common that one title names: all but the kind of data."""
    of, makers = made_of(finding)
    return finding["kind"], finding["pseudonymised"], of if makers else "", tuple(map(key, makers))


def _plain_kinds(findings: Iterable[Mapping[str, Any]]) -> dict[str, None]:
    """The kinds of data that somebody has to decide about, other than pseudonymised, in their order."""
    return {f["category"]: None for f in findings if not (_is_settled(f) or f["pseudonymised"])}


def _heading(exit_: Sequence[Mapping[str, Any]], everywhere: Collection[str], words: Words) -> str:
    """A place and what gets there; of those behind one line of a governance, how many there are, and the line."""
    first = exit_[0]
    if _behind_one_line(first):
        return _group_line(exit_, _reason(first, words), words)
    waiting = [finding for finding in exit_ if not _is_settled(finding)] or exit_
    if not (data := all_kinds(_plain_kinds(waiting), everywhere, words)):
        kinds = dict.fromkeys(_data(f["category"], words, pseudonymised=f["pseudonymised"]) for f in waiting)
        data = words.row(words.first(list(kinds), SHOWN_AT_MOST))
    return words.pair(shown_name(first["leak"]), data)


def _remarks(report: Mapping[str, Any], finding: Mapping[str, Any], words: Words) -> Iterator[Line]:
    """What stands below the title: on which robots it is, why it is one, and what was decided."""
    yield from robots_of(report, finding, words)
    if "reason" in finding:
        yield f"   {_reason(finding, words)}", ""
    if finding["dismissed"]:
        through = ", ".join(shown_name(element) for element in finding["through"])
        past = words("terminal.past") if finding.get("beside_pseudonymised") else ""
        yield f"   {words('terminal.through', names=through, past=past)}", "dim"
    yield from _decision(finding, words)


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


def _policies_in(report: Mapping[str, Any]) -> str:
    """The folder that all policies are in, empty if there is none that says anything."""
    files = [entry["file"] for entry in report["assumptions"].get("policies", ())]
    try:
        return os.path.commonpath([os.path.dirname(file) for file in files]) if files else ""  # noqa: PTH120 - text only
    except ValueError:  # some from the root, some not
        return ""


def _title(
    report: Mapping[str, Any], alike: Sequence[Mapping[str, Any]], words: Words, remarks: Sequence[str] = ()
) -> str:
    """What findings are about that differ only in the kind of data, with the id of each."""
    first = alike[0]
    data = []
    for finding in alike:
        kind = _data(finding["category"], words, pseudonymised=finding["pseudonymised"])
        id_ = f" [{finding['id']}]" if len(alike) > 1 else ""
        data.append(f"{kind}{_may_be_asked(report, finding['category'], words)}{id_}")
    made = data_made(first, words.row(data), words, str, shown_name)
    what = words(f"terminal.kind.{first['kind']}", data=made)
    scope = [words(f"terminal.state.gdpr.{first['gdpr']}")] if "gdpr" in first else []  # one source, so one for all
    title = words.row([words("terminal.from", data=what, source=shown_name(first["source"])), *scope, *remarks])
    return title if len(alike) > 1 else f"{title}   [{first['id']}]"


def _data(category: str, words: Words, *, pseudonymised: bool) -> str:
    return words("terminal.hidden", kind=category) if pseudonymised else category


def _states(finding: Mapping[str, Any], words: Words) -> list[str]:
    return [words(f"terminal.state.{state}") for state in ("accepted", "dismissed") if finding[state]]


def _style(finding: Mapping[str, Any]) -> str:
    return "dim" if _is_settled(finding) else "bold"


def _is_settled(finding: Mapping[str, Any]) -> bool:
    return bool(finding["dismissed"] or finding["accepted"])


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

    def lines(self, findings: Sequence[Mapping[str, Any]]) -> Iterator[Line]:
        """Return the witness of findings that have the same: element, what labels say of it, policy line."""
        witness, words = findings[0]["witness"], self.words
        last = len(witness) - 1
        for hop, element in enumerate(witness):
            here = dict.fromkeys(name for finding in findings for name in _kinds_at(finding, hop))
            notes = list(self._notes(findings, hop, here))
            style = "red" if any("leak" in self.roles.get((key(element), name), ()) for name in here) else ""
            yield f"   {shown_name(element)}  ({', '.join([kind_in(element, words), *notes])})", style
            if hop < last:
                yield f"     | {self._step(findings, hop, witness[hop + 1])}", "dim"

    def _notes(self, findings: Sequence[Mapping[str, Any]], hop: int, present: Collection[str]) -> Iterator[str]:
        """What labels say of an element, for each kind of data that is there."""
        words, at = self.words, key(findings[0]["witness"][hop])
        kinds: dict[tuple[str, str], list[str]] = {}
        for name in present:
            for role in self.roles.get((at, name), ()):
                kinds.setdefault((role, self._of_another(findings, hop, role, name)), []).append(name)
        for (role, another), names in kinds.items():
            data = all_kinds(names, present, words) or _joined(names, words)
            yield f"{words(f'terminal.role.{role}', kind=data)}{another}"
        if unreviewed := [name for name in present if (at, name) in self.unreviewed]:
            whole = len(unreviewed) == len(present)
            yield words("unreviewed") if whole else words("terminal.unreviewed.of", kinds=_joined(unreviewed, words))

    def _of_another(self, findings: Sequence[Mapping[str, Any]], hop: int, role: str, name: str) -> str:
        """Why a leak on the path does not dismiss a finding: it lets out what this one is not about (rule S10)."""
        between = role == "leak" and hop < len(findings[0]["steps"])
        another = between and all(name != finding["category"] for finding in findings)
        return self.words("terminal.another") if another else ""

    def _step(self, findings: Sequence[Mapping[str, Any]], hop: int, to: Mapping[str, Any]) -> str:
        """One hop: what the policy allows, where, and what the data has become."""
        words, step = self.words, findings[0]["steps"][hop]
        places = [
            f"{shown(_within(self.folder, grant['file']))}:{grant['line']}"
            + (f" ({grant['basis']})" if "basis" in grant else "")
            for grant in step["policy"]
        ]
        more = words("terminal.more", n=len(places) - 1) if len(places) > 1 else ""
        text = verb(step["role"], into_channel=to["kind"] in CHANNELS, words=words)
        what = f"{text}  {places[0]}{more}" if places else text
        data = [_data_at(finding, hop, words) for finding in findings]
        if data == [_data_at(finding, max(hop - 1, 0), words) for finding in findings]:
            return what
        return what + words("terminal.now", data=_joined(list(dict.fromkeys(data)), words))


def _kinds_at(finding: Mapping[str, Any], hop: int) -> Iterator[str]:
    """What is there: the data that arrives, at the source the data that leaves, at the leak what gets out too."""
    data = [step["category"] for step in finding["steps"]]
    yield from data[max(hop - 1, 0) : hop or 1]
    if hop == len(data):
        yield finding["category"]


def _data_at(finding: Mapping[str, Any], hop: int, words: Words) -> str:
    step = finding["steps"][hop]
    return _data(step["category"], words, pseudonymised=step["pseudonymised"])


def _joined(names: Sequence[str], words: Words) -> str:
    return joined_by_and([words.row(names[:-1]), names[-1]] if len(names) > 1 else names, words)


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
    if finding["special_from"]:
        yield f"   {words('terminal.special', element=shown_name(finding['special_from']))}", ""


def _may_be_asked(report: Mapping[str, Any], category: str, words: Words) -> str:
    """Which of the kinds asked for data of another may be, with a space before; empty for what is asked for."""
    kinds = report["assumptions"].get("may_be_asked", {}).get(category)
    return words("terminal.may.be", kinds=names_shown(kinds, words)) if kinds else ""


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

    choice, at = words(f"decision.{decision['choice']}"), place(decision)
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
    for code, answer in decision.get("answers", {}).items():
        yield f"      {shown(words.of_value(f'confirm.{code}', code))} {shown(answer)}", style
    if decision.get("condition"):
        yield f"      {words('terminal.condition', condition=shown(decision['condition']))}", style
    for change in decision.get("changed", ()):
        what = words.of_value(f"terminal.changed.{change['what']}", change["what"].replace("_", " "))
        before, now = shown(change["before"]), shown(change["now"])
        yield f"      {words('terminal.changed', what=what, before=before, now=now)}", "yellow"
