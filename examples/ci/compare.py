"""What changes between two reports of ``rosprivacy analyze --format json``, as Markdown for a comment.

Copy to ``.github/compare.py``. It needs Python only. Findings are the same as long as category, source and leak are;
names come from anybody's files, so they are shown as code and can neither link nor mention anybody.

Usage: python compare.py before.json after.json
"""

import json
import re
import sys
from pathlib import Path

SHOWN = 20  # findings of a list; a comment has a limit
LONGEST = 120  # characters of a name


def main(before_file: str, after_file: str) -> None:
    """Print the comment."""
    before, after = (json.loads(Path(file).read_text("utf-8")) for file in (before_file, after_file))
    print("\n".join(comment(before, after)))


def comment(before: dict, after: dict) -> list:
    """Return the lines of the comment."""
    old, new = findings(before), findings(after)
    appeared = [new[key] for key in new if key not in old]
    gone = [old[key] for key in old if key not in new]
    lines = ["### Where personal data can go", ""]
    if not appeared and not gone:
        lines.append(f"No path to assess is new or gone; there are {len(new)}.")
    lines += listed("New paths to assess", appeared)
    lines += listed("Gone", gone)
    lines += ["", f"Elements not reviewed: {len(before['open'])} before, {len(after['open'])} now."]
    lines += [f"Verdict: {code(before['verdict'])} before, {code(after['verdict'])} now."]
    return [*lines, "", "Labels are a person's word; this is no legal verdict."]


def findings(report: dict) -> dict:
    """Return findings by id, without those that others cover and those that were accepted."""
    open_ones = (f for f in report["findings"] if not f["dismissed"] and not f.get("accepted"))
    return {finding["id"]: finding for finding in open_ones}


def listed(title: str, found: list) -> list:
    """Return a heading and one line per finding."""
    if not found:
        return []
    lines = ["", f"**{title}: {len(found)}**", ""]
    for finding in found[:SHOWN]:
        form = "pseudonymised " if finding["pseudonymised"] else ""
        what = f"{code(form + finding['category'])}: {name(finding['source'])} → {name(finding['leak'])}"
        lines.append(f"- {what}{where(finding)}")
    if len(found) > SHOWN:
        lines.append(f"- and {len(found) - SHOWN} more")
    return lines


def where(finding: dict) -> str:
    """Return the policy line that lets the data into the leak."""
    lines = [line for step in finding["steps"][-1:] for line in step["policy"]]
    return f", allowed at {code('{file}:{line}'.format(**lines[0]))}" if lines else ""


def name(element: dict) -> str:
    """Return an element's name as code."""
    robot = f"{element['robot']}:" if element["robot"] else ""
    return code(f"{robot}{element['name']}")


def code(text: str) -> str:
    """Return text as code that cannot end early: printable, short, with no backtick in it."""
    plain = "".join(character if character.isprintable() else "?" for character in text).replace("`", "'")
    plain = re.sub(r"\s+", " ", plain).strip() or "?"
    return f"`{plain[:LONGEST]}{'…' if len(plain) > LONGEST else ''}`"


if __name__ == "__main__":
    main(*sys.argv[1:])
