#!/bin/sh
# Put in place what pip cannot bring: OpenGL without a display, for films, and Python's venv. With
# CI set, also a browser for the tests that look at reports in one; without it they are skipped.
# Root on a Debian-like system gets them installed; anybody else is told the command.
# Never fails: everything that does not draw works without them.
set -u
PATH=$PATH:/usr/sbin:/sbin
[ "$(uname -s)" = Linux ] || exit 0

missing=
has() { for path in "$@"; do [ -e "$path" ] && return 0; done; return 1; }

libraries=$(ldconfig -p 2>/dev/null)
found() { printf '%s\n' "$libraries" | grep -q "$1"; }
found 'libEGL\.so\.1 ' || missing="$missing libegl1"
# PyOpenGL asks for GL functions beside EGL's, and dies of a NoneType without either library.
found 'libOpenGL\.so\.0 ' || found 'libGL\.so\.1 ' || missing="$missing libopengl0"
# Mesa's drivers are one file each up to release 24, one library from then on.
has /usr/lib/*/dri/*_dri.so /usr/lib*/dri/*_dri.so /usr/lib/*/libgallium-*.so \
    /usr/lib/*/libEGL_nvidia.so.0 || missing="$missing libgl1-mesa-dri"
if [ ! -e .venv/.complete ] && ! python3 -c 'import ensurepip' 2>/dev/null; then
    missing="$missing python3-venv" # Debian cuts it out of python3
fi
if [ -n "${CI:-}" ]; then
    browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome)
    [ -n "$browser" ] || missing="$missing chromium"
fi
[ -n "$missing" ] || exit 0

if [ "$(id -u)" != 0 ] || ! command -v apt-get >/dev/null; then
    echo "For films and tests, install the system packages (Debian's names):" \
        "sudo apt-get install --no-install-recommends$missing" >&2
    exit 0
fi
echo "Installing the system packages$missing ..."
export DEBIAN_FRONTEND=noninteractive
# shellcheck disable=SC2086 # a list of words
if ! { apt-get update -qq && apt-get install -qq -y --no-install-recommends $missing; } \
    >/dev/null 2>&1 </dev/null; then
    echo "apt-get could not install$missing; going on without; what needs them is left out." >&2
fi
exit 0
