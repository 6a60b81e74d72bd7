"""What was asked for in the report for the terminal: an answer to a narrower question says so in its verdict (S11).

In: a JSON document of the contract. Out: parts of lines, and lines.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import MAY_REVEAL
from rosprivacy.report.terminal.called_alike import both, named
from rosprivacy.report.words.words import IN_ENGLISH, Words

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

Line = tuple[str, str]  # text, style
ALL = "all"


def asked_at_verdict(report: Mapping[str, Any], words: Words = IN_ENGLISH) -> str:
    """Return what the answer is restricted to, for the line of the verdict; empty if it is about everything."""
    said = report["assumptions"]
    parts = []
    if said["categories_asked"] != ALL:
        parts.append(named(said["categories_asked"], words))
    if said["data_types_asked"] != ALL:
        parts.append(_types(said, words))
    if "identity_factors_asked" in said:
        parts.append(_factors(said, words))
    if said["article9_only"]:
        parts.append(_level(said, words))
    return words("tty.asked", what=both(parts, words)) if parts else ""


def _types(said: Mapping[str, Any], words: Words) -> str:
    return words("tty.asked.types", types=words("tty.or").join(map(shown, said["data_types_asked"])))


def _factors(said: Mapping[str, Any], words: Words) -> str:
    return words("tty.asked.factors", factors=words("tty.or").join(map(shown, said["identity_factors_asked"])))


def _level(said: Mapping[str, Any], words: Words) -> str:
    return words(f"tty.level.{said.get('article9_level', MAY_REVEAL)}")


def may_be_asked(report: Mapping[str, Any], category: str, words: Words) -> str:
    """Return which of the kinds asked for data of another may be, with a space before; empty for what is asked for."""
    kinds = report["assumptions"].get("may_be_asked", {}).get(category)
    return words("tty.may.be", kinds=named(kinds, words)) if kinds else ""


def asked_lines(report: Mapping[str, Any], words: Words) -> Iterator[Line]:
    """Return the restrictions, as assumptions."""
    said = report["assumptions"]
    if said["categories_asked"] != ALL:
        yield f"   {words('tty.only.categories', kinds=', '.join(map(shown, said['categories_asked'])))}", ""
    if said["data_types_asked"] != ALL:
        yield f"   {words('tty.only', what=_types(said, words))}", ""
    if "identity_factors_asked" in said:
        yield f"   {words('tty.only.stated', what=_factors(said, words))}", ""
    if said["article9_only"]:
        yield f"   {words('tty.only.known', what=_level(said, words))}", ""
    for category, kinds in said.get("may_be_asked", {}).items():
        yield f"   {words('tty.also', kind=category, kinds=named(kinds, words))}", ""
