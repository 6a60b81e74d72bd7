"""``rosprivacy help``: the words of the program on one screen, or the help of a command."""

from __future__ import annotations

from typing import Annotated

import typer

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.written_names import did_you_mean, nearest

WORDS = {
    "source": "brings personal data into the robot, such as a camera",
    "leak": "a way out, wanted or not: it keeps, shows or sends data on",
    "conduit": "passes on what it gets, and does nothing else with it",
    "sanitizer": "takes a kind of data out, or the persons out of it",
    "derives": "makes another kind of data, as a face detector does",
    "sensitive": "of a channel: it can carry such data",
    "mundane": "of a channel: it cannot carry such data",
    "absent": "in the policy, and not on the robot",
    "open": "data gets there, and nobody has said what becomes of it",
    "leg": "one direction of a service or an action, such as the request",
    "declared": "what each node's own profile allows",
    "enforced": "what DDS allows its enclave, whose nodes share their rights",
    "finding": "data of a kind can get from a source to a leak, and by which way",
    "hangs on": "a statement without which the answer would be another one",
    "taken away": "data ends there: by a sanitizer, a mundane channel or a type",
    "made up": "no policy says it: an observed node gets its own enclave",
    "undetermined": "something is open, unread or in doubt: this is no all-clear",
}
TOPIC = "words"


def help_topic(
    topic: Annotated[str, typer.Argument(metavar="words|COMMAND", help="What to explain.")] = TOPIC,
) -> None:
    """Explain the words of the program on one screen, or a command."""
    from rosprivacy.cli.app import COMMANDS, program

    if topic in COMMANDS:
        program(topic)([topic, "--help"])
    if topic != TOPIC:
        known = [TOPIC, *COMMANDS]
        hint = did_you_mean(nearest(topic, known), f"one of {', '.join(known)}")
        raise typer.BadParameter(f"nothing is explained under {shown(topic)!r}; {hint}", param_hint="words|COMMAND")
    width = max(map(len, WORDS))
    for word, meaning in WORDS.items():
        print(f"{word:{width}}  {meaning}")
