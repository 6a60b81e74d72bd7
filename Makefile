# Two commands do all set-up: `make demo` and `make test`.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin

LOCK := uv pip compile --quiet --upgrade --universal --python-version 3.10 --generate-hashes --no-emit-index-url \
	--no-annotate --custom-compile-command 'make locks'

.PHONY: demo test fuzz locks clean

demo: $(VENV)/installed
	$(BIN)/rosprivacy analyze examples/factory/before.policy.xml --labels examples/factory/run2.labels.yaml --fail-on never

test: $(VENV)/installed-dev
	$(BIN)/python -m tests.helpers.fetch
	$(BIN)/python -m pytest -rs $(PYTEST_ARGS)

# make fuzz MINUTES=10, make fuzz HOURS=2: of processor time. FOLDER is gone on with: the corpus grows there.
MINUTES := $(if $(HOURS),$(shell echo $$(($(HOURS) * 60))),10)
fuzz: $(VENV)/installed-dev
	$(BIN)/python -m tests.fuzzing run --minutes $(MINUTES) $(if $(FOLDER),--folder '$(FOLDER)')

$(VENV)/installed: pyproject.toml
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --editable '.[code,ontology]'
	$(BIN)/python -m pip install --quiet --only-binary pygraphviz --editable '.[views]' || \
		echo "Graphviz has no wheel for this machine: pictures are missing (docs/views.md, Formats)"
	touch $@

# Spark is large and few change what uses it: make .venv/installed-dev EXTRAS=dev,bench,spark
EXTRAS := dev,bench
$(VENV)/installed-dev: pyproject.toml
	$(PYTHON) -m venv $(VENV)
	@echo "Fetching Python packages for the tests ($(EXTRAS)): about 350 MB; Spark is 450 MB more"
	$(BIN)/python -m pip install --editable '.[$(EXTRAS)]'
	touch $@ $(VENV)/installed

# What the GitHub Action and the image install, with the hashes of all files, what builds rosprivacy itself, and the
# tools of a release. Needs uv.
locks:
	echo 'setuptools>=77' | $(LOCK) pyproject.toml - --extra ontology --output-file requirements.lock
	printf 'setuptools>=77\nneo4j-rust-ext>=5.26\n' | $(LOCK) pyproject.toml - --extra ontology --extra views --output-file docker/requirements.lock
	printf 'build\ncheck-wheel-contents\ncyclonedx-bom\npip\ntwine\n' | $(LOCK) - --output-file .ci/release.lock

clean:
	rm -rf $(VENV) build dist
