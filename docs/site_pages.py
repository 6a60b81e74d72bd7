"""What the site has beside ``docs/``: pages from the top of the repository, and the reference of the public names.

A hook of MkDocs (see ``mkdocs.yml``). Links from one page to another lead there; a link to a file of the repository
that is no page becomes its name. The menu has a page for each command and each document of ``docs/reference/``.
"""

from __future__ import annotations

import posixpath
import re
from pathlib import Path
from typing import TYPE_CHECKING

from mkdocs.structure.files import File
from ontology_page import ontology_page

import rosprivacy

if TYPE_CHECKING:
    from mkdocs.config.defaults import MkDocsConfig
    from mkdocs.structure.files import Files
    from mkdocs.structure.pages import Page

ROOT = Path(__file__).resolve().parent.parent
BESIDE = {
    "README.md": "first-steps.md",
    "SECURITY.md": "reporting.md",
    "CONTRIBUTING.md": "contributing.md",
    "CHANGELOG.md": "changelog.md",
}
MENU = "Reference"  # in mkdocs.yml; its folders are listed behind it
ONTOLOGY = "ontology.md"  # on the site it stands for the folder of the Turtle files
MODEL = ("category", "diagnostic", "element", "policy", "statement")
FACTS = (
    "rosprivacy.analysis.answer",
    *(f"rosprivacy.analysis.model.{module}" for module in MODEL),
    "rosprivacy.analysis.errors",
)


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """List the pages of commands and of documents in the menu."""
    (menu,) = (entry[MENU] for entry in config.nav or [] if isinstance(entry, dict) and MENU in entry)
    for title, folder in (("Commands, one by one", "commands"), ("Documents, one by one", "documents")):
        pages = sorted((ROOT / "docs" / "reference" / folder).glob("*.md"))
        menu.append({title: [f"reference/{folder}/{page.name}" for page in pages]})
    return config


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the pages that do not lie in ``docs/``."""
    for name, page in BESIDE.items():
        files.append(File.generated(config, page, content=linked((ROOT / name).read_text("utf-8"), "", "")))
    files.append(File.generated(config, "reference/python.md", content=reference()))
    files.append(File.generated(config, ONTOLOGY, content=ontology_page()))
    return files


def reference() -> str:
    """Return the page of all public names, and of the facts that an answer is made of."""
    public = [name for name in rosprivacy.__all__ if not name.startswith("__")]
    modules = {name: getattr(getattr(rosprivacy, name), "__module__", "rosprivacy") for name in public}
    told = [f"{module}.{name}" for name, module in modules.items() if module not in FACTS]
    return "# Python\n" + "".join(f"\n::: {path}\n" for path in (*told, *FACTS))


def on_page_markdown(markdown: str, page: Page, **_: object) -> str:
    """Lead links out of ``docs/`` to the pages that stand for these files."""
    folder = posixpath.dirname(page.file.src_uri)
    return linked(markdown, posixpath.join("docs", folder), folder)


def linked(text: str, folder: str, site_folder: str) -> str:
    """Return a page of a folder of the repository with links as they are on the site, in a folder there."""
    pages = {**BESIDE, "ontology": ONTOLOGY}

    def as_on_site(link: re.Match[str]) -> str:
        said, target, anchor = link.groups(default="")
        if ":" in target:
            return link[0]
        path = posixpath.normpath(posixpath.join(folder, target))
        if path in pages:
            return f"[{said}]({posixpath.relpath(pages[path], site_folder or '.')}{anchor})"
        if path.startswith("docs/"):
            return f"[{said}]({posixpath.relpath(path.removeprefix('docs/'), site_folder or '.')}{anchor})"
        return said if (ROOT / path).exists() else link[0]

    return re.sub(r"\[([^\]]+)\]\(([^)#\s]+)(#[^)]*)?\)", as_on_site, text)
