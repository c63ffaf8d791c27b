#!/usr/bin/env bash
# Install fdvv with the lowest versions of what it depends on, and run the tests of what they could break.
# usage: lowest_versions.sh PYTHON; the environment of make setup must exist, for its uv and the C kernels
set -euo pipefail
python=$1
uv=.venv/bin/uv
[ -x "$uv" ] || { echo "lowest_versions: uv is missing; only it can choose the lowest versions" >&2; exit 1; }
lowest=build/lowest/bin/python
[ -x "$lowest" ] || "$python" -m venv build/lowest
"$uv" pip install --quiet --python "$lowest" --resolution lowest-direct \
  -e packages/fdvv -e packages/fdvv-studio
"$uv" pip freeze --python "$lowest" --exclude-editable > build/lowest/versions.txt
# what only the tests use may be of any version, and leaves the rest as it is; an old starlette tests with httpx
"$uv" pip install --quiet --python "$lowest" -c build/lowest/versions.txt \
  httpx httpx2 hypothesis jsonschema pytest pytest-randomly pytest-timeout pytest-xdist
"$uv" pip list --quiet --python "$lowest"
# what old versions warn of, new ones have mended; a test of each dependency, the rest would run again what make test
# runs: click and rich; numpy and scipy; msgspec; calamine; starlette, uvicorn and websockets
core=packages/fdvv/tests studio=packages/fdvv-studio/tests
FDVV_QUICK=1 OPENBLAS_NUM_THREADS=1 build/lowest/bin/pytest -n 2 -q -W ignore::DeprecationWarning -m "not slow and not clock" \
  $core/cli/test_refusals.py $core/model/test_fit.py $core/model/test_bspline.py $core/model/test_surface.py \
  $core/model/test_press.py $core/model/test_file.py $core/program/test_program_file.py $core/formats/test_formats.py \
  $studio/project/test_documents.py $studio/studio/test_app.py $studio/studio/test_live.py $studio/studio/test_serve.py \
  tests/test_imports.py
