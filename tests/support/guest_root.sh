# Sourced by what boots this machine's own system as a guest: guest_root ROOT SCRIPT NAME leaves, in the scratch copy of the
# system at ROOT, nothing but systemd itself and a unit NAME that runs /mnt/SCRIPT with bash when all is up. The script's
# output goes to /mnt/output, its exit code to /mnt/exit-code, and the guest powers off.
guest_root() {
  local root=$1 script=$2 name=$3 unit
  : > "$root/etc/machine-id"
  find "$root/etc/systemd/system" -path '*.wants/*' -delete
  for unit in apt-daily.timer apt-daily-upgrade.timer dpkg-db-backup.timer e2scrub_all.timer fstrim.timer man-db.timer; do
    ln -sf /dev/null "$root/etc/systemd/system/$unit"
  done
  cat > "$root/etc/systemd/system/$name.service" <<UNIT
[Unit]
After=multi-user.target
[Service]
Type=idle
Environment=HOME=/root
StandardOutput=file:/mnt/output
StandardError=file:/mnt/output
ExecStart=/bin/bash /mnt/$script
ExecStopPost=/bin/bash -c 'echo \$EXIT_STATUS > /mnt/exit-code; systemctl --force poweroff'
UNIT
  mkdir -p "$root/etc/systemd/system/multi-user.target.wants"
  ln -sf "../$name.service" "$root/etc/systemd/system/multi-user.target.wants/"
  ln -sf /lib/systemd/system/multi-user.target "$root/etc/systemd/system/default.target"
}
