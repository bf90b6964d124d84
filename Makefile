# make demo: a virtual environment, the gripper solved, its picture.   make test: lint, types, tests.
# make docs: the documentation site, in docs/_build/html; any warning is an error (make test builds it with one example).
# make verify: the long tests, 10 000 damaged files, and the studies behind the pages of docs; an hour or so, may be interrupted.
PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin
# Containers often forbid Python to keep its byte code; each process of the tests would compile all that it imports.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: demo test lint docs figures verify clean

demo: $(VENV)/installed
	$(BIN)/magshell run gripper --out results/gripper

test: lint
	$(BIN)/pytest -n 3 --dist loadfile --max-worker-restart 0

lint: $(VENV)/installed-dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/python docs/make_reference.py --check

docs: $(VENV)/installed-dev
	rm -rf docs/_build docs/worked-examples docs/api/generated
	$(BIN)/sphinx-build -b html -j 2 -W --keep-going docs docs/_build/html

figures: $(VENV)/installed
	$(BIN)/python docs/make_figures.py
	$(BIN)/python docs/make_sweep_figure.py

verify: $(VENV)/installed-dev
	$(BIN)/pytest -m verify
	MAGSHELL_MUTATIONS=10000 $(BIN)/pytest tests/faults
	$(BIN)/python docs/make_element_study.py
	$(BIN)/python docs/make_incompressible_study.py
	$(BIN)/python docs/make_layer_study.py
	$(BIN)/python docs/make_joint_study.py
	$(BIN)/python docs/make_accuracy_study.py
	$(BIN)/python docs/make_published_study.py
	$(BIN)/python docs/make_path_study.py
	$(BIN)/python docs/make_mesh_study.py

$(VENV)/installed: pyproject.toml
	$(PYTHON) -m venv $(VENV)
	$(BIN)/pip install --quiet --no-compile --editable .
	touch $@

$(VENV)/installed-dev: pyproject.toml
	$(PYTHON) -m venv $(VENV)
	$(BIN)/pip install --quiet --no-compile --editable ".[dev]"
	touch $@

clean:
	rm -rf $(VENV) results
