"""One question per ``.cypher`` file, and what reads, checks and runs them.

In: a driver, the name of a question with its parameters, or Cypher of the user's own. Out: rows.
"""
