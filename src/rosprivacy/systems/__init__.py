"""Names of files, or a database, in; out come a ``System`` (robot, fleet, what is stored) and the answer about it."""
