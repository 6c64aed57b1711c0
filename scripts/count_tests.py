"""Counts checks and JUnit reports together: failures, skips with reasons, and one closing line."""

import re
import sys
import xml.etree.ElementTree as ElementTree
from collections import Counter
from pathlib import Path


def report_cases(path: Path) -> list[tuple[str, str, str]]:
    """(outcome, name, reason) of every test in the JUnit report of googletest or pytest."""
    cases = []
    for case in ElementTree.parse(path).getroot().iter("testcase"):
        name = f"{case.get('classname')}.{case.get('name')}"
        failure = next((child for child in case if child.tag in ("failure", "error")), None)
        skip = case.find("skipped")
        if failure is not None:
            cases.append(("failed", name, failure.get("message", "")))
        elif skip is not None:
            cases.append(("skipped", name, skip.get("message", "")))
        elif case.get("status") == "notrun":
            cases.append(("skipped", name, "disabled"))
        else:
            cases.append(("passed", name, ""))
    return cases


def all_cases(checks: Path, reports: list[Path]) -> list[tuple[str, str, str]]:
    """The cases of every report and the lines "outcome<TAB>name" of `checks`.

    A suite that ended badly is a failure of its own unless its reports (suite.xml, or suite_0.xml,
    suite_1.xml, ... of its parts) name one; so is a report that is missing or empty.
    """
    cases = []
    ended_badly = set()
    for line in checks.read_text().splitlines():
        outcome, name = line.split("\t")
        if outcome == "ended badly":
            ended_badly.add(name)
        else:
            cases.append((outcome, name, ""))
    suites = {}
    for report in reports:
        found = report_cases(report) if report.exists() else []
        suites.setdefault(re.sub(r"_\d+$", "", report.stem), []).extend(
            found or [("failed", report.stem, "no test ran")]
        )
    for suite, found in suites.items():
        if suite in ended_badly and not any(case[0] == "failed" for case in found):
            cases.append(("failed", suite, "it ended badly although no test failed"))
        cases += found
    return cases


def main(checks: str, *reports: str) -> int:
    cases = all_cases(Path(checks), [Path(report) for report in reports])
    print()
    for outcome, name, reason in sorted(cases):
        if outcome != "passed":
            print(f"{outcome}: {name}: {' '.join(reason.split())[:300]}".rstrip(": "))
    count = Counter(outcome for outcome, _, _ in cases)
    print(f"{count['passed']} passed, {count['failed']} failed, {count['skipped']} skipped")
    return 1 if count["failed"] else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
