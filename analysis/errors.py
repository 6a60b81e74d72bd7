"""The error tree. Factored out so that every room can raise without importing another.

A message is one line, ``file:line: what is wrong; what to do``, without a line where there is none; the
command line turns errors into exit codes::

    RosPrivacyError
      InputErrors          all problems of an input at once
      InputError           one problem at one place
        PolicyError
        LabelError
        LimitsError
        TypesError
        PackageError
        DecisionError
        FleetError
        OntologyError
        GraphError
        BagError
        ObservationError
      QueryError
      DrawingError
      DatabaseError
      ClusterError
      MiddlewareError
      ModelError
"""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

from rosprivacy.analysis.text import cut, printable

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

LONGEST_SHOWN = 200


def shown(text: str) -> str:
    r"""Return text fit for one line of a message: nothing unprintable, nothing endless.

    >>> shown("/a" + chr(10) + "b")
    '/a\\nb'
    """
    return cut(printable(text), LONGEST_SHOWN)


def reason(error: Exception) -> str:
    """Return why the system refused a file, fit for a message: its own words where it has some.

    >>> reason(PermissionError(13, "Permission denied")), reason(ValueError("embedded null byte"))
    ('Permission denied', 'embedded null byte')
    """
    return shown(getattr(error, "strerror", None) or str(error))


class RosPrivacyError(Exception):
    """Base of all errors that this program raises on purpose."""

    exit_code = 2


class InputError(RosPrivacyError):
    """One problem at one place of an input file.

    Parameters
    ----------
    file
        As the user named it, or the file that it includes.
    line
        1 for the first; 0 where the problem has no line.
    problem
        What is wrong.
    hint
        What to do.
    """

    def __init__(self, file: str, line: int, problem: str, hint: str) -> None:
        self.file = file
        self.line = line
        self.problem = problem
        self.hint = hint
        where = shown(file) or repr(file)
        super().__init__(f"{where}:{line}: {problem}; {hint}" if line else f"{where}: {problem}; {hint}")

    def __reduce__(self) -> tuple[type[InputError], tuple[str, int, str, str]]:
        """Return what it is made of again, where it comes from another process."""
        return type(self), (self.file, self.line, self.problem, self.hint)


class PolicyError(InputError):
    """A policy that cannot be read, or that sros2 would refuse."""


class LabelError(InputError):
    """A label file that cannot be read, contradicts itself, or names what is not there (S11)."""


class LimitsError(InputError):
    """A limits file that cannot be read, or that names what is not there."""


class TypesError(InputError):
    """A file of message types, or of what they cannot carry, that cannot be read."""


class PackageError(InputError):
    """A file that says what a package's nodes do with data, and that cannot be read."""


class DecisionError(InputError):
    """A decisions file that cannot be read, or that contradicts itself."""


class FleetError(InputError):
    """A fleet file that cannot be read."""


class OntologyError(InputError):
    """An ontology file that cannot be read, or a category that it does not have."""


class GraphError(InputError):
    """A saved graph that cannot be read."""


class BagError(InputError):
    """A bag (a recording of ROS messages) that cannot be read."""


class ObservationError(InputError):
    """What was seen of a running system cannot be read, or cannot be looked at with what is installed."""


class InputErrors(RosPrivacyError):  # noqa: N818 - it is several
    """All problems of the input at once, in the order of file and line."""

    def __init__(self, errors: Iterable[InputError]) -> None:
        distinct = {str(error): error for error in errors}.values()
        self.errors = tuple(sorted(distinct, key=lambda e: (e.file, e.line, str(e))))
        super().__init__("\n".join(str(error) for error in self.errors))

    def __reduce__(self) -> tuple[type[InputErrors], tuple[tuple[InputError, ...]]]:
        """Return what it is made of again, where it comes from another process."""
        return type(self), (self.errors,)


@contextmanager
def noting(problems: list[InputError]) -> Iterator[None]:
    """Note what is wrong with a part of the input, and go on with the next part.

    Examples
    --------
    >>> problems: list[InputError] = []
    >>> with noting(problems):
    ...     raise PolicyError("a.xml", 1, "not XML", "correct it")
    >>> [error.file for error in problems]
    ['a.xml']
    """
    try:
        yield
    except InputError as error:
        problems.append(error)
    except InputErrors as error:
        problems += error.errors


class QueryError(RosPrivacyError):
    """A query that is wrong, unknown, or refused by the server."""


class DrawingError(RosPrivacyError):
    """A picture that cannot be made: nothing to draw it with, or nothing of that name to draw."""


class DatabaseError(RosPrivacyError):
    """A database that cannot be reached or does not answer."""

    exit_code = 3


class ClusterError(RosPrivacyError):
    """A cluster that cannot be reached, or on which something fails."""

    exit_code = 3


class MiddlewareError(RosPrivacyError):
    """A running ROS system that cannot be reached, or that does not answer."""

    exit_code = 3


class ModelError(RosPrivacyError):
    """A language model whose server cannot be reached, or does not answer as such servers do."""

    exit_code = 3
