"""Proposals of labels in, out come a table for the terminal and the JSON document."""
