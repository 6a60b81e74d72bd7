"""Country codes -> where a country lies in the sense of GDPR chapter V (rule S10).

In: ``countries.yaml``, which comes with the program and states its date. Out: for each ISO 3166-1 alpha-2 code whether
it lies inside the EEA, outside with an adequacy decision, with one for some recipients only, or with none.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.non_ros import ADEQUATE, INSIDE, PARTLY, THIRD
from rosprivacy.ingest.reading import yaml_values

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rosprivacy.analysis.errors import InputError

MISTAKEN = {"UK": "GB", "EL": "GR", "EU": "the member state", "EEA": "the state"}


class Countries(NamedTuple):
    """The list that comes with the program.

    Attributes
    ----------
    as_of
        Date of the adequacy decisions, ``YYYY-MM-DD``.
    areas
        Code -> one of the areas of ``analysis/non_ros.py``.
    partly
        Code -> whom a partial adequacy decision covers.
    until
        Code -> the last day of an adequacy decision that ends by itself.
    """

    as_of: str
    areas: Mapping[str, str]
    partly: Mapping[str, str]
    until: Mapping[str, str]

    def place(self, code: str) -> dict[str, str]:
        """Return the facts of an element in a country: code, area, whom a partial decision covers, how long it holds.

        >>> countries().place("US")["area"]
        'partly'
        """
        more = {"adequacy": self.partly.get(code, ""), "until": self.until.get(code, "")}
        return {"country": code, "area": self.areas[code], **more}

    def is_abroad(self, code: str) -> bool:
        """Whether a country is outside the EEA, where the GDPR applies on the grounds of Article 3 only.

        >>> [countries().is_abroad(code) for code in ("NO", "CH", "")]
        [False, True, False]
        """
        return bool(code) and self.areas[code] != INSIDE

    def hint(self, text: str) -> str:
        """Return what to write instead of a code that is none."""
        meant = MISTAKEN.get(text.upper(), text.upper())
        if meant in self.areas or text.upper() in MISTAKEN:
            return f"did you mean {meant}?"
        return "write the two letters of ISO 3166-1, such as DE"


@cache
def countries() -> Countries:
    """Read the list."""
    file = str(Path(__file__).with_name("countries.yaml"))
    top, _ = yaml_values.read(file, _broken)
    parts = {key: value for key, _, value in top.entries}
    areas: dict[str, str] = {}
    for key, area in (("eea", INSIDE), ("parts", INSIDE), ("adequate", ADEQUATE), ("others", THIRD)):
        areas |= {item.text: area for item in parts[key].items}
    partly = {key: value.text for key, _, value in parts["partly"].entries}
    until = {key: value.text for key, _, value in parts["until"].entries}
    return Countries(parts["as_of"].text, areas | dict.fromkeys(partly, PARTLY), partly, until)


def _broken(line: int, problem: str, hint: str) -> InputError:
    raise AssertionError(f"countries.yaml:{line}: {problem}; {hint}")
