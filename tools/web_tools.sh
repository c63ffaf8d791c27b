#!/usr/bin/env bash
# Get what building and testing the studio's page needs: node and Chromium from Debian, the page's development
# packages from npm. As root it installs; otherwise it says what to install.
set -euo pipefail
cd "$(dirname "$0")/../web"

fail() { echo "web-tools: $1" >&2; exit 1; }

missing=()
command -v node >/dev/null && command -v npm >/dev/null || missing+=(nodejs npm)
command -v chromium >/dev/null || command -v google-chrome >/dev/null || missing+=(chromium)
if [ ${#missing[@]} -gt 0 ]; then
  [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null || fail "please install: ${missing[*]}"
  apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}"
fi
node -e 'process.exit(Number(process.versions.node.split(".")[0]) < 20 ? 1 : 0)' || fail "node is older than 20"

# npm ci only where the lock file is newer than what it made
if [ ! node_modules/.ready -nt package-lock.json ]; then
  npm ci --silent
  touch node_modules/.ready
fi
echo "web tools are ready"
