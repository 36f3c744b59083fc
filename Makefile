# `make setup` once, then .venv/bin/inca. Nothing outside this folder changes, but for the system
# packages that drawing needs (scripts/system-packages.sh), and the compiled laws of the robot in
# your cache folder (docs/dependencies.md). ARGS="..." goes to the program run.
PYTHON_OF_VENV := .venv/bin/python
INSTALL := -m pip install -qq --disable-pip-version-check --no-input --no-deps --no-build-isolation

.PHONY: help setup demo test test-long test-mujoco4 test-wheel lint docs bench fuzz lock clean system-packages

help:  ## list the targets
	@sed -n 's/^\([a-z0-9-]*\):.*## \(.*\)/  make \1|\2/p' Makefile | awk -F'|' '{printf "%-20s %s\n", $$1, $$2}'

setup: system-packages .venv/.complete  ## make .venv with the locked packages and .venv/bin/inca
	@echo "Ready: .venv/bin/inca --help"

demo: system-packages .venv/.complete  ## the whole work on one example, with report and film
	@.venv/bin/inca demo $(ARGS)

test: system-packages .venv/.complete  ## run the tests, a process on each core
	@$(PYTHON_OF_VENV) -m pytest -n auto --dist loadfile $(ARGS)

test-long: system-packages .venv/.complete  ## run the whole searches that `make test` leaves out
	@$(PYTHON_OF_VENV) -m pytest -n auto --dist load -m long $(ARGS)

test-mujoco4: system-packages .venv-mujoco4/.complete  ## run the tests with MuJoCo 4
	@.venv-mujoco4/bin/python -m pytest -n auto --dist loadfile $(ARGS)

test-wheel: .venv/.complete  ## install the wheel in an empty environment and run its demo; ARGS=python3.13
	@sh scripts/try_wheel.sh $(ARGS)

lint: .venv/.complete  ## check style, format, types and layers
	@.venv/bin/ruff check $(ARGS)
	@.venv/bin/ruff format --check
	@.venv/bin/mypy
	@.venv/bin/lint-imports --no-cache --no-logo

docs: .venv-docs/.complete  ## build the pages of docs/ into site/, and run the notebooks
	@NO_MKDOCS_2_WARNING=1 .venv-docs/bin/mkdocs build --strict $(ARGS)
	@echo "Ready: site/index.html"

bench: .venv/.complete  ## measure how near the limit all runs; ARGS=--quick for a step only
	@$(PYTHON_OF_VENV) benchmarks/speed.py $(ARGS)

fuzz: .venv/.complete  ## read 200 000 damaged files; ARGS="--cases 5000 --reader robot" for fewer
	@$(PYTHON_OF_VENV) tests/fuzz $(ARGS)

lock:  ## write the lock files anew; ARGS=--upgrade takes the newest packages
	@sh scripts/lock.sh $(ARGS)

clean:  ## remove environments, caches and builds
	@rm -rf .venv .venv-* dist build site .pytest_cache .mypy_cache .ruff_cache .hypothesis
	@find . -name __pycache__ -type d -prune -exec rm -rf {} +

system-packages:
	@sh scripts/system-packages.sh

# A stamp is written last, so that an interrupted environment is made again from nothing.
.venv/.locked: requirements.lock
	@sh scripts/environment.sh .venv requirements.lock
	@touch $@

.venv-mujoco4/.locked: requirements-mujoco4.lock
	@sh scripts/environment.sh .venv-mujoco4 requirements-mujoco4.lock
	@touch $@

.venv-docs/.locked: requirements-docs.lock
	@sh scripts/environment.sh .venv-docs requirements-docs.lock
	@touch $@

%/.complete: %/.locked pyproject.toml
	@$*/bin/python $(INSTALL) --editable .
	@$*/bin/python -m compileall -qq identification inca_mj  # see scripts/environment.sh
	@touch $@
