"""Decisions files in, out come decisions; a new decision in, out comes the file with it."""
