"""Observed message types."""
