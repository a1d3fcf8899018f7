#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
set -u -o pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd -P)

usage()
{
    cat <<END
Usage: tests/distributions/debian_13.sh [FOLDER] [--only COMMAND]

Makes a Debian 13 (trixie) in FOLDER (default: build/debian_13 of this repository) with debootstrap, puts a clean clone of this repository's
last commit into it, and there runs, by chroot and with nothing but what ./run installs:

  ./run prm/quick_start.prm
  ./check --quick

With --only that command in place of both: --only "./run prm/quick_start.prm -n 2". Needs root, debootstrap, git, 8 GB and a mirror of
Debian (DEBIAN_MIRROR, default that of debootstrap). The packages, the clone's build and ccache stay in FOLDER, so that the next
call takes what has not changed. RELEASE=sid or another name makes another Debian. Ends with the first exit status that is not 0.
END
}

folder=$root/build/debian_13
commands=("./run prm/quick_start.prm" "./check --quick")
while [ $# -gt 0 ]; do
    case $1 in
    -h | --help)
        usage
        exit 0
        ;;
    --only)
        [ $# -gt 1 ] || { echo "--only needs a command." >&2; exit 1; }
        commands=("$2")
        shift
        ;;
    -*)
        usage >&2
        exit 1
        ;;
    *) folder=$1 ;;
    esac
    shift
done
release=${RELEASE:-trixie}
mirror=${DEBIAN_MIRROR:-}

[ "$(id -u)" = 0 ] || { echo "Only root can change to another root folder." >&2; exit 1; }
for program in debootstrap git unshare chroot; do
    command -v $program >/dev/null || { echo "$program is missing (as root: apt-get install debootstrap git util-linux)." >&2; exit 1; }
done
mkdir -p "$folder/packages" || exit 1
folder=$(cd "$folder" && pwd -P)
system=$folder/root

# A command in the other Debian, in PeriDeal's folder. What is mounted is so for this command alone.
inside()
{
    # shellcheck disable=SC2016 # for the shell in the new namespace
    unshare --mount --propagation private sh -c '
        system=$1 packages=$2
        mount --rbind /proc "$system/proc" && mount --rbind /dev "$system/dev" && mount --rbind /sys "$system/sys" &&
            mount --bind "$packages" "$system/var/cache/apt/archives" || exit 1
        shift 2
        exec chroot "$system" /usr/bin/env -i HOME=/root PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 \
            sh -c "cd perideal && $1"' sh "$system" "$folder/packages" "$1" </dev/null
}

# The system, made under another name until it is whole.
if [ ! -d "$system" ]; then
    echo "Making $release in $system ..."
    rm -rf "$system.part"
    debootstrap --variant=minbase --cache-dir="$folder/packages" "$release" "$system.part" ${mirror:+"$mirror"} >"$folder/debootstrap.log" 2>&1 || {
        tail -n 5 "$folder/debootstrap.log"
        echo "debootstrap failed (log: $folder/debootstrap.log)."
        exit 1
    }
    # It need not outlast a power failure, and writing each file at once takes most of the time.
    echo force-unsafe-io >"$system.part/etc/dpkg/dpkg.cfg.d/unsafe-io"
    mv "$system.part" "$system" || exit 1
fi
cp /etc/resolv.conf "$system/etc/resolv.conf"

# The last commit and nothing else; what was built of an earlier one stays.
clone=$system/perideal
if [ ! -d "$clone/.git" ]; then
    git clone -q --no-hardlinks "$root" "$clone" || exit 1
fi
commit=$(git -C "$root" rev-parse HEAD)
git -C "$clone" fetch -q "$root" "$commit" && git -C "$clone" checkout -q -f --detach "$commit" && git -C "$clone" clean -q -f -d || exit 1
echo "Commit $(git -C "$clone" log -1 --format='%h %s')"

for command in "${commands[@]}"; do
    echo "$release: $command"
    start=$SECONDS
    inside "$command"
    status=$?
    echo "$release: $command: exit status $status after $((SECONDS - start)) s"
    [ $status = 0 ] || exit $status
done
