#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
#
# Install the Debian packages that PeriDeal needs and that are missing; say what they are for. With --list only print them.
set -u

# package: what it is for
packages="\
build-essential: the C++ compiler
cmake: sets up the build
ninja-build: runs the build
ccache: keeps compiled files, so that the next build is quick
pkg-config: finds libraries
libdeal.ii-dev: deal.II, the finite element library, with Trilinos and p4est
libopenmpi-dev: Open MPI, to compile parallel programs
openmpi-bin: mpirun, to start parallel programs
libhdf5-openmpi-dev: HDF5 files, written in parallel
libeigen3-dev: Eigen, small dense matrices
libmuparser-dev: muParser, formulas in scenes
libcli11-dev: CLI11, the command line
nlohmann-json3-dev: JSON, the summary of a run
libpng-dev: PNG, pictures of microstructures
libnanoflann-dev: nanoflann, neighbour search
libhwy-dev: Highway, vector instructions of every processor
libgtest-dev: GoogleTest, unit tests
libbenchmark-dev: Google Benchmark, speed measurements
python3: draws the report and runs the tests of scenes
python3-numpy: arrays in Python
python3-matplotlib: pictures of the report
python3-h5py: HDF5 files in Python
libjs-chart.js: charts in the page of a study whose points tell their names"

# A deal.II of one's own takes the place of Debian's.
[ -n "${DEAL_II_DIR:-}" ] && packages=$(echo "$packages" | grep -v '^libdeal.ii-dev:')

if [ "${1:-}" = --list ]; then
    echo "$packages"
    exit 0
fi

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    echo "This is not Debian: install what these packages contain yourself, if the build fails:"
    echo "  ${packages//$'\n'/$'\n'  }"
    exit 0
fi

names=$(echo "$packages" | cut -d: -f1)
# shellcheck disable=SC2086 # a list of words
present=" $(dpkg-query -W -f='${Package} ${db:Status-Status}\n' $names 2>/dev/null | awk '$2 == "installed" {print $1}' | tr '\n' ' ')"
missing=""
while IFS=: read -r name reason; do
    case "$present" in
    *" $name "*) ;;
    *)
        [ -z "$missing" ] && echo "Missing Debian packages:"
        printf '  %-22s%s\n' "$name" "${reason# }"
        missing="$missing $name"
        ;;
    esac
done <<<"$packages"
[ -z "$missing" ] && exit 0

as_root=""
if [ "$(id -u)" != 0 ]; then
    if command -v sudo >/dev/null && { sudo -n true 2>/dev/null || [ -t 0 ]; }; then
        as_root=sudo
        sudo -v || exit 1
    else
        echo "Installing packages needs root. Please run, as root:"
        echo "  apt-get update && apt-get install --no-install-recommends$missing"
        exit 1
    fi
fi

log=$(mktemp "${TMPDIR:-/tmp}/perideal_packages.XXXXXX")
start=$SECONDS
{
    $as_root apt-get update &&
        $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends $missing
} >"$log" 2>&1 </dev/null &
job=$!

# Each package is unpacked and then set up.
said=-1
while kill -0 $job 2>/dev/null; do
    sleep 1
    total=$(sed -n 's/.* \([0-9]*\) newly installed.*/\1/p' "$log" | tail -1)
    done_=$(grep -c -E '^(Unpacking|Setting up) ' "$log")
    [ "${total:-0}" -gt 0 ] || continue
    percent=$((100 * done_ / (2 * total)))
    [ $percent -gt 99 ] && percent=99
    if [ -t 1 ]; then
        printf '\rInstalling packages (%d): %d %% ' "$total" $percent
    elif [ $((percent / 25)) -gt $said ]; then
        said=$((percent / 25))
        echo "Installing packages ($total): $percent %"
    fi
done
wait $job
status=$?
[ -t 1 ] && printf '\r%60s\r' ''
if [ $status != 0 ]; then
    tail -n 15 "$log"
    echo "Installing the packages failed (log: $log). By hand, as root:"
    echo "  apt-get update && apt-get install --no-install-recommends$missing"
    exit 1
fi
rm -f "$log"
echo "Installed in $((SECONDS - start)) s."
