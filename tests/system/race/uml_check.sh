# Runs as root inside user-mode-linux, where can0 is a vcan and the package's files lie in place: the simulated car drives a
# lap over the kernel's CAN with the daemons that systemd starts. One line a check, as in installed_check.sh.
. /mnt/checks.sh
frames() { cat "/sys/class/net/can0/statistics/$1_packets"; }

# One after the other: systemd itself does not answer while fourteen start at once.
mapfile -t units < <(ls /usr/lib/systemd/system/hairpin.target.wants)
for unit in "${units[@]}"; do
  [[ $(systemctl show -P LoadState "$unit") == masked ]] && continue
  systemctl start "$unit"
  check "$unit runs" '[[ $(systemctl show -P ActiveState $unit) == active ]]' "$(systemctl status --no-pager -n 20 "$unit" 2>&1)"
  running+=("$unit")
done
systemctl start hairpin.target
check "hairpin.target is reached" '[[ $(systemctl show -P ActiveState hairpin.target) == active ]]'
check "the gateway listens on the kernel's CAN" 'grep -q can0 /proc/net/can/rcvlist_sff' "$(cat /proc/net/can/rcvlist_sff)"
echo "figure up_s $(cut -d. -f1 /proc/uptime)"

start=$SECONDS
before=$(frames tx)
/mnt/hairpin-race --attach --can=can0 --speed 0 --patience 20 --track "$(cat /mnt/track)" --config-dir /mnt/config --program-dir /mnt \
  --logs-dir /mnt --out /mnt/run > /mnt/race.txt 2>&1
code=$?
echo "figure lap_wall_s $(( SECONDS - start ))"
echo "figure can_frames $(( $(frames tx) - before ))"
sed 's/^/figure race: /' /mnt/race.txt | tail -n 9
check "the car drives a lap over the kernel's CAN" '[[ $code == 0 ]]' "$(tail -n 20 /mnt/race.txt; journalctl --no-pager -n 60 -u 'hairpin-*')"
for unit in "${running[@]}"; do
  check "$unit was not restarted" '[[ $(systemctl show -P NRestarts $unit) == 0 && $(systemctl show -P ActiveState $unit) == active ]]'
done
exit $failed
