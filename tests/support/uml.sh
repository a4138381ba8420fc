#!/usr/bin/env bash
# uml.sh FOLDER SCRIPT: as container.sh, but in user-mode-linux: a kernel of its own, which has CAN whether or not this
# machine's has: can0 is there, a vcan, before systemd starts. FOLDER/files, if it is there, lies over the root. About 30 s
# of one processor until /mnt/SCRIPT runs.
set -euo pipefail

[[ $# -eq 2 ]] || { echo "usage: uml.sh FOLDER SCRIPT" >&2; exit 2; }
script=$2
folder=$(realpath "$1")
support=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
rm -f "$folder/exit-code"
mkdir -p "$folder/files"

# The guest's first process; systemd takes its place.
cat > "$folder/init" <<INIT
#!/bin/bash
export PATH=/usr/sbin:/usr/bin:/sbin:/bin
mount -t proc none /proc; mount -t sysfs none /sys; mount -t tmpfs none /run
modules=/usr/lib/uml/modules/\$(uname -r)/kernel
for module in fs/overlayfs/overlay net/can/can net/can/can-raw drivers/net/can/dev/can-dev drivers/net/can/vcan; do
  insmod "\$modules/\$module.ko" || echo "no module \$module"
done
ip link add can0 type vcan && ip link set can0 up
mkdir /run/scratch && mount -t tmpfs -o size=600m scratch /run/scratch
root=/run/scratch/root
mkdir /run/scratch/changes /run/scratch/work /run/scratch/files "\$root"
mount -t hostfs -o "$folder/files" none /run/scratch/files
mount -t overlay -o "lowerdir=/run/scratch/files:/,upperdir=/run/scratch/changes,workdir=/run/scratch/work" overlay "\$root"
. "$support/guest_root.sh"
guest_root "\$root" "$script" in-uml
: > "\$root/etc/fstab"
# What a slow machine without disks, users and hardware needs not wait for.
for unit in systemd-tmpfiles-{setup,setup-dev}.service systemd-tmpfiles-clean.timer systemd-{logind,user-sessions}.service \\
    systemd-update-{utmp,utmp-runlevel,done}.service systemd-{udevd,udev-trigger}.service \\
    systemd-udevd-{control,kernel}.socket systemd-{random-seed,hwdb-update,firstboot,machine-id-commit}.service \\
    systemd-journal-{flush,catalog-update}.service systemd-{modules-load,binfmt,remount-fs}.service ldconfig.service \\
    kmod-static-nodes.service console-getty.service getty.target dbus.service dbus.socket cron.service \\
    proc-sys-fs-binfmt_misc.automount dev-hugepages.mount dev-mqueue.mount sys-kernel-{debug,tracing,config}.mount \\
    sys-fs-fuse-connections.mount systemd-ask-password-{console,wall}.path modprobe@{dm_mod,loop,fuse,configfs,drm}.service; do
  ln -sf /dev/null "\$root/etc/systemd/system/\$unit"
done
mount -t hostfs -o "$folder" none "\$root/mnt"
umount /proc /sys
exec switch_root "\$root" /lib/systemd/systemd
INIT
chmod +x "$folder/init"

linux.uml mem=1500M root=/dev/root rootfstype=hostfs rootflags=/ ro quiet con=null con0=null,fd:2 con1=fd:0,fd:1 \
  init="$folder/init" < /dev/null > "$folder/console" 2>&1 || true
exit "$(cat "$folder/exit-code" 2> /dev/null || echo 1)"
