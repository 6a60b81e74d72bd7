"""A language model that a user names: elements in, out comes what is sent to it, and what it answered, as data."""
