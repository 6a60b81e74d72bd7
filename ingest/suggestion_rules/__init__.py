"""Files of rules that suggest labels, and suggestions in label files; what they mean is in ``analysis/suggesting``."""
