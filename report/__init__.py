"""The answer, for a reader: an ``Analysis`` in, text or JSON out. Nothing here decides anything."""
