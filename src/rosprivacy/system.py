"""A system as it was read, before anything is asked of it: robot, fleet, saved graph, database and Spark come to this.

In: what ``robot_system``, ``fleet_system``, ``stored_system`` or Spark have read. Out: ``System``, for ``answering``.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.fleet.likeness import NO_ROBOTS

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from rosprivacy.analysis.fleet.likeness import Likeness
    from rosprivacy.analysis.model import Bound, Diagnostic, FlowGraph, Policy
    from rosprivacy.ingest.labels.label_file import Labels
    from rosprivacy.ingest.types.types_file import TypesFile
    from rosprivacy.ontology.vocabulary import Vocabulary


@dataclass(frozen=True, slots=True)
class System:
    """What can flow where, what people said of it, and where that stands.

    Attributes
    ----------
    diagnostics
        What a reader has to know of the inputs.
    rests_on
        Entries of the ``assumptions`` about what was read: files with their hashes (rule S12).
    policies, labels, types
        As they were read; none where the system comes from a database.
    likeness
        Which robots of the graph stand for which.
    is_fleet
        Whether it is told as one, with patterns and robots counted.
    under
        The same policies, as they were read, under other labels; None where labels stand elsewhere.
    label_files
        Of a fleet: by robot, the label files that it was read with.
    """

    graph: FlowGraph
    bound: Bound
    vocabulary: Vocabulary
    diagnostics: tuple[Diagnostic, ...]
    rests_on: Mapping[str, Any]
    policies: tuple[Policy, ...] = ()
    labels: tuple[Labels, ...] = ()
    likeness: Likeness = NO_ROBOTS
    is_fleet: bool = False
    under: Callable[[tuple[str | Labels, ...]], System] | None = None
    types: tuple[TypesFile, ...] = ()
    label_files: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
