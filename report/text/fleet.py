"""A fleet in the report for the terminal: how many robots, on how many each finding is, which robots differ.

In: a JSON document of the contract. Out: lines.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.report.naming import joined_by_and, names_shown
from rosprivacy.report.robots import forms_in_words

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from rosprivacy.report.catalogs.words import Words
    from rosprivacy.report.text.line_parts import Line

FORMS = ("dismissed", "accepted", "pseudonymised")


def fleet_lines(report: Mapping[str, Any], words: Words) -> Iterator[Line]:
    """Return how many robots there are, and which differ from most of their model."""
    fleet = report.get("fleet")
    if not fleet:
        return
    models = ", ".join(f"{count} {model}" for model, count in fleet["models"].items() if model)
    robots = words.count(fleet["robots"], "robot")
    yield words("terminal.each", robots=robots, models=f" ({models})" if models else ""), ""
    titles = {f["id"]: f"{f['category']}: {f['source']['name']} -> {f['leak']['name']}" for f in report["findings"]}
    titles = {p["id"]: titles[p["finding"]] for p in fleet["patterns"]}
    for deviant in fleet["deviants"]:
        yield "", ""
        yield (
            words("terminal.deviant", robots=names_shown(deviant["robots"], words), model=deviant["model"]),
            "bold yellow",
        )
        for key in ("more", "fewer"):
            for share in deviant[key]:
                what = f"{_form(share, words)}{shown(titles[share['pattern']])}"
                yield f"   {words(f'terminal.fleet.{key}', what=what)}", ""
        for key in ("more_open", "fewer_open"):
            if deviant[key]:
                names = names_shown([element["name"] for element in deviant[key]], words)
                yield f"   {words(f'terminal.fleet.{key}', what=names)}", ""


def on_robots(report: Mapping[str, Any], finding: Mapping[str, Any], words: Words) -> Iterator[str]:
    """Return in a few words on how many robots a finding is; nothing of what is on none."""
    for pattern in report.get("fleet", {}).get("patterns", ()):
        if pattern["finding"] == finding["id"] and pattern["robots"]:
            parts = [f"{words.count(len(robots), 'robot')} {form}" for robots, form in _forms(pattern, words)]
            yield (
                joined_by_and(parts, words)
                if parts
                else words("terminal.on", robots=words.count(len(pattern["robots"]), "of_robots"))
            )


def robots_of(report: Mapping[str, Any], finding: Mapping[str, Any], words: Words) -> Iterator[Line]:
    """Return on how many robots a finding is; a line for each way in which it stands there."""
    fleet = report.get("fleet")
    pattern = next((p for p in fleet["patterns"] if p["finding"] == finding["id"]), None) if fleet else None
    if not fleet or not pattern or not pattern["robots"]:
        return
    forms = _forms(pattern, words)
    on = words(
        "terminal.on.of",
        n=str(len(pattern["robots"])),
        robots=words.count(fleet["robots"], "of_robots"),
        across=words("terminal.across", n=pattern["findings"]) if pattern["across"] else "",
        names="" if forms else f": {names_shown(pattern['robots'], words)}",
        id=pattern["id"],
    )
    yield f"   {on}", ""
    for robots, form in forms:
        count = words.count(len(robots), "robot")
        yield f"   {words.pair(count, words.pair(form, names_shown(robots, words)))}", ""


def _forms(pattern: Mapping[str, Any], words: Words) -> list[tuple[Sequence[str], str]]:
    forms = {form: (words(f"terminal.form.{form}.yes"), words(f"terminal.form.{form}.no")) for form in FORMS}
    return forms_in_words(pattern.get("forms", ()), forms)


def _form(share: Mapping[str, Any], words: Words) -> str:
    where = words("terminal.ends.here") if share["ends"] else ""
    forms = [words(f"terminal.form.{form}.yes") for form in FORMS if share[form]]
    return where + (", ".join(forms) + " " if forms else "")
