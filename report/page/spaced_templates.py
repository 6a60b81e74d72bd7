"""The templates of the report, with the spaces of its language before the marks that they write, compiled once.

In: a language. Out: a loader of templates. A template writes ``{{ name }}: {{ value }}``; in French a space stands
before the colon. ``CompiledTemplates`` keeps what jinja makes of them, as Python keeps its own ``.pyc`` files.
"""

from __future__ import annotations

import re
import sys
from contextlib import suppress
from operator import attrgetter
from pathlib import Path
from typing import TYPE_CHECKING, Any

import jinja2
from jinja2 import FileSystemBytecodeCache, PackageLoader

from rosprivacy.report.catalogs.words import NARROW, WIDE
from rosprivacy.report.finding_facts import grouped

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from jinja2 import Environment
    from jinja2.bccache import Bucket

_MARK = re.compile(r"(?<=[)}>])[:;](?=(?:\*\*)? )")  # after a value or a tag; bold may end there
_BEFORE = {":": WIDE, ";": NARROW}
TEMPLATE = ".j2"
TEMPLATES = Path(__file__).parent / "templates"


class SpacedTemplates(PackageLoader):
    """The templates of this package in a language."""

    def __init__(self, language: str) -> None:
        super().__init__("rosprivacy.report.page")
        self.language = language

    def get_source(self, environment: Environment, template: str) -> tuple[str, str, Callable[[], bool] | None]:
        """Return a template's text; a style or a script stays as it is."""
        source, file, fresh = super().get_source(environment, template)
        if self.language == "fr" and template.endswith(TEMPLATE):
            source = _MARK.sub(lambda mark: _BEFORE[mark[0]] + mark[0], source)
        return source, file, fresh


class CompiledTemplates(FileSystemBytecodeCache):
    """What jinja compiles of the templates of a folder, in its ``__pycache__``: a fifth of a report's time went there.

    A file there counts for one variant, one release of jinja and one text of its template. Where the folder cannot be
    written, or Python is told to write no bytecode, templates are compiled at each run.

    Parameters
    ----------
    templates
        Their folder.
    variant
        Names the environment that they are compiled for, where a folder has several: a language, an escape.
    """

    def __init__(self, templates: Path, variant: str = "") -> None:
        version = f"{sys.implementation.cache_tag}-{jinja2.__version__}"
        super().__init__(str(templates / "__pycache__"), f"{variant}%s.{version}.j2c")

    def load_bytecode(self, bucket: Bucket) -> None:
        """Read a compiled template; a file that cannot be read, or is damaged, counts as none."""
        with suppress(Exception):
            super().load_bytecode(bucket)

    def dump_bytecode(self, bucket: Bucket) -> None:
        """Keep a compiled template, where that can be."""
        if not sys.dont_write_bytecode:
            with suppress(OSError):
                Path(self.directory).mkdir(exist_ok=True)
                super().dump_bytecode(bucket)


def alike(rows: Iterable[Any], *fields: str) -> list[list[Any]]:
    """Return rows that have the same in some fields together, in the order of the first of each."""
    return grouped(rows, attrgetter(*fields))
