"""A file of rules, shipped or of a user: its YAML values and its hash."""

from __future__ import annotations

import hashlib
from functools import partial
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, InputErrors
from rosprivacy.ingest.reading import yaml_values
from rosprivacy.ontology.vocabulary import FOLDER

if TYPE_CHECKING:
    from rosprivacy.analysis.bounds import Bounds
    from rosprivacy.ingest.reading.yaml_values import Value


def read_rule_text(file: str, shipped: str, ships: str, bounds: Bounds) -> tuple[Value, str]:
    """Return what a file of rules holds, and its SHA-256.

    Parameters
    ----------
    shipped
        What the shipped file is called.
    ships
        Its name in the ontology's folder.

    Raises
    ------
    InputErrors
        If it cannot be read.
    """
    try:
        if file == shipped:
            top, data = yaml_values.read_shipped(str(FOLDER / ships), InputError, file)
        else:
            top, data = yaml_values.read(file, partial(InputError, file), bounds)
    except InputError as error:
        raise InputErrors([error]) from None
    return top, hashlib.sha256(data).hexdigest()
