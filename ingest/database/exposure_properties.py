"""Why others on the network can read a channel, as a property of it, and back (rule S10)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.model import Exposure, Place
from rosprivacy.analysis.model.reason import NOT_ENCRYPTED, STRANGERS
from rosprivacy.ingest.database.flow_statements import DATABASE

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

KEY, BETWEEN = "unprotected", ": "
CAUSES = (NOT_ENCRYPTED, STRANGERS)


def exposure_properties(exposures: Iterable[Exposure]) -> dict[str, Any]:
    """Return the properties of a channel with these exposures; null where it has none.

    >>> exposures_of(exposure_properties([Exposure("strangers", Place("g.p7s", 4))]))
    (Exposure(cause='strangers', place=Place(file='g.p7s', line=4)),)
    """
    return {KEY: [f"{one.cause}{BETWEEN}{one.place.file}:{one.place.line}" for one in exposures] or None}


def exposures_of(properties: Mapping[str, Any]) -> tuple[Exposure, ...]:
    """Return the exposures that properties state, sorted; a cause alone is a person's word in the database.

    Raises
    ------
    ValueError
        If they cannot be understood.
    """
    written = properties.get(KEY) or []
    if not isinstance(written, list) or not all(isinstance(text, str) for text in written):
        raise ValueError(f"{KEY} is not a list of texts")
    found = set()
    for text in written:
        cause, _, place = text.partition(BETWEEN)
        file, _, line = place.rpartition(":")
        if cause not in CAUSES or (place and not line.isdecimal()):
            raise ValueError(f"{KEY} {text!r} is none of {', '.join(CAUSES)}, with the file and line that say so")
        found.add(Exposure(cause, Place(file, int(line)) if place else Place(DATABASE, 0)))
    return tuple(sorted(found))
