#!/bin/sh
# Writes docs/answer.png, the picture of README: the head of the report of examples/elbow, made by
# this version and shown by chromium. Run it in the folder of the repository after a change of the
# report; it takes half a minute.
set -e
made=$(mktemp -d)
trap 'rm -rf "$made"' EXIT
elbow=examples/elbow
.venv/bin/python -m identification discover $elbow/elbow.toml $elbow/first.csv \
  --confirm $elbow/second.csv --out "$made/elbow" --quiet > "$made/text"
chromium --headless --no-sandbox --disable-gpu --hide-scrollbars --virtual-time-budget=3000 \
  --window-size=1200,690 --screenshot="$PWD/docs/answer.png" "file://$made/elbow/report.html"
