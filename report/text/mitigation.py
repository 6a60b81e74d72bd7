"""Proposals for the terminal.

In: the JSON document ``rosprivacy.mitigation/1``. Out: lines on a rich console.
"""

from __future__ import annotations

import json
import textwrap
from typing import TYPE_CHECKING, Any

from rich.text import Text

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.mitigation.channel_settings import BRIDGE, COMMAND, FILE, PARAMETER, SET, TAKE_OUT
from rosprivacy.analysis.mitigation.limits import DENY, FILTER, REVIEW
from rosprivacy.analysis.mitigation.proposals import ITSELF
from rosprivacy.analysis.model import STATED as STATED_FLOW
from rosprivacy.analysis.model import STORAGE_LIMITATION, THIRD_COUNTRY
from rosprivacy.analysis.model.reason import NOT_ENCRYPTED, STRANGERS
from rosprivacy.analysis.text import counted
from rosprivacy.analysis.written_names import listed
from rosprivacy.report.catalogs.words import IN_ENGLISH
from rosprivacy.report.document.analysis import SECTIONS
from rosprivacy.report.naming import kind_of, shown_name
from rosprivacy.report.text.line_parts import place
from rosprivacy.report.verdict import doubt_phrases

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rich.console import Console

    from rosprivacy.report.text.line_parts import Line

LOST_TEXTS = {
    "unread": "can no longer read",
    "unwritten": "can no longer write to",
    "narrowed": "gets fewer names through",
}
STATED = {
    STORAGE_LIMITATION: "a retention within the limit",
    THIRD_COUNTRY: "another country, or the basis of the transfer",
}
PROTECT = {
    NOT_ENCRYPTED: "set data_protection_kind to ENCRYPT",
    STRANGERS: "set allow_unauthenticated_participants to false",
}
SETTINGS = {
    (PARAMETER, SET): "set this parameter",
    (PARAMETER, TAKE_OUT): "take this out of its parameters",
    (FILE, SET): "write this in its configuration file",
    (FILE, TAKE_OUT): "take this out of its configuration file",
    (COMMAND, SET): "start it with",
}
SETTINGS_ONLY: tuple[Line, ...] = (
    ("      The program keeps to it, not DDS security: what the policy grants stays", ""),
    ("      granted, and the verdict stays. A DENY in the policy is stronger.", ""),
)
SIGNED = ("dds",)  # grants of permissions: these are changed in the policy that they were made of
SURE = {"likely": "likely", "may": "perhaps"}
WIDTH, SETTING_LINES = 70, 8  # of a setting
SHOWN, PARTS = 12, 4  # elements that get less, and what of each
FIRST = 3  # of these elements, without -v


def print_mitigation(console: Console, report: Mapping[str, Any], *, verbose: bool = False) -> None:
    """Print a document.

    Parameters
    ----------
    verbose
        Every way to set a program, every element that gets less, and what stands above already once more.
    """
    for text, style in _lines(report, verbose=verbose):
        console.print(Text(text, style), soft_wrap=True)


def _lines(report: Mapping[str, Any], *, verbose: bool) -> Iterator[Line]:
    proposals = report["proposals"]
    doubts = [*doubt_phrases(report, IN_ENGLISH)]
    if not proposals:
        yield f"{report['verdict']}: {'; '.join(['no open finding, nothing to remove', *doubts])}", "bold"
    may_deny = DENY in report["assumptions"]["kinds_of_change"]
    above: set[tuple[Line, ...]] = set()
    for number, proposal in enumerate(proposals):
        if number:
            yield "", ""
        yield from _of_proposal(proposal, above, may_deny=may_deny, verbose=verbose)
    yield "", ""
    yield from _closing(report, doubts if proposals else [])


def _of_proposal(
    proposal: Mapping[str, Any], above: set[tuple[Line, ...]], *, may_deny: bool, verbose: bool
) -> Iterator[Line]:
    names = proposal["categories"]
    title = names[0] if len(names) == 1 else f"All together ({', '.join(names)})"
    steps, removes, kept = proposal["steps"], len(proposal["removes"]), proposal["keeps"]
    if removes and not proposal["proven"]:
        yield (
            f"{title}: no proposal for {counted(removes, 'finding')}: none could be proven by a new analysis",
            "bold red",
        )
    elif removes:
        yield f"{title}: {counted(len(steps), 'change')} {_verb(steps)} {counted(removes, 'finding')}", "bold"
        yield f"   {_certainty(proposal)}", "dim"
        settings = [tuple(_setting(row, verbose=verbose)) for row in proposal["settings"]]
        new = verbose or not above.issuperset(settings)
        yield from _new(settings, "setting", above, verbose=verbose)
        yield from SETTINGS_ONLY if settings and new else ()
        yield from _reviews([step for step in steps if step["kind"] == REVIEW])
        changes = [step for kind in (DENY, FILTER) for step in steps if step["kind"] == kind]
        parts = (tuple(_of_step(step, may_deny=may_deny)) for step in changes)
        yield from _new(parts, "change", above, verbose=verbose)
        yield from _breaks(proposal, verbose=verbose)
        stays = f"no open finding of {_elements(names)} is left" if not kept else "only what is listed below is left"
        then = f"the verdict is then {proposal['verdict_then']}"
        if proposal["verdict_then"] == "leak" and not kept:
            then = "findings of other kinds stay, and with them the verdict leak"
        yield f"   Proven: analysed anew {_assumed(steps)}, {stays}; {then}.", "green"
    elif proposal["protect"]:
        yield f"{title}: the governance has to change", "bold"
    else:
        yield f"{title}: no change can be proposed", "bold red"
    yield from _protect(proposal)
    yield from _statements(proposal["statements"])
    for one in kept:
        yield f"   Stays: {_remaining(one)}", "yellow"


def _new(
    parts: Iterable[tuple[Line, ...]], noun: str, above: set[tuple[Line, ...]], *, verbose: bool
) -> Iterator[Line]:
    """Yield the parts that do not stand above, and how many do; all of them, if asked for."""
    told = list(parts)
    repeated = [] if verbose else [lines for lines in told if lines in above]
    if repeated:
        yield f"   {counted(len(repeated), noun)}, as above", "bold"
    for lines in told:
        yield from lines if lines not in repeated else ()
    above.update(told)


def _assumed(steps: Sequence[Mapping[str, Any]]) -> str:
    """With which changes it is proven: those of settings are none of them.

    >>> _assumed([{"kind": REVIEW}, {"kind": FILTER}, {"kind": FILTER}])
    'with the 2 filters, and if the review finds none'
    """
    kinds = [step["kind"] for step in steps]
    names = {DENY: "DENY", FILTER: "filter"}
    several = {DENY: "lines set to DENY", FILTER: "filters"}
    counts = {kind: kinds.count(kind) for kind in names if kind in kinds}
    changes = [f"the {names[kind]}" if n == 1 else f"the {n} {several[kind]}" for kind, n in counts.items()]
    reviews = kinds.count(REVIEW)
    finds = f"if the {'review finds' if reviews == 1 else 'reviews find'} none"
    if not changes:
        return f"for the case that {finds.removeprefix('if ')}"
    return f"with {' and '.join(changes)}" + (f", and {finds}" if reviews else "")


def _protect(proposal: Mapping[str, Any]) -> Iterator[Line]:
    """The lines of governances to change: they are signed, so there is no patch."""
    rows = proposal["protect"]
    if not rows:
        return
    ended = {finding for row in rows for finding in row["findings"]}
    yield f"   Change the governance, and sign it anew: that ends {counted(len(ended), 'finding')}", "bold"
    for row in rows:
        names = list(dict.fromkeys(_of(channel) for channel in row["channels"]))
        more = f" and {len(names) - PARTS} more" if len(names) > PARTS else ""
        yield f"      {place(row)}  {PROTECT[row['cause']]}", ""
        yield f"         {', '.join(names[:PARTS])}{more}", "dim"
    if not proposal["removes"]:
        yield f"   Proven: analysed anew with this, the verdict is then {proposal['verdict_then']}.", "green"


def _statements(statements: Sequence[Mapping[str, Any]]) -> Iterator[Line]:
    """Once per element and reason, whatever the sources."""
    if statements:
        yield "   Without a change of flows, if it is so or can be arranged, label files can state:", ""
    rows = {
        (_of(statement["element"]), statement["kind"], statement["category"], statement["reason"])
        for statement in statements
    }
    for element, kind, category, reason in sorted(rows):
        yield f"      of {element}: {STATED[kind]} for {category}  ({shown(reason)})", ""


def _verb(steps: Sequence[Any]) -> str:
    return "removes" if len(steps) == 1 else "remove"


def _elements(names: Sequence[str]) -> str:
    return names[0] if len(names) == 1 else "these kinds"


def _certainty(proposal: Mapping[str, Any]) -> str:
    cost, least = proposal["cost"], proposal["no_cheaper_than"]
    if proposal["cheapest"]:
        return f"cost {cost}; no cheaper set of such changes does it"
    return f"cost {cost}; whether a cheaper one does it is not known, but none costs less than {least}"


def _reviews(steps: Sequence[Mapping[str, Any]]) -> Iterator[Line]:
    """Reviews first: what they find decides on the rest."""
    for kinds in dict.fromkeys(", ".join(step["categories"]) for step in steps):
        alike = [step for step in steps if ", ".join(step["categories"]) == kinds]
        if len(alike) == 1:
            yield f"   Review {_of(alike[0]['channel'])}: does it carry {kinds}?", "bold"
            yield "      If a person finds that it does not, this label closes the way:", ""
        else:
            yield f"   Review {len(alike)} channels: does any of them carry {kinds}?", "bold"
            yield "      If a person finds that none does, these labels close the ways:", ""
        for section in SECTIONS.values():
            labels = [step["label"][section] for step in alike if section in step["label"]]
            yield from [(f"         {section}:", "")] if labels else ()
            yield from ((f"           {_written(label)}", "") for label in labels)
        yield "      What does carry it is labelled sensitive; then ask again.", ""


def _of_step(step: Mapping[str, Any], *, may_deny: bool) -> Iterator[Line]:
    """A line to deny, or a filter; before a filter at a leak, the lines that could be taken away in its place."""
    if step["kind"] == DENY:
        yield "   Set to DENY", "bold"
        yield from _policy(step["policy"])
        yield "      A DENY holds for the whole enclave.", ""
        return
    granted = [grant for grant in step["policy"] if grant["role"] != STATED_FLOW and grant["kind"] not in SIGNED]
    instead = may_deny and granted == step["policy"] != [] and all(flow["to"].get("leak") for flow in step["between"])
    if instead:
        yield "   Take the grant away, if nothing in its enclave needs it", "bold"
        yield from _policy(step["policy"])
        yield "      --by deny proves it, and says who else loses what.", ""
    yield from _filter(step, "Or put" if instead else "Put")
    yield from _policy(step["policy"]) if not instead else ()


def _setting(row: Mapping[str, Any], *, verbose: bool) -> Iterator[Line]:
    """What a person would set first, at a bridge or a recorder: one way for each sort of channel, or all ways."""
    names = list(dict.fromkeys(map(shown_name, row["channels"])))
    what, node = listed(names, PARTS), shown_name(row["node"])
    yield (
        f"   {f'Keep {what} from the bridge' if row['program'] == BRIDGE else f'Do not record {what} at'} {node}",
        "bold",
    )
    yield f"      It is {SURE[row['confidence']]} {row['package']} ({row['agrees']}).", ""
    kinds: list[str] = []
    for setting in row["write"]:
        phrase = SETTINGS[setting["in"], setting["do"]]
        lead = "Or" if setting["channels"] in kinds else "And" if kinds else ""
        kinds.append(setting["channels"])
        if lead == "Or" and not verbose:
            continue
        yield f"      {f'{lead} {phrase}' if lead else phrase.capitalize()}:", ""
        yield from ((f"         {line}", "") for line in _broken(setting["text"]))
        yield from [(f"         ({setting['note']})", "dim")] if setting["note"] else ()
    if not verbose and (others := len(kinds) - len(set(kinds))):
        yield f"      … or in {counted(others, 'other way', 'other ways')} (-v)", "dim"


def _broken(text: str) -> list[str]:
    """A text in lines, broken behind commas and spaces; the first and the last of many."""
    lines = textwrap.wrap(text, WIDTH, break_long_words=False, break_on_hyphens=False)
    if len(lines) <= SETTING_LINES:
        return lines
    left = len(lines) - SETTING_LINES + 1
    return [*lines[: SETTING_LINES - 2], f"… {counted(left, 'more line')} (--format json has all)", lines[-1]]


def _policy(grants: Iterable[Mapping[str, Any]]) -> Iterator[Line]:
    """The lines, each once: several enclaves may include it. A flow that a person states has none (rule S9)."""
    lines: dict[str, list[str]] = {}
    for grant in grants:
        if grant["role"] == STATED_FLOW:
            yield f"      {place(grant)}  stated flow", "dim"
            continue
        what = f"{grant['role']} {grant['kind']} {shown(grant['name'])}  (profile {shown(grant['profile'])}, enclave"
        lines.setdefault(f"{place(grant)}  {what}", []).append(shown(grant["enclave"]))
    for line, enclaves in lines.items():
        yield f"      {line} {', '.join(enclaves)})", "dim"


def _written(label: Mapping[str, Any]) -> str:
    """A label as a line of YAML; JSON's way of quoting is YAML's too."""
    ((name, said),) = label.items()
    plain = name.isascii() and all(c.isalnum() or c in "/_-." for c in name)
    return f"{name if plain else json.dumps(name)}: {{never: [{', '.join(said['never'])}]}}"


def _filter(step: Mapping[str, Any], verb: str) -> Iterator[Line]:
    """Where the filter stands, who gets what leaves it, and whom it would reach on the other side of the channel."""
    ends = [list(dict.fromkeys(_of(flow[end]) for flow in step["between"])) for end in ("from", "to")]
    source, target = (end[0] if len(end) == 1 else f"any of {', '.join(end)}" for end in ends)
    whole = len(step["between"]) > 1
    kinds = ", ".join(step["categories"])
    yield f"   {verb} a filter between {source} and {target}", "bold"
    yield f"      It has to end {kinds} (anonymise, aggregate or drop; pseudonymising does not end it).", ""
    if whole:
        yield "      In an enclave of its own: the right to the data before it is taken from the whole enclave.", ""
    yield f"      Filtered data goes to: {', '.join(map(_marked, step['reaches'])) or 'nobody'}", ""
    if step["spares"]:
        spared = ", ".join(map(_marked, step["spares"]))
        yield f"      A filter before {source} would also reach: {spared}", ""


def _breaks(proposal: Mapping[str, Any], *, verbose: bool) -> Iterator[Line]:
    """All that gets less, also further on."""
    limit = SHOWN if verbose else FIRST
    if proposal["affected"]:
        yield "   What gets less than today:", ""
    for less in proposal["affected"][:limit]:
        parts = [f"without {', '.join(one['categories'])} from {_of(one['from'])}" for one in less["filtered"]]
        for key, verb in LOST_TEXTS.items():
            parts += [f"{verb} {_of(one)}" for one in less[key]]
        more = [f"{len(parts) - PARTS} more"] if len(parts) > PARTS else []
        yield f"      {_marked(less['element'])}: {'; '.join([*parts[:PARTS], *more])}", ""
    if (others := len(proposal["affected"]) - limit) > 0:
        yield f"      … and {others} more ({'--format json has all' if verbose else '-v'})", "dim"


def _remaining(finding: Mapping[str, Any]) -> str:
    way = " -> ".join(shown_name(element) for element in finding["way"])
    if finding["reason"] == ITSELF:
        if finding["kind"] in STATED:
            return (
                f"{finding['category']} at {way}: it begins there, so there is no way to cut   [{finding['finding']}]"
            )
        return (
            f"{finding['category']} at {way}: it is source and leak, so there is no way to cut; only another role "
            f"helps, after the node itself has changed   [{finding['finding']}]"
        )
    return f"{finding['category']} on {way}: no change is allowed anywhere on this way   [{finding['finding']}]"


def _closing(report: Mapping[str, Any], doubts: Sequence[str]) -> Iterator[Line]:
    assumed = report["assumptions"]
    weights = ", ".join(f"{name} {cost}" for name, cost in assumed["weights"].items())
    yield "Assumed", "bold"
    yield f"   view {report['view']}; kinds of change: {', '.join(assumed['kinds_of_change'])}; weights: {weights}", ""
    if assumed["time_critical"]:
        critical = ", ".join(map(shown_name, assumed["time_critical"]))
        yield f"   nothing on the way to {critical} is touched: time-critical", ""
    for note in report["notes"]:
        yield f"   {note}", "yellow"
    if doubts:
        yield f"   in doubt before the changes: {'; '.join(doubts)}", "yellow"
    for line in report["labels_without_element"]:
        yield f"   after the DENY, a label names nothing: {line}", "yellow"
    if report["why_no_patch"]:
        yield f"   no patch: {report['why_no_patch']}", "yellow"
    elif report["patch"]:
        yield "   the lines set to DENY as a patch: --patch FILE", ""
    yield "   a filter and a review are work for people; labels are a person's word; this is no legal verdict", "dim"


def _marked(element: Mapping[str, Any]) -> str:
    marks = [mark for mark, key in (("leak", "leak"), ("time-critical", "time_critical")) if element.get(key)]
    return shown_name(element) + (f" ({', '.join(marks)})" if marks else "")


def _of(element: Mapping[str, Any]) -> str:
    """The name, and what it is."""
    return f"{shown_name(element)} ({kind_of(element)})"
