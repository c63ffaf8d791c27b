#!/usr/bin/env bash
# Make a virtual environment with all packages of this repository (editable) and everything that demo and tests need.
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
here=()
for package in packages/*/ extras/*/; do here+=(-e "$package"); done
# torch is 1 GB: the engines that need it are tested where it is installed. Every package by its hash, the tools that build included: then nothing is left for a build to fetch
lock=requirements.lock only_uv=$(mktemp)
trap 'rm -f "$only_uv"' EXIT
awk '/^[^ ]/ { on = /^uv==/ } on' "$lock" > "$only_uv"
# uv installs ten times faster; where it cannot be had, or cannot reach what pip can, pip does the same work
uv=("$venv/bin/uv" pip install --quiet --python "$venv/bin/python")
if ! { "${pip[@]}" --require-hashes -r "$only_uv" && "${uv[@]}" --compile-bytecode --require-hashes -r "$lock"; } 2>/dev/null
then
  "${pip[@]}" --require-hashes -r "$lock"
fi
"${pip[@]}" --no-deps --no-build-isolation "${here[@]}"
