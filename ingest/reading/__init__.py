"""Files of anybody in, out come values that know their line, or every problem at its line."""
