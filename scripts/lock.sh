#!/bin/sh
# Write the lock files anew from pyproject.toml; `--upgrade` takes the newest packages.
set -eu
tools=.venv-lock
[ -x $tools/bin/uv ] || { "${PYTHON:-python3}" -m venv $tools && $tools/bin/pip install -q uv; }

# One version of each package for all Pythons, so that a result does not depend on which it was.
compile() {
    $tools/bin/uv pip compile --quiet --universal --python-version 3.11 --fork-strategy fewest \
        --generate-hashes --no-emit-index-url --no-emit-find-links --no-annotate --no-header \
        pyproject.toml "$@"
}
compile --extra control --group dev --output-file requirements.lock "$@"

# The same packages around MuJoCo 4: proof that the core does not lean on what 4 changed.
pins=$tools/pins.txt
sed -n 's/^\([a-z0-9.-]*==[^\\]*\).*/\1/p' requirements.lock | grep -v '^mujoco==' >$pins
echo 'mujoco==4.0.0' >>$pins
rm -f requirements-mujoco4.lock
compile --group test --group build --constraint $pins --output-file requirements-mujoco4.lock

# The site of the documents: the same packages, and those that build pages and run notebooks.
sed -i 's/^mujoco==.*/mujoco==3.17.0/' $pins
rm -f requirements-docs.lock
compile --extra docs --group build --constraint $pins --output-file requirements-docs.lock
