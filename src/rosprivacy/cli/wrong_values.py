"""A value that an option does not take, or an option that is gone -> one line that says what to write instead.

In: typer's error. Out: the same with a message of ours; typer's own lists the values, and names none as the nearest.
"""

from __future__ import annotations

import re

import typer

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.written_names import did_you_mean, nearest
from rosprivacy.cli.exit_code import REMOVED_OPTIONS, REMOVED_VALUES

LISTED = re.compile(r"(?:Value error, )?'(?P<given>.*?)' is not one of (?P<values>'.*')\.?")


def with_nearest(error: typer.BadParameter) -> typer.BadParameter:
    """Name the nearest value, or what stands for a word of an earlier version."""
    if told := LISTED.fullmatch(error.message):
        values, given = re.findall("'([^']*)'", told["values"]), told["given"]
        hint = did_you_mean(nearest(given.casefold(), values), f"one of {', '.join(values)}")
        option = error.param.name if error.param else ""
        if option == "fail_on" and "undetermined" in values and given in REMOVED_VALUES:
            hint = REMOVED_VALUES[given]
        error.message = f"{shown(given)!r} is not one of its values; {hint}"
    return error


def removed_option(error: Exception) -> typer.BadParameter | None:
    """Return what to write for an option of an earlier version; None for any other error.

    Typer exports no name for the error of an unknown option.
    """
    option = getattr(error, "option_name", "")
    hint = REMOVED_OPTIONS.get(option)
    return typer.BadParameter(f"there is no {option} any more; {hint}") if hint else None
