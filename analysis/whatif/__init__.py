"""What would be so if a label were not there: what it takes away, what hangs on it, why data stays away (S7, S8)."""
