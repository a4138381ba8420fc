#!/usr/bin/env bash
# container.sh FOLDER SCRIPT: boots this machine's own system with systemd in a container of its own, on a scratch overlay
# that vanishes afterwards, with FOLDER as /mnt. When it is up, runs /mnt/SCRIPT there with bash, whose output goes to
# FOLDER/output, the console to FOLDER/console; exits with its exit code. Needs root.
set -euo pipefail

[[ $# -eq 2 ]] || { echo "usage: container.sh FOLDER SCRIPT" >&2; exit 2; }
export FOLDER=$1 SCRIPT=$2
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
  : > "$root/etc/machine-id"
  # Nothing but systemd itself, and what is to be tried.
  find "$root/etc/systemd/system" -path '*.wants/*' -delete
  local unit
  for unit in apt-daily.timer apt-daily-upgrade.timer dpkg-db-backup.timer e2scrub_all.timer fstrim.timer man-db.timer; do
    ln -sf /dev/null "$root/etc/systemd/system/$unit"
  done
  cat > "$root/etc/systemd/system/in-container.service" <<UNIT
[Unit]
After=multi-user.target
[Service]
Type=idle
Environment=HOME=/root
StandardOutput=file:/mnt/output
StandardError=file:/mnt/output
ExecStart=/bin/bash /mnt/$SCRIPT
ExecStopPost=/bin/bash -c 'echo \$EXIT_STATUS > /mnt/exit-code; systemctl --force poweroff'
UNIT
  mkdir -p "$root/etc/systemd/system/multi-user.target.wants"
  ln -sf ../in-container.service "$root/etc/systemd/system/multi-user.target.wants/"
  ln -sf /lib/systemd/system/multi-user.target "$root/etc/systemd/system/default.target"
  script -qec "systemd-nspawn --quiet --register=no --keep-unit --boot --private-network --console=read-only \
    --bind=$FOLDER:/mnt -D $root" "$FOLDER/console" < /dev/null > /dev/null || true
}
export -f boot
unshare --mount --pid --fork --kill-child --mount-proc bash -c boot
exit "$(cat "$FOLDER/exit-code" 2> /dev/null || echo 1)"
