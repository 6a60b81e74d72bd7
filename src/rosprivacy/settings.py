"""How to read and what to ask: what the options of the command line mean to the library."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from rosprivacy.analysis.bounds import BOUNDS, Bounds
from rosprivacy.analysis.findings.findings import MAX_PATHS
from rosprivacy.analysis.modes import Article9Level, Paths, View
from rosprivacy.ingest.labels.label_file import STANDARD
from rosprivacy.ingest.policies.xinclude import MAX_BYTES
from rosprivacy.ingest.types import TABLE
from rosprivacy.ontology.vocabulary import TOP

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence


@dataclass(frozen=True, slots=True)
class Settings:
    """How to read and what to ask.

    Attributes
    ----------
    add
        Saved graphs to add to.
    view
        ``declared`` or ``enforced``, rule S6.
    categories
        Names; the answer is about these and narrower ones. Empty for all.
    article9
        Answer only for kinds that fall or may fall under Article 9(1) GDPR, or of which that is not known.
    article9_level
        How far they have to: ``always``, ``conditional`` or ``may-reveal``; a level implies ``article9``.
    data_types
        Answer only for kinds that are represented so, such as video. Empty for all.
    identity_factors
        Answer only for kinds that tell of these factors of Article 4(1), such as economic. Empty for all.
    ontologies
        Users' own, beside the shipped one.
    category
        What the paper's six lists are about.
    standard_channels
        The label file of the standard channels, or None to take none as mundane (rule S13).
    types
        Files of observed message types (rule S15).
    type_limits
        The table of what message types cannot carry, or None to take each to carry everything (rule S15).
    paths, max_paths
        See ``Options``.
    include_root, max_bytes
        See ``read_policy``.
    domain
        That of the robot, for permissions with rules for several domains.
    allow_unsigned
        Whether permissions and governance are read that are not signed by their CA.
    permissions_ca
        Certificates or SHA-256 fingerprints of the CAs that may have signed keystores; empty for that of each keystore.
    bounds
        How much of what is read or made at most.
    progress
        Wraps the list of files, to show how far it is.
    hangs_on
        Of a fleet: whether it is worked out what the answer hangs on. Of a single robot it always is.
    decisions
        A decisions file.
    today
        ISO date on which decisions are valid or expired; None for the date of now (or ``SOURCE_DATE_EPOCH``).
    """

    add: tuple[str, ...] = ()
    view: str = View.declared
    categories: tuple[str, ...] = ()
    article9: bool = False
    article9_level: str | None = None
    data_types: tuple[str, ...] = ()
    identity_factors: tuple[str, ...] = ()
    ontologies: tuple[str, ...] = ()
    category: str = TOP
    standard_channels: str | None = STANDARD
    types: tuple[str, ...] = ()
    type_limits: str | None = TABLE
    paths: str = Paths.witness
    max_paths: int = MAX_PATHS
    hangs_on: bool = False
    include_root: str | None = None
    max_bytes: int = MAX_BYTES
    domain: int | None = None
    allow_unsigned: bool = False
    permissions_ca: tuple[str, ...] = ()
    bounds: Bounds = BOUNDS
    progress: Callable[[Sequence[str]], Iterable[str]] = field(default=lambda files: files)
    decisions: str | None = None
    today: str | None = None

    def __post_init__(self) -> None:
        """Refuse modes that there are not; one name where several may stand is a list of one."""
        View(self.view)
        Paths(self.paths)
        if self.article9_level is not None:
            Article9Level(self.article9_level)
            object.__setattr__(self, "article9", True)
        for name in ("add", "categories", "data_types", "identity_factors", "ontologies", "permissions_ca", "types"):
            if isinstance(getattr(self, name), str):
                object.__setattr__(self, name, (getattr(self, name),))
