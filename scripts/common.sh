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

# The pinned requirements of the named extras in pyproject.toml; `build` names those of the build.
pins() {
  /usr/bin/python3 - "$@" <<'PYTHON'
import sys
import tomllib

with open("pyproject.toml", "rb") as file:
    project = tomllib.load(file)
groups = {"build": project["build-system"]["requires"]}
groups |= project["project"]["optional-dependencies"]
print(*(pin for name in sys.argv[1:] for pin in groups[name]), sep="\n")
PYTHON
}

# make_environment FOLDER EXTRA...: a virtual environment with those pins, of the system's Python or
# of the one that the variable `python` names.
make_environment() {
  local folder=$1 of=${python:-/usr/bin/python3} wanted
  shift
  wanted="$root $("$of" --version) $(pins "$@")"
  [ "$(cat "$folder/.pins" 2>/dev/null)" = "$wanted" ] && return
  # A moved folder or another Python leaves an environment whose programs do not start.
  if [ "$(head -n 1 "$folder/bin/pip" 2>/dev/null)" != "#!$root/$folder/bin/python3" ] ||
    ! "$folder/bin/pip" --version >"$logs/pip.log" 2>&1; then
    step "create ${folder//\//-}" "$of" -m venv --clear "$folder"
  fi
  step "fill ${folder//\//-}" "$folder/bin/pip" install $(pins "$@")
  echo "$wanted" >"$folder/.pins"
}
