"""The functions that people call from Python: what they name -> a ``Result``, or labels from memory.

In: names of files, texts, choices; of all lists one item alone may be given. Out: a ``Result``, ``Labels``.
"""

from __future__ import annotations

from dataclasses import replace
from os import PathLike, fspath
from typing import TYPE_CHECKING, Any, overload

from rosprivacy.analysis.errors import InputError
from rosprivacy.ingest.labels import label_file
from rosprivacy.ingest.labels.label_file import Labels
from rosprivacy.ontology.vocabulary import TOP, load
from rosprivacy.settings import FleetOptions, RobotOptions, Settings, several
from rosprivacy.systems.fleet_system import answer_fleet
from rosprivacy.systems.robot_system import answer_robot

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from rosprivacy.analysis.python_311 import Unpack
    from rosprivacy.explorer.session import FleetSession, Session
    from rosprivacy.labelling.suggesting import Suggested
    from rosprivacy.result import Result
    from rosprivacy.settings import Path, Paths


def analyze(
    policies: Paths = (),
    labels: Path | Labels | Iterable[Path | Labels] = (),
    **options: Unpack[RobotOptions],
) -> Result:
    """Analyse SROS 2 policies under label files.

    Wherever several may be named, one alone may stand without a list.

    Parameters
    ----------
    policies
        Files, folders and globs.
    labels
        Label files, YAML or JSON, or the paper's JSON with six lists; or labels from ``parse_labels``.
    **options
        See ``rosprivacy.settings.Options`` and ``RobotOptions``.

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
    return answer_robot(several(policies), _labels(labels), Settings.of(options))


def analyze_fleet(file: Path, **options: Unpack[FleetOptions]) -> Result:
    """Analyse the robots of a fleet file together.

    Parameters
    ----------
    file
        Fleet file, YAML or JSON; it names policies and labels.
    **options
        See ``rosprivacy.settings.Options`` and ``FleetOptions``.

    Returns
    -------
    Result
        With ``fleet``: which robots are alike, and what they have in common. In the graph one robot stands for all
        that are alike.

    Raises
    ------
    InputErrors
        With every problem of the input, one line each.
    TypeError
        For ``add`` and ``types``: a fleet file names them.

    Examples
    --------
    >>> fleet = analyze_fleet("examples/fleet/fleet.yaml").fleet
    >>> sum(map(fleet.likeness.weight, fleet.likeness.members))
    40
    """
    if named := options.keys() & RobotOptions.__annotations__.keys() - FleetOptions.__annotations__.keys():
        raise TypeError(f"a fleet file names these itself: {', '.join(sorted(named))}")
    return answer_fleet(fspath(file), Settings.of(options))


def suggest(
    policies: Paths = (),
    labels: Path | Labels | Iterable[Path | Labels] = (),
    *,
    rules: Paths = (),
    packages: Paths = (),
    sources: Paths = (),
    libraries: Paths = (),
    types: Paths = (),
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
    types
        Files of message types, as those of ``analyze``; beside those of ``settings``.
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
    from rosprivacy.labelling.by_type_lines import with_offer  # noqa: PLC0415 - light start
    from rosprivacy.labelling.knowledge import UserFiles  # noqa: PLC0415
    from rosprivacy.labelling.suggesting import suggest_labels  # noqa: PLC0415

    files = UserFiles(several(rules), several(packages), several(sources), several(libraries))
    settings = settings or Settings()
    settings = replace(settings, types=(*settings.types, *several(types)))
    return with_offer(suggest_labels(several(policies), _labels(labels), settings, files), settings)


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
    files = UserFiles(several(rules), several(packages), several(sources), several(libraries))
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
    from rosprivacy.explorer.session import Session  # noqa: PLC0415 - light start

    if fleet is not None:
        named = (*several(policies), *_labels(labels))
        if named:
            hint = "leave policies and labels away: the fleet file names them"
            raise InputError(fspath(fleet), 0, "is a fleet, and other files are named beside it", hint)
        return Session.open_fleet(fspath(fleet), settings)
    return Session.open(several(policies), _labels(labels), settings)


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
    return label_file.parse_labels(text, load(ontologies=several(ontologies)), name=name, category=category)


def _labels(labels: Path | Labels | Iterable[Path | Labels]) -> tuple[str | Labels, ...]:
    several = [labels] if isinstance(labels, str | PathLike | Labels) else labels
    return tuple(one if isinstance(one, Labels) else fspath(one) for one in several)
