# Runs inside the container as root: installs the package in /mnt and tries what is promised of it. One line a check,
# `ok NAME` or `FAILED NAME: why`; exits with 1 if any failed.
. /mnt/checks.sh
now_ms() { date +%s%3N; }
main_pid() { systemctl show -P MainPID "$1"; }
# Milliseconds until UNIT runs again with another process than PID; gives up after 5 s.
back_after() {  # UNIT PID
  local start; start=$(now_ms)
  while [[ $(systemctl show -P ActiveState "$1") != active || $(main_pid "$1") == "$2" ]]; do
    (( $(now_ms) - start < 5000 )) || break
    sleep 0.02
  done
  echo $(( $(now_ms) - start ))
}

dpkg -i /mnt/hairpin.deb || exit 1
mapfile -t units < <(ls /usr/lib/systemd/system/hairpin.target.wants)
check "the package names a unit for every daemon" '[[ ${#units[@]} -ge 7 ]]'

# The kernel is the host's: where it gives less than the package's sysctl file asks for, cones do with it.
(( $(cat /proc/sys/net/core/rmem_max) >= 2097152 )) || sed -i 's/^min_receive_buffer_kb.*/min_receive_buffer_kb: 200/' /etc/hairpin/mission_manager.yaml

systemctl start hairpin.target
sleep 2
for unit in "${units[@]}"; do
  # Skipped by its own condition: a driver without its device.
  [[ $(systemctl show -P ConditionResult "$unit") == no ]] && continue
  check "$unit runs" '[[ $(systemctl show -P ActiveState $unit) == active ]]' "$(systemctl status --no-pager -n 20 "$unit" 2>&1)"
done
check "no unit has failed" '[[ -z $(systemctl --failed --quiet --plain --no-legend) ]]' "$(systemctl --failed --no-pager)"

# A machine without manual pages is none the worse.
said=$(cd /usr/lib/systemd/system && systemd-analyze verify --man=no "${units[@]}" hairpin.target lcm-loopback.service 2>&1)
check "systemd-analyze verify is silent" '[[ -z "$said" ]]' "$said"
for unit in "${units[@]}"; do
  exposure=$(systemd-analyze security --no-pager "$unit" 2>&1 | sed -n 's/.*exposure level for .*: \([0-9.]*\) .*/\1/p')
  echo "figure exposure $unit $exposure"
  check "$unit is exposed by less than 5.0" 'awk "BEGIN { exit !(\"$exposure\" != \"\" && $exposure < 5.0) }"' "$exposure"
done

pid=$(main_pid hairpin-local_mapper.service)
kill -STOP "$pid"
ms=$(back_after hairpin-local_mapper.service "$pid")
echo "figure hung_back_ms $ms"
check "a hung daemon is back within 2.5 s" '(( ms < 2500 ))' "$ms ms"

pid=$(main_pid hairpin-boundary_estimator.service)
kill -SEGV "$pid"
ms=$(back_after hairpin-boundary_estimator.service "$pid")
echo "figure crashed_back_ms $ms"
check "a crashed daemon is back within 1 s" '(( ms < 1000 ))' "$ms ms"

config=/etc/hairpin/path_tracker.yaml
cp $config /tmp/good.yaml
echo "no_such_key: 1" >> $config
systemctl restart hairpin-path_tracker.service 2> /dev/null
sleep 1
unit=hairpin-path_tracker.service
check "a bad config ends with 78" '[[ $(systemctl show -P ExecMainStatus $unit) == 78 ]]' "$(systemctl show -P ExecMainStatus $unit)"
check "a bad config is not tried again" '[[ $(systemctl show -P NRestarts $unit) == 0 && $(systemctl show -P ActiveState $unit) == failed ]]'
check "the journal names the key" 'journalctl -u $unit --no-pager | grep -q no_such_key'
cp /tmp/good.yaml $config
systemctl reset-failed $unit
systemctl start $unit
check "a mended config runs" '[[ $(systemctl show -P ActiveState $unit) == active ]]'

drive() {  # OPTION...: the simulator with the installed daemons
  /mnt/hairpin-race --attach --speed 0 --config-dir /mnt/config --program-dir /mnt --logs-dir /mnt --out /mnt/run "$@" > /mnt/race.txt 2>&1
}
drive
code=$?
check "the simulator drives a lap with the installed daemons" '[[ $code == 0 ]]' "$(tail -n 20 /mnt/race.txt)"
map=/var/lib/hairpin/map.yaml
check "the map of the track is kept" '[[ $(grep -c colour: $map) -gt 100 ]]' "$(ls -l /var/lib/hairpin)"
check "the log of every message is written" '[[ $(stat -c %s /var/log/hairpin/car.lcmlog.0) -gt 1000000 ]]'

systemctl restart hairpin.target
sleep 2
drive --mission trackdrive --map $map --seed 2
code=$?
check "the next start races ten laps on it" '[[ $code == 0 ]]' "$(tail -n 20 /mnt/race.txt)"
sed -n 's/^  lap time  */figure trackdrive /p' /mnt/race.txt

systemctl stop hairpin.target
sleep 1
check "the target's stop ends all daemons" '! pgrep -u hairpin'
exit $failed
