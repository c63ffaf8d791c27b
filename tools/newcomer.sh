#!/usr/bin/env bash
# Walk a newcomer's path in an empty folder and a clean environment: a clone of the last commit, what the README says to type, the
# first rendered button, the studio, a study's preview. Prints the seconds of every step; the last line is the sum.
# PYTHON=/path/to/python3: as a newcomer's `python3`
set -euo pipefail
checkout=$(cd "$(dirname "$0")/.." && pwd)
python=$("${PYTHON:-python3}" -c 'import os, sys; print(os.path.realpath(sys.executable))')

place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
mkdir "$place/home" "$place/bin" "$place/fdvv"
ln -s "$python" "$place/bin/python3"
git clone --quiet --depth 1 "file://$checkout" "$place/fdvv"

# root hides things at once, others as root of a namespace of their own
as=(unshare); [ "$(id -u)" = 0 ] || as=(unshare --map-root-user)
clean=(env -i HOME="$place/home" PATH="$place/bin:/usr/local/bin:/usr/bin:/bin:/usr/sbin" LANG=C.UTF-8 TMPDIR="$place/home")
walk=("${clean[@]}" python3 -m tools.newcomer)

if "${as[@]}" --mount true 2>/dev/null; then
  echo "checkout       hidden"
  hidden=("${as[@]}" --mount bash -c 'mount -t tmpfs none "$1" && shift && exec "$@"' - "$checkout")
else
  echo "checkout       not hidden: this system lets nobody mount"
  hidden=()
fi
cd "$place/fdvv"
# what is installed comes over the network, what is used needs none
"${hidden[@]}" "${walk[@]}" "$place/fdvv" install
if "${as[@]}" --net true 2>/dev/null; then
  echo "network        hidden after installation"
  "${hidden[@]}" "${as[@]}" --net bash -c 'ip link set lo up && exec "$@"' - "${walk[@]}" "$place/fdvv" use
else
  echo "network        not hidden: this system lets nobody"
  "${hidden[@]}" "${walk[@]}" "$place/fdvv" use
fi
