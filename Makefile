# Every target prepares .venv by itself, from a clean clone, and again without harm.
# Python 3.11 or newer is looked for; `make test PYTHON=/path/to/python` names one.

PYTHON ?= $(firstword $(foreach p,python3 python3.13 python3.12 python3.11 python py,\
	$(shell $(p) -c "import sys; sys.version_info >= (3, 11) and print('$(p)')" 2>/dev/null)))
ENV := .venv
BIN := $(ENV)/$(if $(filter Windows_NT,$(OS)),Scripts,bin)
RUN := $(BIN)/python
READY := $(ENV)/.ready
PACKAGES := $(patsubst %,%/node_modules/.package-lock.json,tests/node azee/web)
TYPED := tests benchmarks examples packaging
FIXTURES := $(wildcard tests/*/conftest.py)

# Every process that a test starts would compile all modules anew.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: docs package platform-wheel release-check wheel-test-oldest wheel-test-newest web mutants families-table motion-table readme-picture help demo test check format bench bench-solver bench-blender bench-tracker fuzz fuzz-bvh fuzz-bodies examples films pictures wheel-test node

help: ## list the targets
	@sed -n 's/^\([a-z-]*\):.*## /\1\t/p' $(MAKEFILE_LIST) | expand -t 16

demo: $(READY) ## compile an example; print where the GLB, the BVH and the picture are
	@$(RUN) examples/build.py --out out/demo --only person-aged-52

test: $(READY) node ## run all tests; those for Node and Chromium if these are installed
	@$(RUN) -m pytest -n auto --dist worksteal

check: $(READY) ## check format, lint and types and run the fast tests; use before every commit
	@$(RUN) -m ruff format --check .
	@$(RUN) -m ruff check .
	@$(RUN) -m mypy
	@$(RUN) -m mypy $(filter-out $(FIXTURES),$(wildcard $(addsuffix /**/*.py,$(TYPED)) $(addsuffix /*.py,$(TYPED))))
	@$(RUN) -m mypy $(FIXTURES)
	@HYPOTHESIS_PROFILE=quick $(RUN) -m pytest -q -n auto --dist loadfile -m "not slow and not long and not node and not browser"

format: $(READY) ## format all files
	@$(RUN) -m ruff format .
	@$(RUN) -m ruff check --fix .

bench: $(READY) ## measure how long things take
	@$(RUN) benchmarks/run.py

bench-solver: $(READY) ## compare the solver with the published and other methods
	@mkdir -p out
	@$(RUN) benchmarks/run.py solver --json out/solver.json

bench-blender: $(READY) ## compare it with Blender and pinocchio too; installs them (1 GB)
	@mkdir -p out
	@$(RUN) benchmarks/run.py solver --prepare --json out/solver.json
	@$(RUN) benchmarks/editor.py

bench-tracker: $(READY) ## compare our films with people by a tracker, which it installs (1.2 GB)
	@mkdir -p out
	@$(RUN) -m benchmarks.tracker -o out/tracker.json
	@$(RUN) -m benchmarks.tracker.faces

SECONDS ?= 60
fuzz: $(READY) ## search for texts that break the language, for SECONDS=60; on Linux
	@$(RUN) -c "import atheris" 2>/dev/null || $(RUN) -m pip install --quiet -c constraints.txt atheris
	@$(RUN) tests/fuzz/search.py azee $(SECONDS)

fuzz-bvh: $(READY) ## look for recordings that break reading and retargeting, for SECONDS=60
	@$(RUN) -c "import atheris" 2>/dev/null || $(RUN) -m pip install --quiet -c constraints.txt atheris
	@$(RUN) tests/fuzz/search.py bvh $(SECONDS)

fuzz-bodies: $(READY) ## damage files of bodies at random and import them, for SECONDS=60
	@$(RUN) tests/fuzz/search_bodies.py $(SECONDS)

COUNT ?= 50
SEED ?= 0
WORKERS ?= 1
SINCE ?= HEAD~1
MODULES ?=
mutants: $(READY) ## tell which single changes no test sees: COUNT=50 to MODULES=…, or to what changed SINCE=HEAD~1
	@$(RUN) tests/mutants/mutation_test.py --count $(COUNT) --seed $(SEED) -n $(WORKERS) --since $(SINCE) $(MODULES)

examples: $(READY) ## compile every example to every format but films, into out/examples
	@$(RUN) examples/build.py --out out/examples
	@$(RUN) examples/recorded.py --out out/examples

films: $(READY) ## film every example and draw its key postures, into out/films
	@$(RUN) examples/films.py --out out/films
	@$(RUN) examples/recorded.py --out out/films --film

pictures: $(READY) readme-picture ## draw all pictures of the documents and of the examples' folders again
	@$(RUN) examples/build.py --out out/examples --keep-pictures
	@$(RUN) examples/recorded.py --out out/examples --keep-pictures
	@$(RUN) docs/language/pictures.py
	@$(RUN) docs/language/mouths.py
	@$(RUN) docs/film_pictures.py
	@$(RUN) docs/facial_rules.py
	@$(RUN) docs/number_pictures.py
	@$(RUN) docs/repl_pictures.py

readme-picture: $(READY) ## draw the moving picture of README.md again
	@$(RUN) docs/readme_picture.py

motion-table: $(READY) ## compare tracks with flattening on every example, into docs/motion.md
	@$(RUN) docs/motion_table.py

families-table: $(READY) ## try three examples on bodies of many makers, into docs/rig/bodies.md
	@$(RUN) docs/rig/families_table.py

wheel-test: $(READY) node ## run the fast tests against the built wheel, outside the checkout
	@bash tests/project/wheel.sh $(RUN)

wheel-test-oldest: $(READY) node ## the same with the oldest dependencies that are allowed
	@bash tests/project/wheel.sh $(RUN) oldest

wheel-test-newest: $(READY) node ## the same with the newest dependencies there are
	@bash tests/project/wheel.sh $(RUN) newest

docs: $(READY) ## build the site of the documentation into out/docs, and follow its links
	@$(RUN) docs/site/build.py --out out/docs

package: $(READY) ## build the pure wheel and the archive of sources into out/packages
	@rm -rf out/packages
	@$(RUN) -m build --no-isolation --outdir out/packages

platform-wheel: $(READY) ## build a wheel with compiled kernels too, for this platform: Linux on x86-64
	@HATCH_BUILD_HOOK_ENABLE_CUSTOM=true $(RUN) -m build --wheel --no-isolation --outdir out/packages

TAG ?=
release-check: $(READY) ## tell whether the files agree on the version to release, and on TAG=v0.1.0
	@$(RUN) packaging/release.py $(TAG)

node: ## install the packages of the pages and of the tests that need Node, if it is there
	@if command -v npm >/dev/null; then $(MAKE) --no-print-directory $(PACKAGES) || \
		echo "The Node packages could not be installed: their tests are skipped" >&2; fi

web: $(PACKAGES) ## build the pages of azee/web into azee/web/dist
	@npm run --silent build --prefix azee/web

$(PACKAGES): %/node_modules/.package-lock.json: %/package-lock.json
	@npm ci --silent --prefix $* && touch $@

$(READY): pyproject.toml constraints.txt
	@test -n "$(PYTHON)" || { echo "azee needs Python 3.11 or newer; none was found" >&2; exit 1; }
	@echo "Preparing $(ENV) with $(PYTHON) (a minute, once)" >&2
	@$(RUN) -m pip --version >/dev/null 2>&1 || $(PYTHON) -m venv --clear $(ENV)
	@$(RUN) -m pip install --quiet -c constraints.txt hatchling editables
	@$(RUN) -m pip install --quiet --no-build-isolation -c constraints.txt -e '.[dev]'
	@touch $@
