"""The words of all outputs for people, in English, German and French: a key and values in, out comes plain text."""

LANGUAGES = ("en", "de", "fr")
