"""``rosprivacy analyze``: where each kind of data can get, and an exit code for CI."""

from __future__ import annotations

from rosprivacy.cli.answer_command import Asked, Computed, FailsOn, PerPolicy, SaveGraph, Written, answer
from rosprivacy.cli.exit_code import FailOn
from rosprivacy.cli.inputs import Inputs, reads_system


@reads_system()
def analyze(
    inputs: Inputs,
    asked: Asked,
    computed: Computed,
    written: Written,
    per_policy: PerPolicy = False,
    save_graph: SaveGraph = None,
    fail_on: FailsOn = None,
) -> None:
    """Find where each kind of personal data can get from its sources, and whether it reaches a leak."""
    fails = tuple(fail_on or (FailOn.undetermined,))
    form = written.format or "text"
    answer(inputs, asked, computed, written, form, fails, per_policy=per_policy, save_graph=save_graph)
