# make verify | make test | make test-slow | make test-all (both) | make coverage | make lint (style, types) | make bench | make readme | make docs | make clean
# Python 3.11 or later with its headers and a C++ compiler are needed; everything else goes into .venv.

PYTHON ?= $(shell for p in python3 python3.14 python3.13 python3.12 python3.11; do \
	$$p -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && echo $$p && break; done)
BIN := .venv/bin
INSTALLED := .venv/installed
# the root folder is the package; pyright finds it under this name (extraPaths in pyproject.toml)
HERE := .venv/here
KERNELS := $(shell find core -name '*.hpp' -o -name '*.cpp')

# one thread per process: runs already use one process per core
export OMP_NUM_THREADS := 1
export OPENBLAS_NUM_THREADS := 1
# cached bytecode spares each of the many processes a compilation of the package, and of the modules of libraries that are
# imported; pip would compile all of them
unexport PYTHONDONTWRITEBYTECODE

PIP := $(BIN)/python -m pip install --quiet --disable-pip-version-check --no-compile
# prints the libraries that pyproject.toml names, and those of the extras in its arguments
LIBRARIES := import sys, tomllib; p = tomllib.load(open('pyproject.toml', 'rb'))['project']; \
	print(*p['dependencies'], *(name for extra in sys.argv[1:] for name in p['optional-dependencies'][extra]), sep='\n')

.PHONY: verify test test-slow test-all coverage lint style types bench readme docs clean

verify: $(INSTALLED)
	$(BIN)/southwell verify --out reports/out; status=$$?; $(BIN)/southwell pages reports/out && exit $$status

# loadfile: all tests of a file run in one process, because they share fixtures; in the order of tests/conftest.py
IN_PARALLEL := -n 2 --dist loadfile --no-loadscope-reorder

test: $(INSTALLED)
	$(BIN)/pytest $(IN_PARALLEL) -m "not slow"

test-slow: $(INSTALLED)
	$(BIN)/pytest $(IN_PARALLEL) -m slow

test-all: $(INSTALLED)
	$(BIN)/pytest $(IN_PARALLEL)

coverage: $(INSTALLED)
	$(PIP) 'pytest-cov>=6'
	$(BIN)/pytest $(IN_PARALLEL) -m "not slow" --cov=southwell --cov-report=term:skip-covered

lint: style types

style: $(INSTALLED)
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/clang-format --dry-run -Werror $(KERNELS)
	$(BIN)/lint-imports

types: $(INSTALLED)
	$(BIN)/pyright --threads --pythonpath $(BIN)/python

# writes docs/run-time.md
bench: $(INSTALLED)
	$(BIN)/python -m southwell.benchmarks.run_time

# from the results of the last make verify
readme: $(INSTALLED)
	$(BIN)/python -m southwell.reports.site.readme reports/out/results.jsonl

# into build/site, with the results of the last make verify if any; run as a module, because the script would import the
# command southwell, which lies beside it, instead of the package
# the libraries of the extra docs alone: an installation of `.[docs]` compiles the kernels again
docs: $(INSTALLED)
	$(BIN)/python -c "$(LIBRARIES)" docs | $(PIP) --requirement /dev/stdin
	NO_MKDOCS_2_WARNING=1 $(BIN)/python -m mkdocs build

# the kernels are compiled while the libraries are installed
$(INSTALLED): pyproject.toml setup.py $(KERNELS)
	$(if $(strip $(PYTHON)),,$(error No Python 3.11 or later found: install one, or name it: make PYTHON=/path/to/python3))
	$(PYTHON) -m venv .venv
	$(PIP) --no-deps --editable . & kernels=$$!; \
	$(BIN)/python -c "$(LIBRARIES)" codes readers dev | $(PIP) --requirement /dev/stdin; libraries=$$?; \
	wait $$kernels && exit $$libraries
	mkdir -p $(HERE) && ln -sfn ../.. $(HERE)/southwell
	touch $@

clean:
	rm -rf .venv build dist reports/out *.egg-info .pytest_cache .ruff_cache .hypothesis .import_linter_cache
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
	rm -f core/compiled/*.so core/compiled/*.pyd
