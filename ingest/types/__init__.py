"""Message types that were observed: their file, and how it is joined to a graph (rules S15, S16)."""

TABLE = "rosprivacy:types"  # the shipped table of types, as a report names it
