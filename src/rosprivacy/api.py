"""The functions that people call from Python: what they name -> a ``Result``, or labels from memory.

In: names of files, texts, choices; of all lists one item alone may be given. Out: a ``Result``, ``Labels``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from os import PathLike, fspath
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, overload

from rosprivacy.analysis.bounds import BOUNDS, Bounds
from rosprivacy.analysis.errors import InputError
from rosprivacy.analysis.findings.findings import MAX_PATHS
from rosprivacy.ingest.labels import label_file
from rosprivacy.ingest.labels.label_file import STANDARD, Labels
from rosprivacy.ingest.policies.xinclude import MAX_BYTES
from rosprivacy.ingest.types import TABLE
from rosprivacy.ontology.vocabulary import TOP, load
from rosprivacy.reading.fleet_system import answer_fleet
from rosprivacy.reading.robot_system import answer_robot
from rosprivacy.settings import Settings

if TYPE_CHECKING:
    from rosprivacy.analysis.modes import Article9Level, View
    from rosprivacy.explorer.fleet_session import FleetSession
    from rosprivacy.explorer.session import Session
    from rosprivacy.labelling.suggesting import Suggested
    from rosprivacy.result import Result

Path: TypeAlias = str | PathLike[str]
Names: TypeAlias = str | Iterable[str]
Paths: TypeAlias = Path | Iterable[Path]


def analyze(
    policies: Paths = (),
    labels: Path | Labels | Iterable[Path | Labels] = (),
    *,
    view: View | Literal["declared", "enforced"] = "declared",
    categories: Names = (),
    article9: bool = False,
    article9_level: Article9Level | Literal["always", "conditional", "may-reveal"] | None = None,
    data_types: Names = (),
    identity_factors: Names = (),
    ontologies: Paths = (),
    category: str = TOP,
    standard_channels: Path | None = STANDARD,
    types: Paths = (),
    type_limits: Path | None = TABLE,
    paths: Literal["witness", "disjoint", "all"] = "witness",
    max_paths: int = MAX_PATHS,
    decisions: Path | None = None,
    today: str | None = None,
    add: Paths = (),
    domain: int | None = None,
    allow_unsigned: bool = False,
    permissions_ca: Paths = (),
    include_root: Path | None = None,
    max_bytes: int = MAX_BYTES,
    bounds: Bounds = BOUNDS,
    progress: Callable[[Sequence[str]], Iterable[str]] = iter,
) -> Result:
    """Analyse SROS 2 policies under label files.

    Wherever several may be named, one alone may stand without a list.

    Parameters
    ----------
    policies
        Files, folders and globs.
    labels
        Label files, YAML or JSON, or the paper's JSON with six lists; or labels from ``parse_labels``.
    view
        ``declared``: each node does what its own profile says; ``enforced``: what DDS holds its enclave to (rule S6).
    categories
        Answer for these, narrower, broader and overlapping ones only; empty for all.
    article9
        Answer only for what can fall under Article 9(1) GDPR, or of which that is not known.
    article9_level
        The same up to a level: ``always``, ``conditional`` (that too), ``may-reveal`` (as ``article9`` alone).
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
    types
        Files of observed message types, as ``rosprivacy observe`` writes them (rule S15).
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
    add
        Saved graphs to add the policies to.
    domain
        DDS domain of the robot, for permissions with rules for several.
    allow_unsigned
        Read permissions and governance that are not signed by their CA too.
    permissions_ca
        Certificates, or their SHA-256 fingerprints, of the CAs that may have signed what is read; by default each
        keystore names its own.
    include_root
        Folder that includes may read from; by default the policy's own.
    max_bytes
        Bound on a policy with all that it includes.
    bounds
        On what else an input can press: ``Bounds(robots=500_000)``.
    progress
        Wraps the list of files that are read, to show how far it is.

    Returns
    -------
    Result
        The analysis, and what it rests on.

    Raises
    ------
    InputErrors
        With every problem of the input, one line each.

    Examples
    --------
    >>> result = analyze("examples/care-home/care-home.policy.xml", "examples/care-home/care-home.labels.yaml")
    >>> result.analysis.emitted
    ('FaceTemplate', 'Location', 'PersonTrack', 'Video', 'Voice')
    """
    settings = Settings(
        add=_paths(add),
        types=_paths(types),
        view=view,
        categories=_several(categories),
        article9=article9,
        article9_level=article9_level,
        data_types=_several(data_types),
        identity_factors=_several(identity_factors),
        ontologies=_paths(ontologies),
        category=category,
        standard_channels=_path(standard_channels),
        type_limits=_path(type_limits),
        paths=paths,
        max_paths=max_paths,
        domain=domain,
        allow_unsigned=allow_unsigned,
        permissions_ca=_paths(permissions_ca),
        include_root=_path(include_root),
        max_bytes=max_bytes,
        bounds=bounds,
        progress=progress,
        decisions=_path(decisions),
        today=today,
    )
    return answer_robot(_paths(policies), _labels(labels), settings)


def analyze_fleet(
    file: Path,
    *,
    view: View | Literal["declared", "enforced"] = "declared",
    categories: Names = (),
    article9: bool = False,
    article9_level: Article9Level | Literal["always", "conditional", "may-reveal"] | None = None,
    data_types: Names = (),
    identity_factors: Names = (),
    ontologies: Paths = (),
    category: str = TOP,
    standard_channels: Path | None = STANDARD,
    type_limits: Path | None = TABLE,
    paths: Literal["witness", "disjoint", "all"] = "witness",
    max_paths: int = MAX_PATHS,
    hangs_on: bool = False,
    decisions: Path | None = None,
    today: str | None = None,
    domain: int | None = None,
    allow_unsigned: bool = False,
    permissions_ca: Paths = (),
    include_root: Path | None = None,
    max_bytes: int = MAX_BYTES,
    bounds: Bounds = BOUNDS,
    progress: Callable[[Sequence[str]], Iterable[str]] = iter,
) -> Result:
    """Analyse the robots of a fleet file together.

    Parameters
    ----------
    file
        Fleet file, YAML or JSON; it names policies and labels.
    view, categories, article9, article9_level, data_types, identity_factors, ontologies, category, standard_channels,
    type_limits, paths, max_paths, decisions, today
        As in ``analyze``.
    hangs_on
        Whether to work out what the answer hangs on, which takes longer; else ``Result.hangs_on`` is None.
    domain, allow_unsigned, permissions_ca, include_root, max_bytes, bounds, progress
        As in ``analyze``.

    Returns
    -------
    Result
        With ``fleet``: which robots are alike, and what they have in common. In the graph one robot stands for all
        that are alike.

    Raises
    ------
    InputErrors
        With every problem of the input, one line each.

    Examples
    --------
    >>> fleet = analyze_fleet("examples/fleet/fleet.yaml").fleet
    >>> sum(map(fleet.likeness.weight, fleet.likeness.members))
    40
    """
    settings = Settings(
        view=view,
        categories=_several(categories),
        article9=article9,
        article9_level=article9_level,
        data_types=_several(data_types),
        identity_factors=_several(identity_factors),
        ontologies=_paths(ontologies),
        category=category,
        standard_channels=_path(standard_channels),
        type_limits=_path(type_limits),
        paths=paths,
        max_paths=max_paths,
        hangs_on=hangs_on,
        domain=domain,
        allow_unsigned=allow_unsigned,
        permissions_ca=_paths(permissions_ca),
        include_root=_path(include_root),
        max_bytes=max_bytes,
        bounds=bounds,
        progress=progress,
        decisions=_path(decisions),
        today=today,
    )
    return answer_fleet(fspath(file), settings)


def suggest(
    policies: Paths = (),
    labels: Path | Labels | Iterable[Path | Labels] = (),
    *,
    rules: Paths = (),
    packages: Paths = (),
    sources: Paths = (),
    libraries: Paths = (),
    settings: Settings | None = None,
) -> Suggested:
    """Say what the elements of a robot could be labelled as: questions with reasons; nothing is applied.

    Parameters
    ----------
    policies
        Files, folders and globs.
    labels
        What is said already, and is not asked again.
    rules
        Files of rules about names, beside those that come with the program.
    packages
        Files of packages or folders of them, or ``ament`` for those that installed packages ship.
    sources
        Source code of nodes: names and types in it, and the libraries that it uses, are evidence.
    libraries
        Files of rules about libraries, beside those that come with the program.
    settings
        How to read, as ``rosprivacy.settings.Settings``; by default as ``analyze`` does.

    Returns
    -------
    Suggested
        With ``proposals``, in the order in which a person reviews them.

    Raises
    ------
    InputErrors
        With every problem of the input, one line each.

    Examples
    --------
    >>> told = suggest("examples/care-home/care-home.policy.xml", "examples/care-home/care-home.labels.yaml")
    >>> one = told.proposals[0]
    >>> one.label.element.name, one.label.role, one.label.kind, str(one.confidence)
    ('/recorder', 'leak', 'PersonalData', 'may')
    """
    from rosprivacy.labelling.knowledge import UserFiles  # noqa: PLC0415 - light start
    from rosprivacy.labelling.suggesting import suggest_labels  # noqa: PLC0415

    files = UserFiles(_paths(rules), _paths(packages), _paths(sources), _paths(libraries))
    return suggest_labels(_paths(policies), _labels(labels), settings or Settings(), files)


def suggest_fleet(
    file: Path,
    *,
    rules: Paths = (),
    packages: Paths = (),
    sources: Paths = (),
    libraries: Paths = (),
    settings: Settings | None = None,
) -> Suggested:
    """Say what the elements of a fleet could be labelled as; of robots that are alike one is asked about.

    Parameters
    ----------
    file
        Fleet file, YAML or JSON; it names policies and labels.
    rules, packages, sources, libraries, settings
        As in ``suggest``.

    Returns
    -------
    Suggested
        With ``proposals``; the robot is that of ``label.element``, and ``result.fleet.likeness`` says for which ones
        it stands.

    Raises
    ------
    InputErrors
        With every problem of the input, one line each.

    Examples
    --------
    >>> sorted({one.label.element.robot for one in suggest_fleet("examples/fleet/fleet.yaml").proposals})
    ['carrier_01', 'carrier_lent', 'cleaner_1', 'guide_01']
    """
    from rosprivacy.labelling.knowledge import UserFiles  # noqa: PLC0415 - light start
    from rosprivacy.labelling.suggesting import suggested  # noqa: PLC0415

    settings = settings or Settings()
    files = UserFiles(_paths(rules), _paths(packages), _paths(sources), _paths(libraries))
    return suggested(answer_fleet(fspath(file), settings), settings, files)


@overload
def explore(
    policies: Paths = (),
    labels: Path | Labels | Iterable[Path | Labels] = (),
    *,
    settings: Settings | None = None,
) -> Session: ...
@overload
def explore(*, fleet: Path, settings: Settings | None = None) -> FleetSession: ...
def explore(
    policies: Paths = (),
    labels: Path | Labels | Iterable[Path | Labels] = (),
    *,
    fleet: Path | None = None,
    settings: Settings | None = None,
) -> Session | FleetSession:
    """Begin a session: label elements, and see what follows from each label at once.

    Parameters
    ----------
    policies
        Files, folders and globs; they are read once.
    labels
        Label files. What is said goes to the first of them, when the session is saved; it need not be there yet.
    fleet
        A fleet file, in the place of both: it names policies and label files itself. Elements are then named with a
        robot, and what is said goes to the label file of its model, or to its own.
    settings
        How to read and what to ask, as ``rosprivacy.settings.Settings``; by default as ``analyze`` does.

    Returns
    -------
    Session or FleetSession
        With ``label``, ``undo``, ``questions()``, ``findings``, ``save()``.

    Raises
    ------
    InputErrors
        With every problem of the input, one line each.
    InputError
        If policies or labels are named beside a fleet file.

    Examples
    --------
    >>> session = explore("examples/factory/before.policy.xml", "examples/factory/run2.labels.yaml")
    >>> session.questions()[0].name
    '/robot_arm_control'
    >>> session.label("/robot_camera", conduit=True).closed
    ('dc5715a35ba5591a',)
    >>> hospital = explore(fleet="examples/fleet/fleet.yaml")
    >>> len(hospital.target("carrier_lent").robots), len(hospital.target("carrier_lent", only_this_robot=True).robots)
    (24, 1)
    """
    if fleet is not None:
        from rosprivacy.explorer.fleet_session import FleetSession  # noqa: PLC0415 - light start

        named = (*_paths(policies), *_labels(labels))
        if named:
            hint = "leave policies and labels away: the fleet file names them"
            raise InputError(fspath(fleet), 0, "is a fleet, and other files are named beside it", hint)
        return FleetSession.open_fleet(fspath(fleet), settings)
    from rosprivacy.explorer.session import Session  # noqa: PLC0415 - light start

    return Session.open(_paths(policies), _labels(labels), settings)


def parse_labels(
    text: str | Mapping[str, Any], *, name: str = "labels", ontologies: Paths = (), category: str = TOP
) -> Labels:
    """Read labels that stand in memory.

    Parameters
    ----------
    text
        What a label file holds: YAML, JSON, or the same as dicts and lists.
    name
        By which messages and reports call them, where a file's name would stand.
    ontologies
        Those with which they are analysed.
    category
        What the paper's six lists are about; of no effect on other labels.

    Returns
    -------
    Labels
        For ``analyze`` and ``Result.with_labels``.

    Raises
    ------
    InputErrors
        With every problem of the labels, each a ``LabelError`` of one line.

    Examples
    --------
    >>> labels = parse_labels({"labels": 1, "nodes": {"/camera": {"source": ["Video"]}}})
    >>> [entry.name for entry in labels.entries]
    ['/camera']
    """
    return label_file.parse_labels(text, load(ontologies=_paths(ontologies)), name=name, category=category)


def _several(names: Names) -> tuple[str, ...]:
    return (names,) if isinstance(names, str) else tuple(names)


def _path(path: Path | None) -> str | None:
    return None if path is None else fspath(path)


def _labels(labels: Path | Labels | Iterable[Path | Labels]) -> tuple[str | Labels, ...]:
    several = [labels] if isinstance(labels, str | PathLike | Labels) else labels
    return tuple(one if isinstance(one, Labels) else fspath(one) for one in several)


def _paths(paths: Paths) -> tuple[str, ...]:
    return tuple(fspath(path) for path in ([paths] if isinstance(paths, str | PathLike) else paths))
