"""Why something is a finding of another kind than disclosure: a key and values, for words of any language."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Mapping

NO_RETENTION, NO_RETENTION_FOR, ENDLESS_BACKUPS = "no-retention", "no-retention-for", "endless-backups"
KEPT_LONGER, KEPT_LONGER_IN_BACKUPS = "kept-longer", "kept-longer-in-backups"
KEPT_PAST = "kept-past"
NOT_ADEQUATE, NO_LONGER_ADEQUATE, PARTLY_ADEQUATE = "not-adequate", "no-longer-adequate", "partly-adequate"
STATED_NOT_ADEQUATE, STATED_NO_LONGER_ADEQUATE = "stated-not-adequate", "stated-no-longer-adequate"
NOT_ENCRYPTED, STRANGERS = "not-encrypted", "strangers"
NOT_ENCRYPTED_NOR_CLOSED = "not-encrypted-nor-closed"
_UNBASED = "; no basis for the transfer is stated"
REASONS: Mapping[str, str] = {  # key -> the sentence in English, with places for values
    NO_RETENTION: "no retention is stated",
    NO_RETENTION_FOR: "no retention is stated for {category}",
    ENDLESS_BACKUPS: "it has backups, and nothing says for how long",
    KEPT_LONGER: "kept for {kept}, which can be longer than the {limit} that {category} may be kept",
    KEPT_LONGER_IN_BACKUPS: "kept for {kept} and in backups {backups} more, which can be longer than the {limit} that "
    "{category} may be kept",
    KEPT_PAST: "it holds recordings from {since}, and the {kept} for which they are kept ended on {ended}",
    NOT_ADEQUATE: "in {country}, for which no adequacy decision is known" + _UNBASED,
    NO_LONGER_ADEQUATE: "in {country}, for which the adequacy decision ended on {until}" + _UNBASED,
    PARTLY_ADEQUATE: "in {country}, whose adequacy decision covers {recipients}" + _UNBASED,
    STATED_NOT_ADEQUATE: "in {country}; the basis stated is adequacy, and no such decision is known",
    STATED_NO_LONGER_ADEQUATE: "in {country}; the basis stated is adequacy, and the adequacy decision ended on {until}",
    NOT_ENCRYPTED: "nothing encrypts what is sent there, by {file}:{line}",
    STRANGERS: "a participant without a certificate may join, by {file}:{line}",
    NOT_ENCRYPTED_NOR_CLOSED: "nothing encrypts what is sent there, by {file}:{line}, and a participant without a "
    "certificate may join, by {joining_file}:{joining_line}",
}


class Reason(NamedTuple):
    """Why data may not be where they get to.

    Attributes
    ----------
    key
        One of ``REASONS``.
    values
        (place in the sentence, what stands there): names of categories, durations as stated, codes of countries, dates,
        files and lines.
    """

    key: str
    values: tuple[tuple[str, str], ...] = ()

    @classmethod
    def of(cls, key: str, **values: object) -> Reason:
        """Return a reason with its values.

        >>> str(Reason.of(NO_LONGER_ADEQUATE, country="GB", until="2031-12-27"))
        'in GB, for which the adequacy decision ended on 2031-12-27; no basis for the transfer is stated'
        """
        return cls(key, tuple((place, str(value)) for place, value in values.items()))

    def __str__(self) -> str:
        """Return the sentence in English."""
        return REASONS[self.key].format(**dict(self.values))
