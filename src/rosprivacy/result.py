"""What an analysis gives back: the ``Answer`` that every format is made of, and what was read to get it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.findings.findings import Options
from rosprivacy.report.answer import Answer
from rosprivacy.report.document.whole import document

if TYPE_CHECKING:
    from rosprivacy.analysis.model import Policy
    from rosprivacy.ingest.labels.label_file import Labels


@dataclass(frozen=True, slots=True)
class Result(Answer):
    """An answer with the policies and label files behind it; ``formats.py`` says in which formats it is written.

    Attributes
    ----------
    policies, labels
        As they were read; none where the system comes from a database.
    options
        What was asked.
    """

    policies: tuple[Policy, ...] = ()
    labels: tuple[Labels, ...] = ()
    options: Options = field(default_factory=Options)

    def document(self) -> dict[str, Any]:
        """Return the JSON document of the contract."""
        return document(self)
