"""What to change: an analysis and limits in, out come proposals, each proven by a new analysis."""
