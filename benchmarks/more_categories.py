"""The whole command with more kinds of data than the ontology has, for ``turtlebot.py``.

    python benchmarks/more_categories.py COUNT analyze …

Adds COUNT categories ``Extra01``, ``Extra02``, … below ``PersonalData`` to what the program has read from the ontology,
in memory, and goes on into the command line as ``python -m rosprivacy`` does. Everything else is the program as it is.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from rosprivacy import question
from rosprivacy.cli import app
from rosprivacy.ontology.vocabulary import TOP, Vocabulary, load

if TYPE_CHECKING:
    from collections.abc import Sequence


def extended(ontologies: Sequence[str] = ()) -> Vocabulary:
    """Return what the program reads, with the extra categories."""
    known = load(ontologies=ontologies).categories
    extra = [
        known[TOP]._replace(name=name, iri=f"urn:x-benchmark:{name}", label=name, title=name, broader=(TOP,))
        for name in extra_names(count)
    ]
    return Vocabulary.of([*known.values(), *extra])


def extra_names(number: int) -> list[str]:
    return [f"Extra{i:02}" for i in range(1, number + 1)]


if __name__ == "__main__":
    count = int(sys.argv.pop(1))
    vars(question)["load"] = extended  # the name under which the program calls it
    app.main()
