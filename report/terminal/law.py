"""The law that the ontology knows -> text: provisions with their dates, and what is too old to rely on.

In: provisions, the date of the list of adequacy decisions, today. Out: lines. No verdict of law.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.ontology.provisions import MONTHS, is_old

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from rosprivacy.ontology.provisions import Provision

ADEQUACY = "Adequacy decisions (GDPR Art. 45)"
UNCONFIRMED = (
    "amendment adopted {date}; that the Official Journal has it is not confirmed; look whether it was published"
)


def law_lines(provisions: Sequence[Provision], countries: str) -> Iterator[str]:
    """Yield what is known, each with its date; no legal advice."""
    yield "Only these are known, in words of the program; what counts is the law itself."
    yield "'reviewed' is the day on which the entry was last looked at, not a day on which the law was read in force."
    for provision in provisions:
        where = f"  {provision.address}" if provision.address else ""
        yield f"{provision.name}: {provision.title} (reviewed {provision.as_of}){where}"
        yield f"   {provision.meaning}"
        if provision.adopted:
            yield f"   {UNCONFIRMED.format(date=provision.adopted)}"
    yield f"{ADEQUACY}: reviewed {countries}"


def unconfirmed_lines(provisions: Sequence[Provision]) -> list[str]:
    """Return what rests on law that was adopted, and that we did not find published."""
    return [f"{one.name}: {UNCONFIRMED.format(date=one.adopted)}" for one in provisions if one.adopted]


def old_lines(provisions: Sequence[Provision], countries: str, today: str) -> list[str]:
    """Return what was last looked at more than six months before today."""
    dated = [*((provision.name, provision.as_of) for provision in provisions), (ADEQUACY, countries)]
    return [
        f"{name}: reviewed {as_of}, more than {MONTHS} months ago; look whether it still holds"
        for name, as_of in dated
        if is_old(as_of, today)
    ]
