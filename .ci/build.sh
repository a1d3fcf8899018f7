# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
#
# Shell functions that ./run and ./check share. They expect $root, the folder of PeriDeal.

# The preset of CMakePresets.json that is built: release, or the one given here.
use_preset()
{
    preset=$1
    build=$root/build/$1
}
use_preset release

# Install what is missing, with --tests also what only they need. Takes 0.1 s when nothing is.
install_packages()
{
    [ -f "$build/build.ninja" ] && set -- "$@" --again
    bash "$root/.ci/install_packages.sh" "$@"
}

# The Python with numpy, matplotlib and h5py: Debian's, since the first in PATH may lack them.
find_python()
{
    for python in /usr/bin/python3 python3; do
        "$python" -c 'import importlib.util as u, sys; sys.exit(any(u.find_spec(m) is None for m in ("numpy", "matplotlib", "h5py")))' \
            2>/dev/null && return 0
    done
    echo "No python3 with numpy, matplotlib and h5py was found." >&2
    return 1
}

# What every parallel program here needs: several processes on few cores, also as root and in containers; no words of the launcher where
# one ends with a status that is not 0. Variables and no options of mpirun, since those of Open MPI 4 and 5 (PRTE) differ.
parallel_environment()
{
    export OMP_NUM_THREADS=1
    export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
    export OMPI_MCA_rmaps_base_oversubscribe=1 PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe
    export OMPI_MCA_hwloc_base_binding_policy=none PRTE_MCA_hwloc_default_binding_policy=none
    export OMPI_MCA_orte_execute_quiet=1
    export OMPI_MCA_btl_vader_single_copy_mechanism=none
    export PMIX_MCA_gds=hash # else a full folder for temporary files (TMPDIR) ends in a bus error
}

# Configure the build where that has not been done, or was done for a tree that stood elsewhere, another deal.II or, with --tests, where
# GoogleTest was not there yet. Says what deal.II was found.
configure()
{
    local log=$build/configure.log
    local fresh="" own=${DEAL_II_DIR:-}
    if [ -f "$build/CMakeCache.txt" ]; then
        grep -q -x -F "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$build/CMakeCache.txt" || fresh=--fresh
        local found
        found=$(sed -n 's/^deal\.II_DIR:PATH=//p' "$build/CMakeCache.txt")
        case "$found/" in
        "${own%/}"/*) [ -z "$fresh" ] && built_for "$@" && return 0 ;;
        esac
    fi
    mkdir -p "$build"
    echo "Configuring ..."
    if ! (cd "$root" && cmake $fresh --preset $preset) >"$log" 2>&1 </dev/null; then
        grep -A 12 -m 3 'CMake Error' "$log" || tail -n 30 "$log"
        echo "Configuring failed (log: $log)."
        exit 1
    fi
    sed -n 's/^-- \(deal\.II [0-9].*\)/\1/p' "$log"
    if ! built_for "$@"; then
        grep -o 'No tests: .*' "$log" || echo "No tests in $build: PERIDEAL_TESTS is off."
        exit 1
    fi
}

# Whether the build has what is wanted: everything that is computed with or, with --tests, the tests too.
built_for()
{
    [ -f "$build/build.ninja" ] || return 1
    [ "${1:-}" != --tests ] || grep -q '^build unit_tests:' "$build/build.ninja"
}

# Build the given targets with one line of progress; print the compiler's message if that fails.
compile()
{
    local log=$build/build.log start=$SECONDS said=0 step steps percent job
    (cd "$build" && exec env NINJA_STATUS='[%f/%t] ' ninja "$@") >"$log" 2>&1 </dev/null &
    job=$!
    trap 'kill $job 2>/dev/null; exit 130' INT TERM
    while kill -0 $job 2>/dev/null; do
        sleep 0.2
        IFS=' /' read -r step steps < <(sed -n 's/^\[\([0-9]*\/[0-9]*\)\].*/\1/p' "$log" | tail -n 1) || continue
        percent=$((100 * step / steps))
        if [ -t 1 ]; then
            printf '\rBuilding: %d %% (%d of %d) ' $percent "$step" "$steps"
        elif [ $((percent / 20)) -gt $said ] && [ "$steps" -gt 3 ]; then
            said=$((percent / 20))
            echo "Building: $percent % ($((SECONDS - start)) s)"
        fi
    done
    wait $job
    local status=$?
    trap - INT TERM
    [ -t 1 ] && printf '\r%60s\r' ''
    if [ $status != 0 ]; then
        # From the first failed step to the next step, without the command line.
        awk '/^FAILED:/ {on = 1; print; getline; next} on && /^\[[0-9]+\/[0-9]+\]/ {exit} on {print}' "$log" | head -n 60
        grep -q '^FAILED:' "$log" || tail -n 20 "$log"
        echo "Building failed (log: $log)."
        exit 1
    fi
    grep -q 'no work to do' "$log" || echo "Built in $((SECONDS - start)) s."
}
