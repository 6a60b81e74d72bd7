"""Findings of many robots: pairs of source and leak in, out come patterns, counted (rule S10)."""
