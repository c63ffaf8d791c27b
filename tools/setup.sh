#!/usr/bin/env bash
# Make a virtual environment with fdvv and its extras (editable) and everything that demo and tests need.
# usage: setup.sh PYTHON VENV
set -euo pipefail
python=$1 venv=$2

fail() { echo "setup: $1" >&2; exit 1; }

missing=()
command -v "$python" >/dev/null || missing+=(python3)
command -v cc >/dev/null || command -v gcc >/dev/null || missing+=(gcc libc6-dev)
"$python" -c 'import ensurepip, venv' 2>/dev/null || missing+=(python3-venv)
if [ ${#missing[@]} -gt 0 ]; then
  [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null || fail "please install: ${missing[*]}"
  apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -y -qq "${missing[@]}"
fi
"$python" -c 'import sys; sys.exit(sys.version_info < (3, 11))' || fail "$python is older than Python 3.11; run make PYTHON=python3.11"

[ -x "$venv/bin/python" ] || "$python" -m venv "$venv"
pip=("$venv/bin/python" -m pip install --quiet --disable-pip-version-check)
here=(-e '.[dev]')
for extra in extras/*/; do
  # torch is 1 GB: the engines that need it are tested where it is installed
  [ "$extra" = extras/fdvv-botorch/ ] || here+=(-e "$extra")
done
# uv installs ten times faster; where it cannot be had, pip does the same work
if "${pip[@]}" uv 2>/dev/null && "$venv/bin/uv" pip install --quiet --compile-bytecode --python "$venv/bin/python" \
    -c constraints.txt "${here[@]}"; then
  "$venv/bin/uv" pip install --quiet --no-deps --python "$venv/bin/python" -e extras/fdvv-botorch
  exit 0
fi
"${pip[@]}" -c constraints.txt "${here[@]}"
"${pip[@]}" --no-deps -e extras/fdvv-botorch
