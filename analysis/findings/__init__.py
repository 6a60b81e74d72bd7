"""What is found: the fixpoint in, out come findings, open questions and a verdict (rules S10 to S12)."""
