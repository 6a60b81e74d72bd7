"""Decisions and keys, with and without questions: ``python -m tests.decisions``; ``--keys`` shows what was pressed."""

from __future__ import annotations

import os
import sys
import tempfile
from pathlib import Path

from tests.decisions.counting import Count, asked, by_hand
from tests.decisions.truths import truths
from tests.helpers.paths import ROOT

CORPUS = Path(os.environ.get("ROSPRIVACY_CORPUS", ROOT.parent / "shared" / "corpus"))


def main() -> None:
    """Print one line for each system and way."""
    with tempfile.TemporaryDirectory() as folder:
        for truth in truths(CORPUS, Path(folder)):
            file = Path(folder) / "labels.yaml"
            hand = by_hand(truth)
            count, person = asked(truth, file)
            print(truth.name)
            print(f"  by hand   {_shown(hand)}")
            print(f"  asked     {_shown(count)}{'' if count.same else '; NOT the same answer'}")
            print(f"  ratio     decisions {count.decisions / hand.decisions:.2f}, keys {count.keys / hand.keys:.2f}")
            if "--keys" in sys.argv:
                print(f"  {''.join(person.keys)}", *person.remarks, sep="\n  ")
                print(file.read_text("utf-8"))


def _shown(count: Count) -> str:
    of = f"{count.taking_away} take data away, {count.typed} typed lines"
    lists = f"; lists of {', '.join(map(str, count.lists))}" if count.lists else ""
    return (
        f"{count.decisions} decisions ({of}), {count.keys} keys{lists}; {count.rows} rows shown, {count.judged} judged"
    )


if __name__ == "__main__":
    main()
