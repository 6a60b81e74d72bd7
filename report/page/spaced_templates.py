"""The templates of the report, with the spaces of its language before the marks that they write.

In: a language. Out: a loader of templates. A template writes ``{{ name }}: {{ value }}``; in French a space stands
before the colon.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from jinja2 import PackageLoader

from rosprivacy.report.catalogs.words import NARROW, WIDE

if TYPE_CHECKING:
    from collections.abc import Callable

    from jinja2 import Environment

_MARK = re.compile(r"(?<=[)}>])[:;](?= )")  # after a value or a tag
_BEFORE = {":": WIDE, ";": NARROW}
TEMPLATE = ".j2"


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
