"""A JSON document in, out come lines for the terminal."""
