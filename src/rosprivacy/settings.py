"""How to read and what to ask: what the options of the command line mean to the library, each told once.

In: ``Options``, as a person names them in Python; wherever several may be named, one alone may stand without a list.
Out: ``Settings``, plain and complete.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from os import PathLike, fspath
from typing import Any, Literal, TypeAlias, TypedDict

from rosprivacy.analysis.bounds import BOUNDS, Bounds
from rosprivacy.analysis.findings.findings import MAX_PATHS
from rosprivacy.analysis.modes import Article9Level, View
from rosprivacy.analysis.modes import Paths as PathsListed
from rosprivacy.ingest.labels.label_file import STANDARD
from rosprivacy.ingest.types import TABLE
from rosprivacy.ontology.vocabulary import TOP

Path: TypeAlias = str | PathLike[str]
Names: TypeAlias = str | Iterable[str]
Paths: TypeAlias = Path | Iterable[Path]


class Options(TypedDict, total=False):
    """What ``analyze`` and ``analyze_fleet`` may be told by name.

    Attributes
    ----------
    view
        ``declared``: each node does what its own profile says; ``enforced``: what DDS holds its enclave to (rule S6).
    categories
        Answer for these, narrower, broader and overlapping ones only; empty for all.
    article9
        Answer only for what can fall under Article 9(1) GDPR, or of which that is not known.
    article9_level
        The same up to a level, which implies ``article9``: ``always``, ``conditional`` (that too), ``may-reveal`` (as
        ``article9`` alone).
    data_types
        Answer only for data that are represented so, such as ``video``; empty for all.
    identity_factors
        Answer only for data that tell of these factors of a person's identity (Article 4(1)), such as ``economic``;
        empty for all.
    ontologies
        Turtle files with more categories, beside those that come with the program.
    category
        What the paper's six lists are about.
    standard_channels
        Label file of the standard ROS channels; None to take no channel as mundane by itself (rule S13).
    type_limits
        Table of what message types cannot carry; None to take each to carry everything (rule S15).
    paths
        Further paths to list for each finding: none beside the ``witness``, ``disjoint`` ones, or ``all``.
    max_paths
        Bound on the listed paths of a finding.
    decisions
        File of what people have decided about findings.
    today
        Day on which decisions hold or have expired, ``YYYY-MM-DD``; by default that of now, or of
        ``SOURCE_DATE_EPOCH``.
    domain
        DDS domain of the robot, for permissions with rules for several.
    allow_unsigned
        Read permissions and governance that are not signed by their CA too.
    permissions_ca
        Certificates, or their SHA-256 fingerprints, of the CAs that may have signed what is read; by default each
        keystore names its own.
    include_root
        Folder that includes may read from; by default the policy's own.
    bounds
        On what an input can press: ``Bounds(robots=500_000)``.
    progress
        Wraps the list of files that are read, to show how far it is.
    """

    view: View | Literal["declared", "enforced"]
    categories: Names
    article9: bool
    article9_level: Article9Level | Literal["always", "conditional", "may-reveal"] | None
    data_types: Names
    identity_factors: Names
    ontologies: Paths
    category: str
    standard_channels: Path | None
    type_limits: Path | None
    paths: Literal["witness", "disjoint", "all"]
    max_paths: int
    decisions: Path | None
    today: str | None
    domain: int | None
    allow_unsigned: bool
    permissions_ca: Paths
    include_root: Path | None
    bounds: Bounds
    progress: Callable[[Sequence[str]], Iterable[str]]


class RobotOptions(Options, total=False):
    """What ``analyze`` may be told by name.

    Attributes
    ----------
    add
        Saved graphs to add the policies to.
    types
        Files of observed message types, as ``rosprivacy observe`` writes them (rule S15).
    """

    add: Paths
    types: Paths


class FleetOptions(Options, total=False):
    """What ``analyze_fleet`` may be told by name.

    Attributes
    ----------
    hangs_on
        Whether to work out what the answer hangs on, which takes longer; else ``Result.hangs_on`` is None. Of a single
        robot it always is.
    """

    hangs_on: bool


@dataclass(frozen=True, slots=True)
class Settings:
    """How to read and what to ask: each field as in ``Options``, with files as text and lists as tuples.

    ``project`` is the (name, SHA-256) of the project file that names what is read, if one does.

    Raises
    ------
    InputErrors
        If a mode is none of those that there are.
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
    paths: str = PathsListed.witness
    max_paths: int = MAX_PATHS
    hangs_on: bool = False
    include_root: str | None = None
    domain: int | None = None
    allow_unsigned: bool = False
    permissions_ca: tuple[str, ...] = ()
    bounds: Bounds = BOUNDS
    progress: Callable[[Sequence[str]], Iterable[str]] = field(default=lambda files: files)
    decisions: str | None = None
    today: str | None = None
    project: tuple[str, str] | None = None

    def __post_init__(self) -> None:
        """Refuse modes that there are not; one name where several may stand is a list of one."""
        View(self.view)
        PathsListed(self.paths)
        if self.article9_level is not None:
            Article9Level(self.article9_level)
            object.__setattr__(self, "article9", True)
        for name in SEVERAL:
            object.__setattr__(self, name, several(getattr(self, name)))
        for name in FILES:
            value = getattr(self, name)
            object.__setattr__(self, name, value if value is None else fspath(value))

    @classmethod
    def of(cls, options: Mapping[str, Any]) -> Settings:
        """Return the settings that options mean; ``TypeError`` for one that there is not."""
        return cls(**options)


SEVERAL = ("add", "categories", "data_types", "identity_factors", "ontologies", "permissions_ca", "types")
FILES = ("standard_channels", "type_limits", "decisions", "include_root")


def several(names: Paths) -> tuple[str, ...]:
    """Return names, or one name, as a tuple of texts.

    >>> several("a"), several(["a", "b"])
    (('a',), ('a', 'b'))
    """
    return tuple(fspath(name) for name in ([names] if isinstance(names, str | PathLike) else names))
