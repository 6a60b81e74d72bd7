"""The verdict in one sentence, with its doubts: every output says it in these words (rules S11, S12).

In: a JSON document of the contract. Out: plain text. What changes no verdict is named all the same: a doubt that rides
is part of the sentence.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import GOES_NOWHERE, MAY_REVEAL, NO_LEAK_NAMED, RESTRICTED, Rank
from rosprivacy.report.catalogs.words import IN_ENGLISH, Words
from rosprivacy.report.naming import joined_by_and, names_shown, shown_name

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

ALL = "all"
SHOWN_AT_MOST = 3  # elements or files of one sort of doubts


def verdict_sentence(document: Mapping[str, Any], words: Words = IN_ENGLISH) -> str:
    """Return the verdict, what it means, each sort of doubts with names, and what was not asked for.

    Complexity: O(doubts and findings).
    """
    meaning = [_meaning(document, words)]
    accepted = sum(finding["accepted"] for finding in document["findings"])
    if accepted:
        meaning.append(words("terminal.number.accepted", findings=words.count(accepted, "terminal.finding")))
    meaning += doubt_phrases(document, words)
    return words.pair(document["verdict"], "; ".join(meaning))


def verdict_meaning(document: Mapping[str, Any]) -> str:
    """Return the key of what the verdict means, for programs.

    The verdict itself; ``doubtful`` where only a doubt keeps it from being better; ``nothing``, ``goes-nowhere`` or
    ``no-leak-named`` where it lacks grounds.
    """
    verdict = str(document["verdict"])
    if any(document["categories"]) and (verdict != "undetermined" or document["open"]):
        return verdict
    if not document["categories"]:
        return "nothing"
    return lacking(document) or ("doubtful" if any(map(_breaks, doubts_of(document))) else "nothing")


def _meaning(document: Mapping[str, Any], words: Words) -> str:
    key = verdict_meaning(document)
    accepted = any(finding["accepted"] for finding in document["findings"])
    return words(
        f"terminal.accepted.{key}"
        if accepted and key in ("undetermined", "no-leak-found")
        else f"terminal.verdict.{key}"
    )


def lacking(document: Mapping[str, Any]) -> str:
    """Return what 'no leak found' lacks where data has a source: ``GOES_NOWHERE``, ``NO_LEAK_NAMED``, else empty."""
    codes = {row.get("code") for row in document["diagnostics"]}
    return next((code for code in (GOES_NOWHERE, NO_LEAK_NAMED) if code in codes), "")


def doubts_of(document: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """Return the doubts that nobody has accepted; documents of earlier versions have none."""
    return [row for row in document.get("doubts", ()) if not row["accepted"]]


def _breaks(doubt: Mapping[str, Any]) -> bool:
    return bool(doubt["rank"] == Rank.BREAKS)


def doubt_phrases(document: Mapping[str, Any], words: Words) -> Iterator[str]:
    """Return a phrase for each sort of doubts, with the first names; how many are accepted; the restriction last."""
    sorts: dict[str, list[Mapping[str, Any]]] = defaultdict(list)
    for doubt in doubts_of(document):
        sorts[doubt["doubt"]].append(doubt)
    restricted = sorts.pop(RESTRICTED, [])
    yield from (phrase(doubts, words) for doubts in sorts.values())
    accepted = sum(bool(doubt["accepted"]) for doubt in document.get("doubts", ()))
    if accepted:
        yield words.count(accepted, "doubt.accepted")
    if restricted:
        yield restriction(document, words)


def phrase(doubts: Sequence[Mapping[str, Any]], words: Words) -> str:
    """Return what is said of doubts of one sort, with the first names."""
    name, count = doubts[0]["doubt"], sum(doubt["count"] for doubt in doubts)
    return words.count(count, f"doubt.{name}", names=about(doubts, words))


def about(doubts: Iterable[Mapping[str, Any]], words: Words) -> str:
    """Return the names of what some doubts are about, and how many more there are."""
    names = dict.fromkeys(subject(doubt) for doubt in doubts)
    return words.row(words.first(list(names), SHOWN_AT_MOST))


def subject(doubt: Mapping[str, Any]) -> str:
    """Return what one doubt is about: the element, else the file."""
    return shown_name(doubt["element"]) if doubt.get("element") else shown(doubt["file"])


def restriction(document: Mapping[str, Any], words: Words = IN_ENGLISH) -> str:
    """Return what the answer is restricted to; empty if it is about everything."""
    assumed = document["assumptions"]
    parts = []
    if assumed["categories_asked"] != ALL:
        parts.append(names_shown(assumed["categories_asked"], words))
    if assumed["data_types_asked"] != ALL:
        parts.append(asked_types(assumed, words))
    if "identity_factors_asked" in assumed:
        parts.append(asked_factors(assumed, words))
    if assumed["article9_only"]:
        parts.append(asked_level(assumed, words))
    return words("terminal.asked", what=joined_by_and(parts, words)) if parts else ""


def asked_types(assumed: Mapping[str, Any], words: Words) -> str:
    """Return which data types were asked for."""
    return words("terminal.asked.types", types=words("terminal.or").join(map(shown, assumed["data_types_asked"])))


def asked_factors(assumed: Mapping[str, Any], words: Words) -> str:
    """Return which identity factors were asked for."""
    return words(
        "terminal.asked.factors", factors=words("terminal.or").join(map(shown, assumed["identity_factors_asked"]))
    )


def asked_level(assumed: Mapping[str, Any], words: Words) -> str:
    """Return how far Article 9 was asked for."""
    return words(f"terminal.level.{assumed.get('article9_level', MAY_REVEAL)}")
