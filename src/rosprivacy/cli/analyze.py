"""``rosprivacy analyze``: where each kind of data can get, and an exit code for CI."""

from __future__ import annotations

from rosprivacy.cli.answer_command import Asked, Computed, Written, answer
from rosprivacy.cli.exit_code import FailOn
from rosprivacy.cli.inputs import Inputs, reads_system


@reads_system()
def analyze(inputs: Inputs, question: Asked, computed: Computed, written: Written) -> None:
    """Find where each kind of personal data can get from its sources, and whether it reaches a leak."""
    answer(inputs, question, computed, written, written.format or "text", FailOn.undetermined)
