"""A fleet in the report for the terminal: how many robots, on how many each finding is, which robots differ.

In: a JSON document of the contract. Out: lines.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.text import counted
from rosprivacy.report.robots import forms_in_words

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

Line = tuple[str, str]  # text, style
NAMED = 5  # robots that are named
FORMS = (("dismissed", "only through another leak"), ("accepted", "accepted"), ("pseudonymised", "pseudonymised"))


def fleet_lines(report: Mapping[str, Any]) -> Iterator[Line]:
    """Return how many robots there are, and which differ from most of their model."""
    fleet = report.get("fleet")
    if not fleet:
        return
    models = ", ".join(f"{count} {model}" for model, count in fleet["models"].items() if model)
    robots = counted(fleet["robots"], "robot") + (f" ({models})" if models else "")
    yield f"{robots}; each finding below stands for all like it", ""
    titles = {f["id"]: f"{f['category']}: {f['source']['name']} -> {f['leak']['name']}" for f in report["findings"]}
    titles = {p["id"]: titles[p["finding"]] for p in fleet["patterns"]}
    for deviant in fleet["deviants"]:
        yield "", ""
        yield f"{named(deviant['robots'])}: not as most of model {deviant['model']}", "bold yellow"
        for word, key in (("more", "more"), ("not", "fewer")):
            for share in deviant[key]:
                yield f"   {word}: {_form(share)}{shown(titles[share['pattern']])}", ""
        for word, key in (("more to review", "more_open"), ("not to review", "fewer_open")):
            if deviant[key]:
                yield f"   {word}: {named([element['name'] for element in deviant[key]])}", ""


def on_robots(report: Mapping[str, Any], finding: Mapping[str, Any]) -> Iterator[str]:
    """Return in a few words on how many robots a finding is; nothing of what is on none."""
    for pattern in report.get("fleet", {}).get("patterns", ()):
        if pattern["finding"] == finding["id"] and pattern["robots"]:
            forms = forms_in_words(pattern.get("forms", ()))
            parts = [f"{counted(len(robots), 'robot')} {words}" for robots, words in forms]
            yield " and ".join(parts) if parts else f"on {counted(len(pattern['robots']), 'robot')}"


def robots_of(report: Mapping[str, Any], finding: Mapping[str, Any]) -> Iterator[Line]:
    """Return on how many robots a finding is; a line for each way in which it stands there."""
    fleet = report.get("fleet")
    pattern = next((p for p in fleet["patterns"] if p["finding"] == finding["id"]), None) if fleet else None
    if not fleet or not pattern or not pattern["robots"]:
        return
    how_many = f"{len(pattern['robots'])} of {counted(fleet['robots'], 'robot')}"
    across = f", from one to another, {pattern['findings']:,} times" if pattern["across"] else ""
    forms = forms_in_words(pattern.get("forms", ()))
    names = "" if forms else f": {named(pattern['robots'])}"
    yield f"   on {how_many}{across}{names}   [pattern {pattern['id']}]", ""
    for robots, words in forms:
        yield f"   {counted(len(robots), 'robot')}: {words}: {named(robots)}", ""


def named(names: Iterable[str]) -> str:
    """Return some names, and how many more there are.

    >>> named(["a", "b", "c", "d", "e", "f"])
    'a, b, c, d, e and 1 more'
    """
    everything = list(names)
    more = f" and {len(everything) - NAMED} more" if len(everything) > NAMED else ""
    return shown(", ".join(everything[:NAMED])) + more


def _form(share: Mapping[str, Any]) -> str:
    where = "ends here, " if share["ends"] else ""
    forms = [what for key, what in FORMS if share[key]]
    return where + (", ".join(forms) + " " if forms else "")
