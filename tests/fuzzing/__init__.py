"""Fuzzing: structured inputs for every reader, what must hold of each, and a record of what was tried.

``python -m tests.fuzzing --help`` runs it; ``docs/security.md`` says what must hold of each input, and what was
weighed.
"""
