# Sourced by the other scripts: the repository's root, and steps with a log and a duration.
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"
logs=$root/build/logs
mkdir -p "$logs"
# One compiler everywhere, whatever the user's shell prefers, and no foreign Python packages.
export CXX=/usr/bin/g++ PYTHONNOUSERSITE=1 PIP_DISABLE_PIP_VERSION_CHECK=1 PIP_NO_INPUT=1
unset PYTHONPATH PYTHONHOME

die() {
  echo "$(basename "$0"): $*" >&2
  exit 1
}

# step NAME COMMAND...: run it with its output in build/logs/NAME.log and print one line; if it
# fails, print the end of that log as well and return its status.
step() {
  local name=$1 log=$logs/${1// /-}.log begun=$SECONDS status=0
  shift
  printf '%-22s' "$name"
  "$@" >"$log" 2>&1 </dev/null || status=$?
  if [ "$status" -eq 0 ]; then
    printf ' ok      %5d s\n' $((SECONDS - begun))
  else
    printf ' failed  %5d s   end of %s:\n' $((SECONDS - begun)) "${log#"$root"/}"
    tail -n 40 "$log" | sed 's/^/    /'
  fi
  return "$status"
}
