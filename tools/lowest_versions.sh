#!/usr/bin/env bash
# Install fdvv with the lowest versions of what it depends on, and run the tests of what they could break.
# usage: lowest_versions.sh PYTHON; the environment of make setup must exist, for its uv and the C kernels
set -euo pipefail
python=$1
uv=.venv/bin/uv
[ -x "$uv" ] || { echo "lowest_versions: uv is missing; only it can choose the lowest versions" >&2; exit 1; }
lowest=build/lowest/bin/python
[ -x "$lowest" ] || "$python" -m venv build/lowest
"$uv" pip install --quiet --python "$lowest" --resolution lowest-direct -e .
"$uv" pip freeze --python "$lowest" --exclude-editable > build/lowest/versions.txt
# what only the tests use may be of any version, and leaves the rest as it is; an old starlette tests with httpx
"$uv" pip install --quiet --python "$lowest" -c build/lowest/versions.txt \
  griffe httpx httpx2 hypothesis jsonschema pytest pytest-randomly pytest-timeout pytest-xdist
"$uv" pip list --quiet --python "$lowest"
# what old versions warn of, new ones have mended
FDVV_QUICK=1 OPENBLAS_NUM_THREADS=1 build/lowest/bin/pytest -n 2 -q -W ignore::DeprecationWarning \
  -m "not slow and not browser and not firmware" tests/cli/test_refusals.py tests/formats tests/model tests/program \
  tests/project tests/studio/test_app.py tests/studio/test_live.py tests/studio/test_serve.py tests/test_public_face.py
