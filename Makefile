# Two commands do all set-up: `make demo` and `make test`.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin

.PHONY: demo test clean

demo: $(VENV)/installed
	$(BIN)/rosprivacy analyze examples/factory/before.policy.xml --labels examples/factory/run2.labels.yaml --fail-on never

test: $(VENV)/installed-dev
	$(BIN)/python -m pytest $(PYTEST_ARGS)

$(VENV)/installed: pyproject.toml
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --editable .
	touch $@

$(VENV)/installed-dev: pyproject.toml
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --editable '.[dev,bench]'
	touch $@ $(VENV)/installed

clean:
	rm -rf $(VENV) build dist
