#!/bin/sh
# Make a Python environment of exactly the locked packages: environment.sh FOLDER LOCK_FILE
set -eu
folder=$1
lock=$2

# dm_control has wheels up to 3.12, so the newest Python is not the first choice.
# PYTHON=... names another.
python=
bare=
for candidate in ${PYTHON:-python3.12 python3.11 python3.13 python3.14 python3}; do
    "$candidate" -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null || continue
    if "$candidate" -c 'import ensurepip, venv' 2>/dev/null; then
        python=$candidate
        break
    fi
    bare=$candidate
done
if [ -z "$python" ] && [ -n "$bare" ]; then
    echo "$bare lacks its venv module; install it, on Debian: apt-get install python3-venv" >&2
    exit 1
elif [ -z "$python" ]; then
    echo "No Python of 3.11 or newer was found (tried ${PYTHON:-python3.11 to python3.14 and" \
        "python3}); install one, on Debian: apt-get install python3 python3-venv" >&2
    exit 1
fi

echo "Installing the packages of $lock with $("$python" --version) into $folder ..."
rm -rf "$folder"
"$python" -m venv "$folder"
# Compiling the bytecode of everything would double the time.
"$folder/bin/python" -m pip install -qq --disable-pip-version-check --no-input --no-compile \
    --no-deps --only-binary :all: --require-hashes -r "$lock"

# Python writes bytecode at first import, unless PYTHONDONTWRITEBYTECODE forbids it, as in many
# containers: then every start would compile the same sources again, which takes longer than all
# else. So the bytecode of the packages that commands import is written here.
MUJOCO_GL=disable PYTHONDONTWRITEBYTECODE= "$folder/bin/python" -c '
import io
import imageio_ffmpeg, jinja2, mujoco.batch, mujoco.introspect.structs, numba, tqdm, tyro, typeguard
import PIL.ImageDraw, PIL.ImageFont
import scipy.interpolate, scipy.optimize, scipy.signal, scipy.spatial.transform, scipy.stats
from matplotlib.figure import Figure
numba.njit(lambda x: x)(0)  # it imports the rest of numba
for form in ("png", "svg"):  # and these the rest of matplotlib
    figure = Figure(layout="constrained")
    figure.subplots().plot([0, 1], label="a line")
    figure.legend()
    figure.savefig(io.BytesIO(), format=form)
jinja2.Environment(autoescape=True).from_string("{{ a }}").render(a=1)'
