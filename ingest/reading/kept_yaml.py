"""YAML that people wrote -> the same with a change: comments, order and quotes stay.

In: a text, and what is to be changed in it. Out: the new text. ruamel.yaml changes it and writes the rest back.
"""

from __future__ import annotations

import re
from collections import Counter
from io import StringIO
from typing import TYPE_CHECKING, Any

from ruamel.yaml import YAML
from ruamel.yaml.error import YAMLError
from ruamel.yaml.util import load_yaml_guess_indent

if TYPE_CHECKING:
    from collections.abc import Callable

FAILURES = (YAMLError, ValueError, TypeError, AttributeError, LookupError)
_COMMENT = re.compile(r"(?:^|(?<=\s))#.*$", re.MULTILINE)


def changed(text: str, change: Callable[[Any], None]) -> str:
    """Return a text after ``change`` has changed what ruamel.yaml reads in it.

    Raises
    ------
    Exception
        One of ``FAILURES``, if it cannot be read or changed so.
    """
    unix = text.replace("\r\n", "\n")
    yaml = YAML()
    yaml.preserve_quotes = True
    top, indent, offset = load_yaml_guess_indent(unix, yaml=yaml)
    change(top)
    yaml.width = 1_000_000  # lines are people's
    yaml.explicit_start = unix.lstrip("\ufeff").startswith("---")
    yaml.indent(mapping=_indent_of_keys(unix) or 2, sequence=indent or 2, offset=offset or 0)
    out = StringIO()
    yaml.dump(top, out)
    written = out.getvalue()
    return written.replace("\n", "\r\n") if "\r\n" in text else written


def _indent_of_keys(unix: str) -> int:
    """Return by how much the first key below a key of the top is indented; 0 if there is none."""
    below_a_key = False
    for line in unix.split("\n"):
        said = line.strip()
        if not said or said.startswith("#"):
            continue
        indent = len(line) - len(line.lstrip(" "))
        if below_a_key and indent and said[0] != "-":
            return indent
        below_a_key = line[0] not in " \t-" and ":" in line
    return 0


def comments(text: str) -> list[str]:
    """Return the comments of a text, and what looks like one."""
    return _COMMENT.findall(text)


def keeps_comments(old: str, new: str) -> bool:
    """Return whether every comment of a text is in the other."""
    return not Counter(comments(old)) - Counter(comments(new))
