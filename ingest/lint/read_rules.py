"""Rules that are broken where a policy is read: what the reader tells, by its code."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.model import (
    DEAD_DENY,
    DIALECT,
    DUPLICATE_ENCLAVE,
    EMPTY_GROUP,
    EMPTY_INCLUDE,
    FALLBACK_TAKEN,
    MISTAKEN_TILDE,
    ODD_NAMESPACE,
    REFUSED_NAME,
    SEVERAL_PROFILES,
    SHARED_ENCLAVE,
    UNREAD_FILE,
    Breach,
)
from rosprivacy.ingest.lint.rule_table import RULES

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rosprivacy.analysis.model import Diagnostic

OF_CODE = {
    code: RULES[rule]
    for code, rule in (
        (DIALECT, "refused-policy"),
        (ODD_NAMESPACE, "odd-namespace"),
        (DEAD_DENY, "dead-deny"),
        (DUPLICATE_ENCLAVE, "duplicate-enclave"),
        (SEVERAL_PROFILES, "several-profiles"),
        (EMPTY_GROUP, "empty-group"),
        (EMPTY_INCLUDE, "empty-include"),
        (FALLBACK_TAKEN, "missing-include"),
        (MISTAKEN_TILDE, "mistaken-tilde"),
        (REFUSED_NAME, "refused-name"),
        (SHARED_ENCLAVE, "shared-enclave"),
        (UNREAD_FILE, "unused-file"),
    )
}


def read_breaches(said: Iterable[Diagnostic]) -> Iterator[Breach]:
    """Yield the rules that are broken, of what was said of policies as they were read."""
    for one in said:
        if one.code in OF_CODE:
            yield Breach(OF_CODE[one.code], one.place, one.message)
