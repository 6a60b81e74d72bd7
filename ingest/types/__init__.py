"""Message types that were observed: their file, and how it is joined to a graph (rules S15, S16)."""
