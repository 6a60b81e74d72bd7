"""The documentation as a site: built strictly from docs/ and the docstrings, complete, and without other hosts."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

import rosprivacy
from tests.helpers.paths import ROOT
from tests.helpers.reference import command_group

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("site")]  # built once
NO_PART = shutil.ignore_patterns(".*", "build", "dist", "tests", "benchmarks", "__pycache__", "*.egg-info")


def built(repository: Path, site: Path) -> subprocess.CompletedProcess[str]:
    """Build as ``mkdocs.yml`` says, with no way out to the network."""
    closed = dict.fromkeys(("http_proxy", "https_proxy", "HTTP_PROXY", "HTTPS_PROXY"), "http://127.0.0.1:9")
    environment = {**os.environ, **closed, "NO_MKDOCS_2_WARNING": "1"}
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(site)]
    return subprocess.run(command, cwd=repository, env=environment, capture_output=True, text=True, check=False)


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("site")
    done = built(ROOT, folder)
    assert done.returncode == 0, done.stderr
    return folder


def test_every_page_is_there(site: Path) -> None:
    docs = ROOT / "docs"
    pages = {page.relative_to(docs).with_suffix(".html") for page in docs.rglob("*.md")}
    assert pages <= {page.relative_to(site) for page in site.rglob("*.html")}
    assert all((site / f"{page}.html").exists() for page in ("first-steps", "reporting", "changelog"))


def test_each_command_has_a_page_in_the_menu(site: Path) -> None:
    text = (site / "reference" / "index.html").read_text("utf-8")
    for name in command_group():
        assert f'href="commands/{name}.html"' in text, name


def test_nothing_is_loaded_from_another_host(site: Path) -> None:
    for page in site.rglob("*.html"):
        text = page.read_text("utf-8")
        loaded = re.findall(r"<(?:script|img|link|iframe)\b[^>]*\b(?:src|href)=\"?([^\s\">]+)", text)
        assert loaded
        assert not [target for target in loaded if re.match(r"(?:\w+:)?//", target)], page.name
        assert 'class="mermaid"' not in text  # the theme would fetch what draws it


def test_the_reference_tells_every_public_name(site: Path) -> None:
    """That each of them has a docstring is held by ruff (D100 to D107)."""
    text = (site / "reference" / "python.html").read_text("utf-8")
    for name in set(rosprivacy.__all__) - {"__version__"}:
        where = getattr(getattr(rosprivacy, name), "__module__", "rosprivacy")
        assert f'id="{where}.{name}"' in text, name


def test_the_ontology_is_a_page_that_redirects_can_lead_to(site: Path) -> None:
    """https://w3id.org/rosprivacy#Video -> ontology.html#Video; the words of exported files too."""
    text = (site / "ontology.html").read_text("utf-8")
    for term in ("Video", "GDPR-9-1", "CareContext", "verdict-may-reveal", "fallsUnder", "Finding", "Role"):
        assert f'id="{term}"' in text, term
    for page in ("index.html", "linked-data.html"):
        assert 'href="ontology.html"' in (site / page).read_text("utf-8"), page
    assert not [*site.glob("*.py"), *site.glob("*.j2")]


def test_a_dead_link_fails(tmp_path: Path) -> None:
    shutil.copytree(ROOT, tmp_path / "copy", symlinks=True, ignore=NO_PART)
    page = tmp_path / "copy" / "docs" / "views.md"
    links = ("[x](nowhere.md)", "[x](../nowhere.md)", "[x](labels.md#nowhere)")
    page.write_text("\n\n".join([page.read_text("utf-8"), *links, ""]), "utf-8")
    done = built(tmp_path / "copy", tmp_path / "site")
    assert done.returncode == 1
    for target in ("'nowhere.md'", "'../nowhere.md'", "'labels.md#nowhere'"):
        assert any(line.startswith("WARNING") and target in line for line in done.stderr.splitlines()), done.stderr
    assert "Aborted with " in done.stdout  # each warning is an error
