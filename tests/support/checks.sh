# Sourced by what runs inside a guest: one line a check, `ok NAME` or `FAILED NAME: why`; `failed` is 1 if any did.
failed=0
check() {  # NAME CONDITION [WHY]
  if eval "$2"; then echo "ok $1"; else echo "FAILED $1: ${3:-$2}"; failed=1; fi
}
active_within() {  # SECONDS UNIT
  local end=$(( SECONDS + $1 ))
  until [[ $(systemctl show -P ActiveState "$2") == active ]]; do
    (( SECONDS < end )) || return 1
    sleep 0.5
  done
}
