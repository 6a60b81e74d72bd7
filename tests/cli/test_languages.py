"""Which commands speak the reader's language, and which still speak English only: a list that has to be kept true."""

from __future__ import annotations

from typer.main import get_command

from rosprivacy.cli.app import program

STILL_ENGLISH = {
    "annotations": "a label file, and what is wrong with code",
    "bag": "what is in recordings",
    "check": "rights, with lines of files",
    "lint": "rules for those who write policies",
    "db": "a server",
    "decide": "what was recorded",
    "decisions": "what was recorded",
    "diff": "what changed; 'report --since' tells it in a language",
    "fleet": "which robots are alike",
    "help": "the words of label files, which are English",
    "init": "which files were written",
    "labels": "review lists and label files",
    "load": "counts",
    "mitigate": "proposals; the report tells them in a language",
    "observe": "what was written",
    "scan": "what code makes, with lines of files",
    "try": "questions for a label file, as of suggest",
    "suggest": "questions for a label file, whose words are English",
    "query": "rows of a database, with the heads of the queries",
    "unload": "counts",
    "why-not": "the answer",
}
# Where there is '--lang', messages about files and of errors stay English, as does the note of a very large layout.


def test_every_command_that_prints_an_answer_takes_a_language_or_is_listed() -> None:
    commands = get_command(program()).commands  # type: ignore[attr-defined]
    speak = {name for name, command in commands.items() if any(one.name == "lang" for one in command.params)}
    assert speak == {"analyze", "categories", "explore", "graph", "law", "report", "show"}
    assert commands.keys() - speak == STILL_ENGLISH.keys()
