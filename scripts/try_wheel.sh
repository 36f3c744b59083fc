#!/bin/sh
# Build the wheel, install it in an empty environment, and run the demo in an empty folder:
# try_wheel.sh [PYTHON ...], by default the Python that made .venv.
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cd "$root"
.venv/bin/python -m hatchling build -t wheel -d "$place" >/dev/null
[ $# -gt 0 ] || set -- .venv/bin/python
for python in "$@"; do
    "$python" -m venv "$place/environment"
    "$place/environment/bin/python" -m pip install -qq --disable-pip-version-check --no-input \
        "$place"/*.whl
    mkdir "$place/empty"
    (
        cd "$place/empty"
        "$place/environment/bin/inca" --version
        XDG_CACHE_HOME="$place/cache" "$place/environment/bin/inca" demo --quiet
        test -s out/demo/report.html
    )
    du -sm "$place/environment" | sed 's/\t.*/ MB are installed/'
    rm -rf "$place/environment" "$place/empty" "$place/cache"
done
