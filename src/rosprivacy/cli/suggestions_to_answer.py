"""How many suggestions of a label file nobody has answered yet, and the command that asks them.

In: the names of label files, and what else the command has to name. Out: one line for each file with suggestions.
"""

from __future__ import annotations

import shlex
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.text import counted

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from rosprivacy.cli.inputs import Inputs


def suggestions_to_answer(inputs: Inputs) -> Iterator[str]:
    """Yield a line for each label file that has suggestions; a pipe was read already, and is not read again."""
    from rosprivacy.ingest.reading.bounded_file import beginning
    from rosprivacy.ingest.reading.yaml_values import MAX_BYTES

    system = [*(inputs.policies or ())] if inputs.given_options("policies") else []
    system += [word for file in inputs.types or () if inputs.given_options("types") for word in ("--types", file)]
    for name in inputs.labels or ():
        lines = beginning(name, MAX_BYTES).decode("utf-8", "replace").splitlines()
        if line := line_about(name, lines, system):
            yield line


def line_about(file: str, lines: Iterable[str], system: Sequence[str] = ()) -> str:
    """Return the line about the lines of one label file; empty where none is a suggestion.

    >>> line_about("l.yaml", ["labels: 1", "# suggest: likely …"], ["p.xml"])
    "1 suggestion to answer: rosprivacy suggest p.xml --into l.yaml --ask --by 'YOUR NAME'"
    """
    from rosprivacy.ingest.suggestion_rules.comments import MARK

    texts = list(lines)
    waiting = sum(line.startswith(MARK) for line in texts)
    by = [] if any(line.startswith("author:") for line in texts) else ["--by", "YOUR NAME"]
    command = shlex.join(["rosprivacy", "suggest", *system, "--into", file, "--ask", *by])
    return f"{counted(waiting, 'suggestion')} to answer: {shown(command)}" if waiting else ""
