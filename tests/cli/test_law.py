"""``rosprivacy law``: which law is known, as of when, and what is too old to rely on."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from rosprivacy.ingest.labels.countries import countries
from rosprivacy.ontology.provisions import is_old, provisions
from tests.helpers.command import cli

if TYPE_CHECKING:
    from tests.helpers.command import Cli

__all__ = ["cli"]


@pytest.mark.parametrize(
    ("language", "line"),
    [
        (
            "en",
            "GDPR Art. 9(1): Special categories of personal data (as of 2026-11-21)  https://eur-lex.",
        ),
        ("de", "EuGH C-21/23: ND gegen DR (Lindenapotheke), 4. Oktober 2024 (as of 2026-11-21)  https://eur-lex."),
        ("fr", "art. 88 RGPD: Traitement de données dans le cadre des relations de travail (as of 2026-11-21)"),
    ],
)
def test_each_provision_stands_there_with_its_date(cli: Cli, language: str, line: str) -> None:
    lines = cli("law", "--lang", language).stdout.splitlines()
    assert [one for one in lines if one.startswith(line)]
    assert lines[-1].endswith(f"as of {countries().as_of}")
    assert len(lines) == 2 + 2 * len(provisions())


def test_what_is_older_than_six_months_is_4(cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1779408000")  # 22 May 2026
    done = cli("law", "--check")
    assert (done.returncode, done.stdout) == (0, "nothing is older than six months; the oldest is of 2026-11-21\n")
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1811030400")  # 23 May 2027
    done = cli("law", "--check")
    assert done.returncode == 4
    assert len(done.stdout.splitlines()) == len(provisions()) + 1
    assert done.stdout.splitlines()[-1] == (
        "Adequacy decisions (GDPR Art. 45): as of 2026-11-21, more than 6 months ago; look whether it still holds"
    )


@pytest.mark.parametrize(
    ("as_of", "today", "expected"),
    [
        ("2026-08-31", "2027-02-28", False),
        ("2026-08-31", "2027-03-01", True),
        ("2026-12-01", "2027-06-01", False),
        ("2026-12-01", "2027-06-02", True),
    ],
)
def test_six_months_are_counted_by_the_calendar(as_of: str, today: str, expected: bool) -> None:  # noqa: FBT001 - what is expected
    assert is_old(as_of, today) is expected
