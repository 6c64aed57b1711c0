# Sourced by scripts/test and scripts/test-long: counted checks and test suites.
checks=$logs/checks.tsv

setup_failed() {
  printf '\nfailed: setup\n0 passed, 1 failed, 0 skipped\n'
  exit 1
}

begin_checks() {
  rm -f "$logs"/googletest_*.xml "$logs"/pytest*.xml
  : >"$checks"
}

# check NAME COMMAND...: one step that counts as one test.
check() {
  local outcome=passed
  step "$@" || outcome=failed
  printf '%s\t%s\n' "$outcome" "$1" >>"$checks"
}

# suite NAME COMMAND...: a step that writes build/logs/NAME.xml (JUnit), whose tests are counted one
# by one. A suite that dies counts as one failure more, whatever it wrote before.
suite() {
  step "$@" || printf 'ended badly\t%s\n' "$1" >>"$checks"
}

# both_halves PROGRAM ARGUMENT...: a googletest program as two processes, one for each core, with
# half of the tests each, for LIMIT seconds at most; reports, if asked for by REPORTS=1, are
# build/logs/googletest_{0,1}.xml.
both_halves() {
  local half status=0 running=()
  for half in 0 1; do
    GTEST_TOTAL_SHARDS=2 GTEST_SHARD_INDEX=$half \
      GTEST_OUTPUT=${REPORTS:+xml:$logs/googletest_$half.xml} \
      timeout --kill-after=60 "${LIMIT:-1800}" "$@" &
    running+=($!)
  done
  for half in "${running[@]}"; do wait "$half" || status=1; done
  return $status
}

# sanitized ARGUMENT...: the same with address and undefined sanitizers. Of each piece of memory only
# the ten innermost frames are told: of the thirty that are usual, boxes halved again and again have
# millions that differ, and the sanitizer keeps every stack it ever saw.
sanitized() {
  ASAN_OPTIONS=malloc_context_size=10 LSAN_OPTIONS=suppressions=tests/leaks_elsewhere.txt \
    both_halves build/asan/tests/cpp/sardf_tests --gtest_brief=1 "$@"
}

# limited_pytest SECONDS ARGUMENT...: then it is interrupted, so that it prints what it knows, and
# killed a minute later.
limited_pytest() {
  local limit=$1
  shift
  timeout --signal=INT --kill-after=60 "$limit" .venv/bin/python -m pytest "$@"
}

# The Python tests: files of them on both cores, then those that measure seconds. Reports are
# build/logs/pytest_{0,1}.xml. Where a process crashes, which pytest-xdist may wait for without end
# after it has started another one, it names the test and stops.
all_pytest() {
  local status=0
  limited_pytest 2400 -m "not long and not timed" -n 2 --dist loadfile \
    --max-worker-restart=0 --junitxml="$logs/pytest_0.xml" || status=1
  limited_pytest 900 -m "timed and not long" --junitxml="$logs/pytest_1.xml" || status=1
  return $status
}

build_preset() {
  local preset=$1
  shift
  cmake --preset "$preset" "$@" && cmake --build --preset "$preset"
}

check_cpp_format() {
  find core povray_gen tests bench \( -name '*.hpp' -o -name '*.cpp' \) -print0 |
    xargs -0 clang-format-16 --dry-run -Werror
}

# Prints how the speed of three short benchmarks changed since SARDF_BASE, or else since the last
# commit of an earlier day. A report: nothing of it counts, and it is given up after four minutes.
report_speed() {
  local base=${SARDF_BASE:-$(git rev-list -1 --before="$(git log -1 --format=%cs) 00:00" HEAD)}
  if [ -z "$base" ]; then
    echo "speed                  not compared: there is no earlier commit"
  elif step "speed" timeout 240 bench/compare --rounds 3 "$base"; then
    grep -v '^round' "$logs/speed.log" | sed 's/^/    /'
  fi
}

# end_checks REPORT...: prints failures, skips with their reasons, and the closing line; exits with 1
# if anything failed.
end_checks() {
  .venv/bin/python scripts/count_tests.py "$checks" "${@/#/$logs/}"
  exit
}
