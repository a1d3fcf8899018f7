#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
#
# Install the Debian packages that are missing; say what they are for. What cannot be had is named and left out: the same may be there in
# another way, and if not, the build says so.
#
#   --tests   also what only the tests need
#   --again   where the build has been set up: only what is needed
#   --list    only print them
set -u

tests=no
again=no
list=no
for word in "$@"; do
    case $word in
    --tests) tests=yes ;;
    --again) again=yes ;;
    --list) list=yes ;;
    esac
done

# package: what it is for
needed="\
build-essential: the C++ compiler
cmake: sets up the build
ninja-build: runs the build
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
python3: draws the report and runs the tests of scenes
python3-numpy: arrays in Python
python3-matplotlib: pictures of the report
python3-h5py: HDF5 files in Python"
for_tests="\
libgtest-dev: GoogleTest, unit tests
libbenchmark-dev: Google Benchmark, speed measurements
gfortran: Fortran, laws of users
python3-meshio: mesh files of many programs"
useful="\
ccache: keeps compiled files, so that the next build is quick
libjs-chart.js: charts in the page of a study whose points tell their names"

# A deal.II of one's own takes the place of Debian's, with the MPI and the HDF5 that it was built with.
[ -n "${DEAL_II_DIR:-}" ] && needed=$(echo "$needed" | grep -v -E '^(libdeal.ii-dev|libopenmpi-dev|openmpi-bin|libhdf5-openmpi-dev):')

[ $tests = no ] || needed+=$'\n'$for_tests
packages=$needed
[ $again = yes ] || packages+=$'\n'$useful

if [ $list = yes ]; then
    echo "$packages"
    exit 0
fi

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    [ $again = yes ] && exit 0
    echo "This is not Debian: install what these packages contain yourself, if the build fails:"
    echo "  ${packages//$'\n'/$'\n'  }"
    exit 0
fi

# What is not installed of a list, "package: what it is for" in each line.
missing_of()
{
    local names present
    names=$(echo "$1" | cut -d: -f1)
    # shellcheck disable=SC2086 # a list of words
    present=" $(dpkg-query -W -f='${Package} ${db:Status-Status}\n' $names 2>/dev/null | awk '$2 == "installed" {print $1}' | tr '\n' ' ')"
    while IFS=: read -r name reason; do
        case "$present" in
        *" $name "*) ;;
        *) printf '%s:%s\n' "$name" "$reason" ;;
        esac
    done <<<"$1"
}

# The names of such a list, in one line.
names_of()
{
    echo "$1" | cut -d: -f1 | xargs
}

say()
{
    echo "$1"
    while IFS=: read -r name reason; do printf '  %-22s%s\n' "$name" "${reason# }"; done <<<"$2"
}

# Goes on all the same.
leave_out()
{
    local lacking
    lacking=$(missing_of "$needed")
    if [ -n "$lacking" ]; then
        echo "$1 As root:"
        echo "  apt-get update && apt-get install --no-install-recommends $(names_of "$lacking")"
        echo "Going on with what is there."
    fi
    exit 0
}

missing=$(missing_of "$packages")
[ -z "$missing" ] && exit 0
say "Missing Debian packages:" "$missing"

as_root=""
if [ "$(id -u)" != 0 ]; then
    # Nobody is asked for a password for what is not needed.
    if command -v sudo >/dev/null && { sudo -n true 2>/dev/null || { [ -t 0 ] && [ -n "$(missing_of "$needed")" ] && sudo -v; }; }; then
        as_root=sudo
    else
        leave_out "Installing packages needs root."
    fi
fi

# All at once or, where one of them cannot be had, one by one. A source of apt that fails need not be the one that has them.
log=$(mktemp "${TMPDIR:-/tmp}/perideal_packages.XXXXXX")
start=$SECONDS
install()
{
    $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "$@"
}
{
    names=$(names_of "$missing")
    $as_root apt-get update
    # shellcheck disable=SC2086
    install $names || for name in $names; do install "$name"; done
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
[ -t 1 ] && printf '\r%60s\r' ''
missing=$(missing_of "$packages")
if [ -n "$missing" ]; then
    grep -E '^(E|Err|W):' "$log" | sort -u | head -n 8
    say "Not installed (log: $log):" "$missing"
    leave_out "Installing packages failed."
fi
rm -f "$log"
echo "Installed in $((SECONDS - start)) s."
