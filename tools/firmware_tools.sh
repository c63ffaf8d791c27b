#!/usr/bin/env bash
# Get what building and emulating the firmware needs: compilers and the AVR emulator from Debian, TinyUSB's
# source under build/. As root it installs; otherwise it says what to install.
# usage: firmware_tools.sh BUILD
set -euo pipefail
build=$(mkdir -p "$1" && cd "$1" && pwd)

packages=(gcc-arm-none-eabi binutils-arm-none-eabi picolibc-arm-none-eabi gcc-avr avr-libc simavr libsimavr-dev)
release=trixie # the first Debian release that has tinyusb-source
keyring=/usr/share/keyrings/debian-archive-keyring.gpg

fail() { echo "firmware-tools: $1" >&2; exit 1; }

installed() { [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }

install_packages() {
  local missing=() package
  for package in "${packages[@]}"; do installed "$package" || missing+=("$package"); done
  [ ${#missing[@]} -gt 0 ] || return 0
  [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null || fail "please install: ${missing[*]}"
  apt-get update -qq
  DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}"
}

# The first archive address that this machine's own apt uses.
mirror() {
  { cat /etc/apt/sources.list.d/*.sources /etc/apt/sources.list 2>/dev/null || true; } |
    sed -nE -e 's/^URIs:[[:space:]]*([^[:space:]]+).*/\1/p' -e 's/^deb[[:space:]]+(\[[^]]*\][[:space:]]+)?([^[:space:]]+).*/\2/p' |
    grep -v -- '-security' | head -n 1
}

# An apt of its own under build/, so that the machine's sources stay as they are.
download_from_newer_release() {
  local state=$build/apt uri
  uri=$(mirror)
  [ -n "$uri" ] || fail "no Debian archive in /etc/apt; install tinyusb-source $release by hand and rerun"
  mkdir -p "$state/etc" "$state/lists/partial" "$state/cache/archives/partial"
  printf 'Types: deb\nURIs: %s\nSuites: %s\nComponents: main\nSigned-By: %s\n' \
    "$uri" "$release" "$keyring" >"$state/etc/$release.sources"
  local apt=(apt-get -qq -o Dir::Etc::sourcelist=/dev/null -o "Dir::Etc::sourceparts=$state/etc"
    -o "Dir::State::lists=$state/lists" -o "Dir::Cache=$state/cache" -o APT::Sandbox::User=)
  "${apt[@]}" update && "${apt[@]}" download tinyusb-source
}

fetch_tinyusb() {
  local place=$build/tinyusb
  [ ! -f "$place/.ready" ] || return 0
  rm -rf "$place" && mkdir -p "$place"
  (cd "$place" && { apt-get -qq download tinyusb-source 2>/dev/null || download_from_newer_release; })
  dpkg-deb -x "$place"/tinyusb-source_*.deb "$place"
  touch "$place/.ready"
}

install_packages
fetch_tinyusb
echo "firmware tools are ready"
