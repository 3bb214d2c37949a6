# shellcheck shell=sh
# Sourced by ./demo, ./check and the scripts of .ci.

stage_pid=
trap '[ -z "$stage_pid" ] || kill "$stage_pid" 2>/dev/null; exit 130' INT TERM

# listed SECTION...: the packages of those sections of packages.txt, here.
listed() {
  for section in "$@"; do
    awk -v wanted="[$section]" '
      { sub(/[ \t]*#.*/, "") }
      /^\[/ { inside = ($1 == wanted); next }
      inside && NF { print $1 }' packages.txt
  done
}

# stage TITLE LOG COMMAND...: runs a command with its output in LOG. Shows the log's last line in
# place on a terminal, now and then elsewhere; shows the end of the log if the command fails, and
# returns its status.
stage() {
  stage_title=$1 stage_log=$2
  shift 2
  mkdir -p "$(dirname "$stage_log")"
  stage_start=$(date +%s)
  "$@" >"$stage_log" 2>&1 </dev/null &
  stage_pid=$!
  [ -t 1 ] || echo "-- $stage_title .."
  stage_ticks=0
  while kill -0 "$stage_pid" 2>/dev/null; do
    if [ -t 1 ]; then
      printf '\r\033[K-- %s: %.60s' "$stage_title" "$(tail -n 1 "$stage_log" | tr -d '\r')"
    elif [ $((stage_ticks % 300)) -eq 299 ]; then
      printf '   %.90s\n' "$(tail -n 1 "$stage_log")"
    fi
    sleep 0.2
    stage_ticks=$((stage_ticks + 1))
  done
  stage_status=0
  wait "$stage_pid" || stage_status=$?
  stage_pid=
  [ ! -t 1 ] || printf '\r\033[K'
  stage_seconds=$(($(date +%s) - stage_start))
  if [ "$stage_status" -eq 0 ]; then
    echo "-- $stage_title: done in $stage_seconds s"
  else
    echo "-- $stage_title: FAILED after $stage_seconds s; the end of $stage_log:" >&2
    tail -n 30 "$stage_log" >&2
  fi
  return "$stage_status"
}
