"""Where the repository and the tests are, for tests in whichever folder."""

from pathlib import Path

TESTS = Path(__file__).resolve().parent.parent
ROOT = TESTS.parent
