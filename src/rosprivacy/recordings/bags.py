"""Bags, and what is known of the system that was recorded -> what can be in them, for every output.

In: paths of bags, policies, label files. Out: ``BagsAnswer``. Without policies the label files alone tell what is in a
channel. What types suggest stands beside that, by the table in force.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rosprivacy.assumptions import files_read
from rosprivacy.ingest.bags.bag_folders import read_bags
from rosprivacy.ingest.types import TABLE
from rosprivacy.ingest.types.type_table import read_table
from rosprivacy.question import question_of
from rosprivacy.reading.robot_system import answer_robot, read_label_files
from rosprivacy.recordings.bag_kinds import by_labels, by_system, judged
from rosprivacy.report.bags.bag_document import bags_document
from rosprivacy.version import __version__

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from rosprivacy.analysis.model.recording import JudgedBag
    from rosprivacy.ingest.database.bag_rows import BagRows
    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.report.contract.bags import BagsDocument
    from rosprivacy.settings import Settings


@dataclass(frozen=True, slots=True)
class BagsAnswer:
    """Bags with what can be in them.

    Attributes
    ----------
    assumptions
        What the answer rests on (S12).
    """

    bags: tuple[JudgedBag, ...]
    assumptions: Mapping[str, Any]
    vocabulary: Vocabulary

    def document(self) -> BagsDocument:
        """Return the document ``rosprivacy.bags/1``."""
        return bags_document(self.bags, self.assumptions)

    def rows(self, robot: str) -> list[BagRows]:
        """Return what is written into a database; ``robot`` is the one that was recorded, empty for none."""
        from rosprivacy.ingest.database.bag_rows import bag_rows  # noqa: PLC0415 - light start

        return [bag_rows(bag, robot, self.assumptions) for bag in self.bags]


def answer_bags(
    bags: Sequence[str],
    policies: tuple[str, ...],
    labels: tuple[str, ...],
    settings: Settings,
    progress: Callable[[Sequence[str]], Iterable[str]] = lambda files: files,
) -> BagsAnswer:
    """Read bags, and say what kinds of data can be in them.

    Raises
    ------
    InputErrors
        With every problem of the input, one line each.
    """
    read = read_bags(bags, progress)
    vocabulary = question_of(settings).vocabulary
    table = read_table(settings.type_limits or TABLE, vocabulary, settings.bounds)
    suggested_by = {"suggested_by": {"file": table.limits.file, "sha256": table.limits.sha256}}
    if policies or settings.add:
        result = answer_robot(policies, labels, settings)
        return BagsAnswer(
            judged(read, by_system(result), table), {**result.assumptions, **suggested_by}, result.vocabulary
        )
    files = read_label_files(labels, vocabulary, settings)
    rests_on = {
        "rosprivacy": __version__,
        "ontologies": [{"file": name, "sha256": digest} for name, digest in vocabulary.sources],
        **files_read((), files, settings),
        **suggested_by,
    }
    return BagsAnswer(judged(read, by_labels(files, vocabulary), table), rests_on, vocabulary)
