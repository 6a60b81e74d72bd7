"""What was asked for in the report for the terminal: what an answer is restricted to, among what it assumes (S11).

In: a JSON document of the contract. Out: lines, and parts of lines.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.report.called_alike import named
from rosprivacy.report.verdict import ALL, asked_factors, asked_level, asked_types

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rosprivacy.report.catalogs.words import Words

Line = tuple[str, str]  # text, style


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
        yield f"   {words('tty.only', what=asked_types(said, words))}", ""
    if "identity_factors_asked" in said:
        yield f"   {words('tty.only.stated', what=asked_factors(said, words))}", ""
    if said["article9_only"]:
        yield f"   {words('tty.only.known', what=asked_level(said, words))}", ""
    for category, kinds in said.get("may_be_asked", {}).items():
        yield f"   {words('tty.also', kind=category, kinds=named(kinds, words))}", ""
