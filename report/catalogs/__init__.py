"""The words of all outputs for people: a catalogue for each language, and what puts values into its sentences."""

LANGUAGES = ("en", "de", "fr")
