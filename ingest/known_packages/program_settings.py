"""Settings of well-known bridges and recorders, as they ship: ``ontology/channel_settings.yaml``.

In: the shipped file. Out: ``Program``s, each of a package of the catalogue, with what was read.
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import PackageError
from rosprivacy.analysis.mitigation.channel_settings import ChannelSetting, Program, SettingSource
from rosprivacy.ingest.reading import yaml_values
from rosprivacy.ingest.reading.format_reader import FileReader
from rosprivacy.ontology.vocabulary import FOLDER

if TYPE_CHECKING:
    from rosprivacy.ingest.reading.yaml_values import Value

FILE = "channel_settings.yaml"
KEYS = ("channel_settings", "version", "programs")
PROGRAM_KEYS = ("package", "node", "is", "settings", "sources")
SETTING_KEYS = ("channels", "in", "do", "write", "names", "each", "between", "from_root", "note")
SOURCE_KEYS = ("at", "commit", "files", "read")


@cache
def programs() -> tuple[Program, ...]:
    """Read the shipped file.

    >>> [setting.text for setting in programs()[0].settings][0]
    "topic_whitelist: ['(?!({names})$).*']"
    """
    name = f"rosprivacy:{FILE}"
    top, _ = yaml_values.read_shipped(str(FOLDER / FILE), PackageError, name)
    reader = FileReader(name, error=PackageError)
    reader.version(top, "channel_settings", "channel settings")
    values = reader.values_of(top, KEYS)["programs"].items
    return reader.whole(tuple(_program(reader, reader.values_of(value, PROGRAM_KEYS)) for value in values))


def _program(reader: FileReader, values: dict[str, Value]) -> Program:
    settings = (reader.values_of(value, SETTING_KEYS) for value in values["settings"].items)
    sources = (reader.values_of(value, SOURCE_KEYS) for value in values["sources"].items)
    return Program(
        values["package"].text,
        values["node"].text,
        values["is"].text,
        tuple(_setting({key: value.text for key, value in one.items()}) for one in settings),
        tuple(
            SettingSource(
                one["at"].text, one["commit"].text, tuple(file.text for file in one["files"].items), one["read"].text
            )
            for one in sources
        ),
    )


def _setting(texts: dict[str, str]) -> ChannelSetting:
    return ChannelSetting(
        texts["channels"], texts["in"], texts["do"], texts["write"], texts["names"], texts.get("each", "{name}"),
        texts["between"], texts.get("from_root", "true") == "true", texts.get("note", ""),
    )  # fmt: skip
