#!/usr/bin/env bash
# container.sh FOLDER SCRIPT: boots this machine's own system with systemd in a container of its own, on a scratch overlay
# that vanishes afterwards, with FOLDER as /mnt. When it is up, runs /mnt/SCRIPT there with bash, whose output goes to
# FOLDER/output, the console to FOLDER/console; exits with its exit code. Needs root.
set -euo pipefail

[[ $# -eq 2 ]] || { echo "usage: container.sh FOLDER SCRIPT" >&2; exit 2; }
export FOLDER=$1 SCRIPT=$2
SUPPORT=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
export SUPPORT
rm -f "$FOLDER/exit-code"

boot() {
  set -euo pipefail
  mount --make-rprivate /
  local scratch root
  scratch=$(mktemp -d)
  mount -t tmpfs -o size=2g scratch "$scratch"
  root=$scratch/root
  mkdir "$scratch/changes" "$scratch/work" "$root"
  mount -t overlay -o "lowerdir=/,upperdir=$scratch/changes,workdir=$scratch/work" overlay "$root"
  . "$SUPPORT/guest_root.sh"
  guest_root "$root" "$SCRIPT" in-container
  script -qec "systemd-nspawn --quiet --register=no --keep-unit --boot --private-network --console=read-only \
    --bind=$FOLDER:/mnt -D $root" "$FOLDER/console" < /dev/null > /dev/null || true
}
export -f boot
unshare --mount --pid --fork --kill-child --mount-proc bash -c boot
exit "$(cat "$FOLDER/exit-code" 2> /dev/null || echo 1)"
