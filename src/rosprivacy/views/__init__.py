"""Both views beside each other: files and settings in, out comes what the enforced one adds and what ends it (S6)."""
