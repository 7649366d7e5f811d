# Everything a person does often. `make help` lists it.

PYTHON ?= python3
VENV ?= .venv
OUT ?= reports/latest
ENGINES ?= python-fcl coal mujoco pybullet parry3d-f64 parry3d jolt-physics rapier3d ammo.js cannon-es
VERSION = $(shell $(BIN)/python -c 'import hypcheck; print(hypcheck.__version__)')
BIN := $(VENV)/bin
# Bytecode is made for the modules that are used, which are few. The tree is found by its path: a finder would take a tenth
# of the time in which a process starts, and tests start a thousand.
# setuptools warns at each such install that it will drop the mode `compat` one day.
# uv takes a quarter of the time of pip, and trusts the certificates of the system as pip does. Where it is missing, reaches no
# registry or fails, pip installs and says why it cannot.
INSTALL := install() { \
	echo "installing hypcheck$$1 into $(VENV)"; \
	UV_SYSTEM_CERTS=1 UV_HTTP_RETRIES=1 $(BIN)/uv pip install --quiet --python $(BIN)/python --config-setting editable_mode=compat --editable ".$$1" 2>/dev/null || \
	PYTHONWARNINGS=ignore $(BIN)/python -m pip install --quiet --disable-pip-version-check --no-compile --config-settings editable_mode=compat --editable ".$$1"; \
}; install

# The bytecode of what `make verify` loads, so that its first run takes no longer than others.
COMPILED := $(BIN)/python -c 'from hypcheck.derivation import printed_equations, proofs; from hypcheck.report import write; from hypcheck.runs import self_check; write.import_all()'

# Hundreds of processes start in a run of the tests: each would compile hypcheck anew where no bytecode is kept.
unexport PYTHONDONTWRITEBYTECODE

.DEFAULT_GOAL := help
.PHONY: help verify bench deep engines reference reference-bench attack processors pace soak kernels wheel check test tests thorough lint quick cases check-cases prove paper transcripts figures mutants goldens seams surface evidence docs packages release format clean

help: ## this list
	@awk -F ':.*## ' '/^[a-z-]+:.*## /{printf "make %-15s %s\n", $$1, $$2}' $(MAKEFILE_LIST)

verify: $(VENV)/ready ## derive, prove, cross-check five oracles, judge, time; reports in reports/latest/
	$(BIN)/hypcheck verify --self --out $(OUT)

bench: $(VENV)/ready ## error against run time of every method (under 5 minutes); reports in reports/bench/
	$(BIN)/hypcheck bench --out reports/bench

deep: $(VENV)/ready ## a million cases through the oracles (under 15 minutes); reports in reports/reference/
	$(BIN)/hypcheck verify --self --out reports/reference --count 33000 --roots 200000 --meshes 35000

# In a folder of the clone: reports name no folder of the machine that made them.
engines: export HYPCHECK_ENGINES ?= $(VENV)/engines
engines: $(VENV)/ready ## what collision engines get wrong, each installed apart (half an hour); reports in reports/engines/
	$(BIN)/hypcheck engines install $(ENGINES)
	$(BIN)/hypcheck engines verify $(ENGINES)
	$(BIN)/hypcheck engines bench $(ENGINES)
	$(BIN)/hypcheck report reports/engines/bench --format overview --out reports/engines/bench/README.md

reference-bench: $(VENV)/ready ## every method on a quiet machine (under 5 minutes); reports in reports/reference/bench/
	@$(INSTALL) '[report,peers]'
	$(BIN)/hypcheck bench --out reports/reference/bench
	$(BIN)/hypcheck report reports/reference/bench --format overview --out reports/reference/bench/README.md

check: $(VENV)/ready-dev ## lint, types and the quick tests (under a minute): between two edits
	$(MAKE) --no-print-directory --jobs 2 lint quick

quick: $(VENV)/ready-dev
	$(BIN)/python -m pytest --quiet -n auto --dist worksteal -m 'not slow and not thorough'

test: $(VENV)/ready-dev ## lint, format, strict types, import layers and every test but the thorough ones
	$(MAKE) --no-print-directory --jobs 2 lint tests

# Only where every test ran and some failed (1) do these run once more: after an error of pytest (3) most have not run.
tests: $(VENV)/ready-dev
	$(BIN)/python -m pytest --assert plain -n auto --dist worksteal -m 'not thorough' || { \
		ended=$$?; [ $$ended = 1 ] || exit $$ended; \
		echo "What failed beside other tests runs once more, alone: a loaded machine refuses no change. What fails twice fails."; \
		$(BIN)/python -m pytest -m 'not thorough' --last-failed --last-failed-no-failures none --maxfail 3; }

thorough: $(VENV)/ready-dev check-cases ## all labels, and the tests that repeat with many rows or processes what others test with few
	$(BIN)/python -m pytest -n auto --dist worksteal -m thorough

cases: $(VENV)/ready ## the frozen vectors anew, every id kept (two minutes)
	$(BIN)/hypcheck cases freeze --into cases

check-cases: $(VENV)/ready ## prove every label of the frozen vectors from its certificate
	$(BIN)/hypcheck cases check

prove: $(VENV)/ready ## the machine-checked proofs, and the proved checker on the frozen vectors (needs coq; docs/proofs.md)
	$(BIN)/python -m tests.tools.checked proofs --again
	for scene in forest tower tower-simplest; do \
		$(BIN)/hypcheck emit --scene $$scene --language c --output build/proofs/$$scene.c --proof build/proofs/$$scene.v || exit; \
	done
	$(BIN)/python -m hypcheck.proofs build/proofs/forest.v build/proofs/tower.v build/proofs/tower-simplest.v

paper: $(VENV)/ready ## docs/paper.md anew: the ledger of the paper's claims
	$(BIN)/hypcheck derive --only ledger --only costs --format markdown --output docs/paper.md

schemas: $(VENV)/ready-dev ## the published schemas of what is written anew, from the classes that hold it
	$(BIN)/python -m tests.tools.published_schemas

seams: $(VENV)/ready-dev ## what takes which columns of a row anew; docs/rows.md
	$(BIN)/python -m tests.tools.seams

surface: $(VENV)/ready-dev ## what users depend on anew; docs/surface.txt, docs/stability.md
	$(BIN)/python -m tests.tools.surface

goldens: $(VENV)/ready-dev ## what each format of reports says of the recorded runs anew; its diff is to be read; tests/report/goldens/
	$(BIN)/python -m tests.tools.goldens

transcripts: $(VENV)/ready-dev ## what the command line prints in each scene anew; tests/support/transcripts.py: read the difference
	$(BIN)/python -m tests.support.transcripts

figures: $(VENV)/ready-dev ## the paper's figures and our simulations' anew; docs/figures.md
	$(BIN)/python -m tests.tools.figures

mutants: $(VENV)/ready-dev ## gate wrong and right implementations; ends with 1 where one escapes; tests/tools/mutants/README.md
	$(BIN)/python -m tests.tools.mutants --out tests/tools/mutants/README.md

reference: $(VENV)/ready-dev ## every generated figure and page anew, resumable, some hours; reports/README.md says from which commit
	$(BIN)/python -m tests.tools.reference

evidence: $(VENV)/ready-dev ## what mutants, fuzzing, coverage and faults find in our own code, anew; docs/evidence.md (some hours)
	$(BIN)/python -m tests.tools.evidence all --write

# One part of them: evidence-fuzz, evidence-python-coverage.
evidence-%: $(VENV)/ready-dev
	$(BIN)/python -m tests.tools.evidence $* --write

kernels: $(VENV)/ready-dev ## 200 random scenes and the known ones as kernels in five languages (half an hour)
	HYPCHECK_KERNELS=all $(BIN)/python -m pytest tests/kernel/emission

wheel: $(VENV)/ready-dev ## every command of the installed wheel and sdist, with and without a C compiler (five minutes)
	HYPCHECK_WHEEL=all $(BIN)/python -m pytest -n auto tests/test_wheel.py

attack: $(VENV)/ready-dev ## ten million rows at the borders, every kernel and instruction set; ends with 1 where one is wrong
	$(BIN)/python -m tests.tools.attack

processors: $(VENV)/ready-dev ## the C header on ARM, RISC-V, IBM Z, x87, WebAssembly (half an hour); docs/processors.md
	$(BIN)/python -m tests.tools.processors $(COMPILERS) --out docs/processors.md

pace: $(VENV)/ready-dev ## rows a second of verify from 1e6 to 1e9 rows; ends with 1 where they differ by over 15 %
	$(BIN)/python -m tests.tools.pace

soak: $(VENV)/ready-dev ## a million damaged inputs for all readers, ten minutes of verify against what crashes and hangs
	$(BIN)/python -m tests.tools.fuzz --count 1000000
	$(BIN)/python -m tests.tools.soak --seconds 600

lint: $(VENV)/ready-dev ## lint, format, strict types and import layers alone
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

format: $(VENV)/ready-dev ## rewrite the code in the house format
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

docs: $(VENV)/ready-docs ## the site of all pages, its links checked; build/site/index.html
	NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build

packages: $(VENV)/ready-dev ## all packages in dist/, checked, and each installed afresh: every local step of a release
	rm -rf dist
	$(BIN)/python -m packages build
	$(BIN)/python -m packages check
	$(BIN)/python -m packages try

release: $(VENV)/ready-dev ## make packages on a clean tree, and the tag of its version
	@test -z "$$(git status --porcelain)" || { echo "commit first: the tree has changes" >&2; exit 2; }
	@grep -q '^## $(VERSION)$$' CHANGELOG.md || { echo "CHANGELOG.md has no heading $(VERSION); see CONTRIBUTING.md, A release" >&2; exit 2; }
	$(BIN)/python -m tests.tools.reference --check
	$(BIN)/python -m pytest --quiet tests/test_pages.py tests/test_action.py tests/report/test_reference.py
	$(MAKE) --no-print-directory packages
	git tag --annotate --message "hypcheck $(VERSION)" v$(VERSION)

clean: ## remove the environment, caches and the latest reports
	rm -rf $(VENV) build dist *.egg-info .hypothesis .mypy_cache .pytest_cache .ruff_cache .import_linter_cache reports/latest
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

# The environment is made once and used again; a change of pyproject.toml or of the compiled kernel installs anew.
$(BIN)/python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 10))' || { \
		echo "hypcheck needs Python 3.10 or later; $(PYTHON) is $$($(PYTHON) --version 2>&1). Name another: make PYTHON=python3.12" >&2; exit 2; }
	@$(PYTHON) -m venv $(VENV) || { \
		echo "$(PYTHON) cannot make a virtual environment; on Debian and Ubuntu install python3-venv" >&2; rm -rf $(VENV); exit 2; }
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-compile --retries 1 uv 2>/dev/null || true

KERNEL := setup.py hypcheck/kernel/core/binding.c hypcheck/kernel/core/columns.h hypcheck/kernel/core/at_once.h hypcheck/kernel/core/hypcheck.h hypcheck/implementations/calls.c $(wildcard hypcheck/isolation/*.[ch])
$(VENV)/ready: pyproject.toml $(KERNEL) | $(BIN)/python
	@$(INSTALL) '[report]'
	@$(COMPILED)
	@touch $@

$(VENV)/ready-dev: pyproject.toml $(KERNEL) | $(BIN)/python
	@$(INSTALL) '[report,dev]'
	-@$(BIN)/hypcheck engines install python-fcl cannon-es --cache $(VENV)/engines
	@touch $(VENV)/ready $@

# All that CI needs at once: each install compiles the kernel anew.
$(VENV)/ready-ci: pyproject.toml $(KERNEL) | $(BIN)/python
	@$(INSTALL) '[report,dev,docs]'
	-@$(BIN)/hypcheck engines install python-fcl cannon-es --cache $(VENV)/engines
	@touch $(VENV)/ready $(VENV)/ready-dev $(VENV)/ready-docs $@

$(VENV)/ready-docs: pyproject.toml $(KERNEL) | $(BIN)/python
	@$(INSTALL) '[report,docs]'
	@touch $(VENV)/ready $@
