"""Systems that run: what doors see in, out come policies and types of channels, or findings as they come (S16)."""
