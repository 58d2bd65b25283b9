# Every target prepares .venv by itself, from a clean clone, and again without harm.
# Python 3.11 or newer is looked for; `make test PYTHON=/path/to/python` names one.

PYTHON ?= $(firstword $(foreach p,python3 python3.13 python3.12 python3.11 python py,\
	$(shell $(p) -c "import sys; sys.version_info >= (3, 11) and print('$(p)')" 2>/dev/null)))
ENV := .venv
BIN := $(ENV)/$(if $(filter Windows_NT,$(OS)),Scripts,bin)
RUN := $(BIN)/python
READY := $(ENV)/.ready
PACKAGES := tests/node/node_modules/.package-lock.json
TYPED := tests benchmarks examples

.PHONY: motion-table help demo test check format bench bench-solver bench-blender fuzz examples films pictures wheel-test node

help: ## what there is
	@sed -n 's/^\([a-z-]*\):.*## /\1\t/p' $(MAKEFILE_LIST) | expand -t 14

demo: $(READY) ## compile an example; prints where the GLB, the BVH and the picture are
	@$(RUN) examples/build.py --out out/demo --only person-aged-52

test: $(READY) node ## all tests; those for Node and Chromium where these are installed
	@$(RUN) -m pytest

check: $(READY) ## format, lint, types and the fast tests: before every commit
	@$(RUN) -m ruff format --check .
	@$(RUN) -m ruff check .
	@$(RUN) -m mypy
	@$(RUN) -m mypy $(wildcard $(addsuffix /**/*.py,$(TYPED)) $(addsuffix /*.py,$(TYPED)))
	@$(RUN) -m pytest -q -n auto -m "not slow and not node and not browser"

format: $(READY) ## put every file into the one format
	@$(RUN) -m ruff format .
	@$(RUN) -m ruff check --fix .

bench: $(READY) ## how long things take
	@$(RUN) benchmarks/run.py

bench-solver: $(READY) ## inverse kinematics by ours, the published and other methods
	@mkdir -p out
	@$(RUN) benchmarks/run.py solver --json out/solver.json

bench-blender: $(READY) ## the same, after installing Blender and pinocchio for themselves, 1 GB
	@mkdir -p out
	@$(RUN) benchmarks/run.py solver --prepare --json out/solver.json
	@$(RUN) benchmarks/editor.py

SECONDS ?= 60
fuzz: $(READY) ## look for texts that break the language, for SECONDS=60; on Linux
	@$(RUN) -c "import atheris" 2>/dev/null || $(RUN) -m pip install --quiet -c constraints.txt atheris
	@$(RUN) tests/fuzz/search.py $(SECONDS)

examples: $(READY) ## every example in every format but films, into out/examples
	@$(RUN) examples/build.py --out out/examples

films: $(READY) ## a film of every example, and a sheet of its key postures, into out/films
	@$(RUN) examples/films.py --out out/films

pictures: $(READY) ## draw the pictures of the examples' folders and of the tutorial anew
	@$(RUN) examples/build.py --out out/examples --keep-pictures
	@$(RUN) docs/language/pictures.py
	@$(RUN) docs/film_pictures.py
	@$(RUN) docs/repl_pictures.py

motion-table: $(READY) ## compare tracks with flattening on every example, into docs/motion.md
	@$(RUN) docs/motion_table.py

wheel-test: $(READY) node ## the fast tests against the built wheel, outside the checkout
	@bash tests/project/wheel.sh $(RUN)

node: ## packages of the tests that need Node, where it is installed
	@if command -v npm >/dev/null; then $(MAKE) --no-print-directory $(PACKAGES) || \
		echo "The Node packages could not be installed: their tests are skipped" >&2; fi

$(PACKAGES): tests/node/package-lock.json
	@npm ci --silent --prefix tests/node && touch $@

$(READY): pyproject.toml constraints.txt
	@test -n "$(PYTHON)" || { echo "azee needs Python 3.11 or newer; none was found" >&2; exit 1; }
	@echo "Preparing $(ENV) with $(PYTHON) (a minute, once)" >&2
	@$(RUN) -m pip --version >/dev/null 2>&1 || $(PYTHON) -m venv --clear $(ENV)
	@$(RUN) -m pip install --quiet -c constraints.txt hatchling editables
	@$(RUN) -m pip install --quiet --no-build-isolation -c constraints.txt -e '.[dev]'
	@touch $@
