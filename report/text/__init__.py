"""A JSON document in, out come lines of text, for a terminal or a file."""
