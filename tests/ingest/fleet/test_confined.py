"""A fleet file opens nothing outside its folder, and no message tells what stands there."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.files_read import one_run, read_as
from rosprivacy.settings import Settings
from rosprivacy.systems.fleet_system import answer_fleet
from tests.helpers.command import Cli, refused
from tests.helpers.fleet_files import policy, write

if TYPE_CHECKING:
    from collections.abc import Iterator

SECRET = "password: hunter2"  # noqa: S105 - of nobody
INSIDE = "fleet: 1\nrobots: {a: {policies: a.xml}}\n"


@pytest.fixture(autouse=True)
def site(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A fleet's folder, and beside it what belongs to somebody else."""
    monkeypatch.chdir(tmp_path)
    write("site/a.xml", policy("/camera>/image"))
    write("site/robots/r1/p.xml", policy("/camera>/image"))
    write("other/secret.yaml", f"{SECRET}\n")
    write("other/secret.xml", policy("/camera>/image").replace("/image", f"/{SECRET}"))
    write("other/r1/p.xml", policy("/camera>/image"))
    write("other/fleet.yaml", "fleet: 1\nrobots: {b: {policies: secret.xml}}\n")
    Path("site/link.yaml").symlink_to(tmp_path / "other" / "secret.yaml")
    Path("site/link.xml").symlink_to(tmp_path / "other" / "secret.xml")
    Path("site/more").symlink_to(tmp_path / "other")
    Path("site/robots/r1/l.yaml").symlink_to(tmp_path / "other" / "secret.yaml")
    with one_run():
        yield tmp_path / "site"


@pytest.mark.parametrize(
    ("text", "line", "name"),
    [
        ("fleet: 1\ninclude: [../other/secret.yaml]\n", 2, "site/../other/secret.yaml"),
        ("fleet: 1\ninclude: [{tmp}/other/secret.yaml]\n", 2, "{tmp}/other/secret.yaml"),
        ("fleet: 1\ninclude: [link.yaml]\n", 2, "site/link.yaml"),
        ("fleet: 1\ninclude: [more/fleet.yaml]\n", 2, "site/more/fleet.yaml"),
        ("fleet: 1\nrobots:\n  a: {policies: ../other/secret.xml}\n", 3, "site/../other/secret.xml"),
        ("fleet: 1\nrobots:\n  a: {policies: a.xml, labels: ../other/secret.yaml}\n", 3, "site/../other/secret.yaml"),
        ("fleet: 1\nrobots:\n  a: {policies: link.xml}\n", 3, "site/link.xml"),
        ("fleet: 1\nrobots:\n  a: {policies: '../other/*.xml'}\n", 3, "site/../other/*.xml"),
        ("fleet: 1\nmodels:\n  m: {policies: more}\nrobots: {a: {model: m}}\n", 3, "site/more"),
        ("fleet: 1\ngroups:\n  - {policies: 'more/*/p.xml'}\n", 3, "site/more/*/p.xml"),
        ("fleet: 1\ngroups:\n  - {policies: robots/*/p.xml, labels: robots/*/l.yaml}\n", 3, "site/robots/r1/l.yaml"),
    ],
)
def test_what_leaves_the_folder_is_refused_and_not_opened(site: Path, text: str, line: int, name: str) -> None:
    tmp = str(site.parent)
    write("site/f.yaml", text.replace("{tmp}", tmp))
    with pytest.raises(InputErrors) as error:
        answer_fleet("site/f.yaml", Settings())
    what = f"{name.replace('{tmp}', tmp)!r} leaves the folder {site}; move the file inside it, or widen"
    assert any(str(one).startswith(f"site/f.yaml:{line}: {what}") for one in error.value.errors), error.value
    assert SECRET not in str(error.value)
    for file in (site.parent / "other").rglob("*.*"):
        assert read_as(str(file), file.stat()) is None


def test_a_folder_of_policies_may_not_lead_out(site: Path) -> None:
    write("site/f.yaml", "fleet: 1\nrobots:\n  a: {policies: policies}\n")
    write("site/policies/a.xml", policy("/camera>/image"))
    (site / "policies" / "b.xml").symlink_to(site.parent / "other" / "secret.xml")
    with pytest.raises(InputErrors, match=r"^site/policies/b.xml: 'site/policies/b.xml' leaves the folder"):
        answer_fleet("site/f.yaml", Settings())
    secret = site.parent / "other" / "secret.xml"
    assert read_as(str(secret), secret.stat()) is None


@pytest.mark.parametrize("command", [("analyze", "--fleet"), ("fleet",)])
def test_the_root_can_be_widened(cli: Cli, command: tuple[str, ...]) -> None:
    write("site/f.yaml", "fleet: 1\nrobots: {a: {policies: [a.xml, ../other/r1/p.xml]}}\n")
    assert "leaves the folder" in refused(cli(*command, "site/f.yaml"))[0]
    assert cli(*command, "site/f.yaml", "--include-root", ".").returncode in (0, 4)


def test_a_root_that_is_a_link_is_the_folder_that_it_leads_to(site: Path) -> None:
    write("site/f.yaml", INSIDE)
    (site.parent / "by name").symlink_to(site)
    assert answer_fleet("by name/f.yaml", Settings()).policies
