"""A graph that is cut into parts: what one part knows goes in, out comes what all of them say together."""
