"""``rosprivacy law``: which law is known, as of when, and what is too old to rely on."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from rosprivacy.ingest.labels.countries import countries
from rosprivacy.ontology.provisions import is_old, provisions, provisions_named
from rosprivacy.report.catalogs.words import plain
from rosprivacy.report.finding_facts import looked_at
from rosprivacy.report.naming import text
from tests.helpers.command import cli
from tests.helpers.pages import LANGUAGES
from tests.helpers.reports import care

if TYPE_CHECKING:
    from tests.helpers.command import Cli

__all__ = ["cli"]


@pytest.mark.parametrize(
    ("language", "line"),
    [
        (
            "en",
            "GDPR Art. 9(1): Special categories of personal data (reviewed 2026-11-21)  https://eur-lex.",
        ),
        (
            "de",
            "EuGH C-21/23: ND gegen DR (Lindenapotheke), 4. Oktober 2024: Bestellungen von Arzneimitteln (reviewed",
        ),
        ("fr", "art. 88 RGPD: Traitement de données dans le cadre des relations de travail (reviewed 2026-11-21)"),
    ],
)
def test_each_provision_stands_there_with_its_date(cli: Cli, language: str, line: str) -> None:
    lines = cli("law", "--lang", language).stdout.splitlines()
    assert [one for one in lines if one.startswith(line)]
    assert lines[-1].endswith(f"reviewed {countries().as_of}")
    unconfirmed = [one for one in provisions() if not one.confirmed]
    assert len(lines) == 3 + 2 * len(provisions()) + len(unconfirmed)


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_name_of_a_report_is_a_name_here(language: str) -> None:
    """The texts of a report name provisions and say that this command has what they say."""
    known = provisions(language)
    document = care()
    stated = [row for kind in document["categories"] for row in (*kind["law"], *kind.get("in_context", ()))]
    for row in (*stated, *looked_at(document)):
        meanings = [plain(one.meaning) for one in provisions_named(known, text(row, "provision", language))]
        assert plain(text(row, "meaning", language)) in meanings


def test_one_provision_is_printed_by_its_name(cli: Cli) -> None:
    lines = cli("law", "ai act art. 27").stdout.splitlines()
    assert [line for line in lines if line.startswith("AI Act")] == [lines[2]]
    unknown = cli("law", "GDPR Art. 999")
    assert unknown.returncode == 2
    assert "GDPR Art. 999" in unknown.stderr


def test_what_no_public_source_confirms_is_named_and_is_4(cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    """The dates of Annex III rest on an amendment of which no publication was found; some law is a pointer only."""
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1779408000")  # 22 May 2026
    done = cli("law", "--check")
    assert done.returncode == 4
    lines = {line.partition(":")[0]: line for line in done.stdout.splitlines()}
    adopted = {one.name: one.adopted for one in provisions() if not one.confirmed}
    assert lines.keys() == adopted.keys() >= {"AI Act Art. 26(7)", "Personal Information Protection Law (China)"}
    assert all(day in lines[name] and "not confirmed" in lines[name] for name, day in adopted.items())


def test_what_is_older_than_six_months_is_4(cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1811635200")  # 30 May 2027
    done = cli("law", "--check")
    assert done.returncode == 4
    old = [line for line in done.stdout.splitlines() if "more than 6 months ago" in line]
    assert len(old) == len(provisions()) + 1
    assert old[-1] == (
        "Adequacy decisions (GDPR Art. 45): reviewed 2026-11-21, more than 6 months ago; look whether it still holds"
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
