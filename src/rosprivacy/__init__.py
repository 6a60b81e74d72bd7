"""Where personal data can go in a ROS 2 system: SROS 2 policies and labels in, leak paths per category out.

>>> import rosprivacy
>>> result = rosprivacy.analyze(["examples/factory/before.policy.xml"], ["examples/factory/run2.labels.yaml"])
>>> str(result.analysis.verdict)
'leak'

The heavy parts are imported when they are used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.version import __version__

if TYPE_CHECKING:
    from collections.abc import Iterable
    from typing import Any

    from rosprivacy.result import Result

__all__ = ["__version__", "analyze", "analyze_fleet"]


def analyze(policies: Iterable[str], labels: Iterable[str] = (), **options: Any) -> Result:
    """Analyse SROS 2 policies under label files.

    Parameters
    ----------
    policies
        Files, folders and globs.
    labels
        Label files, YAML or JSON, or the paper's JSON with six lists.
    **options
        Fields of ``rosprivacy.settings.Settings``.

    Returns
    -------
    Result
        The analysis, and what it rests on.

    Raises
    ------
    InputErrors
        With every problem of the input, one line each.
    """
    from rosprivacy.assembly import run  # noqa: PLC0415 - light start
    from rosprivacy.settings import Settings  # noqa: PLC0415 - light start

    return run(tuple(policies), tuple(labels), Settings(**options))


def analyze_fleet(file: str, **options: Any) -> Result:
    """Analyse the robots of a fleet file together.

    Parameters
    ----------
    file
        Fleet file, YAML or JSON.
    **options
        Fields of ``rosprivacy.settings.Settings``.

    Returns
    -------
    Result
        With ``fleet``: which robots are alike, and what they have in common. In the graph one robot stands for all
        that are alike.

    Raises
    ------
    InputErrors
        With every problem of the input, one line each.
    """
    from rosprivacy.fleets import run_fleet  # noqa: PLC0415
    from rosprivacy.settings import Settings  # noqa: PLC0415 - light start

    return run_fleet(file, Settings(**options))
