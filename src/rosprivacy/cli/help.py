"""How help is shown: the commands in groups, in the order of a user's way; flags without the name of a type.

What is wrong in a command's words is told with what to write instead.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import typer
from typer.core import TyperGroup

from rosprivacy.cli.exit_code import SIGPIPE

if TYPE_CHECKING:
    from collections.abc import Iterable

BEGIN = "Begin"
OBSERVE = "Observe"
LABEL = "Label"
ANALYSE = "Analyse"
SEE = "See"
DECIDE = "Decide"
MANY = "Fleet and database"


class HelpGroup(TyperGroup):
    """Commands whose flags are shown without ``<bool>``."""

    def get_params(self, ctx: Any) -> list[Any]:
        """Return the options of the group itself."""
        return _untyped(super().get_params(ctx))

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """Return a command of the group, if there is one of that name."""
        command = super().get_command(ctx, cmd_name)
        if command is not None:
            _untyped(command.get_params(ctx))
        return command

    def invoke(self, ctx: Any) -> Any:
        """Read the words of a command and run it.

        Typer ends with 1, which says 'leak', where a pipe is closed and where input ends: what reads standard error may
        be gone, and no command asks anything.
        """
        try:
            return super().invoke(ctx)
        except typer.Exit:  # an exit code is no error
            raise
        except typer.BadParameter as error:
            from rosprivacy.cli.wrong_values import with_nearest

            raise with_nearest(error) from None
        except BrokenPipeError:
            raise typer.Exit(128 + SIGPIPE) from None
        except EOFError as error:
            raise RuntimeError("the input ended") from error
        except Exception as error:
            from rosprivacy.cli.wrong_values import removed_option

            if refusal := removed_option(error):
                raise refusal from None
            raise


def _untyped(parameters: Iterable[Any]) -> list[Any]:
    """A flag takes no value; an empty name of it leaves the type out."""
    parameters = list(parameters)
    for parameter in parameters:
        if getattr(parameter, "is_flag", False):
            parameter.metavar = ""
    return parameters
